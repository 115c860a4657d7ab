#include "rounding/crease_network.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "rounding/corner.h"

namespace arris {
namespace {

// Cosine between an edge and the normal of a face across it, from which on the edge runs into it or ends at it.
constexpr double kFacing = 0.3;

// An arc no longer than this (relative to the shell) has vanished.
constexpr double kLengthTolerance = 1e-6;

// Leaving an edge sharp changes its neighbours' ends. A shell that isn't settled after so many rounds stays sharp.
constexpr int kMaxRounds = 64;

// Where two cylinders meet at an edge that stays sharp, it may lie beside the plane in which they meet by so much,
// relative to how far from it they touch the faces.
constexpr double kMitreLeeway = 0.25;

}  // namespace

NetworkBuilder::NetworkBuilder(const WeldedMesh& mesh, const FlatRegions& regions,
                               std::vector<EdgeKind>& kinds, double radius, ShortEdges short_edges)
    : mesh_(mesh),
      regions_(regions),
      kinds_(kinds),
      radius_(radius),
      short_edges_(short_edges),
      end_of_(mesh.triangles.size() * 3, kUnset),
      capped_(mesh.triangles.size() * 3, false),
      skipped_(mesh.triangles.size() * 3, false) {}

ShellNetwork NetworkBuilder::build(std::uint32_t shell, bool convex) {
  std::uint64_t shortened = 0;
  std::uint64_t narrow = 0;
  std::vector<std::uint32_t> left;
  std::optional<Clearance> clearance;
  if (!convex) clearance.emplace(mesh_, regions_, shell, radius_);
  for (int round = 0;; ++round) {
    Refused refused;
    ShellNetwork network = build_once(shell, convex, refused);
    if (clearance) check_cuts(*clearance, refused);
    if (!refused.any()) {
      network.shortened_edges = shortened;
      network.narrow_edges = narrow;
      network.left_sharp = std::move(left);
      return network;
    }
    if (clearance) clearance->remember(cuts_);
    // Leave those edges sharp and look at their corners again.
    shortened += refused.shortened.size() + refused.no_longer_skipped;
    narrow += refused.narrow.size();
    for (const std::uint32_t first : refused.shortened) leave_sharp(first, left);
    for (const std::uint32_t first : refused.narrow) leave_sharp(first, left);
    if (round == kMaxRounds) {
      narrow += network.rounded_edges - refused.shortened.size() - refused.narrow.size();
      leave_all_sharp(shell, left);
    }
    forget_ends(shell);
  }
}

// The half-edges of the chain that starts with `first`.
std::vector<std::uint32_t> NetworkBuilder::pieces_of(std::uint32_t first) const {
  std::vector<std::uint32_t> pieces = {first};
  for (;;) {
    std::uint32_t n = WeldedMesh::next(pieces.back());
    while (kinds_[n] == EdgeKind::flat) n = WeldedMesh::next(mesh_.twin[n]);
    if (end_of_[n] != kThrough || n == first) return pieces;
    pieces.push_back(n);
  }
}

void NetworkBuilder::leave_sharp(std::uint32_t first, std::vector<std::uint32_t>& left) {
  for (const std::uint32_t h : pieces_of(first)) {
    left.push_back(h);
    kinds_[h] = kinds_[mesh_.twin[h]] = EdgeKind::smooth;
  }
}

void NetworkBuilder::leave_all_sharp(std::uint32_t shell, std::vector<std::uint32_t>& left) {
  for (std::uint32_t i = 0; i < mesh_.shells[shell].triangle_count; ++i) {
    const std::uint32_t t = mesh_.triangles_by_shell[mesh_.shells[shell].first_triangle + i];
    for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
      if (kinds_[h] != EdgeKind::convex) continue;
      kinds_[h] = EdgeKind::smooth;
      if (h < mesh_.twin[h]) left.push_back(h);
    }
  }
}

void NetworkBuilder::forget_ends(std::uint32_t shell) {
  for (std::uint32_t i = 0; i < mesh_.shells[shell].triangle_count; ++i) {
    const std::uint32_t t = mesh_.triangles_by_shell[mesh_.shells[shell].first_triangle + i];
    for (std::uint32_t k = 0; k < 3; ++k) end_of_[3 * t + k] = kUnset;
  }
}

