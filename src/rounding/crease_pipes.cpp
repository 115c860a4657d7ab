#include "rounding/crease_pipes.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace arris {
namespace {

// An arc's part turns by this much at most.
constexpr double kPartAngle = radians(20);

struct Span {
  double t0, t1;
};

// Where a line is within r of a segment: the two are convex.
std::optional<Span> meet_capsule(Vec3d origin, Vec3d direction, Vec3d p0, Vec3d p1, double r) {
  std::optional<Span> all;
  const auto add = [&](double t0, double t1) {
    all = all ? Span{std::min(all->t0, t0), std::max(all->t1, t1)} : Span{t0, t1};
  };
  const double dd = length_squared(direction);
  const auto add_ball = [&](Vec3d center) {
    const Vec3d m = origin - center;
    const double b = dot(m, direction) / dd;
    const double d = length_squared(m - direction * b);
    if (d > r * r) return;
    const double half = std::sqrt((r * r - d) / dd);
    add(-b - half, -b + half);
  };
  add_ball(p0);
  add_ball(p1);
  const Vec3d along = p1 - p0;
  const double extent = length(along);
  if (!(extent > 0)) return all;
  const Vec3d axis = along / extent;
  const Vec3d m = origin - p0;
  const Vec3d m_across = m - axis * dot(m, axis);
  const double speed = dot(direction, axis);
  const Vec3d d_across = direction - axis * speed;
  const double a = length_squared(d_across);
  if (!(a > 1e-24 * dd)) return all;  // along the axis: what it meets are the balls
  const double b = dot(m_across, d_across) / a;
  const double c = length_squared(m_across - d_across * b);
  if (c > r * r) return all;
  const double half = std::sqrt((r * r - c) / a);
  for (const double t : {-b - half, -b + half}) {
    const double at = dot(m, axis) + speed * t;
    if (at >= 0 && at <= extent) add(t, t);
  }
  return all;
}

ArcEnds ends_of(const CreaseCurve& curve) {
  return {curve.at(curve.u0), curve.at(curve.u1)};
}

}  // namespace

std::vector<CreasePipes::Part> CreasePipes::parts_of(std::span<const CreaseCurve> creases) {
  std::vector<Part> parts;
  for (const CreaseCurve& whole : creases) {
    if (whole.is_line) {
      parts.push_back({whole, 0, ends_of(whole)});
      continue;
    }
    const int count = std::max(1, int(std::ceil((whole.u1 - whole.u0) / kPartAngle)));
    const double step = (whole.u1 - whole.u0) / count;
    for (int k = 0; k < count; ++k) {
      CreaseCurve part = whole;
      part.u0 = whole.u0 + step * k;
      part.u1 = k + 1 == count ? whole.u1 : part.u0 + step;
      // An affine image of a circle's arc.
      const double bulge =
          (1 - std::cos(0.5 * step)) * std::sqrt(length_squared(whole.a) + length_squared(whole.b));
      parts.push_back({part, bulge, ends_of(part)});
    }
  }
  return parts;
}

std::vector<Box> CreasePipes::boxes_of(std::span<const Part> parts, double radius) {
  std::vector<Box> boxes;
  for (std::uint32_t i = 0; i < parts.size(); ++i) {
    const auto [p0, p1] = parts[i].ends;
    const Vec3d reach(radius + parts[i].bulge);
    boxes.push_back({min(p0, p1) - reach, max(p0, p1) + reach, i});
  }
  return boxes;
}

CreasePipes::CreasePipes(std::vector<CreaseCurve> creases, double radius)
    : creases_(std::move(creases)),
      r_(radius),
      parts_(parts_of(creases_)),
      tree_(boxes_of(parts_, radius)) {}

// From one t of a ray towards another, either way: where it first comes within r of the curve.
std::optional<double> CreasePipes::step_to_arc(const Part& part, Vec3d origin, Vec3d direction,
                                               double from, double to) const {
  const CreaseCurve& curve = part.curve;
  constexpr int kMostSteps = 200;
  const double way = to < from ? -1 : 1;
  const double speed = way * length(direction);
  double t = from;
  double u = 0.5 * (curve.u0 + curve.u1);
  for (int step = 0; step <= kMostSteps; ++step) {
    const Vec3d x = origin + direction * t;
    u = nearest_parameter(curve, part.ends, x, u);
    const double left = length(x - curve.at(u)) - r_;
    if (left <= 1e-9 * r_) return t;
    t += left / speed;
    if ((t - to) * way > 0) break;
  }
  return std::nullopt;
}

std::optional<PipeHit> CreasePipes::first_entry(Vec3d origin, Vec3d direction, double end) const {
  std::optional<PipeHit> best;
  tree_.for_each_along(origin, direction, 0, end, [&](std::uint32_t i) {
    const Part& part = parts_[i];
    const CreaseCurve& curve = part.curve;
    const auto [p0, p1] = part.ends;
    const std::optional<Span> span = meet_capsule(origin, direction, p0, p1, r_ + part.bulge);
    if (!span || span->t1 < 0 || span->t0 > end) return;
    double t = std::max(span->t0, 0.0);
    if (!curve.is_line) {
      const std::optional<double> met =
          step_to_arc(part, origin, direction, t, std::min(span->t1, end));
      if (!met) return;
      t = *met;
    }
    if (t > end) return;
    const double u = nearest_parameter(curve, origin + direction * t);
    const Vec3d normal = normalize(origin + direction * t - curve.at(u));
    if (dot(normal, direction) >= 0) return;
    end = t;
    const bool is_inner = curve.is_line && u > curve.u0 && u < curve.u1;
    best = PipeHit{t, normal, !is_inner};
  });
  return best;
}

std::optional<PipeSpan> CreasePipes::span_of(std::uint32_t index, Vec3d origin,
                                             Vec3d direction) const {
  const Part& part = parts_[index];
  const CreaseCurve& curve = part.curve;
  const std::optional<Span> span =
      meet_capsule(origin, direction, part.ends.p0, part.ends.p1, r_ + part.bulge);
  if (!span) return std::nullopt;
  const auto place_at = [&](double t) {
    const Vec3d x = origin + direction * t;
    const double u = nearest_parameter(curve, x);
    return PipePlace{t, u, normalize(x - curve.at(u))};
  };
  if (curve.is_line) return PipeSpan{place_at(span->t0), place_at(span->t1)};
  const std::optional<double> t0 = step_to_arc(part, origin, direction, span->t0, span->t1);
  if (!t0) return std::nullopt;
  const std::optional<double> t1 = step_to_arc(part, origin, direction, span->t1, *t0);
  if (!t1) return std::nullopt;
  return PipeSpan{place_at(*t0), place_at(*t1)};
}

bool CreasePipes::holds(Vec3d x, double distance) const {
  bool found = false;
  tree_.for_each_near(x, x, [&](std::uint32_t i) {
    if (found) return;
    const CreaseCurve& curve = parts_[i].curve;
    found = length_squared(x - curve.at(nearest_parameter(curve, x))) < distance * distance;
  });
  return found;
}

std::size_t CreasePipes::bytes() const {
  return creases_.size() * sizeof(CreaseCurve) + parts_.size() * sizeof(Part) + tree_.bytes();
}

}  // namespace arris
