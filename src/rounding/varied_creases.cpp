#include "rounding/varied_creases.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <set>
#include <unordered_map>
#include <utility>

#include "base/parallel_collect.h"
#include "rounding/growing_ball.h"

namespace arris {
namespace {

constexpr int kTransitionSteps = 16;
// The length of a transition, in what the radius grows by: a smooth step is steepest by 0.75 then, and balls whose
// radius grew as fast as they move would have no cone.
constexpr double kTransition = 2;
// In radii: how far a corner's radius goes on beyond where its creases end.
constexpr double kMargin = 0.25;
// A radius is halved so often where there is no room.
constexpr int kHalvings = 3;
// In radii: steps in which a curve is looked at; and most of them.
constexpr double kStep = 0.25;
constexpr int kMostSteps = 2000;
constexpr std::size_t kCurvesAtOnce = 64;
// Radii that differ by no more are the same.
constexpr double kSameRadius = 1e-9;
// Of the radius: what two edges that go on from each other may differ by at one place.
constexpr double kHidden = 1e-3;

struct Interval {
  double low, high;
};

double smooth_step(double x) {
  return x * x * (3 - 2 * x);
}

class VariedFinder {
 public:
  explicit VariedFinder(const VariedInput& input)
      : in_(input.solid), clamp_(input.clamp), radii_(input.radii) {
    collect_edges();
  }

  VariedCreases run() {
    do {
      settle();
      make_field();
    } while (lower_hidden());
    for (const double radius : used_radii()) {
      if (radius > 0) add_class(radius, class_of(radius).creases.curves);
    }
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      if (profiles_[i].knots.size() > 2) add_transitions(edges_[i], profiles_[i]);
    }
    for (const Edge& e : edges_) {
      if (e.radius < e.asked) out_.clamped.push_back({e.half_edge, e.radius});
    }
    return std::move(out_);
  }

 private:
  struct Edge {
    std::uint32_t half_edge, vertex0, vertex1;
    FacePair faces;
    Vec3d p0, direction;
    double length;
    double asked, radius;
  };
  struct Class {
    FoundCreases creases;
    std::vector<CreaseCurve> lines;  // of these, between faces; sorted by them
  };
  // Radii of an edge's ends, and how far each goes.
  struct Ends {
    double radius0, radius1;
    double until0, until1;
  };

  [[nodiscard]] Vec3d local(std::uint32_t vertex) const {
    return Vec3d(in_.mesh.vertices[vertex]) - in_.center;
  }

  void collect_edges() {
    for (const std::uint32_t s : in_.shells) {
      const Shell& shell = in_.mesh.shells[s];
      for (std::uint32_t i = 0; i < shell.triangle_count; ++i) {
        const std::uint32_t t = in_.mesh.triangles_by_shell[shell.first_triangle + i];
        for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
          const std::uint32_t twin = in_.mesh.twin[h];
          if (in_.kinds[h] != EdgeKind::convex || twin < h) continue;
          const std::uint32_t a = in_.regions.region[t], b = in_.regions.region[twin / 3];
          Edge e{h, in_.mesh.origin(h), in_.mesh.target(h), std::minmax(a, b), {}, {},
                 0, radii_[h],          radii_[h]};
          e.p0 = local(e.vertex0);
          const Vec3d along = local(e.vertex1) - e.p0;
          e.length = length(along);
          e.direction = along / e.length;
          for (const std::uint32_t v : {e.vertex0, e.vertex1}) {
            edges_at_[v].push_back(std::uint32_t(edges_.size()));
          }
          edges_.push_back(e);
        }
      }
    }
  }

  static FacePair faces_of(const CreaseCurve& c) { return {c.face_a, c.face_b}; }

  [[nodiscard]] const Class& class_of(double radius) {
    const auto [at, is_new] = classes_.try_emplace(radius);
    Class& made = at->second;
    if (!is_new) return made;
    made.creases = find_creases(
        {in_.mesh, in_.regions, in_.kinds, in_.shells, in_.surface, in_.center, in_.size, radius});
    for (const CreaseCurve& c : made.creases.curves) {
      if (c.is_line && c.face_b != kNone) made.lines.push_back(c);
    }
    std::ranges::sort(made.lines, {}, faces_of);
    return made;
  }

