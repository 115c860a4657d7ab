#include "rounding/crease_cutter.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace arris {
namespace {

// Pieces of curves shorter than this part of the radius are none.
constexpr double kShortest = 1e-7;
// Of more triangles than these the tree finds the near ones faster.
constexpr std::size_t kManyNear = 48;

double length_scale(const CreaseCurve& curve) {
  return curve.is_line ? 1 : std::max(length(curve.a), length(curve.b));
}

std::pair<Vec3d, Vec3d> box_of(const CreaseCurve& curve) {
  const Vec3d p0 = curve.at(curve.u0), p1 = curve.at(curve.u1);
  if (curve.is_line) return {min(p0, p1), max(p0, p1)};
  // The points of an ellipse lie within this of a part's chord.
  const double angle = std::min(curve.u1 - curve.u0, 2 * kPi);
  const Vec3d bulge((1 - std::cos(0.5 * angle)) * std::hypot(length(curve.a), length(curve.b)));
  return {min(p0, p1) - bulge, max(p0, p1) + bulge};
}

// A convex function's value and slope at a place.
struct Sample {
  double u, value, slope;
};

// Where f is below 0 between two places; nothing: nowhere. The function is convex: it lies above its tangents.
template <class Function>
std::optional<Sample> find_below(const Function& f, Sample low, Sample high) {
  for (int i = 0; i < 60; ++i) {
    if (low.value < 0) return low;
    if (high.value < 0) return high;
    if (low.slope >= 0 || high.slope <= 0) return std::nullopt;
    const double u = (high.value - low.value + low.slope * low.u - high.slope * high.u) /
                     (low.slope - high.slope);
    if (!(u > low.u && u < high.u)) return std::nullopt;
    if (low.value + low.slope * (u - low.u) >= 0) return std::nullopt;
    const Sample middle = f(u);
    (middle.slope < 0 ? low : high) = middle;
    if (middle.value < 0) return middle;
  }
  return std::nullopt;
}

// Of a convex function that is 0 or more at `at` and below 0 beyond: Newton's steps stay on this side.
template <class Function>
double root_before(const Function& f, Sample at) {
  for (int i = 0; i < 40 && at.value > 0; ++i) {
    const double u = at.u - at.value / at.slope;
    if (!std::isfinite(u) || u == at.u) break;
    at = f(u);
  }
  return at.u;
}

// By golden sections, until it is below 0 or can't come to be. speed: by which f changes at most.
template <class Function>
double minimum(const Function& f, double speed, double low, double high) {
  constexpr double kGolden = 0.6180339887498949;
  double u = high - kGolden * (high - low), v = low + kGolden * (high - low);
  double fu = f(u), fv = f(v);
  for (int i = 0; i < 60 && low < high; ++i) {
    const double least = std::min(fu, fv);
    if (least < 0 || least > speed * (high - low)) break;
    if (fu < fv) {
      high = v;
      v = u;
      fv = fu;
      u = high - kGolden * (high - low);
      fu = f(u);
    } else {
      low = u;
      u = v;
      fu = fv;
      v = low + kGolden * (high - low);
      fv = f(v);
    }
  }
  return fu < fv ? u : v;
}

// Between a place where f < 0 and one where it may not be; the latter if it is not.
template <class Function>
double root(const Function& f, double below, double above) {
  if (f(above) < 0) return above;
  for (int i = 0; i < 48; ++i) {
    const double middle = 0.5 * (below + above);
    (f(middle) < 0 ? below : above) = middle;
  }
  return above;
}

}  // namespace

double CreaseCutter::shortest(const CreaseCurve& curve) const {
  return kShortest * r_ / length_scale(curve);
}

void CreaseCutter::cut_reached(const CreaseCurve& curve, std::vector<CreaseCurve>& out) {
  near_.clear();
  const auto [low, high] = box_of(curve);
  const Vec3d reach(r_ + tolerance_);
  const Vec3d near_low = low - reach, near_high = high + reach;
  surface_.for_each_near(near_low, near_high, [&](const SurfaceTriangle& t) {
    if (reaches_into(t, near_low, near_high)) near_.push_back(&t);
  });
  std::ranges::sort(near_);
  near_.erase(std::unique(near_.begin(), near_.end()), near_.end());
  at_.assign({curve.u0, curve.u1});
  add_reaches_of_all(curve);
  for_pieces(
      curve, at_, [&](Vec3d x) { return is_on_erosion(x, curve); },
      [&](const CreaseCurve& piece) { out.push_back(piece); });
}

