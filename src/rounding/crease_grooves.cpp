#include "rounding/crease_grooves.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include "base/parallel_collect.h"

namespace arris {
namespace {

// Cells across a pipe.
constexpr int kAcross = 12;
// Of the turn between the two sides: with less, they look smooth.
const double kSmooth = std::cos(radians(8));
// Curvature times radius above which a pipe folds.
constexpr double kFolds = 1 + 1e-6;
// In radii: ends of creases this near to each other are one; how far beside a fold grooves go; steps along segments.
constexpr double kSameEnd = 1e-3;
constexpr double kBeside = 2;
constexpr double kStep = 0.125;
// In radii: chords of one groove lie so near to each other.
constexpr double kSameGroove = 0.01;

// Stretches that one thread looks at at a time.
constexpr std::size_t kStretchesAtOnce = 4;

// A place of a pipe: along it, and across from a to b.
struct GroovePlace {
  double u, v;
};

class GrooveFinder {
 public:
  GrooveFinder(const CreasedSolid& solid, const CreaseShape& shape)
      : solid_(solid), r_(solid.radius) {
    std::vector<Vec3d> ends;
    for (const CreasePipe& pipe : shape.pipes) {
      if (!folds(pipe)) continue;
      stretches_.push_back({&pipe, pipe.curve.u0, pipe.curve.u1});
      ends.push_back(pipe.curve.at(pipe.curve.u0));
      ends.push_back(pipe.curve.at(pipe.curve.u1));
    }
    // Grooves go on over what lies beside.
    for (const CreasePipe& pipe : shape.pipes) add_beside(pipe, ends);
  }

  std::vector<CreaseGroove> find() {
    const auto found = parallel_collect<Found>(
        stretches_.size(), kStretchesAtOnce,
        [&](std::size_t i, auto& list) { add_borders(stretches_[i], list); });
    for (const Found& f : found) (f.is_first ? out_ : second_).push_back(f.groove);
    add_second();
    return std::move(out_);
  }

 private:
  // Part of a pipe.
  struct Stretch {
    const CreasePipe* pipe;
    double u0, u1;
  };
  struct Found {
    CreaseGroove groove;
    bool is_first;  // from the side that counts
  };
  struct Border {
    Vec3d point, normal, other;  // the normals of the two sides
    Vec3d center, other_center;
  };

  [[nodiscard]] Vec3d normal_at(const CreasePipe& pipe, GroovePlace p) const {
    const auto& [a, b] = pipe.wedge_at(p.u);
    const double angle = std::acos(std::clamp(dot(a, b), -1.0, 1.0)), sine = std::sin(angle);
    if (!(sine > 1e-9)) return a;
    return a * (std::sin((1 - p.v) * angle) / sine) + b * (std::sin(p.v * angle) / sine);
  }
  [[nodiscard]] Vec3d point_at(const CreasePipe& pipe, GroovePlace p) const {
    return pipe.curve.at(p.u) + normal_at(pipe, p) * pipe.curve.radius_at(p.u);
  }
  [[nodiscard]] bool is_covered(const CreasePipe& pipe, GroovePlace p) const {
    return solid_.is_beneath(point_at(pipe, p));
  }

  [[nodiscard]] bool folds(const CreasePipe& pipe) const {
    if (pipe.curve.is_line) return false;
    const int steps = int(pipe.wedges.size()) - 1;
    for (int i = 0; i <= steps; ++i) {
      const double u = pipe.curve.u0 + (pipe.curve.u1 - pipe.curve.u0) * i / steps;
      const Vec3d bend =
          (pipe.curve.center - pipe.curve.at(u)) / length_squared(pipe.curve.derivative(u));
      for (int k = 0; k <= kAcross; ++k) {
        if (dot(bend, normal_at(pipe, {u, double(k) / kAcross})) * pipe.curve.r0 > kFolds)
          return true;
      }
    }
    return false;
  }

  void add_beside(const CreasePipe& pipe, std::span<const Vec3d> ends) {
    const CreaseCurve& c = pipe.curve;
    const auto is_end = [&](Vec3d p) {
      return std::ranges::any_of(ends, [&](Vec3d end) { return length(p - end) < kSameEnd * r_; });
    };
    const bool first = is_end(c.at(c.u0)), last = is_end(c.at(c.u1));
    if ((!first && !last) || folds(pipe)) return;
    const double all = c.u1 - c.u0;
    const double part = c.is_line ? std::min(kBeside * r_ / length(c.a), all) : all;
    if (part == all || (first && last && 2 * part > all)) {
      stretches_.push_back({&pipe, c.u0, c.u1});
      return;
    }
    if (first) stretches_.push_back({&pipe, c.u0, c.u0 + part});
    if (last) stretches_.push_back({&pipe, c.u1 - part, c.u1});
  }

