// crease_pipes.h — balls of the radius along creases, as a ray meets them
// What       The rounded surface that is not of the sharp solid is the boundary of the balls around all points of its
//            creases. A ray that comes from where none of these balls are meets it where it first comes within r of a
//            crease: of a segment by a quadratic equation, of an arc of an ellipse, within the capsule around its
//            chord, by Newton's steps of the distance that is left.
// In / Out   coordinates relative to the solid's centre; directions of any length
// Source     J. C. Hart, "Sphere Tracing" (1996): a step of the distance is safe. So is one of Newton's of up to r
//            times the slope, as the second derivative of a distance is at most its inverse: until there it falls.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "rounding/box_tree.h"
#include "rounding/crease_curve.h"
#include "rounding/short_arc.h"

namespace arris {

struct PipeHit {
  double t = 0;
  Vec3d normal;         // unit, from the crease
  bool at_end = false;  // on the ball around an end, or around an arc
};

// Where a ray crosses the surface of one part of the pipes.
struct PipePlace {
  double t = 0, u = 0;  // of the ray, and of the part's curve
  Vec3d normal;         // unit, from the crease
};
struct PipeSpan {
  PipePlace in, out;
};

// Balls along the chord of a part.
struct ChordBalls {
  Vec3d p0, p1, axis;  // axis: unit, along the chord, or 0 if it has no extent
  double extent = 0;
  double radius = 0, growth = 0;  // at p0, and by the way along the axis
  double bulge = 0;               // of an arc above the chord
};

class CreasePipes {
 public:
  explicit CreasePipes(std::vector<CreaseCurve> creases);

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
  // The pipes in parts: segments, and short parts of arcs.
  [[nodiscard]] std::size_t part_count() const { return parts_.size(); }
  [[nodiscard]] const CreaseCurve& curve_of(std::uint32_t part) const { return parts_[part].curve; }
  // How far it lies above its chord.
  [[nodiscard]] double bulge_of(std::uint32_t part) const { return balls_[part].bulge; }
  // The places between which a ray's whole line is within r of a part; of several the first that ends beyond `after`.
  [[nodiscard]] std::optional<PipeSpan> span_of(std::uint32_t index, Vec3d origin, Vec3d direction,
                                                double after) const;
  // Whether x lies deeper than this within a ball.
  [[nodiscard]] bool holds(Vec3d x, double depth) const;

  [[nodiscard]] std::span<const CreaseCurve> creases() const { return creases_; }
  [[nodiscard]] std::size_t bytes() const;

 private:
  // A segment of a line, or a short part of an arc.
  struct Part {
    CreaseCurve curve;
    ShortArc arc;  // if it is no segment
  };
  struct Foot {
    Vec3d point;
    double u = 0;
  };
  static Part make_part(const CreaseCurve& curve);
  static ChordBalls balls_of(const CreaseCurve& part);
  static std::vector<Part> parts_of(std::span<const CreaseCurve> creases);

  // The nearest place of a part to x.
  [[nodiscard]] Foot foot_on(std::uint32_t index, Vec3d x) const;

  std::vector<CreaseCurve> creases_;
  std::vector<Part> parts_;        // in the tree's order
  std::vector<ChordBalls> balls_;  // of the parts: most of what is near a ray is told by these
  BoxTree tree_{{}};
};

}  // namespace arris
