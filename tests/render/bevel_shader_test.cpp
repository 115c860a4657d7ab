#include "render/bevel_shader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "render/scene_geometry.h"
#include "support/render_scenes.h"

namespace arris {
namespace {

Camera camera_from(Vec3d position) {
  Camera camera;
  camera.position = position;
  camera.up = {0, 1, 0};
  return camera;
}

RoundingSettings shader_settings(double radius, int divisions = 3) {
  RoundingSettings settings;
  settings.method = RoundMethod::shader;
  settings.radius = radius;
  settings.shader.divisions = divisions;
  return settings;
}

Scene cube_scene(const RoundingSettings& settings) {
  Scene scene = test::make_empty_scene(camera_from({0, 0, 5}));
  test::add_object(scene, test::make_box_mesh(Vec3d(1)), test::make_lambert(0.5F));
  scene.rounding = settings;
  return scene;
}

// A hit on the sharp mesh, straight down onto it.
SurfaceHit hit_from_above(const PreparedScene& scene, float x, float y) {
  TraceRay ray;
  ray.origin = {x, y, 5};
  ray.direction = {0, 0, -1};
  const std::optional<ObjectHit> met = scene.intersect_object(ray, 0);
  EXPECT_TRUE(met);
  SurfaceHit hit;
  hit.geometry = 0;
  hit.triangle = met->triangle;
  hit.t = met->t;
  hit.position = ray.origin + ray.direction * met->t;
  hit.geometric_normal = met->geometric_normal;
  hit.shading_normal = met->shading_normal;
  return hit;
}

BevelShading shade(const PreparedScene& scene, float x, float y) {
  return eval_bevel_shader(scene, scene.rounding().shaders.at(0), hit_from_above(scene, x, y));
}

TEST(BevelShader, takes_the_rounding_radius_for_delta_and_one_for_perturb) {
  const auto scene = prepare_scene(cube_scene(shader_settings(0.1, 4)));
  const BevelShader& shader = scene->rounding().shaders.at(0);
  EXPECT_FLOAT_EQ(shader.delta, 0.1F);
  EXPECT_FLOAT_EQ(shader.perturb, 1);
  EXPECT_EQ(shader.divisions, 4);
  RoundingSettings own = shader_settings(0.1);
  own.shader.delta = 0.2;
  own.shader.perturb = 0.5;
  const auto other = prepare_scene(cube_scene(own));
  EXPECT_FLOAT_EQ(other->rounding().shaders.at(0).delta, 0.2F);
  EXPECT_FLOAT_EQ(other->rounding().shaders.at(0).perturb, 0.5F);
  EXPECT_TRUE(prepare_scene(cube_scene({}))->rounding().shaders.empty());
}

// Directions up to 45° off along each axis stay within reach; with Perturb 1 some run along the face and out of it.
RoundingSettings steep_settings(double radius, int divisions = 3) {
  RoundingSettings settings = shader_settings(radius, divisions);
  settings.shader.perturb = 0.5;
  return settings;
}

TEST(BevelShader, leaves_faces_far_from_edges_alone) {
  const auto scene = prepare_scene(cube_scene(steep_settings(0.1)));
  const auto wide = prepare_scene(cube_scene(shader_settings(0.1)));
  for (int i = 0; i < 400; ++i) {
    const int row = i / 20;
    const float x = -0.5F + 0.05F * float(i % 20), y = -0.5F + 0.05F * float(row);
    const BevelShading shading = shade(*scene, x, y);
    EXPECT_FLOAT_EQ(shading.fac, 1);
    EXPECT_GT(shading.normal.z, 1 - 1e-6F);
    EXPECT_GT(shade(*wide, x, y).fac, 0.7F);
    EXPECT_GT(shade(*wide, x, y).normal.z, 1 - 1e-6F);
  }
}

// Fac has a layer of its own: 1 inside of faces, less where rays find nothing, 0 on what has no such shader.
TEST(BevelShader, writes_fac_into_a_layer) {
  RenderOptions options;
  options.aovs = {"bevel_fac"};
  const auto render = [&](const RoundingSettings& settings) {
    Scene scene = cube_scene(settings);
    scene.camera->fov_deg = 60;
    return test::render_path(scene, 16, options).picture.layers.at(0).image;
  };
  const Image steep = render(steep_settings(0.1));
  const int x = steep.width_px / 2, y = steep.height_px / 2;
  EXPECT_EQ(steep.at(x, y, 0), 1.0F);
  EXPECT_EQ(steep.at(0, 0, 0), 0.0F);
  const float wide = render(shader_settings(0.1)).at(x, y, 0);
  EXPECT_GT(wide, 0.7F);
  EXPECT_LT(wide, 1.0F);
  RoundingSettings exact = shader_settings(0.1);
  exact.method = RoundMethod::exact;
  EXPECT_EQ(render(exact).at(x, y, 0), 0.0F);
}

TEST(BevelShader, leans_towards_the_neighbouring_face_and_more_so_nearer_to_the_edge) {
  const auto scene = prepare_scene(cube_scene(shader_settings(0.1, 8)));
  float last = -1;
  for (const float distance : {0.3F, 0.1F, 0.05F, 0.001F}) {
    float x = 0, y = 0, z = 0;
    for (int i = 0; i < 50; ++i) {
      const BevelShading shading = shade(*scene, 1 - distance, -0.25F + 0.01F * float(i));
      EXPECT_GT(shading.fac, 0.9F) << distance;
      EXPECT_NEAR(length(shading.normal), 1, 1e-6F);
      x += shading.normal.x / 50;
      y += shading.normal.y / 50;
      z += shading.normal.z / 50;
    }
    EXPECT_GT(x, last + 0.005F) << distance;
    EXPECT_NEAR(y, 0, 0.01F) << distance;
    EXPECT_GT(z, x - 0.01F) << distance;
    last = x;
  }
  EXPECT_NEAR(last, std::sqrt(0.5F), 0.01F);  // at the edge itself: halfway
}

// The closed form for the mean over all directions: half the cube of directions goes towards the edge.
TEST(BevelShader, averages_normals_as_the_area_of_the_directions_says) {
  const double delta = 0.1, distance = 0.02;
  const auto scene = prepare_scene(cube_scene(shader_settings(delta, 16)));
  // The ray (dx, dy, 1 + dz) meets the side first where dx / (1 + dz) > distance / delta, within its reach.
  double to_side = 0;
  const int n = 400;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const double dx = (i + 0.5) / n, up = 2 * (j + 0.5) / n;
      to_side += dx / up > distance / delta ? 0.5 / (n * n) : 0;
    }
  }
  // dy takes some of them out of reach: those are few.
  const double expected_x = to_side, expected_z = 1 - to_side;
  const double expected = expected_x / std::hypot(expected_x, expected_z);
  double mean = 0;
  for (int i = 0; i < 20; ++i)
    mean += shade(*scene, float(1 - distance), 0.01F * float(i)).normal.x / 20;
  EXPECT_NEAR(mean, expected, 0.03);
}

