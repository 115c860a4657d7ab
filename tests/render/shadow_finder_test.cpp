// Shadow edges of a scene as triples of light, blocker and receiver become known.
#include "render/shadow_finder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include "render/edge_objects.h"
#include "render/prepared_scene.h"
#include "support/render_scenes.h"

namespace arris::test {
namespace {

// Boxes and a ball above each other, under a point light and an area light.
Scene stacked_scene() {
  Scene scene;
  scene.camera = Camera{{4, -6, 3}, {0, 0, 1}, {0, 0, 1}, 45};
  scene.materials.emplace_back();
  const auto put = [&](Mesh mesh, Vec3d at) {
    Object object;
    object.mesh = {std::uint32_t(scene.meshes.size())};
    scene.meshes.push_back(std::move(mesh));
    object.material = {0};
    object.world_from_object.translation = at;
    scene.objects.push_back(object);
  };
  put(make_box_mesh({6, 6, 0.1}), {0, 0, -0.1});
  put(make_box_mesh({1.5, 0.5, 0.05}), {0.3, 0, 1});
  put(make_box_mesh({0.5, 1.5, 0.05}), {0, 0.2, 1.5});
  Mesh ball = make_sphere_mesh(2);
  for (Vec3f& p : ball.positions) p *= 0.6F;
  put(std::move(ball), {0.2, 0.1, 2.2});
  put(make_box_mesh({0.2, 0.25, 0.3}), {-0.4, -0.2, 0.5});
  scene.lights.emplace_back(PointLight{{0.5, -0.4, 5}, Rgb(10)});
  AreaLight area;
  area.corner = {-1, 0.5, 5};
  area.edge_u = {1, 0, 0};
  area.edge_v = {0, -1, 0};
  area.radiance = Rgb(5);
  scene.lights.emplace_back(area);
  return scene;
}

std::vector<ShadowTriple> all_triples(const Scene& scene) {
  std::vector<ShadowTriple> triples;
  const auto count = std::uint32_t(scene.objects.size());
  for (std::uint32_t light = 0; light < scene.lights.size(); ++light) {
    for (std::uint32_t blocker = 1; blocker < count; ++blocker) {
      for (std::uint32_t receiver = 0; receiver < count; ++receiver) {
        triples.push_back({light, blocker, receiver});
      }
    }
  }
  return triples;
}

void expect_same(const std::vector<SoftEdge>& a, const std::vector<SoftEdge>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_TRUE(a[i].edge.a == b[i].edge.a && a[i].edge.b == b[i].edge.b &&
                a[i].penumbra == b[i].penumbra && a[i].is_umbra == b[i].is_umbra);
  }
}

void update_all(ShadowFinder& finder, const PreparedScene& scene, const EdgeObjects& objects,
                std::size_t most_events) {
  while (!finder.update(scene, objects, most_events)) {
  }
}

TEST(ShadowFinder, finds_the_same_edges_however_triples_come) {
  const auto scene = prepare_scene(stacked_scene());
  const EdgeObjects objects(*scene, 0);
  std::vector<ShadowTriple> triples = all_triples(scene->scene());
  ShadowFinder at_once;
  at_once.add(triples);
  update_all(at_once, *scene, objects, 1'000'000);
  ASSERT_GT(at_once.edges()->size(), 100U);
  std::mt19937_64 random(1);
  for (int round = 0; round < 5; ++round) {
    std::ranges::shuffle(triples, random);
    ShadowFinder finder;
    for (std::size_t i = 0; i < triples.size(); i += 3) {
      finder.add(std::span(triples).subspan(i, std::min<std::size_t>(3, triples.size() - i)));
      // At most a pair at a time: the others wait.
      finder.update(*scene, objects, 0);
    }
    update_all(finder, *scene, objects, 0);
    expect_same(*finder.edges(), *at_once.edges());
  }
}

TEST(ShadowFinder, finds_anew_what_a_move_has_changed) {
  const PrepareOptions movable{.placement = Placement::movable};
  const auto before = prepare_scene(stacked_scene(), movable);
  const EdgeObjects objects(*before, 0);
  const std::vector<ShadowTriple> triples = all_triples(before->scene());
  for (const std::uint32_t moved : {0U, 2U, 3U}) {
    ShadowFinder finder;
    finder.add(triples);
    update_all(finder, *before, objects, 1'000'000);
    Scene scene = scene_of(*before);
    scene.objects[moved].world_from_object.translation.x += 0.3;
    const auto after = prepare_moved(*before, std::move(scene), movable);
    finder.object_moved(moved);
    // Until they are found anew, edges are shown as they were.
    EXPECT_FALSE(finder.edges()->empty());
    update_all(finder, *after, objects, 1'000'000);
    ShadowFinder fresh;
    fresh.add(triples);
    update_all(fresh, *after, objects, 1'000'000);
    expect_same(*finder.edges(), *fresh.edges());
  }
}

// The least budget with which an update finds these edges at once.
std::size_t events_needed(const PreparedScene& scene, const EdgeObjects& objects,
                          std::span<const ShadowTriple> triples) {
  for (std::size_t events = 0;; ++events) {
    ShadowFinder finder;
    finder.add(triples);
    if (finder.update(scene, objects, events)) return events;
  }
}

TEST(ShadowFinder, counts_new_receivers_alone) {
  const auto scene = prepare_scene(stacked_scene());
  const EdgeObjects objects(*scene, 0);
  ShadowFinder finder;
  for (std::uint32_t receiver = 0; receiver < 4; ++receiver) {
    const std::vector<ShadowTriple> known{{0, 3, receiver}, {0, 4, receiver}};
    finder.add(known);
  }
  update_all(finder, *scene, objects, 1'000'000);
  const std::vector<ShadowTriple> added{{0, 3, 4}, {0, 4, 4}};
  finder.add(added);
  EXPECT_TRUE(finder.update(*scene, objects, events_needed(*scene, objects, added)));
}

}  // namespace
}  // namespace arris::test
