#include "render/crowded_arcs.h"

#include <algorithm>
#include <cmath>

namespace arris {
namespace {

// Solids that touch don't reach into each other; relative to the smaller one's size.
constexpr double kTouching = 1e-4;

struct SolidBox {
  Vec3d low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};
  std::uint32_t geometry = 0;
  std::uint32_t solid = 0;  // of a rounded geometry

  void include(Vec3d p) {
    low = min(low, p);
    high = max(high, p);
  }
};

double slack_of(const SolidBox& a, const SolidBox& b) {
  return kTouching * std::min(length(a.high - a.low), length(b.high - b.low));
}

bool overlap(const SolidBox& a, const SolidBox& b) {
  const double slack = slack_of(a, b);
  for (int axis = 0; axis < 3; ++axis) {
    if (a.high[axis] <= b.low[axis] + slack || b.high[axis] <= a.low[axis] + slack) return false;
  }
  return true;
}

class CrowdFinder {
 public:
  CrowdFinder(const SceneGeometry& geometry, SceneRounding& rounding)
      : geometry_(geometry), out_(rounding) {
    out_.crowded.resize(out_.geometries.size());
  }

  void find() {
    collect_boxes();
    std::ranges::sort(boxes_, [](const SolidBox& a, const SolidBox& b) {
      return a.low.x != b.low.x ? a.low.x < b.low.x
                                : std::pair(a.geometry, a.solid) < std::pair(b.geometry, b.solid);
    });
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      for (std::size_t j = i + 1; j < boxes_.size() && boxes_[j].low.x < boxes_[i].high.x; ++j) {
        if (!overlap(boxes_[i], boxes_[j])) continue;
        look(boxes_[i], boxes_[j]);
        look(boxes_[j], boxes_[i]);
      }
    }
    for (std::size_t i = 0; i < out_.geometries.size(); ++i) {
      out_.geometries[i].crowded = out_.crowded[i].get();
    }
  }

 private:
  void collect_boxes() {
    for (std::uint32_t i = 0; i < out_.geometries.size(); ++i) {
      const GeometryRecord& record = geometry_.embree.records()[i];
      if (record.triangles == nullptr) continue;
      const Rounding* rounding = out_.geometries[i].rounding;
      const std::size_t first = boxes_.size();
      const std::size_t count = rounding != nullptr ? rounding->data().solids.size() : 1;
      boxes_.resize(first + count);
      for (std::uint32_t s = 0; s < count; ++s) {
        boxes_[first + s].geometry = i;
        boxes_[first + s].solid = s;
      }
      for (std::uint32_t t = 0; t < record.triangle_count; ++t) {
        const std::uint32_t solid = rounding != nullptr ? rounding->solid_of(t) : 0;
        if (solid == kNone) continue;
        const WorldTriangle w = world_triangle(geometry_.scene, record, t);
        for (const Vec3f& p : {w.p0, w.p1, w.p2}) boxes_[first + solid].include(Vec3d(p));
      }
    }
  }

  // Marks the arcs of a's solid into whose void b's box reaches.
  void look(const SolidBox& a, const SolidBox& b) {
    const RoundedGeometry& g = out_.geometries[a.geometry];
    if (g.rounding == nullptr) return;
    const Rounding::Data& data = g.rounding->data();
    const Solid& solid = data.solids[a.solid];
    std::unique_ptr<std::vector<bool>>& flags = out_.crowded[a.geometry];
    for (std::uint32_t i = solid.first_arc; i < solid.first_arc + solid.arc_count; ++i) {
      if (data.arcs[i].is_stub() || (flags && (*flags)[i])) continue;
      if (is_separated(g, data.arcs[i], b, slack_of(a, b))) continue;
      if (!flags) flags = std::make_unique<std::vector<bool>>(data.arcs.size(), false);
      (*flags)[i] = true;
    }
  }

  // The void of an arc lies under its two faces, less than r / sin α from the axis, and between its ends, where
  // corners reach no farther than that either.
  [[nodiscard]] bool is_separated(const RoundedGeometry& g, const Arc& arc, const SolidBox& box,
                                  double slack) const {
    const Rounding::Data& data = g.rounding->data();
    const Face& a = data.faces[arc.face_a];
    const Face& b = data.faces[arc.face_b];
    const Vec3d center = data.solids[a.solid].center;
    const Vec3d sum(a.normal + b.normal);
    const double sin_alpha = std::max(0.05, length(sum) / 2);
    const double reach = data.radius / sin_alpha;
    const Vec3d axis(arc.line.axis);
    double least_a = INFINITY, least_b = INFINITY, most_both = -INFINITY;
    double low = INFINITY, high = -INFINITY;
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3d world((corner & 1) != 0 ? box.high.x : box.low.x,
                        (corner & 2) != 0 ? box.high.y : box.low.y,
                        (corner & 4) != 0 ? box.high.z : box.low.z);
      const Vec3d local =
          g.frame == nullptr ? world : transform_point(g.frame->rounding_from_world, world);
      const Vec3d x = local - center;
      least_a = std::min(least_a, dot(Vec3d(a.normal), x));
      least_b = std::min(least_b, dot(Vec3d(b.normal), x));
      most_both = std::max(most_both, dot(sum, x));
      const double along = dot(axis, x - Vec3d(arc.line.p0));
      low = std::min(low, along);
      high = std::max(high, along);
    }
    // Beyond a face; behind the plane through the touching lines; beyond an end.
    const double chord = a.d + b.d - data.radius * (1 - dot(Vec3d(a.normal), Vec3d(b.normal)));
    return least_a >= a.d - slack || least_b >= b.d - slack || most_both <= chord + slack ||
           high <= -reach || low >= double(arc.line.length) + reach;
  }

  const SceneGeometry& geometry_;
  SceneRounding& out_;
  std::vector<SolidBox> boxes_;
};

}  // namespace

void find_crowded_arcs(const SceneGeometry& geometry, SceneRounding& rounding) {
  CrowdFinder(geometry, rounding).find();
}

}  // namespace arris
