// Shadows of rounded solids, and of solids of solids: found edges against dense shadow rays.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "arris/io.h"
#include "render/edge_objects.h"
#include "render/prepared_scene.h"
#include "render/shadow_finder.h"
#include "support/csg_oracle.h"
#include "support/render_scenes.h"

namespace arris::test {
namespace {

// Light 0 and a floor at height 0 that is the last object.
class Shadowed {
 public:
  Shadowed(Scene scene, double reach) : scene_(prepare_scene(std::move(scene))), reach_(reach) {
    const auto count = std::uint32_t(scene_->scene().objects.size());
    const EdgeObjects objects(*scene_, 0);
    std::vector<ShadowTriple> triples;
    for (std::uint32_t blocker = 0; blocker + 1 < count; ++blocker) {
      for (std::uint32_t receiver = 0; receiver < count; ++receiver) {
        triples.push_back({0, blocker, receiver});
      }
    }
    ShadowFinder finder;
    finder.add(triples);
    while (!finder.update(*scene_, objects, 1'000'000)) {
    }
    for (const SoftEdge& e : *finder.edges()) edges_.push_back(e.edge);
    light_ = std::get<HomogeneousPoint>(shadow_lights(*scene_)[0]);
  }

  [[nodiscard]] const std::vector<WorldEdge>& edges() const { return edges_; }
  [[nodiscard]] bool sees_light(Vec3d p) const {
    TraceRay ray;
    ray.origin = Vec3f(p + Vec3d(0, 0, 1e-5));
    const Vec3d to = light_.w > 0 ? light_.xyz / light_.w - p : light_.xyz;
    ray.direction = normalize(Vec3f(to));
    if (light_.w > 0) ray.t_max = float(length(to));
    return !scene_->occluded(ray);
  }
  // From the floor's edges.
  [[nodiscard]] double distance_to_edge(Vec3d p) const {
    double best = std::numeric_limits<double>::infinity();
    for (const WorldEdge& e : edges_) {
      const Vec3d a(e.a), d = Vec3d(e.b) - a;
      const double squared = dot(d, d);
      const double t = squared > 0 ? std::clamp(dot(p - a, d) / squared, 0.0, 1.0) : 0;
      best = std::min(best, length(p - a - d * t));
    }
    return best;
  }
  // Where along rows of the floor the light's visibility changes.
  [[nodiscard]] std::vector<Vec3d> find_changes(int rows, int columns) const {
    std::vector<Vec3d> changes;
    for (int j = 0; j < 2 * rows; ++j) {
      const double at = reach_ * (2 * ((j / 2) + 0.37) / rows - 1);
      const auto place = [&](double t) {
        const double s = reach_ * t;
        return j % 2 == 0 ? Vec3d(s, at, 0) : Vec3d(at, s, 0);
      };
      bool before = sees_light(place(-1));
      for (int i = 1; i <= columns; ++i) {
        double low = 2.0 * (i - 1) / columns - 1, high = 2.0 * i / columns - 1;
        const bool after = sees_light(place(high));
        if (after != before) {
          for (int k = 0; k < 30; ++k) {
            const double middle = (low + high) / 2;
            (sees_light(place(middle)) == before ? low : high) = middle;
          }
          changes.push_back(place(low));
        }
        before = after;
      }
    }
    return changes;
  }
  struct Shares {
    std::size_t changes = 0, found = 0, edges = 0, real = 0;
    double worst = 0;
  };
  [[nodiscard]] Shares measure(double near) const {
    Shares shares;
    for (const Vec3d p : find_changes(60, 300)) {
      const double distance = distance_to_edge(p);
      ++shares.changes;
      shares.found += distance < near ? 1 : 0;
      shares.worst = std::max(shares.worst, distance);
    }
    for (const WorldEdge& e : edges_) {
      if (std::abs(e.a.z) > 1e-4 || std::abs(e.b.z) > 1e-4) continue;
      const Vec3d a(e.a), d = Vec3d(e.b) - a, middle = a + d * 0.5;
      if (length(d) < 1e-3) continue;
      const Vec3d off = normalize(cross(d, {0, 0, 1})) * near;
      ++shares.edges;
      shares.real += sees_light(middle + off) != sees_light(middle - off) ? 1 : 0;
    }
    return shares;
  }

