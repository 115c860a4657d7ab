#include "beam/uniform_rule.h"

#include <algorithm>

namespace arris {

// In order.
std::vector<UniformRule::Bare> UniformRule::cross_all(const std::vector<BeamPart>& parts,
                                                      const Ray& ray, const Reach& reach) {
  std::vector<Bare> all;
  const auto add = [&](const Bare& bare) {
    if (bare.t > reach.from && bare.t < reach.to) all.push_back(bare);
  };
  for (const BeamPart& part : parts) {
    const BeamShape& shape = *solids_[part.solid].shape;
    const Affine3d& m = solids_[part.solid].object_from_world;
    const Ray own{transform_point(m, ray.origin), transform_vector(m, ray.direction)};
    for (const std::uint32_t leaf : part.expression.leaves()) {
      if (const Facet* facet = shape.facet(leaf)) {
        if (const auto t = shape.meet(*facet, own)) add({*t, part.solid, leaf, 0});
        continue;
      }
      if (shape.volume(leaf) != nullptr) continue;
      const CsgSolid& csg = shape.csg();
      for (const Crossing& c : crossings_.find(csg.leaf(leaf), csg.surfaces(), own)) {
        add({c.t, part.solid, leaf, c.face});
      }
    }
  }
  std::ranges::stable_sort(all, {}, &Bare::t);
  return all;
}

bool UniformRule::are_alike(const std::vector<BeamPart>& parts, const std::array<Ray, 4>& rays,
                            const Reach& reach) {
  const std::vector<Bare> first = cross_all(parts, rays[0], reach);
  for (const BeamPart& part : parts) {
    for (const std::uint32_t leaf : part.expression.leaves()) {
      if (solids_[part.solid].shape->volume(leaf) != nullptr) continue;
      if (std::ranges::none_of(first, [&](const Bare& bare) {
            return bare.solid == part.solid && bare.leaf == leaf;
          })) {
        return false;
      }
    }
  }
  return std::ranges::all_of(std::span(rays).subspan(1),
                             [&](const Ray& ray) { return cross_all(parts, ray, reach) == first; });
}

}  // namespace arris
