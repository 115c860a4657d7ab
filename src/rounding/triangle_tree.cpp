#include "rounding/triangle_tree.h"

#include <cmath>
#include <limits>

namespace arris {
namespace {

constexpr std::size_t kLeafSize = 8;

}  // namespace

TriangleTree::TriangleTree(const MeshView& mesh, std::span<const std::uint32_t> triangles,
                           Vec3d center) {
  std::vector<Item> items;
  items.reserve(triangles.size());
  for (const std::uint32_t t : triangles) {
    const auto corner = [&](std::size_t k) {
      return Vec3d(mesh.positions[mesh.triangles[t][k]]) - center;
    };
    items.push_back(
        {min(min(corner(0), corner(1)), corner(2)), max(max(corner(0), corner(1)), corner(2)), t});
  }
  triangles_.reserve(items.size());
  build(items);
}

bool TriangleTree::reaches(const Node& node, const Slab& slab) {
  const Vec3d& n = slab.normal;
  const double middle = dot(n, node.middle);
  const double half = dot(Vec3d(std::abs(n.x), std::abs(n.y), std::abs(n.z)), node.half);
  return middle + half >= slab.low && middle - half <= slab.high;
}

void TriangleTree::build(std::span<Item> items) {
  Vec3d low(std::numeric_limits<double>::infinity());
  Vec3d high = -low;
  for (const Item& item : items) {
    low = min(low, item.low);
    high = max(high, item.high);
  }
  const std::size_t index = nodes_.size();
  nodes_.push_back({(low + high) * 0.5, (high - low) * 0.5});
  if (items.size() <= kLeafSize) {
    nodes_[index].first = std::uint32_t(triangles_.size());
    nodes_[index].count = std::uint32_t(items.size());
    for (const Item& item : items) triangles_.push_back(item.triangle);
  } else {
    const Vec3d e = high - low;
    const int axis = e.x >= e.y ? (e.x >= e.z ? 0 : 2) : (e.y >= e.z ? 1 : 2);
    const std::size_t half = items.size() / 2;
    std::ranges::nth_element(items, items.begin() + std::ptrdiff_t(half), {},
                             [&](const Item& item) { return item.low[axis] + item.high[axis]; });
    build(items.first(half));
    build(items.subspan(half));
  }
  nodes_[index].next = std::uint32_t(nodes_.size());
}

}  // namespace arris
