// Shadow edges lie where the light comes into view, and nowhere else.
#include "edgepoint/shadow_edges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "edgepoint/shadow_scene.h"

namespace arris {
namespace {

using test::FinderRandom;
using test::ShadowScene;
using test::uniform;

// A point on a face, and a way to look to the light from it.
struct FacePoint {
  const test::ShadowObject* object;
  std::size_t receiver, face;
  Vec3d normal;  // unit, outward in the world

  [[nodiscard]] static FacePoint of(const ShadowScene& scene, std::size_t receiver,
                                    std::size_t face) {
    const test::ShadowObject& o = *scene.objects[receiver];
    const auto& t = o.world[face];
    Vec3d n = normalize(cross(t[1] - t[0], t[2] - t[0]));
    if (determinant(o.world_from_object.linear) < 0) n = -n;
    return {&o, receiver, face, n};
  }
  [[nodiscard]] bool faces(const HomogeneousPoint& light) const {
    return dot(normal, light.xyz - object->world[face][0] * light.w) > 0;
  }
};

bool lit(const ShadowScene& scene, const FacePoint& at, Vec3d p, const HomogeneousPoint& light) {
  return scene.sees(p + at.normal * 1e-7, light);
}

// The face of a receiver that a point lies on.
FacePoint face_below(const ShadowScene& scene, std::size_t receiver, Vec3d p) {
  const test::ShadowObject& o = *scene.objects[receiver];
  std::size_t best = 0;
  double nearest = 1e30;
  for (std::size_t f = 0; f < o.world.size(); ++f) {
    const auto& t = o.world[f];
    const Vec3d n = normalize(cross(t[1] - t[0], t[2] - t[0]));
    double outside = std::abs(dot(n, p - t[0]));
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d e = normalize(t[(k + 1) % 3] - t[k]);
      outside = std::max(outside, -dot(cross(n, e), p - t[k]));
    }
    if (outside < nearest) nearest = outside, best = f;
  }
  return FacePoint::of(scene, receiver, best);
}

struct Tally {
  int right = 0, all = 0;
};

// On both sides of each edge's middle: one sees the light and the other does not.
Tally count_changes(const ShadowScene& scene, const std::vector<ShadowEdge>& edges,
                    const HomogeneousPoint& light) {
  Tally tally;
  for (const ShadowEdge& e : edges) {
    const Vec3d a(e.a), b(e.b), middle = (a + b) * 0.5;
    if (length(b - a) < 1e-3) continue;
    const FacePoint at = face_below(scene, e.receiver, middle);
    // Edges are stored as float: back onto the face.
    const Vec3d p = middle - at.normal * dot(at.normal, middle - at.object->world[at.face][0]);
    const Vec3d step = normalize(cross(at.normal, b - a)) * 1e-4;
    ++tally.all;
    tally.right += lit(scene, at, p + step, light) != lit(scene, at, p - step, light) ? 1 : 0;
  }
  return tally;
}

// Whether the surface of another object passes through a point.
bool is_on_another(const ShadowScene& scene, std::size_t receiver, Vec3d p) {
  for (std::size_t r = 0; r < scene.objects.size(); ++r) {
    if (r == receiver) continue;
    for (const auto& t : scene.objects[r]->world) {
      const Vec3d n = normalize(cross(t[1] - t[0], t[2] - t[0]));
      double outside = std::abs(dot(n, p - t[0]));
      for (std::size_t k = 0; k < 3; ++k) {
        outside = std::max(outside, -dot(cross(n, normalize(t[(k + 1) % 3] - t[k])), p - t[k]));
      }
      if (outside < 1e-5) return true;
    }
  }
  return false;
}

// Random pairs of points of faces that look to the light: where one of them sees it, the place between where this
// changes must be on an edge.
// Where solids enter each other it changes without one.
struct Changes {
  int count = 0, entered = 0;
  double farthest = 0;  // from an edge; of those not entered
};

Changes find_changes(const ShadowScene& scene, const std::vector<ShadowEdge>& edges,
                     const HomogeneousPoint& light, FinderRandom& random) {
  Changes changes;
  for (std::size_t r = 0; r < scene.objects.size(); ++r) {
    for (std::size_t f = 0; f < scene.objects[r]->world.size(); ++f) {
      const FacePoint at = FacePoint::of(scene, r, f);
      if (!at.faces(light)) continue;
      const auto& t = scene.objects[r]->world[f];
      const auto point = [&] {
        double u = uniform(random, 0, 1), v = uniform(random, 0, 1);
        if (u + v > 1) u = 1 - u, v = 1 - v;
        return t[0] + (t[1] - t[0]) * u + (t[2] - t[0]) * v;
      };
      const int pairs = r == 0 ? 300 : 6;
      for (int i = 0; i < pairs; ++i) {
        Vec3d p = point(), q = point();
        const bool p_lit = lit(scene, at, p, light);
        if (p_lit == lit(scene, at, q, light)) continue;
        for (int k = 0; k < 30; ++k) {
          const Vec3d m = (p + q) * 0.5;
          (lit(scene, at, m, light) == p_lit ? p : q) = m;
        }
        ++changes.count;
        const double away = test::distance_to_edges(p, edges, r);
        if (away > 1e-4 && is_on_another(scene, r, p)) {
          ++changes.entered;
        } else {
          changes.farthest = std::max(changes.farthest, away);
        }
      }
    }
  }
  return changes;
}

TEST(ShadowEdges, lie_where_visibility_changes) {
  Tally all;
  int changes = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    FinderRandom random(seed);
    const ShadowScene scene = test::random_shadow_scene(random);
    HomogeneousPoint light{{uniform(random, -2, 2), uniform(random, -2, 2), 9}, 1};
    if (seed % 3 == 0) light = {{uniform(random, -1, 1), uniform(random, -1, 1), 2}, 0};
    const std::vector<ShadowEdge> edges = scene.all_shadow_edges(light);
    const Tally tally = count_changes(scene, edges, light);
    all.right += tally.right;
    all.all += tally.all;
    const Changes found = find_changes(scene, edges, light, random);
    changes += found.count;
    EXPECT_EQ(found.entered, 0);
    EXPECT_LT(found.farthest, 2e-5) << seed;
  }
  EXPECT_GT(changes, 500);
  EXPECT_GT(all.all, 500);
  EXPECT_EQ(all.right, all.all);
}

