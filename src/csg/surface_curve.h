// surface_curve.h — the curve in which two smooth surfaces meet, in boxes small enough that it is one piece there
// What       pieces_in() halves a box until in each part the curve is one nearly straight piece or none
// Legend     as crease_finder.h
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <vector>

#include "csg/smooth_patches.h"

namespace arris {

class SurfaceCurve {
 public:
  struct Piece {
    Vec3d a, b;
  };
  // size: the solid's; chords shorter than `least` need not be straight.
  SurfaceCurve(const SmoothSurface& s0, const SmoothSurface& s1, double size);

  // may_hold(box): whether what is looked for may be in a box.
  void collect_pieces(const Box3d& box, const std::function<bool(const Box3d&)>& may_hold,
                      std::vector<Piece>& out) const;
  // The point of the curve near p.
  [[nodiscard]] std::optional<Vec3d> nearest(Vec3d p) const;
  [[nodiscard]] Vec3d along(Vec3d p) const;  // not unit

 private:
  struct Try {
    enum class Outcome : std::uint8_t { none, one, halve } outcome = Outcome::halve;
    Piece piece;
  };
  [[nodiscard]] Try try_box(const Box3d& box) const;
  [[nodiscard]] Try try_line(const Box3d& box, Vec3d p) const;
  [[nodiscard]] bool is_one_piece(const Box3d& box, Vec3d along) const;
  [[nodiscard]] bool misses(const Box3d& box) const;
  [[nodiscard]] bool misses_difference(const Box3d& box, Vec3d middle) const;
  [[nodiscard]] bool is_tangent(const Box3d& box) const;
  // Where the curve meets the plane x[axis] = at, near p.
  [[nodiscard]] std::optional<Vec3d> crossing(Vec3d p, int axis, double at) const;
  [[nodiscard]] std::optional<Vec3d> end_at(const Box3d& box, Vec3d p, Vec3d direction) const;

  const SmoothSurface& s0_;
  const SmoothSurface& s1_;
  double size_;
};

}  // namespace arris
