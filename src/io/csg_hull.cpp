#include "io/csg_hull.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <memory>
#include <string>

extern "C" {
#include <libqhull_r/qhull_ra.h>
}

namespace arris {
namespace {

constexpr double kSixDigits = 4e-6;  // of the size: what numbers of six digits leave open
constexpr std::size_t kMaxDiscs = 400;

// Of points about the origin of size 1.
class Qhull {
 public:
  Qhull() : sink_(std::fopen("/dev/null", "w"), &std::fclose) { qh_zero(&qh_, sink_.get()); }
  Qhull(const Qhull&) = delete;
  Qhull& operator=(const Qhull&) = delete;
  ~Qhull() {
    int remaining = 0, total = 0;
    qh_freeqhull(&qh_, !qh_ALL);
    qh_memfreeshort(&qh_, &remaining, &total);
  }

  bool run(std::vector<Vec3d>& points, std::string options) {
    qhT* const qh = &qh_;  // the name that the library's macros expect
    return qh_new_qhull(qh, 3, int(points.size()), &points[0].x, False, options.data(), sink_.get(),
                        sink_.get()) == 0;
  }

  // Each facet's normal and the numbers of its vertices.
  struct Facet {
    Vec3d normal;
    std::vector<std::uint32_t> vertices;
  };
  std::vector<Facet> facets() {
    qhT* const qh = &qh_;
    std::vector<Facet> facets;
    facetT* facet = nullptr;
    FORALLfacets {
      Facet& made = facets.emplace_back();
      made.normal = {facet->normal[0], facet->normal[1], facet->normal[2]};
      vertexT* vertex = nullptr;
      vertexT** vertexp = nullptr;
      FOREACHvertex_(facet->vertices) {
        made.vertices.push_back(std::uint32_t(qh_pointid(qh, vertex->point)));
      }
    }
    return facets;
  }

