// known_failures_test.cpp — where other implementations of rounded edges are known to fail, and what the
// kernel promises besides exactness: errors, counts, min_angle, solids that touch, no holes
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "arris/error.h"
#include "arris/rounding.h"
#include "support/convex_oracle.h"
#include "support/convex_solids.h"
#include "support/rounded_ray.h"
#include "support/rounding_judge.h"

namespace arris::oracle {
namespace {

const std::vector<RayKind> kAll{RayKind::outside,    RayKind::at_edge, RayKind::at_corner,
                                RayKind::along_edge, RayKind::inside,  RayKind::inside_at_edge};

Rounding make_rounded(const SolidMesh& mesh, double radius, double min_angle = radians(30)) {
  RoundingOptions options;
  options.radius = radius;
  options.min_angle = min_angle;
  return make_rounding(mesh.view(), options, mesh.name);
}

Tally judge_everything(const SolidMesh& mesh, double radius, int rays,
                       double min_angle = radians(1)) {
  const Opening opening(mesh.solid, radius);
  const Rounding rounding = make_rounded(mesh, radius, min_angle);
  Tally tally;
  for (RayKind kind : kAll)
    tally.add(judge_rays(mesh, opening, rounding, {kind, rays, 1, mesh.name}));
  return tally;
}

void expect_exact(const Tally& tally) {
  EXPECT_EQ(tally.unexplained, 0U) << tally.text();
  EXPECT_LE(tally.wrong * 1000, tally.rays) << tally.text();
}

std::optional<RoundedHit> trace_one(const SolidMesh& mesh, const Rounding& rounding,
                                    const Ray& ray) {
  return trace(ray, RoundedMesh{mesh.view(), &rounding});
}

TEST(KnownFailures, cube_edges_split_in_two_collinear_pieces) {
  MeshStyle style;
  style.split = EdgeSplit::shared;
  for (std::uint64_t seed = 1; seed <= 3; ++seed)
    expect_exact(judge_everything(make_mesh(cube(), style, seed), 0.1, 666));
}

TEST(KnownFailures, unit_cube_with_tiny_radius) {
  expect_exact(judge_everything(make_mesh(cube(), {}, 1), 0.002, 500));
}

TEST(KnownFailures, tiny_cube) {
  MeshStyle style;
  style.scale = 0.05;
  expect_exact(judge_everything(make_mesh(cube(), style, 1), 0.005, 500));
  style.scale = 1e-4;
  expect_exact(judge_everything(make_mesh(cube(), style, 1), 1e-5, 500));
}

TEST(KnownFailures, ray_from_inside_leaves_at_the_far_root) {
  const SolidMesh mesh = make_mesh(cube(), {}, 1);
  const double r = 0.1;
  const Rounding rounding = make_rounded(mesh, r);
  const Vec3d direction = normalize(Vec3d(1, 1, 0));
  const auto hit = trace_one(mesh, rounding, {{0, 0, 0.1}, direction});
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->t, 0.4 * std::sqrt(2) + r, 1e-6);
  EXPECT_LT(angle_deg(hit->normal, direction), 0.01);
  EXPECT_EQ(hit->feature, Feature::edge);
}

TEST(KnownFailures, regular_four_edge_apex_is_one_sphere) {
  const SolidMesh mesh = make_mesh(pyramid(4, 1), {}, 1);
  const Rounding rounding = make_rounded(mesh, 0.1);
  EXPECT_EQ(rounding.report().rounded_corners, 5U);
  EXPECT_EQ(rounding.report().rounded_edges, 8U);
  expect_exact(judge_everything(mesh, 0.1, 500));
  const auto apex = trace_one(mesh, rounding, {{1e-4, 2e-4, 5}, {0, 0, -1}});
  ASSERT_TRUE(apex);
  EXPECT_EQ(apex->feature, Feature::corner);
}

TEST(KnownFailures, crooked_apex_is_exact) {
  Random rng(3);
  for (int sides = 4; sides <= 7; ++sides) {
    const SolidMesh mesh = make_mesh(crooked_pyramid(rng, sides), {}, 1);
    const double largest = inradius(mesh.solid);
    for (double share : {0.02, 0.2, 0.6, 0.95})
      expect_exact(judge_everything(mesh, share * largest, 200));
  }
}

// --- touching solids -----------------------------------------------------------------------------

struct TwoCubes {
  SolidMesh left, right;
  Opening left_opening, right_opening;
  Rounding left_rounding, right_rounding;
};

TwoCubes make_touching_cubes(double radius) {
  MeshStyle plain;
  SolidMesh left = make_mesh(cube(), plain, 1), right = left;
  for (Vec3f& p : right.positions) p.x += 1;
  right.solid.center.x += 1;
  for (Vec3d& c : right.corners) c.x += 1;
  Opening left_opening(left.solid, radius), right_opening(right.solid, radius);
  Rounding a = make_rounded(left, radius), b = make_rounded(right, radius);
  return {std::move(left),          std::move(right), std::move(left_opening),
          std::move(right_opening), std::move(a),     std::move(b)};
}

TEST(TouchingSolids, rays_along_the_groove_see_both) {
  const double r = 0.1;
  const TwoCubes cubes = make_touching_cubes(r);
  const std::vector<RoundedMesh> objects{{cubes.left.view(), &cubes.left_rounding},
                                         {cubes.right.view(), &cubes.right_rounding}};
  Random rng(21);
  int rays = 0, wrong = 0, grooves = 0;
  for (int i = 0; i < 20000; ++i) {
    // A target in the groove above the shared face, seen from above, across, and nearly along it.
    const Vec3d target{0.5 + uniform(rng, -r, r), uniform(rng, -0.45, 0.45),
                       0.5 - uniform(rng, 0, r)};
    Vec3d from = random_direction(rng);
    from.z = std::abs(from.z) + 0.05;
    from.x *= i % 2 == 0 ? 0.05 : 1;
    const Ray ray{target + normalize(from) * 4.0, -normalize(from)};
    auto expected = cubes.left_opening.intersect(ray);
    const auto other = cubes.right_opening.intersect(ray);
    if (other && (!expected || other->t < expected->t)) expected = other;
    const auto got = trace(ray, objects);
    ++rays;
    if (got && got->feature == Feature::edge) ++grooves;
    const bool right = expected ? got && std::abs(got->t - expected->t) < 1e-5 &&
                                      angle_deg(got->normal, expected->normal) < 0.2
                                : !got;
    if (!right) ++wrong;
  }
  EXPECT_LE(wrong * 1000, rays) << wrong << " of " << rays;
  EXPECT_GT(grooves, rays / 2);
}

TEST(TouchingSolids, ray_straight_down_the_groove_ends_at_the_ground_of_it) {
  const TwoCubes cubes = make_touching_cubes(0.1);
  const std::vector<RoundedMesh> objects{{cubes.left.view(), &cubes.left_rounding},
                                         {cubes.right.view(), &cubes.right_rounding}};
  // Just beside the shared face: the cylinder of the left cube, nearly vertical there.
  const double x = 0.5 - 1e-3;
  const auto hit = trace({{x, 0.1, 3}, {0, 0, -1}}, objects);
  ASSERT_TRUE(hit);
  const double depth = 0.4 + std::sqrt(0.1 * 0.1 - (x - 0.4) * (x - 0.4));
  EXPECT_NEAR(hit->t, 3 - depth, 1e-5);
  EXPECT_GT(hit->normal.x, 0.9);
}

// --- errors and counts ---------------------------------------------------------------------------

std::string error_of(const SolidMesh& mesh, double radius, const std::string& name) {
  RoundingOptions options;
  options.radius = radius;
  try {
    make_rounding(mesh.view(), options, name);
  } catch (const Error& e) {
    EXPECT_EQ(e.kind(), Error::Kind::input);
    return e.what();
  }
  return "";
}

TEST(RoundingErrors, radius_not_smaller_than_the_inradius_names_object_value_and_limit) {
  const SolidMesh mesh = make_mesh(box({2, 1, 0.5}), {}, 1);
  for (double radius : {0.25, 0.3, 10.0}) {
    const std::string message = error_of(mesh, radius, "plinth");
    EXPECT_NE(message.find("plinth"), std::string::npos) << message;
    EXPECT_NE(message.find(fmt::format("{:g}", radius)), std::string::npos) << message;
    EXPECT_NE(message.find("0.25"), std::string::npos) << message;
  }
  EXPECT_EQ(error_of(mesh, 0.249, "plinth"), "");
}

TEST(RoundingErrors, radius_must_be_positive_and_finite) {
  const SolidMesh mesh = make_mesh(cube(), {}, 1);
  for (double radius : {0.0, -0.1, std::nan(""), HUGE_VAL})
    EXPECT_NE(error_of(mesh, radius, "die").find("die"), std::string::npos) << radius;
}

TEST(RoundingReportCounts, cube_has_twelve_edges_and_eight_corners_in_every_style) {
  Random rng(31);
  for (int i = 0; i < 40; ++i) {
    MeshStyle style = random_style(rng);
    style.split = i % 2 == 0 ? EdgeSplit::shared : EdgeSplit::none;
    const SolidMesh mesh = make_mesh(cube(), style, std::uint64_t(i));
    const RoundingReport report = make_rounded(mesh, 0.1 * mesh.solid.size / 2).report();
    EXPECT_EQ(report.rounded_edges, 12U) << i;
    EXPECT_EQ(report.rounded_corners, 8U) << i;
    EXPECT_EQ(report.solids, 1U) << i;
    EXPECT_EQ(report.convex_solids, 1U) << i;
    EXPECT_EQ(report.exact_solids, 1U) << i;
    EXPECT_EQ(report.open_solids, 0U) << i;
    EXPECT_EQ(report.smooth_edges + report.concave_edges + report.boundary_edges +
                  report.nonmanifold_edges,
              0U)
        << i;
    EXPECT_GT(report.bytes, 0U);
    EXPECT_LE(report.bytes, 250U * 12U + 2048U) << "memory per edge";
  }
}

TEST(RoundingReportCounts, regular_solids) {
  const auto report = [](const Polyhedron& p) {
    return make_rounded(make_mesh(p, {}, 1), 0.1, radians(1)).report();
  };
  const auto expect = [](const RoundingReport& r, std::uint64_t edges, std::uint64_t corners) {
    EXPECT_EQ(r.rounded_edges, edges);
    EXPECT_EQ(r.rounded_corners, corners);
    EXPECT_EQ(r.exact_solids, 1U);
  };
  expect(report(tetrahedron()), 6, 4);
  expect(report(octahedron()), 12, 6);
  expect(report(icosahedron()), 30, 12);
  expect(report(dodecahedron()), 30, 20);
  expect(report(prism(6, 1)), 18, 12);
}

TEST(RoundingReportCounts, two_separate_cubes_in_one_mesh_are_two_solids) {
  SolidMesh mesh = make_mesh(cube(), {}, 1);
  const auto count = std::uint32_t(mesh.positions.size());
  for (std::uint32_t i = 0; i < count; ++i)
    mesh.positions.push_back(mesh.positions[i] + Vec3f(3, 0, 0));
  const std::vector<Triangle> first = mesh.triangles;
  for (Triangle t : first) mesh.triangles.push_back({t[0] + count, t[1] + count, t[2] + count});
  const Rounding rounding = make_rounded(mesh, 0.1);
  EXPECT_EQ(rounding.report().solids, 2U);
  EXPECT_EQ(rounding.report().rounded_edges, 24U);
  EXPECT_NE(rounding.solid_of(0), rounding.solid_of(std::uint32_t(first.size())));
}

TEST(RoundingReportCounts, open_box_is_reported_and_its_rim_stays_sharp) {
  SolidMesh mesh = make_mesh(cube(), {}, 1);
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return mesh.positions[t[0]].z < 0 && mesh.positions[t[1]].z < 0 && mesh.positions[t[2]].z < 0;
  });
  ASSERT_EQ(mesh.triangles.size(), 10U);
  const Rounding rounding = make_rounded(mesh, 0.1);
  EXPECT_EQ(rounding.report().open_solids, 1U);
  EXPECT_EQ(rounding.report().exact_solids, 0U);
  EXPECT_EQ(rounding.report().boundary_edges, 4U);
  EXPECT_FALSE(rounding.report().notes.empty());
}