  // Where between neighbouring rays that see the same smooth surface of object 0 the light's visibility changes.
  [[nodiscard]] Shares measure_seen(Vec3d eye, Vec3d target, double width, int pixels,
                                    double near) const {
    const Vec3d forward = target - eye, right = normalize(cross(forward, {0, 0, 1}));
    const Vec3d down = normalize(cross(forward, right));
    const auto look = [&](double x, double y) {
      TraceRay ray;
      ray.origin = Vec3f(eye);
      ray.direction = normalize(Vec3f(forward + (right * x + down * y) * (width / pixels)));
      Seen seen{scene_->intersect(ray)};
      if (seen.hit) seen.lit = is_lit(*seen.hit);
      return seen;
    };
    Shares shares;
    for (int j = 0; j < pixels; ++j) {
      for (int i = 1; i < pixels; ++i) {
        const double y = j - pixels / 2.0;
        double x0 = i - 1 - pixels / 2.0, x1 = x0 + 1;
        Seen a = look(x0, y), b = look(x1, y);
        if (!is_one_surface(a, b) || a.lit == b.lit) continue;
        for (int k = 0; k < 12; ++k) {
          const Seen middle = look((x0 + x1) / 2, y);
          (middle.lit == a.lit ? x0 : x1) = (x0 + x1) / 2;
          (middle.lit == a.lit ? a : b) = middle;
        }
        if (!is_one_surface(a, b)) continue;
        const double distance = distance_to_edge(Vec3d(a.hit->position));
        ++shares.changes;
        shares.found += distance < near ? 1 : 0;
        shares.worst = std::max(shares.worst, distance);
      }
    }
    return shares;
  }

 private:
  struct Seen {
    std::optional<SurfaceHit> hit;
    bool lit = false;
  };
  // Surfaces that the light grazes change with their own turn.
  [[nodiscard]] bool is_one_surface(const Seen& a, const Seen& b) const {
    if (!a.hit || !b.hit || a.hit->object.index != 0 || b.hit->object.index != 0) return false;
    const Vec3f n = a.hit->geometric_normal;
    return dot(n, b.hit->geometric_normal) > 0.99F &&
           length(a.hit->position - b.hit->position) < 0.2F &&
           std::abs(dot(Vec3d(n), to_light(Vec3d(a.hit->position)))) > 0.15;
  }
  [[nodiscard]] Vec3d to_light(Vec3d p) const {
    return normalize(light_.w > 0 ? light_.xyz / light_.w - p : light_.xyz);
  }
  [[nodiscard]] bool is_lit(const SurfaceHit& hit) const {
    const Vec3d p(hit.position);
    if (dot(Vec3d(hit.geometric_normal), to_light(p)) < 0) return false;
    TraceRay ray = leave_surface(hit, Vec3f(to_light(p)));
    if (light_.w > 0) ray.t_max = float(length(light_.xyz / light_.w - p));
    return !scene_->occluded(ray);
  }

  std::shared_ptr<const PreparedScene> scene_;
  double reach_;
  std::vector<WorldEdge> edges_;
  HomogeneousPoint light_;
};

Scene rounded_scene(const std::vector<std::pair<Mesh, Affine3d>>& solids, double radius,
                    const Light& light) {
  Camera camera;
  camera.position = {5, -9, 6};
  Scene scene = make_empty_scene(camera);
  scene.lights.push_back(light);
  for (const auto& [mesh, place] : solids) {
    Object& object = add_object(scene, mesh, make_lambert(0.5F), place);
    object.rounding.emplace();
    object.rounding->method = RoundMethod::exact;
    object.rounding->radius = radius;
  }
  add_object(scene, make_square_mesh(20), make_lambert(0.5F));
  return scene;
}

std::vector<Light> lights() {
  return {PointLight{{1.5, -2, 7}, {1, 1, 1}}, DirectionalLight{{0.4, 0.3, -1}, {1, 1, 1}}};
}

// An L of unit thickness, extruded along y.
Mesh make_l_mesh() {
  const std::vector<std::pair<float, float>> outline = {{-1, 0},   {1, 0}, {1, 0.8F},
                                                        {0, 0.8F}, {0, 2}, {-1, 2}};
  Mesh mesh;
  mesh.name = "L";
  for (const float y : {-0.7F, 0.7F}) {
    for (const auto& [x, z] : outline) mesh.positions.push_back({x, y, z});
  }
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 5}, {3, 4, 5}};
  for (int i = 0; i < 4; ++i) {
    const Triangle t = mesh.triangles[std::size_t(i)];
    mesh.triangles.push_back({t[0] + 6, t[2] + 6, t[1] + 6});
  }
  for (std::uint32_t i = 0; i < 6; ++i) {
    const std::uint32_t j = (i + 1) % 6;
    mesh.triangles.push_back({i, i + 6, j + 6});
    mesh.triangles.push_back({i, j + 6, j});
  }
  return mesh;
}

