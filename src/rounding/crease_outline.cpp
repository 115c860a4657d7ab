#include "rounding/crease_outline.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>

namespace arris {
namespace {

// Of the radius: a point this near to the sharp surface is on it.
constexpr double kOnSurface = 1e-4;
// Rays almost along an edge would stay in its void for ever: they are followed for as many radii.
constexpr double kFarthest = 100;
// Of n in a wedge or between sides: rounding of directions.
constexpr double kSlack = 1e-9;
// Of the turn between two sides: with less, they look smooth however narrow their rounding is.
const double kSmooth = std::cos(radians(8));
// Curves are halved so often where they begin or end.
constexpr int kMostHalvings = 12;
constexpr int kHidden = 2;

// A point of a curve on balls, perhaps.
struct Touch {
  double u = 0;
  bool exists = false;
  int side = 0;  // of the surface: on it, before or beyond, or kHidden
  Vec3d c, n;
  CreaseWedge wedge;
  double r = 0;

  [[nodiscard]] bool is_on() const { return exists && side == 0; }
};

class OutlineFinder {
 public:
  OutlineFinder(const CreasedSolid& solid, Vec3d eye, VoidDepths depths)
      : solid_(solid), r_(solid.radius), eye_(eye), depths_(depths) {}

  std::vector<CreaseLine> outline() {
    for (const CreasePipe& pipe : solid_.shape().pipes) {
      axis_ = pipe.curve.is_line ? normalize(pipe.curve.a) : Vec3d();
      for (const double side : {-1.0, 1.0}) {
        const auto touch = [&](double u) { return touch_pipe(pipe, u, side); };
        pipe.curve.is_line ? add_line(pipe, touch) : add_arc(pipe, touch);
      }
    }
    for (const CreaseJoint& joint : solid_.shape().joints) {
      axis_ = normalize(solid_.shape().pipes[joint.pipes[0]].curve.a);
      for (const double side : {-1.0, 1.0}) add_joint(joint, side);
    }
    axis_ = {};
    for (const CreaseBall& ball : solid_.shape().balls) add_ball(ball);
    return std::move(out_);
  }

  std::vector<CreaseLine> middles() {
    depths_ = VoidDepths::none;
    for (const CreasePipe& pipe : solid_.shape().pipes) {
      const auto touch = [&](double u) { return touch_middle(pipe, u); };
      pipe.curve.is_line ? add_line(pipe, touch) : add_arc(pipe, touch);
      for (const bool last : {false, true}) add_middle_of_ball(pipe, last, touch);
    }
    return std::move(out_);
  }

 private:
  [[nodiscard]] Vec3d place(const Touch& t) const { return t.c + t.n * t.r; }

  [[nodiscard]] Touch touch_pipe(const CreasePipe& pipe, double u, double side) const {
    Touch out{u, false, 0, pipe.curve.at(u), {}, pipe.wedge_at(u), pipe.curve.radius_at(u)};
    const Vec3d direction = normalize(pipe.curve.derivative(u));
    const Vec3d to_eye = eye_ - out.c;
    const double along = dot(to_eye, direction);
    const Vec3d w = to_eye - direction * along;
    const double distance = length(w);
    // Where balls grow, n leans back: n·T = −growth.
    const double growth = pipe.curve.growth(), upright = std::sqrt(1 - growth * growth);
    const double cosine = (out.r + growth * along) / (upright * distance);
    if (!(std::abs(cosine) < 1)) return out;
    out.exists = true;
    const double sine = std::sqrt(1 - cosine * cosine);
    const Vec3d x = w / distance;
    out.n = (x * cosine + cross(direction, x) * (side * sine)) * upright - direction * growth;
    Vec3d sum = out.wedge.a + out.wedge.b;
    sum = sum - direction * dot(sum, direction);
    const auto turn = [&](Vec3d d) {
      return std::atan2(dot(cross(sum, d), direction), dot(sum, d));
    };
    const double at = turn(out.n);
    out.side = at < turn(out.wedge.a) - kSlack ? -1 : at > turn(out.wedge.b) + kSlack ? 1 : 0;
    if (out.side == 0 && is_hollow(pipe.curve, out, direction)) out.side = kHidden;
    return out;
  }

  // On the inner side of a bent pipe the surface may curve towards the ray that touches it: it hides the place. With κ
  // the crease's curvature and α = d·T of the ray's direction d, the surface's curvature along it has the sign of
  // (1 − α²)/r − α² κ·n / (1 − r κ·n).
  [[nodiscard]] bool is_hollow(const CreaseCurve& curve, const Touch& t, Vec3d direction) const {
    if (curve.is_line) return false;
    const Vec3d bend = (curve.center - t.c) / length_squared(curve.derivative(t.u));
    const double along = dot(normalize(place(t) - eye_), direction);
    return t.r * dot(bend, t.n) >= 1 - along * along;
  }

