// face_bounds.h — interval vectors of the normals and positions of some faces, and how a viewpoint sees them
// What       FaceBounds holds what the nodes of edge and face trees hold; signs_in() bounds
//            normal · (viewpoint − w position) over one: positive where a face faces the viewpoint
// In / Out   UnitFrame: positions relative to the mesh's centre and half size, so within ±1; normals unit; viewpoints
//            scaled so that no coordinate and no w is above 1
// Guarantee  with kSignMargin to either side the bounds hold for every face within, though all is stored and computed
//            in float, rounded to nearest: of u = 2⁻²⁴ relative to each number, positions, viewpoints, w, their product
//            and difference (at most 2) lose 6u a component, normals 2u, products 2u, the sums of three 10u; components
//            of a normal interval are at most 1: 3·(6 + 2 + 2)u + 10u = 40u in all. Planes: less.
// Source     Bala, Walter, Greenberg 2003, section 6.4; R. E. Moore, "Interval Analysis", 1966
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "edgepoint/edge_mesh.h"

namespace arris {

inline constexpr float kSignMargin = 64.0F / (1 << 24);

struct UnitFrame {
  Vec3d center;
  double half_size = 1;

  [[nodiscard]] Vec3d unit_from_object(Vec3d p) const { return (p - center) / half_size; }
};

inline UnitFrame unit_frame(const EdgeMesh& mesh) {
  const double half = max_component(mesh.bounds_max - mesh.bounds_min) / 2;
  return {(mesh.bounds_min + mesh.bounds_max) * 0.5, half > 0 ? half : 1};
}

// Minima of normal and position, then of the same negated: a union is twelve minima.
struct FaceBounds {
  std::array<float, 12> low;

  static FaceBounds empty() {
    FaceBounds b;
    b.low.fill(std::numeric_limits<float>::infinity());
    return b;
  }
  void grow(const FaceBounds& other) {
    for (std::size_t i = 0; i < 12; ++i) low[i] = std::min(low[i], other.low[i]);
  }
  // Axes 0 to 2 of the normal, 3 to 5 of the position.
  [[nodiscard]] float width(std::size_t axis) const { return -low[axis + 6] - low[axis]; }
  [[nodiscard]] float twice_middle(std::size_t axis) const { return low[axis] - low[axis + 6]; }

  void grow_normal(Vec3d n) { grow_at(0, n); }
  void grow_position(Vec3d p) { grow_at(3, p); }

 private:
  void grow_at(std::size_t first, Vec3d v) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto x = float(v[int(k)]);
      low[first + k] = std::min(low[first + k], x);
      low[first + k + 6] = std::min(low[first + k + 6], -x);
    }
  }
};

// A viewpoint in a UnitFrame.
struct UnitView {
  std::array<float, 3> xyz;
  float w;
};

inline std::vector<UnitView> unit_views(const UnitFrame& frame,
                                        std::span<const HomogeneousPoint> from) {
  const auto local = [&](const HomogeneousPoint& p) {
    return (p.xyz - frame.center * p.w) / frame.half_size;
  };
  double size = 0;
  for (const HomogeneousPoint& p : from) {
    const Vec3d v = local(p);
    size = std::max({size, std::abs(v.x), std::abs(v.y), std::abs(v.z), p.w});
  }
  if (!(size > 0)) size = 1;
  std::vector<UnitView> views;
  for (const HomogeneousPoint& p : from) {
    const Vec3d v = local(p) / size;
    views.push_back({{float(v.x), float(v.y), float(v.z)}, float(p.w / size)});
  }
  return views;
}

// The box of some viewpoints.
struct UnitViewBounds {
  std::array<float, 3> low, high;
  float w_low, w_high;
};

// Precondition: views is not empty.
inline UnitViewBounds bounds_of(std::span<const UnitView> views) {
  UnitViewBounds b{views[0].xyz, views[0].xyz, views[0].w, views[0].w};
  for (const UnitView& v : views) {
    for (std::size_t k = 0; k < 3; ++k) {
      b.low[k] = std::min(b.low[k], v.xyz[k]);
      b.high[k] = std::max(b.high[k], v.xyz[k]);
    }
    b.w_low = std::min(b.w_low, v.w);
    b.w_high = std::max(b.w_high, v.w);
  }
  return b;
}

struct SignBounds {
  float low, high;
};

inline SignBounds signs_in(const FaceBounds& faces, const UnitViewBounds& v) {
  SignBounds s{0, 0};
  for (std::size_t k = 0; k < 3; ++k) {
    const float n0 = faces.low[k], n1 = -faces.low[k + 6];
    const float p0 = faces.low[k + 3], p1 = -faces.low[k + 9];
    const float d0 = v.low[k] - std::max(v.w_low * p1, v.w_high * p1);
    const float d1 = v.high[k] - std::min(v.w_low * p0, v.w_high * p0);
    const float a = n0 * d0, b = n0 * d1, c = n1 * d0, d = n1 * d1;
    s.low += std::min(std::min(a, b), std::min(c, d));
    s.high += std::max(std::max(a, b), std::max(c, d));
  }
  return s;
}

}  // namespace arris
