// Events of area lights, against what their definition says of every edge and vertex, and against hulls.
#include "edgepoint/shadow_events.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <tuple>
#include <vector>

#include "edgepoint/shadow_scene.h"

namespace arris {
namespace {

using test::FinderRandom;
using test::uniform;
using Corners = std::array<Vec3d, 4>;

ParallelogramLight random_light(FinderRandom& random) {
  const Vec3d middle = normalize(test::random_point(random, 1)) * uniform(random, 4, 6);
  Vec3d u, v;
  // Solids of radius 2 about the origin are all in front.
  do {
    u = test::random_point(random, 0.8);
    v = test::random_point(random, 0.8);
  } while (std::abs(dot(normalize(cross(u, v)), middle)) < 2);
  return {middle - (u + v) * 0.5, u, v, -middle};
}

// −1, 0 or 1: on which side of the plane through a, b, c.
int side(Vec3d a, Vec3d b, Vec3d c, Vec3d p) {
  const double d = dot(cross(b - a, c - a), p - a);
  return d > 0 ? 1 : d < 0 ? -1 : 0;
}

Vec3d third(const EdgeMesh& mesh, const MeshEdge& e, std::uint32_t face) {
  for (const std::uint32_t v : mesh.triangles[face]) {
    if (v != e.v0 && v != e.v1) return Vec3d(mesh.vertices[v]);
  }
  return {};
}

// Vertices of the event's edge (or the vertex twice), the light's corner and the kind.
using Key = std::tuple<std::uint32_t, std::uint32_t, int, ShadowKind, bool>;

std::set<Key> keys_of(const std::vector<ShadowEvent>& events, const Corners& l) {
  std::set<Key> keys;
  for (const ShadowEvent& e : events) {
    const auto corner = std::ranges::find(l, e.light[0].xyz) - l.begin();
    const bool ev = e.is_at_vertex();
    keys.insert({e.vertex[0], e.vertex[1], int(corner), e.kind, ev});
  }
  return keys;
}

// All but umbral EV events, by their definition.
std::set<Key> brute_force(const EdgeMesh& mesh, const Corners& l) {
  std::set<Key> keys;
  for (std::uint32_t e = 0; e < mesh.edges.size(); ++e) {
    if (mesh.is_concave(e)) continue;
    const MeshEdge& edge = mesh.edges[e];
    const Vec3d a(mesh.vertices[edge.v0]), b(mesh.vertices[edge.v1]);
    for (int i = 0; i < 4; ++i) {
      const auto sides = [&](Vec3d p) { return side(a, b, l[std::size_t(i)], p); };
      const int c0 = sides(third(mesh, edge, edge.face0));
      const int c1 = sides(third(mesh, edge, edge.face1));
      if (c0 != c1) continue;
      bool left = false, right = false;
      for (const Vec3d p : l) {
        left = left || (p != l[std::size_t(i)] && sides(p) > 0);
        right = right || (p != l[std::size_t(i)] && sides(p) < 0);
      }
      if (left == right) continue;
      const bool same = left == (c0 > 0);
      keys.insert({edge.v0, edge.v1, i, same ? ShadowKind::umbral : ShadowKind::penumbral, false});
    }
  }
  for (std::uint32_t q = 0; q < mesh.vertices.size(); ++q) {
    // A pit's edges are concave, or no point of the light sees them as outline.
    std::array<HomogeneousPoint, 4> from;
    std::ranges::transform(l, from.begin(), [](Vec3d p) { return HomogeneousPoint{p, 1}; });
    const bool shows = std::ranges::any_of(mesh.around(q), [&](std::uint32_t e) {
      return !mesh.is_concave(e) && may_be_silhouette(mesh, e, from);
    });
    if (!shows) continue;
    for (int i = 0; i < 4; ++i) {
      const Vec3d p(mesh.vertices[q]), li = l[std::size_t(i)], lj = l[std::size_t((i + 1) % 4)];
      const int light = side(p, li, lj, l[std::size_t((i + 2) % 4)]);
      bool tangential = !mesh.around(q).empty();
      for (const Triangle& t : mesh.triangles) {
        if (t[0] != q && t[1] != q && t[2] != q) continue;
        for (const std::uint32_t v : t) {
          if (v != q) tangential = tangential && side(p, li, lj, Vec3d(mesh.vertices[v])) == -light;
        }
      }
      if (tangential) keys.insert({q, q, i, ShadowKind::penumbral, true});
    }
  }
  return keys;
}

TEST(ShadowEvents, are_those_of_the_definition) {
  FinderRandom random(1);
  const std::vector<Mesh> meshes{make_box_mesh({1, 2, 1.5}), make_icosphere_mesh(1, 2),
                                 test::make_torus_mesh(1, 0.4, 14, 9),
                                 test::make_scan_like_mesh(3, 0.02, 1)};
  std::size_t count = 0;
  for (const Mesh& m : meshes) {
    const EdgeMesh mesh = test::edges_of(m);
    const EdgeTree tree(mesh);
    for (int i = 0; i < 20; ++i) {
      const ParallelogramLight light = random_light(random);
      std::vector<ShadowEvent> events = find_shadow_events(tree, light);
      std::erase_if(events, [](const ShadowEvent& e) {
        return e.is_at_vertex() && e.kind == ShadowKind::umbral;
      });
      const std::set<Key> found = keys_of(events, light.corners());
      EXPECT_EQ(found.size(), events.size());
      EXPECT_TRUE(found == brute_force(mesh, light.corners()));
      count += found.size();
    }
  }
  EXPECT_GT(count, 5000U);
}

TEST(ShadowEvents, of_a_point_are_the_silhouettes) {
  const EdgeMesh box = test::edges_of(make_box_mesh({1, 1, 1}));
  const EdgeTree tree(box);
  EXPECT_EQ(find_shadow_events(tree, HomogeneousPoint{{3, 4, 5}, 1}).size(), 6U);
  EXPECT_EQ(find_shadow_events(tree, HomogeneousPoint{{0, 0, 5}, 0}).size(), 4U);
}

using Polygon = std::vector<Vec2d>;  // counter-clockwise

double turn(Vec2d a, Vec2d b, Vec2d c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

Polygon hull(std::vector<Vec2d> points) {
  std::ranges::sort(points,
                    [](Vec2d a, Vec2d b) { return std::tie(a.x, a.y) < std::tie(b.x, b.y); });
  Polygon out;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t start = out.size();
    for (const Vec2d p : points) {
      while (out.size() >= start + 2 && turn(out[out.size() - 2], out.back(), p) <= 0)
        out.pop_back();
      out.push_back(p);
    }
    out.pop_back();
    std::ranges::reverse(points);
  }
  return out;
}

// What of the polygon lies to the left of each side of the other.
Polygon intersection(Polygon a, const Polygon& b) {
  for (std::size_t i = 0; i < b.size(); ++i) {
    const Vec2d p = b[i], q = b[(i + 1) % b.size()];
    Polygon out;
    for (std::size_t k = 0; k < a.size(); ++k) {
      const Vec2d s = a[k], t = a[(k + 1) % a.size()];
      const double ds = turn(p, q, s), dt = turn(p, q, t);
      if (ds >= 0) out.push_back(s);
      if ((ds >= 0) == (dt >= 0)) continue;
      const double u = ds / (ds - dt);
      out.push_back({s.x + (t.x - s.x) * u, s.y + (t.y - s.y) * u});
    }
    a = out;
  }
  return a;
}

// Points along the outline.
std::vector<Vec3d> points_along(const Polygon& polygon) {
  std::vector<Vec3d> out;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2d a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    for (double t = 0.05; t < 1; t += 0.1) {
      out.push_back({a.x + (b.x - a.x) * t, a.y + (b.y - a.y) * t, 0});
    }
  }
  return out;
}

double distance_to_outline(Vec3d p, const Polygon& polygon) {
  double best = 1e30;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2d a = polygon[i], b = polygon[(i + 1) % polygon.size()];
    best = std::min(best, test::distance_to_segment(p, {a.x, a.y, 0}, {b.x, b.y, 0}));
  }
  return best;
}

