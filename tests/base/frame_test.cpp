#include "base/frame.h"

#include <gtest/gtest.h>

#include <random>

namespace arris {
namespace {

void expect_orthonormal(const Frame& f) {
  EXPECT_NEAR(length(f.tangent), 1.0F, 2e-6F);
  EXPECT_NEAR(length(f.bitangent), 1.0F, 2e-6F);
  EXPECT_NEAR(dot(f.tangent, f.bitangent), 0.0F, 2e-6F);
  EXPECT_NEAR(length(cross(f.tangent, f.bitangent) - f.normal), 0.0F, 3e-6F);
}

TEST(Frame, is_orthonormal_and_right_handed) {
  std::mt19937 random(1);
  std::normal_distribution<float> gauss;
  for (int i = 0; i < 2000; ++i) {
    const Vec3f n = normalize(Vec3f{gauss(random), gauss(random), gauss(random)});
    expect_orthonormal(make_frame(n));
    expect_orthonormal(make_frame(n, normalize(Vec3f{gauss(random), gauss(random), 2})));
  }
  for (const Vec3f n : {Vec3f{0, 0, 1}, Vec3f{0, 0, -1}, Vec3f{1, 0, 0}, Vec3f{0, -1, 0},
                        normalize(Vec3f{1e-4F, 0, -1})}) {
    expect_orthonormal(make_frame(n));
  }
}

TEST(Frame, local_and_world_are_inverse) {
  const Frame frame = make_frame(normalize(Vec3f{1, 2, -3}));
  const Vec3f v{0.3F, -4, 2};
  EXPECT_LT(length(world_from_local(frame, local_from_world(frame, v)) - v), 3e-6F);
  EXPECT_LT(length(local_from_world(frame, frame.normal) - Vec3f{0, 0, 1}), 1e-6F);
}

}  // namespace
}  // namespace arris
