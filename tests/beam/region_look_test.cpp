// Trees of signs against rays: at points that follow the signs to an end, a ray finds what the end says.
#include "beam/region_look.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <vector>

#include "support/beam_truth.h"

namespace arris::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Nothing: within 1e-6 of a zero of a sign.
const LookNode* end_at(const LookTree& tree, Vec2d at) {
  constexpr double kNear = 1e-6;
  const Rect around{at.x - kNear, at.y - kNear, at.x + kNear, at.y + kNear};
  const LookNode* node = tree.nodes.data();
  while (node->kind == LookNode::Kind::sign) {
    const Sign sign = sign_of(range_over(node->polynomial, around));
    if (sign == Sign::unknown) return nullptr;
    node = &tree.nodes[sign == Sign::negative ? node->negative : node->positive];
  }
  return node;
}

Vec2d random_point(CsgRandom& random, const Rect& r) {
  return {uniform(random, r.x0, r.x1), uniform(random, r.y0, r.y1)};
}
Rect random_part(CsgRandom& random, const Rect& r, double side) {
  const Vec2d at = random_point(random, {r.x0, r.y0, r.x1 - side, r.y1 - side});
  return {at.x, at.y, at.x + side, at.y + side};
}

struct Tally {
  int surfaces = 0, nothing = 0, unknown = 0, without_candidates = 0;
  int by_signs = 0;  // of surfaces and nothing
  int bounded = 0;   // by depth_end

  [[nodiscard]] int points() const { return surfaces + nothing + unknown; }
};

// Of all points in the rectangle.
void check_look(const BeamScene& scene, const LookTree& tree, const Rect& rect, CsgRandom& random,
                Tally& tally) {
  for (int k = 0; k < 12; ++k) {
    const Vec2d at = random_point(random, rect);
    const LookNode* end = end_at(tree, at);
    if (end == nullptr) continue;
    const std::optional<RaySight> sight = see(scene, at.x, at.y);
    const SeenKey truth = key_of(sight ? std::optional(sight->seen) : std::nullopt);
    ASSERT_TRUE(!sight || sight->depth <= tree.depth_end * (1 + 1e-9));
    tally.bounded += sight && tree.depth_end < kInfinity ? 1 : 0;
    if (end->kind == LookNode::Kind::unknown) {
      ASSERT_FALSE(tree.complete);
      ++tally.unknown;
      tally.without_candidates += end->count == 0 ? 1 : 0;
      if (!sight || end->count == 0) continue;
      const auto first = tree.candidates.begin() + std::ptrdiff_t(end->first);
      ASSERT_TRUE(std::any_of(first, first + std::ptrdiff_t(end->count),
                              [&](const SeenSurface& s) { return key_of(s) == truth; }))
          << at.x << ", " << at.y << ": leaf " << std::get<1>(truth) << " face "
          << std::get<2>(truth);
      continue;
    }
    const bool is_surface = end->kind == LookNode::Kind::surface;
    ASSERT_EQ(key_of(is_surface ? std::optional(end->seen) : std::nullopt), truth)
        << at.x << ", " << at.y;
    ++(is_surface ? tally.surfaces : tally.nothing);
    tally.by_signs += tree.nodes.size() > 1 ? 1 : 0;
  }
}

// Rectangles as a tracer makes them: parts of a picture and of each other, that hand down their lists and depths.
void look_around(const BeamScene& scene, CsgRandom& random, Tally& tally) {
  const BeamView view(scene.placed, scene.eye);
  std::vector<BeamPart> roots;
  for (std::uint32_t i = 0; i < scene.placed.size(); ++i) {
    const CsgExpression& root = scene.placed[i].shape->root();
    if (!root.is_decided()) roots.push_back({i, root});
  }
  const Rect picture{0, 0, double(scene.width), double(scene.height)};
  for (int k = 0; k < 12; ++k) {
    std::vector<BeamPart> parts = roots;
    Rect rect = picture;
    double depth_end = kInfinity;
    for (const double side : {4.0, 1.0, 0.1, 0.01}) {
      rect = random_part(random, rect, side * uniform(random, 0.5, 1));
      const BeamList list = prune_parts(view, parts, rect, depth_end);
      const LookTree tree = look(view, list, rect, depth_end);
      check_look(scene, tree, rect, random, tally);
      if (testing::Test::HasFatalFailure()) return;
      parts = list.parts;
      depth_end = std::min(depth_end, tree.depth_end);
    }
  }
}

