// bevel_corners.cpp — corners of shells where edges stay sharp: paths, mitres, caps and walls
#include <algorithm>
#include <array>
#include <cmath>

#include "rounding/bevel_shell.h"

namespace arris {
namespace {

// Of the radius: two strips that meet farther apart than this at a mitre don't fit together.
constexpr double kMitreGap = 0.5;
// Of the band's width: where a rounding ends beside a sharp edge it keeps this far from it.
constexpr double kMargin = 0.05;
// Below this sine two directions are along one line.
constexpr double kAlong = 1e-6;

// Along `direction` from p to the plane; nothing if the way is along it.
std::optional<Vec3d> slide(Vec3d p, Vec3d direction, Vec3d on_plane, Vec3d plane_normal) {
  const double approach = dot(plane_normal, direction);
  if (std::abs(approach) < kAlong) return std::nullopt;
  return p + direction * (dot(plane_normal, on_plane - p) / approach);
}

}  // namespace

// Every half-edge of a chain that an arc rounds, in both directions, and the items at its ends.
void ShellBevel::mark_chains(std::uint32_t shell) {
  const Shell& s = mesh_.shells[shell];
  for (std::uint32_t i = s.first_triangle; i < s.first_triangle + s.triangle_count; ++i) {
    for (std::uint32_t h = 3 * mesh_.triangles_by_shell[i], k = 0; k < 3; ++h, ++k) {
      item_of_[h] = kNone;
      in_chain_[h] = visited_[h] = 0;
      path_of_[h] = {};
    }
  }
  for (std::uint32_t a = 0; a < network_->arcs.size(); ++a) {
    const NetworkArc& source = network_->arcs[a];
    if (source.half_edge0 == kNone) continue;
    item_of_[source.half_edge0] = 2 * a;
    if (source.arc.is_stub()) continue;
    item_of_[source.half_edge1] = 2 * a + 1;
    for (std::uint32_t h = source.half_edge0;;) {
      in_chain_[h] = in_chain_[mesh_.twin[h]] = 1;
      if (mesh_.twin[h] == source.half_edge1) break;
      h = WeldedMesh::next(h);
      while (parts_.kinds[h] == EdgeKind::flat) h = WeldedMesh::next(mesh_.twin[h]);
    }
  }
}

bool ShellBevel::make_corners(std::uint32_t shell) {
  mark_chains(shell);
  const Shell& s = mesh_.shells[shell];
  for (std::uint32_t i = s.first_triangle; i < s.first_triangle + s.triangle_count; ++i) {
    for (std::uint32_t h = 3 * mesh_.triangles_by_shell[i], k = 0; k < 3; ++h, ++k) {
      if (item_of_[h] == kNone || arc(item_of_[h]).arc.is_stub() || visited_[h] != 0) continue;
      collect_ring(h);
      if (!make_corner()) return false;
    }
  }
  return true;
}

// Edges between faces, and at the border, around the origin of half_edge, counter-clockwise. The sector after
// edges_[i] lies between it and the next; of an open ring the last sector ends at the border: its edge comes
// last, without a sector of its own.
void ShellBevel::collect_ring(std::uint32_t half_edge) {
  std::uint32_t start = half_edge;
  while (mesh_.twin[start] <= kLastHalfEdge) {
    start = WeldedMesh::next(mesh_.twin[start]);
    if (start == half_edge) break;
  }
  ring_open_ = mesh_.twin[start] > kLastHalfEdge;
  corner_vertex_ = mesh_.origin(half_edge);
  const Vec3d v = local(corner_vertex_);
  edges_.clear();
  std::uint32_t h = start;
  do {
    if (parts_.kinds[h] != EdgeKind::flat) {
      visited_[h] = 1;
      edges_.push_back({h, item_of_[h], normalize(local(mesh_.target(h)) - v)});
    }
    const std::uint32_t back = WeldedMesh::previous(h);
    if (mesh_.twin[back] > kLastHalfEdge) {
      edges_.push_back({kNone, kNone, normalize(local(mesh_.origin(back)) - v)});
      break;
    }
    h = mesh_.twin[back];
  } while (h != start);
}

bool ShellBevel::make_corner() {
  std::array<std::size_t, 2> rounded{};
  std::size_t count = 0;
  Node::Kind kind = Node::Kind::cap;
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    if (edges_[i].item == kNone || arc(edges_[i].item).arc.is_stub()) continue;
    if (count < 2) rounded[count] = i;
    ++count;
    kind = network_->nodes[node_of(edges_[i].item)].kind;
  }
  switch (kind) {
    case Node::Kind::sphere:
      return make_sphere_paths();
    case Node::Kind::mitre:
      return count == 2 && make_mitre(rounded[0], rounded[1]);
    case Node::Kind::cap:
      return make_caps();
  }
  return false;
}

