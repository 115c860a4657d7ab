// Edges of rounded solids in a picture: lines against rays, around corners where convex and concave edges meet.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "render/camera.h"
#include "render/edge_objects.h"
#include "render/prepared_scene.h"
#include "support/creased_solids.h"
#include "support/render_scenes.h"
#include "support/rounded_ray.h"

namespace arris::test {
namespace {

constexpr int kSize = 64;

Scene scene_of(const oracle::CreasedCase& c) {
  Camera camera;
  camera.position = {0, -9, 0};
  Scene scene = make_empty_scene(camera);
  Mesh mesh;
  mesh.name = c.mesh.name;
  mesh.positions = c.mesh.positions;
  mesh.triangles = c.mesh.triangles;
  Object& object = add_object(scene, std::move(mesh), make_lambert(0.5F));
  object.rounding.emplace();
  object.rounding->method = RoundMethod::exact;
  object.rounding->radius = c.radius;
  object.rounding->min_angle = radians(5);
  return scene;
}

// What is seen of a solid in a picture, and the edges that are found for it.
class Picture {
 public:
  Picture(const PreparedScene& scene, const EdgeObjects& objects, const Camera& camera)
      : scene_(scene) {
    ImageSettings image;
    image.width_px = image.height_px = kSize;
    rays_ = make_camera_rays(camera, image);
    view_ = {Vec3d(rays_.position), inverse(Mat3d{rays_.step_x, rays_.step_y, rays_.corner}), kSize,
             kSize};
    FoundEdges found;
    objects.find_edges(scene, view_, 1, found);
    for (const std::span<const WorldEdge> list : found.lists()) {
      edges_.insert(edges_.end(), list.begin(), list.end());
    }
  }

  struct Seen {
    std::optional<SurfaceHit> hit;
    double depth = std::numeric_limits<double>::infinity();
  };
  [[nodiscard]] Seen look(double x, double y) const {
    TraceRay ray;
    ray.origin = Vec3f(view_.eye);
    ray.direction = normalize(Vec3f(direction(x, y)));
    Seen seen{scene_.intersect(ray)};
    if (seen.hit) seen.depth = length(Vec3d(seen.hit->position) - view_.eye);
    return seen;
  }

  struct Jump {
    double x, y;
    double angle, gap;  // degrees; length
  };
  // Between neighbouring pixels, halved until it is in one place.
  [[nodiscard]] std::vector<Jump> find_jumps(double least_gap) const {
    std::vector<Jump> jumps;
    for (int j = 2; j < kSize - 2; ++j) {
      for (int i = 2; i < kSize - 2; ++i) {
        for (const bool down : {false, true}) {
          std::array<double, 2> p{i + 0.37, j + 0.41}, q = p;
          q[down ? 1 : 0] += 1;
          if (const auto jump = find_jump(p, q, least_gap)) jumps.push_back(*jump);
        }
      }
    }
    return jumps;
  }

  // In pixels.
  [[nodiscard]] double distance_to_edge(double x, double y) const {
    double best = std::numeric_limits<double>::infinity();
    for (const WorldEdge& e : edges_) {
      const ScreenEdge s = project_edge(view_, e);
      const double ax = s.x0 - x, ay = s.y0 - y;
      const double dx = s.x1 - x - ax, dy = s.y1 - y - ay;
      const double squared = dx * dx + dy * dy;
      const double t = squared > 0 ? std::clamp(-(ax * dx + ay * dy) / squared, 0.0, 1.0) : 0;
      best = std::min(best, std::hypot(ax + dx * t, ay + dy * t));
    }
    return best;
  }

  // Edges with nothing at them on either side: their middles.
  [[nodiscard]] std::vector<Vec3d> find_floating(double margin) const {
    std::vector<Vec3d> out;
    for (const WorldEdge& e : edges_) {
      const Vec3d a = project(view_, Vec3d(e.a)), b = project(view_, Vec3d(e.b));
      if (a.z <= 0 || b.z <= 0) continue;
      const double dx = b.x / b.z - a.x / a.z, dy = b.y / b.z - a.y / a.z;
      const double size = std::hypot(dx, dy);
      if (size < 1e-3) continue;
      for (const double part : {0.02, 0.5, 0.98}) {
        const Vec3d p = Vec3d(e.a) + (Vec3d(e.b) - Vec3d(e.a)) * part;
        const Vec3d at = project(view_, p);
        const double x = at.x / at.z, y = at.y / at.z;
        if (x < 0 || y < 0 || x > kSize || y > kSize) continue;
        const double off = 0.15 / size;
        const double depth = std::min(look(x - dy * off, y + dx * off).depth,
                                      look(x + dy * off, y - dx * off).depth);
        if (depth > length(p - view_.eye) + margin) out.push_back(p);
      }
    }
    return out;
  }

 private:
  [[nodiscard]] Vec3d direction(double x, double y) const {
    return rays_.corner + rays_.step_x * x + rays_.step_y * y;
  }
  static double angle_between(const Seen& a, const Seen& b) {
    if (!a.hit || !b.hit) return 0;
    const double c = dot(Vec3d(a.hit->geometric_normal), Vec3d(b.hit->geometric_normal));
    return degrees(std::acos(std::clamp(c, -1.0, 1.0)));
  }
  static double gap_between(const Seen& a, const Seen& b) {
    return a.hit || b.hit ? std::abs(a.depth - b.depth) : 0;
  }

