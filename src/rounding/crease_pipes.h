// crease_pipes.h — balls of the radius along creases, as a ray meets them
// What       The rounded surface that is not of the sharp solid is the boundary of the balls around all points of its
//            creases. A ray that comes from where none of these balls are meets it where it first comes within r of a
//            crease: of a segment by a quadratic equation, of an arc of an ellipse by steps of the distance that is
//            left within the capsule around its chord.
// In / Out   coordinates relative to the solid's centre; directions of any length
// Source     for the steps: J. C. Hart, "Sphere Tracing" (1996)
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "rounding/box_tree.h"
#include "rounding/crease_curve.h"

namespace arris {

struct PipeHit {
  double t = 0;
  Vec3d normal;         // unit, from the crease
  bool at_end = false;  // on the ball around an end, or around an arc
};

class CreasePipes {
 public:
  CreasePipes(std::vector<CreaseCurve> creases, double radius);

  // The first place within [0, end] where the ray comes within r of a crease. One that leaves there does not count, so
  // that a ray may start on a pipe.
  [[nodiscard]] std::optional<PipeHit> first_entry(Vec3d origin, Vec3d direction, double end) const;

  // Visits every part of a crease whose balls reach into the box, or which the ray meets; and some beside.
  template <class Visit>
  void for_each_near(Vec3d low, Vec3d high, Visit&& visit) const {
    tree_.for_each_near(low, high, [&](std::uint32_t i) { visit(parts_[i].curve); });
  }
  template <class Visit>
  void for_each_along(Vec3d origin, Vec3d direction, double end, Visit&& visit) const {
    tree_.for_each_along(origin, direction, 0, end,
                         [&](std::uint32_t i) { visit(parts_[i].curve); });
  }

  [[nodiscard]] std::span<const CreaseCurve> creases() const { return creases_; }
  [[nodiscard]] std::size_t bytes() const;

 private:
  // A segment of a line, or a short part of an arc.
  struct Part {
    CreaseCurve curve;
    double bulge;  // of the arc above its chord
  };

  static std::vector<Part> parts_of(std::span<const CreaseCurve> creases);
  static std::vector<Box> boxes_of(std::span<const Part> parts, double radius);

  std::vector<CreaseCurve> creases_;
  double r_;
  std::vector<Part> parts_;
  BoxTree tree_;
};

}  // namespace arris
