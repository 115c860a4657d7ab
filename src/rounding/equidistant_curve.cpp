#include "rounding/equidistant_curve.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace arris {
namespace {

// The angle is looked at in so many steps for where the curve begins and ends.
constexpr int kSteps = 32, kHalvings = 50;
// A branch is fitted in this many pieces at least, each of which is halved this often at most.
constexpr int kPieces = 6, kMostHalvings = 40;
// Of the radius, or the part's length if that is more: no arc's ends are farther apart.
constexpr double kLongest = 0.5;
// Of the tolerance, the height above its chord of an arc that is as good as a segment.
constexpr double kStraight = 0.1;

// The circle through three points, from the first to the last; nothing: the second is no higher above their chord.
std::optional<CreaseCurve> arc_through(Vec3d a, Vec3d b, Vec3d c, double height) {
  const Vec3d ab = b - a, ac = c - a, normal = cross(ab, ac);
  const double squared = length_squared(normal);
  if (!(squared > height * height * length_squared(ac))) return std::nullopt;
  const Vec3d to_center =
      (cross(ac, normal) * length_squared(ab) - cross(ab, normal) * length_squared(ac)) *
      (0.5 / squared);
  CreaseCurve arc;
  arc.is_line = false;
  arc.center = a + to_center;
  arc.a = a - arc.center;
  arc.b = cross(normal / std::sqrt(squared), arc.a);
  const Vec3d end = c - arc.center;
  arc.u1 = std::atan2(dot(end, arc.b), dot(end, arc.a));
  if (arc.u1 < 0) arc.u1 += 2 * kPi;
  return arc;
}

CreaseCurve segment(Vec3d a, Vec3d b) {
  const double way = length(b - a);
  return {a, way > 0 ? (b - a) / way : Vec3d(1, 0, 0), {}, true, 0, way};
}

class Follower {
 public:
  Follower(const CylinderPart& part, const EdgeLine& other, double radius, double tolerance)
      : part_(part), other_(other), r_(radius), tolerance_(tolerance) {
    u_ = part.from;
    v_ = cross(part.axis.direction, u_);
    if (dot(v_, part.to) < 0) v_ = -v_;
    most_ = std::atan2(dot(v_, part.to), dot(u_, part.to));
    squared_speed_ = length_squared(across_other(part.axis.direction));
  }

  std::vector<CreaseCurve> run() {
    if (!(squared_speed_ > 0)) return {};
    // Where there are solutions: between steps, and to within them.
    double begin = 0, before = 0;
    bool is_open = discriminant(0) >= 0;
    for (int i = 1; i <= kSteps; ++i) {
      const double theta = most_ * i / kSteps;
      const bool is_there = discriminant(theta) >= 0;
      if (is_there != is_open) {
        const double border =
            is_there ? border_between(theta, before) : border_between(before, theta);
        if (is_open) follow(begin, border);
        begin = border;
        is_open = is_there;
      }
      before = theta;
    }
    if (is_open) follow(begin, most_);
    return std::move(out_);
  }

 private:
  [[nodiscard]] Vec3d across_other(Vec3d w) const {
    return w - other_.direction * dot(other_.direction, w);
  }
  [[nodiscard]] Vec3d foot(double theta) const {
    return part_.axis.point + (u_ * std::cos(theta) + v_ * std::sin(theta)) * r_;
  }
  // Of s² a + 2 s b + c = 0.
  struct Quadratic {
    double b, discriminant;
  };
  [[nodiscard]] Quadratic quadratic(Vec3d from) const {
    const Vec3d w = across_other(from - other_.point);
    const double b = dot(across_other(part_.axis.direction), w);
    return {b, b * b - squared_speed_ * (length_squared(w) - r_ * r_)};
  }
  [[nodiscard]] double discriminant(double theta) const {
    return quadratic(foot(theta)).discriminant;
  }
  [[nodiscard]] double border_between(double there, double not_there) const {
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (there + not_there);
      (discriminant(middle) >= 0 ? there : not_there) = middle;
    }
    return there;
  }

