// What keys make of a scene between them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "arris/render.h"
#include "geometry/shapes.h"
#include "scene/scene_fingerprint.h"

namespace arris {
namespace {

using testing::HasSubstr;

Scene moving_scene(const std::vector<ObjectKey>& keys) {
  Scene scene;
  scene.materials.emplace_back();
  scene.meshes = {make_box_mesh({1, 1, 1})};
  scene.objects.resize(1);
  scene.animation.objects.push_back({{{ObjectId{0}, {}}}, keys});
  return scene;
}

ObjectKey key_at(double frame, double x, double scale = 1) {
  return {frame, {x, 0, 0}, {}, Vec3d(scale)};
}

double x_at(const Scene& scene, double frame) {
  return scene_at(scene, frame).objects[0].world_from_object.translation.x;
}

TEST(SceneAt, meets_every_key_and_rests_outside) {
  const Scene scene = moving_scene({key_at(-3, 5), key_at(0.25, -1), key_at(7, 2), key_at(8, 0)});
  for (const ObjectKey& key : scene.animation.objects[0].keys) {
    EXPECT_EQ(x_at(scene, key.frame), key.translate.x);
  }
  EXPECT_EQ(x_at(scene, -1e6), 5);
  EXPECT_EQ(x_at(scene, 1e6), 0);
}

// The spline takes its tangents from parabolas, whatever the distances of the keys.
TEST(SceneAt, smooth_keys_of_a_parabola_are_on_it_between_them) {
  const auto parabola = [](double t) { return 0.5 * t * t - 3 * t + 1; };
  std::vector<ObjectKey> keys;
  for (const double t : {-4.0, -1.0, 0.5, 1.0, 6.0, 20.0}) keys.push_back(key_at(t, parabola(t)));
  const Scene scene = moving_scene(keys);
  for (double t = -1; t <= 6; t += 0.125) EXPECT_NEAR(x_at(scene, t), parabola(t), 1e-12) << t;
}

TEST(SceneAt, smooth_keys_have_no_kink) {
  const Scene scene = moving_scene({key_at(0, 0), key_at(1, 3), key_at(5, -2), key_at(6, 4)});
  constexpr double kStep = 1e-6;
  for (const double t : {1.0, 5.0}) {
    const double before = (x_at(scene, t) - x_at(scene, t - kStep)) / kStep;
    const double after = (x_at(scene, t + kStep) - x_at(scene, t)) / kStep;
    EXPECT_NEAR(before, after, 1e-3) << t;
  }
}

TEST(SceneAt, two_keys_are_a_straight_way) {
  const Scene scene = moving_scene({key_at(0, 0), key_at(4, 8)});
  EXPECT_NEAR(x_at(scene, 1), 2, 1e-12);
}

TEST(SceneAt, linear_keys_are_straight_ways) {
  Scene scene = moving_scene({key_at(0, 0), key_at(1, 3), key_at(5, -2)});
  scene.animation.interpolation = Interpolation::linear;
  EXPECT_DOUBLE_EQ(x_at(scene, 0.5), 1.5);
  EXPECT_DOUBLE_EQ(x_at(scene, 3), 0.5);
}

TEST(SceneAt, sizes_never_swing_beyond_their_keys) {
  const Scene scene =
      moving_scene({key_at(0, 0, 5), key_at(1, 0, 0.01), key_at(30, 0, 0.02), key_at(31, 0, 9)});
  for (double t = 0; t <= 31; t += 0.25) {
    const double scale = scene_at(scene, t).objects[0].world_from_object.linear.x.x;
    EXPECT_GE(scale, 0.01) << t;
    EXPECT_LE(scale, 9) << t;
  }
}

TEST(SceneAt, shares_meshes_with_the_scene) {
  const Scene scene = moving_scene({key_at(0, 0), key_at(1, 3)});
  const Scene moved = scene_at(scene, 0.5);
  EXPECT_TRUE(moved.meshes.is_same_as(scene.meshes));
  EXPECT_EQ(moved.meshes[0].positions.data(), scene.meshes[0].positions.data());
}

TEST(SceneAt, fingerprints_tell_frames_apart_and_know_no_keys) {
  Scene scene = moving_scene({key_at(0, 0), key_at(1, 3)});
  EXPECT_NE(scene_fingerprint(scene_at(scene, 0)), scene_fingerprint(scene_at(scene, 1)));
  const Scene still = scene_at(scene, 1);
  Scene plain = still;
  plain.animation = {};
  EXPECT_EQ(scene_fingerprint(still), scene_fingerprint(plain));
}

TEST(ValidateKeys, refuses_what_is_no_number_or_out_of_order) {
  const auto problem = [](const std::vector<ObjectKey>& keys) {
    const std::vector<std::string> problems = validate_scene(moving_scene(keys));
    return problems.empty() ? std::string() : problems[0];
  };
  EXPECT_EQ(problem({key_at(0, 0), key_at(1, 3)}), "");
  EXPECT_THAT(problem({}), HasSubstr("object track 0: has no key"));
  EXPECT_THAT(problem({key_at(1, 0), key_at(0, 3)}), HasSubstr("key 1: frame is 0, after 1"));
  EXPECT_THAT(problem({key_at(NAN, 0)}), HasSubstr("key 0: frame is nan"));
  EXPECT_THAT(problem({key_at(2e6, 0)}), HasSubstr("key 0: frame is 2e+06"));
  EXPECT_THAT(problem({key_at(0, INFINITY)}), HasSubstr("key 0: holds what is not a number"));
  Scene scene = moving_scene({key_at(0, 0)});
  scene.animation.objects[0].parts[0].object.index = 4;
  EXPECT_THAT(validate_scene(scene)[0], HasSubstr("moves object 4, but there are 1"));
  scene = moving_scene({key_at(0, 0)});
  scene.animation.lights.push_back({3, LightTrack::Aim::direction, {0, 0, 1}, {LightKey{}}});
  EXPECT_THAT(validate_scene(scene)[0], HasSubstr("moves light 3, but there are 0"));
}

}  // namespace
}  // namespace arris