TEST(ShadowEdges, where_solids_enter_each_other_visibility_changes_there_too) {
  int changes = 0, entered = 0;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    FinderRandom random(seed);
    const ShadowScene scene = test::random_shadow_scene(random, test::Solids::anywhere);
    const HomogeneousPoint light{{uniform(random, -2, 2), uniform(random, -2, 2), 11}, 1};
    const std::vector<ShadowEdge> edges = scene.all_shadow_edges(light);
    const Changes found = find_changes(scene, edges, light, random);
    changes += found.count;
    entered += found.entered;
    EXPECT_LT(found.farthest, 2e-5) << seed;
  }
  EXPECT_GT(entered, 0);
  EXPECT_GT(changes, 500);
}

std::vector<ShadowEdge> on_receiver(const std::vector<ShadowEdge>& edges, std::uint32_t receiver,
                                    ShadowKind kind) {
  std::vector<ShadowEdge> out;
  for (const ShadowEdge& e : edges) {
    if (e.receiver == receiver && e.kind == kind) out.push_back(e);
  }
  return out;
}

double total_length(const std::vector<ShadowEdge>& edges) {
  double sum = 0;
  for (const ShadowEdge& e : edges) sum += length(Vec3d(e.b) - Vec3d(e.a));
  return sum;
}

// A floor at z = 0, large and thick, as object 0.
ShadowScene scene_on_floor() {
  ShadowScene scene;
  scene.add(make_box_mesh({40, 40, 1}), {{}, {0, 0, -0.5}});
  return scene;
}

TEST(ShadowEdges, a_box_above_a_floor_throws_the_outline_of_its_top) {
  ShadowScene scene = scene_on_floor();
  scene.add(make_box_mesh({1, 1, 1}), {{}, {0, 0, 1.5}});
  const std::vector<ShadowEdge> edges = scene.shadow_edges(1, HomogeneousPoint{{0, 0, 5}, 1});
  ASSERT_FALSE(edges.empty());
  const double half = 0.5 * 5 / 3;
  for (const ShadowEdge& e : edges) {
    EXPECT_EQ(e.receiver, 0U);
    for (const Vec3f p : {e.a, e.b}) {
      EXPECT_NEAR(std::max(std::abs(p.x), std::abs(p.y)), half, 1e-6);
      EXPECT_NEAR(p.z, 0, 1e-6);
    }
  }
  EXPECT_NEAR(total_length(edges), 8 * half, 1e-5);
}