  // Where along an edge balls of the radius touch both of its faces and nothing else.
  [[nodiscard]] std::vector<Interval> room(const Edge& e, double radius) {
    const std::vector<CreaseCurve>& lines = class_of(radius).lines;
    std::vector<Interval> room;
    for (auto c = std::ranges::lower_bound(lines, e.faces, {}, faces_of);
         c != lines.end() && faces_of(*c) == e.faces; ++c) {
      const double v0 = dot(c->at(c->u0) - e.p0, e.direction);
      const double v1 = dot(c->at(c->u1) - e.p0, e.direction);
      const Interval piece{std::min(v0, v1), std::max(v0, v1)};
      if (piece.high > 0 && piece.low < e.length) room.push_back(piece);
    }
    return room;
  }

  // Corners have the median radius of their edges, the smaller one of two, or what is left of it.
  void set_corner(std::uint32_t vertex) {
    std::vector<double> radii;
    for (const std::uint32_t i : edges_at_.at(vertex)) radii.push_back(edges_[i].radius);
    std::ranges::sort(radii);
    const double median = radii[(radii.size() - 1) / 2];
    const auto cap = caps_.find(vertex);
    corners_[vertex] = cap == caps_.end() ? median : std::min(median, cap->second);
  }

  // Radii only fall, so this ends.
  void settle() {
    std::vector<std::uint32_t> waiting(edges_.size());
    std::iota(waiting.rbegin(), waiting.rend(), 0U);
    std::vector<bool> waits(edges_.size(), true);
    for (const auto& [vertex, edges] : edges_at_) set_corner(vertex);
    while (!waiting.empty()) {
      const std::uint32_t i = waiting.back();
      waiting.pop_back();
      waits[i] = false;
      Edge& e = edges_[i];
      if (fits(e)) continue;
      lower(e);
      for (const std::uint32_t v : {e.vertex0, e.vertex1}) {
        set_corner(v);
        for (const std::uint32_t k : edges_at_.at(v)) {
          if (waits[k]) continue;
          waits[k] = true;
          waiting.push_back(k);
        }
      }
    }
  }

  [[nodiscard]] std::optional<Ends> ends_of(const Edge& e) {
    Ends ends{corners_.at(e.vertex0), corners_.at(e.vertex1), 0, 0};
    if (ends.radius0 > 0) {
      const std::vector<Interval> free = room(e, ends.radius0);
      if (free.empty()) return std::nullopt;
      const double low = std::ranges::min_element(free, {}, &Interval::low)->low;
      ends.until0 = std::max(low, 0.0) + kMargin * ends.radius0;
    }
    if (ends.radius1 > 0) {
      const std::vector<Interval> free = room(e, ends.radius1);
      if (free.empty()) return std::nullopt;
      const double high = std::ranges::max_element(free, {}, &Interval::high)->high;
      ends.until1 = std::max(e.length - high, 0.0) + kMargin * ends.radius1;
    }
    return ends;
  }

  [[nodiscard]] bool is_even(const Edge& e) const {
    return corners_.at(e.vertex0) == e.radius && corners_.at(e.vertex1) == e.radius;
  }

  // Of an edge of one radius: it stays sharp.
  [[nodiscard]] bool has_no_room(const Edge& e) {
    if (!std::ranges::binary_search(class_of(e.radius).creases.missing, e.faces)) return false;
    const Vec3d middle = e.p0 + e.direction * (0.5 * e.length);
    const Vec3d inward = -(normal_of(e.faces.first) + normal_of(e.faces.second));
    return gets_stuck_at_edge(in_.surface, middle, normalize(inward), e.radius);
  }

  // Whether the edge's radius and its transitions have room.
  [[nodiscard]] bool fits(const Edge& e) {
    if (is_even(e)) {
      if (e.radius == 0) return true;
      return !(clamp_ && has_no_room(e));
    }
    const std::optional<Ends> ends = ends_of(e);
    if (!ends) return false;
    const double low = ends->until0 + kTransition * std::abs(e.radius - ends->radius0);
    const double high = e.length - ends->until1 - kTransition * std::abs(e.radius - ends->radius1);
    if (low > high) return false;
    const double slack = kSameRadius * e.length;
    const auto covers = [&](const Interval& i) {
      return i.low <= low + slack && i.high >= high - slack;
    };
    if (e.radius > 0 && std::ranges::none_of(room(e, e.radius), covers)) return false;
    return are_free(e, profile_of(e, *ends));
  }

