#include "scene/scene_fingerprint.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "geometry/shapes.h"

namespace arris {
namespace {

TEST(SceneFingerprint, tells_radii_of_edges_apart) {
  Scene plain;
  plain.meshes = {make_box_mesh({1, 1, 1})};
  plain.rounding.emplace();
  std::vector<Scene> scenes(9, plain);
  scenes[1].meshes[0].edge_radii = {{{0, 1}, 0.25F}};
  scenes[2].meshes[0].edge_radii = {{{0, 1}, 0.5F}};
  scenes[3].rounding->on_overlap = OnOverlap::clamp;
  scenes[4].rounding->rules = {{.radius = 0.5}};
  scenes[5].rounding->rules = {{.radius = 0.5, .is_part = true}};
  scenes[6].rounding->rules = {{.radius = 0.5, .turn = {{1, 2}}}};
  scenes[7].rounding->rules = {{.radius = 0.5, .box = {{Vec3d(0), Vec3d(1)}}}};
  scenes[8].rounding->rules = {{.radius = 0.5, .segments = {{Vec3d(0), Vec3d(1)}}}};
  std::set<std::uint64_t> seen;
  for (const Scene& scene : scenes) EXPECT_TRUE(seen.insert(scene_fingerprint(scene)).second);
}

}  // namespace
}  // namespace arris
