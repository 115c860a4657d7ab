// crease_cutter.h — which parts of a curve lie on the erosion of a solid
// What       cut(): the curve is cut at planes where it may begin or cease to belong to its features; of those
//            that do, what is nearer to any triangle than r is cut away. A piece stays if its middle is r from its
//            faces and no nearer to anything else.
// In / Out   coordinates relative to the solid's centre
// Guarantee  what comes out lies in the erosion but for a thousandth of the tolerance
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "rounding/crease_curve.h"
#include "rounding/solid_surface.h"

namespace arris {

// The plane of all x with alpha + normal·x = 0.
struct CurveBound {
  Vec3d normal;
  double alpha;
};

class CreaseCutter {
 public:
  // tolerance: crease_tolerance()
  CreaseCutter(const SolidSurface& surface, double radius, double tolerance)
      : surface_(surface), r_(radius), tolerance_(tolerance), threshold_(r_ - 1e-3 * tolerance) {}

  // Edges, and corners, that the curves to come are at r from: the triangles at them reach no nearer.
  void set_features(std::span<const std::pair<Vec3d, Vec3d>> edges,
                    std::span<const Vec3d> corners) {
    edges_.assign(edges.begin(), edges.end());
    corners_.assign(corners.begin(), corners.end());
  }
  // belongs: whether a point of the curve is of its features.
  template <class Belongs>
  void cut(const CreaseCurve& curve, std::span<const CurveBound> bounds, const Belongs& belongs,
           std::vector<CreaseCurve>& out) {
    for_pieces_of(curve, bounds, belongs,
                  [&](const CreaseCurve& piece) { cut_reached(piece, out); });
  }
  // The pieces that belong.
  template <class Belongs, class Take>
  void for_pieces_of(const CreaseCurve& curve, std::span<const CurveBound> bounds,
                     const Belongs& belongs, const Take& take) const {
    std::vector<double> at{curve.u0, curve.u1};
    for (const CurveBound& bound : bounds) add_crossings(curve, bound.normal, bound.alpha, at);
    for_pieces(curve, at, belongs, take);
  }
  // The same where all of the curve belongs.
  void cut_reached(const CreaseCurve& curve, std::vector<CreaseCurve>& out);

 private:
  // Joins the pieces that stay; none is shorter than it need be.
  template <class Stays, class Take>
  void for_pieces(const CreaseCurve& curve, std::vector<double>& at, const Stays& stays,
                  const Take& take) const;
  [[nodiscard]] bool is_on_erosion(Vec3d x, const CreaseCurve& curve) const;
  void add_reaches_of_all(const CreaseCurve& curve);
  void add_reaches_of_line(const CreaseCurve& line, const SurfaceTriangle& t);
  void add_reaches_of_arc(const CreaseCurve& arc, const SurfaceTriangle& t);
  void sample(const CreaseCurve& arc);
  [[nodiscard]] bool is_of_features(const SurfaceTriangle& t) const;
  [[nodiscard]] bool is_apart(const CreaseCurve& curve, const SurfaceTriangle& t) const;
  [[nodiscard]] double shortest(const CreaseCurve& curve) const;

  const SolidSurface& surface_;
  double r_, tolerance_;
  double threshold_;  // what is nearer than this is cut away
  std::vector<std::pair<Vec3d, Vec3d>> edges_;
  std::vector<Vec3d> corners_;
  std::vector<const SurfaceTriangle*> near_;
  std::vector<double> at_;
  // Of an arc, once they have been asked for; and the heights above what is nearer than r of a triangle there.
  struct Place {
    double u;
    Vec3d x;
  };
  std::vector<Place> samples_;
  std::vector<double> values_;
};

template <class Stays, class Take>
void CreaseCutter::for_pieces(const CreaseCurve& curve, std::vector<double>& at, const Stays& stays,
                              const Take& take) const {
  std::ranges::sort(at);
  CreaseCurve open = curve;
  bool is_open = false;
  double from = at.front();
  for (std::size_t i = 1; i < at.size(); ++i) {
    if (at[i] - from < shortest(curve)) continue;
    const bool stay = stays(curve.at(0.5 * (from + at[i])));
    if (stay && !is_open) open.u0 = from;
    if (stay) open.u1 = at[i];
    if (!stay && is_open) take(open);
    is_open = stay;
    from = at[i];
  }
  if (is_open) take(open);
}

}  // namespace arris
