#include "csg/surface_curve.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "csg/crease_finder.h"

namespace arris {
namespace {

constexpr int kNewtonSteps = 12;
// Of the solid's size: converged.
constexpr double kOnCurve = 1e-11;
// Boxes below are not halved, in parts of the solid's size.
constexpr double kLeastBox = 1.0 / 2048;
// Surfaces that are tangent all over a box of this size are taken to meet smoothly.
constexpr double kTangentBox = 1.0 / 64;
// Boxes are not halved in the very middle, where symmetric solids have their edges.
constexpr double kHalf = 0.4831;
// Pieces may end this far beyond their box, in parts of it: neighbours see the curve a little differently.
constexpr double kBeyondBox = 1e-3;

bool holds_nearly(const Box3d& box, Vec3d p, double slack) {
  const Vec3d s = (box.high - box.low) * slack + Vec3d(1e-300);
  for (int k = 0; k < 3; ++k) {
    if (p[k] < box.low[k] - s[k] || p[k] > box.high[k] + s[k]) return false;
  }
  return true;
}

}  // namespace

SurfaceCurve::SurfaceCurve(const SmoothSurface& s0, const SmoothSurface& s1, double size)
    : s0_(s0), s1_(s1), size_(size) {}

Vec3d SurfaceCurve::along(Vec3d p) const {
  return cross(s0_.gradient(p), s1_.gradient(p));
}

// Newton's steps to the nearest point of both tangent planes.
std::optional<Vec3d> SurfaceCurve::nearest(Vec3d p) const {
  for (int step = 0; step < kNewtonSteps; ++step) {
    const double f0 = s0_.value(p), f1 = s1_.value(p);
    const Vec3d g0 = s0_.gradient(p), g1 = s1_.gradient(p);
    const double a = dot(g0, g0), b = dot(g0, g1), c = dot(g1, g1), det = a * c - b * b;
    if (!(det > 1e-12 * a * c)) return std::nullopt;
    const Vec3d move = g0 * ((b * f1 - c * f0) / det) + g1 * ((b * f0 - a * f1) / det);
    p += move;
    if (!is_finite(p)) return std::nullopt;
    if (length(move) < kOnCurve * size_) return p;
  }
  return std::nullopt;
}

std::optional<Vec3d> SurfaceCurve::crossing(Vec3d p, int axis, double at) const {
  Vec3d e;
  e[axis] = 1;
  for (int step = 0; step < kNewtonSteps; ++step) {
    const Vec3d g0 = s0_.gradient(p), g1 = s1_.gradient(p);
    const double det = dot(cross(g0, g1), e);
    if (!(std::abs(det) > 1e-9 * length(g0) * length(g1))) return std::nullopt;
    const Vec3d move = (cross(g1, e) * -s0_.value(p) + cross(e, g0) * -s1_.value(p) +
                        cross(g0, g1) * (at - p[axis])) /
                       det;
    p += move;
    if (!is_finite(p)) return std::nullopt;
    if (length(move) < kOnCurve * size_) return p;
  }
  return std::nullopt;
}

// The gradients of quadrics are linear, so that those at the corners bound them: if with every pair of them `along` is
// on the same side, f0, f1 and the way along are coordinates of the box.
bool SurfaceCurve::is_one_piece(const Box3d& box, Vec3d along) const {
  const std::array<Vec3d, 8> corners = corners_of(box);
  std::array<Vec3d, 8> turned, g1;
  for (std::size_t i = 0; i < 8; ++i) {
    turned[i] = cross(along, s0_.gradient(corners[i]));
    g1[i] = s1_.gradient(corners[i]);
  }
  for (const Vec3d& t : turned) {
    for (const Vec3d& g : g1) {
      if (!(dot(t, g) > 0)) return false;
    }
  }
  return true;
}

// With a ring the same by the gradients at the corners, which in tame boxes bound those between.
bool SurfaceCurve::misses_difference(const Box3d& box, Vec3d middle) const {
  constexpr double kSafely = 1.5;
  if (!s0_.is_tame(box) || !s1_.is_tame(box)) return false;
  const Vec3d g0 = s0_.gradient(middle), g1 = s1_.gradient(middle);
  const double share = dot(g0, g1) / dot(g0, g0);
  if (!std::isfinite(share)) return false;
  double steepest = 0;
  for (const Vec3d& corner : corners_of(box)) {
    steepest = std::max(steepest, length(s1_.gradient(corner) - s0_.gradient(corner) * share));
  }
  const double rounding = 1e-12 * length(g1) * size_;
  return std::abs(s1_.value(middle) - s0_.value(middle) * share) >
         kSafely * steepest * length(box.high - middle) + rounding;
}

// The curve also lies on every other quadric of the two's pencil: on that whose gradient is least in the box. Where
// surfaces are nearly tangent it tells far more than they.
bool SurfaceCurve::misses(const Box3d& box) const {
  if (s0_.misses(box) || s1_.misses(box)) return true;
  const auto* f0 = std::get_if<SpaceQuadratic>(&s0_.form());
  const auto* f1 = std::get_if<SpaceQuadratic>(&s1_.form());
  const Vec3d middle = (box.low + box.high) * 0.5;
  if (f0 == nullptr || f1 == nullptr) return misses_difference(box, middle);
  const Vec3d g0 = f0->gradient(middle), g1 = f1->gradient(middle);
  const double share = dot(g0, g1) / dot(g0, g0);
  if (!std::isfinite(share)) return false;
  SpaceQuadratic sum;
  sum.q = {f1->q.x - f0->q.x * share, f1->q.y - f0->q.y * share, f1->q.z - f0->q.z * share};
  sum.b = f1->b - f0->b * share;
  sum.c = f1->c - f0->c * share;
  // Where nothing but rounding is left of it, it says nothing.
  const double rounding = 1e-12 * (std::abs(f1->c) + std::abs(f0->c * share) + length(g1) * size_);
  sum.c += std::copysign(rounding, -sum.value(middle));
  return SmoothSurface(sum).misses(box);
}

bool SurfaceCurve::is_tangent(const Box3d& box) const {
  if (length(box.high - box.low) > kTangentBox * size_) return false;
  static const double kSine = std::sin(kTangent);
  const auto is_tangent_at = [&](Vec3d p) {
    const Vec3d g0 = s0_.gradient(p), g1 = s1_.gradient(p);
    return length(cross(g0, g1)) < kSine * length(g0) * length(g1);
  };
  const std::array<Vec3d, 8> corners = corners_of(box);
  return std::ranges::all_of(corners, is_tangent_at) && is_tangent_at((box.low + box.high) * 0.5);
}

// From p, which may lie a little outside, along the curve to where it leaves the box.
std::optional<Vec3d> SurfaceCurve::end_at(const Box3d& box, Vec3d p, Vec3d direction) const {
  for (int tries = 0; tries < 4; ++tries) {
    double best = std::numeric_limits<double>::infinity();
    int axis = 0;
    for (int k = 0; k < 3; ++k) {
      if (std::abs(direction[k]) < 1e-9) continue;
      const double t = ((direction[k] > 0 ? box.high[k] : box.low[k]) - p[k]) / direction[k];
      if (t < best) {
        best = t;
        axis = k;
      }
    }
    if (!std::isfinite(best)) return std::nullopt;
    const double at = direction[axis] > 0 ? box.high[axis] : box.low[axis];
    const std::optional<Vec3d> q = crossing(p + direction * best, axis, at);
    if (!q) return std::nullopt;
    if (holds_nearly(box, *q, kBeyondBox)) return q;
    p = *q;  // it leaves by another side
    direction = normalize(along(p)) * (dot(along(p), direction) < 0 ? -1.0 : 1.0);
  }
  return std::nullopt;
}

// p: on the curve.
SurfaceCurve::Try SurfaceCurve::try_line(const Box3d& box, Vec3d p) const {
  const Vec3d tangent = normalize(along(p));
  const std::optional<Vec3d> a = end_at(box, p, -tangent), b = end_at(box, p, tangent);
  const double least = kShortChord * size_, extent = length(box.high - box.low);
  if (!a || !b) {
    if (extent > kLeastBox * size_) return {};
    // As good as straight.
    double t0 = -extent, t1 = extent;
    for (int k = 0; k < 3; ++k) {
      if (tangent[k] == 0) continue;
      const double u = (box.low[k] - p[k]) / tangent[k], v = (box.high[k] - p[k]) / tangent[k];
      t0 = std::max(t0, std::min(u, v));
      t1 = std::min(t1, std::max(u, v));
    }
    if (!(t0 < t1)) return {Try::Outcome::none, {}};
    return {Try::Outcome::one, {p + tangent * t0, p + tangent * t1}};
  }
  if (dot(*b - *a, tangent) <= 0) return {Try::Outcome::none, {}};
  static const double kCosine = std::cos(kChordTurn);
  const double turn = dot(normalize(along(*a)), normalize(along(*b)));
  if (turn < kCosine && length(*b - *a) > least) return {};
  return {Try::Outcome::one, {*a, *b}};
}

SurfaceCurve::Try SurfaceCurve::try_box(const Box3d& box) const {
  if (is_tangent(box)) return {Try::Outcome::none, {}};
  const Vec3d middle = (box.low + box.high) * 0.5;
  const double radius = length(box.high - middle);
  const bool least = 2 * radius < kLeastBox * size_;
  const Try give_up{least ? Try::Outcome::none : Try::Outcome::halve, {}};
  const Vec3d tangent = along(middle);
  if (!(length(tangent) > 0)) return give_up;
  if (!least && !(s0_.is_tame(box) && s1_.is_tame(box) && is_one_piece(box, tangent))) {
    return give_up;
  }
  const std::optional<Vec3d> p = nearest(middle);
  if (!p) return give_up;
  const double away = length(*p - middle);
  // In coordinates that bend little what is so far away does not come back.
  if (away > 1.5 * radius)
    return {away > 4 * radius || least ? Try::Outcome::none : Try::Outcome::halve, {}};
  return try_line(box, *p);
}

void SurfaceCurve::collect_pieces(const Box3d& box,
                                  const std::function<bool(const Box3d&)>& may_hold,
                                  std::vector<Piece>& out) const {
  std::vector<Box3d> stack{box};
  while (!stack.empty()) {
    const Box3d now = stack.back();
    stack.pop_back();
    if (misses(now) || !may_hold(now)) continue;
    const Try tried = try_box(now);
    if (tried.outcome == Try::Outcome::one) out.push_back(tried.piece);
    if (tried.outcome != Try::Outcome::halve) continue;
    const Vec3d extent = now.high - now.low;
    const int axis =
        extent.x > extent.y ? (extent.x > extent.z ? 0 : 2) : (extent.y > extent.z ? 1 : 2);
    // A box too small to halve holds nothing that is seen.
    if (extent[axis] < 1e-9 * size_) continue;
    Box3d low = now, high = now;
    low.high[axis] = high.low[axis] = now.low[axis] + kHalf * extent[axis];
    stack.push_back(high);
    stack.push_back(low);
  }
}

}  // namespace arris