  // Marching squares.
  void add_borders(const Stretch& stretch, std::vector<Found>& found) const {
    const CreasePipe& pipe = *stretch.pipe;
    const std::vector<double> us = places_along(stretch);
    const auto place = [&](std::size_t i, int k) {
      // Grooves run into concave edges at a small angle.
      return GroovePlace{us[i], 0.5 - 0.5 * std::cos(kPi * k / kAcross)};
    };
    std::vector<bool> before, now;
    for (std::size_t i = 0; i < us.size(); ++i) {
      now.clear();
      for (int k = 0; k <= kAcross; ++k) now.push_back(is_covered(pipe, place(i, k)));
      for (int k = 0; i > 0 && k < kAcross; ++k) {
        const std::array<GroovePlace, 4> corners{place(i - 1, k), place(i, k), place(i, k + 1),
                                                 place(i - 1, k + 1)};
        const auto at = std::size_t(k);
        add_cell(pipe, corners, {before[at], now[at], now[at + 1], before[at + 1]}, found);
      }
      before = now;
    }
  }

  // Even steps, and the ellipse's vertices: the fold lies about those, and may be narrow.
  [[nodiscard]] std::vector<double> places_along(const Stretch& stretch) const {
    const auto& [pipe, u0, u1] = stretch;
    const bool is_line = pipe->curve.is_line;
    const double extent = (u1 - u0) * length(pipe->curve.a);
    const int steps = is_line ? std::max(1, int(std::ceil(extent / (kStep * r_))))
                              : CreasePipe::steps_of(pipe->curve);
    std::vector<double> us;
    for (int i = 0; i <= steps; ++i) us.push_back(u0 + (u1 - u0) * i / steps);
    if (is_line) return us;
    const double quarter = kPi / 2;
    for (double u = std::ceil(u0 / quarter) * quarter; u < u1; u += quarter) us.push_back(u);
    std::ranges::sort(us);
    return us;
  }

  void add_cell(const CreasePipe& pipe, const std::array<GroovePlace, 4>& corners,
                const std::array<bool, 4>& covered, std::vector<Found>& found) const {
    std::vector<Border> crossings;
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t j = (i + 1) % 4;
      if (covered[i] == covered[j]) continue;
      crossings.push_back(covered[i] ? find_border(pipe, corners[j], corners[i])
                                     : find_border(pipe, corners[i], corners[j]));
    }
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
      add(crossings[i], crossings[i + 1], found);
    }
  }

  [[nodiscard]] Border find_border(const CreasePipe& pipe, GroovePlace bare,
                                   GroovePlace covered) const {
    for (int i = 0; i < 20; ++i) {
      const GroovePlace middle{0.5 * (bare.u + covered.u), 0.5 * (bare.v + covered.v)};
      (is_covered(pipe, middle) ? covered : bare) = middle;
    }
    const Vec3d x = point_at(pipe, covered);
    double least = std::numeric_limits<double>::infinity();
    Vec3d other;
    solid_.pipes.for_each_near(x, x, [&](const CreaseCurve& part) {
      const Vec3d c = part.at(nearest_parameter(part, x));
      if (length(x - c) >= least) return;
      least = length(x - c);
      other = c;
    });
    return {point_at(pipe, bare), normal_at(pipe, bare), normalize(x - other),
            pipe.curve.at(bare.u), other};
  }

  static void add(const Border& p, const Border& q, std::vector<Found>& found) {
    if (dot(p.normal, p.other) > kSmooth && dot(q.normal, q.other) > kSmooth) return;
    // Both sides may find the groove, and one of them counts.
    const Vec3d odd{0.5417, 0.6213, 0.5663};
    const bool is_first = dot(odd, p.center) < dot(odd, p.other_center);
    found.push_back({{p.point, q.point, p.normal, p.other}, is_first});
  }

  // What was found from the second side alone.
  void add_second() {
    std::ranges::sort(out_, {}, [](const CreaseGroove& g) { return g.p0.x; });
    const double step = 2 * kArcStep * r_, same = kSameGroove * r_;
    const std::size_t count = out_.size();
    for (const CreaseGroove& groove : second_) {
      const Vec3d middle = (groove.p0 + groove.p1) * 0.5;
      const auto first = std::ranges::lower_bound(
          out_.begin(), out_.begin() + std::ptrdiff_t(count), middle.x - step, {},
          [](const CreaseGroove& g) { return g.p0.x; });
      bool is_known = false;
      for (auto it = first; it != out_.begin() + std::ptrdiff_t(count); ++it) {
        if (it->p0.x > middle.x + step) break;
        const Vec3d along = it->p1 - it->p0;
        const double u = dot(middle - it->p0, along) / std::max(length_squared(along), 1e-300);
        is_known = is_known || length(it->p0 + along * std::clamp(u, 0.0, 1.0) - middle) < same;
      }
      if (!is_known) out_.push_back(groove);
    }
  }

  const CreasedSolid& solid_;
  double r_;
  std::vector<Stretch> stretches_;
  std::vector<CreaseGroove> out_, second_;
};

}  // namespace

std::vector<CreaseGroove> find_grooves(const CreasedSolid& solid, const CreaseShape& shape) {
  return GrooveFinder(solid, shape).find();
}

}  // namespace arris
