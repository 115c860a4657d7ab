#include "rounding/crease_shape.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "base/parallel_collect.h"

namespace arris {
namespace {

// Curves that one thread looks at at a time.
constexpr std::size_t kCurvesAtOnce = 32;

// Of the radius: ends of creases this near to each other are one. They come from different pairs of features.
constexpr double kSameEnd = 1e-3;
// Of the volume that three directions span: below, they lie in a plane, and the creases go on from each other.
constexpr double kFlat = 1e-5;
// Of sines: what is computed of directions.
constexpr double kSlack = 1e-6;

// Directions in which a ball about c touches the surface.
class ContactFinder {
 public:
  ContactFinder(const SolidSurface& surface, double radius, double tolerance)
      : surface_(surface), slack_(2 * tolerance) {
    // A triangle beside the one that is touched may be near enough in so different a direction.
    const double beside = 2 * std::sqrt(4 * tolerance / radius);
    same_ = std::clamp(beside, 1e-3, 0.1);
  }

  [[nodiscard]] double same() const { return same_; }

  void add(Vec3d c, double radius, std::vector<Vec3d>& contacts) const {
    const double most = radius + slack_;
    std::vector<std::pair<double, Vec3d>> found;
    surface_.for_each_near(c - Vec3d(most), c + Vec3d(most), [&](const SurfaceTriangle& t) {
      const Vec3d way = nearest_on_triangle(c, t) - c;
      const double distance = length(way);
      if (distance > 0 && distance <= most) found.emplace_back(distance, way / distance);
    });
    // The nearest of those in about one direction is what is touched.
    std::ranges::sort(found, {}, [](const auto& f) { return f.first; });
    for (const auto& [distance, toward] : found) {
      const Vec3d d = toward;
      const auto is_same = [&](Vec3d known) { return length(known - d) < same_; };
      if (std::ranges::none_of(contacts, is_same)) contacts.push_back(d);
    }
  }

 private:
  const SolidSurface& surface_;
  double slack_;
  double same_;
};

// The outermost of the contacts across a crease whose balls grow so much of the way.
std::optional<CreaseWedge> wedge_of(std::span<const Vec3d> contacts, Vec3d direction, double growth,
                                    double same) {
  std::vector<Vec3d> across;
  Vec3d sum;
  for (const Vec3d d : contacts) {
    if (std::abs(dot(d, direction) + growth) > same) continue;
    across.push_back(d);
    sum += d;
  }
  if (across.size() < 2 || !(length(sum) > kSlack)) return std::nullopt;
  const auto turn = [&](Vec3d d) { return std::atan2(dot(cross(sum, d), direction), dot(sum, d)); };
  const auto [first, last] = std::ranges::minmax_element(across, {}, turn);
  return CreaseWedge{*first, *last};
}

CreasePipe make_pipe(const CreaseCurve& curve, const ContactFinder& finder) {
  CreasePipe pipe{curve, {}};
  const int steps = curve.is_line ? 0 : CreasePipe::steps_of(curve);
  for (int i = 0; i <= steps; ++i) {
    // At the ends other features are touched, too.
    const double inside = std::clamp(double(i), 0.02, std::max(steps - 0.02, 0.02));
    const double part = steps == 0 ? 0.5 : inside / steps;
    const double u = curve.u0 + (curve.u1 - curve.u0) * part;
    std::vector<Vec3d> contacts;
    finder.add(curve.at(u), curve.radius_at(u), contacts);
    const auto wedge =
        wedge_of(contacts, normalize(curve.derivative(u)), curve.growth(), finder.same());
    if (wedge) {
      pipe.wedges.push_back(*wedge);
    } else if (!pipe.wedges.empty()) {
      pipe.wedges.push_back(pipe.wedges.back());
    }
  }
  // Where the first were not found, all are shifted by less than a step.
  while (!pipe.wedges.empty() && pipe.wedges.size() < std::size_t(steps) + 1) {
    pipe.wedges.insert(pipe.wedges.begin(), pipe.wedges.front());
  }
  return pipe;
}

bool spans_volume(std::span<const Vec3d> contacts) {
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    for (std::size_t j = i + 1; j < contacts.size(); ++j) {
      const Vec3d side = cross(contacts[i], contacts[j]);
      for (std::size_t k = j + 1; k < contacts.size(); ++k) {
        if (std::abs(dot(side, contacts[k])) > kFlat) return true;
      }
    }
  }
  return false;
}

// Of the hull of directions; none if they span all.
std::vector<Vec3d> sides_of(std::span<const Vec3d> contacts) {
  std::vector<Vec3d> sides;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    for (std::size_t j = i + 1; j < contacts.size(); ++j) {
      const Vec3d side = cross(contacts[i], contacts[j]);
      if (!(length(side) > kSlack)) continue;
      for (const Vec3d inward : {normalize(side), -normalize(side)}) {
        const auto is_inside = [&](Vec3d d) { return dot(inward, d) >= -kSlack; };
        if (std::ranges::all_of(contacts, is_inside)) sides.push_back(inward);
      }
    }
  }
  return sides;
}