  // The edge's radius, or that of a corner that is larger.
  void lower(Edge& e) {
    const auto [low, high] = std::minmax({corners_.at(e.vertex0), corners_.at(e.vertex1)});
    if (e.radius < high) {
      for (const std::uint32_t v : {e.vertex0, e.vertex1}) {
        if (corners_.at(v) > e.radius) caps_[v] = e.radius;
      }
    } else if (e.radius > high) {
      e.radius = high;
    } else if (e.radius > low) {
      e.radius = low;
    } else {
      e.radius *= 0.5;
      if (e.radius < std::ldexp(e.asked, -kHalvings) * (1 - kSameRadius)) e.radius = 0;
    }
  }

  [[nodiscard]] EdgeProfile profile_of(const Edge& e, const Ends& ends) const {
    EdgeProfile profile{e.p0, e.direction, e.length, {}};
    std::vector<RadiusKnot>& knots = profile.knots;
    const auto add = [&](double v, double radius) {
      if (knots.empty() || v > knots.back().v) knots.push_back({v, radius});
    };
    // Knots of one radius have it exactly.
    const auto add_step = [&](double from, double radius0, double radius1) {
      if (radius0 == radius1) return;
      const double grown = radius1 - radius0, extent = kTransition * std::abs(grown);
      for (int i = 0; i <= kTransitionSteps; ++i) {
        const double part = double(i) / kTransitionSteps;
        const double radius = radius0 + grown * smooth_step(part);
        add(from + extent * part, i == kTransitionSteps ? radius1 : radius);
      }
    };
    add(0, ends.radius0);
    add_step(ends.until0, ends.radius0, e.radius);
    add_step(e.length - ends.until1 - kTransition * std::abs(e.radius - ends.radius1), e.radius,
             ends.radius1);
    add(e.length, ends.radius1);
    return profile;
  }

  [[nodiscard]] Vec3d normal_of(std::uint32_t face) const {
    return in_.regions.planes[face].normal;
  }

  // The centre of the ball that touches both faces at a place of the edge.
  [[nodiscard]] Vec3d center_at(const Edge& e, RadiusKnot at) const {
    const Vec3d a = normal_of(e.faces.first), b = normal_of(e.faces.second);
    return e.p0 + e.direction * at.v - (a + b) * (at.radius / (1 + dot(a, b)));
  }

  [[nodiscard]] bool are_free(const Edge& e, const EdgeProfile& profile) const {
    const double tolerance = crease_tolerance(in_.size, e.radius);
    return std::ranges::none_of(profile.knots, [&](const RadiusKnot& knot) {
      const bool is_end = knot.v <= 0 || knot.v >= e.length;
      return !is_end && knot.radius > tolerance &&
             in_.surface.is_near(center_at(e, knot), knot.radius - tolerance, e.faces.first);
    });
  }

  void make_field() {
    profiles_.clear();
    for (Edge& e : edges_) {
      const std::optional<Ends> ends = is_even(e) ? std::nullopt : ends_of(e);
      profiles_.push_back(
          ends ? profile_of(e, *ends)
               : EdgeProfile{e.p0, e.direction, e.length, {{0, e.radius}, {e.length, e.radius}}});
    }
    out_.field = RadiusField(profiles_);
  }

