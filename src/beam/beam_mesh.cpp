#include "beam/beam_mesh.h"

#include <limits>
#include <map>
#include <tuple>
#include <utility>

namespace arris {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

using Place = std::tuple<double, double, double>;

Place place_of(Vec3d p) {
  return {p.x, p.y, p.z};
}

CsgExpression make_union(std::size_t count) {
  CsgTree tree;
  tree.nodes.push_back({CsgNode::kInner, CsgOperation::unite, {}});
  for (std::uint32_t i = 0; i < count; ++i) {
    tree.nodes[0].children.push_back(i + 1);
    tree.nodes.push_back({i, CsgOperation::unite, {}});
  }
  tree.leaves.resize(count);
  return CsgExpression(tree, std::vector<bool>(count, true));
}

}  // namespace

BeamMesh::BeamMesh(const std::vector<MeshTriangle>& triangles)
    : bounds_{Vec3d(kInfinity), Vec3d(-kInfinity)} {
  std::map<std::pair<Place, Place>, std::uint32_t> known;
  for (const auto& [corners, number] : triangles) {
    const Vec3d n = cross(corners[1] - corners[0], corners[2] - corners[0]);
    const double size = length(n);
    if (!(size > 0)) continue;
    Facet facet;
    facet.triangle = number;
    for (std::size_t k = 0; k < 3; ++k) {
      Vec3d a = corners[k], b = corners[(k + 1) % 3];
      facet.turned[k] = place_of(b) < place_of(a);
      if (facet.turned[k]) std::swap(a, b);
      const auto [at, is_new] =
          known.try_emplace({place_of(a), place_of(b)}, std::uint32_t(edges_.size()));
      if (is_new) edges_.push_back({a, b});
      facet.edges[k] = at->second;
    }
    facets_.push_back(facet);
    const Vec3d unit = n * (1 / size);
    planes_.push_back({unit, dot(unit, corners[0])});
    boxes_.push_back({min(corners[0], min(corners[1], corners[2])),
                      max(corners[0], max(corners[1], corners[2]))});
    bounds_ = hull(bounds_, boxes_.back());
  }
  root_ = make_union(facets_.size());
}

std::optional<double> BeamMesh::meet(std::uint32_t facet, const Ray& ray) const {
  const Facet& f = facets_[facet];
  const double slope = dot(planes_[facet].normal, ray.direction);
  for (std::size_t k = 0; k < 3; ++k) {
    const Edge& e = edges_[f.edges[k]];
    const double side = dot(ray.direction, cross(e.a - ray.origin, e.b - ray.origin));
    if ((f.turned[k] ? -side : side) * slope < 0) return std::nullopt;
  }
  const double t = (planes_[facet].d - dot(planes_[facet].normal, ray.origin)) / slope;
  if (!(t > 0 && t < kInfinity)) return std::nullopt;
  return t;
}

}  // namespace arris
