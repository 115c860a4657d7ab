#include "rounding/bevel_shell.h"

#include <algorithm>
#include <cmath>

namespace arris {

// Both weights by one formula, so that the way back gives the same floats.
Vec3d turn_between(Vec3d a, Vec3d b, int k, int n) {
  if (k == 0) return a;
  if (k == n) return b;
  const double angle = std::atan2(length(cross(a, b)), dot(a, b));
  const double step = angle / n;
  return normalize(a * std::sin(step * (n - k)) + b * std::sin(step * k));
}

ShellBevel::ShellBevel(const RoundingParts& parts, int subdivisions, BevelSurface& out)
    : parts_(parts),
      mesh_(parts.welded),
      radius_(parts.data->radius),
      n_(subdivisions),
      out_(out),
      item_of_(mesh_.twin.size(), kNone),
      in_chain_(mesh_.twin.size(), 0),
      visited_(mesh_.twin.size(), 0),
      path_of_(mesh_.twin.size()) {}

void ShellBevel::keep(std::uint32_t shell) {
  const auto first = mesh_.triangles_by_shell.begin() + mesh_.shells[shell].first_triangle;
  out_.kept.insert(out_.kept.end(), first, first + mesh_.shells[shell].triangle_count);
}

bool ShellBevel::append(std::uint32_t shell) {
  network_ = &parts_.networks[shell];
  const Solid& solid = parts_.data->solids[shell];
  const bool any =
      std::ranges::any_of(network_->arcs, [](const NetworkArc& a) { return !a.arc.is_stub(); });
  if (!any) {
    keep(shell);
    return true;
  }
  center_ = solid.center;
  size_ = solid.size;
  const std::size_t vertices = out_.positions.size();
  const std::size_t triangles = out_.triangles.size();
  const std::size_t kept = out_.kept.size();
  path_vertices_.clear();
  bool made = make();
  if (made) {
    if (solid.exact) {
      made = make_faces_of_erosion();
    } else {
      // Where features are eaten and edges stay sharp, the mesh's own corners are no guide any more.
      made = !solid.rewired && make_corners(shell) && make_faces(shell);
    }
  }
  if (made) {
    for (std::uint32_t a = 0; a < network_->arcs.size(); ++a) make_strip(a);
    return true;
  }
  out_.positions.resize(vertices);
  out_.normals.resize(vertices);
  out_.triangles.resize(triangles);
  out_.face.resize(triangles);
  out_.flat.resize(triangles);
  out_.kept.resize(kept);
  keep(shell);
  return false;
}

std::uint32_t ShellBevel::node_of(Item item) const {
  const Arc& a = arc(item).arc;
  return item % 2 == 0 ? a.node0 : a.node1;
}

std::uint32_t ShellBevel::after(Item item) const {
  const Arc& a = arc(item).arc;
  return item % 2 == 0 ? a.face_a : a.face_b;
}

std::uint32_t ShellBevel::before(Item item) const {
  const Arc& a = arc(item).arc;
  return item % 2 == 0 ? a.face_b : a.face_a;
}

// Away from the node.
Vec3d ShellBevel::direction(Item item) const {
  return normalize(cross(normal(after(item)), normal(before(item))));
}

Vec3d ShellBevel::axis_end(Item item) const {
  const Arc& a = arc(item).arc;
  return item % 2 == 0 ? Vec3d(a.line.p0) : a.line.p1();
}

Vec3d ShellBevel::local(std::uint32_t vertex) const {
  return Vec3d(mesh_.vertices[vertex]) - center_;
}

std::uint32_t ShellBevel::add_vertex(Vec3d position, Vec3d normal) {
  out_.positions.push_back(Vec3f(center_ + position));
  out_.normals.push_back(Vec3f(normal));
  return std::uint32_t(out_.positions.size() - 1);
}

std::uint32_t ShellBevel::copy_vertex(std::uint32_t vertex, Vec3d normal) {
  out_.positions.push_back(Vec3f(out_.positions[vertex]));
  out_.normals.push_back(Vec3f(normal));
  return std::uint32_t(out_.positions.size() - 1);
}

std::uint32_t ShellBevel::add_source_vertex(std::uint32_t vertex, std::uint32_t face) {
  out_.positions.push_back(mesh_.vertices[vertex]);
  out_.normals.push_back(Vec3f(normal(face)));
  return std::uint32_t(out_.positions.size() - 1);
}

void ShellBevel::add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t face,
                              bool flat) {
  out_.triangles.push_back({a, b, c});
  out_.face.push_back(face);
  out_.flat.push_back(flat ? 1 : 0);
}

