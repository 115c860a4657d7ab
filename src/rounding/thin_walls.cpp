#include "rounding/thin_walls.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "base/parallel_collect.h"

namespace arris {
namespace {

// Relative to its radius: what is nearer than this to the ball it touches; the same where it seems stuck; and how far
// from its centre other things are looked for.
constexpr double kTouches = 1.0 / 128, kTouchesFinely = 1e-5, kFar = 2;
// Cosine of how much faces, or directions to them, turn at least that are opposite: by 143 degrees. A ball between them
// grows by less than a third of its centre's way.
constexpr double kOpposite = -0.8;
// The same of three all around, of which no two are opposite: the distance of their hull from the origin is as much. Two
// of them are this far apart at least; and those of a rod at least 66 degrees, else two are of one side.
const double kAround = std::sqrt(0.5 * (1 + kOpposite));
constexpr double kApart = -0.2, kOneSide = 0.4;
// By the way of its centre: slower than this it grows nowhere; the same between the sides of a blade.
constexpr double kStuck = 0.05, kStuckInBlade = 1e-4;
// First radii are halved so often where there is no room.
constexpr int kFirstHalvings = 20;
// Of the radius: so far below an edge a ball begins to grow.
constexpr double kBelowEdge = 1e-3;
constexpr int kMostGrowth = 400, kMostFineGrowth = 100;
// What lies on the plane on which a ball touches, or behind it, it does not touch: other triangles of the same face.
constexpr double kOnPlane = 1 - 1e-9;
// Of the radius: where a ball gets stuck this little smaller, it has to be looked at finely.
constexpr double kNearlyFull = 0.05;
constexpr std::size_t kSidesAtOnce = 256;

// Where a ball touches the surface, or nearly.
struct Contact {
  Vec3d direction;  // from its centre, unit
  double distance;
  const SurfaceTriangle* triangle;
  Vec3d normal;  // of the triangle
};

Vec3d normal_of(const SurfaceTriangle& t) {
  return normalize(cross(t.p1 - t.p0, t.p2 - t.p0));
}

// Whether these are the two sides of a wall, or the rims of two.
bool are_opposite(const Contact& a, const Contact& b) {
  return dot(a.normal, b.normal) < kOpposite || dot(a.direction, b.direction) < kOpposite;
}

// The point nearest to the origin of the hull of unit vectors. E. G. Gilbert, D. W. Johnson, S. S. Keerthi, "A fast
// procedure for computing the distance between complex objects" (1988).
Vec3d nearest_of_hull(const std::vector<Vec3d>& directions) {
  constexpr int kRounds = 64;
  constexpr double kNear = 1e-9;
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
      return dot(p, nearest) < (1 - kNear) * length_squared(nearest);
    };
    if (is_beyond(a) || is_beyond(b) || is_beyond(c) || is_beyond(d)) return {};  // it is within
  }
  return nearest;
}

// Whether a ball that touches in these directions, or faces of these normals, grows by less than a third of its centre's
// way.
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

// A triangle that a ball may touch.
struct Touchable {
  const SurfaceTriangle* triangle;
  Vec3d normal;
};

// Whether something of each lies in front of the other, where a ball may touch both.
bool face_each_other(const Touchable& a, const Touchable& b) {
  const auto is_before = [](const Touchable& plane, const SurfaceTriangle& t) {
    const auto height = [&](Vec3d p) { return dot(plane.normal, p - plane.triangle->p0); };
    return std::min({height(t.p0), height(t.p1), height(t.p2)}) < 0;
  };
  return is_before(a, *b.triangle) && is_before(b, *a.triangle);
}

