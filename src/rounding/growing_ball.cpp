#include "rounding/growing_ball.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace arris {
namespace {

// Relative to its radius: what is nearer than this to the ball it touches; the same where it seems stuck; and how far
// from its centre other things are looked for.
constexpr double kTouches = 1.0 / 128, kTouchesFinely = 1e-5, kFar = 2;
// Of the radius: what rounding errors add to a distance; and how far beyond what a ball asks for is gathered.
constexpr double kSlack = 1e-9, kBesides = 0.5;
// By the way of its centre: slower than this it grows nowhere; the same between the sides of a blade.
constexpr double kStuck = 0.05, kStuckInBlade = 1e-4;
// First radii are halved so often where there is no room.
constexpr int kFirstHalvings = 20;
// Cosine of the angle between a face's normal and the way to where a ball touches it, if that is not at its end.
constexpr double kOnSide = 0.97;
// Of the radius: so far below an edge a ball begins to grow.
constexpr double kBelowEdge = 1e-3;
constexpr int kMostGrowth = 400, kMostFineGrowth = 100;
// What lies on the plane on which a ball touches, or behind it, it does not touch: other triangles of the same face.
constexpr double kOnPlane = 1 - 1e-9;
// Of the radius: where a ball gets stuck this little smaller, it has to be looked at finely.
constexpr double kNearlyFull = 0.05;
// Of three directions all around, of which no two are opposite, the hull is this near to the origin. They are at least
// 66 degrees apart, else two are of one side.
const double kAround = std::sqrt(0.5 * (1 + kOpposite));
constexpr double kOneSide = 0.4;

// Where a ball touches the surface, or nearly.
struct Contact {
  Vec3d direction;  // from its centre, unit
  double distance;
  const SurfaceTriangle* triangle;
  Vec3d normal;  // of the triangle
};

// Whether these are the two sides of a wall, or the rims of two.
bool are_opposite(const Contact& a, const Contact& b) {
  return dot(a.normal, b.normal) < kOpposite || dot(a.direction, b.direction) < kOpposite;
}

// The point nearest to the origin of the hull of unit vectors. E. G. Gilbert, D. W. Johnson, S. S. Keerthi, "A fast
// procedure for computing the distance between complex objects in three-dimensional space" (1988).
Vec3d nearest_of_hull(const std::vector<Vec3d>& directions) {
  constexpr int kRounds = 64;
  constexpr double kNear = 1e-9, kSurely = 1e-6;  // the places of slivers are inexact
  std::array<Vec3d, 4> simplex{directions.front()};
  std::size_t count = 1;
  Vec3d nearest = simplex[0];
  const auto take = [&](Vec3d a, Vec3d b, Vec3d c) {
    const Vec3d near = nearest_on_triangle({}, {a, b, c, 0});
    if (!(length_squared(near) < length_squared(nearest))) return;
    nearest = near;
    simplex = {a, b, c};
  };
  for (int i = 0; i < kRounds; ++i) {
    const auto along = [&](Vec3d d) { return dot(d, nearest); };
    const Vec3d support = *std::ranges::min_element(directions, {}, along);
    const double squared = length_squared(nearest);
    if (squared - dot(support, nearest) <= kNear * squared) break;
    simplex[count++] = support;
    if (count < 4) {
      take(simplex[0], simplex[1], simplex[count - 1]);
      continue;
    }
    const auto [a, b, c, d] = simplex;
    take(a, b, d);
    take(a, c, d);
    take(b, c, d);
    count = 3;
    const auto is_beyond = [&](Vec3d p) {
      return dot(p, nearest) < (1 - kSurely) * length_squared(nearest);
    };
    if (is_beyond(a) || is_beyond(b) || is_beyond(c) || is_beyond(d)) return {};  // it is within
  }
  return nearest;
}

class GrowingBall {
 public:
  GrowingBall(const SolidSurface& surface, Vec3d center, double radius)
      : surface_(surface), start_(center), full_(radius) {}

  bool gets_stuck() {
    if (!gets_stuck(kTouches)) return false;
    return radius_ < (1 - kNearlyFull) * full_ || gets_stuck(kTouchesFinely);
  }