void ShellBevel::end_path(std::uint32_t half_edge) {
  path_of_[half_edge] = {path_start_, std::uint32_t(path_vertices_.size()) - path_start_};
}

// A flat wall between a profile and the tip of the sharp edge. At a stub the wall faces back to the corner.
void ShellBevel::fill_wall(std::uint32_t tip, Item item, Vec3d wall_normal, bool at_stub) {
  const std::uint32_t apex = copy_vertex(tip, wall_normal);
  std::uint32_t last = copy_vertex(profile(item, 0), wall_normal);
  for (int k = 1; k <= n_; ++k) {
    const std::uint32_t next = copy_vertex(profile(item, k), wall_normal);
    const std::uint32_t face = 2 * k <= n_ ? before(item) : after(item);
    if (at_stub) {
      add_triangle(apex, next, last, face, true);
    } else {
      add_triangle(apex, last, next, face, true);
    }
    last = next;
  }
}

bool ShellBevel::make_sphere_paths() {
  const Vec3d v = local(corner_vertex_);
  for (const RingEdge& edge : edges_) {
    if (edge.item == kNone) return false;
    if (!arc(edge.item).arc.is_stub()) continue;
    const Vec3d e = direction(edge.item);
    const double along = dot(e, network_->nodes[node_of(edge.item)].position - v);
    if (along <= 0) return false;
    stub_tip_[edge.item] = add_vertex(v + e * along, normal(after(edge.item)));
    stub_tip_[edge.item + 1] = copy_vertex(stub_tip_[edge.item], normal(before(edge.item)));
    fill_wall(stub_tip_[edge.item], edge.item, -e, true);
  }
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    if (!make_sphere_path(i)) return false;
  }
  return true;
}

// From the end of the sector's second edge, over the short arcs that border its face, to the first edge's.
bool ShellBevel::make_sphere_path(std::size_t sector) {
  const Item goal = edges_[sector].item;
  Item from = edges_[(sector + 1) % edges_.size()].item;
  begin_path();
  if (arc(from).arc.is_stub()) path_vertices_.push_back(stub_tip_[from + 1]);
  for (std::size_t step = 0; step <= ring_items_.size(); ++step) {
    const Ring& ring = rings_[node_of(from)];
    const std::uint32_t at =
        place_[from] == ring.first ? ring.first + ring.count - 1 : place_[from] - 1;
    path_vertices_.push_back(touch_[at]);
    const Item item = ring_items_[at];
    if (item == goal) {
      if (arc(item).arc.is_stub()) path_vertices_.push_back(stub_tip_[item]);
      end_path(edges_[sector].half_edge);
      return true;
    }
    if (arc(item).half_edge0 != kNone) return false;
    from = item ^ 1U;
  }
  return false;
}

void ShellBevel::set_profile(Item item, std::span<const Vec3d> points) {
  for (int k = 0; k <= n_; ++k) {
    profile(item, k) = add_vertex(points[std::size_t(k)], profile_normal(item, k));
  }
}

