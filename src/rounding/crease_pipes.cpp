#include "rounding/crease_pipes.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace arris {
namespace {

// An arc's part turns by this much at most.
constexpr double kPartAngle = radians(20);

// Squared sine below which a ray goes along an axis.
constexpr double kAlong = 1e-22;

struct Span {
  double t0, t1;
};

struct Segment {
  Vec3d p0, p1, axis;  // axis: unit, or 0 if it has no extent
  double extent;
  double radius, growth;  // at p0, and by the way along the axis
};

// Where a line is within r of a segment: the two are convex.
std::optional<Span> meet_capsule(Vec3d origin, Vec3d direction, const Segment& segment, double r) {
  const Vec3d& axis = segment.axis;
  const Vec3d m = origin - segment.p0;
  const double dd = length_squared(direction);
  const Vec3d normal = cross(direction, axis);
  const double apart = dot(m, normal), a = length_squared(normal);
  const bool is_along = !(a > kAlong * dd);
  // Most lines pass at a distance.
  if (!is_along && apart * apart > r * r * a * (1 + 1e-9)) return std::nullopt;
  std::optional<Span> all;
  const auto add = [&](double t0, double t1) {
    all = all ? Span{std::min(all->t0, t0), std::max(all->t1, t1)} : Span{t0, t1};
  };
  if (!is_along) {  // else what it meets are the balls
    const double s0 = dot(m, axis), speed = dot(direction, axis);
    const Vec3d m_across = m - axis * s0;
    const Vec3d d_across = direction - axis * speed;
    const double b = dot(m_across, d_across) / a;
    const double c = length_squared(m_across - d_across * b);
    if (c > r * r) return std::nullopt;
    const double half = std::sqrt((r * r - c) / a);
    int sides = 0;
    for (const double t : {-b - half, -b + half}) {
      const double at = s0 + speed * t;
      if (at < 0 || at > segment.extent) continue;
      add(t, t);
      ++sides;
    }
    if (sides == 2) return all;
  }
  for (const Vec3d center : {segment.p0, segment.p1}) {
    const Vec3d from = origin - center;
    const double b = dot(from, direction) / dd;
    const double d = length_squared(from - direction * b);
    if (d > r * r) continue;
    const double half = std::sqrt((r * r - d) / dd);
    add(-b - half, -b + half);
  }
  return all;
}

// The same for balls whose radius grows along the segment: where a line meets the cone that touches all of them,
// |x − c| = radius + growth s across its sides, or the balls at the ends.
std::optional<Span> meet_cone(Vec3d origin, Vec3d direction, const Segment& segment) {
  const auto& [p0, p1, axis, extent, radius, growth] = segment;
  std::optional<Span> all;
  const auto add = [&](double t) {
    all = all ? Span{std::min(all->t0, t), std::max(all->t1, t)} : Span{t, t};
  };
  const Vec3d m = origin - p0;
  const double dd = length_squared(direction), s0 = dot(m, axis), speed = dot(direction, axis);
  const double g2 = growth * growth, r0 = radius + growth * s0;
  const double a = (1 - g2) * (dd - speed * speed) - g2 * speed * speed;
  const double b = (1 - g2) * (dot(m, direction) - s0 * speed) - growth * speed * r0;
  const double c = (1 - g2) * (length_squared(m) - s0 * s0) - r0 * r0;
  const double discriminant = b * b - a * c;
  if (discriminant >= 0) {
    const double q = -(b + std::copysign(std::sqrt(discriminant), b));
    for (const double t : {q / a, c / q}) {
      if (!std::isfinite(t)) continue;
      const double s = s0 + speed * t;
      const double side = radius + growth * s;
      if (side < 0) continue;
      const double ball = nearest_ball(s, side / std::sqrt(1 - g2), growth);
      if (ball >= 0 && ball <= extent) add(t);
    }
  }
  for (const auto& [center, r] : {std::pair(p0, radius), std::pair(p1, radius + growth * extent)}) {
    const Vec3d from = origin - center;
    const double at = dot(from, direction) / dd;
    const double d = length_squared(from - direction * at);
    if (d > r * r) continue;
    const double half = std::sqrt((r * r - d) / dd);
    add(-at - half);
    add(-at + half);
  }
  return all;
}

std::optional<Span> meet_balls(Vec3d origin, Vec3d direction, const Segment& segment,
                               double bulge) {
  if (segment.growth != 0) return meet_cone(origin, direction, segment);
  return meet_capsule(origin, direction, segment, segment.radius + bulge);
}

// A ray, and balls around an arc.
class ArcWay {
 public:
  ArcWay(const ShortArc& arc, const Ray& ray, double radius)
      : arc_(arc),
        origin_(ray.origin),
        speed_(length(ray.direction)),
        direction_(ray.direction / speed_),
        r_(radius) {}

