// surfaces.h — the planes and quadrics that the faces of a tree lie on, equal ones only once
// What       Faces that coincide, from however many leaves, refer to one surface; a ray meets that at one t, to the
//            last bit. So coincident faces are decided once: A - A is empty, solids that touch have no wall between.
// Guarantee  surfaces are merged only if they deviate, within the leaf's box, by less than kMergedDeviation of its
//            coordinates (files hold six digits) and kMergedThickness of its thickness, so no single leaf collapses; a
//            wall or gap between two leaves may
// Frames     the tree's own space
#pragma once

#include <cstdint>
#include <map>
#include <tuple>
#include <unordered_map>
#include <vector>

#include "csg/cover.h"

namespace arris {

inline constexpr double kMergedDeviation = 1e-6;
inline constexpr double kMergedThickness = 1e-4;

// normal·x = d, normal unit
struct CsgPlane {
  Vec3d normal;
  double d = 0;
};

// A plane of the table as a leaf's face sees it: flipped, if the leaf is on the side of the plane's normal.
struct PlaneRef {
  std::uint32_t plane = 0;
  bool flipped = false;
};

// Where f(unit_from_object · x) < 0 for f = x² + y² + z² - 1 (ellipsoid), x² + y² - 1 (cylinder), x² + y² - z²
// (double cone).
struct CsgQuadric {
  enum class Form : std::uint8_t { ellipsoid, cylinder, cone };
  Form form = Form::ellipsoid;
  Affine3d unit_from_object;
};
constexpr Vec3d weights_of(CsgQuadric::Form form) {
  return {1, 1,
          form == CsgQuadric::Form::ellipsoid ? 1.0
          : form == CsgQuadric::Form::cone    ? -1.0
                                              : 0.0};
}
constexpr double constant_of(CsgQuadric::Form form) {
  return form == CsgQuadric::Form::cone ? 0 : 1;
}

class SurfaceTable {
 public:
  // `leaf` is the box of the leaf whose face it is; infinite for half-spaces.
  PlaneRef add(const CsgPlane& plane, const Box3d& leaf);
  std::uint32_t add(const CsgQuadric& quadric, const Box3d& leaf);

  [[nodiscard]] const std::vector<CsgPlane>& planes() const { return planes_; }
  [[nodiscard]] const std::vector<CsgQuadric>& quadrics() const { return quadrics_; }

  [[nodiscard]] Vec3d normal_of(PlaneRef face) const {
    const Vec3d n = planes_[face.plane].normal;
    return face.flipped ? -n : n;
  }
  // Negative inside the leaf.
  [[nodiscard]] double height_over(PlaneRef face, Vec3d p) const {
    const CsgPlane& plane = planes_[face.plane];
    const double h = dot(plane.normal, p) - plane.d;
    return face.flipped ? -h : h;
  }
  [[nodiscard]] Interval height_over(PlaneRef face, const SpaceCell& cell) const {
    const CsgPlane& plane = planes_[face.plane];
    const Interval h = linear_range(cell, plane.normal) - Interval(plane.d);
    return face.flipped ? -h : h;
  }
  [[nodiscard]] double value_of(std::uint32_t quadric, Vec3d p) const;
  [[nodiscard]] Interval value_of(std::uint32_t quadric, const SpaceCell& cell) const;
  [[nodiscard]] Vec3d gradient_of(std::uint32_t quadric, Vec3d p) const;

 private:
  using NormalKey = std::tuple<int, int, int>;
  std::vector<CsgPlane> planes_;
  std::vector<double> plane_slack_, quadric_slack_;
  std::map<NormalKey, std::multimap<double, std::uint32_t>> planes_by_normal_;
  std::vector<CsgQuadric> quadrics_;
  std::multimap<double, std::uint32_t> quadrics_by_key_;
};

}  // namespace arris