  [[nodiscard]] Touch touch_middle(const CreasePipe& pipe, double u) const {
    Touch out{u, false, 0, pipe.curve.at(u), {}, pipe.wedge_at(u), pipe.curve.radius_at(u)};
    const auto& [a, b] = out.wedge;
    if (dot(a, b) > kSmooth) return out;
    const Vec3d to_eye = eye_ - out.c;
    out.exists = dot(a, to_eye) > out.r && dot(b, to_eye) > out.r;
    out.n = normalize(a + b);
    return out;
  }

  // From the end of a pipe's middle.
  template <class TouchAt>
  void add_middle_of_ball(const CreasePipe& pipe, bool last, const TouchAt& touch) {
    const std::uint32_t index = pipe.balls[last ? 1 : 0];
    if (index == kNone) return;
    const CreaseBall& ball = solid_.shape().balls[index];
    if (ball.sides.empty() || dot(ball.middle, eye_ - ball.center) <= ball.radius) return;
    const Touch from = touch(last ? pipe.curve.u1 : pipe.curve.u0);
    if (!from.exists) return;
    Touch to = from;
    to.c = ball.center;
    to.n = ball.middle;
    to.r = ball.radius;
    if (!solid_.is_beneath(place(to))) emit(from, to);
  }

  // On a segment the directions are the same everywhere. It is cut where it passes into other balls.
  template <class TouchAt>
  void add_line(const CreasePipe& pipe, const TouchAt& touch) {
    const Touch first = touch(pipe.curve.u0), last = touch(pipe.curve.u1);
    if (!first.is_on()) return;
    const std::vector<double> cuts = cuts_of(place(first), place(last));
    for (std::size_t i = 1; i < cuts.size(); ++i) {
      const auto at = [&](double part) {
        Touch t = first;
        t.u = first.u + (last.u - first.u) * part;
        t.c = first.c + (last.c - first.c) * part;
        t.r = first.r + (last.r - first.r) * part;
        return t;
      };
      if (solid_.is_beneath(place(at(0.5 * (cuts[i - 1] + cuts[i]))))) continue;
      emit(at(cuts[i - 1]), at(cuts[i]));
    }
  }

  // Fractions of a segment of the surface at which it may begin or cease to be within balls.
  [[nodiscard]] std::vector<double> cuts_of(Vec3d p, Vec3d q) const {
    std::vector<double> cuts{0, 1};
    const double least = -solid_.beneath(), extent = length(q - p);
    solid_.pipes.for_each_along(p, q - p, 1, [&](const CreaseCurve& other) {
      const auto distance = [&](double part) {
        return distance_to_balls(other, p + (q - p) * part);
      };
      // Distances change by no more than the way along the segment.
      const double at_p = distance(0), at_q = distance(1);
      if (at_p + at_q - extent >= 2 * least) return;
      double low = 0, high = 1, at_nearest = std::min(at_p, at_q);
      double nearest = at_p < at_q ? 0 : 1;
      while (at_nearest >= least && at_nearest - (high - low) * extent < least &&
             high - low > 1e-6) {
        const double u = low + (high - low) / 3, v = high - (high - low) / 3;
        const double at_u = distance(u), at_v = distance(v);
        (at_u < at_v ? high : low) = at_u < at_v ? v : u;
        nearest = at_u < at_v ? u : v;
        at_nearest = std::min(at_u, at_v);
      }
      if (at_nearest >= least) return;
      for (const double far : {0.0, 1.0}) {
        if ((far == 0 ? at_p : at_q) < least) continue;
        double inside = nearest, outside = far;
        for (int i = 0; i < 30; ++i) {
          const double middle = 0.5 * (inside + outside);
          (distance(middle) < least ? inside : outside) = middle;
        }
        cuts.push_back(outside);
      }
    });
    std::ranges::sort(cuts);
    return cuts;
  }

  // On the ball between two cones, from the end of one's line to that of the other's.
  void add_joint(const CreaseJoint& joint, double side) {
    const auto touch_end = [&](std::size_t i, double its_side) {
      const CreasePipe& pipe = solid_.shape().pipes[joint.pipes[i]];
      return touch_pipe(pipe, joint.is_last[i] ? pipe.curve.u1 : pipe.curve.u0, its_side);
    };
    const Touch from = touch_end(0, side);
    Touch to = touch_end(1, side);
    const Touch other = touch_end(1, -side);
    if (other.exists && dot(other.n, from.n) > dot(to.n, from.n)) to = other;
    if (!from.is_on() || !to.is_on()) return;
    const Vec3d z = normalize(eye_ - from.c);
    const double cosine = from.r / length(eye_ - from.c), sine = std::sqrt(1 - cosine * cosine);
    const auto round = [&](double part) {
      const Vec3d n = from.n + (to.n - from.n) * part;
      Touch t = from;
      t.u = part;
      t.n = z * cosine + normalize(n - z * dot(n, z)) * sine;
      return t;
    };
    const double turn = std::acos(std::clamp(dot(from.n, to.n), -1.0, 1.0));
    follow(0, 1, std::max(1, int(std::ceil(turn / kArcStep))), round);
  }