  // Between two t of the ray: where it first is within a ball.
  [[nodiscard]] std::optional<PipeHit> enter(double from, double to) const {
    const auto met = arc_.enter(origin_, direction_, from * speed_, to * speed_, r_);
    if (!met) return std::nullopt;
    const Vec3d away = origin_ + direction_ * met->along - arc_.at(met->turn);
    return PipeHit{met->along / speed_, normalize(away), true};
  }
  // From one t within balls: where it leaves them.
  [[nodiscard]] double leave(double from) const {
    return arc_.leave(origin_, direction_, from * speed_, r_).along / speed_;
  }
  // So far beyond a t that it is another place.
  [[nodiscard]] double beyond(double t) const { return t + kApart * r_ / speed_; }

 private:
  static constexpr double kApart = 1e-6;

  const ShortArc& arc_;
  Vec3d origin_;
  double speed_;
  Vec3d direction_;
  double r_;
};

}  // namespace

CreasePipes::Part CreasePipes::make_part(const CreaseCurve& curve) {
  Part part;
  part.curve = curve;
  part.p0 = curve.at(curve.u0);
  part.p1 = curve.at(curve.u1);
  part.length = length(part.p1 - part.p0);
  if (part.length > 0) part.axis = (part.p1 - part.p0) / part.length;
  part.radius = curve.r0;
  if (part.length > 0) part.growth = (curve.r1 - curve.r0) / part.length;
  if (curve.is_line) return part;
  // An affine image of a circle's arc.
  part.bulge = (1 - std::cos(0.5 * (curve.u1 - curve.u0))) *
               std::sqrt(length_squared(curve.a) + length_squared(curve.b));
  part.arc = ShortArc(curve);
  return part;
}

std::vector<CreasePipes::Part> CreasePipes::parts_of(std::span<const CreaseCurve> creases) {
  std::vector<Part> parts;
  for (const CreaseCurve& whole : creases) {
    if (whole.is_line) {
      parts.push_back(make_part(whole));
      continue;
    }
    const int count = std::max(1, int(std::ceil((whole.u1 - whole.u0) / kPartAngle)));
    const double step = (whole.u1 - whole.u0) / count;
    for (int k = 0; k < count; ++k) {
      CreaseCurve part = whole;
      part.u0 = whole.u0 + step * k;
      part.u1 = k + 1 == count ? whole.u1 : part.u0 + step;
      parts.push_back(make_part(part));
    }
  }
  return parts;
}

std::vector<Box> CreasePipes::boxes_of(std::span<const Part> parts) {
  std::vector<Box> boxes;
  for (std::uint32_t i = 0; i < parts.size(); ++i) {
    const Part& part = parts[i];
    const Vec3d reach(std::max(part.curve.r0, part.curve.r1) + part.bulge);
    boxes.push_back({min(part.p0, part.p1) - reach, max(part.p0, part.p1) + reach, i});
  }
  return boxes;
}

CreasePipes::CreasePipes(std::vector<CreaseCurve> creases)
    : creases_(std::move(creases)), parts_(parts_of(creases_)), tree_(boxes_of(parts_)) {}

