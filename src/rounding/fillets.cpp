#include "rounding/fillets.h"

#include <algorithm>
#include <cmath>

#include "rounding/thin_walls.h"

namespace arris {
namespace {

// How far beside the plane of two contacts a direction may lie.
constexpr double kBeside = 1e-4;
// Weights of contacts may be this much below 0: fillets and faces meet without a gap.
constexpr double kLeastWeight = -1e-6;
// Relative to the radius: nearer than this to its surface, a ball does not hold a point.
constexpr double kOnBall = 1e-6;
// Two faces' contacts on their common edge are one.
constexpr double kSame = 1e-5;
// Of the radius: what lies behind the end of a fillet, along it, is longer by no more than this.
constexpr double kWayAtEnd = 3;
// Of the radius: so far behind the surface of a fillet is something of it.
constexpr double kBehind = 1e-3;

// n = α a + β b, up to kBeside, with weights that count.
bool is_between(Vec3d n, Vec3d a, Vec3d b) {
  const double c = dot(a, b), s2 = 1 - c * c;
  if (!(s2 > 1e-12)) return false;
  const double na = dot(n, a), nb = dot(n, b);
  const double alpha = (na - c * nb) / s2, beta = (nb - c * na) / s2;
  if (alpha < kLeastWeight || beta < kLeastWeight) return false;
  return length_squared(n - a * alpha - b * beta) < kBeside * kBeside;
}

bool is_between(Vec3d n, Vec3d a, Vec3d b, Vec3d c) {
  const double volume = dot(a, cross(b, c));
  if (std::abs(volume) < 1e-9) return false;
  return dot(n, cross(b, c)) / volume >= kLeastWeight &&
         dot(n, cross(c, a)) / volume >= kLeastWeight &&
         dot(n, cross(a, b)) / volume >= kLeastWeight;
}

}  // namespace

Fillets::Fillets(const CreasedSolid& outside, std::span<const PlainCrease> plain)
    : outside_(&outside) {
  for (std::uint32_t i = 0; i < outside.pipes.part_count(); ++i) {
    const CreaseCurve& curve = outside.pipes.curve_of(i);
    const Contacts contacts = contacts_at(curve.at(0.5 * (curve.u0 + curve.u1)));
    // Around a corner the balls touch nothing else: the seam of two offsets, not a crease. Smooth edges stay.
    if (contacts.count < 2 || contacts.at_smooth_edge || !is_backed(curve, contacts)) continue;
    Part part{i, curve.is_line && contacts.count == 2, contacts.toward[0], contacts.toward[1]};
    part.among_walls = is_among_walls(curve);
    any_among_walls_ = any_among_walls_ || part.among_walls;
    while (!plain.empty() && plain.front().part < i) plain = plain.subspan(1);
    if (!plain.empty() && plain.front().part == i) {
      part.plain0 = dot(plain.front().axis, plain.front().p0 - curve.center);
      part.plain1 = part.plain0 + plain.front().length;
    }
    set_box(part);
    parts_.push_back(part);
  }
}

// Of each face the nearest place: beside its foot on a plane, a ball is within the tolerance of other triangles, too.
Fillets::Contacts Fillets::contacts_at(Vec3d c) const {
  struct Nearest {
    std::uint32_t region;
    double squared;
    Vec3d foot;
  };
  std::array<Nearest, kMostContacts> nearest;
  std::size_t count = 0;
  const double most = outside_->radius + outside_->tolerance;
  outside_->surface.for_each_near(c - Vec3d(most), c + Vec3d(most), [&](const SurfaceTriangle& t) {
    if (is_plainly_beyond(c, t, most)) return;
    const Vec3d foot = nearest_on_triangle(c, t) - c;
    const double squared = length_squared(foot);
    if (squared > most * most) return;
    const auto end = nearest.begin() + std::ptrdiff_t(count);
    const auto same =
        std::find_if(nearest.begin(), end, [&](const Nearest& n) { return n.region == t.region; });
    if (same == end) {
      if (count < kMostContacts) nearest[count++] = {t.region, squared, foot};
    } else if (squared < same->squared) {
      *same = {t.region, squared, foot};
    }
  });
  Contacts contacts;
  for (std::size_t k = 0; k < count; ++k) {
    for (std::size_t i = 0; i < k; ++i) {
      contacts.at_smooth_edge = contacts.at_smooth_edge ||
                                outside_->surface.is_joined(nearest[i].region, nearest[k].region);
    }
    const Vec3d toward = normalize(nearest[k].foot);
    const auto known = std::span(contacts.toward).first(contacts.count);
    const auto is_same = [&](Vec3d other) {
      return length_squared(other - toward) < kSame * kSame;
    };
    if (std::none_of(known.begin(), known.end(), is_same)) {
      contacts.toward[contacts.count++] = toward;
    }
  }
  return contacts;
}

// Whether what lies behind the middle of a part ends, about where the planes of its contacts meet, at the mesh, or at
// balls on the other side. In the mouth of an undercut groove it does not: no crease is known between its lips.
bool Fillets::is_backed(const CreaseCurve& curve, const Contacts& contacts) const {
  Vec3d middle;
  double least_cosine = 1;
  for (std::size_t i = 0; i < contacts.count; ++i) {
    middle += contacts.toward[i];
    for (std::size_t j = 0; j < i; ++j) {
      least_cosine = std::min(least_cosine, dot(contacts.toward[i], contacts.toward[j]));
    }
  }
  const double half_cosine = std::sqrt(std::max(0.5 * (1 + least_cosine), 0.0));
  if (half_cosine < kSame || length(middle) < kSame) return true;
  const Vec3d n = normalize(middle);
  const double r = outside_->radius, tolerance = outside_->tolerance;
  const double most = 2 * (r / half_cosine - r) + kWayAtEnd * r;
  const Vec3d x = curve.at(0.5 * (curve.u0 + curve.u1)) + n * r;
  return std::isfinite(outside_->surface.first_exit(x, n, -tolerance, most).t) ||
         outside_->pipes.first_entry(x + n * tolerance, n, most).has_value();
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
  const double r = outside_->radius;
  Vec3d low(INFINITY), high(-INFINITY);
  // Between contacts the surface rises above their chord.
  double least_cosine = 1;
  for (const double u : {curve.u0, 0.5 * (curve.u0 + curve.u1), curve.u1}) {
    const Contacts contacts = contacts_at(curve.at(u));
    for (std::size_t i = 0; i < contacts.count; ++i) {
      const Vec3d p = curve.at(u) + contacts.toward[i] * r;
      low = min(low, p);
      high = max(high, p);
      for (std::size_t j = 0; j < i; ++j) {
        least_cosine = std::min(least_cosine, dot(contacts.toward[i], contacts.toward[j]));
      }
    }
  }
  const double half_angle = 0.5 * std::acos(std::clamp(least_cosine, -1.0, 1.0));
  const Vec3d rise(r * (1 - std::cos(half_angle)) + 2 * outside_->pipes.bulge_of(part.pipe) +
                   kOnBall * r);
  part.low = low - rise;
  part.high = high + rise;
}

bool Fillets::begins_at(const Part& part, const PipePlace& place) const {
  const CreaseCurve& curve = outside_->pipes.curve_of(part.pipe);
  const Vec3d c = curve.at(place.u);
  const Vec3d x = c + place.normal * outside_->radius;
  if (min(x, part.low) != part.low || max(x, part.high) != part.high) return false;
  const bool is_end = place.u <= curve.u0 || place.u >= curve.u1;
  if (part.has_sides && !is_end) {
    if (!is_between(place.normal, part.side_a, part.side_b)) return false;
  } else {
    const Contacts contacts = contacts_at(c);
    const auto& g = contacts.toward;
    bool found = false;
    for (std::size_t i = 0; i < contacts.count; ++i) {
      for (std::size_t j = i + 1; j < contacts.count && !found; ++j) {
        found = is_between(place.normal, g[i], g[j]);
        for (std::size_t k = j + 1; k < contacts.count && !found; ++k) {
          found = is_between(place.normal, g[i], g[j], g[k]);
        }
      }
    }
    if (!found) return false;
  }
  if (place.u > part.plain0 && place.u < part.plain1) return true;
  const double r = outside_->radius;
  if (outside_->pipes.holds(x, r * kOnBall)) return false;
  return !part.among_walls || !outside_->is_beneath(x + place.normal * (kBehind * r));
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
