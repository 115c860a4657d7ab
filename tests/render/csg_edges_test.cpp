// Edges of solids of solids: closed forms, and dense rays.
#include "render/csg_edges.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <string>
#include <thread>

#include "arris/error.h"
#include "io/csg_reader.h"
#include "support/csg_oracle.h"
#include "support/csg_picture.h"

namespace arris::test {
namespace {

std::shared_ptr<const CsgCells> cells_of(const CsgTree& tree) {
  return std::make_shared<const CsgCells>(std::make_shared<const CsgSolid>(tree), tree.name);
}

double length_of(std::span<const CsgEdges::Segment> segments) {
  double sum = 0;
  for (const CsgEdges::Segment& s : segments) sum += length(s.b - s.a);
  return sum;
}

double length_of(const std::vector<CreaseSegment>& segments) {
  double sum = 0;
  for (const CreaseSegment& s : segments) sum += length(s.b - s.a);
  return sum;
}

CsgLeaf leaf_of(CsgPrimitive primitive, const Affine3d& place = {}, std::uint32_t material = 0) {
  return {std::move(primitive), place, MaterialId{material}};
}

constexpr Affine3d kAlongX{{{0, 1, 0}, {0, 0, 1}, {1, 0, 0}}, {}};

std::vector<CreaseSegment> creases_of(const CsgEdges& edges) {
  return find_creases(edges.probe(), SmoothPatches(edges.probe().solid()), 0);
}

TEST(csg_edges, sphere_has_the_circle_of_tangents_as_outline_and_no_creases) {
  const CsgEdges edges(cells_of(one_leaf(CsgSphere{2})), 0);
  EXPECT_TRUE(creases_of(edges).empty());
  const Vec3d eye{3, -4, 5};
  const CsgEdges::Found found = edges.find(eye, 0);
  ASSERT_FALSE(found.silhouette.empty());
  for (const CsgEdges::Segment& s : found.silhouette) {
    EXPECT_NEAR(length(s.a), 2, 1e-12);
    EXPECT_NEAR(dot(s.a, eye), 4, 1e-10);
  }
  const double radius = 2 * std::sqrt(1 - 4 / length_squared(eye));
  EXPECT_NEAR(length_of(found.silhouette), 2 * kPi * radius, 2e-3 * 2 * kPi * radius);
}

TEST(csg_edges, cylinder_and_cone_have_two_straight_outlines) {
  const Vec3d eye{5, 1, 2};
  for (const double top : {1.0, 0.0, 0.4}) {
    const CsgEdges edges(cells_of(one_leaf(CsgCone{0, 3, 1, top})), 0);
    const CsgEdges::Found found = edges.find(eye, 0);
    ASSERT_EQ(found.silhouette.size(), 2U) << top;
    for (const CsgEdges::Segment& s : found.silhouette) {
      const double h = 3, slope = (1 - top) / h;
      EXPECT_NEAR(std::abs(s.a.z - s.b.z), 3, 1e-5);
      for (const Vec3d p : {s.a, s.b}) {
        EXPECT_NEAR(std::hypot(p.x, p.y), 1 - slope * p.z, 1e-5);
        const Vec3d middle = (s.a + s.b) * 0.5;
        const Vec3d normal = normalize(Vec3d(middle.x, middle.y, 0)) + Vec3d(0, 0, slope);
        EXPECT_NEAR(dot(normal, eye - p), 0, 1e-5);
      }
    }
    EXPECT_NEAR(length_of(creases_of(edges)), 2 * kPi * (1 + top), 4e-3 * (1 + top)) << top;
  }
}

TEST(csg_edges, drilled_block_has_its_rims) {
  const CsgTree tree = flat_tree(CsgOperation::subtract, {leaf_of(CsgBox{Vec3d(-1), Vec3d(1)}),
                                                          leaf_of(CsgCone{-2, 2, 0.5, 0.5})});
  const CsgEdges edges(cells_of(tree), 0);
  EXPECT_NEAR(length_of(creases_of(edges)), 12 * 2 + 2 * 2 * kPi * 0.5, 0.01);
  for (const CreaseSegment& s : creases_of(edges)) {
    for (const Vec3d p : {s.a, s.b}) {
      const bool rim =
          std::abs(std::hypot(p.x, p.y) - 0.5) < 1e-6 && std::abs(std::abs(p.z) - 1) < 1e-6;
      int at_side = 0;
      for (int k = 0; k < 3; ++k) at_side += std::abs(std::abs(p[k]) - 1) < 1e-6 ? 1 : 0;
      EXPECT_TRUE(rim || at_side >= 2);
    }
  }
  // Its wall is concave: no outline.
  EXPECT_TRUE(edges.find({4, 3, 5}, 0).silhouette.empty());
}

// Two cylinders of radius 1 that cross at right angles have two ellipses in common, of half axes 1 and √2.
TEST(csg_edges, steinmetz_solid_has_two_ellipses) {
  const CsgTree tree = flat_tree(CsgOperation::intersect, {leaf_of(CsgCone{-2, 2, 1, 1}),
                                                           leaf_of(CsgCone{-2, 2, 1, 1}, kAlongX)});
  const CsgEdges edges(cells_of(tree), 0);
  const double around = std::comp_ellint_2(std::sqrt(0.5)) * 4 * std::sqrt(2.0);
  // By their crossings, up to a distance s, the cylinders meet at the angle s.
  EXPECT_NEAR(length_of(creases_of(edges)), 2 * around - 8 * kTangent, 0.003 * around);
  for (const CreaseSegment& s : creases_of(edges)) {
    EXPECT_NEAR(std::hypot(s.a.x, s.a.y), 1, 1e-4);
    EXPECT_NEAR(std::hypot(s.a.y, s.a.z), 1, 1e-4);
  }
}

TEST(csg_edges, tangent_surfaces_make_no_edge_unless_the_material_differs) {
  for (const std::uint32_t material : {0U, 1U}) {
    const CsgTree tree = flat_tree(
        CsgOperation::unite, {leaf_of(CsgCone{-2, 0, 1, 1}), leaf_of(CsgSphere{1}, {}, material)});
    const CsgEdges edges(cells_of(tree), 0);
    double rim = 0, border = 0;
    for (const CreaseSegment& c : creases_of(edges)) {
      (std::abs(c.a.z + 2) < 1e-6 ? rim : border) += length(c.b - c.a);
    }
    EXPECT_NEAR(rim, 2 * kPi, 0.01);
    // As border of the cylinder with its own end, and of that with the sphere.
    EXPECT_NEAR(border, material * 4 * kPi, 0.02);
  }
}

TEST(csg_edges, materials_part_a_plane) {
  for (const std::uint32_t material : {0U, 1U}) {
    const CsgTree tree =
        flat_tree(CsgOperation::unite, {leaf_of(CsgBox{{-1, 0, 0}, {0, 1, 1}}),
                                        leaf_of(CsgBox{{0, 0, 0}, {1, 1, 1}}, {}, material)});
    const CsgEdges edges(cells_of(tree), 0);
    // A box of 2 × 1 × 1, and the outline of the face between.
    double sum = 0;
    for (const CreaseSegment& s : creases_of(edges)) {
      if (std::abs(s.a.x) < 1e-6 && std::abs(s.b.x) < 1e-6) sum += length(s.b - s.a);
    }
    // Cells may meet in it, so that both find it.
    EXPECT_EQ(sum > 3.99, material == 1);
    EXPECT_NEAR(length_of(creases_of(edges)) - sum, 16, 1e-3);
  }
}

struct Shares {
  std::size_t jumps = 0, found = 0, close = 0;
  std::size_t seen = 0, real = 0;

