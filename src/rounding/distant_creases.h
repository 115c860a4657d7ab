// distant_creases.h — creases between concave edges and corners that don't meet
// What       Balls that come out of a groove roll over its rims: over those of facets beside its end, too, and where
//            two grooves, or posts, are near to each other, over both. Each pair of features that one ball may touch
//            gives a curve (crease_curve.h, equidistant_curve.h). A ball on both lips of a passage that it can't pass
//            has none if another has room behind it, or gets stuck: what is there stays (open_mouths.h, thin_walls.h).
// In / Out   coordinates relative to the solid's centre
// Limits     of curves most of which is buried, what is shorter than a sixteenth, or a tenth of the radius, may be
//            missed; room behind lips is looked for within eight radii
// Cost       about linear in the pairs within 2 r of each other that lie beneath one another's planes
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "rounding/box_tree.h"
#include "rounding/concave_features.h"
#include "rounding/crease_cutter.h"

namespace arris {

class DistantCreases {
 public:
  // are_one_surface: whether creases between these faces don't matter; asked of features all of whose edges are smooth.
  using AreOneSurface =
      std::function<bool(std::span<const std::uint32_t>, std::span<const std::uint32_t>)>;
  // tolerance: crease_tolerance(); extent: how far lines reach.
  DistantCreases(const ConcaveFeatures& features, const SolidSurface& surface, double radius,
                 double tolerance, double extent, AreOneSurface are_one_surface);

  // Those of an edge, or a corner, with all edges and corners that come after it. Calls may be made at the same time.
  void add_of_edge(std::uint32_t edge, CreaseCutter& cutter, std::vector<CreaseCurve>& out) const;
  void add_of_corner(std::uint32_t corner, CreaseCutter& cutter,
                     std::vector<CreaseCurve>& out) const;

 private:
  [[nodiscard]] bool may_touch_both(const ConcaveEdge& a, const ConcaveEdge& b) const;
  [[nodiscard]] bool may_touch_both(const ConcaveEdge& a, const ConcaveCorner& b) const;
  [[nodiscard]] bool may_touch_both(const ConcaveCorner& a, const ConcaveCorner& b) const;
  [[nodiscard]] std::vector<CreaseCurve> curves_of(const ConcaveEdge& a,
                                                   const ConcaveEdge& b) const;
  template <class A, class B>
  void cut(const std::vector<CreaseCurve>& curves, const A& a, const B& b, CreaseCutter& cutter,
           std::vector<CreaseCurve>& out) const;

  [[nodiscard]] bool is_buried(const CreaseCurve& curve) const;
  [[nodiscard]] bool is_on_lips(const CreaseCurve& curve) const;
  [[nodiscard]] bool is_in_gap(Vec3d x) const;

  const ConcaveFeatures& features_;
  const SolidSurface& surface_;
  double r_, tolerance_, extent_;
  AreOneSurface are_one_surface_;
  BoxTree edge_tree_, corner_tree_;
};

}  // namespace arris