 private:
  // Contacts within `touching` are taken as one until it seems stuck: that leads it beside its way by as much.
  bool gets_stuck(double touching) {
    center_ = start_;
    find_near(full_);
    const int most = touching == kTouches ? kMostGrowth : kMostFineGrowth;
    for (int i = 0; i < most && radius_ < full_; ++i) {
      take_contacts(touching);
      if (is_stuck()) take_contacts(kTouchesFinely);
      if (is_stuck()) return true;
      const double speed = length(middle_);
      const double step = std::max(way_until_touch(speed), 0.5 * touching_ * radius_);
      center_ -= middle_ * (step / speed);
      find_near(kFar * (radius_ + step));
    }
    return radius_ < full_;
  }

  // What is nearer to the centre, and the radius.
  void find_near(double distance) {
    near_.clear();
    radius_ = far_ = std::min(distance, kFar * full_);
    if (length(center_ - gathered_about_) + far_ > gathered_to_) gather();
    for (const Plane& plane : around_) {
      if (std::abs(dot(plane.normal, center_) - plane.d) > far_ + kSlack * full_) continue;
      const Vec3d away = nearest_on_triangle(center_, *plane.triangle) - center_;
      const double length_away = length(away);
      if (!(length_away < far_ && length_away > 0)) continue;
      radius_ = std::min(radius_, length_away);
      near_.push_back({away / length_away, length_away, plane.triangle, plane.normal});
    }
  }

  // A ball takes many steps within a few radii: what is there is looked for once, or twice.
  void gather() {
    gathered_about_ = center_;
    gathered_to_ = far_ + kBesides * full_;
    around_.clear();
    const Vec3d reach(gathered_to_);
    surface_.for_each_near(center_ - reach, center_ + reach, [&](const SurfaceTriangle& t) {
      if (is_plainly_beyond(center_, t, gathered_to_)) return;
      if (length_squared(nearest_on_triangle(center_, t) - center_) > gathered_to_ * gathered_to_)
        return;
      const Vec3d normal = normal_of(t);
      around_.push_back({&t, normal, dot(normal, t.p0)});
    });
    std::ranges::sort(around_, {}, &Plane::triangle);
    const auto is_same = [](const Plane& a, const Plane& b) { return a.triangle == b.triangle; };
    around_.erase(std::unique(around_.begin(), around_.end(), is_same), around_.end());
  }

  void take_contacts(double touching) {
    touching_ = touching;
    contacts_.clear();
    for (const Contact& c : near_) {
      if (touches(c)) contacts_.push_back(c);
    }
    std::ranges::sort(contacts_, {}, &Contact::distance);
    directions_.clear();
    for (auto c = contacts_.begin(); c != contacts_.end(); ++c) {
      const auto hides = [&](const Contact& nearer) {
        return dot(c->direction, nearer.direction) * c->distance > kOnPlane * nearer.distance;
      };
      if (std::none_of(contacts_.begin(), c, hides)) directions_.push_back(c->direction);
    }
    middle_ = nearest_of_hull(directions_);
  }
  [[nodiscard]] bool touches(const Contact& c) const {
    return c.distance <= std::min((1 + touching_) * radius_, full_);
  }

  // How far the centre may go while the radius grows at a speed and nothing more is touched: distances to triangles are
  // convex. What has not been found comes nearer at most as fast as the centre moves.
  [[nodiscard]] double way_until_touch(double speed) const {
    const Vec3d away = middle_ / speed;
    double way = (far_ - radius_) / (1 + speed);
    for (const Contact& c : near_) {
      const double recedes = dot(c.direction, away);
      if (recedes < speed && !touches(c))
        way = std::min(way, (c.distance - radius_) / (speed - recedes));
    }
    return way;
  }

  // Whether a ball touches both in one place, as far as touching is told.
  [[nodiscard]] bool is_at(const Contact& a, const Contact& b) const {
    return dot(a.direction, b.direction) > 1 - 2 * touching_;
  }

