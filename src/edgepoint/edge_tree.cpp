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

EdgeEnds ends_of(const EdgeMesh& mesh, std::uint32_t edge) {
  return {mesh.vertices[mesh.edges[edge].v0], mesh.vertices[mesh.edges[edge].v1]};
}

void grow(EdgeBox& box, const EdgeBox& other) {
  for (int k = 0; k < 3; ++k) {
    box.low[k] = std::min(box.low[k], other.low[k]);
    box.high[k] = std::max(box.high[k], other.high[k]);
  }
}

// From the last node to the first, so that children come before their parents.
std::vector<EdgeBox> make_boxes(const Part& part) {
  std::vector<EdgeBox> boxes(part.nodes.size());
  for (std::size_t i = boxes.size(); i-- > 0;) {
    const BoundsNode& node = part.nodes[i];
    EdgeBox box{Vec3f(kInfinity), Vec3f(-kInfinity)};
    for (std::size_t e = node.first; e < node.first + node.count; ++e) {
      grow(box, {part.ends[e].a, part.ends[e].a});
      grow(box, {part.ends[e].b, part.ends[e].b});
    }
    for (std::size_t child = i + 1; child < i + node.size; child += part.nodes[child].size) {
      grow(box, boxes[child]);
    }
    boxes[i] = box;
  }
  return boxes;
}

Part make_part(const EdgeMesh& mesh, std::span<const std::uint32_t> edges, const UnitFrame& frame) {
  Part part;
  if (edges.empty()) return part;
  std::vector<BoundsRecord> records(edges.size());
  parallel_for(edges.size(), {.grain = kGrain},
               [&](std::size_t i) { records[i] = record_of(mesh, edges[i], frame); });
  part.nodes = build_bounds_tree(records, SplitBy::normals_and_positions);
  part.edges.resize(edges.size());
  part.ends.resize(edges.size());
  for (std::vector<float>& p : part.planes) p.resize(edges.size());
  parallel_for(edges.size(), {.grain = kGrain}, [&](std::size_t i) {
    const MeshEdge& e = mesh.edges[records[i].item];
    part.edges[i] = records[i].item;
    part.ends[i] = ends_of(mesh, records[i].item);
    for (std::size_t side = 0; side < 2; ++side) {
      const FacePlane p = plane_of(mesh, side == 0 ? e.face0 : e.face1, frame);
      for (int k = 0; k < 3; ++k) part.planes[4 * side + std::size_t(k)][i] = float(p.normal[k]);
      part.planes[4 * side + 3][i] = float(dot(p.normal, p.point));
    }
  });
  part.boxes = make_boxes(part);
  return part;
}

// Large enough that little is looked at twice where the tree is cut, small enough for many threads.
constexpr std::uint32_t kShareEdges = 16'384;

void add_shares(const Part& part, EdgeGroup group, std::vector<EdgeShare>& shares) {
  std::uint32_t first = 0, edges = 0;
  const auto count = std::uint32_t(part.nodes.size());
  for (std::uint32_t i = 0; i < count; ++i) {
    edges += part.nodes[i].count;
    if (edges < kShareEdges && i + 1 < count) continue;
    shares.push_back({group, first, i + 1});
    first = i + 1;
    edges = 0;
  }
}