  template <class TouchAt>
  void add_arc(const CreasePipe& pipe, const TouchAt& touch) {
    follow(pipe.curve.u0, pipe.curve.u1, CreasePipe::steps_of(pipe.curve), touch);
  }

  // Chords of the parts that are on the surface.
  template <class TouchAt>
  void follow(double u0, double u1, int steps, const TouchAt& touch_at) {
    const auto touch = [&](double u) {
      Touch t = touch_at(u);
      if (t.is_on() && solid_.is_beneath(place(t))) t.side = kHidden;
      return t;
    };
    Touch before = touch(u0);
    for (int i = 1; i <= steps; ++i) {
      const Touch after = touch(u0 + (u1 - u0) * i / steps);
      follow_step(before, after, 0, touch);
      before = after;
    }
    flush();
  }

  template <class TouchAt>
  void follow_step(const Touch& a, const Touch& b, int halvings, const TouchAt& touch) {
    const bool alike = a.exists == b.exists && a.side == b.side;
    const bool turns = a.is_on() && b.is_on() && dot(a.n, b.n) < std::cos(kArcStep);
    if ((!alike || turns) && halvings < kMostHalvings) {
      const Touch middle = touch(0.5 * (a.u + b.u));
      follow_step(a, middle, halvings + 1, touch);
      follow_step(middle, b, halvings + 1, touch);
      return;
    }
    if (!a.is_on() || !b.is_on()) return flush();
    if (!run_) run_ = Run{a, a};
    if (dot(run_->first.n, b.n) < std::cos(kArcStep) || halvings == 0) {
      emit(run_->first, a);
      run_ = Run{a, b};
    }
    run_->last = b;
  }

  // What halving cut is one chord again.
  void flush() {
    if (run_) emit(run_->first, run_->last);
    run_.reset();
  }

  void add_ball(const CreaseBall& ball) {
    const Vec3d to_eye = eye_ - ball.center;
    const double distance = length(to_eye);
    if (!(distance > ball.radius)) return;
    const double cosine = ball.radius / distance, sine = std::sqrt(1 - cosine * cosine);
    const Vec3d z = to_eye / distance;
    const Vec3d x = normalize(std::abs(z.x) < 0.6 ? cross(z, {1, 0, 0}) : cross(z, {0, 1, 0}));
    const Vec3d y = cross(z, x);
    ball_ = &ball;
    const auto touch = [&](double angle) {
      const Vec3d n = z * cosine + x * (sine * std::cos(angle)) + y * (sine * std::sin(angle));
      return Touch{angle, true, 0, ball.center, n, {}, ball.radius};
    };
    // Where the circle crosses a side, and between.
    std::vector<double> cuts;
    for (const Vec3d side : ball.sides) {
      // cosine z·side + sine (cos x·side + sin y·side) = 0
      const double p = sine * dot(x, side), q = sine * dot(y, side), k = -cosine * dot(z, side);
      const double size = std::hypot(p, q);
      if (size <= std::abs(k)) continue;
      const double middle = std::atan2(q, p), half = std::acos(k / size);
      for (const double angle : {middle - half, middle + half}) {
        cuts.push_back(angle < 0 ? angle + 2 * kPi : angle >= 2 * kPi ? angle - 2 * kPi : angle);
      }
    }
    if (cuts.empty()) cuts.push_back(0);
    std::ranges::sort(cuts);
    cuts.push_back(cuts.front() + 2 * kPi);
    for (std::size_t i = 1; i < cuts.size(); ++i) {
      if (cuts[i] - cuts[i - 1] < kSlack) continue;
      const Vec3d n = touch(0.5 * (cuts[i - 1] + cuts[i])).n;
      const auto is_inside = [&](Vec3d side) { return dot(n, side) >= 0; };
      if (!std::ranges::all_of(ball.sides, is_inside)) continue;
      const int steps = std::max(1, int(std::ceil((cuts[i] - cuts[i - 1]) / kArcStep)));
      follow(cuts[i - 1], cuts[i], steps, touch);
    }
    ball_ = nullptr;
  }