ShellNetwork NetworkBuilder::build_once(std::uint32_t shell_index, bool convex, Refused& refused) {
  const Shell& shell = mesh_.shells[shell_index];
  center_ = shell.center();
  size_ = shell.size();
  convex_ = convex;
  out_ = {};
  ends_.clear();
  cuts_.clear();
  borders_.clear();
  vanished_.clear();
  const auto first = mesh_.triangles_by_shell.begin() + shell.first_triangle;
  const auto last = first + shell.triangle_count;
  for (auto t = first; t != last; ++t) {
    for (std::uint32_t h = 3 * *t; h < 3 * *t + 3; ++h) {
      if (kinds_[h] != EdgeKind::convex || end_of_[h] != kUnset) continue;
      collect_ring(h);
      make_corner();
    }
  }
  for (auto t = first; t != last; ++t) {
    for (std::uint32_t h = 3 * *t; h < 3 * *t + 3; ++h) {
      const bool begins_arc = end_of_[h] != kThrough && end_of_[h] != kSkipped;
      if (kinds_[h] == EdgeKind::convex && begins_arc) make_arc(h);
    }
  }
  leave_broken_runs_sharp(refused);
  skip_or_leave_sharp(refused);
  append_border_faces();
  return std::move(out_);
}

void NetworkBuilder::check_cuts(Clearance& clearance, Refused& refused) {
  const std::vector<std::uint32_t> in_surface = clearance.find_in_surface(cuts_);
  for (const std::uint32_t i : in_surface) {
    if (!cuts_[i].is_corner) refused.narrow.push_back(cuts_[i].half_edge);
  }
  // A corner of an edge that is going to stay sharp changes.
  if (refused.any()) return;
  for (const std::uint32_t i : in_surface) leave_without_spheres(cuts_[i], refused);
  if (refused.any()) return;
  for (const std::uint32_t i : clearance.find_overlapping(cuts_)) {
    if (cuts_[i].is_corner) {
      leave_without_spheres(cuts_[i], refused);
    } else {
      refused.narrow.push_back(cuts_[i].half_edge);
    }
  }
}

void NetworkBuilder::leave_without_spheres(const Cut& corner, Refused& refused) {
  refused.corners.push_back(corner.half_edge);
  collect_ring(corner.half_edge);
  for (const RingEdge& edge : ring_) capped_[edge.half_edge] = true;
}

// What an arc of the mesh takes away. False if its ends leave nothing of the edge.
bool NetworkBuilder::add_cut(const NetworkArc& arc, const End& end0, const End& end1) {
  const Plane& a = regions_.planes[arc.arc.face_a];
  const Plane& b = regions_.planes[arc.arc.face_b];
  const Vec3d axis = normalize(cross(a.normal, b.normal));
  // Lines along the axis: the edge, and where the cylinder touches the faces.
  const std::array<Vec3d, 3> lines = {arc.v0, end0.point + a.normal * radius_,
                                      end0.point + b.normal * radius_};
  const Vec3d across = lines[1] - lines[0];
  const double setback = length(across - axis * dot(across, axis));
  Cut cut;
  cut.half_edge = arc.half_edge0;
  cut.ends = {mesh_.origin(arc.half_edge0), mesh_.origin(arc.half_edge1)};
  cut.mitred = end0.mitred;
  cut.mitred.insert(cut.mitred.end(), end1.mitred.begin(), end1.mitred.end());
  const Vec3d out = normalize(a.normal + b.normal);
  cut.planes.reserve(5);
  cut.planes.assign({{a.normal, a.d, arc.arc.face_a},
                     {b.normal, b.d, arc.arc.face_b},
                     {-out, -dot(out, lines[1])}});
  std::array<std::array<Vec3d, 3>, 2> at;
  for (const auto& [end, points] : {std::pair(&end0, &at[0]), std::pair(&end1, &at[1])}) {
    const Vec3d n = end->plane_normal;
    const double leeway = !end->mitred.empty() ? kMitreLeeway * setback : 0;
    cut.planes.push_back({-n, -dot(n, end->plane_point), kNone, leeway});
    for (std::size_t i = 0; i < 3; ++i) {
      (*points)[i] = lines[i] + axis * (dot(n, end->plane_point - lines[i]) / dot(n, axis));
    }
  }
  if (dot(at[1][0] - at[0][0], axis) <= kLengthTolerance * size_) return false;
  const double beyond = size_ + radius_;
  cut.outline.reserve(9);
  cut.axes = {{end0.point - axis * beyond, end1.point + axis * beyond}};
  for (std::size_t i = 0; i < 3; ++i) {
    cut.outline.push_back({at[0][i], at[1][i]});
    cut.outline.push_back({at[0][i], at[0][(i + 1) % 3]});
    cut.outline.push_back({at[1][i], at[1][(i + 1) % 3]});
  }
  cuts_.push_back(std::move(cut));
  return true;
}