std::uint32_t& ShellBevel::profile(Item item, int k) {
  return profiles_[std::size_t(item) * std::size_t(n_ + 1) + std::size_t(k)];
}

Vec3d ShellBevel::profile_normal(Item item, int k) const {
  return turn_between(normal(before(item)), normal(after(item)), k, n_);
}

bool ShellBevel::make() {
  profiles_.assign(network_->arcs.size() * 2 * std::size_t(n_ + 1), kNone);
  stub_tip_.assign(network_->arcs.size() * 2, kNone);
  if (!make_rings()) return false;
  for (std::uint32_t n = 0; n < network_->nodes.size(); ++n) {
    if (rings_[n].count > 0 && network_->nodes[n].kind == Node::Kind::sphere) make_sphere(n);
  }
  return true;
}

// Sorts the items of each sphere's node so that each one's face `after` is the next one's face `before`.
bool ShellBevel::make_rings() {
  const std::size_t items = network_->arcs.size() * 2;
  rings_.assign(network_->nodes.size(), {});
  const auto for_items = [&](auto&& visit) {
    for (Item i = 0; i < items; ++i) {
      if (i % 2 == 1 && arc(i).arc.is_stub()) continue;
      if (network_->nodes[node_of(i)].kind == Node::Kind::sphere) visit(i);
    }
  };
  for_items([&](Item i) { ++rings_[node_of(i)].count; });
  std::uint32_t total = 0;
  for (Ring& ring : rings_) {
    ring.first = total;
    total += ring.count;
    ring.count = 0;
  }
  ring_items_.assign(total, kNone);
  touch_.assign(total, kNone);
  place_.assign(items, kNone);
  for_items([&](Item i) {
    Ring& ring = rings_[node_of(i)];
    ring_items_[ring.first + ring.count++] = i;
  });
  for (const Ring& ring : rings_) {
    if (ring.count == 0) continue;
    if (ring.count < 3) return false;
    for (std::uint32_t k = ring.first; k + 1 < ring.first + ring.count; ++k) {
      std::uint32_t next = k + 1;
      while (next < ring.first + ring.count && before(ring_items_[next]) != after(ring_items_[k])) {
        ++next;
      }
      if (next == ring.first + ring.count) return false;
      std::swap(ring_items_[k + 1], ring_items_[next]);
    }
    if (before(ring_items_[ring.first]) != after(ring_items_[ring.first + ring.count - 1])) {
      return false;
    }
    for (std::uint32_t k = ring.first; k < ring.first + ring.count; ++k) place_[ring_items_[k]] = k;
  }
  return true;
}

// T on each face, profiles between them, and the patch that they bound.
void ShellBevel::make_sphere(std::uint32_t node) {
  const Ring& ring = rings_[node];
  const Vec3d center = network_->nodes[node].position;
  for (std::uint32_t k = ring.first; k < ring.first + ring.count; ++k) {
    const Vec3d n = normal(after(ring_items_[k]));
    touch_[k] = add_vertex(center + n * radius_, n);
  }
  for (std::uint32_t k = 0; k < ring.count; ++k) {
    const Item item = ring_items_[ring.first + k];
    profile(item, 0) = touch_[ring.first + (k + ring.count - 1) % ring.count];
    for (int i = 1; i < n_; ++i) {
      const Vec3d n = profile_normal(item, i);
      profile(item, i) = add_vertex(center + n * radius_, n);
    }
    profile(item, n_) = touch_[ring.first + k];
  }
  fill_patch(node, ring);
}