  [[nodiscard]] std::optional<Jump> find_jump(std::array<double, 2> p, std::array<double, 2> q,
                                              double least_gap) const {
    constexpr double kLeastAngle = 20;
    Seen a = look(p[0], p[1]), b = look(q[0], q[1]);
    const auto jumps = [&](const Seen& s, const Seen& t) {
      return angle_between(s, t) > kLeastAngle || gap_between(s, t) > least_gap;
    };
    for (int k = 0; k < 13; ++k) {
      if (!jumps(a, b)) return std::nullopt;
      const std::array<double, 2> m{(p[0] + q[0]) / 2, (p[1] + q[1]) / 2};
      const Seen middle = look(m[0], m[1]);
      const double score_a = angle_between(a, middle) / 20 + gap_between(a, middle) / least_gap;
      const double score_b = angle_between(middle, b) / 20 + gap_between(middle, b) / least_gap;
      (score_a > score_b ? q : p) = m;
      (score_a > score_b ? b : a) = middle;
    }
    if (!jumps(a, b)) return std::nullopt;
    return Jump{p[0], p[1], angle_between(a, b), gap_between(a, b)};
  }

  const PreparedScene& scene_;
  CameraRays rays_{};
  PixelView view_;
  std::vector<WorldEdge> edges_;
};

Camera camera_at(oracle::Random& rng, Vec3d corner, double radius) {
  Camera camera;
  for (;;) {
    const Vec3d v{oracle::uniform(rng, -1, 1), oracle::uniform(rng, -1, 1),
                  oracle::uniform(rng, -1, 1)};
    const double l = length(v);
    if (l < 0.1 || l > 1) continue;
    camera.position = corner + v * (20 * radius / l);
    camera.target = corner;
    camera.up = std::abs(v.z) < 0.9 * l ? Vec3d(0, 0, 1) : Vec3d(1, 0, 0);
    camera.fov_deg = 16;
    return camera;
  }
}

bool is_inside(const oracle::CreasedCase& c, Vec3d eye) {
  const Vec3d any{0.341, 0.527, 0.778};
  return oracle::intersect_mesh({eye, any}, c.mesh.view()).size() % 2 == 1;
}

// rules_of: what a solid's edges have for radii, but the case's own.
template <class RulesOf>
void expect_edges_at_jumps(const RulesOf& rules_of) {
  oracle::Random rng(21);
  std::size_t jumps = 0, missed = 0, floating = 0;
  std::string examples;
  for (const oracle::CreasedCase& c : oracle::make_creased_cases()) {
    Scene unprepared = scene_of(c);
    unprepared.objects[0].rounding->rules = rules_of(c);
    const auto scene = prepare_scene(std::move(unprepared));
    const EdgeObjects objects(*scene, 1);
    std::size_t of_case = 0, of_case_missed = 0, of_case_floating = 0;
    for (int i = 0; i < 12; ++i) {
      const auto& positions = c.mesh.positions;
      const Vec3d corner(
          positions[std::size_t(oracle::uniform_int(rng, 0, int(positions.size()) - 1))]);
      const Camera camera = camera_at(rng, corner, c.radius);
      const Picture picture(*scene, objects, camera);
      if (!picture.look(kSize / 2.0, kSize / 2.0).hit || is_inside(c, camera.position)) continue;
      for (const Picture::Jump& jump : picture.find_jumps(0.3 * c.radius)) {
        ++of_case;
        const double distance = picture.distance_to_edge(jump.x, jump.y);
        if (distance < 0.2) continue;
        ++of_case_missed;
        if (of_case_missed < 6) {
          const auto seen = picture.look(jump.x, jump.y);
          auto near = seen;
          for (const double off : {0.02, -0.02}) {
            if (!near.hit) near = picture.look(jump.x + off, jump.y + off);
            if (!near.hit) near = picture.look(jump.x + off, jump.y - off);
          }
          const Vec3d p = near.hit ? Vec3d(near.hit->position) : Vec3d();
          examples += fmt::format(
              "{} view {}: at {:.1f} {:.1f} ({:.4f}, {:.4f}, {:.4f}) turn {:.0f} gap {:.2g} r, "
              "edge "
              "{:.2g} pixels away\n",
              c.mesh.name, i, jump.x, jump.y, p.x, p.y, p.z, jump.angle, jump.gap / c.radius,
              distance);
        }
      }
      for (const Vec3d p : picture.find_floating(0.5 * c.radius)) {
        ++of_case_floating;
        if (of_case_floating < 4) {
          examples += fmt::format("{} view {}: floats at ({:.4f}, {:.4f}, {:.4f})\n", c.mesh.name,
                                  i, p.x, p.y, p.z);
        }
      }
    }
    jumps += of_case;
    missed += of_case_missed;
    floating += of_case_floating;
    examples += fmt::format("{}: {} jumps, {} missed, {} float\n", c.mesh.name, of_case,
                            of_case_missed, of_case_floating);
  }
  EXPECT_GT(jumps, 2000U);
  EXPECT_EQ(missed, 0U) << examples;
  EXPECT_EQ(floating, 0U) << examples;
}

TEST(RoundedOutline, every_jump_of_a_picture_of_mixed_corners_is_an_edge) {
  expect_edges_at_jumps([](const oracle::CreasedCase&) { return std::vector<EdgeRule>(); });
}

TEST(RoundedOutline, every_jump_is_an_edge_where_edges_have_radii_of_their_own) {
  oracle::Random rng(4);
  expect_edges_at_jumps([&](const oracle::CreasedCase& c) {
    std::vector<EdgeRule> rules;
    for (const double part : {0.0, 0.5, 1.2}) {
      const auto& positions = c.mesh.positions;
      const Vec3d corner(
          positions[std::size_t(oracle::uniform_int(rng, 0, int(positions.size()) - 1))]);
      EdgeRule rule;
      rule.radius = part;
      rule.is_part = true;
      rule.box = {corner - Vec3d(1.1), corner + Vec3d(1.1)};
      rules.push_back(rule);
    }
    return rules;
  });
}

}  // namespace
}  // namespace arris::test
