#include "edgepoint/edge_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel_for.h"

namespace arris {
namespace {

using Part = EdgeTree::Part;

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// The plane of a face in the tree's coordinates, as the predicate has it: through the first corner.
struct FacePlane {
  Vec3d normal, point;
};

FacePlane plane_of(const EdgeMesh& mesh, std::uint32_t face, const UnitFrame& frame) {
  return {normalize(face_normal(mesh, face)),
          frame.unit_from_object(Vec3d(mesh.vertices[mesh.triangles[face][0]]))};
}

BoundsRecord record_of(const EdgeMesh& mesh, std::uint32_t edge, const UnitFrame& frame) {
  BoundsRecord r{FaceBounds::empty(), edge};
  for (const std::uint32_t face : {mesh.edges[edge].face0, mesh.edges[edge].face1}) {
    const FacePlane p = plane_of(mesh, face, frame);
    r.bounds.grow_normal(p.normal);
    r.bounds.grow_position(p.point);
  }
  return r;
}

constexpr std::size_t kGrain = 4096;

Part make_part(const EdgeMesh& mesh, std::span<const std::uint32_t> edges, const UnitFrame& frame) {
  Part part;
  if (edges.empty()) return part;
  std::vector<BoundsRecord> records(edges.size());
  parallel_for(edges.size(), {.grain = kGrain},
               [&](std::size_t i) { records[i] = record_of(mesh, edges[i], frame); });
  part.nodes = build_bounds_tree(records, SplitBy::normals_and_positions);
  part.edges.resize(edges.size());
  for (std::vector<float>& p : part.planes) p.resize(edges.size());
  parallel_for(edges.size(), {.grain = kGrain}, [&](std::size_t i) {
    const MeshEdge& e = mesh.edges[records[i].item];
    part.edges[i] = records[i].item;
    for (std::size_t side = 0; side < 2; ++side) {
      const FacePlane p = plane_of(mesh, side == 0 ? e.face0 : e.face1, frame);
      for (int k = 0; k < 3; ++k) part.planes[4 * side + std::size_t(k)][i] = float(p.normal[k]);
      part.planes[4 * side + 3][i] = float(dot(p.normal, p.point));
    }
  });
  return part;
}

constexpr std::size_t kAtOnce = 64;

// Lowest and highest sign of each of up to kAtOnce edges' faces over the viewpoints.
struct EdgeSigns {
  std::array<float, kAtOnce> low, high;
};

void find_signs(const Part& part, std::size_t first, std::size_t count,
                std::span<const UnitView> views, EdgeSigns& out) {
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

// Nodes that one thread goes through.
constexpr std::size_t kNodesAtOnce = 4096;

struct NodeRange {
  std::size_t first, last;
};

// Appends the edges wanted of a range of nodes, wherever it starts; `holds` decides of those too near zero.
template <class Predicate>
void find_in_range(const Part& part, NodeRange range, Wanted wanted,
                   std::span<const UnitView> views, const Predicate& holds,
                   std::vector<std::uint32_t>& found) {
  const UnitViewBounds bounds = bounds_of(views);
  EdgeSigns signs;
  const float too_low = wanted == Wanted::both_signs ? kSignMargin : kInfinity;
  const float low_enough = wanted == Wanted::both_signs ? -kSignMargin : kInfinity;
  for (std::size_t at = range.first; at < range.last;) {
    const BoundsNode& node = part.nodes[at];
    const SignBounds s = signs_in(node.bounds, bounds);
    if (s.low > too_low || s.high < -kSignMargin) {
      at += node.size;
      continue;
    }
    for (std::size_t done = 0; done < node.count; done += kAtOnce) {
      const std::size_t first = node.first + done, count = std::min(kAtOnce, node.count - done);
      find_signs(part, first, count, views, signs);
      for (std::size_t i = 0; i < count; ++i) {
        if (signs.low[i] > too_low || signs.high[i] < -kSignMargin) continue;
        const bool sure = signs.low[i] < low_enough && signs.high[i] > kSignMargin;
        const std::uint32_t edge = part.edges[first + i];
        if (sure || holds(edge)) found.push_back(edge);
      }
    }
    ++at;
  }
}

// Appends the edges wanted, of large trees on all cores.
template <class Predicate>
void find_in(const Part& part, Wanted wanted, std::span<const UnitView> views,
             const Predicate& holds, std::vector<std::uint32_t>& found) {
  const std::size_t count = (part.nodes.size() + kNodesAtOnce - 1) / kNodesAtOnce;
  if (count <= 1) {
    find_in_range(part, {0, part.nodes.size()}, wanted, views, holds, found);
    return;
  }
  std::vector<std::vector<std::uint32_t>> in_range(count);
  parallel_for(count, {}, [&](std::size_t i) {
    const NodeRange range{i * kNodesAtOnce, std::min((i + 1) * kNodesAtOnce, part.nodes.size())};
    find_in_range(part, range, wanted, views, holds, in_range[i]);
  });
  for (const std::vector<std::uint32_t>& edges : in_range) {
    found.insert(found.end(), edges.begin(), edges.end());
  }
}

}  // namespace

EdgeTree::EdgeTree(const EdgeMesh& mesh) : mesh_(&mesh), frame_(unit_frame(mesh)) {
  std::vector<std::uint32_t> smooth, sharp;
  smooth.reserve(mesh.edges.size());
  for (std::uint32_t e = 0; e < mesh.edges.size(); ++e) {
    (mesh.is_open(e) ? open_ : mesh.is_sharp(e) ? sharp : smooth).push_back(e);
  }
  smooth_ = make_part(mesh, smooth, frame_);
  sharp_ = make_part(mesh, sharp, frame_);
}

std::vector<std::uint32_t> EdgeTree::find_silhouettes(const HomogeneousPoint& from) const {
  const std::vector<UnitView> views = unit_views(frame_, std::span(&from, 1));
  const auto holds = [&](std::uint32_t e) { return is_silhouette(*mesh_, e, from); };
  std::vector<std::uint32_t> found = open_;
  find_in(smooth_, Wanted::both_signs, views, holds, found);
  find_in(sharp_, Wanted::both_signs, views, holds, found);
  return found;
}

std::vector<std::uint32_t> EdgeTree::find_drawn(const HomogeneousPoint& from) const {
  const std::vector<UnitView> views = unit_views(frame_, std::span(&from, 1));
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
  const std::vector<UnitView> views = unit_views(frame_, from);
  const auto holds = [&](std::uint32_t e) { return may_be_silhouette(*mesh_, e, from); };
  find_in(smooth_, Wanted::both_signs, views, holds, found);
  find_in(sharp_, Wanted::both_signs, views, holds, found);
  return found;
}

}  // namespace arris
