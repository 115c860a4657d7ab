#include "rounding/smooth_reach.h"

#include <algorithm>

#include "base/parallel_collect.h"

namespace arris {
namespace {

// Cosine of the turn beyond which a ball in one face's place does not belong to the other's surface.
constexpr double kMostTurn = -0.5;
constexpr std::size_t kFacesAtOnce = 64;

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
        if (std::ranges::binary_search(in_.sharp, FacePair(face, next))) continue;
        reached.push_back(next);
      }
    }
    std::ranges::sort(reached);
    for (const std::uint32_t other : reached) {
      if (other != face) list.emplace_back(face, other);
    }
  }

  [[nodiscard]] Vec3d normal_of(std::uint32_t face) const {
    return in_.regions.planes[face].normal;
  }

  // Faces into which balls may cut that touch this one, and that don't turn away.
  [[nodiscard]] std::vector<std::uint32_t> faces_near(std::uint32_t face) const {
    const Vec3d normal = normal_of(face);
    std::vector<std::uint32_t> near;
    const auto may_be_new = [&](std::uint32_t other) {
      return (near.empty() || near.back() != other) && !(dot(normal, normal_of(other)) < kMostTurn);
    };
    for (const FacePair& pair : pairs_of(by_region_, face)) {
      in_.surface.for_each_cut(pair.second, normal, in_.radius, may_be_new,
                               [&](const SurfaceTriangle& t) { near.push_back(t.region); });
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

}  // namespace arris
