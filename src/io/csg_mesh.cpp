#include "io/csg_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "io/csg_hull.h"

namespace arris {
namespace {

using Index = std::uint32_t;

// Of the size: what six digits may bend a convex solid's faces by.
constexpr double kConvex = 2e-6;
constexpr std::uint64_t kMaxConvexWork = 20'000'000;

struct Side {
  Index triangle;
  bool forward;  // from the lesser point to the greater
};

// The triangles along each edge, in the order of its points.
std::map<std::pair<Index, Index>, std::vector<Side>> sides_of(
    const std::vector<Triangle>& triangles) {
  std::map<std::pair<Index, Index>, std::vector<Side>> sides;
  for (Index t = 0; t < triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = triangles[t][k], b = triangles[t][(k + 1) % 3];
      sides[std::minmax(a, b)].push_back({t, a < b});
    }
  }
  return sides;
}

// Points at one place become one; triangles without area in number are left out.
CsgMesh welded(const std::vector<Vec3d>& points, const std::vector<Triangle>& triangles) {
  CsgMesh mesh;
  std::map<std::array<double, 3>, Index> known;
  std::vector<Index> number;
  for (const Vec3d& p : points) {
    // -0 is 0
    const auto [entry, is_new] =
        known.try_emplace({p.x + 0.0, p.y + 0.0, p.z + 0.0}, Index(mesh.vertices.size()));
    if (is_new) mesh.vertices.push_back(p);
    number.push_back(entry->second);
  }
  for (const Triangle& t : triangles) {
    const Triangle w{number[t[0]], number[t[1]], number[t[2]]};
    if (w[0] != w[1] && w[1] != w[2] && w[2] != w[0]) mesh.triangles.push_back(w);
  }
  return mesh;
}

double signed_volume(const CsgMesh& mesh, const std::vector<Index>& triangles) {
  double volume = 0;
  const Vec3d origin = mesh.vertices[mesh.triangles[triangles[0]][0]];
  for (const Index t : triangles) {
    const Triangle& c = mesh.triangles[t];
    volume += dot(mesh.vertices[c[0]] - origin,
                  cross(mesh.vertices[c[1]] - origin, mesh.vertices[c[2]] - origin));
  }
  return volume / 6;
}

// Turns triangles around.
class Turning {
 public:
  explicit Turning(CsgMesh& mesh) : mesh_(mesh), sides_(sides_of(mesh.triangles)) {}

  [[nodiscard]] std::size_t unbalanced_edges() const {
    std::size_t count = 0;
    for (const auto& [edge, sides] : sides_) {
      int balance = 0;
      for (const Side& side : sides) balance += side.forward ? 1 : -1;
      if (balance != 0) ++count;
    }
    return count;
  }

  // Of each set of triangles that edges of two join, those are turned that disagree with its first. True if any.
  bool make_consistent() {
    std::vector<std::vector<std::pair<Index, bool>>> neighbours(mesh_.triangles.size());
    for (const auto& [edge, sides] : sides_) {
      if (sides.size() != 2) continue;
      const bool agree = sides[0].forward != sides[1].forward;
      neighbours[sides[0].triangle].emplace_back(sides[1].triangle, agree);
      neighbours[sides[1].triangle].emplace_back(sides[0].triangle, agree);
    }
    std::vector<std::int8_t> turned(mesh_.triangles.size(), -1);
    bool any = false;
    for (Index start = 0; start < turned.size(); ++start) {
      if (turned[start] >= 0) continue;
      turned[start] = 0;
      std::vector<Index> part{start};
      for (std::size_t i = 0; i < part.size(); ++i) {
        for (const auto& [other, agree] : neighbours[part[i]]) {
          if (turned[other] >= 0) continue;
          turned[other] = std::int8_t(agree ? turned[part[i]] : 1 - turned[part[i]]);
          part.push_back(other);
        }
      }
      for (const Index t : part) {
        if (turned[t] == 1) turn(t), any = true;
      }
      if (signed_volume(mesh_, part) < 0) {
        for (const Index t : part) turn(t);
      }
    }
    sides_ = sides_of(mesh_.triangles);
    return any;
  }

 private:
  void turn(Index t) { std::swap(mesh_.triangles[t][1], mesh_.triangles[t][2]); }