// What the spheres of the corner in ring_ take away.
void NetworkBuilder::add_corner_cut(const CornerErosion& erosion) {
  const Vec3d v = local(mesh_.origin(ring_[0].half_edge));
  Cut cut;
  cut.is_corner = true;
  cut.half_edge = ring_[0].half_edge;
  cut.ends = {mesh_.origin(cut.half_edge), mesh_.origin(cut.half_edge)};
  cut.planes.reserve(2 * ring_.size());
  cut.outline.reserve(3 * ring_.size() + 2 * erosion.short_arcs.size());
  for (std::size_t i = 0; i < ring_.size(); ++i) {
    const RingEdge& edge = ring_[i];
    const Plane& plane = regions_.planes[edge.face_after];
    cut.planes.push_back({plane.normal, plane.d, edge.face_after});
    const Vec3d direction = outgoing_direction(edge);
    const Vec3d node = erosion.nodes[erosion.node_of_edge[i]];
    cut.planes.push_back({direction, dot(direction, node), kNone});
    const Vec3d foot = v + direction * dot(direction, node - v);
    cut.outline.push_back({v, foot});
    for (const std::uint32_t face : {edge.face_before, edge.face_after}) {
      cut.outline.push_back({foot, node + regions_.planes[face].normal * radius_});
    }
  }
  for (const Vec3d& node : erosion.nodes) cut.axes.push_back({node, node});
  for (const CornerErosion::ShortArc& s : erosion.short_arcs) {
    const Segment axis{erosion.nodes[s.node0], erosion.nodes[s.node1]};
    cut.axes.push_back(axis);
    for (const std::uint32_t face : {ring_[s.face_a].face_after, ring_[s.face_b].face_after}) {
      const Vec3d up = regions_.planes[face].normal * radius_;
      cut.outline.push_back({axis.p0 + up, axis.p1 + up});
    }
  }
  cuts_.push_back(std::move(cut));
}

Vec3d NetworkBuilder::local(std::uint32_t vertex) const {
  return Vec3d(mesh_.vertices[vertex]) - center_;
}

std::uint32_t NetworkBuilder::add_node(const NetworkNode& node) {
  out_.nodes.push_back(node);
  return std::uint32_t(out_.nodes.size() - 1);
}

std::uint32_t NetworkBuilder::set_end(std::uint32_t half_edge, const End& end) {
  ends_.push_back(end);
  return end_of_[half_edge] = std::uint32_t(ends_.size() - 1);
}

// Edges between different faces around the origin of half_edge, counter-clockwise.
void NetworkBuilder::collect_ring(std::uint32_t half_edge) {
  // Back to the border, if there is one.
  std::uint32_t start = half_edge;
  ring_open_ = ring_irregular_ = false;
  while (mesh_.twin[start] <= kLastHalfEdge) {
    start = WeldedMesh::next(mesh_.twin[start]);
    if (start == half_edge) break;
  }
  ring_open_ = mesh_.twin[start] > kLastHalfEdge;
  ring_.clear();
  std::uint32_t h = start;
  do {
    if (mesh_.twin[h] <= kLastHalfEdge && kinds_[h] != EdgeKind::flat) {
      ring_.push_back({h, regions_.region[mesh_.twin[h] / 3], regions_.region[h / 3],
                       kinds_[h] == EdgeKind::convex});
      ring_irregular_ = ring_irregular_ || kinds_[h] == EdgeKind::concave;
    }
    const std::uint32_t back = WeldedMesh::previous(h);
    if (mesh_.twin[back] > kLastHalfEdge) break;
    h = mesh_.twin[back];
  } while (h != start);
}

// From the corner along the edge.
Vec3d NetworkBuilder::outgoing_direction(const RingEdge& edge) const {
  // The half-edge runs along n_after × n_before where the edge is convex.
  return normalize(
      cross(regions_.planes[edge.face_after].normal, regions_.planes[edge.face_before].normal));
}

ArcLine NetworkBuilder::arc_line(Vec3d p0, Vec3d p1, std::uint32_t face_a,
                                 std::uint32_t face_b) const {
  return make_arc_line(p0, p1, regions_.planes[face_a].normal, regions_.planes[face_b].normal);
}

Vec3d NetworkBuilder::axis_point(std::uint32_t face_a, std::uint32_t face_b, Vec3d near) const {
  return nearest_on_offset_line(regions_.planes[face_a], regions_.planes[face_b], radius_, near);
}