BeamScene random_scene(CsgRandom& random, int i) {
  BeamScene scene;
  scene.width = scene.height = 8;
  const bool among = i % 5 == 0;
  scene.eye = look_at(random_unit(random) * (among ? 1.0 : uniform(random, 2.5, 6)),
                      random_vector(random, 0.5), 40, 8, 8);
  return scene;
}

void expect_all_kinds(const Tally& tally) {
  EXPECT_GT(tally.surfaces, tally.points() / 5);
  EXPECT_GT(tally.nothing, tally.points() / 50);
  EXPECT_GT(tally.by_signs, tally.points() / 30);
  EXPECT_GT(tally.bounded, tally.points() / 8);
  EXPECT_LT(tally.unknown, tally.points() / 2);
  EXPECT_LT(tally.without_candidates, tally.points() / 4);
}

TEST(region_look, ends_are_what_rays_see_of_convex_leaves) {
  CsgRandom random(1);
  Tally tally;
  for (int i = 0; i < 120; ++i) {
    BeamScene scene = random_scene(random, i);
    for (int k = 0; k <= i % 2; ++k) {
      scene.add(random_convex_tree(random, 1 + int(random() % 3)),
                k == 0 ? Affine3d{} : random_placement(random, 1));
    }
    look_around(scene, random, tally);
    ASSERT_FALSE(HasFatalFailure()) << i;
  }
  expect_all_kinds(tally);
  EXPECT_LT(tally.unknown, tally.points() / 4);
}

// A cone by itself, with a bite out of it, or as a hole, perhaps before another one that begins just behind its apex.
CsgTree random_cone_tree(CsgRandom& random, int i, const CsgCone& cone) {
  if (i % 4 == 0) return one_leaf(cone);
  CsgLeaf other{random_convex(random), random_placement(random, 1), {}};
  if (i % 4 == 1) return flat_tree(CsgOperation::subtract, {{cone, {}, {}}, other});
  if (i % 4 == 2) {
    const double gap = uniform(random, 0.01, 0.2);
    other = {CsgBox{{-2, -2, -2}, {2, 2, -gap}}, {}, {}};
  }
  const CsgBox block{Vec3d(-3), Vec3d(3)};
  return flat_tree(CsgOperation::subtract, {{block, {}, {}}, {cone, {}, {}}, other});
}

// Along its walls a cone's curvature changes its sign, and rays that run in its opening never leave it.
TEST(region_look, ends_are_what_rays_see_along_the_walls_of_cones) {
  CsgRandom random(6);
  Tally tally;
  for (int i = 0; i < 300; ++i) {
    // The apex is at the origin.
    const double spread = uniform(random, 0.2, 1.5);  // radius by height
    const double low = i % 3 != 0 ? 0 : uniform(random, 0, 1), high = uniform(random, 1, 3);
    const CsgCone cone{low, high, spread * low, spread * high};
    BeamScene scene;
    scene.width = scene.height = 8;
    scene.add(random_cone_tree(random, i, cone));
    Vec3d eye = random_vector(random, 1);
    if (random() % 4 != 0) {  // in the cone
      eye.z = uniform(random, low, high);
      const double angle = uniform(random, 0, 2 * kPi);
      const double radius = uniform(random, 0, spread * eye.z);
      eye = {radius * std::cos(angle), radius * std::sin(angle), eye.z};
    }
    const double angle = uniform(random, 0, 2 * kPi);
    Vec3d wall{spread * std::cos(angle), spread * std::sin(angle), 1};
    if (random() % 2 == 0) wall = -wall;
    scene.eye = look_at(eye, eye + wall + random_vector(random, 0.1), uniform(random, 5, 60), 8, 8);
    look_around(scene, random, tally);
    ASSERT_FALSE(HasFatalFailure()) << i;
  }
  EXPECT_GT(tally.surfaces, tally.points() / 3);
  EXPECT_GT(tally.by_signs, tally.points() / 30);
  EXPECT_LT(tally.unknown, tally.points() / 3);
}