  Shares& operator+=(const Shares& other) {
    jumps += other.jumps;
    found += other.found;
    close += other.close;
    seen += other.seen;
    real += other.real;
    return *this;
  }
};

// Of points of found edges that are seen, those across which something changes.
void count_real(CsgPicture& picture, std::span<const CsgPicture::Projected> edges,
                CsgRandom& random, Shares& shares) {
  for (const CsgPicture::Projected& e : edges) {
    const double dx = e.x1 - e.x0, dy = e.y1 - e.y0, size = std::hypot(dx, dy);
    if (size < 0.1) continue;
    const double t = uniform(random, 0.1, 0.9);
    const double x = e.x0 + dx * t, y = e.y0 + dy * t;
    if (std::max(std::abs(x), std::abs(y)) > picture.pixels() / 2.0) continue;
    const double z = 1 / (1 / e.z0 + (1 / e.z1 - 1 / e.z0) * t);
    const double off = 0.1, nx = -dy / size * off, ny = dx / size * off;
    const CsgSight a = picture.look(x + nx, y + ny), b = picture.look(x - nx, y - ny);
    const bool is_seen =
        (a.hit && std::abs(a.depth - z) < 0.02 * z) || (b.hit && std::abs(b.depth - z) < 0.02 * z);
    const bool is_hidden = (a.hit && a.depth < z * 0.98) || (b.hit && b.depth < z * 0.98);
    if (!is_seen || is_hidden) continue;
    ++shares.seen;
    shares.real += CsgPicture::differs(a, b, radians(1), 2e-3) ? 1 : 0;
  }
}

Shares measure(const CsgTree& tree, Vec3d eye, Vec3d target, double width, CsgRandom& random) {
  const CsgSolid solid(tree);
  const auto cells = cells_of(tree);
  Shares one;
  if (cells->cells().empty()) return one;
  const CsgEdges edges(cells, 0);
  CsgPicture picture(solid, eye, target, width, 64);
  CsgEdges::Found found = edges.find(eye, 0);
  found.sharp.insert(found.sharp.end(), found.silhouette.begin(), found.silhouette.end());
  const std::vector<CsgPicture::Projected> projected = picture.project(found.sharp);
  for (const CsgJump& jump : picture.find_jumps(radians(3))) {
    const double distance = CsgPicture::distance_to(projected, jump);
    ++one.jumps;
    one.found += distance < 1 ? 1 : 0;
    one.close += distance < 0.25 ? 1 : 0;
  }
  count_real(picture, projected, random, one);
  return one;
}

void expect_shares(const Shares& all) {
  EXPECT_GE(double(all.found), 0.999 * double(all.jumps)) << all.jumps;
  EXPECT_GE(double(all.close), 0.995 * double(all.jumps)) << all.jumps;
  // Some of what lies closely behind a surface counts as seen.
  EXPECT_GE(double(all.real), 0.9 * double(all.seen)) << all.seen;
  testing::Test::RecordProperty("jumps", int(all.jumps));
  testing::Test::RecordProperty("within_a_pixel", int(all.found));
  testing::Test::RecordProperty("within_a_quarter", int(all.close));
  testing::Test::RecordProperty("seen", int(all.seen));
  testing::Test::RecordProperty("real", int(all.real));
}

TEST(csg_edges, changes_of_every_kind_of_leaf_lie_on_edges) {
  CsgRandom random(11);
  for (int kind = 0; kind < kPrimitiveKinds - 1; ++kind) {
    Shares all;
    for (int i = 0; i < 6; ++i) {
      const CsgTree tree = one_leaf(random_primitive(random, kind), random_placement(random, 0.3));
      all += measure(tree, random_unit(random) * uniform(random, 4.0, 9.0), {}, 4, random);
    }
    EXPECT_GT(all.jumps, 200U) << kind;
    expect_shares(all);
  }
}

TEST(csg_edges, changes_seen_by_rays_lie_on_edges) {
  CsgRandom random(7);
  Shares all;
  for (int i = 0; i < 40; ++i) {
    const CsgTree tree = random_tree(random, 3);
    const Vec3d eye = random_unit(random) * uniform(random, 4.0, 9.0);
    const Shares one = measure(tree, eye, random_vector(random, 0.3), 5, random);
    all += one;
  }
  EXPECT_GT(all.jumps, 4000U);
  expect_shares(all);
}

// A single cell of it takes minutes.
TEST(csg_edges, looking_for_them_ends_soon_when_it_is_stopped) {
  const std::string text =
      "linear_extrude(height = 10, twist = 1e9, slices = 30000) { square(size = [1, 1]); }";
  const std::span bytes{reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
  const Scene scene = read_csg(bytes, "twist.csg", no_csg_files());
  const auto cells = cells_of(scene.csg_trees[0]);
  std::atomic<bool> stop = false;
  std::thread stopper([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    stop = true;
  });
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_THROW(CsgEdges(cells, 2, &stop), Error);
  stopper.join();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(15));
}

}  // namespace
}  // namespace arris::test
