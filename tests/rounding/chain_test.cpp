// chain_test.cpp — rims of many pieces, as machined parts are cut into: rounded as the torus that they stand for
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "arris/rounding.h"
#include "support/nonconvex_solids.h"
#include "support/rounded_ray.h"

namespace arris::oracle {
namespace {

struct Ring {
  double radius, z;
  std::vector<double> angles;  // ascending, within one turn
};

std::vector<double> even_angles(int count, double first) {
  std::vector<double> angles;
  for (int i = 0; i < count; ++i) angles.push_back(first + 2 * std::numbers::pi * i / count);
  return angles;
}

// A ring-shaped solid. Its facets are those between the points nearest to each other in angle.
class RingSolid {
 public:
  RingSolid(const Ring& outer_top, const Ring& outer_bottom, const Ring& hole_top,
            const Ring& hole_bottom) {
    mesh_.name = "ring";
    const std::uint32_t rings[] = {add(outer_bottom), add(outer_top), add(hole_top),
                                   add(hole_bottom)};
    const std::size_t sizes[] = {outer_bottom.angles.size(), outer_top.angles.size(),
                                 hole_top.angles.size(), hole_bottom.angles.size()};
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t j = (i + 1) % 4;
      join(rings[i], sizes[i], rings[j], sizes[j]);
    }
  }

  [[nodiscard]] const TriangleSoup& mesh() const { return mesh_; }

 private:
  std::uint32_t add(const Ring& ring) {
    const auto first = std::uint32_t(mesh_.positions.size());
    for (const double a : ring.angles) {
      mesh_.positions.push_back(
          Vec3f(Vec3d(ring.radius * std::cos(a), ring.radius * std::sin(a), ring.z)));
      angles_.push_back(a);
    }
    return first;
  }

  void join(std::uint32_t a, std::size_t size_a, std::uint32_t b, std::size_t size_b) {
    const auto angle = [&](std::uint32_t first, std::size_t size, std::size_t i) {
      return angles_[first + i % size] + 2 * std::numbers::pi * double(i / size);
    };
    for (std::size_t i = 0, j = 0; i < size_a || j < size_b;) {
      const bool along_a =
          j == size_b || (i < size_a && angle(a, size_a, i + 1) <= angle(b, size_b, j + 1));
      const auto at_a = a + std::uint32_t(i % size_a);
      const auto at_b = b + std::uint32_t(j % size_b);
      if (along_a) {
        mesh_.triangles.push_back({at_a, a + std::uint32_t((i + 1) % size_a), at_b});
        ++i;
      } else {
        mesh_.triangles.push_back({at_a, b + std::uint32_t((j + 1) % size_b), at_b});
        ++j;
      }
    }
  }

  TriangleSoup mesh_;
  std::vector<double> angles_;
};

constexpr double kRadius = 0.3;

// How far below the top a torus of the rounding radius lies, so far from the rim.
double depth_at(double from_rim) {
  const double d = kRadius - from_rim;
  return kRadius - std::sqrt(kRadius * kRadius - d * d);
}

// Rays from above onto a circle of the top: none may meet the sharp face, and straight ones meet the torus.
void expect_rounded(const RingSolid& solid, double circle, double rim) {
  RoundingOptions options;
  options.radius = kRadius;
  const Rounding rounding = make_rounding(solid.mesh().view(), options, "ring");
  for (const RoundingNote& note : rounding.report().notes) {
    EXPECT_EQ(std::string(note.many).find("needs more length"), std::string::npos);
    EXPECT_EQ(std::string(note.many).find("too large"), std::string::npos) << note.count;
  }
  int flat = 0;
  for (int i = 0; i < 1440; ++i) {
    const double a = 2 * std::numbers::pi * (i + 0.37) / 1440;
    const Vec3d target(circle * std::cos(a), circle * std::sin(a), 1);
    for (const double lean : {0.0, 1.5, -1.5}) {
      const Vec3d direction = normalize(Vec3d(lean * std::cos(a), lean * std::sin(a), -1));
      const Ray ray{target - direction * 2.0, direction};
      const auto hit = trace(ray, {solid.mesh().view(), &rounding});
      if (hit && std::abs(hit->t - 2) < 1e-5) ++flat;
      if (lean != 0) continue;
      ASSERT_TRUE(hit) << i;
      EXPECT_NEAR(hit->t - 2, depth_at(std::abs(circle - rim)), 0.01) << i;
    }
  }
  EXPECT_EQ(flat, 0);
}

// Every other facet of the wall touches the rim in a corner only; the edges that are rounded there aren't its own.
TEST(Chain, facets_that_touch_a_rim_in_a_corner_are_rounded_with_it) {
  const RingSolid solid({3, 1, even_angles(64, 0)}, {3, 0, even_angles(64, 0)},
                        {1, 1, even_angles(48, 0)},
                        {1, 0, even_angles(48, 2 * std::numbers::pi / 96)});
  expect_rounded(solid, 1.1, 1);
}

TEST(Chain, facets_that_touch_an_outer_rim_in_a_corner_are_rounded_with_it) {
  const RingSolid solid({3, 1, even_angles(64, 0)},
                        {3, 0, even_angles(64, 2 * std::numbers::pi / 128)},
                        {1, 1, even_angles(48, 0)}, {1, 0, even_angles(48, 0)});
  expect_rounded(solid, 2.9, 3);
}

// In the eroded solid short pieces of the rim have vanished: their neighbours meet beyond them.
TEST(Chain, short_pieces_of_a_rim_are_rounded_by_their_neighbours) {
  std::vector<double> angles = even_angles(64, 0);
  for (const double more : {0.002, 1.004, 1.0045, 2.5, 4.9101}) angles.push_back(more);
  std::ranges::sort(angles);
  const RingSolid solid({3, 1, angles}, {3, 0, angles}, {1, 1, even_angles(48, 0)},
                        {1, 0, even_angles(48, 0)});
  expect_rounded(solid, 2.9, 3);
  const RingSolid uneven({3, 1, angles}, {3, 0, even_angles(64, 0.01)}, {1, 1, even_angles(48, 0)},
                         {1, 0, even_angles(48, 0)});
  expect_rounded(uneven, 2.9, 3);
}

}  // namespace
}  // namespace arris::oracle
