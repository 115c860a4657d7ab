#include "edges/flat_regions.h"

#include <algorithm>
#include <cmath>

namespace arris {
namespace {

// Angles are compared with this slack, so that an edge of exactly min_angle counts as sharp.
constexpr double kAngleTolerance = 1e-5;

struct TrianglePlane {
  Vec3d normal;       // unit; not meaningful for a sliver
  double height = 0;  // over the longest edge: the smaller, the less the normal is worth
};

class RegionBuilder {
 public:
  explicit RegionBuilder(const WeldedMesh& mesh) : mesh_(mesh), planes_(mesh.triangles.size()) {
    out_.region.assign(mesh.triangles.size(), kNone);
  }

  FlatRegions build() {
    for (std::uint32_t s = 0; s < mesh_.shells.size(); ++s) build_shell(s);
    return std::move(out_);
  }

 private:
  // Regions grow from the best conditioned triangles first, so that slivers join the face they lie in.
  void build_shell(std::uint32_t shell_index) {
    const Shell& shell = mesh_.shells[shell_index];
    center_ = shell.center();
    const Vec3d extent = max(shell.bounds_max, -shell.bounds_min);
    // Far from the origin the coordinates themselves are coarser.
    const double coordinate_error = 4 * 6e-8 * max_component(max(extent, -extent));
    tolerance_ = kPlaneTolerance * shell.size() + coordinate_error;
    const auto first = mesh_.triangles_by_shell.begin() + shell.first_triangle;
    seeds_.assign(first, first + shell.triangle_count);
    for (const std::uint32_t t : seeds_) planes_[t] = plane_of(t);
    std::ranges::sort(seeds_, [&](std::uint32_t a, std::uint32_t b) {
      return planes_[a].height != planes_[b].height ? planes_[a].height > planes_[b].height : a < b;
    });
    for (const std::uint32_t t : seeds_) {
      if (out_.region[t] == kNone) grow(t, shell_index);
    }
  }

  [[nodiscard]] Vec3d local(std::uint32_t vertex) const {
    return Vec3d(mesh_.vertices[vertex]) - center_;
  }

  [[nodiscard]] TrianglePlane plane_of(std::uint32_t t) const {
    const Triangle& v = mesh_.triangles[t];
    const Vec3d a = local(v[0]);
    const Vec3d b = local(v[1]);
    const Vec3d c = local(v[2]);
    const double longest_squared =
        std::max({length_squared(b - a), length_squared(c - b), length_squared(a - c)});
    const Vec3d n = cross(b - a, c - a);
    const double doubled_area = length(n);
    if (doubled_area == 0) return {Vec3d(0, 0, 1), 0};
    return {n / doubled_area, doubled_area / std::sqrt(longest_squared)};
  }

  // Is t in the plane of the region's seed? The plane is known to `tolerance_` over the seed's own height and
  // less well farther out (coordinates are some sixteen times finer than the tolerance).
  [[nodiscard]] bool is_coplanar(std::uint32_t seed, std::uint32_t t) const {
    const TrianglePlane& plane = planes_[seed];
    const bool sliver = planes_[t].height <= 4 * tolerance_;
    if (!sliver && dot(plane.normal, planes_[t].normal) < 0.5) return false;
    const Vec3d on_plane = local(mesh_.triangles[seed][0]);
    const double spread = plane.height > 0 ? tolerance_ / (8 * plane.height) : 0;
    for (const std::uint32_t v : mesh_.triangles[t]) {
      const Vec3d p = local(v) - on_plane;
      const double off = dot(plane.normal, p);
      if (std::abs(off) <= tolerance_) continue;
      if (std::abs(off) > tolerance_ + spread * length(p)) return false;
    }
    return true;
  }

  void grow(std::uint32_t seed, std::uint32_t shell_index) {
    const auto index = std::uint32_t(out_.planes.size());
    members_.assign(1, seed);
    out_.region[seed] = index;
    for (std::size_t i = 0; i < members_.size(); ++i) {
      const std::uint32_t t = members_[i];
      for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t twin = mesh_.twin[3 * t + k];
        if (twin > kLastHalfEdge || out_.region[twin / 3] != kNone) continue;
        if (!is_coplanar(seed, twin / 3)) continue;
        out_.region[twin / 3] = index;
        members_.push_back(twin / 3);
      }
    }
    out_.planes.push_back(fit_plane(seed));
    out_.shell.push_back(shell_index);
  }

  // Area-weighted over the members.
  [[nodiscard]] Plane fit_plane(std::uint32_t seed) const {
    Vec3d normal;
    Vec3d weighted_center;
    double area = 0;
    for (const std::uint32_t t : members_) {
      const Triangle& v = mesh_.triangles[t];
      const Vec3d a = local(v[0]);
      const Vec3d b = local(v[1]);
      const Vec3d c = local(v[2]);
      const Vec3d n = cross(b - a, c - a);
      const double doubled_area = length(n);
      normal += n;
      weighted_center += (a + b + c) * (doubled_area / 3);
      area += doubled_area;
    }
    Plane plane{planes_[seed].normal, dot(planes_[seed].normal, local(mesh_.triangles[seed][0]))};
    if (length_squared(normal) > 0) {
      plane.normal = normalize(normal);
      plane.d = dot(plane.normal, weighted_center / area);
    }
    return plane;
  }