// Both strips end in the mitre plane, where they meet in the mean of their profiles.
bool ShellBevel::make_mitre(std::size_t at0, std::size_t at1) {
  const Item items[2] = {edges_[at0].item, edges_[at1].item};
  const Vec3d center = network_->nodes[node_of(items[0])].position;
  const Vec3d plane = normalize(direction(items[0]) - direction(items[1]));
  points_.clear();
  for (int k = 0; k <= n_; ++k) {
    const int ks[2] = {k, n_ - k};
    Vec3d ends[2];
    for (std::size_t i = 0; i < 2; ++i) {
      const Vec3d p = axis_end(items[i]) + profile_normal(items[i], ks[i]) * radius_;
      const std::optional<Vec3d> q = slide(p, direction(items[i]), center, plane);
      if (!q) return false;
      ends[i] = *q;
    }
    if (length(ends[0] - ends[1]) > kMitreGap * radius_) return false;
    points_.push_back((ends[0] + ends[1]) * 0.5);
  }
  // Where one edge between them stays sharp it now begins at the strips' corner.
  const Vec3d v = local(corner_vertex_);
  const auto settle = [&](std::size_t from, std::size_t to, Vec3d& corner) {
    const std::size_t between = (to + edges_.size() - from) % edges_.size();
    if (between != 2) return;
    const Vec3d e = edges_[(from + 1) % edges_.size()].direction;
    corner = v + e * dot(e, corner - v);
  };
  settle(at1, at0, points_.front());
  settle(at0, at1, points_.back());
  set_profile(items[0], points_);
  std::ranges::reverse(points_);
  set_profile(items[1], points_);
  make_mitre_paths(at0, at1, points_.front());
  make_mitre_paths(at1, at0, points_.back());
  return true;
}

// The sectors from one rounded edge counter-clockwise to the other have one corner each.
void ShellBevel::make_mitre_paths(std::size_t from, std::size_t to, Vec3d position) {
  const Item first = edges_[from].item, last = edges_[to].item;
  for (std::size_t i = from; i != to; i = (i + 1) % edges_.size()) {
    if (edges_[i].half_edge == kNone) continue;
    const std::uint32_t face = parts_.regions.region[edges_[i].half_edge / 3];
    begin_path();
    if (i == from) {
      path_vertices_.push_back(profile(first, n_));
      if (face == before(last)) profile(last, 0) = profile(first, n_);
    } else if (face == before(last) && (i + 1) % edges_.size() == to) {
      path_vertices_.push_back(profile(last, 0));
    } else {
      path_vertices_.push_back(add_vertex(position, normal(face)));
    }
    end_path(edges_[i].half_edge);
  }
}

bool ShellBevel::make_caps() {
  if (edges_.size() == 3) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (edges_[i].item == kNone) continue;
      if (ring_open_) return make_border_cap(i);
      if (network_->nodes[node_of(edges_[i].item)].wall != kNone) return make_wall_cap(i);
    }
  }
  // Each rounding ends in a wall across its edge, far enough back to leave the faces' corners whole.
  const Vec3d v = local(corner_vertex_);
  std::vector<std::uint32_t> tips(edges_.size(), kNone);
  std::vector<std::uint8_t> moved(edges_.size(), 0);
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    const Item item = edges_[i].item;
    if (item == kNone || arc(item).arc.is_stub()) continue;
    const Vec3d e = direction(item);
    const double back = retreat(i);
    const Vec3d foot = axis_end(item) + e * (dot(e, v - axis_end(item)) + back);
    points_.clear();
    for (int k = 0; k <= n_; ++k) points_.push_back(foot + profile_normal(item, k) * radius_);
    set_profile(item, points_);
    tips[i] =
        back > 0 ? add_vertex(v + e * back, e) : add_source_vertex(corner_vertex_, after(item));
    moved[i] = back > 0 ? 1 : 0;
    fill_wall(tips[i], item, e, false);
  }
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    if (edges_[i].half_edge == kNone) continue;
    const std::uint32_t face = parts_.regions.region[edges_[i].half_edge / 3];
    const std::size_t next = (i + 1) % edges_.size();
    begin_path();
    if (tips[next] != kNone) {
      path_vertices_.push_back(profile(edges_[next].item, 0));
      if (moved[next] != 0) path_vertices_.push_back(copy_vertex(tips[next], normal(face)));
    }
    path_vertices_.push_back(add_source_vertex(corner_vertex_, face));
    if (tips[i] != kNone) {
      if (moved[i] != 0) path_vertices_.push_back(copy_vertex(tips[i], normal(face)));
      path_vertices_.push_back(profile(edges_[i].item, n_));
    }
    end_path(edges_[i].half_edge);
  }
  return true;
}