TEST(region_look, ends_are_what_rays_see_of_every_kind_of_leaf) {
  CsgRandom random(2);
  Tally tally;
  for (int i = 0; i < 60; ++i) {
    BeamScene scene = random_scene(random, i);
    scene.add(random_tree(random, 1 + i % 2), random_placement(random, 0.3));
    look_around(scene, random, tally);
    ASSERT_FALSE(HasFatalFailure()) << i;
  }
  expect_all_kinds(tally);
}

// Open ones by themselves, and closed ones inside booleans.
TEST(region_look, ends_are_what_rays_see_of_meshes) {
  CsgRandom random(3);
  Tally tally;
  for (int i = 0; i < 80; ++i) {
    BeamScene scene = random_scene(random, i);
    std::vector<MeshTriangle> triangles;
    for (std::uint32_t k = 0; k < std::uint32_t(1 + i % 7); ++k) {
      const Vec3d middle = random_vector(random, 0.8);
      triangles.push_back(
          {{middle + random_vector(random, 0.7), middle + random_vector(random, 0.7),
            middle + random_vector(random, 0.7)},
           k});
    }
    scene.add(triangles, random_placement(random, 0.5));
    if (i % 2 == 0) {
      CsgTree tree = random_convex_tree(random, 1);
      for (std::size_t k = 1; k < tree.leaves.size(); k += 2) {
        tree.leaves[k].primitive = random_mesh(random);
      }
      scene.add(tree);
    }
    look_around(scene, random, tally);
    ASSERT_FALSE(HasFatalFailure()) << i;
  }
  expect_all_kinds(tally);
}

// Is the ray inside the leaf at depths in turn? Whole leaves may be left and entered again.
struct Inside {
  bool starts = false;
  std::vector<double> changes;  // ascending

  [[nodiscard]] bool at(double depth) const {
    const auto before = std::ranges::lower_bound(changes, depth) - changes.begin();
    return starts != (before % 2 == 1);
  }
};
Inside inside_of(const BeamShape& shape, std::uint32_t leaf, const Ray& ray) {
  Inside inside;
  if (const Facet* facet = shape.facet(leaf)) {
    if (const auto t = shape.meet(*facet, ray)) inside.changes.push_back(*t);
    return inside;
  }
  LeafCrossings crossings;
  for (const Crossing& c : crossings.find(shape.csg().leaf(leaf), shape.csg().surfaces(), ray)) {
    if (c.t <= 0) inside.starts = !inside.starts;
    if (c.t > 0 && std::isfinite(c.t)) inside.changes.push_back(c.t);
  }
  std::ranges::sort(inside.changes);
  return inside;
}

// Sure to be inside, sure to be outside, or nothing is said.
Cover cover_at(const std::optional<LeafSpan>& span, double depth) {
  if (!span || (!span->starts_inside && depth < span->enter.lo) || depth > span->leave.hi) {
    return Cover::out;
  }
  const bool entered = span->starts_inside || depth > span->enter.hi;
  return span->certain && entered && depth < span->leave.lo ? Cover::in : Cover::on;
}

void check_span(const BeamScene& scene, const BeamView& view, std::uint32_t leaf, const Rect& rect,
                CsgRandom& random, std::array<int, 3>& covers) {
  const BeamShape& shape = view.shape(0);
  const std::vector<Assumption> none;
  const auto span = make_span(view, {0, leaf}, kInfinity, SignOracle(rect, none));
  for (int n = 0; n < 6; ++n) {
    const Ray world = ray_through(scene.eye, random_point(random, rect));
    const Affine3d& m = scene.placed[0].object_from_world;
    const Inside inside = inside_of(
        shape, leaf, {transform_point(m, world.origin), transform_vector(m, world.direction)});
    std::vector<double> depths;
    for (int j = 0; j < 8; ++j) depths.push_back(uniform(random, 0, 8));
    // Where the bounds are, just beyond them, and the middles between crossings.
    for (std::size_t c = 1; c < inside.changes.size(); ++c) {
      depths.push_back((inside.changes[c - 1] + inside.changes[c]) / 2);
    }
    for (const double end :
         span ? std::vector{span->enter.lo, span->enter.hi, span->leave.lo, span->leave.hi}
              : std::vector<double>{}) {
      depths.insert(depths.end(), {end * (1 - 1e-6), end * (1 + 1e-6)});
    }
    for (const double depth : depths) {
      const bool near_change = std::ranges::any_of(inside.changes, [&](double change) {
        return std::abs(change - depth) < 1e-7 * (1 + depth);
      });
      if (!std::isfinite(depth) || near_change) continue;
      const Cover cover = cover_at(span, depth);
      ++covers[std::size_t(cover)];
      ASSERT_TRUE(cover == Cover::on || inside.at(depth) == (cover == Cover::in))
          << "leaf " << leaf << " at " << depth;
    }
  }
}

