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

}  // namespace

CreasePipes::Part CreasePipes::make_part(const CreaseCurve& curve) {
  Part part;
  part.curve = curve;
  part.p0 = curve.at(curve.u0);
  part.p1 = curve.at(curve.u1);
  part.length = length(part.p1 - part.p0);
  if (part.length > 0) part.axis = (part.p1 - part.p0) / part.length;
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

std::vector<Box> CreasePipes::boxes_of(std::span<const Part> parts, double radius) {
  std::vector<Box> boxes;
  for (std::uint32_t i = 0; i < parts.size(); ++i) {
    const Part& part = parts[i];
    const Vec3d reach(radius + part.bulge);
    boxes.push_back({min(part.p0, part.p1) - reach, max(part.p0, part.p1) + reach, i});
  }
  return boxes;
}

CreasePipes::CreasePipes(std::vector<CreaseCurve> creases, double radius)
    : creases_(std::move(creases)),
      r_(radius),
      parts_(parts_of(creases_)),
      tree_(boxes_of(parts_, radius)) {}

CreasePipes::Foot CreasePipes::foot_on(const Part& part, Vec3d x) {
  if (!part.curve.is_line) {
    const Turn turn = part.arc.nearest(x, {});
    return {part.arc.at(turn), part.arc.parameter(turn)};
  }
  const double u = nearest_parameter(part.curve, x);
  return {part.curve.at(u), u};
}

// From one t of a ray towards another, either way: where it first comes within r of the arc.
std::optional<CreasePipes::ArcEntry> CreasePipes::step_to_arc(const ShortArc& arc, const Ray& ray,
                                                              double from, double to) const {
  constexpr int kMostSteps = 200;
  constexpr double kSafePart = 0.5;  // of the longest safe step
  const double way = to < from ? -1 : 1;
  const double unit = way / length(ray.direction);
  const Vec3d direction = ray.direction * unit;
  double t = from, before = from;
  double left_before = 0;
  Turn turn;
  for (int step = 0; step <= kMostSteps; ++step) {
    const Vec3d x = ray.origin + ray.direction * t;
    turn = arc.nearest(x, turn);
    const Vec3d away = x - arc.at(turn);
    const double distance = length(away), left = distance - r_;
    if (std::abs(left) <= 1e-9 * r_ || (left < 0 && step == 0)) return ArcEntry{t, turn};
    if (left < 0) {
      // Too far, as the arc bends towards the ray: back along the chord.
      t = before + (t - before) * (left_before / (left_before - left));
      continue;
    }
    before = t;
    left_before = left;
    const double fall = -dot(away, direction) / distance;
    const double safe = std::max(left, kSafePart * r_ * fall);
    t += unit * (fall > 0 ? std::min(left / fall, safe) : left);
    if ((t - to) * way <= 0) continue;
    if (before == to) break;
    t = to;
  }
  return std::nullopt;
}

std::optional<PipeHit> CreasePipes::first_entry(Vec3d origin, Vec3d direction, double end) const {
  std::optional<PipeHit> best;
  tree_.for_each_along(origin, direction, 0, end, [&](std::uint32_t i) {
    const Part& part = parts_[i];
    const std::optional<Span> span = meet_capsule(
        origin, direction, {part.p0, part.p1, part.axis, part.length}, r_ + part.bulge);
    if (!span || span->t1 < 0 || span->t0 > end) return;
    double t = std::max(span->t0, 0.0);
    Vec3d foot;
    bool is_inner = false;
    if (part.curve.is_line) {
      const double along = dot(origin + direction * t - part.p0, part.axis);
      foot = part.p0 + part.axis * std::clamp(along, 0.0, part.length);
      is_inner = along > 0 && along < part.length;
    } else {
      const std::optional<ArcEntry> met =
          step_to_arc(part.arc, {origin, direction}, t, std::min(span->t1, end));
      if (!met) return;
      t = met->t;
      foot = part.arc.at(met->turn);
    }
    if (t > end) return;
    const Vec3d normal = normalize(origin + direction * t - foot);
    if (dot(normal, direction) >= 0) return;
    end = t;
    best = PipeHit{t, normal, !is_inner};
  });
  return best;
}

std::optional<PipeSpan> CreasePipes::span_of(std::uint32_t index, Vec3d origin,
                                             Vec3d direction) const {
  const Part& part = parts_[index];
  const std::optional<Span> span =
      meet_capsule(origin, direction, {part.p0, part.p1, part.axis, part.length}, r_ + part.bulge);
  if (!span) return std::nullopt;
  const auto place_at = [&](double t) {
    const Vec3d x = origin + direction * t;
    const Foot foot = foot_on(part, x);
    return PipePlace{t, foot.u, normalize(x - foot.point)};
  };
  if (part.curve.is_line) return PipeSpan{place_at(span->t0), place_at(span->t1)};
  const Ray ray{origin, direction};
  const std::optional<ArcEntry> in = step_to_arc(part.arc, ray, span->t0, span->t1);
  if (!in) return std::nullopt;
  const std::optional<ArcEntry> out = step_to_arc(part.arc, ray, span->t1, in->t);
  if (!out) return std::nullopt;
  return PipeSpan{place_at(in->t), place_at(out->t)};
}

bool CreasePipes::holds(Vec3d x, double distance) const {
  bool found = false;
  tree_.for_each_near(x, x, [&](std::uint32_t i) {
    found = found || length_squared(x - foot_on(parts_[i], x).point) < distance * distance;
  });
  return found;
}

std::size_t CreasePipes::bytes() const {
  return creases_.size() * sizeof(CreaseCurve) + parts_.size() * sizeof(Part) + tree_.bytes();
}

}  // namespace arris