TEST(BevelShader, counts_every_ray_within_a_closed_convex_solid_near_its_size) {
  const auto scene = prepare_scene(cube_scene(shader_settings(0.9, 4)));
  for (int i = 0; i < 100; ++i) {
    const int row = i / 10;
    const float x = -0.9F + 0.2F * float(i % 10), y = -0.9F + 0.2F * float(row);
    EXPECT_FLOAT_EQ(shade(*scene, x, y).fac, 1);
  }
}

// A step: the face z = 0 ends at the wall x = 0 of an upper block, whose far side is 10 away.
TEST(BevelShader, does_not_catch_faces_beyond_its_reach_at_a_concave_edge) {
  Scene scene = test::make_empty_scene(camera_from({0, 0, 5}));
  Mesh step;
  step.name = "step";
  const std::vector<Vec2f> outline = {{-10, -10}, {10, -10}, {10, 10}, {0, 10}, {0, 0}, {-10, 0}};
  for (const float y : {-20.0F, 20.0F}) {
    for (const Vec2f& p : outline) step.positions.push_back({p.x, y, p.y});
  }
  for (const Triangle& t : std::vector<Triangle>{{0, 1, 4}, {0, 4, 5}, {1, 2, 4}, {2, 3, 4}}) {
    step.triangles.push_back({t[0], t[1], t[2]});
    step.triangles.push_back({t[0] + 6, t[2] + 6, t[1] + 6});
  }
  for (std::uint32_t i = 0; i < 6; ++i) {
    const std::uint32_t j = (i + 1) % 6;
    step.triangles.push_back({i, i + 6, j});
    step.triangles.push_back({j, i + 6, j + 6});
  }
  test::add_object(scene, step, test::make_lambert(0.5F));
  scene.rounding = shader_settings(0.1, 4);
  const auto prepared = prepare_scene(scene);
  float least = 1;
  for (int i = 0; i < 50; ++i) {
    TraceRay ray;
    ray.origin = {-0.05F, 0.02F * float(i), 5};
    ray.direction = {0, 0, -1};
    const std::optional<ObjectHit> met = prepared->intersect_object(ray, 0);
    ASSERT_TRUE(met);
    ASSERT_NEAR(met->t, 5, 1e-5);
    SurfaceHit hit;
    hit.geometry = 0;
    hit.position = ray.origin + ray.direction * met->t;
    hit.geometric_normal = hit.shading_normal = met->geometric_normal;
    ASSERT_GT(hit.shading_normal.z, 0.999F);
    const BevelShading shading =
        eval_bevel_shader(*prepared, prepared->rounding().shaders.at(0), hit);
    EXPECT_GT(shading.normal.z, 1 - 1e-6F);  // no unrelated face
    least = std::min(least, shading.fac);
  }
  EXPECT_LT(least, 0.8F);  // the rays into the upper block count as misses
}

