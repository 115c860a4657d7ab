#include "rounding/crease_network.h"

#include <algorithm>
#include <cmath>

#include "rounding/corner.h"

namespace arris {
namespace {

// Marks in end_of_.
constexpr std::uint32_t kUnset = kNone;
constexpr std::uint32_t kThrough = kNone - 1;  // the chain goes straight on here

// An arc no longer than this (relative to the shell) has vanished.
constexpr double kLengthTolerance = 1e-6;

}  // namespace

NetworkBuilder::NetworkBuilder(const WeldedMesh& mesh, const FlatRegions& regions,
                               std::vector<EdgeKind>& kinds, double radius)
    : mesh_(mesh),
      regions_(regions),
      kinds_(kinds),
      radius_(radius),
      end_of_(mesh.triangles.size() * 3, kUnset) {}

ShellNetwork NetworkBuilder::build(std::uint32_t shell, bool convex) {
  std::uint64_t shortened = 0;
  for (;;) {
    std::vector<std::uint32_t> inverted;
    ShellNetwork network = build_once(shell, convex, inverted);
    if (inverted.empty() || convex) {
      network.shortened_edges = shortened;
      return network;
    }
    // Leave those edges sharp and look at their corners again.
    for (const std::uint32_t first : inverted) {
      ++shortened;
      std::uint32_t h = first;
      for (;;) {
        kinds_[h] = kinds_[mesh_.twin[h]] = EdgeKind::smooth;
        std::uint32_t n = WeldedMesh::next(h);
        while (kinds_[n] == EdgeKind::flat) n = WeldedMesh::next(mesh_.twin[n]);
        if (end_of_[n] != kThrough) break;
        h = n;
      }
    }
    for (std::uint32_t i = 0; i < mesh_.shells[shell].triangle_count; ++i) {
      const std::uint32_t t = mesh_.triangles_by_shell[mesh_.shells[shell].first_triangle + i];
      for (std::uint32_t k = 0; k < 3; ++k) end_of_[3 * t + k] = kUnset;
    }
  }
}

ShellNetwork NetworkBuilder::build_once(std::uint32_t shell_index, bool convex,
                                        std::vector<std::uint32_t>& inverted) {
  const Shell& shell = mesh_.shells[shell_index];
  center_ = shell.center();
  size_ = shell.size();
  out_ = {};
  ends_.clear();
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
      if (kinds_[h] != EdgeKind::convex || end_of_[h] == kThrough) continue;
      if (!make_arc(h) && !convex) inverted.push_back(h);
    }
  }
  return std::move(out_);
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
  if (rounded.size() == 2 && make_mitre(*rounded[0], *rounded[1])) return;
  if (rounded.size() > 2 && !ring_open_ && !ring_irregular_) {
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
    double best = 0.3;
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
  set_end(edge.half_edge, {add_node(node), node.position});
}

bool NetworkBuilder::make_mitre(const RingEdge& a, const RingEdge& b) {
  const Vec3d v = local(mesh_.origin(a.half_edge));
  const Vec3d direction_a = outgoing_direction(a);
  const Vec3d direction_b = outgoing_direction(b);
  const std::optional<Mitre> mitre =
      make_mitre_plane({axis_point(a.face_before, a.face_after, v), direction_a},
                       {axis_point(b.face_before, b.face_after, v), direction_b});
  // A sharp bend puts the plane far away: not a chain any more.
  if (!mitre || length(mitre->center - v) > 8 * radius_) return false;
  const std::uint32_t node = add_node({mitre->center, Node::Kind::mitre, kNone});
  set_end(a.half_edge, {node, mitre->end_a});
  set_end(b.half_edge, {node, mitre->end_b});
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
  const auto base = std::uint32_t(out_.nodes.size());
  for (const Vec3d& position : erosion->nodes) add_node({position, Node::Kind::sphere, kNone});
  for (std::size_t i = 0; i < ring_.size(); ++i) {
    const std::uint32_t node = base + erosion->node_of_edge[i];
    const Vec3d position = erosion->nodes[erosion->node_of_edge[i]];
    if (ring_[i].rounded) {
      set_end(ring_[i].half_edge, {node, position});
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

// False if the arc has vanished.
bool NetworkBuilder::make_arc(std::uint32_t first) {
  std::uint32_t h = first;
  for (;;) {
    std::uint32_t n = WeldedMesh::next(h);
    while (kinds_[n] == EdgeKind::flat) n = WeldedMesh::next(mesh_.twin[n]);
    if (end_of_[n] != kThrough || n == first) break;
    h = n;
  }
  const std::uint32_t back = mesh_.twin[h];
  if (first > back) return true;  // made from the other end
  const End& e0 = ends_[end_of_[first]];
  const End& e1 = ends_[end_of_[back]];
  const std::uint32_t face_a = regions_.region[first / 3];
  const std::uint32_t face_b = regions_.region[mesh_.twin[first] / 3];
  const Vec3d v0 = local(mesh_.origin(first));
  const Vec3d v1 = local(mesh_.target(h));
  const Vec3d axis =
      normalize(cross(regions_.planes[face_a].normal, regions_.planes[face_b].normal));
  const double arc_length = dot(e1.point - e0.point, axis);
  const double edge_length = dot(v1 - v0, axis);
  if (edge_length > arc_length) {
    out_.radius_limit =
        std::min(out_.radius_limit, radius_ * edge_length / (edge_length - arc_length));
  }
  ++out_.rounded_edges;
  const ArcLine line = arc_line(e0.point, e1.point, face_a, face_b);
  const Arc arc{line, face_a, face_b, e0.node, e1.node, first / 3, mesh_.twin[first] / 3};
  out_.arcs.push_back({arc, v0, v1, first, back});
  if (arc_length > kLengthTolerance * size_) return true;
  out_.inverted = true;
  return false;
}

}  // namespace arris
