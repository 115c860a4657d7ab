#include "rounding/near_triangles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace arris {
namespace {

// Relative to the radius: bounds that differ by less are one.
constexpr double kSame = 1e-6;
// Relative to the radius: a place this near to the nearest one is as good.
constexpr double kNear = 1e-4;
// Relative to the radius: so near a place need be to lie well within reach.
constexpr double kInside = 0.5;
// More functions than these cost more than asking the surface; and longer lists.
constexpr std::size_t kMostDepths = 8, kMostOthers = 24;

// Bounds r minus the distance to a triangle from above, on the offset of another one.
class DepthBound {
 public:
  DepthBound(const std::array<Vec3d, 3>& offset, const SurfaceTriangle& other, double radius)
      : offset_(offset), other_(other), r_(radius) {}

  // Nothing: it is nowhere near.
  [[nodiscard]] std::optional<DepthAtCorners> find() const {
    const std::array<Place, 3> corners{place(offset_[0]), place(offset_[1]), place(offset_[2])};
    const Place& farthest = *std::ranges::max_element(corners, {}, &Place::distance);
    if (farthest.distance <= r_) return DepthAtCorners{r_, r_, r_};
    // Distances are convex: the tangent at any place bounds them from below. One from where the distance is r cuts
    // off most; it lies on the way from the farthest corner to the nearest place.
    const std::optional<Place> near = nearest_place();
    if (!near) return std::nullopt;
    if (near->distance >= r_) return tangent(*near);
    // Newton's steps from outside stay there.
    Place at = farthest;
    for (int i = 0; i < 20; ++i) {
      const Vec3d away = at.x - at.foot, way = near->x - at.x;
      const double speed = dot(away, way) / at.distance;
      if (!(at.distance - r_ > kSame * r_ && speed < 0)) break;
      at = place(at.x - way * ((at.distance - r_) / speed));
    }
    return tangent(at);
  }

 private:
  // With the nearest one of the other triangle.
  struct Place {
    Vec3d x, foot;
    double distance;
  };
  [[nodiscard]] Place place(Vec3d x) const {
    const Vec3d foot = nearest_on_triangle(x, other_);
    return {x, foot, length(x - foot)};
  }

  // By projecting back and forth between the two triangles; about the nearest one does, too. Nothing: all are beyond
  // the radius.
  [[nodiscard]] std::optional<Place> nearest_place() const {
    const SurfaceTriangle own{offset_[0], offset_[1], offset_[2], 0};
    Place at = place((offset_[0] + offset_[1] + offset_[2]) / 3.0);
    for (int i = 0; i < 100; ++i) {
      if (is_beyond(at)) return std::nullopt;
      const Vec3d before = at.x;
      at = place(nearest_on_triangle(at.foot, own));
      if (length(at.x - before) < kNear * r_ || at.distance < kInside * r_) break;
    }
    if (is_beyond(at)) return std::nullopt;
    return at;
  }

  // Whether the tangent at a place shows that all places are r or more from the other triangle.
  [[nodiscard]] bool is_beyond(const Place& at) const {
    if (at.distance < r_) return false;
    const DepthAtCorners bound = tangent(at);
    return std::max({bound.d0, bound.d1, bound.d2}) <= 0;
  }

  [[nodiscard]] DepthAtCorners tangent(const Place& at) const {
    if (!(at.distance > 0)) return {r_, r_, r_};
    const Vec3d gradient = (at.x - at.foot) / at.distance;
    const auto depth = [&](Vec3d c) { return r_ - at.distance - dot(gradient, c - at.x); };
    return {depth(offset_[0]), depth(offset_[1]), depth(offset_[2])};
  }