TEST(RoundingReportCounts, convex_edges_that_are_not_to_be_rounded_are_noted) {
  const SolidMesh mesh = make_mesh(cube(), {}, 1);
  RoundingOptions options;
  options.radius = 0.1;
  options.edges = RoundEdges::concave;
  const Rounding rounding = make_rounding(mesh.view(), options, mesh.name);
  EXPECT_EQ(rounding.report().rounded_edges, 0U);
  ASSERT_EQ(rounding.report().notes.size(), 1U);
  EXPECT_EQ(rounding.report().notes[0].text(),
            "12 convex edges stay sharp: only concave edges are to be rounded");
}

// A T-junction is healed, or the solid is reported as open; it never gets a hole.
TEST(RoundingReportCounts, t_junctions_are_healed_or_reported) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    MeshStyle style;
    style.split = EdgeSplit::t_junction;
    const SolidMesh mesh = make_mesh(seed % 2 == 0 ? cube() : dodecahedron(), style, seed);
    const double radius = 0.2 * inradius(mesh.solid);
    const Opening opening(mesh.solid, radius);
    const Rounding rounding = make_rounded(mesh, radius);
    if (rounding.report().exact_solids == 0) {
      EXPECT_GT(rounding.report().open_solids, 0U);
      EXPECT_FALSE(rounding.report().notes.empty());
    }
    RaySource source(mesh, opening, seed);
    int wrong = 0;
    for (int i = 0; i < 500; ++i) {
      const Ray ray = source.make(RayKind::outside);
      const auto expected = opening.intersect(ray);
      const auto got = trace_one(mesh, rounding, ray);
      if (expected && (!got || (got->t - expected->t) * length(ray.direction) > 1e-5)) ++wrong;
    }
    EXPECT_EQ(wrong, 0) << seed;
  }
}

