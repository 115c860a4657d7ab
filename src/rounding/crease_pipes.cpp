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

// Where a line is within r of a segment: the two are convex.
std::optional<Span> meet_capsule(Vec3d origin, Vec3d direction, const ChordBalls& chord, double r) {
  const Vec3d& axis = chord.axis;
  const Vec3d m = origin - chord.p0;
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
      if (at < 0 || at > chord.extent) continue;
      add(t, t);
      ++sides;
    }
    if (sides == 2) return all;
  }
  for (const Vec3d center : {chord.p0, chord.p1}) {
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
std::optional<Span> meet_cone(Vec3d origin, Vec3d direction, const ChordBalls& chord) {
  const auto& [p0, p1, axis, extent, radius, growth, bulge] = chord;
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

std::optional<Span> meet_balls(Vec3d origin, Vec3d direction, const ChordBalls& chord) {
  if (chord.growth != 0) return meet_cone(origin, direction, chord);
  return meet_capsule(origin, direction, chord, chord.radius + chord.bulge);
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

  // Between two t of the ray: where it first is within a ball; and from there where it leaves them.
  [[nodiscard]] std::optional<PipePlace> enter(double from, double to) const {
    const auto met = arc_.enter(origin_, direction_, from * speed_, to * speed_, r_);
    if (!met) return std::nullopt;
    return place_of(*met);
  }
  [[nodiscard]] PipePlace leave(double from) const {
    return place_of(arc_.leave(origin_, direction_, from * speed_, r_));
  }
  // So far beyond a t that it is another place.
  [[nodiscard]] double beyond(double t) const { return t + kApart * r_ / speed_; }

 private:
  static constexpr double kApart = 1e-6;

  [[nodiscard]] PipePlace place_of(const ShortArc::Crossing& crossing) const {
    const Vec3d away = origin_ + direction_ * crossing.along - arc_.at(crossing.turn);
    return {crossing.along / speed_, arc_.parameter(crossing.turn), normalize(away)};
  }

  const ShortArc& arc_;
  Vec3d origin_;
  double speed_;
  Vec3d direction_;
  double r_;
};

}  // namespace

CreasePipes::Part CreasePipes::make_part(const CreaseCurve& curve) {
  return {curve, curve.is_line ? ShortArc() : ShortArc(curve)};
}

ChordBalls CreasePipes::balls_of(const CreaseCurve& part) {
  ChordBalls balls;
  balls.p0 = part.at(part.u0);
  balls.p1 = part.at(part.u1);
  balls.extent = length(balls.p1 - balls.p0);
  balls.radius = part.r0;
  if (balls.extent > 0) {
    balls.axis = (balls.p1 - balls.p0) / balls.extent;
    balls.growth = (part.r1 - part.r0) / balls.extent;
  }
  if (!part.is_line) {
    // An affine image of a circle's arc.
    balls.bulge = (1 - std::cos(0.5 * (part.u1 - part.u0))) *
                  std::sqrt(length_squared(part.a) + length_squared(part.b));
  }
  return balls;
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

CreasePipes::CreasePipes(std::vector<CreaseCurve> creases) : creases_(std::move(creases)) {
  const std::vector<Part> parts = parts_of(creases_);
  std::vector<Box> boxes;
  for (std::uint32_t i = 0; i < parts.size(); ++i) {
    const ChordBalls balls = balls_of(parts[i].curve);
    const Vec3d reach(std::max(parts[i].curve.r0, parts[i].curve.r1) + balls.bulge);
    boxes.push_back({min(balls.p0, balls.p1) - reach, max(balls.p0, balls.p1) + reach, i});
  }
  tree_ = BoxTree(std::move(boxes));
  for (const std::uint32_t i : tree_.renumber()) {
    parts_.push_back(parts[i]);
    balls_.push_back(balls_of(parts[i].curve));
  }
}

CreasePipes::Foot CreasePipes::foot_on(std::uint32_t index, Vec3d x) const {
  const auto& [curve, arc] = parts_[index];
  if (!curve.is_line) {
    const Turn turn = arc.nearest(x, {});
    return {arc.at(turn), arc.parameter(turn)};
  }
  const ChordBalls& balls = balls_[index];
  double u = nearest_parameter(curve, x);
  if (balls.growth != 0) {
    const double along = dot(x - balls.p0, balls.axis);
    const double away = length(x - balls.p0 - balls.axis * along);
    const double ball = nearest_ball(along, away, balls.growth);
    u = curve.u0 + std::clamp(ball / balls.extent, 0.0, 1.0) * (curve.u1 - curve.u0);
  }
  return {curve.at(u), u};
}

std::optional<PipeHit> CreasePipes::first_entry(Vec3d origin, Vec3d direction, double end) const {
  std::optional<PipeHit> best;
  tree_.for_each_along(origin, direction, 0, end, [&](std::uint32_t i) {
    const ChordBalls& balls = balls_[i];
    const std::optional<Span> span = meet_balls(origin, direction, balls);
    if (!span || span->t1 < 0 || span->t0 > end) return;
    double t = std::max(span->t0, 0.0);
    if (!parts_[i].curve.is_line) {
      const ArcWay way(parts_[i].arc, {origin, direction}, balls.radius);
      const double last = std::min(span->t1, end);
      auto met = way.enter(t, last);
      // One that leaves may come back where the arc bends.
      if (met && dot(met->normal, direction) >= 0) met = way.enter(way.beyond(met->t), last);
      if (!met || dot(met->normal, direction) >= 0) return;
      end = met->t;
      best = PipeHit{met->t, met->normal, true};
      return;
    }
    const Vec3d x = origin + direction * t - balls.p0;
    double along = dot(x, balls.axis);
    if (balls.growth != 0) {
      along = nearest_ball(along, length(x - balls.axis * along), balls.growth);
    }
    const Vec3d foot = balls.p0 + balls.axis * std::clamp(along, 0.0, balls.extent);
    const bool is_inner = along > 0 && along < balls.extent;
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
  const std::optional<Span> span = meet_balls(origin, direction, balls_[index]);
  if (!span) return std::nullopt;
  if (parts_[index].curve.is_line) {
    if (span->t1 <= after) return std::nullopt;
    const auto place_at = [&](double t) {
      const Vec3d x = origin + direction * t;
      const Foot foot = foot_on(index, x);
      return PipePlace{t, foot.u, normalize(x - foot.point)};
    };
    return PipeSpan{place_at(span->t0), place_at(span->t1)};
  }
  const ArcWay way(parts_[index].arc, {origin, direction}, balls_[index].radius);
  const auto in = way.enter(std::max(span->t0, way.beyond(after)), span->t1);
  if (!in) return std::nullopt;
  return PipeSpan{*in, way.leave(in->t)};
}

bool CreasePipes::holds(Vec3d x, double depth) const {
  return tree_.any_near(x, x, [&](std::uint32_t i) {
    const ChordBalls& balls = balls_[i];
    if (balls.growth != 0) return distance_to_balls(parts_[i].curve, x) < -depth;
    const double least = balls.radius - depth;
    const double along = std::clamp(dot(x - balls.p0, balls.axis), 0.0, balls.extent);
    const double squared = length_squared(x - balls.p0 - balls.axis * along);
    if (parts_[i].curve.is_line) return least > 0 && squared < least * least;
    // An arc is nowhere farther from its chord than the bulge.
    const double most = least + balls.bulge, surely = least - balls.bulge;
    if (most <= 0 || squared > most * most) return false;
    if (surely > 0 && squared < surely * surely) return true;
    return least > 0 && length_squared(x - foot_on(i, x).point) < least * least;
  });
}

std::size_t CreasePipes::bytes() const {
  return creases_.size() * sizeof(CreaseCurve) +
         parts_.size() * (sizeof(Part) + sizeof(ChordBalls)) + tree_.bytes();
}

}  // namespace arris