// On a floor the penumbra of a convex solid ends at the hull of its shadows from the light's corners, the umbra where
// they all lie.
TEST(ShadowEvents, of_convex_solids_bound_penumbra_and_umbra) {
  FinderRandom random(2);
  int umbras = 0;
  for (int round = 0; round < 60; ++round) {
    test::ShadowScene scene;
    scene.add(make_box_mesh({200, 200, 1}), {{}, {0, 0, -0.5}});
    const std::array<Mesh, 3> solids{make_box_mesh({1, 0.7, 1.2}), make_icosahedron_mesh(0.8),
                                     make_icosphere_mesh(0.9, 1)};
    scene.add(solids[std::size_t(round % 3)], {test::random_turn(random), {0, 0, 2}});
    const double size = round % 2 == 0 ? 0.4 : 1.5;
    const Vec3d u = test::random_point(random, size), v = test::random_point(random, size);
    const ParallelogramLight light{
        Vec3d{uniform(random, -2, 2), uniform(random, -2, 2), 8} - (u + v) * 0.5, u, v, {0, 0, -1}};
    const Vec3d normal = cross(u, v);
    // The whole solid in front of the light.
    if (std::abs(dot(normalize(normal), light.corner - Vec3d{0, 0, 2})) < 1.5) continue;
    ParallelogramLight towards = light;
    towards.toward = Vec3d{0, 0, 2} - light.corner;
    const std::vector<ShadowEdge> edges = scene.shadow_edges(1, towards);

    std::vector<Vec2d> all;
    std::optional<Polygon> umbra;
    for (const Vec3d l : light.corners()) {
      std::vector<Vec2d> shadow;
      for (const Vec3f& corner : scene.objects[1]->mesh.vertices) {
        const Vec3d p = transform_point(scene.objects[1]->world_from_object, Vec3d(corner));
        const Vec3d at = l + (p - l) * (l.z / (l.z - p.z));
        shadow.push_back({at.x, at.y});
      }
      all.insert(all.end(), shadow.begin(), shadow.end());
      umbra = umbra ? intersection(*umbra, hull(shadow)) : hull(shadow);
    }
    const Polygon penumbra = hull(all);
    std::vector<ShadowEdge> penumbral, umbral;
    for (const ShadowEdge& e : edges) {
      ASSERT_EQ(e.receiver, 0U);
      (e.kind == ShadowKind::penumbral ? penumbral : umbral).push_back(e);
    }
    double total = 0, around = 0;
    for (const ShadowEdge& e : penumbral) {
      EXPECT_LT(distance_to_outline(Vec3d(e.a), penumbra), 1e-5);
      EXPECT_LT(distance_to_outline(Vec3d(e.b), penumbra), 1e-5);
      total += length(Vec3d(e.b) - Vec3d(e.a));
    }
    for (std::size_t i = 0; i < penumbra.size(); ++i) {
      const Vec2d a = penumbra[i], b = penumbra[(i + 1) % penumbra.size()];
      around += std::hypot(b.x - a.x, b.y - a.y);
    }
    EXPECT_NEAR(total, around, 1e-4);
    for (const Vec3d p : points_along(penumbra)) {
      EXPECT_LT(test::distance_to_edges(p, penumbral, 0), 1e-5);
    }
    umbras += umbra->empty() ? 0 : 1;
    for (const Vec3d p : points_along(*umbra)) {
      EXPECT_LT(test::distance_to_edges(p, umbral, 0), 1e-5);
    }
  }
  EXPECT_GT(umbras, 10);
}

