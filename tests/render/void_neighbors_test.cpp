// Rays that cross the void of a rounded edge in one step meet what they meet when traced through it, and shadow
// rays are stopped by what others meet.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "render/prepared_scene.h"
#include "render/scene_geometry.h"
#include "render/scene_rounding.h"
#include "support/convex_solids.h"
#include "support/csg_oracle.h"
#include "support/render_scenes.h"

namespace arris::test {
namespace {

using oracle::Random;
using oracle::uniform;

constexpr double kRadius = 0.06;

struct Heap {
  const char* name;
  double step;     // between the pieces' places
  double scatter;  // about them
  // Each its own way; else faces of neighbours are parallel, and coincide if step is 1.
  bool turned = false;
  double scale = 0;  // of true instances of one cube; 0: pieces of their own
  bool csg = false;  // every other piece is a CSG solid
};

Mat3d scaled(double scale) {
  return {{scale, 0, 0}, {0, scale, 0}, {0, 0, scale}};
}

// The mesh's bounds as a solid.
void add_csg_box(Scene& scene, const Mesh& mesh, const Affine3d& place) {
  CsgBox box{Vec3d(mesh.positions[0]), Vec3d(mesh.positions[0])};
  for (const Vec3f& p : mesh.positions) {
    box.low = min(box.low, Vec3d(p));
    box.high = max(box.high, Vec3d(p));
  }
  Object object;
  object.name = "csg " + std::to_string(scene.objects.size());
  object.csg = CsgId{std::uint32_t(scene.csg_trees.size())};
  object.world_from_object = place;
  scene.csg_trees.push_back(one_leaf(box));
  scene.objects.push_back(object);
}

// Cubes, prisms and dodecahedra of about unit size on a ground plane.
Scene make_heap(const Heap& heap, std::uint64_t seed) {
  Random random(seed);
  Scene scene = make_empty_scene({.position = {6, -8, 6}, .target = {}});
  constexpr double kScales[] = {1, 0.5, 0.3};
  const std::vector<oracle::Polyhedron> kinds{oracle::cube(), oracle::prism(6, 1.0),
                                              oracle::dodecahedron()};
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) {
      for (int k = 0; k < 3; ++k) {
        const auto pick = heap.turned ? std::size_t(oracle::uniform_int(random, 0, 2)) : 0;
        const double scale = heap.scale > 0 ? 1 / heap.scale : kScales[pick];
        const oracle::SolidMesh solid = oracle::make_mesh(kinds[pick], {.scale = scale}, random());
        Mesh mesh;
        mesh.name = solid.name;
        mesh.positions = solid.positions;
        mesh.triangles = solid.triangles;
        Affine3d place;
        if (heap.turned) place.linear = oracle::random_rotation(random);
        place.translation = Vec3d(i, j, k) * heap.step +
                            oracle::random_direction(random) * uniform(random, 0, heap.scatter);
        if (heap.csg && (i + j + k) % 2 == 0) {
          add_csg_box(scene, mesh, place);
          continue;
        }
        if (heap.scale > 0) place.linear = scaled(heap.scale);
        Object& object = add_object(scene, std::move(mesh), make_lambert(0.5F), place);
        if (heap.scale > 0) object.mesh = {0};
      }
    }
  }
  add_object(scene, make_square_mesh(20), make_lambert(0.5F), translation({0, 0, -0.501}))
      .rounding = RoundingSettings{};
  RoundingSettings rounding;
  rounding.method = RoundMethod::exact;
  rounding.radius = kRadius;
  scene.rounding = rounding;
  return scene;
}

// The same scene twice: as it is prepared, and with all voids said to hold something.
struct Pair {
  PreparedScene fast, thorough;
  std::vector<std::vector<VoidNeighbors>> marks;
};

std::unique_ptr<Pair> prepare_both(const Scene& scene, const EmbreeSceneOptions& options) {
  auto geometry = std::make_shared<const SceneGeometry>(scene, options);
  SceneRounding wary = make_scene_rounding(*geometry, scene.rounding, {});
  std::vector<std::vector<VoidNeighbors>> marks(wary.geometries.size());
  for (std::size_t i = 0; i < marks.size(); ++i) {
    RoundedGeometry& g = wary.geometries[i];
    if (g.rounding == nullptr) continue;
    const Rounding::Data& data = g.rounding->data();
    marks[i].assign(data.arcs.size() + data.solids.size(), VoidNeighbors::inside);
    g.neighbors = marks[i].data();
  }
  SceneRounding plain = make_scene_rounding(*geometry, scene.rounding, {});
  return std::unique_ptr<Pair>(new Pair{PreparedScene(geometry, std::move(plain)),
                                        PreparedScene(geometry, std::move(wary)),
                                        std::move(marks)});
}

