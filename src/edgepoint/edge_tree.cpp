#include "edgepoint/edge_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/parallel_for.h"

namespace arris {
namespace {

using Bounds = EdgeTree::Bounds;
using Node = EdgeTree::Node;
using Part = EdgeTree::Part;
using View = EdgeTree::View;

constexpr std::size_t kLeafEdges = 16;
constexpr std::size_t kParallelEdges = 1 << 14;
constexpr std::size_t kBins = 16;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

struct Record {
  Bounds bounds;
  std::uint32_t edge;
};

Bounds empty_bounds() {
  Bounds b;
  b.low.fill(kInfinity);
  return b;
}

void grow(Bounds& a, const Bounds& b) {
  for (std::size_t i = 0; i < 12; ++i) a.low[i] = std::min(a.low[i], b.low[i]);
}

float width(const Bounds& b, std::size_t axis) {
  return -b.low[axis + 6] - b.low[axis];
}

float normal_span(const Bounds& b) {
  return width(b, 0) + width(b, 1) + width(b, 2);
}

// The chance of a node to be entered, about: how much normals and positions (seen from about half a mesh away) vary.
float extent(const Bounds& b) {
  return normal_span(b) + width(b, 3) + width(b, 4) + width(b, 5);
}

// Twice the middle.
float middle(const Bounds& b, std::size_t axis) {
  return b.low[axis] - b.low[axis + 6];
}

Bounds bounds_of(std::span<const Record> records) {
  Bounds b = empty_bounds();
  for (const Record& r : records) grow(b, r.bounds);
  return b;
}

struct Bin {
  Bounds bounds = empty_bounds();
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

std::array<BinScale, 6> scales_of(std::span<const Record> records) {
  std::array<float, 6> low, high;
  low.fill(kInfinity);
  high.fill(-kInfinity);
  for (const Record& r : records) {
    for (std::size_t axis = 0; axis < 6; ++axis) {
      const float m = middle(r.bounds, axis);
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
                   const std::array<Bin, kBins>& bins) {
  std::array<float, kBins> right_cost{};
  Bin right;
  for (std::size_t k = kBins - 1; k > 0; --k) {
    grow(right.bounds, bins[k].bounds);
    right.count += bins[k].count;
    right_cost[k - 1] = right.count == 0 ? kInfinity : float(right.count) * extent(right.bounds);
  }
  Bin left;
  for (std::size_t k = 0; k + 1 < kBins; ++k) {
    grow(left.bounds, bins[k].bounds);
    left.count += bins[k].count;
    if (left.count == 0) continue;
    const float cost = float(left.count) * extent(left.bounds) + right_cost[k];
    if (cost < best.cost) best = {axis, k, scale, cost};
  }
}

// The axes along which the edges vary most are worth looking at: two of them, found by the spread of their middles.
std::array<std::size_t, 2> promising_axes(const std::array<BinScale, 6>& scales) {
  const auto spread = [&](std::size_t axis) {
    return scales[axis].per_unit > 0 ? 1 / scales[axis].per_unit : 0;
  };
  std::array<std::size_t, 6> order{0, 1, 2, 3, 4, 5};
  std::ranges::stable_sort(order,
                           [&](std::size_t a, std::size_t b) { return spread(a) > spread(b); });
  return {order[0], order[1]};
}

Split find_split(std::span<const Record> records) {
  const std::array<BinScale, 6> scales = scales_of(records);
  Split best;
  const std::array<std::size_t, 2> axes = promising_axes(scales);
  std::array<std::array<Bin, kBins>, 2> bins;
  for (const Record& r : records) {
    for (std::size_t i = 0; i < 2; ++i) {
      Bin& bin = bins[i][scales[axes[i]].bin(middle(r.bounds, axes[i]))];
      grow(bin.bounds, r.bounds);
      ++bin.count;
    }
  }
  for (std::size_t i = 0; i < 2; ++i) {
    if (scales[axes[i]].per_unit > 0) improve_split(best, axes[i], scales[axes[i]], bins[i]);
  }
  return best;
}

struct Range {
  std::size_t first, count;
};

// Appends the nodes of a range of records in depth-first order. Records move so that each node's own lie together.
void build(std::span<Record> all, Range range, std::vector<Node>& nodes) {
  const std::span<Record> records = all.subspan(range.first, range.count);
  const std::size_t at = nodes.size();
  nodes.push_back({bounds_of(records), std::uint32_t(range.first), std::uint32_t(range.count), 1});
  if (records.size() <= kLeafEdges) return;

  const float half = normal_span(nodes[at].bounds) / 2;
  const auto kept_end = std::partition(records.begin(), records.end(), [&](const Record& r) {
    return normal_span(r.bounds) > half;
  });
  const auto kept = std::size_t(kept_end - records.begin());
  const std::span<Record> rest = records.subspan(kept);
  if (rest.size() <= kLeafEdges) return;
  const Split split = find_split(rest);
  std::size_t left = rest.size() / 2;  // all alike: any half will do
  if (split.cost < kInfinity) {
    const auto middle_at = std::partition(rest.begin(), rest.end(), [&](const Record& r) {
      return split.scale.bin(middle(r.bounds, split.axis)) <= split.last_left;
    });
    left = std::size_t(middle_at - rest.begin());
  }
  nodes[at].count = std::uint32_t(kept);
  const std::array<Range, 2> children{Range{range.first + kept, left},
                                      Range{range.first + kept + left, rest.size() - left}};
  if (rest.size() < kParallelEdges) {
    for (const Range& child : children) build(all, child, nodes);
  } else {
    std::array<std::vector<Node>, 2> below;
    parallel_for(2, {}, [&](std::size_t i) { build(all, children[i], below[i]); });
    for (const std::vector<Node>& b : below) nodes.insert(nodes.end(), b.begin(), b.end());
  }
  nodes[at].size = std::uint32_t(nodes.size() - at);
}

// The plane of a face in the tree's coordinates, as the predicate has it: through the first corner.
struct FacePlane {
  Vec3d normal, point;
};

FacePlane plane_of(const EdgeMesh& mesh, std::uint32_t face, Vec3d center, double half_size) {
  return {normalize(face_normal(mesh, face)),
          (Vec3d(mesh.vertices[mesh.triangles[face][0]]) - center) / half_size};
}

Record record_of(const EdgeMesh& mesh, std::uint32_t edge, Vec3d center, double half_size) {
  Record r{empty_bounds(), edge};
  for (const std::uint32_t face : {mesh.edges[edge].face0, mesh.edges[edge].face1}) {
    const FacePlane p = plane_of(mesh, face, center, half_size);
    for (int i = 0; i < 3; ++i) {
      const auto k = std::size_t(i);
      const auto n = float(p.normal[i]), x = float(p.point[i]);
      r.bounds.low[k] = std::min(r.bounds.low[k], n);
      r.bounds.low[k + 3] = std::min(r.bounds.low[k + 3], x);
      r.bounds.low[k + 6] = std::min(r.bounds.low[k + 6], -n);
      r.bounds.low[k + 9] = std::min(r.bounds.low[k + 9], -x);
    }
  }
  return r;
}

constexpr std::size_t kGrain = 4096;

Part make_part(const EdgeMesh& mesh, std::span<const std::uint32_t> edges, Vec3d center,
               double half_size) {
  Part part;
  if (edges.empty()) return part;
  std::vector<Record> records(edges.size());
  parallel_for(edges.size(), {.grain = kGrain},
               [&](std::size_t i) { records[i] = record_of(mesh, edges[i], center, half_size); });
  build(records, {0, records.size()}, part.nodes);
  part.edges.resize(edges.size());
  for (std::vector<float>& p : part.planes) p.resize(edges.size());
  parallel_for(edges.size(), {.grain = kGrain}, [&](std::size_t i) {
    const MeshEdge& e = mesh.edges[records[i].edge];
    part.edges[i] = records[i].edge;
    for (std::size_t side = 0; side < 2; ++side) {
      const FacePlane p = plane_of(mesh, side == 0 ? e.face0 : e.face1, center, half_size);
      for (int k = 0; k < 3; ++k) part.planes[4 * side + std::size_t(k)][i] = float(p.normal[k]);
      part.planes[4 * side + 3][i] = float(dot(p.normal, p.point));
    }
  });
  return part;
}

// Bounds of the viewpoints: minima, and negated maxima of w (one for all).
struct ViewBounds {
  std::array<float, 3> low, high;
  float w_low, w_high;
};

ViewBounds bounds_of(std::span<const View> views) {
  ViewBounds b{views[0].xyz, views[0].xyz, views[0].w, views[0].w};
  for (const View& v : views) {
    for (std::size_t k = 0; k < 3; ++k) {
      b.low[k] = std::min(b.low[k], v.xyz[k]);
      b.high[k] = std::max(b.high[k], v.xyz[k]);
    }
    b.w_low = std::min(b.w_low, v.w);
    b.w_high = std::max(b.w_high, v.w);
  }
  return b;
}

struct Signs {
  float low, high;
};

// normal · (viewpoint − w position) over the node, in interval arithmetic (the margin stands for its rounding).
Signs signs_in(const Bounds& node, const ViewBounds& v) {
  Signs s{0, 0};
  for (std::size_t k = 0; k < 3; ++k) {
    const float n0 = node.low[k], n1 = -node.low[k + 6];
    const float p0 = node.low[k + 3], p1 = -node.low[k + 9];
    const float d0 = v.low[k] - std::max(v.w_low * p1, v.w_high * p1);
    const float d1 = v.high[k] - std::min(v.w_low * p0, v.w_high * p0);
    const float a = n0 * d0, b = n0 * d1, c = n1 * d0, d = n1 * d1;
    s.low += std::min(std::min(a, b), std::min(c, d));
    s.high += std::max(std::max(a, b), std::max(c, d));
  }
  return s;
}

constexpr std::size_t kAtOnce = 64;

// Lowest and highest sign of each of up to kAtOnce edges' faces over the viewpoints.
struct EdgeSigns {
  std::array<float, kAtOnce> low, high;
};

void find_signs(const Part& part, std::size_t first, std::size_t count, std::span<const View> views,
                EdgeSigns& out) {
  std::array<const float*, 8> p;
  for (std::size_t k = 0; k < 8; ++k) p[k] = part.planes[k].data() + first;
  for (std::size_t view = 0; view < views.size(); ++view) {
    const float x = views[view].xyz[0], y = views[view].xyz[1], z = views[view].xyz[2];
    const float w = views[view].w;
    float* const low = out.low.data();
    float* const high = out.high.data();
    if (view == 0) {
      for (std::size_t i = 0; i < count; ++i) {
        const float s0 = p[0][i] * x + p[1][i] * y + p[2][i] * z - p[3][i] * w;
        const float s1 = p[4][i] * x + p[5][i] * y + p[6][i] * z - p[7][i] * w;
        low[i] = std::min(s0, s1);
        high[i] = std::max(s0, s1);
      }
      continue;
    }
    for (std::size_t i = 0; i < count; ++i) {
      const float s0 = p[0][i] * x + p[1][i] * y + p[2][i] * z - p[3][i] * w;
      const float s1 = p[4][i] * x + p[5][i] * y + p[6][i] * z - p[7][i] * w;
      low[i] = std::min(low[i], std::min(s0, s1));
      high[i] = std::max(high[i], std::max(s0, s1));
    }
  }
}

// What a query looks for: both signs (silhouettes), or any front (sharp edges that are drawn).
enum class Wanted { both_signs, front };

// Appends the edges wanted; `holds` decides of those too near zero.
template <class Predicate>
void find_in(const Part& part, Wanted wanted, std::span<const View> views, const Predicate& holds,
             std::vector<std::uint32_t>& found) {
  const ViewBounds bounds = bounds_of(views);
  EdgeSigns signs;
  const float too_low = wanted == Wanted::both_signs ? kTreeMargin : kInfinity;
  const float low_enough = wanted == Wanted::both_signs ? -kTreeMargin : kInfinity;
  for (std::size_t at = 0; at < part.nodes.size();) {
    const Node& node = part.nodes[at];
    const Signs s = signs_in(node.bounds, bounds);
    if (s.low > too_low || s.high < -kTreeMargin) {
      at += node.size;
      continue;
    }
    for (std::size_t done = 0; done < node.count; done += kAtOnce) {
      const std::size_t first = node.first + done, count = std::min(kAtOnce, node.count - done);
      find_signs(part, first, count, views, signs);
      for (std::size_t i = 0; i < count; ++i) {
        if (signs.low[i] > too_low || signs.high[i] < -kTreeMargin) continue;
        const bool sure = signs.low[i] < low_enough && signs.high[i] > kTreeMargin;
        const std::uint32_t edge = part.edges[first + i];
        if (sure || holds(edge)) found.push_back(edge);
      }
    }
    ++at;
  }
}

}  // namespace

EdgeTree::EdgeTree(const EdgeMesh& mesh)
    : mesh_(&mesh), center_((mesh.bounds_min + mesh.bounds_max) * 0.5) {
  half_size_ = max_component(mesh.bounds_max - mesh.bounds_min) / 2;
  if (!(half_size_ > 0)) half_size_ = 1;
  std::vector<std::uint32_t> smooth, sharp;
  smooth.reserve(mesh.edges.size());
  for (std::uint32_t e = 0; e < mesh.edges.size(); ++e) {
    (mesh.is_open(e) ? open_ : mesh.is_sharp(e) ? sharp : smooth).push_back(e);
  }
  smooth_ = make_part(mesh, smooth, center_, half_size_);
  sharp_ = make_part(mesh, sharp, center_, half_size_);
}

std::vector<View> EdgeTree::views_of(std::span<const HomogeneousPoint> from) const {
  double size = 0;
  for (const HomogeneousPoint& p : from) {
    const Vec3d v = (p.xyz - center_ * p.w) / half_size_;
    size = std::max({size, std::abs(v.x), std::abs(v.y), std::abs(v.z), p.w});
  }
  if (!(size > 0)) size = 1;
  std::vector<View> views;
  for (const HomogeneousPoint& p : from) {
    const Vec3d v = (p.xyz - center_ * p.w) / (half_size_ * size);
    views.push_back({{float(v.x), float(v.y), float(v.z)}, float(p.w / size)});
  }
  return views;
}

std::vector<std::uint32_t> EdgeTree::find_silhouettes(const HomogeneousPoint& from) const {
  const std::vector<View> views = views_of(std::span(&from, 1));
  const auto holds = [&](std::uint32_t e) { return is_silhouette(*mesh_, e, from); };
  std::vector<std::uint32_t> found = open_;
  find_in(smooth_, Wanted::both_signs, views, holds, found);
  find_in(sharp_, Wanted::both_signs, views, holds, found);
  return found;
}

std::vector<std::uint32_t> EdgeTree::find_drawn(const HomogeneousPoint& from) const {
  const std::vector<View> views = views_of(std::span(&from, 1));
  const auto holds = [&](std::uint32_t e) { return is_drawn(*mesh_, e, from); };
  std::vector<std::uint32_t> found = open_;
  find_in(smooth_, Wanted::both_signs, views, holds, found);
  find_in(sharp_, Wanted::front, views, holds, found);
  return found;
}

std::vector<std::uint32_t> EdgeTree::find_possible_silhouettes(
    std::span<const HomogeneousPoint> from) const {
  std::vector<std::uint32_t> found = open_;
  if (from.empty()) return found;
  const std::vector<View> views = views_of(from);
  const auto holds = [&](std::uint32_t e) { return may_be_silhouette(*mesh_, e, from); };
  find_in(smooth_, Wanted::both_signs, views, holds, found);
  find_in(sharp_, Wanted::both_signs, views, holds, found);
  return found;
}

std::uint64_t EdgeTree::bytes() const {
  std::uint64_t total = open_.size() * sizeof(std::uint32_t);
  for (const Part* part : {&smooth_, &sharp_}) {
    total += part->nodes.size() * sizeof(Node) + part->edges.size() * (sizeof(std::uint32_t) + 32);
  }
  return total;
}

}  // namespace arris
