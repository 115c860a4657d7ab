// What the polynomials of a view say of picture points, against the rays through them.
#include "beam/beam_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "support/beam_truth.h"

namespace arris::test {
namespace {

using Real = long double;
using Vec3r = Vec3<Real>;
struct Point {
  double x, y;
};

Vec3r map_real(const Mat3d& m, Vec3r v) {
  return Vec3r(m.x) * v.x + Vec3r(m.y) * v.y + Vec3r(m.z) * v.z;
}
Vec3r map_real(const Affine3d& m, Vec3r p) {
  return map_real(m.linear, p) + Vec3r(m.translation);
}
Real height_of(const CsgPlane& plane, Vec3r p) {
  return dot(Vec3r(plane.normal), p) - Real(plane.d);
}
// The bilinear form of the quadric without its constant.
Real product_of(const CsgQuadric& quadric, Vec3r a, Vec3r b) {
  return dot(Vec3r(weights_of(quadric.form)) * a, b);
}

// origin + depth · direction in some solid's space; polynomials are those of this ray times weight, and quadrics'
// times weight².
struct ViewRay {
  Vec3r origin, direction;
  Real weight = 1;
};

struct ViewScene {
  BeamScene beam;
  std::optional<LitPlane> lit;
  LightPlace light;
  double reach = 0;
  std::unique_ptr<BeamView> view;

