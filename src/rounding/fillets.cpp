#include "rounding/fillets.h"

#include <algorithm>
#include <cmath>

#include "rounding/thin_walls.h"

namespace arris {
namespace {

// Relative to the radius: nearer than this to its surface, a ball does not hold a point.
constexpr double kOnBall = 1e-6;
// Of the radius: so far behind the surface of a fillet is something of it.
constexpr double kBehind = 1e-3;

}  // namespace

Fillets::Fillets(const CreasedSolid& outside, std::span<const PlainCrease> plain)
    : outside_(&outside) {
  for (std::uint32_t i = 0; i < outside.pipes.part_count(); ++i) {
    const CreaseCurve& curve = outside.pipes.curve_of(i);
    const Contacts contacts = contacts_at(curve, 0.5 * (curve.u0 + curve.u1));
    const std::span<const Vec3d> toward = contacts.toward();
    // Around a corner the balls touch nothing else: the seam of two offsets, not a crease. Smooth edges stay.
    if (toward.size() < 2 || contacts.are_at_smooth_edge(outside.surface)) continue;
    Part part{i, curve.is_line && toward.size() == 2, toward[0], toward[1]};
    while (!plain.empty() && plain.front().part < i) plain = plain.subspan(1);
    if (!plain.empty() && plain.front().part == i) {
      part.plain0 = dot(plain.front().axis, plain.front().p0 - curve.center);
      part.plain1 = part.plain0 + plain.front().length;
    }
    set_box(part);
    part.among_walls = !outside.field.is_uniform_within(part.low, part.high) ||
                       is_among_walls(curve) || outside.mouths.is_behind(i);
    any_among_walls_ = any_among_walls_ || part.among_walls;
    parts_.push_back(part);
  }
}

Contacts Fillets::contacts_at(const CreaseCurve& curve, double u) const {
  return {outside_->surface, curve.at(u), curve.radius_at(u) + outside_->tolerance};
}

bool Fillets::is_among_walls(const CreaseCurve& curve) const {
  const Vec3d p0 = curve.at(curve.u0), p1 = curve.at(curve.u1);
  const double r = outside_->radius, bulge = curve.is_line ? 0 : length(curve.a) + length(curve.b);
  const Vec3d reach(r + bulge);
  return outside_->surface.has_firm_near(min(p0, p1) - reach, max(p0, p1) + reach) ||
         is_between_walls(outside_->surface, (p0 + p1) * 0.5,
                          2 * r + bulge + 0.5 * length(p1 - p0));
}

void Fillets::set_box(Part& part) const {
  const CreaseCurve& curve = outside_->pipes.curve_of(part.pipe);
  Vec3d low(INFINITY), high(-INFINITY);
  // Between contacts the surface rises above their chord.
  double half_cosine = 1;
  for (const double u : {curve.u0, 0.5 * (curve.u0 + curve.u1), curve.u1}) {
    const Contacts contacts = contacts_at(curve, u);
    half_cosine = std::min(half_cosine, contacts.spread().half_cosine);
    for (const Vec3d toward : contacts.toward()) {
      const Vec3d p = curve.at(u) + toward * curve.radius_at(u);
      low = min(low, p);
      high = max(high, p);
    }
  }
  const double r = std::max(curve.r0, curve.r1);
  const Vec3d rise(r * (1 - half_cosine) + 2 * outside_->pipes.bulge_of(part.pipe) + kOnBall * r);
  part.low = low - rise;
  part.high = high + rise;
}

bool Fillets::begins_at(const Part& part, const PipePlace& place) const {
  const CreaseCurve& curve = outside_->pipes.curve_of(part.pipe);
  const Vec3d c = curve.at(place.u);
  const double r = curve.radius_at(place.u);
  const Vec3d x = c + place.normal * r;
  if (min(x, part.low) != part.low || max(x, part.high) != part.high) return false;
  const bool is_plain = place.u > part.plain0 && place.u < part.plain1;
  if (!is_plain && outside_->pipes.holds(x, r * kOnBall)) return false;
  const bool is_end = place.u <= curve.u0 || place.u >= curve.u1, grows = curve.r0 != curve.r1;
  if (part.has_sides && (grows || !is_end)) {
    // Normals of cones lean, and what is between two of different slopes belongs to their common ball.
    const auto across = [&](Vec3d v) {
      return grows ? normalize(v - curve.a * dot(v, curve.a)) : v;
    };
    if (!is_between(across(place.normal), across(part.side_a), across(part.side_b))) return false;
  } else if (!contacts_at(curve, place.u).hold(place.normal)) {
    return false;
  }
  return is_plain || !part.among_walls || !outside_->is_beneath(x + place.normal * (kBehind * r));
}

std::optional<FilletCrossing> Fillets::meet(std::uint32_t index, Vec3d origin, Vec3d direction,
                                            const Wanted& wanted) const {
  const Part& part = parts_[index];
  const auto counts = [&](const PipePlace& place) {
    return place.t > wanted.t_min && place.t < wanted.t_max && begins_at(part, place);
  };
  double after = -INFINITY;
  while (const auto span = outside_->pipes.span_of(part.pipe, origin, direction, after)) {
    // Into the ball is out of the fillet. In a gap, a ray may have come into it by its side.
    if (counts(span->in)) {
      if (wanted.entries && any_among_walls_) {
        const auto met = outside_->cross_void(origin + direction * span->in.t, -direction).met;
        const double t = met ? span->in.t - met->t : -INFINITY;
        if (t > wanted.t_min) return FilletCrossing{t, -met->normal, true};
      }
      if (wanted.exits) return FilletCrossing{span->in.t, -span->in.normal, false};
    }
    if (wanted.entries && counts(span->out)) {
      return FilletCrossing{span->out.t, -span->out.normal, true};
    }
    after = span->out.t;
  }
  return std::nullopt;
}

}  // namespace arris