TEST(ShadowEdges, a_box_on_a_floor_throws_a_shadow_from_where_it_stands) {
  ShadowScene scene = scene_on_floor();
  scene.add(make_box_mesh({1, 1, 1}), {{}, {0, 0, 0.5}});
  const std::vector<ShadowEdge> edges = scene.shadow_edges(1, HomogeneousPoint{{4, 4, 0.5}, 0});
  // The direction (4, 4, 0.5) sends a point at height 1 by 8 along −x and −y.
  const std::vector<Vec3d> outline{
      {0.5, -0.5, 0}, {-7.5, -8.5, 0}, {-8.5, -8.5, 0}, {-8.5, -7.5, 0}, {-0.5, 0.5, 0}};
  for (std::size_t i = 0; i + 1 < outline.size(); ++i) {
    for (double t = 0; t <= 1; t += 0.0625) {
      const Vec3d p = outline[i] + (outline[i + 1] - outline[i]) * t;
      EXPECT_LT(test::distance_to_edges(p, edges, 0), 1e-5);
    }
  }
  for (const ShadowEdge& e : edges) {
    if (e.receiver != 0) continue;
    const Vec3d middle = (Vec3d(e.a) + Vec3d(e.b)) * 0.5;
    double nearest = 1;
    for (std::size_t i = 0; i + 1 < outline.size(); ++i) {
      nearest = std::min(nearest, test::distance_to_segment(middle, outline[i], outline[i + 1]));
    }
    // The edges on which the box stands are edges of its shadow, too.
    const bool stands = std::max(std::abs(middle.x), std::abs(middle.y)) < 0.5 + 1e-6;
    EXPECT_TRUE(nearest < 1e-5 || stands);
  }
}

TEST(ShadowEdges,
     an_edge_under_an_area_light_has_umbra_and_penumbra_where_the_planes_meet_the_floor) {
  ShadowScene scene = scene_on_floor();
  scene.add(make_box_mesh({4, 8, 0.125}),
            {{}, {-2, 0, 1.0625}});  // ends at x = 0, z from 1 to 1.125
  const ParallelogramLight light{{-0.5, -0.5, 3}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}};
  const std::vector<ShadowEdge> edges = scene.shadow_edges(1, light);
  const auto penumbral = on_receiver(edges, 0, ShadowKind::penumbral);
  const auto umbral = on_receiver(edges, 0, ShadowKind::umbral);
  for (const double y : {-2.0, -0.3, 0.0, 0.7, 1.9}) {
    // From the light's far side over the top edge; from its near side under the bottom edge.
    EXPECT_LT(test::distance_to_edges({0.5 * 1.125 / 1.875, y, 0}, penumbral, 0), 1e-6);
    EXPECT_LT(test::distance_to_edges({-0.5 * 1.0 / 2.0, y, 0}, umbral, 0), 1e-6);
  }
  for (const ShadowEdge& e : penumbral) {
    EXPECT_LT(e.a.x, 0.5 * 1.125 / 1.875 + 1e-6);
  }
}

TEST(ShadowEdges, penumbra_hardens_at_contact) {
  ShadowScene scene = scene_on_floor();
  scene.add(make_box_mesh({1, 1, 1}), {{}, {0, 0, 0.5}});
  const ParallelogramLight light{{6, 5, 4}, {0.5, -0.5, 0}, {0, 0, 1}, {-1, -1, 0}};
  const std::vector<ShadowEdge> edges = scene.shadow_edges(1, light);
  for (const ShadowKind kind : {ShadowKind::penumbral, ShadowKind::umbral}) {
    const auto some = on_receiver(edges, 0, kind);
    for (const Vec3d corner : {Vec3d{0.5, -0.5, 0}, Vec3d{-0.5, 0.5, 0}}) {
      EXPECT_LT(test::distance_to_edges(corner, some, 0), 1e-5);
    }
  }
  // A unit along the shadow both are apart.
  const auto umbral = on_receiver(edges, 0, ShadowKind::umbral);
  for (const ShadowEdge& e : on_receiver(edges, 0, ShadowKind::penumbral)) {
    for (const Vec3f p : {e.a, e.b}) {
      if (length(Vec3d(p) - Vec3d{0.5, -0.5, 0}) > 0.5 && p.x > p.y && p.x < -0.6) {
        EXPECT_GT(test::distance_to_edges(Vec3d(p), umbral, 0), 1e-3);
      }
    }
  }
}