// --- min_angle -----------------------------------------------------------------------------------

TEST(MinAngle, edges_that_turn_less_stay_as_they_are) {
  const SolidMesh mesh = make_mesh(prism(16, 1), {}, 1);  // 22.5 degrees between the sides
  const Rounding rounding = make_rounded(mesh, 0.1);
  EXPECT_EQ(rounding.report().smooth_edges, 16U);
  EXPECT_EQ(rounding.report().rounded_edges, 32U);
  // At a side edge, half way up: the sharp surface.
  for (int i = 0; i < 16; ++i) {
    const double a = 2 * kPi * i / 16 + 1e-3;
    const Vec3d out{std::cos(a), std::sin(a), 0};
    const auto hit = trace_one(mesh, rounding, {out * 3.0, -out});
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->t, 3 - std::cos(kPi / 16) / std::cos(kPi / 16 - 1e-3), 1e-5);
  }
  // At the rim: rounded.
  const Vec3d out = normalize(Vec3d(std::cos(kPi / 16), std::sin(kPi / 16), 1));
  const Vec3d rim{std::cos(kPi / 16) * std::cos(kPi / 16), std::sin(kPi / 16) * std::cos(kPi / 16),
                  0.5};
  const auto hit = trace_one(mesh, rounding, {rim + out * 3.0, -out});
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->t, 3 + 0.1 * (std::sqrt(2) - 1), 1e-4);
  EXPECT_EQ(hit->feature, Feature::edge);
}

