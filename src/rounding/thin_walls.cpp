#include "rounding/thin_walls.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "base/parallel_collect.h"
#include "rounding/growing_ball.h"

namespace arris {
namespace {

constexpr std::size_t kSidesAtOnce = 256;

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
  [[nodiscard]] bool hold(const FacePair& faces) {
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
  std::uint32_t first_ = kNone;
  std::vector<std::uint32_t> beyond_;  // faces that the first's surface meets in sharp edges
};

// Corners of sides; all triangles of one have it at the same place.
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
  std::vector<std::atomic<bool>> are_of_rods(
      triangles.size());  // what is known need not be told again
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
                                   if (face_each_other(own, other)) across.push_back(other);
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
        const auto flag_of = [&](const Touchable& side) -> std::atomic<bool>& {
          return are_of_rods[std::size_t(side.triangle - triangles.data())];
        };
        if (flag_of(own) && flag_of(a) && flag_of(b)) return;
        if (!are_around(own, a, b)) return;
        for (const Touchable& side : {own, a, b}) {
          if (!flag_of(side).exchange(true)) add(side, side);
        }
      };
      input.surface.for_each_near(min(p0, min(p1, p2)) - reach, max(p0, max(p1, p2)) + reach, look);
    }
  };
  ThinWalls walls;
  Blades blades(input);
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
  std::vector<std::uint32_t> all = walls.sides;
  all.insert(all.end(), walls.rods.begin(), walls.rods.end());
  sort_and_unite(all);
  walls.needles = find_needles(input, all);
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

}  // namespace arris