// Where pipes end and the ball is surface beside them.
std::vector<CreaseBall> make_balls(std::span<CreasePipe> pipes, double radius,
                                   const ContactFinder& finder) {
  struct End {
    Vec3d point;
    double radius;
    std::uint32_t* ball;
  };
  std::vector<End> ends;
  for (CreasePipe& pipe : pipes) {
    ends.push_back({pipe.curve.at(pipe.curve.u0), pipe.curve.r0, &pipe.balls[0]});
    ends.push_back({pipe.curve.at(pipe.curve.u1), pipe.curve.r1, &pipe.balls[1]});
  }
  std::ranges::sort(ends, {}, [](const End& e) { return e.point.x; });
  const double same = kSameEnd * radius;
  std::vector<bool> taken(ends.size(), false);
  std::vector<CreaseBall> balls;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    if (taken[i]) continue;
    const Vec3d center = ends[i].point;
    CreaseBall ball{center, ends[i].radius, {}, {}, {}};
    std::vector<std::uint32_t*> links;
    for (std::size_t j = i; j < ends.size() && ends[j].point.x - center.x < same; ++j) {
      if (taken[j] || length(ends[j].point - center) >= same) continue;
      taken[j] = true;
      finder.add(ends[j].point, ends[j].radius, ball.contacts);
      links.push_back(ends[j].ball);
    }
    if (!spans_volume(ball.contacts)) continue;
    for (std::uint32_t* const link : links) *link = std::uint32_t(balls.size());
    ball.sides = sides_of(ball.contacts);
    const Vec3d sum = std::accumulate(ball.contacts.begin(), ball.contacts.end(), Vec3d());
    if (!ball.sides.empty()) ball.middle = normalize(sum);
    balls.push_back(std::move(ball));
  }
  return balls;
}

std::vector<CreaseJoint> find_joints(std::span<const CreasePipe> pipes, double radius) {
  struct End {
    Vec3d point;
    std::uint32_t pipe;
    bool is_last;
  };
  std::vector<End> ends;
  for (std::uint32_t i = 0; i < pipes.size(); ++i) {
    const CreaseCurve& c = pipes[i].curve;
    if (!c.is_line || c.face_b == kNone) continue;
    ends.push_back({c.at(c.u0), i, false});
    ends.push_back({c.at(c.u1), i, true});
  }
  std::ranges::sort(ends, {}, [](const End& e) { return e.point.x; });
  const double same = kSameEnd * radius;
  std::vector<CreaseJoint> joints;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    for (std::size_t j = i + 1; j < ends.size() && ends[j].point.x - ends[i].point.x < same; ++j) {
      const CreaseCurve &c = pipes[ends[i].pipe].curve, &d = pipes[ends[j].pipe].curve;
      if (c.growth() == 0 && d.growth() == 0) continue;
      const bool is_one_edge = c.face_a == d.face_a && c.face_b == d.face_b;
      if (!is_one_edge || length(ends[i].point - ends[j].point) >= same) continue;
      joints.push_back({{ends[i].pipe, ends[j].pipe}, {ends[i].is_last, ends[j].is_last}});
    }
  }
  return joints;
}