// A square light of side 1 at height 4 over a box whose top is at height 1: on the floor, all edges along the box's
// sides have a penumbra of 1 · 1 / 3 across, and at contact none.
TEST(ShadowEdges, penumbras_are_as_wide_as_the_light_makes_them) {
  ShadowScene scene = scene_on_floor();
  scene.add(make_box_mesh({1, 1, 1}), {{}, {0, 0, 0.5}});
  const ParallelogramLight light{{-0.5, 1.5, 4}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}};
  int along_x = 0;
  for (const ShadowEdge& e : scene.shadow_edges(1, light)) {
    if (e.receiver != 0) continue;
    EXPECT_NEAR(e.penumbra.z, 0, 1e-5);
    const Vec3d a(e.a), b(e.b);
    if (length(b - a) < 1e-3 || std::abs(a.y - b.y) > 1e-6 || a.y > -0.51) continue;
    ++along_x;  // thrown by the far side of the top
    EXPECT_NEAR(std::abs(e.penumbra.y), 1.0 / 3, 1e-5);
    // It leads to where the shadow's other edge is.
    const double other = (a.y + double(e.penumbra.y));
    EXPECT_NEAR(std::min(a.y, other), -0.5 - (2.5 + 0.5) / 3, 1e-5);
  }
  EXPECT_GE(along_x, 2);
}

TEST(ShadowEdges, penumbras_lie_in_the_plane_of_the_face_that_shows_them) {
  ShadowScene scene = scene_on_floor();
  scene.add(make_box_mesh({1, 1, 1}), {{}, {0, 0, 2}});
  const Vec3d wall{1, 0, 0}, size{0.5, 8, 8};
  scene.add(make_box_mesh(size), {{}, {-3, 0, 0}});
  const ParallelogramLight light{{4, -0.5, 3}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}};
  int count = 0;
  for (const ShadowEdge& e : scene.shadow_edges(1, light)) {
    if (e.receiver != 2 || std::abs(double(e.a.x) + 2.75) > 1e-5) continue;
    EXPECT_NEAR(dot(wall, Vec3d(e.penumbra)), 0, 1e-5);
    ++count;
  }
  EXPECT_GT(count, 4);
}

TEST(ShadowEdges, a_light_throws_no_shadow_behind_itself) {
  ShadowScene scene = scene_on_floor();
  scene.add(make_box_mesh({1, 1, 1}), {{}, {0, 0, 1.5}});
  ParallelogramLight light{{-0.5, -0.5, 4}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}};
  EXPECT_FALSE(scene.shadow_edges(1, light).empty());
  light.toward = {0, 0, 1};
  EXPECT_TRUE(scene.shadow_edges(1, light).empty());
  // Half of the box is behind the light.
  light = {{-0.5, -0.5, 1.5}, {1, 0, 0}, {0, 1, 0}, {0, 0, -1}};
  for (const ShadowEdge& e : scene.shadow_edges(1, light)) {
    EXPECT_LT(e.a.z, 1.5);
    EXPECT_LT(e.b.z, 1.5);
  }
}

// How much of an area light a point sees: all, nothing or some, by rays to points along its outline.
enum class Sight { all, some, nothing };

Sight sight(const ShadowScene& scene, const FacePoint& at, Vec3d p,
            const ParallelogramLight& light) {
  constexpr int kAlong = 48;
  const std::array<Vec3d, 4> l = light.corners();
  int seen = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    for (int k = 0; k < kAlong; ++k) {
      const Vec3d x = l[i] + (l[(i + 1) % 4] - l[i]) * (double(k) / kAlong);
      seen += lit(scene, at, p, {x, 1}) ? 1 : 0;
    }
  }
  return seen == 0 ? Sight::nothing : seen == 4 * kAlong ? Sight::all : Sight::some;
}

// Whether one object alone hides the light's outline from a point of the floor.
bool is_hidden_by_one(const ShadowScene& scene, Vec3d p, const ParallelogramLight& light) {
  constexpr int kAlong = 24;
  const std::array<Vec3d, 4> l = light.corners();
  return std::ranges::any_of(scene.objects, [&](const auto& object) {
    for (std::size_t i = 0; i < 4; ++i) {
      for (int k = 0; k < kAlong; ++k) {
        const Vec3d x = l[i] + (l[(i + 1) % 4] - l[i]) * (double(k) / kAlong);
        const bool hidden = std::ranges::any_of(object->world, [&](const auto& t) {
          const std::optional<double> at = test::hit(t, p, x - p);
          return at && *at > 1e-9 && *at < 1;
        });
        if (!hidden) return false;
      }
    }
    return true;
  });
}