// r from its features, and from nothing less.
bool CreaseCutter::is_on_erosion(Vec3d x, const CreaseCurve& curve) const {
  const double least = r_ - tolerance_, most = r_ + tolerance_;
  bool on_a = curve.face_a == kNone, on_b = curve.face_b == kNone, touches = false;
  bool is_free = true;
  const auto look = [&](const SurfaceTriangle& t) {
    if (!is_free || is_plainly_beyond(x, t, most)) return;
    const double squared = length_squared(x - nearest_on_triangle(x, t));
    if (squared > most * most) return;
    is_free = squared >= least * least;
    touches = true;
    on_a = on_a || t.region == curve.face_a;
    on_b = on_b || t.region == curve.face_b;
  };
  if (near_.size() > kManyNear) {
    surface_.for_each_near(x - Vec3d(most), x + Vec3d(most), look);
  } else {
    for (const SurfaceTriangle* t : near_) look(*t);
  }
  return is_free && touches && on_a && on_b;
}

// Where the curve comes within r of a triangle, or leaves it.
void CreaseCutter::add_reaches_of_all(const CreaseCurve& curve) {
  samples_.clear();
  // No point of the curve is farther from its middle than half its length.
  const Vec3d middle = curve.at(0.5 * (curve.u0 + curve.u1));
  const double half = 0.5 * (curve.u1 - curve.u0) * length_scale(curve);
  for (const SurfaceTriangle* const t : near_) {
    if (t->region == curve.face_a || t->region == curve.face_b) continue;
    if (is_apart(curve, *t) || is_of_features(*t)) continue;
    if (length(middle - nearest_on_triangle(middle, *t)) - half >= threshold_) continue;
    if (curve.is_line) {
      add_reaches_of_line(curve, *t);
    } else {
      add_reaches_of_arc(curve, *t);
    }
  }
}

bool CreaseCutter::is_of_features(const SurfaceTriangle& t) const {
  const auto has = [&](Vec3d p) { return t.p0 == p || t.p1 == p || t.p2 == p; };
  return std::ranges::any_of(corners_, has) || std::ranges::any_of(edges_, [&](const auto& edge) {
           return has(edge.first) && has(edge.second);
         });
}

// Whether all of it is beyond r on one side of the triangle's plane.
bool CreaseCutter::is_apart(const CreaseCurve& curve, const SurfaceTriangle& t) const {
  const Vec3d n = cross(t.p1 - t.p0, t.p2 - t.p0);
  const double limit = threshold_ * length(n);
  if (curve.is_line) {
    const double h0 = dot(n, curve.at(curve.u0) - t.p0), h1 = dot(n, curve.at(curve.u1) - t.p0);
    return std::min(h0, h1) >= limit || std::max(h0, h1) <= -limit;
  }
  const double middle = dot(n, curve.center - t.p0);
  return std::abs(middle) - std::hypot(dot(n, curve.a), dot(n, curve.b)) >= limit;
}

void CreaseCutter::add_reaches_of_line(const CreaseCurve& line, const SurfaceTriangle& t) {
  const auto above = [&](double u) {
    const Vec3d x = line.at(u), away = x - nearest_on_triangle(x, t);
    const double distance = length(away);
    return Sample{u, distance - threshold_, distance > 0 ? dot(away, line.a) / distance : 0};
  };
  const Sample low = above(line.u0), high = above(line.u1);
  if (!find_below(above, low, high)) return;
  if (low.value >= 0) at_.push_back(root_before(above, low));
  if (high.value >= 0) at_.push_back(root_before(above, high));
}

void CreaseCutter::add_reaches_of_arc(const CreaseCurve& arc, const SurfaceTriangle& t) {
  const auto above = [&](double u) {
    const Vec3d x = arc.at(u);
    return length(x - nearest_on_triangle(x, t)) - threshold_;
  };
  // Minima are looked for between samples.
  if (samples_.empty()) sample(arc);
  values_.clear();
  for (const auto& [u, x] : samples_) {
    values_.push_back(length(x - nearest_on_triangle(x, t)) - threshold_);
  }
  const auto u_of = [&](std::size_t i) { return samples_[i].u; };
  const std::size_t last = samples_.size() - 1;
  for (std::size_t i = 0; i <= last; ++i) {
    const bool is_least =
        (i == 0 || values_[i] <= values_[i - 1]) && (i == last || values_[i] <= values_[i + 1]);
    if (!is_least || values_[i] <= 0) continue;
    const double low = u_of(i == 0 ? 0 : i - 1), high = u_of(std::min(i + 1, last));
    const double u = minimum(above, length_scale(arc), low, high);
    if (above(u) >= 0) continue;
    at_.push_back(root(above, u, low));
    at_.push_back(root(above, u, high));
  }
  for (std::size_t i = 0; i < last; ++i) {
    if ((values_[i] < 0) == (values_[i + 1] < 0)) continue;
    const bool first = values_[i] < 0;
    at_.push_back(root(above, u_of(first ? i : i + 1), u_of(first ? i + 1 : i)));
  }
}

void CreaseCutter::sample(const CreaseCurve& arc) {
  const int count = std::max(4, int(std::ceil((arc.u1 - arc.u0) / radians(8))));
  const double step = (arc.u1 - arc.u0) / count;
  for (int i = 0; i <= count; ++i) {
    const double u = arc.u0 + step * i;
    samples_.push_back({u, arc.at(u)});
  }
}

}  // namespace arris
