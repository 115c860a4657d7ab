#include "rounding/creased_solid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include "base/frame.h"
#include "base/parallel_for.h"
#include "rounding/crease_grooves.h"
#include "rounding/growing_ball.h"
#include "rounding/stretches.h"
#include "rounding/thin_walls.h"

namespace arris {
namespace {

// Faces that turn by less are one: 1 − cosine.
constexpr double kLeastTurn = 0.03;
// How far beside the plane of two faces' normals that of a place between them may lie: facets end at pipes' ends.
constexpr double kBeside = 0.05;
// A point is beneath the surface if it is deeper within a ball than this part of the radius, and than so many
// tolerances: creases may end by one or two too late.
constexpr double kBeneath = 1e-5;
constexpr double kTolerances = 8;
// Of the radius: a point this near to the sharp surface is on it.
constexpr double kOnSurface = 1e-4;
// Cosine of the angle to a face's normal up to which the way from a place to the nearest one of the face is along it.
constexpr double kStraightOut = 1 - 1e-10;
// Of the radius: so far beside a face it is asked in the nearest place of it. More than a cell of StuckPlaces.
constexpr double kBesideFace = 0.25;
// Of the radius: triangles as near as another to a place, and how far from their edges they are asked.
constexpr double kSameDistance = 1e-6, kFromEdge = 1.0 / 32;
// Of the radius: most ways through a void are shorter; and what is shorter may be none.
constexpr double kShortWay = 4, kLeastWay = 1e-3;
// Of a way that should lie in a void: how many radii beneath the surface it may not be, and by how many it is looked
// at; and about a place where it meets material, what shows how this lies.
constexpr double kInMaterial = 0.02, kWayAtOnce = 0.1, kBesides = 0.01, kBorder = 1e-6;
constexpr int kLeastWaySteps = 4, kMostWaySteps = 64;
// Relative to the radius: steps in which edges are looked at.
constexpr double kEdgeStep = 0.25;
constexpr int kMostEdgeSteps = 256;

// Where a ray comes to what stays, between two of its t.
struct Border {
  Vec3d x, direction;
  double before, within;

  // Found to within a distance.
  template <class IsMaterial>
  [[nodiscard]] double find(double exactly, const IsMaterial& is_material) const {
    double low = before, high = within;
    for (double left = (high - low) * length(direction); left > exactly; left *= 0.5) {
      const double middle = 0.5 * (low + high);
      (is_material(x + direction * middle) ? high : low) = middle;
    }
    return high;
  }

  // Of the plane through the places that two rays beside it come to; unit, against the ray.
  template <class IsMaterial>
  [[nodiscard]] Vec3d normal_at(double t, double beside, const IsMaterial& is_material) const {
    const Vec3d d = normalize(direction), u(make_frame(Vec3f(d)).tangent), v = cross(d, u);
    const auto place_beside = [&](Vec3d way) -> std::optional<Vec3d> {
      for (const double side : {beside, -beside}) {
        const double reach = kSteepest * beside / length(direction);
        const Border near{x + way * side, direction, t - reach, t + reach};
        const auto is_there = [&](double at) { return is_material(near.x + direction * at); };
        if (is_there(near.before) || !is_there(near.within)) continue;
        return (near.x + direction * near.find(kExactly * beside, is_material) -
                (x + direction * t)) /
               side;
      }
      return std::nullopt;
    };
    const std::optional<Vec3d> a = place_beside(u), b = place_beside(v);
    if (!a || !b) return -d;
    const Vec3d normal = normalize(cross(*a, *b));
    return dot(normal, d) < 0 ? normal : -normal;
  }