// All changes are found, and so many edges are no more than that.
void expect_found(const char* name, const Shadowed::Shares& shares, double real) {
  EXPECT_GT(shares.changes, 20U) << name;
  EXPECT_EQ(shares.found, shares.changes) << name << ": " << shares.worst;
  EXPECT_GE(double(shares.real), real * double(shares.edges)) << name << ": " << shares.edges;
}

TEST(rounded_shadows, of_a_box_are_its_outline) {
  CsgRandom random(3);
  for (const Light& light : lights()) {
    for (int i = 0; i < 4; ++i) {
      Affine3d place = random_placement(random, 0.4);
      place.linear = {normalize(place.linear.x), normalize(place.linear.y), {}};
      place.linear.z = cross(place.linear.x, place.linear.y);
      place.linear.y = cross(place.linear.z, place.linear.x);
      if (i == 0) place.linear = {};
      place.translation.z = 3;
      const Shadowed shadowed(
          rounded_scene({{make_box_mesh(Vec3d{1, 0.8, 0.6}), place}}, 0.25, light), 8);
      expect_found("box", shadowed.measure(2e-3), 1);
    }
  }
}

TEST(rounded_shadows, of_an_l_and_of_blocks_that_touch) {
  for (const Light& light : lights()) {
    const Shadowed l(rounded_scene({{make_l_mesh(), {{}, {0, 0, 1}}}}, 0.15, light), 8);
    expect_found("L above", l.measure(2e-3), 0.97);
    const Shadowed standing(rounded_scene({{make_l_mesh(), {{}, {0, 0, 0}}}}, 0.15, light), 8);
    // At the ends of the notch an outline goes on behind another one, in pieces of a few thousandths.
    expect_found("L standing", standing.measure(2e-3), 0.96);
    const Shadowed two(rounded_scene({{make_box_mesh(Vec3d{1, 0.8, 0.6}), {{}, {-1, 0, 2}}},
                                      {make_box_mesh(Vec3d{1, 0.8, 0.6}), {{}, {1, 0, 2}}}},
                                     0.2, light),
                       8);
    expect_found("touching", two.measure(2e-3), 0.8);
    const Shadowed stack(rounded_scene({{make_box_mesh(Vec3d{1, 0.8, 0.6}), {{}, {0, 0, 0.6}}},
                                        {make_box_mesh(Vec3d{0.7, 0.8, 0.6}), {{}, {0, 0, 1.8}}}},
                                       0.2, light),
                         8);
    expect_found("stack", stack.measure(2e-3), 0.75);
  }
}

// Of drilled, cut and united solids, in front of a floor that is a mesh.
TEST(csg_shadows, on_a_floor_are_found) {
  CsgRandom random(5);
  for (const Light& light : lights()) {
    Shadowed::Shares all;
    for (int i = 0; i < 12; ++i) {
      Scene scene = rounded_scene({}, 0, light);
      Object object;
      object.name = "solid";
      object.csg = CsgId{0};
      object.world_from_object.translation = {0.13, 0.07, 3};
      CsgTree tree = random_tree(random, 3);
      while (scene.materials.size() < tree.leaves.size()) {
        scene.materials.push_back(make_lambert(0.5F));
      }
      scene.csg_trees.push_back(std::move(tree));
      scene.objects.insert(scene.objects.begin(), object);
      const Shadowed::Shares one = Shadowed(std::move(scene), 6).measure(0.012);
      all.changes += one.changes;
      all.found += one.found;
      all.edges += one.edges;
      all.real += one.real;
      all.worst = std::max(all.worst, one.worst);
    }
    EXPECT_GT(all.changes, 300U);
    EXPECT_GE(double(all.found), 0.99 * double(all.changes)) << all.worst;
    EXPECT_GE(double(all.real), 0.5 * double(all.edges));
  }
}