TEST(BevelShader, meets_the_same_object_only) {
  Scene scene = cube_scene(steep_settings(0.1));
  // A tiny cube within the first, just below the surface.
  test::add_object(scene, test::make_box_mesh(Vec3d(0.02)), test::make_lambert(0.5F),
                   test::translation({0, 0, 0.95}));
  const auto prepared = prepare_scene(scene);
  const BevelShading shading = shade(*prepared, 0, 0);
  EXPECT_FLOAT_EQ(shading.fac, 1);
  EXPECT_GT(shading.normal.z, 1 - 1e-6F);
}

TEST(BevelShader, bends_shading_normals_of_traced_hits_and_nothing_else) {
  const auto bent = prepare_scene(cube_scene(shader_settings(0.1)));
  const auto sharp = prepare_scene(cube_scene({}));
  int changed = 0;
  for (int i = 0; i < 200; ++i) {
    TraceRay ray;
    ray.origin = {-0.995F + 0.01F * float(i), 0.3F, 4};
    ray.direction = {0, 0, -1};
    const auto a = bent->intersect(ray), b = sharp->intersect(ray);
    const auto again = bent->intersect(ray);
    ASSERT_TRUE(a && b);
    EXPECT_EQ(a->t, b->t);
    EXPECT_EQ(a->geometric_normal, b->geometric_normal);
    EXPECT_EQ(a->shading_normal, again->shading_normal);
    EXPECT_GT(dot(a->shading_normal, -ray.direction), 0);
    changed += a->shading_normal == b->shading_normal ? 0 : 1;
    EXPECT_EQ(a->rounding_seen, a->shading_normal != b->shading_normal);
  }
  EXPECT_GT(changed, 10);
  EXPECT_LT(changed, 120);
}

}  // namespace
}  // namespace arris