  static constexpr double kSteepest = 5, kExactly = 1e-3;
};

}  // namespace

bool CreasedSolid::is_kept(Vec3d x, Vec3d normal, std::uint32_t region) const {
  const double r = field.at(x);
  return r <= tolerance || !surface.is_near(x - normal * r, r - tolerance, region) ||
         stays(x, normal, region, r);
}

bool CreasedSolid::is_kept(const MeshPlace& at, Vec3d x, Vec3d normal, std::uint32_t region) const {
  if (clear.is_clear(at.triangle, at.u, at.v)) return true;
  const auto others = near.of(at.triangle);
  if (!others) return is_kept(x, normal, region);
  const double r = field.at(x);
  return r <= tolerance || !surface.is_one_near(*others, x - normal * r, r - tolerance, region) ||
         stays(x, normal, region, r);
}

bool CreasedSolid::stays(Vec3d x, Vec3d normal, std::uint32_t region, double r,
                         bool is_at_edge) const {
  if (surface.is_firm(region) || mouths.hold(surface, x)) return true;
  const Vec3d c = x - normal * r;
  if (!narrow.may_be_between_walls(surface, c, 2 * r)) return false;
  std::optional<bool> known;
  if (!is_at_edge) {
    known = stuck.at(x, normal, region, [&](Vec3d y) { return gets_stuck_at(y, region); });
  }
  if (known) return *known;
  return is_between_walls(surface, c, 2 * r) &&
         gets_stuck(surface, x, normal, region, r - tolerance);
}

// The same to the last bits, nearly, from wherever it is asked: of a triangle that does not hang on these, and not on
// an edge, where balls begin to grow as rounding errors will.
StuckPlaces::Answer CreasedSolid::gets_stuck_at(Vec3d x, std::uint32_t region) const {
  using Answer = StuckPlaces::Answer;
  const Vec3d reach(kBesideFace * radius);
  double least = reach.x;
  std::vector<std::pair<const SurfaceTriangle*, double>> of_face;  // with their distances
  surface.for_each_near(x - reach, x + reach, [&](const SurfaceTriangle& t) {
    if (t.region != region) return;
    of_face.emplace_back(&t, length(x - nearest_on_triangle(x, t)));
    least = std::min(least, of_face.back().second);
  });
  const SurfaceTriangle* first = nullptr;
  for (const auto& [t, distance] : of_face) {
    const bool is_nearest = distance <= least + kSameDistance * radius;
    if (is_nearest && (first == nullptr || t < first)) first = t;
  }
  if (first == nullptr || least == reach.x) return Answer::not_on_face;
  const Vec3d edge = nearest_on_triangle(x, *first);
  const Vec3d inward = (first->p0 + first->p1 + first->p2) / 3.0 - edge;
  const double way = length(inward), most = kFromEdge * radius;
  const Vec3d place = way > most ? edge + inward * (most / way) : edge + inward;
  const Vec3d normal = normal_of(*first);
  const double r = field.at(place);
  const bool is_stuck = is_between_walls(surface, place - normal * r, 2 * r) &&
                        gets_stuck(surface, place, normal, region, r - tolerance);
  return is_stuck ? Answer::yes : Answer::no;
}

VoidCrossing CreasedSolid::cross_void(Vec3d x, Vec3d direction) const {
  // Most ways are short: what lies far along the ray is not looked at at first.
  const double speed = length(direction), least = tolerance / speed;
  const double reach = std::max(kShortWay * radius / speed, 2 * least);
  VoidCrossing crossing{{}, surface.first_exit(x, direction, least, reach)};
  crossing.met = pipes.first_entry(x, direction, std::min(crossing.exit.t, reach));
  if (!crossing.met && !std::isfinite(crossing.exit.t)) {
    crossing.exit = surface.first_exit(x, direction, least);
    crossing.met = pipes.first_entry(x, direction, crossing.exit.t);
  }
  if (const auto material = first_material(x, direction, crossing)) crossing.met = material;
  return crossing;
}

std::optional<PipeHit> CreasedSolid::first_material(Vec3d x, Vec3d direction,
                                                    const VoidCrossing& crossing) const {
  const auto& [met, exit] = crossing;
  const double end = met ? met->t : exit.t;
  if (!std::isfinite(end)) return std::nullopt;
  const Vec3d last = x + direction * end;
  const Vec3d low = min(x, last), high = max(x, last), reach(radius);
  if (!surface.has_firm_near(low - reach, high + reach) && !mouths.is_near(low, high) &&
      field.is_uniform_within(low, high)) {
    const Vec3d middle = (x + last) * 0.5;
    const double within = 2 * radius + 0.5 * length(last - x);
    if (!narrow.may_be_between_walls(surface, middle, within) ||
        !is_between_walls(surface, middle, within)) {
      return std::nullopt;
    }
  }
  const double speed = length(direction), most = kWayAtOnce * radius / speed;
  const int steps = std::clamp(int(std::ceil(end / most)), kLeastWaySteps, kMostWaySteps);
  const auto is_material = [&](Vec3d y) { return is_beneath(y, kInMaterial); };
  for (int i = 1; i < steps; ++i) {
    const double t = end * i / steps;
    if (!is_material(x + direction * t)) continue;
    const Border border{x, direction, end * (i - 1) / steps, t};
    const double at = border.find(kBorder * radius, is_material);
    // What is beneath the pipe, but for the tolerance.
    if (met && (end - at) * speed <= kInMaterial * radius) return std::nullopt;
    return PipeHit{at, border.normal_at(at, kBesides * radius, is_material), true};
  }
  // A skin, too thin to be found; unless the way began behind the face by rounding errors.
  if (!met && length(last - x) > kLeastWay * radius && is_kept(last, exit.normal, exit.region)) {
    return PipeHit{end, -exit.normal, true};
  }
  return std::nullopt;
}

const CreaseShape& CreasedSolid::shape() const {
  std::call_once(made_shape->once, [&] {
    run_isolated([&] {
      CreaseShape made = make_crease_shape(surface, pipes.creases(), radius, tolerance);
      made.grooves = find_grooves(*this, made);
      made_shape->shape = std::move(made);
    });
  });
  return made_shape->shape;
}

std::vector<std::pair<double, double>> CreasedSolid::find_sharp_parts(const FaceEdge& edge) const {
  if (surface.is_firm(edge.region0) || surface.is_firm(edge.region1)) return {{0, 1}};
  const bool may_stay = is_between_walls(surface, (edge.p0 + edge.p1) * 0.5,
                                         2 * radius + 0.5 * length(edge.p1 - edge.p0));
  if (field.is_uniform() && !may_stay) return {};
  const Vec3d inward = -normalize(edge.normal0 + edge.normal1);
  const auto is_sharp = [&](double u) {
    const Vec3d x = edge.p0 + (edge.p1 - edge.p0) * u;
    const double r = field.at(x);
    return r <= tolerance || (may_stay && is_between_walls(surface, x + inward * r, 2 * r) &&
                              gets_stuck_at_edge(surface, x, inward, r - tolerance));
  };
  const double extent = length(edge.p1 - edge.p0);
  const int steps = std::clamp(int(std::ceil(extent / (kEdgeStep * radius))), 2, kMostEdgeSteps);
  return find_stretches(steps, is_sharp);
}

double CreasedSolid::beneath() const {
  return std::max(kBeneath * radius, kTolerances * tolerance);
}

// The nearest ball's centre is on a crease, or on the way from the nearest place of the surface through x: two balls
// one of which holds the other touch there.
bool CreasedSolid::is_beneath(Vec3d x, double radii) const {
  if (pipes.holds(x, std::max(beneath(), radii * radius)) || mouths.hold(surface, x)) return true;
  const auto nearest = surface.nearest(x, radius);
  if (!nearest) return true;
  const auto& [t, foot, distance] = *nearest;
  const double r = field.at(foot);
  if (distance < std::max(kOnSurface, radii) * radius || r <= tolerance) return false;
  const Vec3d out = (foot - x) / distance;
  return !surface.is_near(foot - out * r, r - tolerance, t->region) ||
         stays(foot, out, t->region, r, dot(out, normal_of(*t)) <= kStraightOut);
}

std::optional<EdgeBlend> CreasedSolid::blend_at(Vec3d x, Vec3d normal) const {
  if (!surface.is_curved()) return std::nullopt;
  const double r = field.at(x);
  const Vec3d c = x - normal * r;
  const double most = r + 2 * tolerance;
  std::vector<EdgeBlend::Side> touched;
  surface.for_each_near(c - Vec3d(most), c + Vec3d(most), [&](const SurfaceTriangle& t) {
    const Vec3d p = nearest_on_triangle(c, t);
    if (length_squared(p - c) < most * most) touched.push_back({t.index, p, normalize(p - c), 0});
  });
  std::optional<EdgeBlend> best;
  double widest = 1 - kLeastTurn;  // cosine
  for (const EdgeBlend::Side& a : touched) {
    for (const EdgeBlend::Side& b : touched) {
      const double cosine = dot(a.face_normal, b.face_normal);
      if (!(cosine < widest)) continue;
      const double along_a = dot(normal, a.face_normal), along_b = dot(normal, b.face_normal);
      const double s2 = 1 - cosine * cosine;
      const double weight_a = (along_a - cosine * along_b) / s2;
      const double weight_b = (along_b - cosine * along_a) / s2;
      const Vec3d beside = normal - a.face_normal * weight_a - b.face_normal * weight_b;
      if (std::min(weight_a, weight_b) < -kBeside || length(beside) > kBeside) continue;
      widest = cosine;
      best = EdgeBlend{a, b};
      best->a.weight = std::max(weight_a, 0.0);
      best->b.weight = std::max(weight_b, 0.0);
    }
  }
  return best;
}

}  // namespace arris