  const WeldedMesh& mesh_;
  std::vector<TrianglePlane> planes_;
  FlatRegions out_;
  Vec3d center_;
  double tolerance_ = 0;
  std::vector<std::uint32_t> seeds_, members_;
};

bool is_room(const WeldedMesh& mesh, const FlatRegions& regions, const Shell& shell,
             double min_angle) {
  bool any_concave = false;
  for (std::uint32_t i = 0; i < shell.triangle_count; ++i) {
    const std::uint32_t t = mesh.triangles_by_shell[shell.first_triangle + i];
    for (std::uint32_t k = 0; k < 3; ++k) {
      const EdgeKind kind = classify_edge(mesh, regions, 3 * t + k, min_angle);
      if (kind == EdgeKind::convex) return false;
      any_concave = any_concave || kind == EdgeKind::concave;
    }
  }
  return any_concave;
}

bool is_marked_sharp(const WeldedMesh& mesh, std::uint32_t h) {
  const std::uint32_t a = mesh.origin(h), b = mesh.target(h);
  return std::ranges::binary_search(*mesh.sharp_edges, VertexPair{std::min(a, b), std::max(a, b)});
}

void turn_shell(WeldedMesh& mesh, Shell& shell) {
  // Reversing (a, b, c) into (a, c, b) sends half-edge 3t+k to 3t+2-k.
  const auto turned = [](std::uint32_t h) { return h - h % 3 + 2 - h % 3; };
  for (std::uint32_t i = 0; i < shell.triangle_count; ++i) {
    const std::uint32_t t = mesh.triangles_by_shell[shell.first_triangle + i];
    std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
    std::swap(mesh.twin[3 * t], mesh.twin[3 * t + 2]);
    for (std::uint32_t k = 0; k < 3; ++k) {
      std::uint32_t& twin = mesh.twin[3 * t + k];
      if (twin <= kLastHalfEdge) twin = turned(twin);
    }
  }
  shell.turned = !shell.turned;
}

}  // namespace

FlatRegions make_flat_regions(const WeldedMesh& mesh) {
  return RegionBuilder(mesh).build();
}

double turn_at(const WeldedMesh& mesh, const FlatRegions& regions, std::uint32_t h) {
  const Vec3d na = regions.planes[regions.region[h / 3]].normal;
  const Vec3d nb = regions.planes[regions.region[mesh.twin[h] / 3]].normal;
  const Vec3d edge = Vec3d(mesh.vertices[mesh.target(h)]) - Vec3d(mesh.vertices[mesh.origin(h)]);
  const Vec3d axis = cross(na, nb);
  const double angle = std::atan2(length(axis), dot(na, nb));
  return dot(axis, edge) >= 0 ? angle : -angle;
}

EdgeKind classify_edge(const WeldedMesh& mesh, const FlatRegions& regions, std::uint32_t h,
                       double min_angle) {
  if (mesh.twin[h] == kBoundary) return EdgeKind::boundary;
  if (mesh.twin[h] == kNonManifold) return EdgeKind::nonmanifold;
  if (regions.region[h / 3] == regions.region[mesh.twin[h] / 3]) return EdgeKind::flat;
  const double turn = turn_at(mesh, regions, h);
  const bool smooth =
      mesh.sharp_edges ? !is_marked_sharp(mesh, h) : std::abs(turn) < min_angle - kAngleTolerance;
  if (smooth) return EdgeKind::smooth;
  return turn > 0 ? EdgeKind::convex : EdgeKind::concave;
}

std::vector<std::uint32_t> turn_inverted_shells(WeldedMesh& mesh, const FlatRegions& regions,
                                                double min_angle) {
  std::vector<std::uint32_t> turned;
  for (std::uint32_t s = 0; s < mesh.shells.size(); ++s) {
    Shell& shell = mesh.shells[s];
    bool inverted = false;
    if (shell.closed) {
      inverted = shell.volume < 0 && std::ranges::none_of(mesh.shells, [&](const Shell& other) {
                   return can_hold(other, shell);
                 });
    } else {
      inverted = is_room(mesh, regions, shell, min_angle);
    }
    if (!inverted) continue;
    turn_shell(mesh, shell);
    turned.push_back(s);
  }
  return turned;
}

bool is_cavity(const Shell& shell) {
  return shell.closed && shell.volume < 0 && !shell.turned;
}

bool can_hold(const Shell& outer, const Shell& inner) {
  if (!outer.closed || outer.volume <= 0) return false;
  for (int axis = 0; axis < 3; ++axis) {
    if (inner.bounds_min[axis] <= outer.bounds_min[axis]) return false;
    if (inner.bounds_max[axis] >= outer.bounds_max[axis]) return false;
  }
  return true;
}

std::uint32_t shell_around(std::span<const Shell> shells, std::uint32_t hollow) {
  std::uint32_t outer = kNone;
  if (!is_cavity(shells[hollow])) return outer;
  for (std::uint32_t s = 0; s < shells.size(); ++s) {
    if (!can_hold(shells[s], shells[hollow])) continue;
    if (outer == kNone || shells[s].volume < shells[outer].volume) outer = s;
  }
  return outer;
}

}  // namespace arris
