#include "rounding/distant_creases.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include "rounding/contacts.h"
#include "rounding/equidistant_curve.h"
#include "rounding/growing_ball.h"
#include "rounding/thin_walls.h"

namespace arris {
namespace {

// Of the radius: by how much curves may be beside where they should be. Their directions are exact to some hundred
// times that, so that normals lie between those of the faces.
constexpr double kFit = 1e-7;
// Of the radius: how far behind a ball on two lips room for another is looked for, and by which steps.
constexpr double kBehind = 8, kStep = 0.25;
// Of half the angle between what it touches, the least cosine.
constexpr double kLeastCosine = 0.1;
// How often a curve is looked at for whether any of it stays; of the radius, how far apart.
constexpr int kLeastPlaces = 16;
constexpr double kPlaceStep = 0.1;
// Of the tolerance: edges that go apart by less are parallel, and those that pass by less meet.
constexpr double kBeside = 0.25;
// Sine of the angle from which on the closed form of edges that cross is good.
constexpr double kCrossing = 1e-3;

std::vector<Box> boxes_of(const std::vector<ConcaveEdge>& edges, double r) {
  std::vector<Box> boxes;
  for (const ConcaveEdge& e : edges) {
    Box box = e.box(r);
    box.item = std::uint32_t(boxes.size());
    boxes.push_back(box);
  }
  return boxes;
}

std::vector<Box> boxes_of(const std::vector<ConcaveCorner>& corners, double r) {
  std::vector<Box> boxes;
  for (const ConcaveCorner& c : corners) {
    boxes.push_back({c.point - Vec3d(r), c.point + Vec3d(r), std::uint32_t(boxes.size())});
  }
  return boxes;
}

std::array<std::uint32_t, 2> faces_of(const ConcaveEdge& e) {
  return {e.face0, e.face1};
}
const std::vector<std::uint32_t>& faces_of(const ConcaveCorner& c) {
  return c.faces;
}

CylinderPart cylinder_about(const ConcaveEdge& e) {
  return {{e.p0, e.direction}, length(e.p1 - e.p0), -e.normal0, -e.normal1};
}

// Whether all of some points are above one of the planes.
template <class Planes, class Points>
bool are_beyond(const Planes& planes, const Points& points, double tolerance) {
  return std::ranges::any_of(planes, [&](const CurveBound& plane) {
    return std::ranges::all_of(
        points, [&](Vec3d p) { return plane.alpha + dot(plane.normal, p) > tolerance; });
  });
}

}  // namespace

DistantCreases::DistantCreases(const ConcaveFeatures& features, const SolidSurface& surface,
                               double radius, double tolerance, double extent,
                               AreOneSurface are_one_surface)
    : features_(features),
      surface_(surface),
      r_(radius),
      tolerance_(tolerance),
      extent_(extent),
      are_one_surface_(std::move(are_one_surface)),
      edge_tree_(boxes_of(features.edges, radius)),
      corner_tree_(boxes_of(features.corners, radius)) {}

bool DistantCreases::may_touch_both(const ConcaveEdge& a, const ConcaveEdge& b) const {
  return !are_beyond(a.bounds(), b.hull(r_), tolerance_) &&
         !are_beyond(b.bounds(), a.hull(r_), tolerance_);
}

bool DistantCreases::may_touch_both(const ConcaveEdge& a, const ConcaveCorner& b) const {
  return !are_beyond(a.bounds(), std::array{b.point}, tolerance_ + r_) &&
         !are_beyond(b.bounds(), a.hull(r_), tolerance_);
}

// On the circle of the places that are r from both.
bool DistantCreases::may_touch_both(const ConcaveCorner& a, const ConcaveCorner& b) const {
  const double half = 0.5 * length(b.point - a.point);
  if (!(half > 0 && half < r_)) return false;
  const Vec3d toward = (b.point - a.point) / (2 * half);
  const double ring = std::sqrt(r_ * r_ - half * half);
  const auto is_beyond = [&](double along) {
    return along * half - ring * std::sqrt(std::max(1 - along * along, 0.0)) > tolerance_;
  };
  return std::ranges::none_of(a.directions, [&](Vec3d d) { return is_beyond(dot(d, toward)); }) &&
         std::ranges::none_of(b.directions, [&](Vec3d d) { return is_beyond(-dot(d, toward)); });
}

std::vector<CreaseCurve> DistantCreases::curves_of(const ConcaveEdge& a,
                                                   const ConcaveEdge& b) const {
  const Vec3d normal = cross(a.direction, b.direction), between = b.p0 - a.p0;
  const double sine = length(normal), beside = kBeside * tolerance_;
  const EdgeLine line{a.p0, a.direction};
  if (sine * length(b.p1 - b.p0) < beside) return parallel_edge_creases(line, b.p0, r_, extent_);
  if (sine > kCrossing && std::abs(dot(normal, between)) < beside * sine) {
    const double along = dot(cross(between, b.direction), normal) / (sine * sine);
    return edge_edge_creases(a.p0 + a.direction * along, a.direction, b.direction, r_);
  }
  return equidistant_curves(cylinder_about(a), {b.p0, b.direction}, r_, kFit * r_);
}

template <class A, class B>
void DistantCreases::cut(const std::vector<CreaseCurve>& curves, const A& a, const B& b,
                         CreaseCutter& cutter, std::vector<CreaseCurve>& out) const {
  const std::vector<CurveBound> bounds = bounds_of(a, b);
  std::vector<CreaseCurve> found;
  const auto belongs = [&](Vec3d x) {
    return a.is_touched_from(x, tolerance_) && b.is_touched_from(x, tolerance_);
  };
  for (const CreaseCurve& curve : curves) {
    cutter.for_pieces_of(curve, bounds, belongs, [&](const CreaseCurve& piece) {
      if (!is_buried(piece)) cutter.cut_reached(piece, found);
    });
  }
  std::ranges::copy_if(found, std::back_inserter(out),
                       [&](const CreaseCurve& curve) { return !is_on_lips(curve); });
}

// The rim of a hole that is no wider than the ball has such curves between all its edges.
bool DistantCreases::is_buried(const CreaseCurve& curve) const {
  const double scale = curve.is_line ? 1 : std::max(length(curve.a), length(curve.b));
  const double extent = (curve.u1 - curve.u0) * scale;
  const int places = std::max(kLeastPlaces, int(extent / (kPlaceStep * r_)));
  for (int i = 0; i < places; ++i) {
    const double u = curve.u0 + (curve.u1 - curve.u0) * (i + 0.5) / places;
    if (!surface_.is_near(curve.at(u), r_ - tolerance_, kNone)) return false;
  }
  return true;
}

// Looked for behind the middle of what the ball touches.
bool DistantCreases::is_on_lips(const CreaseCurve& curve) const {
  const Vec3d c = curve.at(0.5 * (curve.u0 + curve.u1));
  const auto [n, half_cosine] = Contacts(surface_, c, r_ + tolerance_).spread();
  if (length_squared(n) == 0) return true;
  const double end = std::min(surface_.first_exit(c, n, 0, kBehind * r_).t, kBehind * r_);
  bool has_left = false;
  for (double t = kStep * r_; t < end - r_; t += kStep * r_) {
    const bool fits = !surface_.is_near(c + n * t, r_, kNone);
    if (fits && has_left) return true;
    has_left = has_left || !fits;
  }
  // Where what the ball touches would meet, if it is not in the open.
  return is_in_gap(c + n * std::min(r_ / std::max(half_cosine, kLeastCosine), 0.5 * (r_ + end)));
}

bool DistantCreases::is_in_gap(Vec3d x) const {
  const auto at = surface_.nearest(x, r_);
  return at && is_between_walls(surface_, x, 2 * r_) &&
         gets_stuck(surface_, at->place, normal_of(*at->triangle), at->triangle->region,
                    r_ - tolerance_);
}

void DistantCreases::add_of_edge(std::uint32_t edge, CreaseCutter& cutter,
                                 std::vector<CreaseCurve>& out) const {
  const ConcaveEdge& a = features_.edges[edge];
  const Box box = a.box(r_);
  const Vec3d low = box.low - Vec3d(tolerance_), high = box.high + Vec3d(tolerance_);
  edge_tree_.for_each_near(low, high, [&](std::uint32_t other) {
    if (other <= edge) return;
    const ConcaveEdge& b = features_.edges[other];
    if (a.vertex0 == b.vertex0 || a.vertex0 == b.vertex1 || a.vertex1 == b.vertex0 ||
        a.vertex1 == b.vertex1 || !may_touch_both(a, b)) {
      return;
    }
    if (a.is_smooth && b.is_smooth && are_one_surface_(faces_of(a), faces_of(b))) return;
    cutter.set_features({{{a.p0, a.p1}, {b.p0, b.p1}}}, {});
    cut(curves_of(a, b), a, b, cutter, out);
  });
  corner_tree_.for_each_near(low, high, [&](std::uint32_t other) {
    const ConcaveCorner& b = features_.corners[other];
    if (std::ranges::count(b.edges, edge) > 0 || !may_touch_both(a, b)) return;
    if (a.is_smooth && b.is_smooth && are_one_surface_(faces_of(a), faces_of(b))) return;
    cutter.set_features({{{a.p0, a.p1}}}, {{b.point}});
    cut(equidistant_curves(cylinder_about(a), {b.point, {}}, r_, kFit * r_), a, b, cutter, out);
  });
}

void DistantCreases::add_of_corner(std::uint32_t corner, CreaseCutter& cutter,
                                   std::vector<CreaseCurve>& out) const {
  const ConcaveCorner& a = features_.corners[corner];
  corner_tree_.for_each_near(a.point - Vec3d(r_), a.point + Vec3d(r_), [&](std::uint32_t other) {
    if (other <= corner) return;
    const ConcaveCorner& b = features_.corners[other];
    if (!may_touch_both(a, b)) return;
    if (a.is_smooth && b.is_smooth && are_one_surface_(faces_of(a), faces_of(b))) return;
    cutter.set_features({}, {{a.point, b.point}});
    cut(corner_corner_creases(a.point, b.point, r_), a, b, cutter, out);
  });
}

}  // namespace arris