  CsgMesh& mesh_;
  std::map<std::pair<Index, Index>, std::vector<Side>> sides_;
};

bool is_one_piece(const CsgMesh& mesh) {
  std::vector<Index> root(mesh.vertices.size());
  std::iota(root.begin(), root.end(), 0U);
  const auto find = [&](Index i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  for (const Triangle& t : mesh.triangles) {
    root[find(t[0])] = find(t[1]);
    root[find(t[1])] = find(t[2]);
  }
  const Index first = find(mesh.triangles[0][0]);
  return std::all_of(mesh.triangles.begin(), mesh.triangles.end(),
                     [&](const Triangle& t) { return find(t[0]) == first; });
}

bool is_convex(const CsgMesh& mesh) {
  if (std::uint64_t(mesh.triangles.size()) * mesh.vertices.size() > kMaxConvexWork) return false;
  Vec3d low(1e300), high(-1e300);
  for (const Vec3d& p : mesh.vertices) {
    low = min(low, p);
    high = max(high, p);
  }
  const double tolerance = kConvex * max_component(high - low);
  for (const Triangle& t : mesh.triangles) {
    const Vec3d a = mesh.vertices[t[0]];
    const Vec3d normal = cross(mesh.vertices[t[1]] - a, mesh.vertices[t[2]] - a);
    const double most = tolerance * length(normal);
    for (const Vec3d& p : mesh.vertices) {
      if (dot(normal, p - a) > most) return false;
    }
  }
  return is_one_piece(mesh);
}

}  // namespace

CsgMesh sweep_mesh(const CsgRegion& region, const std::vector<MeshRing>& rings, RingEnds ends) {
  std::vector<Vec2d> corners;
  for (const Outline& outline : region.outlines) {
    corners.insert(corners.end(), outline.begin(), outline.end());
  }
  const auto count = Index(corners.size());
  std::vector<Vec3d> points;
  points.reserve(corners.size() * rings.size());
  for (const MeshRing& ring : rings) {
    for (const Vec2d& p : corners) points.push_back(ring(p));
  }
  std::vector<Triangle> triangles;
  const auto layers = Index(ends == RingEnds::joined ? rings.size() : rings.size() - 1);
  for (Index layer = 0; layer < layers; ++layer) {
    const Index below = layer * count, above = Index((layer + 1) % rings.size()) * count;
    Index first = 0;
    for (const Outline& outline : region.outlines) {
      const auto size = Index(outline.size());
      for (Index i = 0; i < size; ++i) {
        const Index a = below + first + i, b = below + first + (i + 1) % size;
        const Index c = above + first + (i + 1) % size, d = above + first + i;
        if (length_squared(points[a] - points[c]) <= length_squared(points[b] - points[d])) {
          triangles.insert(triangles.end(), {{a, b, c}, {a, c, d}});
        } else {
          triangles.insert(triangles.end(), {{a, b, d}, {b, c, d}});
        }
      }
      first += size;
    }
  }
  if (ends == RingEnds::closed_by_faces) {
    const std::optional<std::vector<Triangle>> cap = triangulate(region);
    if (!cap) throw ScadUnsupported{"the outline crosses itself"};
    const auto top = Index(rings.size() - 1) * count;
    for (const Triangle& t : *cap) {
      triangles.push_back({t[0], t[2], t[1]});
      triangles.push_back({top + t[0], top + t[1], top + t[2]});
    }
  }
  return welded(points, triangles);
}

std::variant<ClosedSolid, std::string> close_solid(const std::vector<Vec3d>& points,
                                                   const std::vector<Triangle>& triangles) {
  CsgMesh mesh = welded(points, triangles);
  if (mesh.triangles.size() < 4) return "it has fewer than four faces with an area";
  ClosedSolid solid;
  Turning turning(mesh);
  if (turning.unbalanced_edges() > 0) solid.turned = turning.make_consistent();
  if (const std::size_t open = turning.unbalanced_edges()) {
    return fmt::format("it isn't closed: {} edges have a face on one side only", open);
  }
  std::vector<Index> all(mesh.triangles.size());
  std::iota(all.begin(), all.end(), 0U);
  if (signed_volume(mesh, all) < 0) {
    for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
    solid.turned = true;
  }
  if (is_convex(mesh)) {
    if (std::optional<CsgPrimitive> hull = hull_of_points(mesh.vertices)) {
      solid.primitive = *std::move(hull);
      return solid;
    }
  }
  solid.primitive = std::move(mesh);
  return solid;
}

}  // namespace arris
