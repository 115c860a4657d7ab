// Rays against prepared geometry: no leaks, no self-intersection, instances agree with baked meshes.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "arris/error.h"
#include "render/prepared_scene.h"
#include "render/scene_geometry.h"
#include "support/render_scenes.h"

namespace arris::test {
namespace {

using Random = std::mt19937;

Vec3f random_direction(Random& random) {
  std::normal_distribution<float> gauss;
  for (;;) {
    const Vec3f v{gauss(random), gauss(random), gauss(random)};
    if (length(v) > 1e-3F) {
      return normalize(v);
    }
  }
}

Camera any_camera() {
  Camera camera;
  camera.position = {3, -4, 3};
  return camera;
}

Scene one_object(const Mesh& mesh, const Affine3d& world_from_object = {}) {
  Scene scene = make_empty_scene(any_camera());
  add_object(scene, mesh, make_lambert(0.5F), world_from_object);
  return scene;
}

PreparedScene prepare_with(const Scene& scene, std::uint64_t max_copied_triangles) {
  return PreparedScene(std::make_shared<const SceneGeometry>(
                           scene, EmbreeSceneOptions{.max_copied_triangles = max_copied_triangles}),
                       SceneRounding{});
}

TraceRay make_trace_ray(Vec3f origin, Vec3f direction) {
  TraceRay ray;
  ray.origin = origin;
  ray.direction = direction;
  return ray;
}

TEST(trace, no_ray_leaves_a_closed_mesh) {
  for (const double shift : {0.0, 1000.0}) {
    const Mesh sphere = make_sphere_mesh(4);
    const auto scene = prepare_scene(one_object(sphere, translation({shift, 0, 0})));
    const auto& geometry = scene->geometry();
    const GeometryRecord& record = geometry.embree.records()[0];
    Random random(1);
    int leaks = 0, vertex_leaks = 0;
    const auto leak = [&](Vec3f origin, Vec3f target) {
      const TraceRay ray = make_trace_ray(origin, normalize(target - origin));
      return scene->intersect(ray) && scene->occluded(ray) ? 0 : 1;
    };
    for (int i = 0; i < 200'000; ++i) {  // at random, at edges and at vertices
      const Vec3f origin = 0.5F * random_direction(random) + Vec3f(float(shift), 0, 0);
      const Triangle& t = sphere.triangles[std::size_t(i) % sphere.triangles.size()];
      const Vec3f a = record.positions[t[0]], b = record.positions[t[1]];
      const float along = std::uniform_real_distribution<float>(0, 1)(random);
      leaks += leak(origin, origin + random_direction(random));
      leaks += leak(origin, a + (b - a) * along);
      vertex_leaks += leak(origin, a);
    }
    EXPECT_EQ(leaks, 0) << shift;
    EXPECT_LE(vertex_leaks, 600) << shift;  // 3 in 1,000 of the rays aimed at the very vertex
  }
}

// A ray that leaves a convex solid outward never meets it again; one that leaves inward always does, on
// another face.
void expect_no_self_intersection(const PreparedScene& scene, Vec3f centre, float size) {
  Random random(2);
  int met_again = 0, lost = 0;
  for (int i = 0; i < 100'000; ++i) {
    const Vec3f origin = centre + 3 * size * random_direction(random);
    const Vec3f target = centre + 0.5F * size * random_direction(random);
    const auto hit = scene.intersect(make_trace_ray(origin, normalize(target - origin)));
    if (!hit) {
      ++lost;
      continue;
    }
    const Vec3f direction = random_direction(random);
    const TraceRay ray = leave_surface(*hit, direction);
    const bool outward = dot(direction, hit->geometric_normal) > 0;
    met_again += outward && scene.intersect(ray) ? 1 : 0;
    met_again += outward && scene.occluded(ray) ? 1 : 0;
    lost += !outward && !scene.intersect(ray) ? 1 : 0;
  }
  EXPECT_EQ(met_again, 0);
  EXPECT_LE(lost, 2);  // inward within the rounding error of an edge
}

TEST(trace, rays_leave_their_surface_at_any_scale) {
  for (const double scale : {1e-3, 1.0, 1e4}) {
    for (const double shift : {0.0, 10.0}) {
      const Affine3d place{{{scale, 0, 0}, {0, scale, 0}, {0, 0, scale}}, {shift * scale, 0, 0}};
      const Scene scene = one_object(make_box_mesh({1, 1, 1}), place);
      SCOPED_TRACE(testing::Message() << "scale " << scale << " shift " << shift);
      expect_no_self_intersection(*prepare_scene(scene), Vec3f(place.translation), float(scale));
      SCOPED_TRACE("instanced");
      Scene two = scene;
      two.objects.push_back(two.objects[0]);
      two.objects[1].world_from_object.translation.y += 1e3 * scale;
      const PreparedScene instanced = prepare_with(two, 0);
      ASSERT_TRUE(instanced.geometry().embree.records()[0].instanced);
      expect_no_self_intersection(instanced, Vec3f(place.translation), float(scale));
    }
  }
}

TEST(trace, huge_coordinates_keep_their_hits) {
  const Scene scene = one_object(make_box_mesh({100, 100, 100}), translation({1e6, -1e6, 1e6}));
  expect_no_self_intersection(*prepare_scene(scene), {1e6F, -1e6F, 1e6F}, 100);
}

TEST(trace, positions_lie_on_their_triangle) {
  const auto scene = prepare_scene(one_object(make_sphere_mesh(3), translation({20, 30, 40})));
  const GeometryRecord& record = scene->geometry().embree.records()[0];
  Random random(3);
  for (int i = 0; i < 10'000; ++i) {
    const auto hit = scene->intersect(make_trace_ray({20, 30, 40}, random_direction(random)));
    ASSERT_TRUE(hit);
    const Vec3d corner(record.positions[record.triangles[hit->triangle][0]]);
    ASSERT_LE(std::abs(dot(Vec3d(hit->position) - corner, Vec3d(hit->geometric_normal))),
              double(record.position_error));
    ASSERT_EQ(hit->side, Side::inside);
    ASSERT_NEAR(length(hit->geometric_normal), 1, 1e-5);
  }
}

Affine3d sheared() {
  return {{{1.5, 0.2, 0}, {-0.3, 0.8, 0.4}, {0.1, 0.5, 1.2}}, {2, -1, 0.5}};
}
Affine3d mirrored() {
  return {{{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {1, 1, 0}};
}
Affine3d unevenly_scaled() {
  return {{{3, 0, 0}, {0, 0.5, 0}, {0, 0, 1}}, {0, 2, 0}};
}

TEST(trace, instances_agree_with_baked_meshes) {
  for (const Affine3d& place : {sheared(), mirrored(), unevenly_scaled()}) {
    Scene scene = one_object(make_sphere_mesh(2), place);
    scene.meshes[0].normals = scene.meshes[0].positions;
    scene.objects.push_back(scene.objects[0]);
    scene.objects[1].world_from_object.translation.z += 5;
    const PreparedScene baked = prepare_with(scene, 1'000'000), instanced = prepare_with(scene, 0);
    ASSERT_FALSE(baked.geometry().embree.records()[0].instanced);
    ASSERT_TRUE(instanced.geometry().embree.records()[1].instanced);
    Random random(4);
    int hits = 0;
    int one_sided = 0, neighbours = 0;  // by rays that graze or meet an edge
    for (int i = 0; i < 20'000; ++i) {
      const Vec3f origin = Vec3f(place.translation) + 8 * random_direction(random);
      const Vec3f target = Vec3f(place.translation) + 2 * random_direction(random);
      const TraceRay ray = make_trace_ray(origin, normalize(target - origin));
      const auto a = baked.intersect(ray), b = instanced.intersect(ray);
      ASSERT_EQ(baked.occluded(ray), a.has_value());
      one_sided += a.has_value() != b.has_value() ? 1 : 0;
      if (!a || !b) {
        continue;
      }
      ++hits;
      ASSERT_EQ(a->object, b->object);
      if (a->triangle != b->triangle) {
        ++neighbours;
        continue;
      }
      const float grazing = std::abs(dot(ray.direction, a->geometric_normal));
      ASSERT_LE(length(a->position - b->position) * grazing, 1e-5);
      ASSERT_GT(dot(a->geometric_normal, b->geometric_normal), 0.99999F);
      ASSERT_GT(dot(a->shading_normal, b->shading_normal), 0.99999F);
      ASSERT_EQ(a->side, Side::outside);
      ASSERT_EQ(b->side, Side::outside);
    }
    EXPECT_GT(hits, 2000);
    EXPECT_LE(one_sided, 1);
    EXPECT_LE(neighbours, 4);
  }
}

TEST(trace, transformed_normals_are_perpendicular_to_the_surface) {
  const auto scene = prepare_scene(one_object(make_box_mesh({1, 1, 1}), sheared()));
  const Affine3d m = sheared();
  const auto hit = scene->intersect(make_trace_ray(
      Vec3f(transform_point(m, {0.1, 0.2, 9})), Vec3f(normalize(transform_vector(m, {0, 0, -1})))));
  ASSERT_TRUE(hit);
  EXPECT_NEAR(dot(Vec3d(hit->geometric_normal), m.linear.x), 0, 1e-6);
  EXPECT_NEAR(dot(Vec3d(hit->geometric_normal), m.linear.y), 0, 1e-6);
  EXPECT_GT(dot(Vec3d(hit->geometric_normal), m.linear.z), 0);
}

TEST(trace, degenerate_triangles_are_never_hit) {
  Mesh mesh = make_box_mesh({1, 1, 1});
  mesh.positions.insert(mesh.positions.end(), {{0, 0, 5}, {0, 0, 5}, {1, 0, 5}, {2, 0, 5}});
  mesh.triangles.insert(mesh.triangles.end(), {{8, 8, 8}, {8, 9, 10}, {8, 10, 11}});
  const auto scene = prepare_scene(one_object(mesh));
  Random random(5);
  for (int i = 0; i < 10'000; ++i) {
    const Vec3f direction = random_direction(random);
    const auto hit = scene->intersect(make_trace_ray(Vec3f(0.5F, 0, 5) - direction, direction));
    ASSERT_TRUE(!hit || hit->triangle < 12);
  }
}

TEST(trace, rendering_degenerate_triangles_stays_finite) {
  Mesh mesh = make_box_mesh({1, 1, 1});
  mesh.positions.insert(mesh.positions.end(),
                        {{0, 0, 1.5F}, {1e-20F, 0, 1.5F}, {0, 1e-20F, 1.5F}, {1, 0, 1.5F}});
  mesh.triangles.insert(mesh.triangles.end(), {{8, 9, 10}, {8, 9, 11}});
  Scene scene = one_object(mesh);
  scene.materials[0].emission = Rgb(1);
  scene.environment = ConstantEnvironment{Rgb(1)};
  const double mean = mean_of(render_path(scene, 64).picture.color);
  EXPECT_GT(mean, 1.0);
  EXPECT_LT(mean, 3.0);
}

TEST(trace, an_empty_scene_shows_its_environment) {
  Scene scene;
  scene.environment = ConstantEnvironment{{0.1F, 0.2F, 0.3F}};
  scene.image.width_px = 20;
  scene.image.height_px = 10;
  const Image image = render_path(scene, 2).picture.color;
  EXPECT_EQ(image.at(19, 9, 1), 0.2F);
}

TEST(trace, a_scene_without_lights_is_black) {
  EXPECT_EQ(mean_of(render_path(one_object(make_box_mesh({1, 1, 1})), 4).picture.color), 0.0);
}

TEST(trace, objects_without_triangles_are_skipped) {
  Scene scene = one_object(Mesh{});
  add_object(scene, make_box_mesh({1, 1, 1}), make_lambert(0.5F));
  const auto prepared = prepare_scene(scene);
  const auto hit = prepared->intersect(make_trace_ray({0, 0, 5}, {0, 0, -1}));
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->object.index, 1U);
  EXPECT_EQ(prepare_stats(*prepared).triangles, 12U);
}

}  // namespace
}  // namespace arris::test