bool is_outside(const EdgeBox& box, std::span<const HalfSpace> within) {
  return std::ranges::any_of(within, [&](const HalfSpace& h) {
    double most = h.offset;
    for (int k = 0; k < 3; ++k) {
      most += std::max(h.direction[k] * double(box.low[k]), h.direction[k] * double(box.high[k]));
    }
    return most < 0;
  });
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

// What a query looks for: both signs (silhouettes), any front (sharp edges that are drawn), or all.
enum class Wanted { both_signs, front, all };

struct Search {
  Wanted wanted = Wanted::both_signs;
  std::span<const UnitView> views;
  std::span<const HalfSpace> within;
  std::size_t first = 0, last = 0;  // nodes
};

// Appends the places of the edges wanted; `holds` decides of those too near zero.
template <class Predicate>
void find_in(const Part& part, const Search& search, const Predicate& holds,
             std::vector<std::uint32_t>& places) {
  const UnitViewBounds bounds = bounds_of(search.views);
  EdgeSigns signs;
  const bool both = search.wanted == Wanted::both_signs;
  const float too_low = both ? kSignMargin : kInfinity;
  const float low_enough = both ? -kSignMargin : kInfinity;
  const float too_high = search.wanted == Wanted::all ? -kInfinity : -kSignMargin;
  const float high_enough = search.wanted == Wanted::all ? -kInfinity : kSignMargin;
  for (std::size_t at = search.first; at < search.last;) {
    const BoundsNode& node = part.nodes[at];
    const SignBounds s = signs_in(node.bounds, bounds);
    if (s.low > too_low || s.high < too_high || is_outside(part.boxes[at], search.within)) {
      at += node.size;
      continue;
    }
    for (std::size_t done = 0; done < node.count; done += kAtOnce) {
      const std::size_t first = node.first + done, count = std::min(kAtOnce, node.count - done);
      find_signs(part, first, count, search.views, signs);
      for (std::size_t i = 0; i < count; ++i) {
        if (signs.low[i] > too_low || signs.high[i] < too_high) continue;
        const bool sure = signs.low[i] < low_enough && signs.high[i] > high_enough;
        if (sure || holds(part.edges[first + i])) places.push_back(std::uint32_t(first + i));
      }
    }
    ++at;
  }
}

// Nodes that one thread goes through.
constexpr std::size_t kNodesAtOnce = 4096;

// Appends the edges that change sign between the views, of large trees on all cores.
template <class Predicate>
void find_changing(const Part& part, std::span<const UnitView> views, const Predicate& holds,
                   std::vector<std::uint32_t>& found) {
  const std::size_t nodes = part.nodes.size(), count = (nodes + kNodesAtOnce - 1) / kNodesAtOnce;
  std::vector<std::vector<std::uint32_t>> places(count);
  parallel_for(count, {}, [&](std::size_t i) {
    const std::size_t first = i * kNodesAtOnce, last = std::min(first + kNodesAtOnce, nodes);
    find_in(part, {Wanted::both_signs, views, {}, first, last}, holds, places[i]);
  });
  for (const std::vector<std::uint32_t>& some : places) {
    for (const std::uint32_t place : some) found.push_back(part.edges[place]);
  }
}

}  // namespace

EdgeTree::EdgeTree(const EdgeMesh& mesh) : mesh_(&mesh), frame_(unit_frame(mesh)) {
  std::vector<std::uint32_t> smooth, sharp;
  smooth.reserve(mesh.edges.size());
  for (std::uint32_t e = 0; e < mesh.edges.size(); ++e) {
    (mesh.is_open(e) ? open_.edges : mesh.is_sharp(e) ? sharp : smooth).push_back(e);
  }
  for (const std::uint32_t e : open_.edges) open_.ends.push_back(ends_of(mesh, e));
  smooth_ = make_part(mesh, smooth, frame_);
  sharp_ = make_part(mesh, sharp, frame_);
  const auto open = std::uint32_t(open_.edges.size());
  for (std::uint32_t first = 0; first < open; first += kShareEdges) {
    shares_.push_back({EdgeGroup::open, first, std::min(open, first + kShareEdges)});
  }
  add_shares(smooth_, EdgeGroup::smooth, shares_);
  add_shares(sharp_, EdgeGroup::sharp, shares_);
}

std::vector<std::uint32_t> EdgeTree::find_silhouettes(const HomogeneousPoint& from) const {
  const std::vector<UnitView> views = unit_views(frame_, std::span(&from, 1));
  const auto holds = [&](std::uint32_t e) { return is_silhouette(*mesh_, e, from); };
  std::vector<std::uint32_t> found = open_.edges;
  find_changing(smooth_, views, holds, found);
  find_changing(sharp_, views, holds, found);
  return found;
}

void EdgeTree::find_drawn(const EdgeShare& share, const DrawnQuery& query,
                          std::vector<std::uint32_t>& places) const {
  if (share.group == EdgeGroup::open) {
    for (std::uint32_t i = share.first; i < share.last; ++i) places.push_back(i);
    return;
  }
  const std::vector<UnitView> views = unit_views(frame_, std::span(&query.from, 1));
  const Wanted sharp = query.turned_away ? Wanted::all : Wanted::front;
  const Wanted wanted = share.group == EdgeGroup::sharp ? sharp : Wanted::both_signs;
  find_in(
      part(share.group), {wanted, views, query.within, share.first, share.last},
      [&](std::uint32_t e) { return is_drawn(*mesh_, e, query.from); }, places);
}

std::vector<std::uint32_t> EdgeTree::find_possible_silhouettes(
    std::span<const HomogeneousPoint> from) const {
  std::vector<std::uint32_t> found = open_.edges;
  if (from.empty()) return found;
  const std::vector<UnitView> views = unit_views(frame_, from);
  const auto holds = [&](std::uint32_t e) { return may_be_silhouette(*mesh_, e, from); };
  find_changing(smooth_, views, holds, found);
  find_changing(sharp_, views, holds, found);
  return found;
}

}  // namespace arris
