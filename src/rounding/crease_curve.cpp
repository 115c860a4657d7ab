#include "rounding/crease_curve.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace arris {
namespace {

// Sine below which two directions count as parallel.
constexpr double kParallel = 1e-7;

CreaseCurve line(Vec3d point, Vec3d direction, double extent) {
  return {point, direction, {}, true, -extent, extent};
}

// The ellipse in which a plane through a point of a cylinder's axis cuts it.
CreaseCurve cut_cylinder(Vec3d center, Vec3d axis, Vec3d normal, double radius) {
  const Vec3d across = cross(axis, normal);
  if (!(length(across) > kParallel)) return crease_circle(center, normal, radius);
  const Vec3d minor = normalize(across);
  const Vec3d major = cross(normal, minor);
  return {center, minor * radius, major * (radius / std::abs(dot(axis, normal))), false,
          0,      2 * kPi};
}

}  // namespace

CreaseCurve crease_circle(Vec3d center, Vec3d normal, double radius) {
  const Vec3d any = std::abs(normal.x) < 0.6 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0);
  const Vec3d a = normalize(cross(normal, any));
  return {center, a * radius, cross(normal, a) * radius, false, 0, 2 * kPi};
}

Vec3d CreaseCurve::at(double u) const {
  return is_line ? center + a * u : center + a * std::cos(u) + b * std::sin(u);
}

Vec3d CreaseCurve::derivative(double u) const {
  return is_line ? a : b * std::cos(u) - a * std::sin(u);
}

void add_crossings(const CreaseCurve& curve, Vec3d normal, double alpha,
                   std::vector<double>& roots) {
  const auto add = [&](double u) {
    if (u > curve.u0 && u < curve.u1) roots.push_back(u);
  };
  const double constant = alpha + dot(normal, curve.center);
  const double p = dot(normal, curve.a);
  if (curve.is_line) {
    if (p != 0) add(-constant / p);
    return;
  }
  // constant + p cos u + q sin u = constant + s cos(u − φ)
  const double q = dot(normal, curve.b);
  const double s = std::hypot(p, q);
  if (!(s > std::abs(constant))) return;
  const double phase = std::atan2(q, p), half = std::acos(-constant / s);
  for (const double u : {phase - half, phase + half}) {
    for (const double turn : {-2 * kPi, 0.0, 2 * kPi}) add(u + turn);
  }
}

double nearest_parameter(const CreaseCurve& curve, Vec3d x) {
  const Vec3d offset = x - curve.center;
  if (curve.is_line) {
    const double u = dot(offset, curve.a) / length_squared(curve.a);
    return std::clamp(u, curve.u0, curve.u1);
  }
  const double p = dot(offset, curve.a), q = dot(offset, curve.b);
  const double aa = length_squared(curve.a), bb = length_squared(curve.b);
  const auto distance_squared = [&](double u) { return length_squared(curve.at(u) - x); };
  // Half the derivative of the squared distance: (bb − aa) sin u cos u + p sin u − q cos u.
  const auto slope = [&](double u) {
    const double c = std::cos(u), s = std::sin(u);
    return (bb - aa) * s * c + p * s - q * c;
  };
  // A minimum lies where the slope turns from negative to positive; there are two at most.
  const int steps = std::max(1, int(std::ceil((curve.u1 - curve.u0) / radians(30))));
  const double step = (curve.u1 - curve.u0) / steps;
  double best = curve.u0, least = distance_squared(curve.u0);
  const auto take = [&](double u) {
    const double d = distance_squared(u);
    if (d >= least) return;
    least = d;
    best = u;
  };
  take(curve.u1);
  double before = slope(curve.u0);
  for (int i = 1; i <= steps; ++i) {
    double high = curve.u0 + step * i, low = high - step;
    const double after = slope(high);
    if (before < 0 && after >= 0) {
      double at_low = before, at_high = after;
      // Regula falsi with halving (Illinois).
      for (int k = 0; k < 40 && high - low > 1e-14; ++k) {
        const double u = low + (high - low) * (at_low / (at_low - at_high));
        const double f = slope(u);
        if (f == 0) {
          low = high = u;
        } else if (f < 0) {
          low = u;
          at_low = f;
          at_high *= 0.5;
        } else {
          high = u;
          at_high = f;
          at_low *= 0.5;
        }
        if (std::abs(f) < 1e-15 * (aa + bb)) break;
      }
      take(std::abs(slope(low)) < std::abs(slope(high)) ? low : high);
    }
    before = after;
  }
  return best;
}

