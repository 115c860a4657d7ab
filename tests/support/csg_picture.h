// csg_picture.h — where in a picture of a solid of solids something changes, by dense rays; and how near edges are
// What       CsgPicture casts rays in double through a square picture; find_jumps() bisects between neighbouring pixels
//            until what changes there is found to 1/4096 of a pixel; distance_to() measures edges against it
// Legend     pixels: x to the right, y down, the picture's middle at (0, 0)
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "csg/csg_solid.h"
#include "render/csg_edges.h"

namespace arris::test {

struct CsgSight {
  bool hit = false;
  double depth = 0;
  Vec3d normal;
  std::uint32_t material = 0;
};

struct CsgJump {
  double x = 0, y = 0, depth = 0;  // depth: of the nearer side
};

class CsgPicture {
 public:
  CsgPicture(const CsgSolid& solid, Vec3d eye, Vec3d target, double width, int pixels)
      : solid_(solid), view_(view_of(solid.root())), eye_(eye), pixels_(pixels) {
    forward_ = normalize(target - eye);
    const double step = width / pixels / length(target - eye);
    right_ = normalize(cross(forward_, Vec3d(0.1, 0.2, 0.9))) * step;
    down_ = normalize(cross(forward_, right_)) * step;
  }

  [[nodiscard]] CsgSight look(double x, double y) {
    const Ray ray{eye_, forward_ + right_ * x + down_ * y};
    for (const CsgBoundary& b : search_.find(solid_, view_, ray)) {
      if (b.t <= 0) continue;
      return {true, b.t, solid_.outward_normal(b, ray), solid_.leaf(b.leaf).material.index};
    }
    return {};
  }
  // Turns above `turn`, steps of depth above `step` of it.
  [[nodiscard]] static bool differs(const CsgSight& a, const CsgSight& b, double turn,
                                    double step) {
    if (a.hit != b.hit) return true;
    if (!a.hit) return false;
    return a.material != b.material || dot(a.normal, b.normal) < std::cos(turn) ||
           std::abs(a.depth - b.depth) > step * std::min(a.depth, b.depth);
  }

  [[nodiscard]] std::vector<CsgJump> find_jumps(double turn) {
    std::vector<CsgJump> jumps;
    const double half = pixels_ / 2.0;
    std::vector<CsgSight> row, above;
    for (int j = 0; j < pixels_; ++j) {
      row.clear();
      for (int i = 0; i < pixels_; ++i) row.push_back(look(i - half, j - half));
      for (std::size_t i = 0; i < row.size(); ++i) {
        const double x = double(i) - half, y = j - half;
        if (i > 0) add_jump(x - 1, y, row[i - 1], x, y, row[i], turn, jumps);
        if (j > 0) add_jump(x, y - 1, above[i], x, y, row[i], turn, jumps);
      }
      above = row;
    }
    return jumps;
  }

  // In pixels, of segments that are as deep as the jump or nearer; segments must be in front of the eye.
  struct Projected {
    double x0, y0, z0, x1, y1, z1;
  };
  [[nodiscard]] std::vector<Projected> project(std::span<const CsgEdges::Segment> edges) const {
    std::vector<Projected> out;
    for (const CsgEdges::Segment& e : edges) {
      const Vec3d a = place(e.a), b = place(e.b);
      if (a.z > 0 && b.z > 0) out.push_back({a.x, a.y, a.z, b.x, b.y, b.z});
    }
    return out;
  }
  [[nodiscard]] static double distance_to(std::span<const Projected> edges, const CsgJump& jump) {
    double best = std::numeric_limits<double>::infinity();
    for (const Projected& e : edges) {
      const double dx = e.x1 - e.x0, dy = e.y1 - e.y0, squared = dx * dx + dy * dy;
      const double t =
          squared > 0
              ? std::clamp(((jump.x - e.x0) * dx + (jump.y - e.y0) * dy) / squared, 0.0, 1.0)
              : 0;
      const double z = 1 / (1 / e.z0 + (1 / e.z1 - 1 / e.z0) * t);
      if (std::abs(z - jump.depth) > 0.02 * jump.depth) continue;
      best = std::min(best, std::hypot(jump.x - e.x0 - dx * t, jump.y - e.y0 - dy * t));
    }
    return best;
  }
  // x, y in pixels; z: depth as CsgSight's
  [[nodiscard]] Vec3d place(Vec3d p) const {
    const Vec3d d = p - eye_;
    const double z = dot(d, forward_);
    return {dot(d, right_) / (dot(right_, right_) * z), dot(d, down_) / (dot(down_, down_) * z), z};
  }
  [[nodiscard]] int pixels() const { return pixels_; }
  [[nodiscard]] Vec3d point(double x, double y, double depth) const {
    return eye_ + (forward_ + right_ * x + down_ * y) * depth;
  }

 private:
  static double size_of(const CsgSight& a, const CsgSight& b) {
    if (a.hit != b.hit) return 1e9;
    if (!a.hit) return 0;
    return length(a.normal - b.normal) + 30 * std::abs(a.depth - b.depth) +
           (a.material != b.material ? 10 : 0);
  }
  void add_jump(double x0, double y0, CsgSight a, double x1, double y1, CsgSight b, double turn,
                std::vector<CsgJump>& jumps) {
    if (!differs(a, b, turn / 2, 1e-3)) return;
    for (int i = 0; i < 12; ++i) {
      const double x = (x0 + x1) / 2, y = (y0 + y1) / 2;
      const CsgSight middle = look(x, y);
      if (size_of(a, middle) > size_of(middle, b)) {
        b = middle;
        x1 = x;
        y1 = y;
      } else {
        a = middle;
        x0 = x;
        y0 = y;
      }
    }
    if (!differs(a, b, turn, 2e-3)) return;
    const double depth = !a.hit ? b.depth : !b.hit ? a.depth : std::min(a.depth, b.depth);
    jumps.push_back({x1, y1, depth});
  }

  const CsgSolid& solid_;
  CsgExpressionView view_;
  Vec3d eye_, forward_, right_, down_;
  int pixels_;
  BoundarySearch search_;
};

}  // namespace arris::test
