#include "beam/ray_sight.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace arris {
namespace {

// Crossings nearer to each other than this part of their distance are one: facets and faces on one plane.
constexpr double kOneCrossing = 1e-12;

struct Toggle {
  double t = 0;
  std::uint32_t slot = 0, face = 0;
};

// Of one part: the expression's leaves toggled along the ray from a depth on.
class PartSight {
 public:
  PartSight(std::uint32_t index, const BeamShape& shape, const CsgExpression& expression,
            double from)
      : index_(index), shape_(shape), expression_(expression), from_(from) {}

  std::optional<RaySight> find(const Ray& ray) {
    inside_.assign(expression_.leaves().size(), 0);
    for (std::uint32_t slot = 0; slot < inside_.size(); ++slot) collect(slot, ray);
    std::ranges::sort(toggles_, [](const Toggle& a, const Toggle& b) {
      return a.t != b.t ? a.t < b.t : a.slot < b.slot;
    });
    const bool start = value();
    for (std::size_t i = 0; i < toggles_.size();) {
      const double t = toggles_[i].t;
      std::optional<Toggle> decider;
      bool before = start;
      for (; i < toggles_.size() && toggles_[i].t <= t * (1 + kOneCrossing); ++i) {
        inside_[toggles_[i].slot] ^= 1U;
        const bool now = value();
        if (now != before) decider = toggles_[i];
        before = now;
      }
      if (before != start) return RaySight{name(*decider, before), t};
    }
    return std::nullopt;
  }

 private:
  void collect(std::uint32_t slot, const Ray& ray) {
    const std::uint32_t leaf = expression_.leaves()[slot];
    if (const Facet* facet = shape_.facet(leaf)) {
      const std::optional<double> t = shape_.meet(*facet, ray);
      if (t && *t > from_) toggles_.push_back({*t, slot, 0});
      return;
    }
    if (const ClosedMesh* volume = shape_.volume(leaf)) {
      inside_[slot] = volume->contains(ray.origin + ray.direction * from_) ? 1 : 0;
      return;
    }
    thread_local LeafCrossings crossings;
    const CsgSolid& csg = shape_.csg();
    for (const Crossing& c : crossings.find(csg.leaf(leaf), csg.surfaces(), ray)) {
      if (c.t <= from_) {
        inside_[slot] ^= 1U;
      } else if (std::isfinite(c.t)) {
        toggles_.push_back({c.t, slot, c.face});
      }
    }
  }
  [[nodiscard]] bool value() const {
    return expression_.eval([&](std::uint32_t slot) { return inside_[slot] != 0; });
  }
  [[nodiscard]] SeenSurface name(const Toggle& toggle, bool entering) const {
    const std::uint32_t leaf = expression_.leaves()[toggle.slot];
    SeenSurface seen{index_, leaf, toggle.face, {}, entering};
    if (const ConvexLeaf* convex = shape_.convex(leaf)) {
      const bool is_plane = toggle.face < convex->planes.size();
      const bool leaves = inside_[toggle.slot] == 0;  // after it
      seen.surface = {index_, is_plane ? convex->planes[toggle.face].plane : *convex->quadric,
                      is_plane ? BeamSurface::Root::none
                      : leaves ? BeamSurface::Root::farther
                               : BeamSurface::Root::nearer};
    } else if (const Facet* facet = shape_.facet(leaf)) {
      seen.surface = {index_, facet->plane.plane, BeamSurface::Root::none};
    }
    if (shape_.is_whole(leaf)) {
      seen.face = kAnyFace;
      seen.surface = {index_, leaf, BeamSurface::Root::whole};
    }
    return seen;
  }

  std::uint32_t index_;
  const BeamShape& shape_;
  const CsgExpression& expression_;
  double from_;
  std::vector<std::uint8_t> inside_;
  std::vector<Toggle> toggles_;
};

}  // namespace

std::optional<RaySight> see(std::span<const BeamSolid> solids, const std::vector<BeamPart>& parts,
                            const Ray& world, double from) {
  std::optional<RaySight> first;
  for (const BeamPart& part : parts) {
    const BeamSolid& solid = solids[part.solid];
    const Ray ray{transform_point(solid.object_from_world, world.origin),
                  transform_vector(solid.object_from_world, world.direction)};
    const std::optional<RaySight> sight =
        PartSight(part.solid, *solid.shape, part.expression, from).find(ray);
    if (sight && (!first || sight->depth < first->depth)) first = sight;
  }
  return first;
}

}  // namespace arris