// Whether three triangles, of which two face each other, may be sides of a rod.
bool are_around(const Touchable& a, const Touchable& b, const Touchable& c) {
  return are_around(a.normal, b.normal, c.normal) && face_each_other(a, c) && face_each_other(b, c);
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
    const Vec3d reach(far_);
    surface_.for_each_near(center_ - reach, center_ + reach, [&](const SurfaceTriangle& t) {
      if (is_plainly_beyond(center_, t, far_)) return;
      const Vec3d away = nearest_on_triangle(center_, t) - center_;
      const double length_away = length(away);
      if (!(length_away < far_ && length_away > 0)) return;
      radius_ = std::min(radius_, length_away);
      near_.push_back({away / length_away, length_away, &t, {}});
    });
  }

  void take_contacts(double touching) {
    touching_ = touching;
    contacts_.clear();
    for (const Contact& c : near_) {
      if (!touches(c)) continue;
      contacts_.push_back(c);
      contacts_.back().normal = normal_of(*c.triangle);
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

  // Facets that are touched where they meet, as far as touching is told, are one.
  [[nodiscard]] bool are_of_blade(const Contact& a, const Contact& b) const {
    if (surface_.is_blade(a.triangle->region, b.triangle->region)) return true;
    const auto is_at = [&](const Contact& c, const Contact& other) {
      return dot(c.direction, other.direction) > 1 - 2 * touching_;
    };
    for (const Contact& c : contacts_) {
      if (!is_at(c, a)) continue;
      for (const Contact& d : contacts_) {
        if (is_at(d, b) && surface_.is_blade(c.triangle->region, d.triangle->region)) return true;
      }
    }
    return false;
  }

  // A ball in a blade, or in a needle, goes on however slowly.
  [[nodiscard]] bool is_stuck() const {
    const double speed = length(middle_);
    bool in_blade = false;
    for (const Contact& a : contacts_) {
      for (const Contact& b : contacts_) {
        if (!are_opposite(a, b)) continue;
        if (!are_of_blade(a, b)) return true;
        in_blade = true;
      }
    }
    if (!in_blade && speed < kAround && are_around(directions_)) {
      faces_.clear();
      for (const Contact& c : contacts_) faces_.push_back(c.triangle->region);
      in_blade = surface_.is_needle(faces_);
      if (!in_blade) return true;
    }
    return speed < (in_blade ? kStuckInBlade : kStuck);
  }

  const SolidSurface& surface_;
  Vec3d start_, center_;
  Vec3d middle_;  // of the directions to what it touches
  double full_, radius_ = 0, far_ = 0, touching_ = 0;
  std::vector<Contact> near_, contacts_;
  std::vector<Vec3d> directions_;             // of contacts, without those on planes of others
  mutable std::vector<std::uint32_t> faces_;  // of contacts
};

template <class T>
void sort_and_unite(std::vector<T>& list) {
  std::ranges::sort(list);
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

// Facets of curved surfaces that meet in an edge: behind the first of a surface, too, balls roll out of the wedge.
class Blades {
 public:
  explicit Blades(const ThinWallInput& input) : in_(input) {}

  // Asked in order of the first.
  [[nodiscard]] bool hold(const FacePair& faces) const {
    if (faces.first != first_) {
      first_ = faces.first;
      beyond_.clear();
      for (const std::uint32_t face : around(first_)) {
        for (const FacePair& pair : pairs_of(in_.sharp, face)) beyond_.push_back(pair.second);
      }
      sort_and_unite(beyond_);
    }
    if (beyond_.empty()) return false;
    return std::ranges::any_of(around(faces.second), [&](std::uint32_t face) {
      return std::ranges::binary_search(beyond_, face);
    });
  }

 private:
  static constexpr int kSteps = 3;  // over smooth edges

  static std::span<const FacePair> pairs_of(std::span<const FacePair> sorted, std::uint32_t face) {
    return {std::ranges::lower_bound(sorted, face, {}, &FacePair::first),
            std::ranges::upper_bound(sorted, face, {}, &FacePair::first)};
  }
  // The face and those of its surface some steps from it.
  [[nodiscard]] std::vector<std::uint32_t> around(std::uint32_t face) const {
    std::vector<std::uint32_t> faces{face};
    for (std::size_t step = 0, i = 0; step < kSteps; ++step) {
      for (const std::size_t end = faces.size(); i < end; ++i) {
        for (const FacePair& pair : pairs_of(in_.smooth, faces[i])) {
          if (std::ranges::count(faces, pair.second) == 0) faces.push_back(pair.second);
        }
      }
    }
    return faces;
  }

  const ThinWallInput& in_;
  mutable std::uint32_t first_ = kNone;
  mutable std::vector<std::uint32_t>
      beyond_;  // faces that the first's surface meets in sharp edges
};

// Corners of sides of rods; all triangles of one have it at the same place.
std::vector<std::pair<std::uint32_t, std::uint32_t>> find_needles(
    const ThinWallInput& input, std::span<const std::uint32_t> sides) {
  struct Corner {
    Vec3d place;
    std::uint32_t face;

    [[nodiscard]] auto key() const { return std::tie(place.x, place.y, place.z); }
  };
  std::vector<Corner> corners;
  for (const std::uint32_t i : sides) {
    const SurfaceTriangle& t = input.surface.triangles()[i];
    for (const Vec3d p : {t.p0, t.p1, t.p2}) corners.push_back({p, t.region});
  }
  std::ranges::sort(corners, {}, [](const Corner& c) { return std::tuple(c.key(), c.face); });
  std::vector<std::pair<std::uint32_t, std::uint32_t>> needles;
  std::uint32_t count = 0;
  for (std::size_t i = 0, end = 0; i < corners.size(); i = end) {
    std::vector<std::uint32_t> faces;
    std::vector<Vec3d> normals;
    for (; end < corners.size() && corners[end].key() == corners[i].key(); ++end) {
      if (!faces.empty() && faces.back() == corners[end].face) continue;
      faces.push_back(corners[end].face);
      normals.push_back(input.regions.planes[faces.back()].normal);
    }
    if (faces.size() < 3 || !are_around(normals)) continue;
    for (const std::uint32_t face : faces) needles.emplace_back(face, count);
    ++count;
  }
  std::ranges::sort(needles);
  return needles;
}

}  // namespace

ThinWalls find_thin_walls(const ThinWallInput& input) {
  const auto normal_of = [&](std::uint32_t face) { return input.regions.planes[face].normal; };
  const auto& triangles = input.surface.triangles();
  struct Side {
    std::uint32_t triangle;
    FacePair opposite;  // the same face twice: of a rod
  };
  const auto find = [&](std::size_t i, std::vector<Side>& sides) {
    const Touchable own{&triangles[i], normal_of(triangles[i].region)};
    const auto add = [&](const Touchable& a, const Touchable& b) {
      sides.push_back(
          {std::uint32_t(a.triangle - triangles.data()), {a.triangle->region, b.triangle->region}});
    };
    std::vector<Touchable> across;
    const auto is_apart = [&](std::uint32_t face) {
      return dot(own.normal, normal_of(face)) < kApart;
    };
    input.surface.for_each_cut(std::uint32_t(i), own.normal, input.radius, is_apart,
                               [&](const SurfaceTriangle& t) {
                                 const Touchable other{&t, normal_of(t.region)};
                                 if (dot(own.normal, other.normal) > kOpposite) {
                                   across.push_back(other);
                                   return;
                                 }
                                 add(own, other);
                                 add(other, own);
                               });
    const Vec3d reach(2 * input.radius);
    for (const Touchable& a : across) {
      const auto& [p0, p1, p2, region, index] = *a.triangle;
      const auto look = [&](const SurfaceTriangle& t) {
        const Touchable b{&t, normal_of(t.region)};
        if (!are_around(own, a, b)) return;
        for (const Touchable& side : {own, a, b}) add(side, side);
      };
      input.surface.for_each_near(min(p0, min(p1, p2)) - reach, max(p0, max(p1, p2)) + reach, look);
    }
  };
  ThinWalls walls;
  const Blades blades(input);
  for (const FacePair& pair : input.sharp) {
    if (dot(normal_of(pair.first), normal_of(pair.second)) < kOpposite)
      walls.blades.push_back(pair);
  }
  std::vector<FacePair> opposite;
  for (const auto& [triangle, faces] :
       parallel_collect<Side>(triangles.size(), kSidesAtOnce, find)) {
    const bool is_of_rod = faces.first == faces.second;
    (is_of_rod ? walls.rods : walls.sides).push_back(triangle);
    if (!is_of_rod) opposite.push_back(faces);
  }
  sort_and_unite(walls.sides);
  sort_and_unite(walls.rods);
  sort_and_unite(opposite);
  for (const FacePair& pair : opposite) {
    if (blades.hold(pair)) walls.blades.push_back(pair);
  }
  sort_and_unite(walls.blades);
  walls.needles = find_needles(input, walls.rods);
  return walls;
}

bool is_between_walls(const SolidSurface& surface, Vec3d center, double radius) {
  const Vec3d low = center - Vec3d(radius), high = center + Vec3d(radius);
  std::vector<Touchable> near;
  const auto add = [&](const SurfaceTriangle& t) {
    if (is_plainly_beyond(center, t, radius)) return;
    if (std::ranges::count(near, &t, &Touchable::triangle) > 0) return;
    if (length(nearest_on_triangle(center, t) - center) < radius)
      near.push_back({&t, normal_of(t)});
  };
  surface.for_each_wall_near(low, high, add);
  for (const Touchable& a : near) {
    for (const Touchable* b = near.data(); b != &a; ++b) {
      if (dot(a.normal, b->normal) < kOpposite) return true;
    }
  }
  near.clear();
  surface.for_each_rod_near(low, high, add);
  for (const Touchable& a : near) {
    for (const Touchable* b = near.data(); b != &a; ++b) {
      if (!(dot(a.normal, b->normal) < kApart) || !face_each_other(a, *b)) continue;
      const auto closes = [&](const Touchable& c) { return are_around(a, *b, c); };
      if (std::ranges::any_of(near, closes)) return true;
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
