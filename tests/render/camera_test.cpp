#include "render/camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "render/pixel_filter.h"
#include "support/render_scenes.h"

namespace arris::test {
namespace {

struct Frame2d {
  double left = 1, right = 0, top = 1, bottom = 0;  // of the picture's width and height
};

// Where the scene's vertices fall in the picture.
Frame2d project(const Scene& scene, const Camera& camera) {
  const Vec3d forward = normalize(camera.target - camera.position);
  const Vec3d right = normalize(cross(forward, camera.up));
  const Vec3d up = cross(right, forward);
  const double tan_y = std::tan(radians(camera.fov_deg) / 2);
  const double tan_x = tan_y * scene.image.width_px / scene.image.height_px;
  Frame2d frame;
  for (const Object& object : scene.objects) {
    for (const Vec3f& position : scene.meshes[object.mesh.index].positions) {
      const Vec3d p = transform_point(object.world_from_object, Vec3d(position)) - camera.position;
      const double depth = dot(p, forward);
      EXPECT_GT(depth, 0);
      const double x = 0.5 + dot(p, right) / depth / tan_x / 2;
      const double y = 0.5 - dot(p, up) / depth / tan_y / 2;
      frame.left = std::min(frame.left, x);
      frame.right = std::max(frame.right, x);
      frame.top = std::min(frame.top, y);
      frame.bottom = std::max(frame.bottom, y);
    }
  }
  return frame;
}

Scene model(const Mesh& mesh, int width_px, int height_px, Vec3d place = {100, -20, 3}) {
  Scene scene;
  add_object(scene, mesh, make_lambert(0.5F), translation(place));
  scene.image.width_px = width_px;
  scene.image.height_px = height_px;
  return scene;
}

TEST(camera, frames_any_model_tightly_with_a_margin) {
  for (const Vec3d half :
       {Vec3d(1, 1, 1), Vec3d(10, 0.1, 0.1), Vec3d(0.1, 0.2, 30), Vec3d(5, 5, 1e-3)}) {
    for (const int width : {300, 1280, 4000}) {
      for (const Vec3d up : {Vec3d(0, 0, 1), Vec3d(0, 1, 0), Vec3d(1, 0, 0)}) {
        Scene scene = model(make_box_mesh(half), width, 720);
        scene.up = up;
        const Frame2d f = project(scene, frame_scene(scene));
        const double margin = std::min({f.left, 1 - f.right, f.top, 1 - f.bottom});
        EXPECT_GT(margin, 0.05);
        // One direction fills the picture but for its margins, the model in their middle.
        EXPECT_NEAR(std::max(f.right - f.left, f.bottom - f.top), 0.84, 0.01);
      }
    }
  }
}

TEST(camera, frames_a_model_alike_wherever_it_is) {
  const Frame2d here = project(model(make_box_mesh({1, 1, 1}), 1280, 720, {}),
                               frame_scene(model(make_box_mesh({1, 1, 1}), 1280, 720, {})));
  for (const double far : {1e3, 1e5, -1e5, 1e7}) {
    const Scene scene = model(make_box_mesh({1, 1, 1}), 1280, 720, Vec3d(far));
    const Frame2d there = project(scene, frame_scene(scene));
    EXPECT_NEAR(there.left, here.left, 1e-5) << far;
    EXPECT_NEAR(there.right, here.right, 1e-5) << far;
    EXPECT_NEAR(there.top, here.top, 1e-5) << far;
    EXPECT_NEAR(there.bottom, here.bottom, 1e-5) << far;
  }
}

TEST(camera, frames_a_point_and_nothing) {
  Mesh point;
  point.positions = {{1, 2, 3}};
  Scene scene = model(point, 640, 480);
  EXPECT_TRUE(is_finite(frame_scene(scene).position));
  scene.camera = frame_scene(scene);
  EXPECT_EQ(validate_scene(scene), std::vector<std::string>());
  Scene nothing;
  nothing.camera = frame_scene(nothing);
  EXPECT_EQ(validate_scene(nothing), std::vector<std::string>());
}

TEST(camera, looks_from_above_the_front_and_the_right) {
  Scene scene = model(make_box_mesh({1, 1, 1}), 640, 480);
  const Camera z_up = frame_scene(scene);
  const Vec3d d = z_up.position - z_up.target;
  EXPECT_GT(d.x, 0);
  EXPECT_LT(d.y, -d.x);
  EXPECT_GT(d.z, 0);
  scene.up = {0, 1, 0};
  const Camera y_up = frame_scene(scene);
  const Vec3d e = y_up.position - y_up.target;
  EXPECT_GT(e.x, 0);
  EXPECT_GT(e.z, e.x);
  EXPECT_GT(e.y, 0);
}

TEST(camera, centre_and_corners_of_the_picture) {
  Camera camera;
  camera.position = {0, -10, 0};
  camera.fov_deg = 90;
  ImageSettings image;
  image.width_px = 200;
  image.height_px = 100;
  const CameraRays rays = make_camera_rays(camera, image);
  const Vec3f centre = camera_ray(rays, 100, 50).direction;
  EXPECT_NEAR(length(centre - Vec3f(0, 1, 0)), 0, 1e-6);
  const Vec3f top = camera_ray(rays, 100, 0).direction;
  EXPECT_NEAR(top.z / top.y, 1, 1e-6);
  const Vec3f right = camera_ray(rays, 200, 50).direction;
  EXPECT_NEAR(right.x / right.y, 2, 1e-6);
}

TEST(pixel_filter, offsets_are_distributed_as_the_filter) {
  using Filter = ImageSettings::Filter;
  for (const Filter filter :
       {Filter::box, Filter::tent, Filter::gaussian, Filter::blackman_harris}) {
    const PixelFilter sampler(filter);
    constexpr int kBins = 30, kSamples = 1 << 18;
    const double radius = filter_radius(filter);
    std::vector<double> observed(kBins), expected(kBins);
    double total = 0;
    for (int i = 0; i < kSamples; ++i) {
      const double x = double(sampler.sample_offset((float(i) + 0.5F) / float(kSamples)));
      ASSERT_LE(std::abs(x), radius * (1 + 1e-6));
      observed[std::size_t(std::clamp(int((x + radius) / (2 * radius) * kBins), 0, kBins - 1))] +=
          1.0 / kSamples;
    }
    for (int bin = 0; bin < kBins; ++bin) {
      for (int i = 0; i < 100; ++i) {
        const double x = -radius + 2 * radius * (bin + (i + 0.5) / 100) / kBins;
        expected[std::size_t(bin)] += eval_filter(filter, x);
      }
      total += expected[std::size_t(bin)];
    }
    for (std::size_t bin = 0; bin < kBins; ++bin) {
      EXPECT_NEAR(observed[bin], expected[bin] / total, 0.001) << int(filter) << " bin " << bin;
    }
  }
}

}  // namespace
}  // namespace arris::test