CreasePipes::Foot CreasePipes::foot_on(const Part& part, Vec3d x) {
  if (!part.curve.is_line) {
    const Turn turn = part.arc.nearest(x, {});
    return {part.arc.at(turn), part.arc.parameter(turn)};
  }
  double u = nearest_parameter(part.curve, x);
  if (part.growth != 0) {
    const double along = dot(x - part.p0, part.axis);
    const double ball = nearest_ball(along, length(x - part.p0 - part.axis * along), part.growth);
    u = part.curve.u0 + std::clamp(ball / part.length, 0.0, 1.0) * (part.curve.u1 - part.curve.u0);
  }
  return {part.curve.at(u), u};
}

std::optional<PipeHit> CreasePipes::first_entry(Vec3d origin, Vec3d direction, double end) const {
  std::optional<PipeHit> best;
  tree_.for_each_along(origin, direction, 0, end, [&](std::uint32_t i) {
    const Part& part = parts_[i];
    const std::optional<Span> span = meet_balls(
        origin, direction, {part.p0, part.p1, part.axis, part.length, part.radius, part.growth},
        part.bulge);
    if (!span || span->t1 < 0 || span->t0 > end) return;
    double t = std::max(span->t0, 0.0);
    if (!part.curve.is_line) {
      const ArcWay way(part.arc, {origin, direction}, part.radius);
      const double last = std::min(span->t1, end);
      std::optional<PipeHit> met = way.enter(t, last);
      // One that leaves may come back where the arc bends.
      if (met && dot(met->normal, direction) >= 0) met = way.enter(way.beyond(met->t), last);
      if (!met || dot(met->normal, direction) >= 0) return;
      end = met->t;
      best = met;
      return;
    }
    const Vec3d x = origin + direction * t - part.p0;
    double along = dot(x, part.axis);
    if (part.growth != 0) {
      along = nearest_ball(along, length(x - part.axis * along), part.growth);
    }
    const Vec3d foot = part.p0 + part.axis * std::clamp(along, 0.0, part.length);
    const bool is_inner = along > 0 && along < part.length;
    if (t > end) return;
    const Vec3d normal = normalize(origin + direction * t - foot);
    if (dot(normal, direction) >= 0) return;
    end = t;
    best = PipeHit{t, normal, !is_inner};
  });
  return best;
}

std::optional<PipeSpan> CreasePipes::span_of(std::uint32_t index, Vec3d origin, Vec3d direction,
                                             double after) const {
  const Part& part = parts_[index];
  const std::optional<Span> span =
      meet_balls(origin, direction,
                 {part.p0, part.p1, part.axis, part.length, part.radius, part.growth}, part.bulge);
  if (!span) return std::nullopt;
  const auto place_at = [&](double t) {
    const Vec3d x = origin + direction * t;
    const Foot foot = foot_on(part, x);
    return PipePlace{t, foot.u, normalize(x - foot.point)};
  };
  if (part.curve.is_line) {
    if (span->t1 <= after) return std::nullopt;
    return PipeSpan{place_at(span->t0), place_at(span->t1)};
  }
  const ArcWay way(part.arc, {origin, direction}, part.radius);
  const auto in = way.enter(std::max(span->t0, way.beyond(after)), span->t1);
  if (!in) return std::nullopt;
  return PipeSpan{place_at(in->t), place_at(way.leave(in->t))};
}

bool CreasePipes::holds(Vec3d x, double depth) const {
  bool found = false;
  tree_.for_each_near(x, x, [&](std::uint32_t i) {
    const Part& part = parts_[i];
    if (found || part.growth != 0) {
      found = found || distance_to_balls(part.curve, x) < -depth;
      return;
    }
    const double least = part.radius - depth;
    found = length_squared(x - foot_on(part, x).point) < least * least;
  });
  return found;
}

std::size_t CreasePipes::bytes() const {
  return creases_.size() * sizeof(CreaseCurve) + parts_.size() * sizeof(Part) + tree_.bytes();
}

}  // namespace arris