  // Where another edge is nearer to a place that an edge's balls touch, the field would not know of them. True: some
  // were.
  bool lower_hidden() {
    std::vector<std::size_t> hidden;
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      if (is_hidden(edges_[i], profiles_[i])) hidden.push_back(i);
    }
    for (const std::size_t i : hidden) lower(edges_[i]);
    return !hidden.empty();
  }

  [[nodiscard]] bool is_hidden(const Edge& e, const EdgeProfile& profile) const {
    const int steps =
        std::clamp(int(std::ceil(e.length / (kStep * out_.field.largest()))), 8, kMostSteps);
    for (int i = 1; i < steps; ++i) {
      const double v = e.length * i / steps, radius = profile.at(v);
      // At the ends other faces are touched.
      if (radius == 0 || std::min(v, e.length - v) < radius) continue;
      const Vec3d c = center_at(e, {v, radius});
      for (const std::uint32_t face : {e.faces.first, e.faces.second}) {
        const Vec3d touching = c + normal_of(face) * radius;
        if (std::abs(out_.field.at(touching) - radius) > kHidden * radius) return true;
      }
    }
    return false;
  }

  [[nodiscard]] std::set<double> used_radii() const {
    std::set<double> radii;
    for (const Edge& e : edges_) radii.insert(e.radius);
    for (const auto& [vertex, radius] : corners_) radii.insert(radius);
    return radii;
  }

  // Whether the field has a curve's radius where the ball at a place of it touches.
  [[nodiscard]] bool is_of_field(const CreaseCurve& c, double u, double radius) const {
    const Vec3d x = c.at(u);
    const auto is_same = [&](Vec3d p) {
      return std::abs(out_.field.at(p) - radius) <= kSameRadius * radius;
    };
    bool any = false;
    for (const std::uint32_t face : {c.face_a, c.face_b}) {
      if (face == kNone) continue;
      any = true;
      if (!is_same(x + normal_of(face) * radius)) return false;
    }
    return any || is_same(x);
  }

  void add_class(double radius, const std::vector<CreaseCurve>& curves) {
    const auto more = parallel_collect<CreaseCurve>(
        curves.size(), kCurvesAtOnce,
        [&](std::size_t i, auto& list) { cut(curves[i], radius, list); });
    out_.curves.insert(out_.curves.end(), more.begin(), more.end());
  }

  // The parts of a curve whose balls the field wants.
  void cut(const CreaseCurve& curve, double radius, std::vector<CreaseCurve>& list) const {
    const double extent =
        (curve.u1 - curve.u0) * (curve.is_line ? 1 : std::max(length(curve.a), length(curve.b)));
    const int steps = std::clamp(int(std::ceil(extent / (kStep * radius))), 4, kMostSteps);
    const auto place = [&](int i) { return curve.u0 + (curve.u1 - curve.u0) * i / steps; };
    CreaseCurve open = curve;
    bool is_open = is_of_field(curve, curve.u0, radius);
    for (int i = 1; i <= steps; ++i) {
      const bool now = is_of_field(curve, place(i), radius);
      if (now == is_open) continue;
      double low = place(i - 1), high = place(i);
      for (int k = 0; k < 40; ++k) {
        const double middle = 0.5 * (low + high);
        (is_of_field(curve, middle, radius) == is_open ? low : high) = middle;
      }
      if (now) open.u0 = high;
      open.u1 = low;
      if (is_open) list.push_back(open);
      is_open = now;
    }
    open.u1 = curve.u1;
    if (is_open) list.push_back(open);
  }

  void add_transitions(const Edge& e, const EdgeProfile& profile) {
    for (std::size_t i = 1; i < profile.knots.size(); ++i) {
      const RadiusKnot &from = profile.knots[i - 1], &to = profile.knots[i];
      if (from.radius == to.radius) continue;
      const Vec3d c0 = center_at(e, from), along = center_at(e, to) - c0;
      CreaseCurve cone;
      cone.center = c0;
      cone.a = normalize(along);
      cone.u1 = length(along);
      cone.face_a = e.faces.first;
      cone.face_b = e.faces.second;
      cone.r0 = from.radius;
      cone.r1 = to.radius;
      out_.curves.push_back(cone);
    }
  }

  const CreaseInput& in_;
  bool clamp_;
  std::span<const double> radii_;
  std::vector<Edge> edges_;
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> edges_at_;  // by vertex
  std::unordered_map<std::uint32_t, double> corners_, caps_;                // the same
  std::map<double, Class> classes_;                                         // by radius
  std::vector<EdgeProfile> profiles_;
  VariedCreases out_;
};

}  // namespace

VariedCreases find_varied_creases(const VariedInput& input) {
  return VariedFinder(input).run();
}

}  // namespace arris