void NetworkBuilder::make_corner() {
  std::vector<const RingEdge*> rounded;
  for (const RingEdge& edge : ring_) {
    if (edge.rounded) rounded.push_back(&edge);
  }
  if (!ring_open_ && ring_.size() == 2 && rounded.size() == 2) {
    for (const RingEdge* edge : rounded) end_of_[edge->half_edge] = kThrough;
    return;
  }
  if (std::ranges::any_of(rounded, [&](const RingEdge* e) { return skipped_[e->half_edge]; })) {
    make_corner_beyond();
    return;
  }
  if (rounded.size() == 2 && make_mitre(*rounded[0], *rounded[1])) {
    add_border_faces(*rounded[0], *rounded[1]);
    return;
  }
  if (rounded.size() > 2 && !ring_open_ && !ring_irregular_ && !capped_[ring_[0].half_edge]) {
    make_spheres();
    return;
  }
  for (const RingEdge* edge : rounded) make_cap(*edge);
}

void NetworkBuilder::make_cap(const RingEdge& edge) {
  const Vec3d v = local(mesh_.origin(edge.half_edge));
  const Vec3d direction = outgoing_direction(edge);
  NetworkNode node;
  node.kind = Node::Kind::cap;
  node.position = axis_point(edge.face_before, edge.face_after, v);
  if (ring_irregular_) {
    // The face that the edge runs into, if there is one that faces it.
    double best = kFacing;
    for (const RingEdge& other : ring_) {
      for (const std::uint32_t face : {other.face_before, other.face_after}) {
        const Plane& plane = regions_.planes[face];
        const double facing = dot(plane.normal, direction);
        if (face == edge.face_before || face == edge.face_after || facing <= best) continue;
        best = facing;
        node.wall = face;
        node.position += direction * ((plane.d - dot(plane.normal, node.position)) / facing);
      }
    }
  }
  Vec3d inward = direction;
  if (node.wall == kNone) {
    node.position += direction * cap_shift(edge);
  } else {
    inward = regions_.planes[node.wall].normal;
  }
  set_end(edge.half_edge, {add_node(node), node.position, node.position, inward});
}

// By which the end of a rounding without a wall is moved in: it must touch its faces beside the corner, not past their
// next edges, and where the edge ends in the open, stop short of that.
double NetworkBuilder::cap_shift(const RingEdge& edge) const {
  const Vec3d n0 = regions_.planes[edge.face_before].normal;
  const Vec3d n1 = regions_.planes[edge.face_after].normal;
  const double setback = radius_ * length(cross(n0, n1)) / (1 + dot(n0, n1));  // r tan(φ/2)
  const Vec3d direction = outgoing_direction(edge);
  const Vec3d v = local(mesh_.origin(edge.half_edge));
  const std::size_t i = std::size_t(&edge - ring_.data());
  const std::size_t count = ring_.size();
  double cotangent = 0;
  for (const std::size_t other : {(i + 1) % count, (i + count - 1) % count}) {
    const Vec3d before = regions_.planes[ring_[other].face_before].normal;
    const Vec3d after = regions_.planes[ring_[other].face_after].normal;
    const double turned = setback * length(cross(before, after));  // as in clearance.cpp
    if (other == i || turned < kSmoothDepthAtEnd * radius_ * dot(before, after)) continue;
    const Vec3d u = normalize(local(mesh_.target(ring_[other].half_edge)) - v);
    const double cosine = dot(u, direction);
    const double sine = length(cross(u, direction));
    if (cosine > 0) cotangent = std::max(cotangent, sine > 0 ? cosine / sine : 1e30);
  }
  for (const RingEdge& other : ring_) {
    for (const std::uint32_t face : {other.face_before, other.face_after}) {
      const bool ends_here = dot(regions_.planes[face].normal, direction) < -kFacing;
      if (face != edge.face_before && face != edge.face_after && ends_here) {
        cotangent = std::max(cotangent, 1.0);
      }
    }
  }
  return setback * cotangent;
}

