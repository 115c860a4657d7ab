// beam_truth.h — what rays see, sample by sample, and random scenes of supported leaves
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "beam/beam_tracer.h"
#include "beam/ray_sight.h"
#include "support/csg_oracle.h"

namespace arris::test {

// Solid, leaf, face, entering; nothing: (-1, 0, 0, false).
using SeenKey = std::tuple<int, std::uint32_t, std::uint32_t, bool>;

inline SeenKey key_of(const std::optional<SeenSurface>& seen) {
  return seen ? SeenKey{int(seen->solid), seen->leaf, seen->face, seen->entering}
              : SeenKey{-1, 0, 0, false};
}

struct BeamScene {
  std::deque<BeamShape> shapes;
  std::vector<BeamSolid> placed;
  EyeRays eye;
  int width = 16, height = 16;

  // Of a CsgTree or of triangles.
  template <class Described>
  void add(const Described& described, const Affine3d& world_from_object = {}) {
    placed.push_back({&shapes.emplace_back(described), inverse(world_from_object)});
  }
};

inline EyeRays look_at(Vec3d from, Vec3d to, double fov_deg, int width, int height) {
  const Vec3d f = normalize(to - from), right = normalize(cross(f, Vec3d(0.1, 0.2, 1)));
  const double pixel = 2 * std::tan(radians(fov_deg) / 2) / height;
  EyeRays eye;
  eye.position = from;
  eye.step_x = right * pixel;
  eye.step_y = cross(f, right) * pixel;
  eye.corner = f - eye.step_x * (width / 2.0) - eye.step_y * (height / 2.0);
  return eye;
}

// The first surface along the ray through a picture point.
inline std::optional<RaySight> see(const BeamScene& scene, double x, double y) {
  std::vector<BeamPart> roots;
  for (std::uint32_t i = 0; i < scene.placed.size(); ++i) {
    roots.push_back({i, scene.placed[i].shape->root()});
  }
  return see(scene.placed, roots, ray_through(scene.eye, {x, y}));
}
inline SeenKey key_at(const BeamScene& scene, double x, double y) {
  const std::optional<RaySight> sight = see(scene, x, y);
  return key_of(sight ? std::optional(sight->seen) : std::nullopt);
}

// Spheres, boxes, cylinders, cones, convex polyhedra, half-spaces.
inline CsgPrimitive random_convex(CsgRandom& random) {
  constexpr int kKinds[] = {0, 1, 2, 2, 4, 10};
  return random_primitive(random, kKinds[random() % 6]);
}

// As random_tree(), of convex leaves.
inline CsgTree random_convex_tree(CsgRandom& random, int depth) {
  CsgTree tree = random_tree(random, depth);
  for (std::size_t i = 1; i < tree.leaves.size(); ++i) {
    tree.leaves[i].primitive = random_convex(random);
  }
  return tree;
}

}  // namespace arris::test
