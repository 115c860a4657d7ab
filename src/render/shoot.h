// shoot.h — single rays in double precision, for checking geometry
// What       Shooter::shoot() finds what PreparedScene::intersect() finds and computes place and normal anew in
//            double from the triangle that was hit
// In / Out   a ray in world space whose direction need not be unit; t in lengths of it
// Guarantee  on a flat face t, position and normal are those of the triangle's plane to double rounding
//            On a CSG solid they are those of the exact surface.
// Limits     which triangle is hit is decided in float: at an edge it may be the neighbour. Hits on rounded
//            edges have float precision of the scene's size, wherever the ray comes from.
// Cost       the constructor visits all vertices; shoot() is safe from any number of threads
#pragma once

#include <optional>

#include "arris/rounding.h"
#include "render/prepared_scene.h"

namespace arris {

struct Shot {
  double t = 0;
  Vec3d position;
  Vec3d normal;  // unit, outward from the solid
  ObjectId object;
  Feature feature = Feature::face;
  bool inside = false;  // the ray started in the solid: t is where it leaves
};

class Shooter {
 public:
  explicit Shooter(const PreparedScene& scene);

  // Precondition: the direction is finite and not zero.
  [[nodiscard]] std::optional<Shot> shoot(const Ray& ray) const;

 private:
  const PreparedScene& scene_;
  Vec3d center_;
  double radius_ = 0;  // of a ball around all vertices
};

}  // namespace arris