TEST(MinAngle, is_the_smallest_turn_that_is_rounded) {
  const SolidMesh mesh = make_mesh(prism(12, 1), {}, 1);  // 30 degrees between the sides
  EXPECT_EQ(make_rounded(mesh, 0.1, radians(29.9)).report().rounded_edges, 36U);
  EXPECT_EQ(make_rounded(mesh, 0.1, radians(30.1)).report().rounded_edges, 24U);
  EXPECT_EQ(make_rounded(mesh, 0.1, radians(89.9)).report().rounded_edges, 24U);
  EXPECT_EQ(make_rounded(mesh, 0.1, radians(90.1)).report().rounded_edges, 0U);
}

// --- no holes ------------------------------------------------------------------------------------

// Whatever is left sharp, the rounded solid lies between opening(P) and P: no ray may pass through what both
// share, nor be stopped outside of P.
TEST(NoHoles, partly_smooth_solid_lies_between_its_opening_and_itself) {
  for (int sides : {13, 16, 24, 48}) {
    for (double share : {0.05, 0.3, 0.9}) {
      const SolidMesh mesh = make_mesh(prism(sides, 0.8), {}, 1);
      const double radius = share * inradius(mesh.solid);
      const Opening opening(mesh.solid, radius);
      const Rounding rounding = make_rounded(mesh, radius);
      RaySource source(mesh, opening, std::uint64_t(sides));
      int wrong = 0;
      std::string example;
      for (int i = 0; i < 4000; ++i) {
        const RayKind kind = kAll[std::size_t(i) % 4];
        const Ray ray = source.make(kind);
        const auto sharp = intersect_mesh(ray, mesh.view());
        const auto opened = opening.intersect(ray);
        const auto got = trace_one(mesh, rounding, ray);
        const double slack = 1e-5 * mesh.solid.size / length(ray.direction);
        const bool too_late = opened && (!got || got->t > opened->t + slack);
        const bool too_soon = got && (sharp.empty() || got->t < sharp.front().t - slack);
        if ((too_late || too_soon) &&
            std::abs(opening.least_distance(ray)) > 1e-5 * mesh.solid.size) {
          ++wrong;
          example = fmt::format("{} ray {}: sharp {} opened {} got {} (-1: nothing)", name_of(kind),
                                i, sharp.empty() ? -1 : sharp.front().t, opened ? opened->t : -1,
                                got ? got->t : -1);
        }
      }
      EXPECT_EQ(wrong, 0) << sides << " sides, share " << share << "; " << example;
    }
  }
}