TEST(region_look, spans_hold_where_rays_are_inside_leaves) {
  CsgRandom random(5);
  std::array<int, 3> covers{};
  for (int i = 0; i < 66; ++i) {
    BeamScene scene = random_scene(random, i);
    CsgTree tree = one_leaf(random_primitive(random, i % kPrimitiveKinds));
    tree.leaves[0].object_from_primitive = random_placement(random, 0.5);
    scene.add(tree);
    const BeamShape& shape = scene.shapes[0];
    const BeamView view(scene.placed, scene.eye);
    for (int k = 0; k < 12; ++k) {
      const Rect rect = random_part(random, {0, 0, 8, 8}, std::pow(10, uniform(random, -2, 0.5)));
      for (const std::uint32_t leaf : shape.root().leaves()) {
        if (shape.volume(leaf) != nullptr) continue;
        check_span(scene, view, leaf, rect, random, covers);
        ASSERT_FALSE(HasFatalFailure()) << i;
      }
    }
  }
  for (const int times : covers) EXPECT_GT(times, 10000);
}

// A thin part before a thick one: slices find the thick one first, and what is between is outside.
TEST(region_look, spans_end_where_a_leaf_is_left_for_the_first_time) {
  int thin = 0;
  for (int i = 0; i < 60; ++i) {
    BeamScene scene;
    scene.width = scene.height = 8;
    scene.add(one_leaf(CsgTorus{1, 0.3}));
    // Through the upper part of the first tube and the middle of the second.
    scene.eye = look_at({0, -5, 0.3 + 0.01 * i}, {0, 1, 0}, 20, 8, 8);
    const BeamView view(scene.placed, scene.eye);
    const Rect rect{3.9999, 3.9999, 4.0001, 4.0001};
    const Inside inside = inside_of(scene.shapes[0], 0, ray_through(scene.eye, {4, 4}));
    const std::vector<Assumption> none;
    const auto span = make_span(view, {0, 0}, kInfinity, SignOracle(rect, none));
    ASSERT_TRUE(span && span->certain) << i;
    if (inside.changes.size() < 4 || span->enter.hi > inside.changes[1]) continue;
    EXPECT_LE(span->leave.lo, inside.changes[1] + 1e-4) << i;
    ++thin;
  }
  EXPECT_GT(thin, 20);
}

// What stands on a floor, as a light sees it.
struct LightScene {
  BeamScene beam;
  LightPlace light;
  LitPlane floor;
  static constexpr double kReach = 40;

  // From the light to the point of the floor that the eye sees; its depth is 1.
  [[nodiscard]] Ray ray_to(Vec2d at) const {
    const Ray seen = ray_through(beam.eye, at);
    const Vec3d p = seen.origin - seen.direction * (seen.origin.z / seen.direction.z);
    if (!light.is_directional) return {light.position, p - light.position};
    const Vec3d travels = light.direction * (kReach / length(light.direction));
    return {p - travels, travels};
  }
};

LightScene light_scene(CsgRandom& random, int i) {
  LightScene scene;
  scene.beam.add(one_leaf(CsgBox{{-20, -20, -1}, {20, 20, 0}}));
  const auto& planes = scene.beam.placed[0].shape->planes();
  while (std::abs(planes[scene.floor.plane].d) > 1e-9) ++scene.floor.plane;
  for (int k = 0; k <= i % 2; ++k) {
    CsgTree tree = i % 4 < 2 ? random_convex_tree(random, 1) : random_tree(random, 1);
    if (i % 3 == 0) tree.leaves.back().primitive = random_mesh(random);
    scene.beam.add(tree, {{}, {uniform(random, -1, 1), uniform(random, -1, 1), 1.8}});
  }
  if (i % 4 == 3) {
    scene.beam.add(std::vector<MeshTriangle>{
        {{random_vector(random, 1) + Vec3d(1.2), random_vector(random, 1) + Vec3d(1.2),
          random_vector(random, 1) + Vec3d(1.2)},
         0}});
  }
  scene.light.is_directional = i % 2 == 0;
  scene.light.direction = {uniform(random, -0.5, 0.5), uniform(random, -0.5, 0.5), -1};
  scene.light.position = {uniform(random, -3, 3), uniform(random, -3, 3), 9};
  scene.beam.eye = look_at({uniform(random, -3, 3), -6, 8}, {0, 0, 0}, 40, 8, 8);
  return scene;
}