  // In the world. Nothing: the eye's ray does not meet the lit plane.
  [[nodiscard]] std::optional<ViewRay> world_ray(Point at) const {
    const EyeRays& eye = beam.eye;
    const ViewRay seen{Vec3r(eye.position), Vec3r(eye.corner) + Vec3r(eye.step_x) * Real(at.x) +
                                                Vec3r(eye.step_y) * Real(at.y)};
    if (!lit) return seen;
    const BeamSolid& of = beam.placed[lit->solid];
    const CsgPlane& plane = of.shape->planes()[lit->plane];
    const Affine3d& m = of.object_from_world;
    const Real height = height_of(plane, map_real(m, seen.origin));
    const Real slope = dot(Vec3r(plane.normal), map_real(m.linear, seen.direction));
    if (!(height * slope < 0)) return std::nullopt;
    const Real weight = std::abs(slope);
    const Vec3r point = seen.origin + seen.direction * (std::abs(height) / weight);
    if (!light.is_directional) {
      return ViewRay{Vec3r(light.position), (point - Vec3r(light.position)) * weight};
    }
    const Vec3r travels(light.direction * (1 / length(light.direction)));
    return ViewRay{point - travels * Real(reach), travels * (1 / weight), weight};
  }
  [[nodiscard]] std::optional<ViewRay> ray(std::uint32_t solid, Point at) const {
    const std::optional<ViewRay> world = world_ray(at);
    if (!world) return std::nullopt;
    const Affine3d& m = beam.placed[solid].object_from_world;
    return ViewRay{map_real(m, world->origin), map_real(m.linear, world->direction), world->weight};
  }
};

enum class ViewKind : int { eye, point_light, directional_light };

ViewScene random_scene(CsgRandom& random, ViewKind kind) {
  ViewScene scene;
  for (int k = 0; k < 2; ++k) {
    CsgTree tree = random_convex_tree(random, 1);
    tree.leaves.back().primitive = random_mesh(random);
    if (tree.leaves.size() > 2) tree.leaves[1].primitive = random_primitive(random, k * 2);
    scene.beam.add(tree, random_placement(random, 1));
  }
  scene.beam.eye =
      look_at(random_unit(random) * uniform(random, 3, 6), random_vector(random, 0.5), 40, 16, 16);
  if (kind == ViewKind::eye) {
    scene.view = std::make_unique<BeamView>(scene.beam.placed, scene.beam.eye);
    return scene;
  }
  scene.lit = LitPlane{std::uint32_t(random() % 2), 0};
  const auto& planes = scene.beam.placed[scene.lit->solid].shape->planes();
  scene.lit->plane = std::uint32_t(random() % planes.size());
  scene.light.is_directional = kind == ViewKind::directional_light;
  scene.light.direction = random_vector(random, 1);
  scene.light.position = random_vector(random, 4);
  scene.reach = uniform(random, 8, 12);
  scene.view = std::make_unique<BeamView>(scene.beam.placed, scene.beam.eye, *scene.lit,
                                          scene.light, scene.reach);
  return scene;
}

// Calls check(scene, solid, ray, at) for points of many pictures.
template <class Check>
void visit_points(ViewKind kind, const Check& check) {
  CsgRandom random(1 + std::uint64_t(kind));
  int points = 0;
  for (int i = 0; i < 80; ++i) {
    const ViewScene scene = random_scene(random, kind);
    for (int k = 0; k < 24; ++k) {
      const Point at{uniform(random, 0, 16), uniform(random, 0, 16)};
      const std::uint32_t solid = std::uint32_t(k) % 2;
      const std::optional<ViewRay> ray = scene.ray(solid, at);
      if (!ray) continue;
      check(scene, solid, *ray, at);
      ++points;
    }
  }
  EXPECT_GT(points, 800);
}

template <class Polynomial>
Interval value_at(const Polynomial& p, Point at) {
  return range_over(p, Rect{at.x, at.y, at.x, at.y});
}

// `scale`: what the terms that cancel in the value may be. The truth is a long double: a little may be lost there too.
constexpr Real kTruthRounding = 1e-18L, kTightness = 1e-13L;
testing::AssertionResult holds_closely(Interval range, Real truth, Real scale) {
  const Real slack = kTruthRounding * scale;
  if (!(Real(range.lo) - slack <= truth && truth <= Real(range.hi) + slack)) {
    return testing::AssertionFailure() << double(truth) << " is not in [" << range.lo << ", "
                                       << range.hi << "], scale " << double(scale);
  }
  if (Real(range.hi) - Real(range.lo) > kTightness * scale) {
    return testing::AssertionFailure() << "[" << range.lo << ", " << range.hi << "] is wide";
  }
  return testing::AssertionSuccess();
}

Real square_of(Real x) {
  return x * x;
}
// Coordinates along the ray, and in the frame of the quadric, are below these.
Real scale_of(const ViewRay& ray) {
  return (1 + length(ray.origin)) * (1 + length(ray.direction)) * (1 + ray.weight);
}
Real scale_of(const ViewRay& ray, const CsgQuadric& q) {
  const Mat3d& m = q.unit_from_object.linear;
  const Real size = 1 + Real(length(m.x) + length(m.y) + length(m.z)) +
                    Real(length(q.unit_from_object.translation));
  return square_of(scale_of(ray) * size);
}

class BeamViewTest : public testing::TestWithParam<ViewKind> {};

TEST_P(BeamViewTest, planes_heights_are_those_along_the_ray) {
  visit_points(
      GetParam(), [](const ViewScene& scene, std::uint32_t solid, const ViewRay& ray, Point at) {
        const auto& planes = scene.beam.placed[solid].shape->planes();
        for (std::uint32_t i = 0; i < planes.size(); ++i) {
          const PlaneForm& form = scene.view->plane(solid, i);
          const Real slope = dot(Vec3r(planes[i].normal), ray.direction) * ray.weight;
          ASSERT_TRUE(holds_closely(value_at(form.height, at),
                                    height_of(planes[i], ray.origin) * ray.weight, scale_of(ray)));
          ASSERT_TRUE(holds_closely(value_at(form.slope, at), slope, scale_of(ray)));
        }
      });
}

TEST_P(BeamViewTest, quadrics_values_are_those_along_the_ray) {
  int quadrics_seen = 0;
  visit_points(
      GetParam(), [&](const ViewScene& scene, std::uint32_t solid, const ViewRay& ray, Point at) {
        const auto& quadrics = scene.beam.placed[solid].shape->quadrics();
        for (std::uint32_t i = 0; i < quadrics.size(); ++i) {
          const CsgQuadric& quadric = quadrics[i];
          const QuadricForm& form = scene.view->quadric(solid, i);
          const Real ww = square_of(ray.weight), scale = scale_of(ray, quadric);
          const Vec3r o = map_real(quadric.unit_from_object, ray.origin);
          const Vec3r d = map_real(quadric.unit_from_object.linear, ray.direction);
          const Real value = (product_of(quadric, o, o) - Real(constant_of(quadric.form))) * ww;
          const Real half_slope = product_of(quadric, o, d) * ww;
          const Real curvature = product_of(quadric, d, d) * ww;
          ASSERT_TRUE(holds_closely(value_at(form.value, at), value, scale));
          ASSERT_TRUE(holds_closely(value_at(form.half_slope, at), half_slope, scale));
          ASSERT_TRUE(holds_closely(value_at(form.curvature, at), curvature, scale));
          ASSERT_TRUE(holds_closely(value_at(form.discriminant, at),
                                    half_slope * half_slope - value * curvature, scale * scale));
          ASSERT_TRUE(holds_closely(value_at(form.along, at), o.z * ray.weight, scale));
          ++quadrics_seen;
        }
      });
  EXPECT_GT(quadrics_seen, 1000);
}

// Within both tangents, and only there, a ray from outside meets the cylinder ahead, or the lines of parallel rays do.
TEST_P(BeamViewTest, tangents_tell_which_rays_meet_a_cylinder) {
  int hits = 0, misses = 0;
  visit_points(GetParam(), [&](const ViewScene& scene, std::uint32_t solid, const ViewRay& ray,
                               Point at) {
    const auto& quadrics = scene.beam.placed[solid].shape->quadrics();
    for (std::uint32_t i = 0; i < quadrics.size(); ++i) {
      const QuadricForm& form = scene.view->quadric(solid, i);
      const Vec3r o = map_real(quadrics[i].unit_from_object, ray.origin);
      const Vec3r d = map_real(quadrics[i].unit_from_object.linear, ray.direction);
      const bool is_cylinder = quadrics[i].form == CsgQuadric::Form::cylinder;
      const bool outside = o.x * o.x + o.y * o.y > 1 + 1e-9L;
      const bool parallel = scene.view->kind() == BeamKind::parallel;
      ASSERT_EQ(form.has_tangents, is_cylinder && (parallel || outside));
      if (!form.has_tangents) continue;
      // The line's distance from the axis.
      const Real apart = std::abs(o.x * d.y - o.y * d.x) / std::hypot(d.x, d.y);
      const bool ahead = parallel || o.x * d.x + o.y * d.y < 0;
      const Interval low = value_at(form.tangents[0], at), high = value_at(form.tangents[1], at);
      if (std::abs(apart - 1) < 1e-9L) continue;
      if (apart < 1 && ahead) {
        ASSERT_TRUE(low.lo > 0 && high.lo > 0);
        ++hits;
      } else {
        ASSERT_TRUE(low.hi < 0 || high.hi < 0);
        ++misses;
      }
    }
  });
  EXPECT_GT(hits, 30);
  EXPECT_GT(misses, 30);
}

TEST_P(BeamViewTest, orders_of_surfaces_are_those_of_their_depths) {
  int planes_seen = 0, quadrics_seen = 0;
  visit_points(
      GetParam(), [&](const ViewScene& scene, std::uint32_t solid, const ViewRay& ray, Point at) {
        const std::uint32_t other = 1 - solid;  // depths are the same in both
        const auto& planes = scene.beam.placed[solid].shape->planes();
        const auto& others = scene.beam.placed[other].shape->planes();
        const std::optional<ViewRay> other_ray = scene.ray(other, at);
        const BeamKind kind = scene.view->kind();
        for (std::uint32_t i = 0; i < planes.size(); i += 3) {
          const PlaneForm& p = scene.view->plane(solid, i);
          const Real p_height = height_of(planes[i], ray.origin) * ray.weight;
          const Real p_slope = dot(Vec3r(planes[i].normal), ray.direction) * ray.weight;
          const Real depth = -p_height / p_slope;
          for (std::uint32_t k = 0; k < others.size(); k += 4) {
            const Real slope = dot(Vec3r(others[k].normal), other_ray->direction) * ray.weight;
            const Real other_depth = -height_of(others[k], other_ray->origin) * ray.weight / slope;
            const Quadratic before = plane_before_plane(p, scene.view->plane(other, k), kind);
            const Real truth = (depth - other_depth) * p_slope * slope;
            ASSERT_TRUE(
                holds_closely(value_at(before, at), truth, scale_of(ray) * scale_of(*other_ray)));
            ++planes_seen;
          }
          const auto& quadrics = scene.beam.placed[other].shape->quadrics();
          for (std::uint32_t k = 0; k < quadrics.size(); ++k) {
            const CsgQuadric& quadric = quadrics[k];
            const QuadricForm& q = scene.view->quadric(other, k);
            const Real scale = scale_of(*other_ray, quadric) * square_of(scale_of(ray));
            const Vec3r o = map_real(quadric.unit_from_object, other_ray->origin);
            const Vec3r d = map_real(quadric.unit_from_object.linear, other_ray->direction);
            const Vec3r point = o + d * depth;
            const Real value = product_of(quadric, point, point) - Real(constant_of(quadric.form));
            ASSERT_TRUE(holds_closely(value_at(quadric_at_plane(q, p, kind), at),
                                      value * square_of(ray.weight * p_slope), scale));
            const Real curvature = product_of(quadric, d, d);
            const Real middle = -product_of(quadric, o, d) / curvature;
            ASSERT_TRUE(holds_closely(
                value_at(plane_beyond_middle(q, p, kind), at),
                (depth - middle) * p_slope * curvature * square_of(ray.weight), scale));
            ++quadrics_seen;
          }
        }
      });
  EXPECT_GT(planes_seen, 2000);
  EXPECT_GT(quadrics_seen, 1000);
}

// Sides of mesh edges, and on which side of all three a ray passes a facet that it meets.
TEST_P(BeamViewTest, sides_are_those_on_which_rays_pass_edges) {
  int met = 0, edge_on = 0;
  visit_points(
      GetParam(), [&](const ViewScene& scene, std::uint32_t solid, const ViewRay& ray, Point at) {
        const BeamShape& shape = *scene.beam.placed[solid].shape;
        const auto side_of = [&](const BeamShape::Edge& e) {
          return dot(ray.direction, cross(Vec3r(e.a) - ray.origin, Vec3r(e.b) - ray.origin));
        };
        for (std::uint32_t i = 0; i < shape.edges().size(); ++i) {
          // Directions that are fixed are those of the polynomials but for the weight, which scales the depth.
          ASSERT_TRUE(holds_closely(value_at(scene.view->side(solid, i), at),
                                    side_of(shape.edges()[i]) * square_of(ray.weight),
                                    square_of(scale_of(ray))));
        }
        for (std::uint32_t leaf = 0; leaf < shape.leaf_count(); ++leaf) {
          const Facet* facet = shape.facet(leaf);
          if (facet == nullptr) continue;
          const int turn = scene.view->facet_turn(solid, leaf);
          edge_on += turn == 0 ? 1 : 0;
          int positive = 0;
          for (std::size_t k = 0; k < 3; ++k) {
            const Real side = side_of(shape.edges()[facet->edges[k]]);
            positive += (side > 0) != facet->turned[k] ? 1 : 0;
          }
          if (positive != 0 && positive != 3) continue;
          // The line passes through the triangle, ahead or behind.
          const CsgPlane& plane = shape.planes()[facet->plane.plane];
          const Real t = -height_of(plane, ray.origin) / dot(Vec3r(plane.normal), ray.direction);
          const bool ahead = t > 0 || scene.view->kind() == BeamKind::parallel;
          ASSERT_EQ(turn, (positive == 3) == ahead ? 1 : -1);
          ++met;
        }
      });
  EXPECT_GT(met, 200);
  EXPECT_LT(edge_on, 30);
}

INSTANTIATE_TEST_SUITE_P(Kinds, BeamViewTest,
                         testing::Values(ViewKind::eye, ViewKind::point_light,
                                         ViewKind::directional_light));

// A point of the leaf, or nothing.
std::optional<Vec3d> point_of(CsgRandom& random, const BeamShape& shape, std::uint32_t leaf) {
  if (const Facet* facet = shape.facet(leaf)) {
    const auto corner = [&](std::size_t k) {
      const BeamShape::Edge& e = shape.edges()[facet->edges[k]];
      return facet->turned[k] ? e.b : e.a;
    };
    const double u = uniform(random, 0, 1), v = uniform(random, 0, 1 - u);
    return corner(0) * (1 - u - v) + corner(1) * u + corner(2) * v;
  }
  const Box3d& box = shape.leaf_box(leaf);
  if (!is_finite(box.low) || !is_finite(box.high)) return std::nullopt;
  const Vec3d p{uniform(random, box.low.x, box.high.x), uniform(random, box.low.y, box.high.y),
                uniform(random, box.low.z, box.high.z)};
  const CsgSolid& csg = shape.csg();
  return contains(csg.leaf(leaf), csg.surfaces(), p) ? std::optional(p) : std::nullopt;
}

// x, y: where in the picture; z: how deep.
Vec3d picture_of(const EyeRays& eye, Vec3d world) {
  const Vec3d q = inverse(Mat3d{eye.step_x, eye.step_y, eye.corner}) * (world - eye.position);
  return {q.x / q.z, q.y / q.z, q.z};
}

TEST(beam_view, windows_hold_what_the_eye_sees_of_leaves) {
  CsgRandom random(11);
  int points = 0, everywhere = 0, windows = 0;
  for (int i = 0; i < 60; ++i) {
    ViewScene scene = random_scene(random, ViewKind::eye);
    if (i % 4 == 0) {
      scene.beam.eye.position = random_vector(random, 1);
      scene.view = std::make_unique<BeamView>(scene.beam.placed, scene.beam.eye);
    }
    const EyeRays& eye = scene.beam.eye;
    for (std::uint32_t solid = 0; solid < 2; ++solid) {
      const BeamShape& shape = *scene.beam.placed[solid].shape;
      const Affine3d world_from_object = inverse(scene.beam.placed[solid].object_from_world);
      for (const std::uint32_t leaf : shape.root().leaves()) {
        const LeafWindow window = scene.view->window(solid, leaf);
        const bool is_all = std::isinf(window.x0) || std::isinf(window.x1);
        for (int k = 0; k < 20; ++k) {
          const std::optional<Vec3d> p = point_of(random, shape, leaf);
          if (!p) continue;
          const Vec3d at = picture_of(eye, transform_point(world_from_object, *p));
          if (at.z > 0) {
            ASSERT_TRUE(window.meets({at.x, at.y, at.x, at.y})) << i;
          } else {
            ASSERT_TRUE(is_all) << i;
          }
          ASSERT_TRUE(is_all || (window.near <= at.z && at.z <= window.far)) << i;
          ++points;
        }
        // As tight as boxes are.
        const Box3d& box = shape.leaf_box(leaf);
        if (!is_finite(box.low) || !is_finite(box.high)) continue;
        Box3d hull_of_corners{Vec3d(INFINITY), Vec3d(-INFINITY)};
        for (const Vec3d& corner : corners_of(box)) {
          const Vec3d at = picture_of(eye, transform_point(world_from_object, corner));
          hull_of_corners = hull(hull_of_corners, {at, at});
        }
        ++(is_all ? everywhere : windows);
        if (is_all) {
          EXPECT_LT(hull_of_corners.low.z, 1e-3) << i;
          continue;
        }
        const double slack =
            1e-4 * (1 + length(hull_of_corners.low) + length(hull_of_corners.high));
        EXPECT_NEAR(window.x0, hull_of_corners.low.x, slack);
        EXPECT_NEAR(window.y0, hull_of_corners.low.y, slack);
        EXPECT_NEAR(window.x1, hull_of_corners.high.x, slack);
        EXPECT_NEAR(window.y1, hull_of_corners.high.y, slack);
        EXPECT_NEAR(window.near, hull_of_corners.low.z, slack);
        EXPECT_NEAR(window.far, hull_of_corners.high.z, slack);
      }
    }
  }
  EXPECT_GT(points, 5000);
  EXPECT_GT(windows, 500);
  EXPECT_GT(everywhere, 50);
}

TEST(beam_view, windows_hold_the_shadows_of_leaves) {
  CsgRandom random(12);
  int shadows = 0, bounded = 0;
  for (int i = 0; i < 80; ++i) {
    const ViewScene scene =
        random_scene(random, i % 2 == 0 ? ViewKind::point_light : ViewKind::directional_light);
    const BeamSolid& of = scene.beam.placed[scene.lit->solid];
    const CsgPlane& plane = of.shape->planes()[scene.lit->plane];
    const auto height = [&](Vec3d world) {
      return dot(plane.normal, transform_point(of.object_from_world, world)) - plane.d;
    };
    for (std::uint32_t solid = 0; solid < 2; ++solid) {
      const BeamShape& shape = *scene.beam.placed[solid].shape;
      const Affine3d world_from_object = inverse(scene.beam.placed[solid].object_from_world);
      for (const std::uint32_t leaf : shape.root().leaves()) {
        const LeafWindow window = scene.view->window(solid, leaf);
        for (int k = 0; k < 10; ++k) {
          const std::optional<Vec3d> own = point_of(random, shape, leaf);
          if (!own) continue;
          const Vec3d p = transform_point(world_from_object, *own);
          const Vec3d from = scene.light.is_directional
                                 ? p - scene.light.direction * (100 / length(scene.light.direction))
                                 : scene.light.position;
          const double here = height(p), there = height(from);
          const double u = there / (there - here);  // from + u (p - from) is on the plane
          if (!(u > 1 && u < 1e3)) continue;        // the point is not between
          const Vec3d at = picture_of(scene.beam.eye, from + (p - from) * u);
          if (!(at.z > 1e-6)) continue;  // the eye does not see it
          ASSERT_TRUE(window.meets({at.x, at.y, at.x, at.y})) << i;
          ++shadows;
          bounded += std::isinf(window.x0) ? 0 : 1;
        }
      }
    }
  }
  EXPECT_GT(shadows, 2000);
  EXPECT_GT(bounded, shadows / 4);
}

TEST(beam_view, cells_hold_the_rays_between_two_depths_and_little_more) {
  CsgRandom random(13);
  for (int i = 0; i < 300; ++i) {
    const ViewScene scene =
        random_scene(random, i % 2 == 0 ? ViewKind::eye : ViewKind::point_light);
    const Point corner{uniform(random, 0, 15), uniform(random, 0, 15)};
    const Rect rect{corner.x, corner.y, corner.x + uniform(random, 0.01, 2),
                    corner.y + uniform(random, 0.01, 2)};
    const double near = uniform(random, 0.1, 4), far = near + uniform(random, 0.01, 3);
    const SpaceCell cell = scene.view->cell(0, rect, {near, far});
    const auto middle = [](const Vec3i& v) {
      return Vec3d{v.x.lo / 2 + v.x.hi / 2, v.y.lo / 2 + v.y.hi / 2, v.z.lo / 2 + v.z.hi / 2};
    };
    const Mat3d cube_from_object =
        inverse(Mat3d{middle(cell.half[0]), middle(cell.half[1]), middle(cell.half[2])});
    double most = 0;
    for (int k = 0; k < 40; ++k) {
      // Corners first.
      const double u = k < 8 ? k % 2 : uniform(random, 0, 1);
      const double v = k < 8 ? k / 2 % 2 : uniform(random, 0, 1);
      const double w = k < 8 ? k / 4 : uniform(random, 0, 1);
      const auto ray = scene.ray(0, {rect.x0 + u * rect.width(), rect.y0 + v * rect.height()});
      if (!ray) continue;
      const Vec3d p(ray->origin + ray->direction * Real(near + w * (far - near)));
      const Vec3d at = cube_from_object * (p - middle(cell.center));
      const double reach = std::max({std::abs(at.x), std::abs(at.y), std::abs(at.z)});
      ASSERT_LE(reach, 1 + 1e-9) << i;
      most = std::max(most, k < 8 ? std::min({std::abs(at.x), std::abs(at.y), std::abs(at.z)}) : 0);
    }
    EXPECT_TRUE(i % 2 != 0 || most >= 1 - 1e-9) << i;
  }
}

TEST(beam_view, volumes_are_started_in_by_origins_inside) {
  CsgRandom random(14);
  int inside = 0;
  for (int i = 0; i < 200; ++i) {
    const CsgMesh mesh = random_mesh(random);
    BeamScene scene;
    const Affine3d placement = random_placement(random, 0.5);
    scene.add(one_leaf(mesh), placement);
    scene.eye = look_at(random_vector(random, 0.8), {2, 2, 2}, 40, 4, 4);
    const LightPlace point{random_vector(random, 0.8), {}, false}, sun{{}, {0, 0, -1}, true};
    const std::uint32_t volume = std::uint32_t(scene.shapes[0].leaf_count()) - 1;
    const auto is_in = [&](Vec3d p) {
      return mesh_holds(mesh, transform_point(scene.placed[0].object_from_world, p));
    };
    const LitPlane lit{0, 0};
    const auto cover = [&](Vec3d p) { return is_in(p) ? Cover::in : Cover::out; };
    EXPECT_EQ(BeamView(scene.placed, scene.eye).start_in_volume(0, volume),
              cover(scene.eye.position));
    EXPECT_EQ(BeamView(scene.placed, scene.eye, lit, point, 9).start_in_volume(0, volume),
              cover(point.position));
    EXPECT_EQ(BeamView(scene.placed, scene.eye, lit, sun, 9).start_in_volume(0, volume),
              Cover::out);
    inside += is_in(scene.eye.position) ? 1 : 0;
  }
  EXPECT_GT(inside, 20);
  EXPECT_LT(inside, 180);
}

}  // namespace
}  // namespace arris::test