TraceRay towards_a_piece(const Heap& heap, Random& random) {
  const Vec3d middle = Vec3d(1.5, 1.5, 1) * heap.step;
  const Vec3d from = middle + oracle::random_direction(random) * 9.0;
  const Vec3d at =
      Vec3d(uniform(random, -0.6, 3.6), uniform(random, -0.6, 3.6), uniform(random, -0.5, 2.5)) *
      heap.step;
  TraceRay ray;
  ray.origin = Vec3f(from);
  ray.direction = normalize(Vec3f(at - from));
  return ray;
}

bool agree(const std::optional<SurfaceHit>& a, const std::optional<SurfaceHit>& b) {
  if (a.has_value() != b.has_value()) return false;
  if (!a) return true;
  return a->geometry == b->geometry && std::abs(a->t - b->t) <= 1e-5F * (1 + a->t) &&
         dot(a->geometric_normal, b->geometric_normal) > 0.99999F;
}

class VoidNeighborsOf : public ::testing::TestWithParam<Heap> {};

TEST_P(VoidNeighborsOf, rays_agree_with_those_traced_through_the_void) {
  const Heap& heap = GetParam();
  Random random(7);
  int rays = 0, from_edges = 0, wrong = 0, skipped = 0, untrue_shadows = 0;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const auto scenes = prepare_both(make_heap(heap, seed),
                                     {.max_copied_triangles = heap.scale > 0 ? 0U : 1'000'000U});
    for (int i = 0; i < 24000; ++i) {
      TraceRay ray = towards_a_piece(heap, random);
      for (int bounce = 0; bounce < 4; ++bounce) {
        ++rays;
        const auto fast = scenes->fast.intersect(ray), thorough = scenes->thorough.intersect(ray);
        wrong += agree(fast, thorough) ? 0 : 1;
        TraceRay shadow = ray;
        shadow.t_max = 1.5F;
        wrong +=
            scenes->fast.transmittance(shadow) == scenes->thorough.transmittance(shadow) ? 0 : 1;
        const bool is_met = fast && fast->t < shadow.t_max;
        untrue_shadows += scenes->fast.occluded(shadow) == is_met ? 0 : 1;
        if (!fast) break;
        from_edges += fast->feature == Feature::edge || fast->feature == Feature::corner ? 1 : 0;
        skipped += fast->crossed != kNone ? 1 : 0;
        Vec3f direction(oracle::random_direction(random));
        if (dot(direction, fast->geometric_normal) < 0) direction = -direction;
        ray = leave_surface(*fast, direction);
      }
    }
  }
  EXPECT_GT(from_edges, 10000);
  EXPECT_GT(skipped, from_edges / 2);
  EXPECT_LE(untrue_shadows, rays / 10000) << rays;
  // Rays that graze a face or an edge may meet it or not, by a rounding error of its float coordinates.
  EXPECT_LE(wrong, rays / 10000) << rays;
}

std::string heap_name(const ::testing::TestParamInfo<Heap>& info) {
  return info.param.name;
}

INSTANTIATE_TEST_SUITE_P(Heaps, VoidNeighborsOf,
                         ::testing::Values(Heap{"apart", 1.9, 0.1, true},
                                           Heap{"near", 1.001, 0.0005, false},
                                           Heap{"touching", 1, 0, false},
                                           Heap{"overlapping", 0.93, 0.05, false},
                                           Heap{"turned", 1.05, 0.1, true},
                                           Heap{"csg_near", 1.001, 0.0005, false, 0, true},
                                           Heap{"csg_touching", 1, 0, false, 0, true},
                                           Heap{"csg_overlapping", 0.93, 0.05, false, 0, true},
                                           Heap{"csg_turned", 1.05, 0.1, true, 0, true},
                                           Heap{"instances_grown", 0.93, 0.05, false, 1000},
                                           Heap{"instances_shrunk", 0.93, 0.05, false, 0.001}),
                         heap_name);

}  // namespace
}  // namespace arris::test
