// radius_field.h — the radius that a solid's rounded edges have at each place
// What       Each convex edge has a profile: the radius by the place along it, linear between knots. At a place of the
//            solid the radius is that of the nearest edge's profile, at the foot of the perpendicular.
// In / Out   coordinates relative to the solid's centre
// Cost       one search of the edges near
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "arris/math.h"
#include "rounding/box_tree.h"

namespace arris {

struct RadiusKnot {
  double v;  // along the edge
  double radius;
};

struct EdgeProfile {
  Vec3d p0, direction;  // unit
  double length = 0;
  std::vector<RadiusKnot> knots;  // from 0 to length; v ascending

  [[nodiscard]] double at(double v) const;
};

class RadiusField {
 public:
  // The same everywhere.
  explicit RadiusField(double radius) : largest_(radius) {}
  explicit RadiusField(std::vector<EdgeProfile> edges);

  [[nodiscard]] bool is_uniform() const { return edges_.empty(); }
  [[nodiscard]] double largest() const { return largest_; }
  // Farther than four times the largest radius from all edges it is the largest.
  [[nodiscard]] double at(Vec3d x) const;
  // Whether it is seen at once that all of a box has one radius.
  [[nodiscard]] bool is_uniform_within(Vec3d low, Vec3d high) const;
  [[nodiscard]] std::size_t bytes() const;

 private:
  struct Nearest {
    double distance, radius;
  };
  [[nodiscard]] std::optional<Nearest> nearest(Vec3d x) const;

  double largest_ = 0;
  std::vector<EdgeProfile> edges_;
  BoxTree tree_{{}};
};

}  // namespace arris
