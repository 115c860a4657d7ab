#include "rounding/plain_crease.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/parallel_collect.h"
#include "rounding/clipped_triangle.h"

namespace arris {
namespace {

// Relative to the radius: shorter stretches are of little use.
constexpr double kShortest = 0.25;
// Relative to the radius: pieces into which other creases are cut.
constexpr double kFinest = 1.0 / 128;
// Parts of pipes that one thread looks at at a time.
constexpr std::size_t kPartsAtOnce = 64;
// Sine of the angle between the faces' normals, and one plus its cosine, from which on sections are well-shaped.
constexpr double kLeastSine = 0.02, kLeastOpening = 0.02;

// The prism's section, in its plane: n_a along x.
class Section {
 public:
  Section(double radius, double cosine) : r_(radius), c_(cosine), s_(std::sqrt(1 - c_ * c_)) {}

  // Where the faces meet.
  [[nodiscard]] Vec3d tip() const { return {r_, r_ * (1 - c_) / s_, 0}; }

  // From a place (a, b, s) to what lies between the normals' directions, under the faces and beyond r.
  [[nodiscard]] double distance_from(Vec3d p) const {
    const double beta = (p.y - c_ * p.x) / (s_ * s_), alpha = p.x - c_ * beta;
    const Vec3d x(p.x, beta * s_, 0);
    if (alpha >= 0 && beta >= 0) {
      const double l = length(x);
      if (l < r_) return r_ - l;
      if (p.x <= r_ && p.y <= r_) return 0;
    }
    return std::min(distance(x, {r_, 0, 0}), distance(x, {r_ * c_, r_ * s_, 0}));
  }

 private:
  // To the side between the tip and where the ball touches a face.
  [[nodiscard]] double distance(Vec3d x, Vec3d touching) const {
    const Vec3d side = tip() - touching;
    const double part = dot(x - touching, side) / length_squared(side);
    return length(x - touching - side * std::clamp(part, 0.0, 1.0));
  }

  double r_, c_, s_;
};

class StretchFinder {
 public:
  StretchFinder(const CreasedSolid& solid, const CreaseCurve& line, Vec3d normal_a, Vec3d normal_b)
      : solid_(solid),
        line_(line),
        na_(normal_a),
        nb_(normal_b),
        r_(solid.radius),
        slack_(2 * solid.tolerance),
        cosine_(dot(normal_a, normal_b)),
        section_(r_, cosine_) {}

  [[nodiscard]] Stretch find() {
    stretch_ = {line_.u0, line_.u1};
    const auto [low, high] = box();
    solid_.surface.for_each_near(low, high, [&](const SurfaceTriangle& t) {
      if (t.region != line_.face_a && t.region != line_.face_b && is_long()) cut_at(t);
    });
    solid_.pipes.for_each_near(low, high, [&](const CreaseCurve& c) { cut_at(c); });
    return stretch_;
  }
  [[nodiscard]] bool is_long() const { return stretch_.s1 - stretch_.s0 > kShortest * r_; }

 private:
  // (a, b, s)
  [[nodiscard]] Vec3d spot_of(Vec3d x) const {
    const Vec3d from = x - line_.center;
    return {dot(na_, from), dot(nb_, from), dot(line_.a, from)};
  }

  // Of the prism.
  [[nodiscard]] std::pair<Vec3d, Vec3d> box() const {
    const Vec3d tip = (na_ + nb_) * (r_ / (1 + cosine_));
    const Vec3d low = min(tip, min(na_ * r_, nb_ * r_)), high = max(tip, max(na_ * r_, nb_ * r_));
    const Vec3d p0 = line_.at(line_.u0), p1 = line_.at(line_.u1);
    return {min(p0, p1) + low - Vec3d(slack_), max(p0, p1) + high + Vec3d(slack_)};
  }

  // What a triangle has in the hull of the prism.
  void cut_at(const SurfaceTriangle& t) {
    const std::array<Vec3d, 3> corners{spot_of(t.p0), spot_of(t.p1), spot_of(t.p2)};
    const auto above_a = [&](Vec3d p) { return p.x - r_ - slack_; };
    const auto above_b = [&](Vec3d p) { return p.y - r_ - slack_; };
    const auto below = [&](Vec3d p) { return r_ * (1 + cosine_) - slack_ - p.x - p.y; };
    const auto is_beyond = [&](const auto& height) {
      return height(corners[0]) > 0 && height(corners[1]) > 0 && height(corners[2]) > 0;
    };
    if (is_beyond(above_a) || is_beyond(above_b) || is_beyond(below)) return;
    ClippedTriangle part(corners);
    part.clip(above_a);
    part.clip(above_b);
    part.clip(below);
    if (part.corners().empty()) return;
    const auto [low, high] = std::ranges::minmax(part.corners(), {}, &Vec3d::z);
    stretch_.cut(low.z - slack_, high.z + slack_);
  }

  // A place of a crease.
  struct Place {
    double u;
    Vec3d p;  // (a, b, s)
  };
  [[nodiscard]] Place place_on(const CreaseCurve& c, double u) const {
    return {u, spot_of(c.at(u))};
  }