// An L: opening it keeps at least the openings of its two arms.
TEST(NoHoles, solid_with_a_concave_edge_keeps_the_openings_of_its_parts) {
  const std::vector<Vec3d> outline{{0, 0, 0}, {2, 0, 0}, {2, 1, 0},
                                   {1, 1, 0}, {1, 2, 0}, {0, 2, 0}};
  Polyhedron l{"L", outline, {{5, 4, 3, 0}, {3, 2, 1, 0}, {6, 9, 10, 11}, {6, 7, 8, 9}}};
  for (Vec3d p : outline) l.vertices.push_back(p + Vec3d(0, 0, 1));
  for (std::uint32_t i = 0; i < 6; ++i) l.faces.push_back({i, (i + 1) % 6, (i + 1) % 6 + 6, i + 6});
  const SolidMesh mesh = make_mesh(l, {}, 1);
  const auto arm = [](Vec3d size, Vec3d middle) {
    SolidMesh part = make_mesh(box(size), {}, 1);
    part.solid.center += middle;
    return part;
  };
  const double radius = 0.15;
  const Opening along_x(arm({2, 1, 1}, {1, 0.5, 0.5}).solid, radius),
      along_y(arm({1, 2, 1}, {0.5, 1, 0.5}).solid, radius);
  const Rounding rounding = make_rounded(mesh, radius);
  EXPECT_EQ(rounding.report().exact_solids, 1U);
  EXPECT_EQ(rounding.report().concave_edges, 1U);
  EXPECT_FALSE(rounding.report().notes.empty());
  Random rng(41);
  int wrong = 0, moved = 0;
  std::string example;
  for (int i = 0; i < 20000; ++i) {
    const Vec3d target =
        Vec3d(uniform(rng, -0.2, 2.2), uniform(rng, -0.2, 2.2), uniform(rng, -0.1, 1.1));
    const Vec3d from = random_direction(rng);
    const Ray ray{target + from * 6.0, -from};
    const auto sharp = intersect_mesh(ray, mesh.view());
    const auto a = along_x.intersect(ray), b = along_y.intersect(ray);
    const double opened = std::min(a ? a->t : kInfinity, b ? b->t : kInfinity);
    const auto got = trace_one(mesh, rounding, ray);
    if (got && got->feature != Feature::face) ++moved;
    const bool too_late = opened < kInfinity && (!got || got->t > opened + 1e-5);
    const bool too_soon = got && (sharp.empty() || got->t < sharp.front().t - 1e-5);
    if (!too_late && !too_soon) continue;
    ++wrong;
    example = fmt::format(
        "ray {} target ({:.4f}, {:.4f}, {:.4f}): sharp {} opened {} got {} (-1: nothing)", i,
        target.x, target.y, target.z, sharp.empty() ? -1 : sharp.front().t, opened,
        got ? got->t : -1);
  }
  EXPECT_EQ(wrong, 0) << example;
  EXPECT_GT(moved, 500);
}

}  // namespace
}  // namespace arris::oracle