  void emit(const Touch& from, const Touch& to) {
    CreaseLine line{place(from), place(to), from.wedge.a - from.wedge.b};
    if (line.a == line.b) return;
    if (depths_ == VoidDepths::found) {
      const double own = std::max(own_depth(line.a), own_depth(line.b));
      line.void_depth = std::min(own + neighbor_depth(from, line), kFarthest * r_);
    }
    out_.push_back(line);
  }

  // Either way along the ray as far as the sharp solid goes.
  [[nodiscard]] double own_depth(Vec3d p) const {
    const Vec3d d = normalize(p - eye_);
    double most = 0;
    for (const Vec3d way : {d, -d}) {
      most = std::max(most, std::min(solid_.surface.first_exit(p, way, 0).t, kFarthest * r_));
    }
    return most;
  }

  // The void of a touching solid is at most as wide as two tangents r tan(θ/2), θ the angle between the faces.
  [[nodiscard]] double neighbor_depth(const Touch& t, const CreaseLine& line) const {
    const Vec3d pair[2] = {t.wedge.a, t.wedge.b};
    const std::span<const Vec3d> contacts =
        ball_ != nullptr ? std::span<const Vec3d>(ball_->contacts) : std::span<const Vec3d>(pair);
    double cosine = 1;
    for (const Vec3d a : contacts) {
      for (const Vec3d b : contacts) cosine = std::min(cosine, dot(a, b));
    }
    const double tangent = std::sqrt((1 - cosine) / std::max(1 + cosine, 1e-9));
    const Vec3d d = normalize(line.a - eye_);
    const double across = length(d - axis_ * dot(d, axis_));
    return t.r * 2 * tangent / std::max(across, 1 / kFarthest);
  }

  struct Run {
    Touch first, last;
  };

  const CreasedSolid& solid_;
  double r_;
  Vec3d eye_;
  VoidDepths depths_;
  Vec3d axis_;  // of the segment that is added
  const CreaseBall* ball_ = nullptr;
  std::optional<Run> run_;
  std::vector<CreaseLine> out_;
};

}  // namespace

std::vector<CreaseLine> find_crease_outline(const CreasedSolid& solid, Vec3d eye,
                                            VoidDepths depths) {
  return OutlineFinder(solid, eye, depths).outline();
}

std::vector<CreaseLine> find_crease_middles(const CreasedSolid& solid, Vec3d eye) {
  return OutlineFinder(solid, eye, VoidDepths::none).middles();
}

// A place of the edge is kept if a ball that fits touches it. Their centres lie on an arc about it; where some of it
// fits but not all, it ends on creases. So what is kept begins and ends where a crease that touches the edge does, or
// turns back along it.
std::vector<std::pair<double, double>> find_kept_parts(const CreasedSolid& solid,
                                                       const FaceEdge& edge) {
  const double slack = 2 * solid.tolerance;
  const Vec3d along = edge.p1 - edge.p0;
  const double extent = length(along);
  const auto foot = [&](Vec3d x) { return dot(x - edge.p0, along) / (extent * extent); };
  std::vector<double> cuts{0, 1};
  solid.pipes.for_each_along(edge.p0, along, 1, [&](const CreaseCurve& part) {
    std::vector<double> us{part.u0, part.u1};
    if (!part.is_line) {
      const double back = std::atan2(dot(part.b, along), dot(part.a, along));
      for (int i = -2; i <= 4; ++i) {
        const double u = back + i * kPi;
        if (u > part.u0 && u < part.u1) us.push_back(u);
      }
    }
    for (const double u : us) {
      const double at = foot(part.at(u));
      if (at <= 0 || at >= 1) continue;
      if (length(part.at(u) - edge.p0 - along * at) <= part.radius_at(u) + slack)
        cuts.push_back(at);
    }
  });
  std::ranges::sort(cuts);
  const auto is_kept = [&](Vec3d y) {
    if (solid.is_kept(y, edge.normal0, edge.region0)) return true;
    if (solid.is_kept(y, edge.normal1, edge.region1)) return true;
    bool kept = false;
    solid.pipes.for_each_near(
        y, y, [&](const CreaseCurve& part) { kept = kept || distance_to_balls(part, y) <= slack; });
    return kept;
  };
  const double least = kOnSurface * solid.radius / extent;
  std::vector<std::pair<double, double>> parts;
  for (std::size_t i = 1; i < cuts.size(); ++i) {
    if (cuts[i] - cuts[i - 1] < least) continue;
    if (!is_kept(edge.p0 + along * (0.5 * (cuts[i - 1] + cuts[i])))) continue;
    if (!parts.empty() && cuts[i - 1] - parts.back().second <= least) {
      parts.back().second = cuts[i];
    } else {
      parts.emplace_back(cuts[i - 1], cuts[i]);
    }
  }
  return parts;
}

}  // namespace arris
