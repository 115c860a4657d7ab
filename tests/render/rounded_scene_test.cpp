// rounded_scene_test.cpp — the renderer's rays among rounded solids against the definition: solids that touch,
// overlap and stand in one another, and instances of every kind
// A wrong ray is explained if one that differs by the rounding of floats would have been right (tangents, and
// places where two surfaces are equally near); none may be unexplained, and few may be wrong at all.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "render/prepared_scene.h"
#include "render/scene_geometry.h"
#include "support/convex_oracle.h"
#include "support/convex_solids.h"
#include "support/rounding_judge.h"

namespace arris::oracle {
namespace {

constexpr double kEveryEdge = radians(0.01);  // min_angle that rounds every edge of the solids here

Affine3d moved(Vec3d by) {
  return {{}, by};
}

Mat3d scaling(double s) {
  return {{s, 0, 0}, {0, s, 0}, {0, 0, s}};
}

Polyhedron transformed(Polyhedron polyhedron, const Affine3d& m) {
  for (Vec3d& v : polyhedron.vertices) v = transform_point(m, v);
  if (determinant(m.linear) < 0) {
    for (auto& face : polyhedron.faces) std::reverse(face.begin(), face.end());
  }
  return polyhedron;
}

Mesh mesh_of(const SolidMesh& solid) {
  Mesh mesh;
  mesh.name = solid.name;
  mesh.positions = solid.positions;
  mesh.triangles = solid.triangles;
  return mesh;
}

void append(Mesh& mesh, const SolidMesh& solid) {
  const auto first = std::uint32_t(mesh.positions.size());
  mesh.positions.insert(mesh.positions.end(), solid.positions.begin(), solid.positions.end());
  for (const Triangle& t : solid.triangles) {
    mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
}

RoundingSettings rounded_by(double radius) {
  RoundingSettings settings;
  settings.method = RoundMethod::exact;
  settings.radius = radius;
  settings.min_angle = kEveryEdge;
  return settings;
}

// The described scene and the solids it stands for, in world space.
class World {
 public:
  World() {
    scene_.camera = Camera{.position = {9, 9, 9}, .target = {}};
    scene_.environment = ConstantEnvironment{};
    scene_.materials.emplace_back();
  }

  // An object of its own.
  void add(const Polyhedron& polyhedron, double radius) {
    SolidMesh solid = make_mesh(polyhedron, {}, 1);
    scene_.meshes.push_back(mesh_of(solid));
    add_object(radius, {});
    add_solid(std::move(solid), radius);
  }

  // All in one mesh.
  void add_together(const std::vector<Polyhedron>& polyhedra, double radius) {
    Mesh mesh;
    for (const Polyhedron& polyhedron : polyhedra) {
      SolidMesh solid = make_mesh(polyhedron, {}, 1);
      append(mesh, solid);
      add_solid(std::move(solid), radius);
    }
    scene_.meshes.push_back(std::move(mesh));
    add_object(radius, {});
  }

  // Objects that share one mesh.
  void add_instances(const Polyhedron& polyhedron, const std::vector<Affine3d>& places,
                     double radius) {
    scene_.meshes.push_back(mesh_of(make_mesh(polyhedron, {}, 1)));
    for (const Affine3d& place : places) {
      add_object(radius, place);
      add_solid(make_mesh(transformed(polyhedron, place), {}, 1), radius);
    }
  }

  [[nodiscard]] PreparedScene prepare(std::uint64_t max_copied_triangles) const {
    auto geometry = std::make_shared<const SceneGeometry>(
        scene_, EmbreeSceneOptions{.max_copied_triangles = max_copied_triangles});
    SceneRounding rounding = make_scene_rounding(*geometry, std::nullopt, {});
    return {std::move(geometry), std::move(rounding)};
  }

  [[nodiscard]] const std::vector<SolidMesh>& solids() const { return solids_; }
  [[nodiscard]] const std::vector<Opening>& openings() const { return openings_; }

 private:
  void add_object(double radius, const Affine3d& place) {
    Object object;
    object.name = fmt::format("object {}", scene_.objects.size());
    object.mesh.index = std::uint32_t(scene_.meshes.size() - 1);
    object.world_from_object = place;
    object.rounding = rounded_by(radius);
    scene_.objects.push_back(object);
  }
  void add_solid(SolidMesh solid, double radius) {
    openings_.emplace_back(solid.solid, radius);
    solids_.push_back(std::move(solid));
  }

  Scene scene_;
  std::vector<SolidMesh> solids_;
  std::vector<Opening> openings_;
};

TraceRay float_ray(const Ray& ray) {
  TraceRay traced;
  traced.origin = Vec3f(ray.origin);
  traced.direction = Vec3f(normalize(ray.direction));
  return traced;
}

// What the oracle says of a ray and one solid.
struct Crossing {
  double t = 0;
  Vec3d normal;
  std::size_t solid = 0;
};

struct Counts {
  int rays = 0, hits = 0, rounded = 0, wrong = 0, unexplained = 0;
  std::string lines;
};

class SceneJudge {
 public:
  SceneJudge(const World& world, const PreparedScene& scene) : world_(world), scene_(scene) {
    for (const SolidMesh& solid : world.solids()) {
      for (const Vec3d corner : solid.corners) reach_ = std::max(reach_, length(corner));
    }
  }

  [[nodiscard]] double reach() const { return reach_; }

  void judge(const TraceRay& traced, const std::string& label, Counts& counts,
             std::optional<std::size_t> without = {}) const {
    const Ray ray{Vec3d(traced.origin), Vec3d(traced.direction)};
    const std::optional<SurfaceHit> got = scene_.intersect(traced);
    const std::vector<Crossing> expected = intersect(ray, without);
    ++counts.rays;
    counts.hits += expected.empty() ? 0 : 1;
    counts.rounded += got && got->feature != Feature::face ? 1 : 0;
    const bool right = agree(got, expected) && scene_.occluded(traced) == !expected.empty();
    if (right) return;
    ++counts.wrong;
    if (is_explained(ray, got, scene_.occluded(traced), expected, without)) return;
    if (++counts.unexplained <= 5) counts.lines += describe(ray, got, expected, label);
  }

 private:
  // Of every solid that the ray meets, nearest first: those beside the nearest are as good.
  [[nodiscard]] std::vector<Crossing> intersect(const Ray& ray,
                                                std::optional<std::size_t> without) const {
    std::vector<Crossing> crossings;
    for (std::size_t i = 0; i < world_.openings().size(); ++i) {
      if (i == without) continue;
      const auto hit = world_.openings()[i].intersect(ray);
      if (hit) crossings.push_back({hit->t, hit->normal, i});
    }
    std::ranges::sort(crossings, {}, &Crossing::t);
    return crossings;
  }

  // 1e-5 of the size of the solid that was met.
  [[nodiscard]] double t_tolerance(const Crossing& crossing) const {
    return 1e-5 * world_.solids()[crossing.solid].solid.size;
  }

  [[nodiscard]] bool agree(const std::optional<SurfaceHit>& got,
                           const std::vector<Crossing>& expected) const {
    if (!got || expected.empty()) return !got && expected.empty();
    return std::ranges::any_of(expected, [&](const Crossing& crossing) {
      const double tolerance = t_tolerance(crossing);
      return crossing.t <= expected[0].t + tolerance &&
             std::abs(double(got->t) - crossing.t) <= tolerance &&
             angle_deg(Vec3d(got->geometric_normal), crossing.normal) <= 0.2;
    });
  }

  // Floats are good to 6e-8; a ray goes through some ten roundings on its way into a solid's space and to a hit.
  [[nodiscard]] double rounding_error(const Ray& ray) const {
    return 1e-6 * (reach_ + length(ray.origin));
  }

  [[nodiscard]] bool is_explained(const Ray& ray, const std::optional<SurfaceHit>& got,
                                  bool occluded, const std::vector<Crossing>& expected,
                                  std::optional<std::size_t> without) const {
    bool hit_explained = agree(got, expected) || (got && slides(ray, *got, expected));
    bool shadow_explained = occluded == !expected.empty();
    Random rng(1);
    const double error = rounding_error(ray);
    for (int i = 0; i < 200 && !(hit_explained && shadow_explained); ++i) {
      const Ray near{ray.origin + random_direction(rng) * (error * uniform(rng, 0, 1)),
                     ray.direction + random_direction(rng) * uniform(rng, 0, 1e-6)};
      const auto others = intersect(near, without);
      hit_explained = hit_explained || agree(got, others);
      shadow_explained = shadow_explained || occluded == !others.empty();
    }
    return hit_explained && shadow_explained;
  }

  // Ends on the right surface after it has only skimmed it from the expected point on.
  [[nodiscard]] bool slides(const Ray& ray, const SurfaceHit& got,
                            const std::vector<Crossing>& expected) const {
    const Vec3d end = ray.origin + ray.direction * double(got.t);
    return std::ranges::any_of(expected, [&](const Crossing& crossing) {
      if (crossing.t > expected[0].t + t_tolerance(crossing)) return false;
      const Opening& opening = world_.openings()[crossing.solid];
      const Vec3d middle = ray.origin + ray.direction * (0.5 * (double(got.t) + crossing.t));
      return std::abs(opening.distance(end)) <= rounding_error(ray) &&
             std::abs(opening.distance(middle)) <= rounding_error(ray) &&
             angle_deg(Vec3d(got.geometric_normal), opening.from_erosion(end)) <= 0.2;
    });
  }

  [[nodiscard]] std::string describe(const Ray& ray, const std::optional<SurfaceHit>& got,
                                     const std::vector<Crossing>& expected,
                                     const std::string& label) const {
    const auto vec = [](Vec3d v) { return fmt::format("({:.9g}, {:.9g}, {:.9g})", v.x, v.y, v.z); };
    std::string s =
        fmt::format("{}: origin {} direction {}: ", label, vec(ray.origin), vec(ray.direction));
    s += expected.empty() ? "expected nothing"
                          : fmt::format("expected t {:.9g} normal {} of solid {}", expected[0].t,
                                        vec(expected[0].normal), expected[0].solid);
    s += got ? fmt::format(", got t {:.9g} normal {} of object {} on {}\n", got->t,
                           vec(Vec3d(got->geometric_normal)), got->object.index,
                           arris::name_of(got->feature))
             : ", got nothing\n";
    if (scene_.occluded(float_ray(ray)) != !expected.empty())
      s += "  and the shadow ray is wrong\n";
    return s;
  }

  const World& world_;
  const PreparedScene& scene_;
  double reach_ = 0;
};

bool is_outside(const World& world, Vec3d point) {
  return std::ranges::none_of(
      world.openings(), [&](const Opening& opening) { return opening.in_sharp_solid(point); });
}

// Which solid a hit is on. Its index is the object's, except in a mesh of several solids.
std::size_t solid_of(const World& world, const SurfaceHit& hit) {
  std::size_t solid = 0;
  double least = kInfinity;
  for (std::size_t i = 0; i < world.openings().size(); ++i) {
    const Opening& opening = world.openings()[i];
    const double distance =
        std::abs(opening.distance(Vec3d(hit.position))) +
        1e-3 * opening.solid().size *
            angle_deg(opening.from_erosion(Vec3d(hit.position)), Vec3d(hit.geometric_normal));
    if (distance < least) solid = i;
    least = std::min(least, distance);
  }
  return solid;
}

// Rays from outside at each of the solids, with whatever stands around them, and on from where they hit.
struct SceneCounts {
  Counts camera, outward, inward;
};

SceneCounts shoot_at_solids(const World& world, const PreparedScene& scene, int rays) {
  const SceneJudge judge(world, scene);
  SceneCounts counts;
  Random rng(17);
  for (std::size_t i = 0; i < world.solids().size(); ++i) {
    RaySource source(world.solids()[i], world.openings()[i], 7 + i);
    for (const RayKind kind :
         {RayKind::outside, RayKind::at_edge, RayKind::at_corner, RayKind::along_edge}) {
      for (int k = 0; k < rays; ++k) {
        const TraceRay ray = float_ray(source.make(kind));
        if (!is_outside(world, Vec3d(ray.origin))) continue;
        const std::string label = fmt::format("solid {} {} ray {}", i, name_of(kind), k);
        judge.judge(ray, label, counts.camera);
        const auto hit = scene.intersect(ray);
        if (!hit || hit->side != Side::outside) continue;
        const std::size_t own = solid_of(world, *hit);
        const Vec3f away = Vec3f(random_direction(rng));
        const float cosine = dot(away, hit->geometric_normal);
        if (std::abs(cosine) < 0.02F) continue;
        // A convex solid is never met again from outside.
        judge.judge(leave_surface(*hit, away), label + (cosine > 0 ? ", outward" : ", inward"),
                    cosine > 0 ? counts.outward : counts.inward,
                    cosine > 0 ? std::optional(own) : std::nullopt);
      }
    }
  }
  return counts;
}

void expect_right(const Counts& counts) {
  EXPECT_EQ(counts.unexplained, 0) << counts.rays << " rays\n" << counts.lines;
  EXPECT_LE(counts.wrong * 1000, counts.rays) << counts.wrong << " wrong of " << counts.rays;
}

// Camera rays, and those that leave what they hit outward.
SceneCounts expect_right_outside(const World& world,
                                 std::uint64_t max_copied_triangles = 1'000'000) {
  const PreparedScene scene = world.prepare(max_copied_triangles);
  SceneCounts counts = shoot_at_solids(world, scene, 600);
  expect_right(counts.camera);
  EXPECT_GT(counts.camera.rounded * 20, counts.camera.hits) << "hardly a rounded edge was met";
  expect_right(counts.outward);
  return counts;
}

// Where solids overlap, few camera rays in ten thousand miss one that reaches into the void of another.
void expect_few_wrong(const World& world, std::uint64_t max_copied_triangles) {
  const PreparedScene scene = world.prepare(max_copied_triangles);
  const Counts counts = shoot_at_solids(world, scene, 600).camera;
  EXPECT_LE(counts.wrong * 1000, counts.rays) << counts.wrong << " wrong\n" << counts.lines;
}

std::vector<Polyhedron> row_of_cubes() {
  std::vector<Polyhedron> cubes;
  for (int x = 0; x < 4; ++x) {
    for (int z = 0; z < 2; ++z) cubes.push_back(transformed(cube(), moved(Vec3d(x, 0, z))));
  }
  return cubes;
}

World separate_cubes() {
  World world;
  for (const Polyhedron& cube : row_of_cubes()) world.add(cube, 0.1);
  return world;
}

World cubes_of_one_mesh() {
  World world;
  world.add_together(row_of_cubes(), 0.1);
  return world;
}

World instanced_cubes() {
  World world;
  std::vector<Affine3d> places;
  for (int x = 0; x < 4; ++x) {
    for (int z = 0; z < 2; ++z) places.push_back(moved(Vec3d(x, 0, z)));
  }
  world.add_instances(cube(), places, 0.1);
  return world;
}

// ---- solids that touch: faces that coincide (the paper's Fig. 9)

TEST(rounded_scene, touching_cubes) {
  expect_right(expect_right_outside(separate_cubes()).inward);
}

TEST(rounded_scene, touching_cubes_of_one_mesh) {
  expect_right(expect_right_outside(cubes_of_one_mesh()).inward);
}

TEST(rounded_scene, touching_cubes_that_are_instances) {
  expect_right(expect_right_outside(instanced_cubes(), 0).inward);
}

// Rays into the grooves, nearly along them, and off the walls of the grooves again.
Counts shoot_along_grooves(const World& world, std::uint64_t max_copied_triangles) {
  const PreparedScene scene = world.prepare(max_copied_triangles);
  const SceneJudge judge(world, scene);
  Random rng(3);
  Counts counts;
  for (int i = 0; i < 20'000; ++i) {
    // A point of the groove on top between two cubes, of the one in front, or where they cross.
    const Vec3d along = i % 2 == 0 ? Vec3d(0, 1, 0) : Vec3d(0, 0, 1);
    const double x = 0.5 + uniform_int(rng, 0, 2);
    const Vec3d through = i % 2 == 0
                              ? Vec3d(x + uniform(rng, -0.08, 0.08), uniform(rng, -0.45, 0.45),
                                      1.5 - uniform(rng, 0, 0.08))
                              : Vec3d(x + uniform(rng, -0.08, 0.08), -0.5 + uniform(rng, 0, 0.08),
                                      uniform(rng, -0.45, 1.45));
    const Vec3d direction =
        normalize(along + random_direction(rng) * std::pow(10, uniform(rng, -3, -0.5)));
    const TraceRay ray = float_ray({through - direction * 5, direction});
    judge.judge(ray, fmt::format("groove ray {}", i), counts);
    const auto hit = scene.intersect(ray);
    if (!hit || hit->feature == Feature::face || hit->side != Side::outside) continue;
    // The rounded edge that was hit is convex: a ray that leaves it outward meets others only.
    Vec3f away = Vec3f(random_direction(rng));
    if (dot(away, hit->geometric_normal) < 0) away = -away;
    if (dot(away, hit->geometric_normal) < 0.02F) continue;
    judge.judge(leave_surface(*hit, away), fmt::format("from groove ray {}", i), counts,
                solid_of(world, *hit));
  }
  return counts;
}

TEST(rounded_scene, along_the_grooves_between_cubes) {
  expect_right(shoot_along_grooves(separate_cubes(), 1'000'000));
}

TEST(rounded_scene, along_the_grooves_between_cubes_of_one_mesh) {
  expect_right(shoot_along_grooves(cubes_of_one_mesh(), 1'000'000));
}

TEST(rounded_scene, along_the_grooves_between_instances) {
  expect_right(shoot_along_grooves(instanced_cubes(), 0));
}

// ---- solids that overlap, and solids in one another

TEST(rounded_scene, overlapping_solids) {
  World world;
  Random rng(5);
  world.add(cube(), 0.2);
  world.add(transformed(cube(), {random_rotation(rng), {0.4, 0.3, 0.2}}), 0.1);
  world.add(transformed(dodecahedron(), {random_rotation(rng) * scaling(0.5), {-0.3, 0.2, 0.4}}),
            0.05);
  world.add(transformed(prism(6, 1.5), {random_rotation(rng) * scaling(0.4), {0.1, -0.5, 0.1}}),
            0.08);
  expect_few_wrong(world, 1'000'000);
}

// Of the inner cube, corner and edges stand in the void of the outer one, and three faces coincide.
TEST(rounded_scene, a_cube_in_the_corner_of_another) {
  World world;
  world.add(cube(), 0.25);
  world.add(transformed(cube(), {scaling(0.5), Vec3d(0.25)}), 0.02);
  expect_right_outside(world);
}

TEST(rounded_scene, solids_inside_solids) {
  World world;
  Random rng(6);
  world.add(cube(), 0.3);
  world.add(transformed(cube(), {scaling(0.8), {}}), 0.1);
  world.add(transformed(octahedron(), {random_rotation(rng) * scaling(0.3), {}}), 0.05);
  expect_right_outside(world);
}

// ---- instances

std::vector<Affine3d> instance_places() {
  Random rng(8);
  const Mat3d turned = random_rotation(rng);
  return {{turned * scaling(2.5), {0, 0, 0}},
          {Mat3d{{-1.5, 0, 0}, {0, 1.5, 0}, {0, 0, 1.5}}, {9, 0, 0}},
          {turned * Mat3d{{2, 0, 0}, {0, 0.7, 0}, {0, 0, 1.2}}, {0, 9, 0}},
          {turned * Mat3d{{1, 0, 0}, {0.3, 1.5, 0}, {-0.2, 0.4, 1.8}}, {9, 9, 0}},
          {Mat3d{{1, 0.2, 0}, {-0.3, -0.8, 0.4}, {0.1, 0.5, 1.2}}, {0, 0, 9}}};
}

class Instances : public testing::TestWithParam<Polyhedron> {};

TEST_P(Instances, are_rounded_by_world_units) {
  World world;
  world.add_instances(GetParam(), instance_places(), 0.11);
  const PreparedScene scene = world.prepare(0);
  for (const GeometryRecord& record : scene.geometry().embree.records()) {
    ASSERT_TRUE(record.instanced);
  }
  const SceneCounts counts = shoot_at_solids(world, scene, 600);
  expect_right(counts.camera);
  EXPECT_GT(counts.camera.rounded * 20, counts.camera.hits) << "hardly a rounded edge was met";
  expect_right(counts.outward);
  expect_right(counts.inward);
}

INSTANTIATE_TEST_SUITE_P(rounded_scene, Instances,
                         testing::Values(cube(), dodecahedron(), prism(5, 1.3), pyramid(4, 1.2)),
                         [](const auto& test) {
                           return test.param.name + std::to_string(test.index);
                         });

TEST(rounded_scene, instances_of_one_mesh_in_one_another) {
  World world;
  Random rng(9);
  world.add_instances(
      cube(),
      {{}, {random_rotation(rng) * scaling(0.7), {0.4, 0.4, 0.3}}, {scaling(0.5), Vec3d(0.25)}},
      0.06);
  expect_few_wrong(world, 0);
}

// Of three objects that share a mesh the third is as the first, twice as large; the second's rules are others in the
// mesh's own units.
TEST(rounded_scene, instances_share_a_rounding_where_rules_are_the_same_to_them) {
  Scene scene;
  scene.camera = Camera{.position = {9, 9, 9}, .target = {}};
  scene.environment = ConstantEnvironment{};
  scene.materials.emplace_back();
  scene.meshes.push_back(mesh_of(make_mesh(cube(), {}, 1)));
  for (const auto& [scale, edge_radius] : {std::pair(1.0, 0.04), {2.0, 0.04}, {2.0, 0.08}}) {
    Object object;
    object.name = fmt::format("object {}", scene.objects.size());
    object.world_from_object.linear = scaling(scale);
    object.rounding = rounded_by(0.1 * scale);
    object.rounding->rules.emplace_back().radius = edge_radius;
    scene.objects.push_back(object);
  }
  const SceneGeometry geometry(scene, EmbreeSceneOptions{.max_copied_triangles = 0});
  const SceneRounding rounding = make_scene_rounding(geometry, std::nullopt, {});
  ASSERT_EQ(rounding.geometries.size(), 3U);
  EXPECT_NE(rounding.geometries[0].rounding, rounding.geometries[1].rounding);
  EXPECT_EQ(rounding.geometries[0].rounding, rounding.geometries[2].rounding);
}

}  // namespace
}  // namespace arris::oracle
