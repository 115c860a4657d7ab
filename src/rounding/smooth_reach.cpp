#include "rounding/smooth_reach.h"

#include <algorithm>
#include <array>

#include "base/parallel_collect.h"

namespace arris {
namespace {

// Cosine of the turn beyond which a ball in one face's place does not belong to the other's surface.
constexpr double kMostTurn = -0.5;
constexpr std::size_t kFacesAtOnce = 64, kTrianglesAtOnce = 256;
// Cosine between the normals of a wall's two sides, at most.
constexpr double kOpposite = -0.8;
// Relative to the radius: what is no nearer than this short of it only touches.
constexpr double kTouching = 1e-6;

// Of sorted pairs, those whose first is the face.
std::span<const FacePair> pairs_of(std::span<const FacePair> sorted, std::uint32_t face) {
  const auto first = std::ranges::lower_bound(sorted, face, {}, &FacePair::first);
  const auto last = std::ranges::upper_bound(sorted, face, {}, &FacePair::first);
  return {first, last};
}

class ReachFinder {
 public:
  explicit ReachFinder(const SmoothReachInput& input) : in_(input) {
    const std::span<const SurfaceTriangle> triangles = in_.surface.triangles();
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
      by_region_.emplace_back(triangles[i].region, i);
    }
    std::ranges::sort(by_region_);
    for (const auto& [face, other] : in_.smooth) {
      if (curved_.empty() || curved_.back() != face) curved_.push_back(face);
    }
  }

  [[nodiscard]] std::vector<FacePair> thin_walls() const {
    const std::span<const SurfaceTriangle> triangles = in_.surface.triangles();
    std::vector<FacePair> pairs = parallel_collect<FacePair>(
        triangles.size(), kTrianglesAtOnce,
        [&](std::size_t i, std::vector<FacePair>& list) { add_thin_walls(triangles[i], list); });
    std::ranges::sort(pairs);
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    return pairs;
  }

  [[nodiscard]] std::vector<FacePair> run() const {
    return parallel_collect<FacePair>(
        curved_.size(), kFacesAtOnce,
        [&](std::size_t i, std::vector<FacePair>& list) { add_reach(curved_[i], list); });
  }

 private:
  void add_reach(std::uint32_t face, std::vector<FacePair>& list) const {
    const std::vector<std::uint32_t> near = faces_near(face);
    std::vector<std::uint32_t> reached{face};
    for (std::size_t i = 0; i < reached.size(); ++i) {
      for (const FacePair& pair : pairs_of(in_.smooth, reached[i])) {
        const std::uint32_t next = pair.second;
        if (std::ranges::count(reached, next) > 0) continue;
        if (!std::ranges::binary_search(near, next)) continue;
        if (dot(normal_of(face), normal_of(next)) < kMostTurn) continue;
        if (std::ranges::binary_search(in_.sharp, FacePair(face, next))) continue;
        reached.push_back(next);
      }
    }
    std::ranges::sort(reached);
    for (const std::uint32_t other : reached) {
      if (other != face) list.emplace_back(face, other);
    }
  }

  void add_thin_walls(const SurfaceTriangle& own, std::vector<FacePair>& list) const {
    const Vec3d normal = normal_of(own.region), down = normal * in_.radius, reach(in_.radius);
    const std::array<Vec3d, 3> offset{own.p0 - down, own.p1 - down, own.p2 - down};
    const Vec3d low = min(offset[0], min(offset[1], offset[2])) - reach;
    const Vec3d high = max(offset[0], max(offset[1], offset[2])) + reach;
    const std::size_t first = list.size();
    in_.surface.for_each_near(low, high, [&](const SurfaceTriangle& t) {
      if (t.region == own.region || dot(normal, normal_of(t.region)) > kOpposite) return;
      if (!cuts_into(offset, normal, t)) return;
      const FacePair pair(own.region, t.region);
      if (std::ranges::binary_search(in_.sharp, pair)) return;
      if (std::find(list.begin() + std::ptrdiff_t(first), list.end(), pair) != list.end()) return;
      list.push_back(pair);
      list.emplace_back(t.region, own.region);
    });
  }

  // Whether a triangle may be nearer than r to the centres of balls that touch one of this normal.
  [[nodiscard]] bool cuts_into(const std::array<Vec3d, 3>& offset, Vec3d normal,
                               const SurfaceTriangle& t) const {
    const double reach = (1 - kTouching) * in_.radius;
    if (is_beyond_reach(offset, normal, t, reach)) return false;
    // All of t lies behind the plane through its point that is nearest to a centre.
    const Vec3d middle = (offset[0] + offset[1] + offset[2]) / 3.0;
    const Vec3d foot = nearest_on_triangle(middle, t), away = middle - foot;
    const double limit = reach * length(away);
    return std::ranges::any_of(offset, [&](Vec3d c) { return dot(c - foot, away) < limit; });
  }
  [[nodiscard]] Vec3d normal_of(std::uint32_t face) const {
    return in_.regions.planes[face].normal;
  }

  // Faces into which balls may cut that touch this one.
  [[nodiscard]] std::vector<std::uint32_t> faces_near(std::uint32_t face) const {
    const Vec3d normal = normal_of(face), reach(in_.radius);
    std::vector<std::uint32_t> near;
    for (const FacePair& pair : pairs_of(by_region_, face)) {
      const SurfaceTriangle& own = in_.surface.triangles()[pair.second];
      const Vec3d down = normal * in_.radius;
      const std::array<Vec3d, 3> offset{own.p0 - down, own.p1 - down, own.p2 - down};
      const Vec3d low = min(offset[0], min(offset[1], offset[2])) - reach;
      const Vec3d high = max(offset[0], max(offset[1], offset[2])) + reach;
      in_.surface.for_each_near(low, high, [&](const SurfaceTriangle& t) {
        if (t.region != face && cuts_into(offset, normal, t)) near.push_back(t.region);
      });
    }
    std::ranges::sort(near);
    near.erase(std::unique(near.begin(), near.end()), near.end());
    return near;
  }

  const SmoothReachInput& in_;
  std::vector<FacePair> by_region_;  // a face, a triangle of it
  std::vector<std::uint32_t> curved_;
};

}  // namespace

std::vector<FacePair> find_smooth_reach(const SmoothReachInput& input) {
  return ReachFinder(input).run();
}

std::vector<FacePair> find_thin_walls(const SmoothReachInput& input) {
  return ReachFinder(input).thin_walls();
}

}  // namespace arris