// Where the light begins to be hidden there is a penumbral edge; where one object hides it wholly, mostly an umbral one
// (in 40 such scenes at 167 of 169 places; events of three edges are not looked for). Rays go to points of the light's
// outline that are a 48th of its sides apart, so places are known that well.
TEST(ShadowEdges, area_lights_begin_to_be_hidden_at_penumbral_edges_and_are_hidden_at_umbral_ones) {
  int near_penumbral = 0, penumbral_changes = 0, near_umbral = 0, umbral_changes = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    FinderRandom random(seed);
    const ShadowScene scene = test::random_shadow_scene(random);
    const ParallelogramLight light{{uniform(random, -1, 1), uniform(random, -1, 1), 11},
                                   {0.8, 0.1, 0},
                                   {-0.1, 0.6, 0.1},
                                   {0, 0, -1}};
    const std::vector<ShadowEdge> edges = scene.all_shadow_edges(light);
    const auto penumbral = on_receiver(edges, 0, ShadowKind::penumbral);
    const auto umbral = on_receiver(edges, 0, ShadowKind::umbral);
    const FacePoint floor = face_below(scene, 0, {0.1, 0.2, 0});
    for (int i = 0; i < 150; ++i) {
      Vec3d p{uniform(random, -6, 6), uniform(random, -6, 6), 0};
      Vec3d q = p + Vec3d{uniform(random, -1, 1), uniform(random, -1, 1), 0};
      if (std::max(std::abs(q.x), std::abs(q.y)) > 6) continue;  // beyond the floor
      const Sight from = sight(scene, floor, p, light), to = sight(scene, floor, q, light);
      if (from == to || (from != Sight::some && to != Sight::some)) continue;
      for (int k = 0; k < 12; ++k) {
        const Vec3d m = (p + q) * 0.5;
        (sight(scene, floor, m, light) == from ? p : q) = m;
      }
      // Between other kinds of places than those at the ends, perhaps.
      const Sight one = sight(scene, floor, p, light), other = sight(scene, floor, q, light);
      if (one != Sight::some && other != Sight::some) continue;
      const bool begins = one == Sight::all || other == Sight::all;
      if (!begins && !is_hidden_by_one(scene, one == Sight::nothing ? p : q, light)) continue;
      const double away = test::distance_to_edges(p, begins ? penumbral : umbral, 0);
      constexpr double kNear = 0.01;
      (begins ? penumbral_changes : umbral_changes) += 1;
      (begins ? near_penumbral : near_umbral) += away < kNear ? 1 : 0;
    }
  }
  EXPECT_GT(penumbral_changes, 50);
  EXPECT_GT(umbral_changes, 20);
  EXPECT_EQ(near_penumbral, penumbral_changes);
  EXPECT_GE(near_umbral, 0.95 * umbral_changes);
}

TEST(ShadowEdges, of_all_events_are_those_of_each) {
  FinderRandom random(4);
  const ShadowScene scene = test::random_shadow_scene(random);
  const ParallelogramLight light{{-1, -1, 9}, {2, 0, 0}, {0, 1, 0.5}, {0, 0, -1}};
  for (std::size_t blocker = 0; blocker < scene.objects.size(); ++blocker) {
    const test::ShadowObject& b = *scene.objects[blocker];
    const std::vector<ShadowEvent> events =
        transform(b.world_from_object,
                  find_shadow_events(b.edges, transform(inverse(b.world_from_object), light)));
    const std::vector<ShadowReceiver> receivers = scene.receivers(blocker);
    const std::vector<ShadowEdge> all = test::trace_events(events, receivers);
    std::size_t at = 0;
    for (const ShadowEvent& event : events) {
      for (const ShadowEdge& e : test::trace_events({event}, receivers)) {
        ASSERT_LT(at, all.size());
        EXPECT_TRUE(e.a == all[at].a && e.b == all[at].b && e.receiver == all[at].receiver);
        ++at;
      }
    }
    EXPECT_EQ(at, all.size());
  }
}

bool is_same(const ShadowEdge& x, const ShadowEdge& y) {
  return x.a == y.a && x.b == y.b && x.kind == y.kind && x.receiver == y.receiver &&
         x.penumbra == y.penumbra;
}

// Bands over parts of the faces, as roundings take them.
FaceVoids random_voids(const EdgeMesh& mesh, FinderRandom& random) {
  FaceVoids voids;
  voids.first.push_back(0);
  for (std::size_t face = 0; face < mesh.triangles.size(); ++face) {
    if (random() % 2 == 0) {
      voids.bands.push_back({uniform(random, -1, 0.5), uniform(random, -1, 2), 0.5});
    }
    voids.first.push_back(std::uint32_t(voids.bands.size()));
  }
  return voids;
}

