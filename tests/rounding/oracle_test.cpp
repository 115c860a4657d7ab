// oracle_test.cpp — the rounding kernel against the definition: rays of every difficult kind at convex solids
// of every kind, meshed in every style
// A failure prints the rays; the seeds in their labels make the same solid, mesh and ray again.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "arris/rounding.h"
#include "support/convex_oracle.h"
#include "support/convex_solids.h"
#include "support/rounded_ray.h"
#include "support/rounding_judge.h"

namespace arris::oracle {
namespace {

constexpr double kEveryEdge = radians(0.01);  // min_angle that rounds every edge of the solids here

Rounding round_every_edge(const SolidMesh& mesh, double radius,
                          Detection detection = Detection::face_index) {
  RoundingOptions options;
  options.radius = radius;
  options.min_angle = kEveryEdge;
  options.detection = detection;
  return make_rounding(mesh.view(), options, mesh.name);
}

// Share of the inradius: the ends of the promised range, and everything between.
double random_share(Random& rng) {
  const int pick = uniform_int(rng, 0, 9);
  if (pick == 0) return 0.01;
  if (pick == 1) return 0.95;
  return pick < 6 ? std::pow(10, uniform(rng, -2, -0.3)) : uniform(rng, 0.05, 0.95);
}

struct Campaign {
  std::uint64_t first_seed = 1;
  int seeds = 8;
  int rays = 120;  // of each kind at each solid
  std::vector<RayKind> kinds;
  Detection detection = Detection::face_index;
  Start start = Start::unknown;
};

// Every kind of solid, in the style that `restyle` makes of a random one, with a random radius.
template <class Restyle>
Tally run(const Campaign& campaign, Restyle restyle) {
  Tally tally;
  for (int s = 0; s < campaign.seeds; ++s) {
    const std::uint64_t seed = campaign.first_seed + std::uint64_t(s);
    Random rng(seed);
    for (const Polyhedron& polyhedron : make_solids(seed)) {
      MeshStyle style = random_style(rng);
      restyle(style);
      const SolidMesh mesh = make_mesh(polyhedron, style, seed);
      const double largest = inradius(mesh.solid);
      // A radius must be large against the rounding error of the positions.
      const double share = std::max(random_share(rng), 300 * mesh.quantum / largest);
      if (share > 0.95) continue;
      const double radius = share * largest;
      const Opening opening(mesh.solid, radius);
      const std::string label =
          fmt::format("{} solid seed {} share {:.4f}", mesh.name, seed, share);
      try {
        const Rounding rounding = round_every_edge(mesh, radius, campaign.detection);
        for (RayKind kind : campaign.kinds)
          tally.add(judge_rays(mesh, opening, rounding,
                               {kind, campaign.rays, seed, label, campaign.start}));
      } catch (const std::exception& e) {
        ADD_FAILURE() << label << ": " << e.what();
      }
    }
  }
  return tally;
}

// `one_in`: at most one wrong ray in that many, all of them explained.
void expect_exact(const Tally& tally, std::uint64_t one_in = 1000) {
  EXPECT_EQ(tally.unexplained, 0U) << tally.text();
  EXPECT_LE(tally.wrong * one_in, tally.rays);
  EXPECT_GT(tally.rounded * 20, tally.hits)
      << "the rays hardly met a rounded edge: " << tally.text();
}

const std::vector<RayKind> kFromOutside{RayKind::outside, RayKind::at_edge, RayKind::at_corner,
                                        RayKind::along_edge};
const std::vector<RayKind> kFromInside{RayKind::inside, RayKind::inside_at_edge};
const std::vector<RayKind> kAll{RayKind::outside,    RayKind::at_edge, RayKind::at_corner,
                                RayKind::along_edge, RayKind::inside,  RayKind::inside_at_edge};

TEST(RoundingExactness, rays_from_outside) {
  expect_exact(run({.first_seed = 100, .kinds = kFromOutside}, [](MeshStyle&) {}));
}

TEST(RoundingExactness, rays_from_inside) {
  expect_exact(run({.first_seed = 200, .kinds = kFromInside}, [](MeshStyle&) {}));
}

// Secondary rays leave a rounded edge through the void between it and the sharp edge.
TEST(RoundingExactness, rays_from_the_void_between_sharp_and_rounded_edge) {
  expect_exact(run({.first_seed = 300, .kinds = {RayKind::from_void}}, [](MeshStyle&) {}));
}

// A host that knows where its rays start says so and spares the kernel the question.
TEST(RoundingExactness, rays_of_known_start) {
  std::vector<RayKind> kinds = kAll;
  kinds.push_back(RayKind::from_void);
  expect_exact(run({.first_seed = 350, .kinds = kinds, .start = Start::told}, [](MeshStyle&) {}));
}

TEST(RoundingExactness, contains_the_points_of_the_opening) {
  for (std::uint64_t seed = 360; seed < 364; ++seed) {
    for (const Polyhedron& polyhedron : make_solids(seed)) {
      Random rng(seed);
      const SolidMesh mesh = make_mesh(polyhedron, random_style(rng), seed);
      const double radius = random_share(rng) * inradius(mesh.solid);
      const Opening opening(mesh.solid, radius);
      const Rounding rounding = round_every_edge(mesh, radius);
      RaySource source(mesh, opening, seed);
      for (int i = 0; i < 300; ++i) {
        const RayKind kind = i % 3 == 0   ? RayKind::from_void
                             : i % 3 == 1 ? RayKind::inside
                                          : RayKind::outside;
        const Vec3d point = source.make(kind).origin;
        if (std::abs(opening.distance(point)) < 1e-6 * mesh.solid.size) continue;
        ASSERT_EQ(rounding.contains(0, point), opening.contains(point))
            << mesh.name << " seed " << seed << " " << i;
      }
    }
  }
}

// So flat along an edge that the float positions decide much of t: nothing may be off the surface.
TEST(RoundingExactness, rays_grazing_along_edges_never_leave_the_surface) {
  const Tally tally = run({.first_seed = 400, .kinds = {RayKind::grazing}}, [](MeshStyle&) {});
  EXPECT_EQ(tally.unexplained, 0U) << tally.text();
  EXPECT_LE(tally.wrong * 20, tally.rays) << tally.text();
}

TEST(RoundingExactness, edges_split_in_collinear_pieces) {
  expect_exact(run({.first_seed = 500, .seeds = 6, .kinds = kAll},
                   [](MeshStyle& s) { s.split = EdgeSplit::shared; }));
}

// At 100 sizes from the origin float positions are good to 6e-6 of the size only: more tangents than usual.
TEST(RoundingExactness, far_from_the_origin) {
  expect_exact(
      run({.first_seed = 700, .seeds = 6, .kinds = kAll}, [](MeshStyle& s) { s.offset = 100; }),
      300);
}

TEST(RoundingExactness, scales_from_a_thousandth_to_a_thousand) {
  for (double scale : {1e-3, 1e3})
    expect_exact(run({.first_seed = 800, .seeds = 3, .kinds = kAll},
                     [&](MeshStyle& s) { s.scale = scale; }));
}

TEST(RoundingExactness, with_the_kd_tree) {
  std::vector<RayKind> kinds = kAll;
  kinds.push_back(RayKind::from_void);
  expect_exact(run({.first_seed = 900, .seeds = 4, .kinds = kinds, .detection = Detection::kd_tree},
                   [](MeshStyle&) {}));
}

TEST(RoundingExactness, unevenly_scaled_mirrored_and_sheared_solids) {
  Tally tally;
  Random rng(1000);
  for (Polyhedron polyhedron : make_solids(1000)) {
    Mat3d map = random_rotation(rng) * Mat3d{{1, 0, 0}, {0.3, 0.5, 0}, {-0.2, 0.4, -2}};
    for (Vec3d& v : polyhedron.vertices) v = map * v;
    for (auto& face : polyhedron.faces) std::reverse(face.begin(), face.end());  // the map mirrors
    const SolidMesh mesh = make_mesh(polyhedron, random_style(rng), 1000);
    const double radius = random_share(rng) * inradius(mesh.solid);
    const Opening opening(mesh.solid, radius);
    const Rounding rounding = round_every_edge(mesh, radius);
    for (RayKind kind : kAll)
      tally.add(judge_rays(mesh, opening, rounding, {kind, 60, 1, mesh.name + " sheared"}));
  }
  expect_exact(tally);
}

// A room is a solid of air; its mesh may face either way.
TEST(RoundingExactness, triangles_facing_inwards) {
  expect_exact(
      run({.first_seed = 1100, .seeds = 3, .kinds = kAll}, [](MeshStyle& s) { s.inward = true; }));
}

}  // namespace
}  // namespace arris::oracle