  const std::array<Vec3d, 3>& offset_;
  const SurfaceTriangle& other_;
  double r_;
};

bool is_same(const DepthAtCorners& a, const DepthAtCorners& b, double tolerance) {
  return std::abs(a.d0 - b.d0) < tolerance && std::abs(a.d1 - b.d1) < tolerance &&
         std::abs(a.d2 - b.d2) < tolerance;
}

// Whether b is positive wherever a is.
bool is_within(const DepthAtCorners& a, const DepthAtCorners& b) {
  const std::array<double, 3> at{a.d0, a.d1, a.d2}, other{b.d0, b.d1, b.d2};
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t k = (i + 1) % 3;
    if (at[i] > 0 && !(other[i] > 0)) return false;
    if ((at[i] > 0) == (at[k] > 0)) continue;
    const double part = at[i] / (at[i] - at[k]);  // where a is 0
    if (!(other[i] + (other[k] - other[i]) * part > 0)) return false;
  }
  return true;
}

void add_depth(const DepthAtCorners& depth, double tolerance, std::vector<DepthAtCorners>& depths) {
  const auto holds = [&](const DepthAtCorners& d) {
    return is_same(depth, d, tolerance) || is_within(depth, d);
  };
  if (std::any_of(depths.begin(), depths.end(), holds)) return;
  std::erase_if(depths, [&](const DepthAtCorners& d) { return is_within(d, depth); });
  depths.push_back(depth);
}

}  // namespace

NearTriangles find_near_triangles(const SolidSurface& surface, const SurfaceTriangle& triangle,
                                  Vec3d normal, double radius) {
  const Vec3d down = normal * radius;
  const std::array<Vec3d, 3> offset{triangle.p0 - down, triangle.p1 - down, triangle.p2 - down};
  const Vec3d low = min(offset[0], min(offset[1], offset[2])) - Vec3d(radius);
  const Vec3d high = max(offset[0], max(offset[1], offset[2])) + Vec3d(radius);
  std::vector<DepthAtCorners> depths;
  std::vector<std::uint32_t> others;
  const auto is_listed = [&](std::uint32_t i) {
    return std::find(others.begin(), others.end(), i) != others.end();
  };
  surface.for_each_near(low, high, [&](const SurfaceTriangle& other) {
    const bool are_too_many = depths.size() > kMostDepths && others.size() > kMostOthers;
    if (other.region == triangle.region || are_too_many || !reaches_into(other, low, high)) return;
    if (is_beyond_reach(offset, normal, other, (1 - kSame) * radius)) return;
    const auto index = std::uint32_t(&other - surface.triangles().data());
    if (is_listed(index) || surface.is_joined(triangle.region, other.region)) return;
    if (depths.size() <= kMostDepths) {
      const auto depth = DepthBound(offset, other, radius).find();
      if (!depth) return;
      add_depth(*depth, kSame * radius, depths);
    }
    if (others.size() <= kMostOthers) others.push_back(index);
  });
  const auto is_everywhere = [](const DepthAtCorners& d) {
    return std::min({d.d0, d.d1, d.d2}) > 0;
  };
  if (depths.size() > kMostDepths || std::ranges::any_of(depths, is_everywhere)) {
    depths = {{radius, radius, radius}};
  }
  NearTriangles found{std::move(depths), std::nullopt};
  if (others.size() <= kMostOthers) found.others = std::move(others);
  return found;
}

NearLists::NearLists(std::span<const List> lists) : begins_{0} {
  for (const List& list : lists) {
    triangles_.push_back(list.triangle);
    others_.insert(others_.end(), list.others.begin(), list.others.end());
    begins_.push_back(std::uint32_t(others_.size()));
  }
}

std::optional<std::span<const std::uint32_t>> NearLists::of(std::uint32_t triangle) const {
  const auto found = std::ranges::lower_bound(triangles_, triangle);
  if (found == triangles_.end() || *found != triangle) return std::nullopt;
  const auto i = std::size_t(found - triangles_.begin());
  return std::span(others_).subspan(begins_[i], begins_[i + 1] - begins_[i]);
}

}  // namespace arris
