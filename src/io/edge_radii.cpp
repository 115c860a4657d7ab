#include "io/edge_radii.h"

#include <algorithm>
#include <utility>

namespace arris {
namespace {

EdgeRadius make_edge_radius(std::uint32_t a, std::uint32_t b, float radius) {
  return {{std::min(a, b), std::max(a, b)}, radius};
}

}  // namespace

void EdgeRadii::add_edge(std::uint32_t a, std::uint32_t b, float radius) {
  edges_.push_back(make_edge_radius(a, b, radius));
}

void EdgeRadii::add_side(std::uint32_t a, std::uint32_t b, std::span<const float> vertex_radii) {
  if (a == b || !(vertex_radii[a] >= 0 && vertex_radii[b] >= 0)) return;
  sides_.push_back(make_edge_radius(a, b, std::min(vertex_radii[a], vertex_radii[b])));
}

std::vector<EdgeRadius> EdgeRadii::take() {
  std::vector<EdgeRadius> all = std::move(edges_);
  std::reverse(all.begin(), all.end());
  all.insert(all.end(), sides_.begin(), sides_.end());
  sides_ = {};
  // The first of each edge counts.
  std::stable_sort(all.begin(), all.end(), [](const EdgeRadius& a, const EdgeRadius& b) {
    return a.vertices < b.vertices;
  });
  const auto end = std::unique(
      all.begin(), all.end(),
      [](const EdgeRadius& a, const EdgeRadius& b) { return a.vertices == b.vertices; });
  all.erase(end, all.end());
  std::erase_if(all, [](const EdgeRadius& edge) { return !(edge.radius >= 0); });
  return all;
}

}  // namespace arris