  // Facets that are touched where they meet are one. Sides of a needle are no less of one
  // where they don't meet in an edge.
  [[nodiscard]] bool are_of_blade(const Contact& a, const Contact& b) const {
    const std::array<std::uint32_t, 2> faces{a.triangle->region, b.triangle->region};
    if (surface_.is_blade(faces[0], faces[1]) || surface_.is_needle(faces)) return true;
    for (const Contact& c : contacts_) {
      if (!is_at(c, a)) continue;
      for (const Contact& d : contacts_) {
        if (is_at(d, b) && surface_.is_blade(c.triangle->region, d.triangle->region)) return true;
      }
    }
    return false;
  }

  // Whether a side of a blade ends there, in a concave edge: a ball that is still between the two sides does not fit
  // where the blade begins. The way to the face beyond such an edge is not along its normal; facets of a curved side
  // are one.
  [[nodiscard]] bool is_at_foot(const Contact& contact) const {
    return std::ranges::any_of(contacts_, [&](const Contact& c) {
      if (!is_at(c, contact) || dot(c.direction, c.normal) > kOnSide) return false;
      return std::ranges::none_of(contacts_, [&](const Contact& d) {
        return is_at(d, contact) && surface_.is_joined(c.triangle->region, d.triangle->region);
      });
    });
  }

  // A ball in a blade, or in a needle, goes on however slowly.
  [[nodiscard]] bool is_stuck() const {
    const double speed = length(middle_);
    bool in_blade = false;
    for (const Contact& a : contacts_) {
      for (const Contact& b : contacts_) {
        if (!are_opposite(a, b)) continue;
        if (!are_of_blade(a, b) || is_at_foot(a) || is_at_foot(b)) return true;
        in_blade = true;
      }
    }
    if (!in_blade && speed < kAround && are_around(directions_)) {
      std::vector<std::uint32_t> faces;
      for (const Contact& c : contacts_) faces.push_back(c.triangle->region);
      in_blade = surface_.is_needle(faces);
      if (!in_blade) return true;
    }
    return speed < (in_blade ? kStuckInBlade : kStuck);
  }

  const SolidSurface& surface_;
  Vec3d start_, center_;
  Vec3d middle_;  // of the directions to what it touches
  double full_, radius_ = 0, far_ = 0, touching_ = 0;
  struct Plane {
    const SurfaceTriangle* triangle;
    Vec3d normal;
    double d;
  };
  std::vector<Plane> around_;  // of what is within a distance of a place
  Vec3d gathered_about_;
  double gathered_to_ = 0;
  std::vector<Contact> near_, contacts_;
  std::vector<Vec3d> directions_;  // of contacts, without those on planes of others
};

}  // namespace

bool are_around(Vec3d a, Vec3d b, Vec3d c) {
  const auto [least, most] = std::minmax({dot(a, b), dot(a, c), dot(b, c)});
  return least < kApart && most < kOneSide &&
         length_squared(nearest_on_triangle({}, {a, b, c, 0})) < kAround * kAround;
}

bool are_around(const std::vector<Vec3d>& directions) {
  const auto last = directions.end();
  for (auto a = directions.begin(); a != last; ++a) {
    for (auto b = a + 1; b != last; ++b) {
      if (dot(*a, *b) < kOneSide &&
          std::any_of(b + 1, last, [&](Vec3d c) { return are_around(*a, *b, c); })) {
        return true;
      }
    }
  }
  return false;
}

bool gets_stuck(const SolidSurface& surface, Vec3d x, Vec3d normal, std::uint32_t face,
                double radius) {
  double r = radius;
  for (int i = 0; i < kFirstHalvings; ++i) {
    r *= 0.5;
    if (!surface.is_near(x - normal * r, (1 - kTouches) * r, face)) break;
  }
  return GrowingBall(surface, x - normal * r, radius).gets_stuck();
}

bool gets_stuck_at_edge(const SolidSurface& surface, Vec3d x, Vec3d inward, double radius) {
  return GrowingBall(surface, x + inward * (kBelowEdge * radius), radius).gets_stuck();
}

}  // namespace arris