// The edge runs into a face: its profile lies there and becomes part of that face's outline.
bool ShellBevel::make_wall_cap(std::size_t at) {
  const Item item = edges_[at].item;
  const std::uint32_t wall = network_->nodes[node_of(item)].wall;
  const std::size_t second = (at + 1) % 3, third = (at + 2) % 3;
  if (parts_.regions.region[edges_[second].half_edge / 3] != wall) return false;
  const Plane& plane = parts_.regions.planes[wall];
  points_.clear();
  for (int k = 0; k <= n_; ++k) {
    const std::optional<Vec3d> p = slide(axis_end(item) + profile_normal(item, k) * radius_,
                                         direction(item), plane.normal * plane.d, plane.normal);
    if (!p) return false;
    points_.push_back(*p);
  }
  set_profile(item, points_);
  begin_path();
  path_vertices_.push_back(profile(item, n_));
  end_path(edges_[at].half_edge);
  begin_path();
  for (int k = 0; k <= n_; ++k) {
    const std::uint32_t copy = copy_vertex(profile(item, k), plane.normal);
    path_vertices_.push_back(copy);
  }
  end_path(edges_[second].half_edge);
  begin_path();
  path_vertices_.push_back(profile(item, 0));
  end_path(edges_[third].half_edge);
  return true;
}

// The edge runs to the border of an open shell: so does its rounding.
bool ShellBevel::make_border_cap(std::size_t at) {
  if (at != 1) return false;
  const Item item = edges_[1].item;
  const Vec3d e = direction(item);
  const Vec3d across = cross(edges_[0].direction, edges_[2].direction);
  Vec3d plane = length(across) > kAlong ? normalize(across) : e;
  if (std::abs(dot(plane, e)) < 0.1) plane = e;
  points_.clear();
  for (int k = 0; k <= n_; ++k) {
    const std::optional<Vec3d> p =
        slide(axis_end(item) + profile_normal(item, k) * radius_, e, local(corner_vertex_), plane);
    if (!p) return false;
    points_.push_back(*p);
  }
  set_profile(item, points_);
  begin_path();
  path_vertices_.push_back(profile(item, 0));
  end_path(edges_[0].half_edge);
  begin_path();
  path_vertices_.push_back(profile(item, n_));
  end_path(edges_[1].half_edge);
  return true;
}

// How far along edge `at` its touching lines are clear of the edges beside it.
double ShellBevel::retreat(std::size_t at) const {
  const std::size_t count = edges_.size();
  const Item item = edges_[at].item;
  double back = 0;
  if (!ring_open_ || at + 1 < count) {
    back = std::max(back, retreat_in_sector(at, (at + 1) % count, after(item), true));
  }
  if (!ring_open_ || at > 0) {
    back = std::max(back, retreat_in_sector(at, (at + count - 1) % count, before(item), false));
  }
  return back;
}

// In the face between edges `at` and `other`, at the angle θ: s along the first edge, w away from it, a point is
// s sin θ − w cos θ away from the second.
double ShellBevel::retreat_in_sector(std::size_t at, std::size_t other, std::uint32_t face,
                                     bool counter_clockwise) const {
  const auto width = [&](const RingEdge& edge) {
    if (edge.item == kNone || arc(edge.item).arc.is_stub()) return 0.0;
    const Vec3d a = normal(after(edge.item)), b = normal(before(edge.item));
    return radius_ * std::tan(std::atan2(length(cross(a, b)), dot(a, b)) / 2);
  };
  const Vec3d e = edges_[at].direction, f = edges_[other].direction;
  const double sine = dot(normal(face), cross(e, f)) * (counter_clockwise ? 1 : -1);
  const double cosine = dot(e, f);
  if (sine < kAlong) return 0;  // 180° and more
  const double w = width(edges_[at]);
  const double clear = width(edges_[other]) + kMargin * w;
  return std::max(0.0, (clear + w * cosine) / sine);
}

}  // namespace arris