  // Both branches. At its ends a branch may turn into the other, where s has a root's slope: steps are those of a
  // cosine.
  void follow(double begin, double end) {
    for (const double sign : {-1.0, 1.0}) {
      const auto at = [&](double w) {
        const Vec3d from = foot(0.5 * (begin + end - (end - begin) * std::cos(w)));
        const auto [b, square] = quadratic(from);
        const double s = (-b + sign * std::sqrt(std::max(square, 0.0))) / squared_speed_;
        return from + part_.axis.direction * s;
      };
      for (int i = 0; i < kPieces; ++i) fit(at, kPi * i / kPieces, kPi * (i + 1) / kPieces, 0);
    }
  }

  template <class Curve>
  void fit(const Curve& at, double w0, double w1, int depth) {
    const double middle = 0.5 * (w0 + w1);
    const Vec3d a = at(w0), b = at(middle), c = at(w1);
    if (is_beyond_ends(a, b, c)) return;
    const std::optional<CreaseCurve> arc = arc_through(a, b, c, kStraight * tolerance_);
    const auto is_near = [&](Vec3d x) {
      if (!arc)
        return length(x - a - (c - a) * (dot(x - a, c - a) / length_squared(c - a))) <= tolerance_;
      const Vec3d away = x - arc->center, normal = normalize(cross(arc->a, arc->b));
      const double height = dot(away, normal);
      const double beside = length(away - normal * height) - length(arc->a);
      return std::hypot(height, beside) <= tolerance_;
    };
    const bool is_short = length(c - a) <= tolerance_;
    const bool fits = length(c - a) <= kLongest * std::max(r_, part_.length) &&
                      (!arc || arc->u1 < 0.5 * kPi) && is_near(at(0.5 * (w0 + middle))) &&
                      is_near(at(0.5 * (middle + w1)));
    if (is_short || fits || depth == kMostHalvings) {
      out_.push_back(arc && !is_short ? *arc : segment(a, c));
      return;
    }
    fit(at, w0, middle, depth + 1);
    fit(at, middle, w1, depth + 1);
  }

  // Whether a piece leads past an end of the part all the way, as far as three of its places tell.
  [[nodiscard]] bool is_beyond_ends(Vec3d a, Vec3d b, Vec3d c) const {
    const auto along = [&](Vec3d x) { return dot(part_.axis.direction, x - part_.axis.point); };
    const double s0 = along(a), s1 = along(b), s2 = along(c);
    if ((s0 < s1) != (s1 < s2)) return false;
    return std::max(s0, s2) < -tolerance_ || std::min(s0, s2) > part_.length + tolerance_;
  }

  const CylinderPart& part_;
  const EdgeLine& other_;
  double r_, tolerance_;
  Vec3d u_, v_;
  double most_ = 0;           // of the angle
  double squared_speed_ = 0;  // by which the other's axis is left along this one
  std::vector<CreaseCurve> out_;
};

}  // namespace

std::vector<CreaseCurve> equidistant_curves(const CylinderPart& part, const EdgeLine& other,
                                            double radius, double tolerance) {
  return Follower(part, other, radius, tolerance).run();
}

std::vector<CreaseCurve> parallel_edge_creases(const EdgeLine& a, Vec3d other, double radius,
                                               double extent) {
  const Vec3d between = other - a.point - a.direction * dot(a.direction, other - a.point);
  const double half = 0.5 * length(between);
  if (!(half > 0 && half < radius)) return {};
  const Vec3d across =
      cross(a.direction, normalize(between)) * std::sqrt(radius * radius - half * half);
  std::vector<CreaseCurve> lines;
  for (const double side : {-1.0, 1.0}) {
    lines.push_back(
        {a.point + between * 0.5 + across * side, a.direction, {}, true, -extent, extent});
  }
  return lines;
}

std::vector<CreaseCurve> corner_corner_creases(Vec3d a, Vec3d b, double radius) {
  const double half = 0.5 * length(b - a);
  if (!(half > 0 && half < radius)) return {};
  return {crease_circle((a + b) * 0.5, normalize(b - a), std::sqrt(radius * radius - half * half))};
}

}  // namespace arris