// Adds receivers in random order, some at a time, and compares with all at once.
void expect_same_in_any_order(const std::vector<ShadowEvent>& events,
                              const std::vector<ShadowReceiver>& receivers, FinderRandom& random) {
  const std::vector<ShadowEdge> at_once = test::trace_events(events, receivers);
  std::vector<ShadowReceiver> waiting = receivers, known;
  std::ranges::shuffle(waiting, random);
  TracedEvents traced(events);
  while (!waiting.empty()) {
    const std::size_t count = std::min<std::size_t>(waiting.size(), 1 + random() % 2);
    std::vector<ShadowReceiver> added(waiting.end() - std::ptrdiff_t(count), waiting.end());
    waiting.resize(waiting.size() - count);
    known.insert(known.end(), added.begin(), added.end());
    std::ranges::sort(added, {}, &ShadowReceiver::number);
    std::ranges::sort(known, {}, &ShadowReceiver::number);
    traced.add(known, added);
  }
  ASSERT_EQ(traced.edges().size(), at_once.size());
  for (std::size_t i = 0; i < at_once.size(); ++i) {
    ASSERT_TRUE(is_same(traced.edges()[i], at_once[i])) << i << " of " << at_once.size();
  }
}

TEST(ShadowEdges, are_the_same_in_whatever_order_receivers_come) {
  FinderRandom random(5);
  std::size_t events_seen = 0;
  for (int round = 0; round < 60; ++round) {
    const ShadowScene scene = test::random_shadow_scene(
        random, round % 2 == 0 ? test::Solids::apart : test::Solids::anywhere);
    const ParallelogramLight area{{-1, -1, 9}, {2, 0, 0}, {0, 1, 0.5}, {0, 0, -1}};
    const HomogeneousPoint point{{1, uniform(random, -2, 2), 9}, double(round % 3 != 0)};
    std::vector<FaceVoids> voids;
    for (const auto& object : scene.objects) voids.push_back(random_voids(object->mesh, random));
    for (std::size_t blocker = 0; blocker < scene.objects.size(); ++blocker) {
      const test::ShadowObject& b = *scene.objects[blocker];
      const Affine3d object_from_world = inverse(b.world_from_object);
      std::vector<ShadowEvent> of_point = transform(
          b.world_from_object, find_shadow_events(b.edges, transform(object_from_world, point)));
      const std::vector<ShadowEvent> of_area = transform(
          b.world_from_object, find_shadow_events(b.edges, transform(object_from_world, area)));
      events_seen += of_point.size() + of_area.size();
      std::vector<ShadowReceiver> receivers = scene.receivers(blocker);
      expect_same_in_any_order(of_area, receivers, random);
      expect_same_in_any_order(of_point, receivers, random);
      for (std::size_t i = 0; i < receivers.size(); ++i) receivers[i].voids = &voids[i];
      for (ShadowEvent& event : of_point) event.void_depth = 3;
      expect_same_in_any_order(of_point, receivers, random);
    }
  }
  EXPECT_GT(events_seen, 10'000U);
}

TEST(ShadowEdges, receivers_hide_each_other_also_when_the_nearer_comes_later) {
  ShadowScene scene = scene_on_floor();
  scene.add(make_box_mesh({1, 1, 0.1}), {{}, {0, 0, 3}});
  scene.add(make_box_mesh({4, 4, 0.1}), {{}, {0, 0, 1}});
  const test::ShadowObject& b = *scene.objects[1];
  const HomogeneousPoint light{{0, 0, 9}, 1};
  TracedEvents traced(
      transform(b.world_from_object,
                find_shadow_events(b.edges, transform(inverse(b.world_from_object), light))));
  const std::vector<ShadowReceiver> all = scene.receivers(1);
  const std::vector<ShadowReceiver> floor{all[0]}, both{all[0], all[2]}, table{all[2]};
  traced.add(floor, floor);
  EXPECT_FALSE(on_receiver(traced.edges(), 0, ShadowKind::hard).empty());
  traced.add(both, table);
  EXPECT_TRUE(on_receiver(traced.edges(), 0, ShadowKind::hard).empty());
  EXPECT_FALSE(on_receiver(traced.edges(), 2, ShadowKind::hard).empty());
  traced.forget_receivers();
  EXPECT_TRUE(traced.edges().empty());
}

}  // namespace
}  // namespace arris