bool NetworkBuilder::make_mitre(const RingEdge& a, const RingEdge& b,
                                const std::vector<std::uint32_t>& between) {
  const Vec3d v = local(mesh_.origin(a.half_edge));
  const Vec3d direction_a = outgoing_direction(a);
  const Vec3d direction_b = outgoing_direction(b);
  const std::optional<Mitre> mitre =
      make_mitre_plane({axis_point(a.face_before, a.face_after, v), direction_a},
                       {axis_point(b.face_before, b.face_after, v), direction_b});
  // A sharp bend puts the plane far away: not a chain any more.
  if (!mitre || length(mitre->center - v) > 8 * radius_) return false;
  const std::uint32_t node = add_node({mitre->center, Node::Kind::mitre, kNone});
  const Vec3d normal = normalize(direction_a - direction_b);
  const auto mitred = [&](std::uint32_t half_edge) {
    std::vector<std::uint32_t> all = {half_edge};
    all.insert(all.end(), between.begin(), between.end());
    return all;
  };
  set_end(a.half_edge, {node, mitre->end_a, mitre->center, normal, mitred(b.half_edge)});
  set_end(b.half_edge, {node, mitre->end_b, mitre->center, -normal, mitred(a.half_edge)});
  return true;
}

void NetworkBuilder::make_spheres() {
  std::vector<Plane> planes;
  planes.reserve(ring_.size());
  for (const RingEdge& edge : ring_) {
    Plane plane = regions_.planes[edge.face_after];
    plane.d -= radius_;
    planes.push_back(plane);
  }
  const Vec3d v = local(mesh_.origin(ring_[0].half_edge));
  const std::optional<CornerErosion> erosion = erode_corner(planes, size_);
  if (!erosion) {
    for (const RingEdge& edge : ring_) {
      if (edge.rounded) make_cap(edge);
    }
    return;
  }
  ++out_.rounded_corners;
  if (!convex_) add_corner_cut(*erosion);
  const auto base = std::uint32_t(out_.nodes.size());
  for (const Vec3d& position : erosion->nodes) add_node({position, Node::Kind::sphere, kNone});
  for (std::size_t i = 0; i < ring_.size(); ++i) {
    const std::uint32_t node = base + erosion->node_of_edge[i];
    const Vec3d position = erosion->nodes[erosion->node_of_edge[i]];
    if (ring_[i].rounded) {
      set_end(ring_[i].half_edge, {node, position, position, outgoing_direction(ring_[i])});
    } else {
      const std::uint32_t a = ring_[i].face_after;
      const std::uint32_t b = ring_[i].face_before;
      const Arc stub{arc_line(position, position, a, b), a, b, node, kNone};
      out_.arcs.push_back({stub, v, v, ring_[i].half_edge, kNone});
    }
  }
  for (const CornerErosion::ShortArc& s : erosion->short_arcs) {
    const Vec3d p0 = erosion->nodes[s.node0];
    const Vec3d p1 = erosion->nodes[s.node1];
    const std::uint32_t a = ring_[s.face_a].face_after;
    const std::uint32_t b = ring_[s.face_b].face_after;
    const Arc arc{arc_line(p0, p1, a, b), a, b, base + s.node0, base + s.node1};
    out_.arcs.push_back({arc, v, v, kNone, kNone});
  }
}

void NetworkBuilder::make_arc(std::uint32_t first) {
  const std::uint32_t h = pieces_of(first).back();
  const std::uint32_t back = mesh_.twin[h];
  if (first > back) return;  // made from the other end
  End& e0 = ends_[end_of_[first]];
  End& e1 = ends_[end_of_[back]];
  e0.arc = e1.arc = std::uint32_t(out_.arcs.size());
  const std::uint32_t face_a = regions_.region[first / 3];
  const std::uint32_t face_b = regions_.region[mesh_.twin[first] / 3];
  const Vec3d v0 = local(mesh_.origin(first));
  const Vec3d v1 = local(mesh_.target(h));
  const Vec3d axis =
      normalize(cross(regions_.planes[face_a].normal, regions_.planes[face_b].normal));
  const double arc_length = dot(e1.point - e0.point, axis);
  const double edge_length = dot(v1 - v0, axis);
  const double limit = edge_length > arc_length ? radius_ * edge_length / (edge_length - arc_length)
                                                : std::numeric_limits<double>::infinity();
  out_.radius_limit = std::min(out_.radius_limit, limit);
  ++out_.rounded_edges;
  const ArcLine line = arc_line(e0.point, e1.point, face_a, face_b);
  const Arc arc{line, face_a, face_b, e0.node, e1.node, first / 3, mesh_.twin[first] / 3};
  out_.arcs.push_back({arc, v0, v1, first, back});
  const bool has_vanished = arc_length <= kLengthTolerance * size_;
  if (has_vanished) out_.inverted = true;
  if (convex_) return;
  if (has_vanished || !add_cut(out_.arcs.back(), e0, e1)) {
    vanished_.push_back({first, back, limit});
  }
}

}  // namespace arris