// A fan of spherical triangles from the first T; the profile of item k runs from T(k−1) to T(k).
void ShellBevel::fill_patch(std::uint32_t node, const Ring& ring) {
  const Vec3d center = network_->nodes[node].position;
  const auto copy_profile = [&](Item item, std::vector<std::uint32_t>& side) {
    side.clear();
    for (int i = 0; i <= n_; ++i) side.push_back(profile(item, i));
  };
  copy_profile(ring_items_[ring.first + 1], side_ab_);
  const Vec3d n_first = normal(after(ring_items_[ring.first]));
  for (std::uint32_t k = 2; k < ring.count; ++k) {
    const Item item = ring_items_[ring.first + k];
    copy_profile(item, side_bc_);
    side_ac_.clear();
    if (k + 1 == ring.count) {
      copy_profile(ring_items_[ring.first], side_ac_);
      std::ranges::reverse(side_ac_);
    } else {
      side_ac_.push_back(touch_[ring.first]);
      for (int i = 1; i < n_; ++i) {
        const Vec3d n = turn_between(n_first, normal(after(item)), i, n_);
        side_ac_.push_back(add_vertex(center + n * radius_, n));
      }
      side_ac_.push_back(touch_[ring.first + k]);
    }
    fill_triangle(center, {after(ring_items_[ring.first]), before(item), after(item)});
    std::swap(side_ab_, side_ac_);
  }
}

// Rows of great arcs from side ab to side ac, from corner a on; the last row is side bc.
void ShellBevel::fill_triangle(Vec3d center, const std::array<std::uint32_t, 3>& faces) {
  // The face nearest to a triangle's middle, by its weights towards the three corners in thirds of a step.
  const auto face_at = [&](int to_a, int to_b, int to_c) {
    return faces[to_a >= to_b && to_a >= to_c ? 0 : to_b >= to_c ? 1 : 2];
  };
  row_.assign(1, side_ab_[0]);
  for (int i = 1; i <= n_; ++i) {
    const std::uint32_t left = side_ab_[std::size_t(i)], right = side_ac_[std::size_t(i)];
    if (i == n_) {
      next_row_ = side_bc_;
    } else {
      next_row_.assign(1, left);
      const Vec3d n_left(out_.normals[left]), n_right(out_.normals[right]);
      for (int j = 1; j < i; ++j) {
        const Vec3d n = turn_between(n_left, n_right, j, i);
        next_row_.push_back(add_vertex(center + n * radius_, n));
      }
      next_row_.push_back(right);
    }
    for (int j = 0; j < i; ++j) {
      const auto at = std::size_t(j);
      add_triangle(row_[at], next_row_[at], next_row_[at + 1],
                   face_at(3 * (n_ - i) + 1, 3 * (i - j) - 2, 3 * j + 1), false);
      if (j + 1 == i) continue;
      add_triangle(row_[at], next_row_[at + 1], row_[at + 1],
                   face_at(3 * (n_ - i) + 2, 3 * (i - j) - 4, 3 * j + 2), false);
    }
    std::swap(row_, next_row_);
  }
}

// Quads between the profiles at both ends, face a on the left of the way from end 0 to end 1.
void ShellBevel::make_strip(std::uint32_t arc_index) {
  const Arc& a = network_->arcs[arc_index].arc;
  if (a.is_stub()) return;
  const Item item0 = 2 * arc_index, item1 = item0 + 1;
  for (int k = 0; k < n_; ++k) {
    const std::uint32_t left0 = profile(item0, n_ - k), right0 = profile(item0, n_ - k - 1);
    const std::uint32_t left1 = profile(item1, k), right1 = profile(item1, k + 1);
    const std::uint32_t face = 2 * k < n_ ? a.face_a : a.face_b;
    add_triangle(left0, right0, right1, face, false);
    add_triangle(left0, right1, left1, face, false);
  }
}

// Faces of E moved out: from T along the item, to the T before the item's other end.
bool ShellBevel::make_faces_of_erosion() {
  std::vector<bool> done(ring_items_.size(), false);
  std::vector<std::uint32_t> loop;
  for (std::uint32_t start = 0; start < ring_items_.size(); ++start) {
    if (done[start]) continue;
    loop.clear();
    const std::uint32_t face = after(ring_items_[start]);
    for (std::uint32_t at = start; !done[at];) {
      done[at] = true;
      loop.push_back(touch_[at]);
      const Item other = ring_items_[at] ^ 1U;
      const Ring& ring = rings_[node_of(other)];
      at = place_[other] == ring.first ? ring.first + ring.count - 1 : place_[other] - 1;
      if (after(ring_items_[at]) != face) return false;
    }
    for (std::size_t i = 1; i + 1 < loop.size(); ++i) {
      add_triangle(loop[0], loop[i], loop[i + 1], face, true);
    }
  }
  return true;
}

}  // namespace arris
