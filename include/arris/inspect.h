// inspect.h — what is in a scene: the facts behind `arris info`
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "arris/scene.h"

namespace arris {

// Edges of the welded mesh by what rounding does with them.
struct EdgeCounts {
  std::uint64_t convex = 0;       // sharp, turns outward
  std::uint64_t concave = 0;      // sharp, turns inward
  std::uint64_t smooth = 0;       // neither sharp nor flat
  std::uint64_t flat = 0;         // between coplanar triangles
  std::uint64_t boundary = 0;     // one triangle
  std::uint64_t nonmanifold = 0;  // not as many triangles run along it as against it
};

// Of a solid made of others: of its description, before anything coincides or is empty.
struct CsgReport {
  std::uint64_t primitives = 0;
  std::uint64_t curved = 0;  // of them, those with a curved surface, which is exact
  std::uint64_t flat_faces =
      0;  // of the others: facets, where something round was described by them
  std::uint64_t operations = 0;
  std::uint64_t depth = 0;  // operations in one another
};

struct ObjectReport {
  std::string name;
  std::optional<CsgReport> csg;  // set: a solid; what follows up to the bounds says nothing
  std::uint64_t triangles = 0, vertices = 0;  // vertices after welding
  std::uint64_t shells = 0;                   // connected components
  EdgeCounts edges;
  bool closed = false;             // every shell
  bool convex = false;             // every shell is closed and convex
  std::optional<double> inradius;  // world units, the smallest of the closed convex shells
  Vec3d bounds_min, bounds_max;    // world
  std::uint64_t degenerate_triangles = 0;
};

struct SceneReport {
  std::uint64_t triangles = 0;
  Vec3d bounds_min, bounds_max;
  std::vector<ObjectReport> objects;
};

// min_angle: of objects that have no rounding of their own.
SceneReport inspect_scene(const Scene& scene, double min_angle = radians(30));

}  // namespace arris
