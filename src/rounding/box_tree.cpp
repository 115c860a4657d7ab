#include "rounding/box_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace arris {
namespace {

constexpr std::size_t kLeafSize = 8;
// A box of this many times its triangle's area is worth splitting, into this many at most.
constexpr double kEmptyBox = 8;
constexpr int kMostParts = 16;

int longest_axis(Vec3d e) {
  return e.x >= e.y ? (e.x >= e.z ? 0 : 2) : (e.y >= e.z ? 1 : 2);
}

// Of the triangle between two planes across an axis.
Box box_between(const std::array<Vec3d, 3>& corners, int axis, double from, double to,
                std::uint32_t item) {
  Box box{Vec3d(std::numeric_limits<double>::infinity()),
          Vec3d(-std::numeric_limits<double>::infinity()), item};
  const auto include = [&](Vec3d p) {
    box.low = min(box.low, p);
    box.high = max(box.high, p);
  };
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3d p = corners[k], side = corners[(k + 1) % 3] - p;
    if (p[axis] >= from && p[axis] <= to) include(p);
    for (const double plane : {from, to}) {
      const double part = (plane - p[axis]) / side[axis];
      if (part > 0 && part < 1) include(p + side * part);
    }
  }
  return box;
}

}  // namespace

void append_triangle_boxes(const std::array<Vec3d, 3>& corners, double shortest, std::uint32_t item,
                           std::vector<Box>& boxes) {
  const Vec3d low = min(corners[0], min(corners[1], corners[2]));
  const Vec3d high = max(corners[0], max(corners[1], corners[2]));
  const Vec3d e = high - low;
  const int axis = longest_axis(e);
  const double area = 0.5 * length(cross(corners[1] - corners[0], corners[2] - corners[0]));
  const double box_area = e.x * e.y + e.y * e.z + e.z * e.x;
  const double wanted =
      std::min({box_area / (kEmptyBox * area), e[axis] / shortest, 1.0 * kMostParts});
  if (!(wanted >= 2)) {
    boxes.push_back({low, high, item});
    return;
  }
  const int count = int(wanted);
  const auto plane = [&](int k) {
    return k == count ? high[axis] : low[axis] + e[axis] * k / count;
  };
  for (int k = 0; k < count; ++k) {
    const Box part = box_between(corners, axis, plane(k), plane(k + 1), item);
    // What the crossings' rounding may lose.
    const Vec3d slack = e * 1e-12;
    boxes.push_back({part.low - slack, part.high + slack, item});
  }
}

BoxTree::BoxTree(std::vector<Box> boxes) {
  items_.reserve(boxes.size());
  if (!boxes.empty()) build(boxes);
}

std::vector<std::uint32_t> BoxTree::renumber() {
  constexpr std::uint32_t kNoNumber = 0xffffffff;
  std::vector<std::uint32_t> number(items_.size(), kNoNumber), old;
  for (std::uint32_t& item : items_) {
    if (number[item] == kNoNumber) {
      number[item] = std::uint32_t(old.size());
      old.push_back(item);
    }
    item = number[item];
  }
  return old;
}

bool BoxTree::reaches(const Node& node, const SlabBounds& slab) {
  const Vec3d& n = slab.normal;
  const double middle = dot(n, node.middle);
  const double half = dot(Vec3d(std::abs(n.x), std::abs(n.y), std::abs(n.z)), node.half);
  return middle + half >= slab.low && middle - half <= slab.high;
}

void BoxTree::build(std::span<Box> boxes) {
  Vec3d low(std::numeric_limits<double>::infinity());
  Vec3d high = -low;
  for (const Box& box : boxes) {
    low = min(low, box.low);
    high = max(high, box.high);
  }
  const std::size_t index = nodes_.size();
  nodes_.push_back({(low + high) * 0.5, (high - low) * 0.5});
  if (boxes.size() <= kLeafSize) {
    nodes_[index].first = std::uint32_t(items_.size());
    nodes_[index].count = std::uint32_t(boxes.size());
    for (const Box& box : boxes) items_.push_back(box.item);
  } else {
    const Vec3d e = high - low;
    const int axis = longest_axis(e);
    const std::size_t half = boxes.size() / 2;
    std::ranges::nth_element(boxes, boxes.begin() + std::ptrdiff_t(half), {},
                             [&](const Box& box) { return box.low[axis] + box.high[axis]; });
    build(boxes.first(half));
    build(boxes.subspan(half));
  }
  nodes_[index].next = std::uint32_t(nodes_.size());
}

}  // namespace arris