// A block with a notch: at the notch's inner corner the umbra's outline follows the light's edges.
TEST(ShadowEvents, concave_turns_have_umbral_ev_events) {
  Mesh mesh;
  const std::vector<Vec2d> outline{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  for (const float z : {0.0F, 0.25F}) {
    for (const Vec2d p : outline) mesh.positions.push_back({float(p.x), float(p.y), z});
  }
  for (const Triangle& t :
       {Triangle{0, 1, 3}, Triangle{1, 2, 3}, Triangle{0, 3, 5}, Triangle{3, 4, 5}}) {
    mesh.triangles.push_back({t[2], t[1], t[0]});
    mesh.triangles.push_back({t[0] + 6, t[1] + 6, t[2] + 6});
  }
  for (std::uint32_t i = 0; i < 6; ++i) {
    const std::uint32_t j = (i + 1) % 6;
    mesh.triangles.push_back({i, j, j + 6});
    mesh.triangles.push_back({i, j + 6, i + 6});
  }
  const EdgeMesh edges = test::edges_of(mesh);
  ASSERT_TRUE(edges.closed);
  const EdgeTree tree(edges);
  // Turned against the notch, so that one edge of the light meets its corner first.
  const ParallelogramLight light{{1.3, 0.5, 3}, {0.5, 0.4, 0}, {-0.4, 0.5, 0}, {0, 0, -1}};
  int umbral = 0, elsewhere = 0;
  for (const ShadowEvent& e : find_shadow_events(tree, light)) {
    if (!e.is_at_vertex() || e.kind != ShadowKind::umbral) continue;
    const Vec3d q = e.origin[0];
    (q.x == 1 && q.y == 1 ? umbral : elsewhere) += 1;
  }
  EXPECT_GT(umbral, 0);
  EXPECT_EQ(elsewhere, 0);
}

}  // namespace
}  // namespace arris