  void cut_at(const CreaseCurve& c) {
    if (!is_long()) return;
    const double speed = c.is_line ? 1 : std::sqrt(length_squared(c.a) + length_squared(c.b));
    const double half = 0.5 * (c.u1 - c.u0), reach = r_ + half * speed;
    const Place middle = place_on(c, c.u0 + half);
    if (middle.p.z + reach <= stretch_.s0 || middle.p.z - reach >= stretch_.s1) return;
    cut_at(c, speed, place_on(c, c.u0), place_on(c, c.u1));
  }

  // Where balls around a crease, of the given speed at most, reach into the void.
  void cut_at(const CreaseCurve& c, double speed, const Place& from, const Place& to) {
    if (!is_long()) return;
    const double half = 0.5 * (to.u - from.u);
    if (is_under_faces(c, half, max(from.p, to.p))) return;
    const Place middle = place_on(c, from.u + half);
    const Vec3d p = middle.p;
    const double extent = half * speed;
    const double d = std::max(section_.distance_from(p) - extent - slack_, 0.0);
    if (d >= r_) return;
    const double reach = std::sqrt(r_ * r_ - d * d) + extent;
    if (p.z + reach <= stretch_.s0 || p.z - reach >= stretch_.s1) return;
    if (extent <= kFinest * r_) {
      stretch_.cut(p.z - reach, p.z + reach);
      return;
    }
    // What is nearer to the stretch's middle may spare the other half.
    const double middle_s = 0.5 * (stretch_.s0 + stretch_.s1);
    const bool is_from_nearer = std::abs(from.p.z - middle_s) <= std::abs(to.p.z - middle_s);
    if (is_from_nearer) cut_at(c, speed, from, middle);
    cut_at(c, speed, middle, to);
    if (!is_from_nearer) cut_at(c, speed, from, middle);
  }

  // Balls around places that lie under both offset faces don't: the points of the section are at least as near to the
  // axis as to these. highest: of the ends of a piece.
  [[nodiscard]] bool is_under_faces(const CreaseCurve& c, double half, Vec3d highest) const {
    if (highest.x > slack_ || highest.y > slack_) return false;
    if (c.is_line) return true;
    const double rise = 1 - std::cos(half);
    return highest.x + rise * std::hypot(dot(na_, c.a), dot(na_, c.b)) <= slack_ &&
           highest.y + rise * std::hypot(dot(nb_, c.a), dot(nb_, c.b)) <= slack_;
  }

  const CreasedSolid& solid_;
  const CreaseCurve& line_;
  Vec3d na_, nb_;
  double r_, slack_, cosine_;
  Section section_;
  Stretch stretch_{};
};

}  // namespace

std::optional<PlainCrossing> cross_plainly(const PlainCrease& crease, const CreasedSolid& solid,
                                           std::uint32_t face, const Ray& ray) {
  const double r = solid.radius;
  const Vec3d rel = ray.origin - crease.p0;
  const double along = dot(rel, crease.axis);
  const auto is_beside = [&](double s) { return s >= 0 && s <= crease.length; };
  if (!is_beside(along)) return std::nullopt;
  const Vec3d other = face == crease.face_a ? crease.normal_b : crease.normal_a;
  const double above = dot(other, rel);
  if (above <= r * crease.cosine + solid.tolerance || above > r + solid.tolerance) {
    return std::nullopt;
  }
  const double speed = dot(ray.direction, crease.axis);
  const Vec3d offset = rel - crease.axis * along;
  const Vec3d across = ray.direction - crease.axis * speed;
  const double b = dot(offset, across), c = length_squared(offset) - r * r;
  const double discriminant = b * b - length_squared(across) * c;
  if (b < 0 && discriminant >= 0 && c > 0) {
    const double t = c / (-b + std::sqrt(discriminant));
    if (!is_beside(along + speed * t)) return std::nullopt;
    return PlainCrossing{t, (offset + across * t) * (1 / r)};
  }
  const double approach = dot(other, ray.direction);
  if (!(approach > 0)) return std::nullopt;
  const double t = std::max((r - above) / approach, 0.0);
  if (!is_beside(along + speed * t)) return std::nullopt;
  return PlainCrossing{t, std::nullopt};
}

std::vector<PlainCrease> find_plain_creases(const CreasedSolid& solid,
                                            std::span<const Plane> planes) {
  if (!solid.field.is_uniform()) return {};
  const auto find = [&](std::size_t i, std::vector<PlainCrease>& out) {
    const CreaseCurve& line = solid.pipes.curve_of(std::uint32_t(i));
    if (!line.is_line || line.face_a == kNone || line.face_b == kNone) return;
    if (line.u1 - line.u0 < kShortest * solid.radius) return;
    if (solid.surface.is_joined(line.face_a, line.face_b) ||
        solid.surface.is_joined(line.face_b, line.face_a)) {
      return;
    }
    if (solid.mouths.is_behind(std::uint32_t(i))) return;
    const Vec3d na = planes[line.face_a].normal, nb = planes[line.face_b].normal;
    const double cosine = dot(na, nb);
    if (1 + cosine < kLeastOpening || 1 - cosine * cosine < kLeastSine * kLeastSine) return;
    StretchFinder finder(solid, line, na, nb);
    const Stretch stretch = finder.find();
    if (!finder.is_long()) return;
    out.push_back({line.at(stretch.s0), line.a, stretch.s1 - stretch.s0, na, nb, cosine,
                   line.face_a, line.face_b, std::uint32_t(i), false});
  };
  return parallel_collect<PlainCrease>(solid.pipes.part_count(), kPartsAtOnce, find);
}

}  // namespace arris
