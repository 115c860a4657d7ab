// CSG solids in scenes: rays, secondary rays, materials, instances, pictures.
#include <gtest/gtest.h>

#include <cmath>

#include "arris/error.h"
#include "arris/inspect.h"
#include "csg/csg_cells.h"
#include "render/camera.h"
#include "render/prepared_scene.h"
#include "render/scene_geometry.h"
#include "render/shoot.h"
#include "render/staging.h"
#include "support/csg_oracle.h"
#include "support/render_scenes.h"

namespace arris::test {
namespace {

// Materials by leaf are kept if there are as many.
Object& add_csg(Scene& scene, CsgTree tree, const Affine3d& world_from_object = {}) {
  if (scene.meshes.empty()) scene.meshes.emplace_back();
  std::size_t materials = 1;
  for (const CsgLeaf& leaf : tree.leaves) {
    materials = std::max(materials, leaf.material.index + std::size_t{1});
  }
  while (scene.materials.size() < materials) scene.materials.push_back(make_lambert(0.5F));
  Object object;
  object.name = tree.name + std::to_string(scene.objects.size());
  object.csg = CsgId{std::uint32_t(scene.csg_trees.size())};
  object.world_from_object = world_from_object;
  scene.csg_trees.push_back(std::move(tree));
  scene.objects.push_back(object);
  return scene.objects.back();
}

Scene csg_scene(CsgTree tree, const Affine3d& world_from_object = {}) {
  Camera camera;
  camera.position = {3, -4, 3};
  Scene scene = make_empty_scene(camera);
  add_csg(scene, std::move(tree), world_from_object);
  return scene;
}

TraceRay make_trace_ray(Vec3d origin, Vec3d direction) {
  TraceRay ray;
  ray.origin = Vec3f(origin);
  ray.direction = normalize(Vec3f(direction));
  return ray;
}

// A block with a round hole along z, and a ball taken out of its side.
CsgTree drilled_block() {
  return flat_tree(CsgOperation::subtract, {{CsgBox{Vec3d(-1), Vec3d(1)}, {}, {0}},
                                            {CsgCone{-2, 2, 0.5, 0.5}, {}, {1}},
                                            {CsgSphere{0.6}, {{}, {1, 0.2, 0}}, {2}}});
}

TEST(csg_scene, hits_are_those_of_the_solid_for_any_placement) {
  CsgRandom random(1);
  for (int i = 0; i < 30; ++i) {
    const CsgTree tree = random_tree(random, 3);
    const Affine3d place = i == 0 ? Affine3d{} : random_placement(random, 5);
    Scene scene = csg_scene(tree, place);
    scene.objects.push_back(scene.objects[0]);  // an instance
    scene.objects[1].world_from_object.translation += Vec3d(20, 0, 0);
    const auto prepared = prepare_scene(std::move(scene));
    const CsgSolid solid(tree);
    BoundarySearch search;
    const Affine3d object_from_world = inverse(place);
    for (int k = 0; k < 300; ++k) {
      const Vec3d target = transform_point(place, random_vector(random, 1.5));
      const Vec3d origin = place.translation + random_unit(random) * 8.0;
      const TraceRay ray = make_trace_ray(origin, target - origin);
      const Ray own{transform_point(object_from_world, Vec3d(ray.origin)),
                    transform_vector(object_from_world, Vec3d(ray.direction))};
      const CsgBoundary* first = nullptr;
      for (const CsgBoundary& b : search.find(solid, view_of(solid.root()), own)) {
        if (b.t > 0 && (first == nullptr || b.t < first->t)) first = &b;
      }
      const auto hit = prepared->intersect(ray);
      ASSERT_EQ(hit && hit->object.index == 0, first != nullptr);
      if (first == nullptr) continue;
      ASSERT_EQ(hit->t, float(first->t));
      ASSERT_EQ(hit->feature, Feature::csg);
      ASSERT_EQ(hit->material, tree.leaves[first->leaf].material);
      ASSERT_EQ(hit->side == Side::outside, first->entering);
      ASSERT_EQ(hit->side == Side::outside, dot(ray.direction, hit->geometric_normal) < 0);
      TraceRay shadow = ray;
      shadow.t_max = hit->t * 0.9999F;
      ASSERT_FALSE(prepared->occluded(shadow));
      shadow.t_max = hit->t * 1.0001F;
      ASSERT_TRUE(prepared->occluded(shadow));
      const TraceRay moved =
          make_trace_ray(Vec3d(ray.origin) + Vec3d(20, 0, 0), Vec3d(ray.direction));
      const auto twin = prepared->intersect(moved);
      ASSERT_TRUE(twin.has_value());
      EXPECT_EQ(twin->object.index, 1U);
    }
  }
}

// Rays that leave a hit know at once whether they are inside: by membership a little further on.
TEST(csg_scene, secondary_rays_start_on_their_side) {
  CsgRandom random(2);
  for (const double scale : {1e-3, 1.0, 1e4}) {
    const Affine3d place{{{scale, 0, 0}, {0, scale, 0}, {0, 0, scale}}, Vec3d(3 * scale)};
    const auto prepared = prepare_scene(csg_scene(drilled_block(), place));
    int wrong = 0, tried = 0;
    for (int i = 0; i < 20'000; ++i) {
      const Vec3d target = place.translation + random_vector(random, scale);
      const Vec3d origin = place.translation + random_unit(random) * (4 * scale);
      const auto hit = prepared->intersect(make_trace_ray(origin, target - origin));
      if (!hit) continue;
      const TraceRay next = leave_surface(*hit, Vec3f(random_unit(random)));
      const bool outward = dot(next.direction, hit->geometric_normal) > 0;
      const auto second = prepared->intersect(next);
      // What leaves outward comes back from outside, what goes inward leaves.
      const Side expected = outward ? Side::outside : Side::inside;
      wrong += (second ? second->side != expected : !outward) ? 1 : 0;
      ++tried;
    }
    EXPECT_GT(tried, 5000);
    EXPECT_LE(wrong, tried / 2000) << scale;  // within the error of an edge
  }
}

TEST(csg_scene, holes_show_what_drilled_them) {
  const auto prepared = prepare_scene(csg_scene(drilled_block()));
  const auto material = [&](Vec3d from, Vec3d to) {
    return prepared->intersect(make_trace_ray(from, to - from))->material.index;
  };
  EXPECT_EQ(material({0.8, 0.8, 5}, {0.8, 0.8, 0}), 0U);
  EXPECT_EQ(material({0.3, 0, 5}, {-0.5, 0, 0}), 1U);
  EXPECT_EQ(material({5, 0.2, 0}, {0, 0.2, 0.3}), 2U);
  EXPECT_FALSE(prepared->intersect(make_trace_ray({0, 0, 5}, {0, 0, -1})));
  EXPECT_FALSE(prepared->occluded(make_trace_ray({0, 0, 5}, {0, 0, -1})));
}

TEST(csg_scene, translucent_solids_count_each_surface_once) {
  // Boxes that touch, on a grid on which cells are halved, too.
  std::vector<CsgLeaf> leaves;
  for (int i = 0; i < 64; ++i) {
    const Vec3d at{double(i % 4), double(i / 4 % 4), double(i / 16)};
    leaves.push_back({CsgBox{at, at + Vec3d(1, 1, i % 2 == 0 ? 1.0 : 0.5)}, {}, {}});
  }
  const CsgTree tree = flat_tree(CsgOperation::unite, std::move(leaves));
  Scene scene = csg_scene(tree);
  scene.materials[0].opacity = 0.5F;
  const auto prepared = prepare_scene(std::move(scene));
  const CsgSolid solid(tree);
  BoundarySearch search;
  CsgRandom random(3);
  for (int i = 0; i < 2000; ++i) {
    Ray ray{{uniform(random, 0, 4), uniform(random, 0, 4), 8}, {0, 0, -1}};
    if (i % 2 == 0)
      ray.direction = Vec3d(normalize(Vec3f(random_vector(random, 0.3) - Vec3d(0, 0, 1))));
    ray.origin = Vec3d(Vec3f(ray.origin));
    TraceRay traced;
    traced.origin = Vec3f(ray.origin);
    traced.direction = Vec3f(ray.direction);
    const std::size_t count = search.find(solid, view_of(solid.root()), ray).size();
    ASSERT_EQ(prepared->transmittance(traced), std::pow(0.5F, float(count))) << i;
  }
}

// A sphere in a uniform white furnace, as a CSG solid: radiance = albedo where it is seen.
TEST(csg_scene, furnace) {
  Camera camera;
  camera.position = {0, -3, 0};
  camera.fov_deg = 10;
  Scene scene = make_empty_scene(camera);
  scene.environment = ConstantEnvironment{{1, 1, 1}};
  add_csg(scene, one_leaf(CsgSphere{1}));
  EXPECT_NEAR(mean_of(render_path(scene, 64).picture.color), 0.5, 0.01);
  scene.materials[0] = Material{};
  scene.materials[0].transmission = 1;
  scene.materials[0].roughness = 0;
  scene.materials[0].base_color = {1, 1, 1};
  scene.image.max_depth = 200;
  EXPECT_NEAR(mean_of(render_path(scene, 64).picture.color), 1, 0.01);  // glass loses nothing
  scene.materials[0] = make_lambert(0);
  scene.materials[0].emission = {2, 2, 2};
  EXPECT_NEAR(mean_of(render_path(scene, 4).picture.color), 2, 0.01);
}

TEST(csg_scene, agrees_with_a_mesh_of_the_same_shape) {
  const auto box_scene = [](bool csg) {
    Camera camera;
    camera.position = {3, -4, 3};
    Scene scene = make_empty_scene(camera);
    scene.environment = ConstantEnvironment{{1, 1, 1}};
    scene.lights.emplace_back(PointLight{{2, -2, 4}, {20, 20, 20}});
    if (csg) {
      add_csg(scene, one_leaf(CsgBox{Vec3d(-1), Vec3d(1)}));
    } else {
      add_object(scene, make_box_mesh(Vec3d(1)), make_lambert(0.5F));
    }
    scene.image.width_px = scene.image.height_px = 16;
    return scene;
  };
  const Image a = render_path(box_scene(true), 16).picture.color;
  const Image b = render_path(box_scene(false), 16).picture.color;
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    EXPECT_NEAR(a.values[i], b.values[i], 1e-3F * (1 + b.values[i])) << i;
  }
}

TEST(csg_scene, shoots_exactly) {
  const auto prepared = prepare_scene(csg_scene(one_leaf(CsgSphere{1})));
  const Shooter shooter(*prepared);
  const auto shot = shooter.shoot({{0.3, 0.4, 1000}, {0, 0, -2}});
  ASSERT_TRUE(shot);
  EXPECT_NEAR(shot->t, (1000 - std::sqrt(0.75)) / 2, 1e-12);
  EXPECT_NEAR(shot->normal.x, 0.3, 1e-12);
  EXPECT_STREQ(name_of(shot->feature), "csg");
  EXPECT_FALSE(shot->inside);
  const auto from_inside = shooter.shoot({{0.3, 0.4, 0}, {0, 0, 1}});
  ASSERT_TRUE(from_inside);
  EXPECT_TRUE(from_inside->inside);
  EXPECT_NEAR(from_inside->normal.z, std::sqrt(0.75), 1e-12);
}

TEST(csg_scene, is_framed_staged_and_inspected) {
  Scene scene = csg_scene(drilled_block(), translation({10, 0, 0}));
  scene.camera.reset();
  const SceneReport report = inspect_scene(scene);
  ASSERT_TRUE(report.objects[0].csg);
  EXPECT_EQ(report.objects[0].csg->primitives, 3U);
  EXPECT_EQ(report.objects[0].csg->operations, 1U);
  EXPECT_EQ(report.objects[0].csg->depth, 1U);
  EXPECT_NEAR(report.bounds_min.x, 9, 1e-12);
  EXPECT_NEAR(report.bounds_max.z, 1, 1e-12);
  EXPECT_NEAR(frame_scene(scene).target.x, 10, 1);
  StageOptions options;
  options.lighting = Lighting::studio;
  options.ground = true;
  stage_model(scene, options);
  ASSERT_EQ(scene.objects.size(), 2U);
  EXPECT_NEAR(scene.meshes.back().positions[0].z, -1, 0.01);
}

TEST(csg_scene, rounding_settings_leave_a_note) {
  Scene scene = csg_scene(drilled_block());
  add_object(scene, make_box_mesh(Vec3d(0.5)), make_lambert(0.5F), translation({0, 3, 0}));
  scene.rounding = RoundingSettings{};
  for (const RoundMethod method : {RoundMethod::exact, RoundMethod::mesh, RoundMethod::shader}) {
    scene.rounding->method = method;
    scene.rounding->radius = 0.1;
    const auto prepared = prepare_scene(scene);
    int notes = 0;
    for (const RoundingSummary& summary : prepare_stats(*prepared).rounding) {
      if (summary.object_index != 0) continue;
      ++notes;
      EXPECT_EQ(summary.radius, 0);
      EXPECT_NE(summary.notes.at(0).text().find("stay sharp"), std::string::npos);
    }
    EXPECT_EQ(notes, 1);
    CsgRandom random(4);
    for (int i = 0; i < 2000; ++i) {  // rounded meshes and CSG in one scene
      const Vec3d target = Vec3d(0, 1.5, 0) + random_vector(random, 2);
      const auto hit = prepared->intersect(make_trace_ray({4, -5, 6}, target - Vec3d(4, -5, 6)));
      if (hit && hit->object.index == 0) {
        ASSERT_EQ(hit->feature, Feature::csg);
        (void)prepared->intersect(leave_surface(*hit, Vec3f(random_unit(random))));
      }
    }
  }
}

TEST(csg_scene, empty_and_endless_solids) {
  const auto prepared = prepare_scene(csg_scene(flat_tree(CsgOperation::unite, {})));
  EXPECT_FALSE(prepared->intersect(make_trace_ray({0, 0, 5}, {0, 0, -1})));
  EXPECT_THROW(prepare_scene(csg_scene(one_leaf(CsgHalfSpace{}))), Error);
}

}  // namespace
}  // namespace arris::test
