#include "edgepoint/bounds_tree.h"

#include <algorithm>
#include <limits>

#include "base/parallel_for.h"

namespace arris {
namespace {

constexpr std::size_t kParallelRecords = 1 << 14;
constexpr std::size_t kBins = 16;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

float normal_span(const FaceBounds& b) {
  return b.width(0) + b.width(1) + b.width(2);
}

// The chance of a node to be entered, about. Normals and positions: how much they vary, positions as seen from about
// half a mesh away. Positions: the surface of their box.
float extent(const FaceBounds& b, SplitBy by) {
  const float x = b.width(3), y = b.width(4), z = b.width(5);
  return by == SplitBy::positions ? x * y + y * z + z * x : normal_span(b) + x + y + z;
}

std::size_t leaf_size(SplitBy by) {
  return by == SplitBy::positions ? 4 : 16;
}

FaceBounds bounds_of(std::span<const BoundsRecord> records) {
  FaceBounds b = FaceBounds::empty();
  for (const BoundsRecord& r : records) b.grow(r.bounds);
  return b;
}

struct Bin {
  FaceBounds bounds = FaceBounds::empty();
  std::size_t count = 0;
};

// Where along an axis the middles of records lie, in kBins equal parts.
struct BinScale {
  float low = 0, per_unit = 0;

  [[nodiscard]] std::size_t bin(float at) const {
    const float k = (at - low) * per_unit;
    return std::size_t(std::clamp(k, 0.0F, float(kBins - 1)));
  }
};

struct Split {
  std::size_t axis = 0;
  std::size_t last_left = 0;  // bin
  BinScale scale;
  float cost = kInfinity;
};

std::array<BinScale, 6> scales_of(std::span<const BoundsRecord> records) {
  std::array<float, 6> low, high;
  low.fill(kInfinity);
  high.fill(-kInfinity);
  for (const BoundsRecord& r : records) {
    for (std::size_t axis = 0; axis < 6; ++axis) {
      const float m = r.bounds.twice_middle(axis);
      low[axis] = std::min(low[axis], m);
      high[axis] = std::max(high[axis], m);
    }
  }
  std::array<BinScale, 6> scales;
  for (std::size_t axis = 0; axis < 6; ++axis) {
    const float range = high[axis] - low[axis];
    // Where all lie in one place there is nothing to tell apart.
    scales[axis] = {low[axis], range > 1e-6F ? float(kBins) * 0.9999F / range : 0};
  }
  return scales;
}

// The best place between bins: where counts times extents come to least.
void improve_split(Split& best, std::size_t axis, const BinScale& scale,
                   const std::array<Bin, kBins>& bins, SplitBy by) {
  std::array<float, kBins> right_cost{};
  Bin right;
  for (std::size_t k = kBins - 1; k > 0; --k) {
    right.bounds.grow(bins[k].bounds);
    right.count += bins[k].count;
    right_cost[k - 1] =
        right.count == 0 ? kInfinity : float(right.count) * extent(right.bounds, by);
  }
  Bin left;
  for (std::size_t k = 0; k + 1 < kBins; ++k) {
    left.bounds.grow(bins[k].bounds);
    left.count += bins[k].count;
    if (left.count == 0) continue;
    const float cost = float(left.count) * extent(left.bounds, by) + right_cost[k];
    if (cost < best.cost) best = {axis, k, scale, cost};
  }
}

// The axes along which the edges vary most are worth looking at: two of them, found by the spread of their middles.
std::array<std::size_t, 2> promising_axes(const std::array<BinScale, 6>& scales, SplitBy by) {
  const auto spread = [&](std::size_t axis) {
    if (by == SplitBy::positions && axis < 3) return -1.0F;
    return scales[axis].per_unit > 0 ? 1 / scales[axis].per_unit : 0.0F;
  };
  std::array<std::size_t, 6> order{0, 1, 2, 3, 4, 5};
  std::ranges::stable_sort(order,
                           [&](std::size_t a, std::size_t b) { return spread(a) > spread(b); });
  return {order[0], order[1]};
}

Split find_split(std::span<const BoundsRecord> records, SplitBy by) {
  const std::array<BinScale, 6> scales = scales_of(records);
  Split best;
  const std::array<std::size_t, 2> axes = promising_axes(scales, by);
  std::array<std::array<Bin, kBins>, 2> bins;
  for (const BoundsRecord& r : records) {
    for (std::size_t i = 0; i < 2; ++i) {
      Bin& bin = bins[i][scales[axes[i]].bin(r.bounds.twice_middle(axes[i]))];
      bin.bounds.grow(r.bounds);
      ++bin.count;
    }
  }
  for (std::size_t i = 0; i < 2; ++i) {
    if (scales[axes[i]].per_unit > 0) improve_split(best, axes[i], scales[axes[i]], bins[i], by);
  }
  return best;
}

struct Range {
  std::size_t first, count;
};

// Appends the nodes of a range of records in depth-first order. Records move so that each node's own lie together.
void build(std::span<BoundsRecord> all, Range range, SplitBy by, std::vector<BoundsNode>& nodes) {
  const std::span<BoundsRecord> records = all.subspan(range.first, range.count);
  const std::size_t at = nodes.size();
  nodes.push_back({bounds_of(records), std::uint32_t(range.first), std::uint32_t(range.count), 1});
  if (records.size() <= leaf_size(by)) return;

  const float half = normal_span(nodes[at].bounds) / 2;
  const auto kept_end = std::partition(records.begin(), records.end(), [&](const BoundsRecord& r) {
    return by == SplitBy::normals_and_positions && normal_span(r.bounds) > half;
  });
  const auto kept = std::size_t(kept_end - records.begin());
  const std::span<BoundsRecord> rest = records.subspan(kept);
  if (rest.size() <= leaf_size(by)) return;
  const Split split = find_split(rest, by);
  std::size_t left = rest.size() / 2;  // all alike: any half will do
  if (split.cost < kInfinity) {
    const auto middle_at = std::partition(rest.begin(), rest.end(), [&](const BoundsRecord& r) {
      return split.scale.bin(r.bounds.twice_middle(split.axis)) <= split.last_left;
    });
    left = std::size_t(middle_at - rest.begin());
  }
  nodes[at].count = std::uint32_t(kept);
  const std::array<Range, 2> children{Range{range.first + kept, left},
                                      Range{range.first + kept + left, rest.size() - left}};
  if (rest.size() < kParallelRecords) {
    for (const Range& child : children) build(all, child, by, nodes);
  } else {
    std::array<std::vector<BoundsNode>, 2> below;
    parallel_for(2, {}, [&](std::size_t i) { build(all, children[i], by, below[i]); });
    for (const std::vector<BoundsNode>& b : below) nodes.insert(nodes.end(), b.begin(), b.end());
  }
  nodes[at].size = std::uint32_t(nodes.size() - at);
}

}  // namespace

std::vector<BoundsNode> build_bounds_tree(std::span<BoundsRecord> records, SplitBy by) {
  std::vector<BoundsNode> nodes;
  if (!records.empty()) build(records, {0, records.size()}, by, nodes);
  return nodes;
}

}  // namespace arris