 private:
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> sink_;
  qhT qh_;
};

struct Unit {
  Vec3d middle;
  double size = 0;
  std::vector<Vec3d> points;
};

Unit to_unit(const std::vector<Vec3d>& points) {
  Vec3d low(1e300), high(-1e300);
  for (const Vec3d& p : points) {
    low = min(low, p);
    high = max(high, p);
  }
  Unit unit{(low + high) * 0.5, max_component(high - low), {}};
  if (!(unit.size > 0)) return unit;
  for (const Vec3d& p : points) unit.points.push_back((p - unit.middle) / unit.size);
  return unit;
}

Vec3d without_noise(Vec3d normal) {
  for (int axis = 0; axis < 3; ++axis) {
    if (std::abs(normal[axis]) < 1e-12) normal[axis] = 0;
  }
  return normalize(normal);
}

CsgMesh mesh_of_hull(Qhull& qhull, const std::vector<Vec3d>& points) {
  CsgMesh mesh;
  std::map<std::uint32_t, std::uint32_t> number;
  for (const Qhull::Facet& facet : qhull.facets()) {
    if (facet.vertices.size() != 3) continue;
    Triangle triangle{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [entry, is_new] =
          number.try_emplace(facet.vertices[k], std::uint32_t(mesh.vertices.size()));
      if (is_new) mesh.vertices.push_back(points[facet.vertices[k]]);
      triangle[k] = entry->second;
    }
    const Vec3d a = mesh.vertices[triangle[0]];
    const Vec3d turn = cross(mesh.vertices[triangle[1]] - a, mesh.vertices[triangle[2]] - a);
    if (dot(turn, facet.normal) < 0) std::swap(triangle[1], triangle[2]);
    mesh.triangles.push_back(triangle);
  }
  return mesh;
}

}  // namespace

std::optional<CsgPolyhedron> hull_polyhedron(const std::vector<Vec3d>& points) {
  Unit unit = to_unit(points);
  if (unit.points.size() < 4) return std::nullopt;
  Qhull qhull;
  if (!qhull.run(unit.points, "qhull Pp C2e-6")) return std::nullopt;
  CsgPolyhedron hull;
  std::vector<std::uint32_t> used;
  for (const Qhull::Facet& facet : qhull.facets()) {
    CsgHalfSpace& face = hull.faces.emplace_back();
    face.normal = without_noise(facet.normal);
    face.d = -std::numeric_limits<double>::infinity();
    for (const std::uint32_t v : facet.vertices)
      face.d = std::max(face.d, dot(face.normal, points[v]));
    used.insert(used.end(), facet.vertices.begin(), facet.vertices.end());
  }
  std::ranges::sort(used);
  used.erase(std::unique(used.begin(), used.end()), used.end());
  for (const std::uint32_t v : used) hull.vertices.push_back(points[v]);
  if (hull.faces.size() < 4) return std::nullopt;
  // Merged faces are moved out to their farthest vertex.
  for (const Vec3d& p : hull.vertices) {
    for (CsgHalfSpace& face : hull.faces) face.d = std::max(face.d, dot(face.normal, p));
  }
  return hull;
}

std::optional<CsgPrimitive> hull_of_points(const std::vector<Vec3d>& points) {
  if (points.size() <= 2 * kMaxPolyhedronFaces) {
    std::optional<CsgPolyhedron> hull = hull_polyhedron(points);
    if (!hull) return std::nullopt;
    if (hull->faces.size() <= kMaxPolyhedronFaces) return *std::move(hull);
  }
  Unit unit = to_unit(points);
  Qhull qhull;
  if (unit.points.size() < 4 || !qhull.run(unit.points, "qhull Pp Qt")) return std::nullopt;
  return mesh_of_hull(qhull, points);
}

// Andrew's monotone chain.
Outline hull_of_points(std::vector<Vec2d> points) {
  std::ranges::sort(points, [](Vec2d a, Vec2d b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return {};
  const Vec2d extent = points.back() - points.front();
  const double least = 1e-14 * (extent.x * extent.x + extent.y * extent.y);
  Outline hull;
  const auto half = [&](auto begin, auto end) {
    const std::size_t first = hull.size();
    for (auto p = begin; p != end; ++p) {
      while (hull.size() >= first + 2 &&
             cross(hull.back() - hull[hull.size() - 2], *p - hull.back()) <= least) {
        hull.pop_back();
      }
      hull.push_back(*p);
    }
    hull.pop_back();
  };
  half(points.begin(), points.end());
  half(points.rbegin(), points.rend());
  if (hull.size() < 3) hull.clear();
  return hull;
}

// -------------------------------------------------------------------------------------------------- balls

namespace {

// A frame whose z is `axis`.
Mat3d frame_about(Vec3d axis) {
  const Vec3d z = normalize(axis);
  const Vec3d other = std::abs(z.x) < 0.6 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0);
  const Vec3d x = normalize(cross(other, z));
  return {x, cross(z, x), z};
}

SolidShape ball(const Ball& b, const LeafMaker& make_leaf) {
  return make_leaf(CsgSphere{b.radius}, {Mat3d{}, b.center});
}

// Frustum that touches both balls; a cylinder for equal ones.
SolidShape sleeve(const Ball& a, const Ball& b, const LeafMaker& make_leaf) {
  const Vec3d along = b.center - a.center;
  const double distance = length(along);
  const double sine = (a.radius - b.radius) / distance, cosine = std::sqrt(1 - sine * sine);
  const CsgCone cone{a.radius * sine, distance + b.radius * sine, a.radius * cosine,
                     b.radius * cosine};
  return make_leaf(cone, {frame_about(along), a.center});
}

std::vector<Ball> without_repeats(const std::vector<Ball>& balls, double size) {
  std::vector<Ball> kept;
  for (const Ball& b : balls) {
    const bool known = std::any_of(kept.begin(), kept.end(), [&](const Ball& k) {
      return length(k.center - b.center) <= 1e-9 * size &&
             std::abs(k.radius - b.radius) <= 1e-9 * size;
    });
    if (!known) kept.push_back(b);
  }
  return kept;
}

// Balls of one radius about points of a plane: a slab, cylinders along its edges, balls at its corners.
SolidShape hull_of_flat_balls(const std::vector<Ball>& balls, Vec3d normal,
                              const LeafMaker& make_leaf) {
  const Affine3d place{frame_about(normal), balls[0].center};
  const Affine3d back = inverse(place);
  std::vector<Vec2d> centers;
  for (const Ball& b : balls) {
    const Vec3d p = transform_point(back, b.center);
    centers.push_back({p.x, p.y});
  }
  const Outline outline = hull_of_points(centers);
  const double r = balls[0].radius;
  std::vector<Vec3d> corners;
  std::vector<SolidShape> parts(1);
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const auto at = [&](std::size_t k) {
      const Vec2d p = outline[k % outline.size()];
      return Ball{transform_point(place, {p.x, p.y, 0}), r};
    };
    for (const double z : {-r, r}) {
      corners.push_back(transform_point(place, {outline[i].x, outline[i].y, z}));
    }
    parts.push_back(sleeve(at(i), at(i + 1), make_leaf));
    parts.push_back(ball(at(i), make_leaf));
  }
  if (std::optional<CsgPrimitive> slab = hull_of_points(corners))
    parts[0] = make_leaf(*std::move(slab));
  return combine(CsgOperation::unite, std::move(parts));
}

SolidShape hull_of_equal_balls(const std::vector<Ball>& balls, const LeafMaker& make_leaf) {
  const auto farthest = [&](const auto& measure) {
    return *std::ranges::max_element(balls, {}, [&](const Ball& b) { return measure(b.center); });
  };
  const Vec3d a = farthest([&](Vec3d p) { return length(p - balls[0].center); }).center;
  const Vec3d b = farthest([&](Vec3d p) { return length(p - a); }).center;
  const double size = length(b - a);
  const Vec3d axis = normalize(b - a);
  const auto off_axis = [&](Vec3d p) { return length(cross(p - a, axis)); };
  const Vec3d c = farthest(off_axis).center;
  if (off_axis(c) <= kSixDigits * size) {
    const Ball first{a, balls[0].radius}, last{b, balls[0].radius};
    std::vector<SolidShape> parts{sleeve(first, last, make_leaf), ball(first, make_leaf),
                                  ball(last, make_leaf)};
    return combine(CsgOperation::unite, std::move(parts));
  }
  const Vec3d normal = normalize(cross(axis, c - a));
  const Vec3d d = farthest([&](Vec3d p) { return std::abs(dot(p - a, normal)); }).center;
  std::vector<Vec3d> centers;
  for (const Ball& each : balls) centers.push_back(each.center);
  std::optional<CsgPolyhedron> core;
  if (std::abs(dot(d - a, normal)) > kSixDigits * size) core = hull_polyhedron(centers);
  if (core) return make_leaf(CsgRounded{*std::move(core), balls[0].radius});
  return hull_of_flat_balls(balls, normal, make_leaf);
}

SolidShape hull_of_two_balls(Ball a, Ball b, const LeafMaker& make_leaf) {
  if (a.radius < b.radius) std::swap(a, b);
  if (length(b.center - a.center) <= a.radius - b.radius) return ball(a, make_leaf);
  std::vector<SolidShape> parts{sleeve(a, b, make_leaf), ball(a, make_leaf)};
  if (b.radius > 0) parts.push_back(ball(b, make_leaf));
  return combine(CsgOperation::unite, std::move(parts));
}

}  // namespace

std::optional<SolidShape> hull_of_balls(std::vector<Ball> balls, const LeafMaker& make_leaf) {
  if (balls.empty()) return SolidShape{};
  double size = 0, least = balls[0].radius, most = 0;
  for (const Ball& b : balls) {
    size = std::max(size, length(b.center - balls[0].center) + b.radius);
    least = std::min(least, b.radius);
    most = std::max(most, b.radius);
  }
  if (most == 0) {
    std::vector<Vec3d> points;
    for (const Ball& b : balls) points.push_back(b.center);
    std::optional<CsgPrimitive> hull = hull_of_points(points);
    return hull ? make_leaf(*std::move(hull)) : SolidShape{};
  }
  if (balls.size() > 10'000) return std::nullopt;
  balls = without_repeats(balls, size);
  if (balls.size() == 1) return ball(balls[0], make_leaf);
  if (most - least <= kSixDigits * most) {
    for (Ball& b : balls) b.radius = most;
    return hull_of_equal_balls(balls, make_leaf);
  }
  if (balls.size() == 2) return hull_of_two_balls(balls[0], balls[1], make_leaf);
  return std::nullopt;
}

// -------------------------------------------------------------------------------------------------- discs

namespace {

bool is_within(const Disc2d& inner, const Disc2d& outer) {
  return std::hypot(inner.center.x - outer.center.x, inner.center.y - outer.center.y) +
             inner.radius <=
         outer.radius;
}

std::vector<Disc2d> without_covered(const std::vector<Disc2d>& discs) {
  std::vector<Disc2d> kept;
  for (const Disc2d& disc : discs) {
    if (std::any_of(kept.begin(), kept.end(), [&](const Disc2d& k) { return is_within(disc, k); }))
      continue;
    std::erase_if(kept, [&](const Disc2d& k) { return is_within(k, disc); });
    kept.push_back(disc);
  }
  return kept;
}

// Points are as many as there like; only those on their own hull can matter.
std::vector<Disc2d> without_inner_points(const std::vector<Disc2d>& discs) {
  std::vector<Vec2d> points;
  std::vector<Disc2d> kept;
  for (const Disc2d& disc : discs) {
    if (disc.radius == 0) {
      points.push_back(disc.center);
    } else {
      kept.push_back(disc);
    }
  }
  const Outline outline = hull_of_points(points);
  for (const Vec2d& p : outline.empty() ? points : outline) kept.push_back({p, 0, 0});
  return kept;
}

}  // namespace

std::optional<FlatShape> hull_of_discs(std::vector<Disc2d> discs) {
  discs = without_inner_points(discs);
  const bool all_points =
      std::all_of(discs.begin(), discs.end(), [](const Disc2d& d) { return d.radius == 0; });
  if (all_points) {
    std::vector<Vec2d> points;
    for (const Disc2d& disc : discs) points.push_back(disc.center);
    Outline outline = hull_of_points(std::move(points));
    return make_flat(outline.empty() ? CsgRegion{} : CsgRegion{{std::move(outline)}});
  }
  if (discs.size() > kMaxDiscs) return std::nullopt;
  discs = without_covered(discs);
  const auto round = [](const Disc2d& d) {
    return make_flat(FlatDisc{d.center, {d.radius, 0}, {0, d.radius}, d.facets});
  };
  if (discs.size() == 1) return round(discs[0]);
  double size = 0;
  for (const Disc2d& d : discs) {
    size =
        std::max(size, std::hypot(d.center.x - discs[0].center.x, d.center.y - discs[0].center.y) +
                           d.radius);
  }
  std::vector<Vec2d> touched;
  std::vector<std::uint8_t> is_outer(discs.size(), 0);
  // A line that touches two discs and has all others on its left.
  for (std::size_t i = 0; i < discs.size(); ++i) {
    for (std::size_t k = 0; k < discs.size(); ++k) {
      const Vec2d along = discs[k].center - discs[i].center;
      const double distance = std::hypot(along.x, along.y);
      if (i == k || !(distance > 0)) continue;
      const Vec2d d = along * (1 / distance);
      const double sine = (discs[i].radius - discs[k].radius) / distance;
      if (std::abs(sine) > 1) continue;
      const Vec2d normal = d * sine + Vec2d{d.y, -d.x} * std::sqrt(1 - sine * sine);
      const auto reach = [&](const Disc2d& disc) {
        return normal.x * disc.center.x + normal.y * disc.center.y + disc.radius;
      };
      const double most = reach(discs[i]) + 1e-9 * size;
      if (std::any_of(discs.begin(), discs.end(), [&](const Disc2d& o) { return reach(o) > most; }))
        continue;
      touched.push_back(discs[i].center + normal * discs[i].radius);
      touched.push_back(discs[k].center + normal * discs[k].radius);
      is_outer[i] = is_outer[k] = 1;
    }
  }
  std::vector<FlatShape> parts;
  Outline outline = hull_of_points(std::move(touched));
  if (!outline.empty()) parts.push_back(make_flat(CsgRegion{{std::move(outline)}}));
  for (std::size_t i = 0; i < discs.size(); ++i) {
    if (is_outer[i] != 0 && discs[i].radius > 0) parts.push_back(round(discs[i]));
  }
  return combine(CsgOperation::unite, std::move(parts));
}

}  // namespace arris