TEST(region_look, lights_reach_a_plane_where_rays_do) {
  CsgRandom random(4);
  int lit = 0, blocked = 0, unknown = 0, by_signs = 0;
  for (int i = 0; i < 120; ++i) {
    const LightScene scene = light_scene(random, i);
    const BeamView view(scene.beam.placed, scene.beam.eye, scene.floor, scene.light,
                        LightScene::kReach);
    std::vector<BeamPart> others;
    for (std::uint32_t k = 1; k < scene.beam.placed.size(); ++k) {
      const CsgExpression& root = scene.beam.placed[k].shape->root();
      if (!root.is_decided()) others.push_back({k, root});
    }
    for (int k = 0; k < 30; ++k) {
      const double side = std::pow(10, uniform(random, -2, 0.5));
      const Rect rect = random_part(random, {0, 0, 8, 8}, side);
      const PlaneForm& plane = view.plane(scene.floor.solid, scene.floor.plane);
      const Interval height = absolute(range_over(plane.height, rect));
      const double end = height.hi / absolute(range_over(plane.slope, rect)).lo * (1 + 1e-9);
      const BeamList list = prune_parts(view, others, rect, end);
      const LookTree tree = look(view, list, rect, end, {.only = scene.floor});
      for (int n = 0; n < 12; ++n) {
        const Vec2d at = random_point(random, rect);
        const LookNode* node = end_at(tree, at);
        if (node == nullptr) continue;
        if (node->kind == LookNode::Kind::unknown) {
          ++unknown;
          continue;
        }
        const auto sight = see(scene.beam.placed, others, scene.ray_to(at));
        const bool is_lit = !sight || sight->depth > 1;
        const bool reached =
            node->kind == LookNode::Kind::nothing ||
            (node->seen.surface.is_plane() && node->seen.surface.index == scene.floor.plane);
        ASSERT_EQ(reached, is_lit) << i << ": " << at.x << ", " << at.y;
        ++(is_lit ? lit : blocked);
        by_signs += tree.nodes.size() > 1 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(lit, 10000);
  EXPECT_GT(blocked, 2000);
  EXPECT_GT(by_signs, 1000);
  EXPECT_LT(unknown, lit / 2);
}

TEST(region_look, follows_no_more_signs_and_puts_no_more_leaves_in_order_than_it_is_told) {
  BeamScene scene;
  scene.width = scene.height = 8;
  std::vector<CsgLeaf> balls;
  for (int k = 0; k < 4; ++k)
    balls.push_back({CsgSphere{0.1}, {{}, {0.3 * k - 0.45, 0, 0.5 * k}}, {}});
  scene.add(flat_tree(CsgOperation::unite, balls));
  scene.eye = look_at({0, 0, 5}, {0, 0, 0}, 40, 8, 8);
  const BeamView view(scene.placed, scene.eye);
  const Rect rect{2, 2, 6, 6};
  const std::vector<BeamPart> roots{{0, scene.placed[0].shape->root()}};
  const BeamList list = prune_parts(view, roots, rect, kInfinity);
  const LookTree few_signs = look(view, list, rect, kInfinity, {.only = {}, .most_signs = 1});
  EXPECT_FALSE(few_signs.complete);
  EXPECT_LE(few_signs.nodes.size(), 3U);
  const LookTree few_leaves = look(view, list, rect, kInfinity, {.only = {}, .most_leaves = 3});
  ASSERT_EQ(few_leaves.nodes.size(), 1U);
  EXPECT_EQ(few_leaves.nodes[0].kind, LookNode::Kind::unknown);
  EXPECT_GT(few_leaves.nodes[0].count, 0U);
  const LookTree all = look(view, list, rect, kInfinity, {.only = {}, .most_signs = 8});
  EXPECT_TRUE(all.complete);
  EXPECT_GE(all.nodes.size(), 9U);
}

}  // namespace
}  // namespace arris::test