// Of an arc by Newton's method from the angle about its centre.
double distance_to_balls(const CreaseCurve& part, Vec3d x) {
  if (part.is_line) {
    double u = dot(x - part.center, part.a) / length_squared(part.a);
    const double growth = part.growth();
    if (growth != 0) u = nearest_ball(u, length(x - part.at(u)), growth);
    u = std::clamp(u, part.u0, part.u1);
    return length(x - part.at(u)) - part.radius_at(u);
  }
  const Vec3d offset = x - part.center;
  const double p = dot(offset, part.a), q = dot(offset, part.b);
  const double aa = length_squared(part.a), bb = length_squared(part.b);
  const double middle = 0.5 * (part.u0 + part.u1);
  double u = std::atan2(q / bb, p / aa);
  u = std::clamp(u + 2 * kPi * std::round((middle - u) / (2 * kPi)), part.u0, part.u1);
  for (int i = 0; i < 3; ++i) {
    const double c = std::cos(u), s = std::sin(u);
    const double slope = (bb - aa) * s * c + p * s - q * c;
    const double bend = (bb - aa) * (c * c - s * s) + p * c + q * s;
    if (!(bend > 0)) break;
    const double before = u;
    u = std::clamp(u - slope / bend, part.u0, part.u1);
    if (std::abs(u - before) < 1e-7) break;
  }
  return length(x - part.at(u)) - part.r0;
}

std::optional<CreaseCurve> face_face_crease(const Plane& a, const Plane& b, double radius,
                                            Vec3d near, double extent) {
  const Vec3d direction = cross(a.normal, b.normal);
  const double squared = length_squared(direction);
  if (!(squared > kParallel * kParallel)) return std::nullopt;
  // The point of both offset planes that is nearest to `near`.
  const double above_a = a.d - radius - dot(a.normal, near);
  const double above_b = b.d - radius - dot(b.normal, near);
  const double c = dot(a.normal, b.normal);
  const Vec3d point = near + a.normal * ((above_a - c * above_b) / squared) +
                      b.normal * ((above_b - c * above_a) / squared);
  return line(point, direction / std::sqrt(squared), extent);
}

std::vector<CreaseCurve> face_edge_creases(const Plane& face, const EdgeLine& edge, double radius,
                                           double extent) {
  const double approach = dot(face.normal, edge.direction);
  const double under = face.d - radius - dot(face.normal, edge.point);  // of the offset plane
  if (std::abs(approach) > kParallel) {
    return {cut_cylinder(edge.point + edge.direction * (under / approach), edge.direction,
                         face.normal, radius)};
  }
  if (!(std::abs(under) < radius)) return {};
  const Vec3d foot = edge.point + face.normal * under;
  const Vec3d across =
      normalize(cross(face.normal, edge.direction)) * std::sqrt(radius * radius - under * under);
  return {line(foot + across, edge.direction, extent), line(foot - across, edge.direction, extent)};
}

std::vector<CreaseCurve> edge_edge_creases(Vec3d corner, Vec3d direction0, Vec3d direction1,
                                           double radius) {
  std::vector<CreaseCurve> curves;
  for (const Vec3d normal : {direction0 - direction1, direction0 + direction1}) {
    if (!(length(normal) > kParallel)) continue;
    const Vec3d unit = normalize(normal);
    if (std::abs(dot(direction0, unit)) < kParallel) continue;
    curves.push_back(cut_cylinder(corner, direction0, unit, radius));
  }
  return curves;
}

std::optional<CreaseCurve> face_corner_crease(const Plane& face, Vec3d corner, double radius) {
  const double under = face.d - radius - dot(face.normal, corner);
  if (!(std::abs(under) < radius)) return std::nullopt;
  return crease_circle(corner + face.normal * under, face.normal,
                       std::sqrt(radius * radius - under * under));
}

}  // namespace arris