// A drilled block, a ring round it and a cone beside it.
CsgTree block_and_ring() {
  CsgTree tree;
  tree.name = "block";
  tree.leaves = {{CsgBox{{-1, -1, 0}, {1, 1, 2}}, {}, {0}},
                 {CsgCone{-2, 3, 0.5, 0.5}, {}, {0}},
                 {CsgSphere{0.7}, {{}, {1, -0.2, 1}}, {0}},
                 {CsgTorus{1.8, 0.3}, {{}, {0, 0, 0.5}}, {0}},
                 {CsgCone{0, 1.5, 0.5, 0}, {{}, {-1.2, -1.8, 0}}, {0}}};
  tree.nodes = {{CsgNode::kInner, CsgOperation::unite, {1, 2, 3}},
                {CsgNode::kInner, CsgOperation::subtract, {4, 5, 6}},
                {3, CsgOperation::unite, {}},
                {4, CsgOperation::unite, {}},
                {0, CsgOperation::unite, {}},
                {1, CsgOperation::unite, {}},
                {2, CsgOperation::unite, {}}};
  return tree;
}

// A lamp of side 1 at height 4 over a box whose top is at height 1, and a floor that is a solid of solids: all edges
// that the box throws on it along its sides have a penumbra of 1 · 1 / 3 across.
TEST(csg_shadows, of_area_lights_have_penumbras) {
  Camera camera;
  camera.position = {3, -6, 4};
  Scene scene = make_empty_scene(camera);
  add_object(scene, make_box_mesh({0.5, 0.5, 0.5}), make_lambert(0.5F), translation({0, 0, 0.5}));
  CsgTree slab = flat_tree(CsgOperation::unite, {{CsgBox{{-9, -9, -1}, {9, 9, 0}}, {}, {0}}});
  slab.name = "slab";
  Object floor;
  floor.name = "floor";
  floor.csg = CsgId{0};
  scene.csg_trees.push_back(std::move(slab));
  scene.objects.push_back(std::move(floor));
  AreaLight lamp;
  lamp.corner = {-0.5, 1.5, 4};
  lamp.edge_u = {0, 1, 0};
  lamp.edge_v = {1, 0, 0};
  scene.lights.emplace_back(lamp);
  const auto prepared = prepare_scene(std::move(scene));
  const EdgeObjects objects(*prepared, 0);
  ShadowFinder finder;
  const ShadowTriple triple{0, 0, 1};
  finder.add({&triple, 1});
  ASSERT_TRUE(finder.update(*prepared, objects, 1'000'000));
  int along_x = 0;
  for (const SoftEdge& e : *finder.edges()) {
    const Vec3f a = e.edge.a, b = e.edge.b;
    if (length(b - a) < 1e-3F || std::abs(a.y - b.y) > 1e-4F || a.y > -0.51F) continue;
    ++along_x;
    EXPECT_NEAR(std::abs(e.penumbra.y), 1.0 / 3, 1e-4);
  }
  EXPECT_GE(along_x, 2);
}

TEST(csg_shadows, on_itself_are_found) {
  for (const Light& light : lights()) {
    Scene scene = rounded_scene({}, 0, light);
    Object object;
    object.name = "solid";
    object.csg = CsgId{0};
    scene.csg_trees.push_back(block_and_ring());
    scene.objects.insert(scene.objects.begin(), object);
    const Shadowed shadowed(std::move(scene), 6);
    const Shadowed::Shares shares = shadowed.measure_seen({4, -7, 5}, {0, 0, 0.8}, 5, 500, 0.01);
    EXPECT_GT(shares.changes, 100U);
    EXPECT_GE(double(shares.found), 0.99 * double(shares.changes))
        << shares.changes << " " << shares.found << " " << shares.worst;
  }
}

// The stones of an arch: visibility of the sun changes nowhere on the lawn but along edges that are found.
TEST(rounded_shadows, of_an_arch_are_found) {
  Scene scene = load_scene(std::string(ARRIS_SOURCE_DIR) + "/examples/scenes/arch.toml");
  std::rotate(scene.objects.begin(), scene.objects.begin() + 1, scene.objects.end());
  const Shadowed arch(std::move(scene), 15);
  expect_found("arch", arch.measure(0.012), 0);
}

}  // namespace
}  // namespace arris::test
