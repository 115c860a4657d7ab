#include "rounding/edge_radii.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

namespace arris {
namespace {

// Of the mesh's size: an edge this near to a segment lies on it, or to a box within.
constexpr double kBeside = 1e-4;
// Angles that differ by no more are the same.
constexpr double kSameAngle = radians(0.01);

class RadiusFinder {
 public:
  RadiusFinder(const MeshView& mesh, const WeldedMesh& welded, const FlatRegions& regions,
               const RoundingOptions& options)
      : places_(mesh.places.empty() ? mesh.positions : mesh.places),
        welded_(welded),
        regions_(regions),
        options_(options) {
    Vec3d low(INFINITY), high(-INFINITY);
    for (const Vec3f& p : places_) {
      low = min(low, Vec3d(p));
      high = max(high, Vec3d(p));
    }
    slack_ = places_.empty() ? 0 : kBeside * length(high - low);
  }

  // The last rule that holds gives it.
  [[nodiscard]] double radius_of(std::uint32_t h, std::vector<std::uint64_t>& matches) const {
    const EdgeRule* last = nullptr;
    for (std::size_t i = 0; i < options_.rules.size(); ++i) {
      if (!holds(options_.rules[i], h)) continue;
      ++matches[i];
      last = &options_.rules[i];
    }
    if (last == nullptr) return own_radius(h).value_or(options_.radius);
    return last->is_part ? last->radius * options_.radius : last->radius;
  }

 private:
  [[nodiscard]] std::optional<double> own_radius(std::uint32_t h) const {
    const VertexPair ends{std::min(welded_.origin(h), welded_.target(h)),
                          std::max(welded_.origin(h), welded_.target(h))};
    const auto at = std::ranges::lower_bound(welded_.edge_radii, ends, {}, &EdgeRadius::vertices);
    if (at == welded_.edge_radii.end() || at->vertices != ends) return std::nullopt;
    return double(at->radius);
  }

  [[nodiscard]] bool holds(const EdgeRule& rule, std::uint32_t h) const {
    const Vec3d p0(places_[welded_.source[welded_.origin(h)]]);
    const Vec3d p1(places_[welded_.source[welded_.target(h)]]);
    const double turn = turn_at(welded_, regions_, h);
    if (rule.kind == (turn < 0 ? RoundEdges::convex : RoundEdges::concave)) return false;
    if (rule.turn) {
      const auto [least, most] = *rule.turn;
      const double angle = std::abs(turn);
      if (angle < least - kSameAngle || angle > most + kSameAngle) return false;
    }
    if (rule.box && !(is_within(*rule.box, p0) && is_within(*rule.box, p1))) return false;
    const auto lies_on = [&](const std::array<Vec3d, 2>& segment) {
      return is_beside(segment, p0) && is_beside(segment, p1);
    };
    return rule.segments.empty() || std::ranges::any_of(rule.segments, lies_on);
  }

  [[nodiscard]] bool is_within(const std::array<Vec3d, 2>& box, Vec3d p) const {
    for (int axis = 0; axis < 3; ++axis) {
      if (p[axis] < box[0][axis] - slack_ || p[axis] > box[1][axis] + slack_) return false;
    }
    return true;
  }

  [[nodiscard]] bool is_beside(const std::array<Vec3d, 2>& segment, Vec3d p) const {
    const Vec3d along = segment[1] - segment[0];
    const double squared = length_squared(along);
    const double part =
        squared > 0 ? std::clamp(dot(p - segment[0], along) / squared, 0.0, 1.0) : 0;
    return length(p - segment[0] - along * part) <= slack_;
  }

  std::span<const Vec3f> places_;
  const WeldedMesh& welded_;
  const FlatRegions& regions_;
  const RoundingOptions& options_;
  double slack_ = 0;
};

}  // namespace

EdgeRadii find_edge_radii(const MeshView& mesh, const WeldedMesh& welded,
                          const FlatRegions& regions, std::span<const EdgeKind> kinds,
                          const RoundingOptions& options) {
  EdgeRadii out{{}, std::vector<std::uint64_t>(options.rules.size(), 0)};
  if (options.rules.empty() && welded.edge_radii.empty()) return out;
  const RadiusFinder finder(mesh, welded, regions, options);
  std::vector<double> radii(kinds.size(), options.radius);
  bool any = false;
  for (std::uint32_t h = 0; h < radii.size(); ++h) {
    const std::uint32_t twin = welded.twin[h];
    const bool is_rounded = kinds[h] == EdgeKind::convex ||
                            (kinds[h] == EdgeKind::concave && options.edges != RoundEdges::convex);
    if (!is_rounded || twin < h) continue;
    radii[h] = radii[twin] = finder.radius_of(h, out.matches);
    any = any || radii[h] != options.radius;
  }
  if (any) out.radii = std::move(radii);
  return out;
}

}  // namespace arris