// Pieces into which the finder has cut one curve follow each other.
std::vector<CreaseCurve> join_pieces(std::span<const CreaseCurve> creases) {
  std::vector<CreaseCurve> out;
  for (const CreaseCurve& c : creases) {
    const bool goes_on = !out.empty() && out.back().center == c.center && out.back().a == c.a &&
                         out.back().b == c.b && out.back().is_line == c.is_line &&
                         out.back().u1 == c.u0;
    if (goes_on) {
      out.back().u1 = c.u1;
    } else {
      out.push_back(c);
    }
  }
  return out;
}

// Features that meet three in one line give it more than once.
std::vector<CreaseCurve> without_doubles(std::span<const CreaseCurve> creases, double radius) {
  struct Known {
    CreaseCurve curve;
    Vec3d p0, middle, p1;
  };
  std::vector<Known> all;
  for (const CreaseCurve& c : creases) {
    all.push_back({c, c.at(c.u0), c.at(0.5 * (c.u0 + c.u1)), c.at(c.u1)});
  }
  std::ranges::sort(all, {}, [](const Known& k) { return k.middle.x; });
  const double same = kSameEnd * radius;
  std::vector<CreaseCurve> out;
  for (std::size_t i = 0; i < all.size(); ++i) {
    bool is_double = false;
    for (std::size_t j = i; j-- > 0 && all[i].middle.x - all[j].middle.x < same;) {
      const bool along = length(all[i].p0 - all[j].p0) + length(all[i].p1 - all[j].p1) < same;
      const bool against = length(all[i].p0 - all[j].p1) + length(all[i].p1 - all[j].p0) < same;
      is_double = is_double || ((along || against) && length(all[i].middle - all[j].middle) < same);
    }
    if (!is_double) out.push_back(all[i].curve);
  }
  return out;
}

}  // namespace

int CreasePipe::steps_of(const CreaseCurve& curve) {
  const double widest = std::max(length(curve.a), length(curve.b));
  const double step = kArcStep * std::sqrt(std::min(1.0, curve.r0 / widest));
  return std::max(1, int(std::ceil((curve.u1 - curve.u0) / step)));
}

CreaseWedge CreasePipe::wedge_at(double u) const {
  if (wedges.size() == 1) return wedges.front();
  const double last = double(wedges.size() - 1);
  const double at = std::clamp((u - curve.u0) / (curve.u1 - curve.u0) * last, 0.0, last);
  const auto i = std::min(std::size_t(at), wedges.size() - 2);
  const double part = at - double(i);
  const Vec3d direction = normalize(curve.derivative(u));
  const auto blend = [&](Vec3d from, Vec3d to) {
    const Vec3d d = from + (to - from) * part;
    return normalize(d - direction * dot(d, direction));
  };
  return {blend(wedges[i].a, wedges[i + 1].a), blend(wedges[i].b, wedges[i + 1].b)};
}

CreaseShape make_crease_shape(const SolidSurface& surface, std::span<const CreaseCurve> creases,
                              double radius, double tolerance) {
  const ContactFinder finder(surface, radius, tolerance);
  CreaseShape shape;
  const std::vector<CreaseCurve> curves = without_doubles(join_pieces(creases), radius);
  shape.pipes =
      parallel_collect<CreasePipe>(curves.size(), kCurvesAtOnce, [&](std::size_t i, auto& list) {
        CreasePipe pipe = make_pipe(curves[i], finder);
        if (!pipe.wedges.empty()) list.push_back(std::move(pipe));
      });
  shape.joints = find_joints(shape.pipes, radius);
  shape.balls = make_balls(shape.pipes, radius, finder);
  return shape;
}

}  // namespace arris
