// shadow_scene.h — a few solids on a floor, and rays that say who sees the light
// What       ShadowScene holds meshes with their trees, finds all shadow edges of all of them, and casts rays by brute
//            force
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "edgepoint/finder_meshes.h"
#include "edgepoint/shadow_edges.h"

namespace arris::test {

inline Mat3d random_turn(FinderRandom& random) {
  const Vec3d x = normalize(random_point(random, 1));
  const Vec3d y = normalize(cross(x, random_point(random, 1)));
  return {x, y, cross(x, y)};
}

struct ShadowObject {
  EdgeMesh mesh;
  EdgeTree edges;
  FaceTree faces;
  Affine3d world_from_object;
  std::vector<std::array<Vec3d, 3>> world;  // triangles

  ShadowObject(EdgeMesh m, const Affine3d& to_world)
      : mesh(std::move(m)), edges(mesh), faces(mesh), world_from_object(to_world) {
    for (const Triangle& t : mesh.triangles) {
      std::array<Vec3d, 3> corners;
      for (std::size_t k = 0; k < 3; ++k) {
        corners[k] = transform_point(to_world, Vec3d(mesh.vertices[t[k]]));
      }
      world.push_back(corners);
    }
  }
  ShadowObject(const ShadowObject&) = delete;
};

// Where along origin + t direction, 0 < t, the triangle is met.
inline std::optional<double> hit(const std::array<Vec3d, 3>& triangle, Vec3d origin,
                                 Vec3d direction) {
  const Vec3d e1 = triangle[1] - triangle[0], e2 = triangle[2] - triangle[0];
  const Vec3d p = cross(direction, e2);
  const double det = dot(e1, p);
  if (det == 0) return std::nullopt;
  const Vec3d s = origin - triangle[0], q = cross(s, e1);
  const double u = dot(s, p) / det, v = dot(direction, q) / det, t = dot(e2, q) / det;
  if (u < 0 || v < 0 || u + v > 1 || t <= 0) return std::nullopt;
  return t;
}

inline std::vector<ShadowEdge> trace_events(std::vector<ShadowEvent> events,
                                            std::span<const ShadowReceiver> receivers) {
  TracedEvents traced(std::move(events));
  traced.add(receivers, receivers);
  return traced.edges();
}

struct ShadowScene {
  std::vector<std::unique_ptr<ShadowObject>> objects;

  void add(const Mesh& mesh, const Affine3d& world_from_object = {}) {
    objects.push_back(std::make_unique<ShadowObject>(edges_of(mesh), world_from_object));
  }
  // All objects as receivers of the blocker's shadow.
  [[nodiscard]] std::vector<ShadowReceiver> receivers(std::size_t blocker) const {
    std::vector<ShadowReceiver> out;
    for (std::size_t i = 0; i < objects.size(); ++i) {
      out.push_back(
          {std::uint32_t(i), &objects[i]->faces, objects[i]->world_from_object, i == blocker});
    }
    return out;
  }
  template <class Light>
  [[nodiscard]] std::vector<ShadowEdge> shadow_edges(std::size_t blocker,
                                                     const Light& light) const {
    const ShadowObject& b = *objects[blocker];
    const std::vector<ShadowEvent> events =
        find_shadow_events(b.edges, transform(inverse(b.world_from_object), light));
    return trace_events(transform(b.world_from_object, events), receivers(blocker));
  }
  template <class Light>
  [[nodiscard]] std::vector<ShadowEdge> all_shadow_edges(const Light& light) const {
    std::vector<ShadowEdge> all;
    for (std::size_t i = 0; i < objects.size(); ++i) {
      const std::vector<ShadowEdge> some = shadow_edges(i, light);
      all.insert(all.end(), some.begin(), some.end());
    }
    return all;
  }
  // Whether nothing lies between; a point on a surface must be moved off it.
  [[nodiscard]] bool sees(Vec3d from, const HomogeneousPoint& light) const {
    const Vec3d d = light.w == 0 ? light.xyz : light.xyz / light.w - from;
    for (const auto& object : objects) {
      for (const std::array<Vec3d, 3>& t : object->world) {
        const std::optional<double> at = hit(t, from, d);
        if (at && (light.w == 0 || *at < 1)) return false;
      }
    }
    return true;
  }
};

inline double distance_to_segment(Vec3d p, Vec3d a, Vec3d b) {
  const Vec3d d = b - a;
  const double l2 = length_squared(d);
  const double t = l2 > 0 ? std::clamp(dot(p - a, d) / l2, 0.0, 1.0) : 0;
  return length(p - (a + d * t));
}

inline double distance_to_edges(Vec3d p, std::span<const ShadowEdge> edges, std::size_t receiver) {
  double best = std::numeric_limits<double>::infinity();
  for (const ShadowEdge& e : edges) {
    if (e.receiver == receiver) {
      best = std::min(best, distance_to_segment(p, Vec3d(e.a), Vec3d(e.b)));
    }
  }
  return best;
}

// A floor and some boxes, balls and tori above it. Solids that reach into each other would show changes of visibility
// where one's surface enters the other, which nobody sees: none do.
enum class Solids { apart, anywhere };

inline ShadowScene random_shadow_scene(FinderRandom& random, Solids solids = Solids::apart) {
  ShadowScene scene;
  scene.add(make_box_mesh({12, 12, 1}), {{}, {0, 0, -0.5}});
  struct Ball {
    Vec3d center;
    double radius;
  };
  std::vector<Ball> taken;
  const auto count = 2 + random() % 4;
  while (taken.size() < count) {
    const double size = uniform(random, 0.3, 1.2);
    Affine3d to_world{random_turn(random), random_point(random, 2)};
    to_world.translation.z = uniform(random, 2, 6);
    const Ball ball{to_world.translation, 1.5 * size};
    const bool overlaps = std::ranges::any_of(taken, [&](const Ball& b) {
      return length(b.center - ball.center) < b.radius + ball.radius;
    });
    if (overlaps && solids == Solids::apart) continue;
    if (taken.size() % 2 == 1) to_world.linear.x = -to_world.linear.x;  // mirrored
    taken.push_back(ball);
    scene.add(std::array{make_box_mesh({size, size * 0.7, size * 1.3}), make_icosahedron_mesh(size),
                         make_torus_mesh(size, 0.4 * size, 12, 8)}[random() % 3],
              to_world);
  }
  return scene;
}

}  // namespace arris::test
