#include "edges/flat_regions.h"

#include <algorithm>
#include <cmath>

namespace arris {
namespace {

// Angles are compared with this slack, so that an edge of exactly min_angle counts as sharp.
constexpr double kAngleTolerance = 1e-5;

struct TrianglePlane {
  Vec3d normal;        // unit; zero for a sliver until it takes its neighbour's
  double longest = 0;  // edge
  std::uint32_t longest_edge = 0;
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
  void build_shell(std::uint32_t shell_index) {
    const Shell& shell = mesh_.shells[shell_index];
    center_ = shell.center();
    const Vec3d extent = max(shell.bounds_max, -shell.bounds_min);
    // Far from the origin the coordinates themselves are coarser.
    const double coordinate_error = 4 * 6e-8 * max_component(max(extent, -extent));
    tolerance_ = kPlaneTolerance * shell.size() + coordinate_error;
    const auto first = mesh_.triangles_by_shell.begin() + shell.first_triangle;
    const auto last = first + shell.triangle_count;
    for (auto t = first; t != last; ++t) planes_[*t] = plane_of(*t);
    for (auto t = first; t != last; ++t) {
      const bool sliver = length_squared(planes_[*t].normal) == 0;
      if (out_.region[*t] == kNone && !sliver) grow(*t, shell_index);
    }
    for (auto t = first; t != last; ++t) {  // slivers that no region reached
      if (out_.region[*t] == kNone) grow(*t, shell_index);
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
    TrianglePlane plane;
    const double lengths[3] = {length(b - a), length(c - b), length(a - c)};
    for (std::uint32_t k = 0; k < 3; ++k) {
      if (lengths[k] > plane.longest) {
        plane.longest = lengths[k];
        plane.longest_edge = 3 * t + k;
      }
    }
    const Vec3d n = cross(b - a, c - a);
    const double doubled_area = length(n);
    // Lower than the tolerance: its direction is noise.
    if (doubled_area > tolerance_ * plane.longest) plane.normal = n / doubled_area;
    return plane;
  }

  [[nodiscard]] bool is_coplanar(std::uint32_t h, std::uint32_t twin) const {
    const std::uint32_t t = h / 3;
    const std::uint32_t s = twin / 3;
    if (length_squared(planes_[s].normal) == 0) return planes_[s].longest_edge == twin;
    if (dot(planes_[t].normal, planes_[s].normal) < 0.5) return false;
    const Vec3d on_edge = local(mesh_.origin(h));
    const Vec3d apex_s = local(mesh_.origin(WeldedMesh::previous(twin))) - on_edge;
    const Vec3d apex_t = local(mesh_.origin(WeldedMesh::previous(h))) - on_edge;
    return std::abs(dot(planes_[t].normal, apex_s)) <= tolerance_ &&
           std::abs(dot(planes_[s].normal, apex_t)) <= tolerance_;
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
        if (!is_coplanar(3 * t + k, twin)) continue;
        if (length_squared(planes_[twin / 3].normal) == 0) {
          planes_[twin / 3].normal = planes_[t].normal;
        }
        out_.region[twin / 3] = index;
        members_.push_back(twin / 3);
      }
    }
    Plane plane = fit_plane();
    if (members_.size() > 2 && farthest_from(plane) > 4 * tolerance_) {
      for (std::size_t i = 1; i < members_.size(); ++i) {
        out_.region[members_[i]] = std::uint32_t(out_.planes.size() + i);
      }
      for (const std::uint32_t t : members_) {
        single_.assign(1, t);
        members_.swap(single_);
        add_region(fit_plane(), shell_index);
        members_.swap(single_);
      }
      return;
    }
    add_region(plane, shell_index);
  }

  void add_region(const Plane& plane, std::uint32_t shell_index) {
    out_.planes.push_back(plane);
    out_.shell.push_back(shell_index);
  }

  // Area-weighted over the members.
  [[nodiscard]] Plane fit_plane() const {
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
    Plane plane;
    plane.normal = length_squared(normal) > 0 ? normalize(normal) : planes_[members_[0]].normal;
    if (area > 0) plane.d = dot(plane.normal, weighted_center / area);
    return plane;
  }

  [[nodiscard]] double farthest_from(const Plane& plane) const {
    double distance = 0;
    for (const std::uint32_t t : members_) {
      for (const std::uint32_t v : mesh_.triangles[t]) {
        distance = std::max(distance, std::abs(dot(plane.normal, local(v)) - plane.d));
      }
    }
    return distance;
  }

  const WeldedMesh& mesh_;
  std::vector<TrianglePlane> planes_;
  FlatRegions out_;
  Vec3d center_;
  double tolerance_ = 0;
  std::vector<std::uint32_t> members_, single_;
};

bool contains(const Shell& outer, const Shell& inner) {
  for (int axis = 0; axis < 3; ++axis) {
    if (inner.bounds_min[axis] <= outer.bounds_min[axis]) return false;
    if (inner.bounds_max[axis] >= outer.bounds_max[axis]) return false;
  }
  return true;
}

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
  if (std::abs(turn) < min_angle - kAngleTolerance) return EdgeKind::smooth;
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
                   return other.closed && other.volume > 0 && contains(other, shell);
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

}  // namespace arris
