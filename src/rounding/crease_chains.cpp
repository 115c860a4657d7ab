// crease_chains.cpp — rims of many pieces, on shells that aren't exact
// What       Border faces: a facet that touches the rim in a corner only has no edge there that could round it; the
//            arcs which meet in that corner do, and their bands are put on it.
//            Skipped edges: where a rim is rounded by more than a short piece bears, its arc turns over. In E that
//            edge has vanished, and its neighbours' arcs meet beyond it (an edge event of the offset outline). On
//            shells that aren't convex this is done where both neighbours share one face with it and a run of skipped
//            edges bends by less than kMostBend.
// Limits     border faces end at their own height, not on the cylinders, which may stand out there by the height of the
//            bend: clearance.h judges them as any face that goes on smoothly
// Tests      tests/rounding/chain_test.cpp
#include <algorithm>
#include <unordered_set>

#include "rounding/crease_network.h"

namespace arris {
namespace {

// Cosine of the angle by which two arcs may bend that meet beyond skipped edges.
constexpr double kMostBend = 0.7;
constexpr std::size_t kMostPieces = 256;

}  // namespace

// The rounded edge that follows when skipped ones are passed, the first of which is half_edge. Nothing if what is
// skipped does not lead on to one. Changes ring_.
std::optional<NetworkBuilder::RingEdge> NetworkBuilder::edge_beyond(
    std::uint32_t half_edge, std::vector<std::uint32_t>& passed) {
  std::uint32_t h = half_edge;
  for (std::size_t piece = 0; piece < kMostPieces; ++piece) {
    passed.push_back(h);
    collect_ring(mesh_.twin[h]);
    const RingEdge* next = nullptr;
    std::size_t rounded = 0;
    for (const RingEdge& edge : ring_) {
      if (!edge.rounded) continue;
      ++rounded;
      if (edge.half_edge != mesh_.twin[h]) next = &edge;
    }
    if (ring_open_ || rounded != 2 || next == nullptr) return std::nullopt;
    if (!skipped_[next->half_edge]) return *next;
    h = next->half_edge;
  }
  return std::nullopt;
}

// At a corner of skipped edges.
void NetworkBuilder::make_corner_beyond() {
  std::vector<RingEdge> arcs;
  std::vector<std::uint32_t> skipped;
  for (const RingEdge& edge : ring_) {
    if (!edge.rounded) continue;
    if (skipped_[edge.half_edge]) {
      skipped.push_back(edge.half_edge);
      end_of_[edge.half_edge] = kSkipped;
    } else {
      arcs.push_back(edge);
    }
  }
  if (skipped.size() == 2 && arcs.empty()) return;
  if (skipped.size() == 1 && arcs.size() == 1 && make_mitre_beyond(arcs[0], skipped[0])) return;
  for (const std::uint32_t h : skipped) edge_beyond(h, no_longer_skipped_);
  for (const RingEdge& arc : arcs) {
    collect_ring(arc.half_edge);
    make_cap(*std::ranges::find(ring_, arc.half_edge, &RingEdge::half_edge));
  }
}

// With the arc beyond the skipped half-edge. False if there is none that it meets.
bool NetworkBuilder::make_mitre_beyond(const RingEdge& edge, std::uint32_t skipped) {
  std::vector<std::uint32_t> passed;
  const std::optional<RingEdge> beyond = edge_beyond(skipped, passed);
  if (!beyond || beyond->half_edge == edge.half_edge || !make_mitre(edge, *beyond, passed)) {
    return false;
  }
  add_border_faces_beyond(edge, *beyond, passed);
  end_of_[mesh_.twin[passed.back()]] = kSkipped;
  return true;
}

// Both neighbours of the vanished arc end in mitres with it, share one of its faces, and go on in its direction.
bool NetworkBuilder::can_skip(const Vanished& arc) const {
  if (short_edges_ == ShortEdges::leave_sharp) return false;
  const std::vector<std::uint32_t>& mitred0 = ends_[end_of_[arc.first]].mitred;
  const std::vector<std::uint32_t>& mitred1 = ends_[end_of_[arc.back]].mitred;
  if (mitred0.empty() || mitred1.empty() || mitred0[0] == mitred1[0]) return false;
  const auto has_region = [&](std::uint32_t h, std::uint32_t region) {
    return regions_.region[h / 3] == region || regions_.region[mesh_.twin[h] / 3] == region;
  };
  const auto is_common = [&](std::uint32_t h) {
    const std::uint32_t region = regions_.region[h / 3];
    return has_region(mitred0[0], region) && has_region(mitred1[0], region);
  };
  if (is_common(arc.first) == is_common(mesh_.twin[arc.first])) return false;
  const auto direction = [&](std::uint32_t h) {
    return normalize(local(mesh_.target(h)) - local(mesh_.origin(h)));
  };
  return dot(direction(mitred0[0]), direction(mitred1[0])) < -kMostBend;
}

void NetworkBuilder::skip(std::uint32_t first) {
  for (const std::uint32_t h : pieces_of(first)) skipped_[h] = skipped_[mesh_.twin[h]] = true;
}

// Of neighbours that have vanished those go first that would at the smallest radius: the others get longer by it.
void NetworkBuilder::skip_or_leave_sharp(Refused& refused) {
  std::ranges::sort(vanished_, {}, &Vanished::limit);
  std::unordered_set<std::uint32_t> waiting;
  for (const Vanished& arc : vanished_) {
    if (waiting.contains(arc.first) || waiting.contains(arc.back)) continue;
    if (!can_skip(arc)) {
      refused.shortened.push_back(arc.first);
      continue;
    }
    skip(arc.first);
    refused.skips_changed = true;
    for (const std::uint32_t h : {arc.first, arc.back}) {
      waiting.insert(ends_[end_of_[h]].mitred[0]);
    }
  }
}

// The runs that no longer lead from one arc to another stay sharp.
void NetworkBuilder::leave_broken_runs_sharp(Refused& refused) {
  for (const std::uint32_t h : no_longer_skipped_) {
    if (!skipped_[h]) continue;
    skipped_[h] = skipped_[mesh_.twin[h]] = false;
    kinds_[h] = kinds_[mesh_.twin[h]] = EdgeKind::smooth;
    ++refused.no_longer_skipped;
  }
  no_longer_skipped_.clear();
}

// Faces at the corner in ring_ that lie between two arcs which meet in a mitre.
void NetworkBuilder::add_border_faces(const RingEdge& a, const RingEdge& b) {
  const Vec3d v = local(mesh_.origin(a.half_edge));
  bool after_a = false;  // counter-clockwise between a and b, or between b and a?
  // Twice around: the first time to know where it begins.
  for (std::size_t i = 0; i < 2 * ring_.size(); ++i) {
    const RingEdge& edge = ring_[i % ring_.size()];
    if (edge.half_edge == a.half_edge) after_a = true;
    if (edge.half_edge == b.half_edge) after_a = false;
    const std::uint32_t face = edge.face_after;
    const bool is_between = face != a.face_after && face != a.face_before && face != b.face_after &&
                            face != b.face_before;
    if (i < ring_.size() || !is_between) continue;
    borders_.push_back({a.half_edge, {face, after_a ? a.face_before : a.face_after, v, v, kNone}});
    borders_.push_back({b.half_edge, {face, after_a ? b.face_after : b.face_before, v, v, kNone}});
  }
}

// The same where they meet beyond skipped edges, which share one face.
void NetworkBuilder::add_border_faces_beyond(const RingEdge& a, const RingEdge& b,
                                             std::span<const std::uint32_t> passed) {
  const auto is_of = [](std::uint32_t face, const RingEdge& e) {
    return face == e.face_after || face == e.face_before;
  };
  const std::uint32_t common = is_of(a.face_after, b) ? a.face_after : a.face_before;
  const auto add = [&](std::uint32_t face, Vec3d v0, Vec3d v1) {
    if (is_of(face, a) || is_of(face, b)) return;
    for (const RingEdge& e : {a, b})
      borders_.push_back({e.half_edge, {face, common, v0, v1, kNone}});
  };
  const auto add_corner = [&](std::uint32_t half_edge) {
    collect_ring(half_edge);
    const Vec3d v = local(mesh_.origin(half_edge));
    for (const RingEdge& edge : ring_) {
      const bool has_edge = std::ranges::any_of(passed, [&](std::uint32_t h) {
        return regions_.region[h / 3] == edge.face_after ||
               regions_.region[mesh_.twin[h] / 3] == edge.face_after;
      });
      if (!has_edge) add(edge.face_after, v, v);
    }
  };
  add_corner(passed.front());
  for (const std::uint32_t h : passed) {
    const Vec3d v0 = local(mesh_.origin(h));
    const Vec3d v1 = local(mesh_.target(h));
    add(regions_.region[h / 3], v0, v1);
    add(regions_.region[mesh_.twin[h] / 3], v0, v1);
    add_corner(mesh_.twin[h]);
  }
  ++out_.rounded_edges;
}

// Once the arcs are known.
void NetworkBuilder::append_border_faces() {
  for (Border& border : borders_) {
    border.face.arc = ends_[end_of_[border.half_edge]].arc;
    if (border.face.arc != kNone) out_.border_faces.push_back(border.face);
  }
}

}  // namespace arris
