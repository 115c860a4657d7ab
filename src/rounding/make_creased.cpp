#include "rounding/make_creased.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel_collect.h"
#include "rounding/crease_grooves.h"
#include "rounding/creases.h"
#include "rounding/smooth_reach.h"

namespace arris {
namespace {

// Triangles whose bands one thread finds at a time.
constexpr std::size_t kTrianglesAtOnce = 256;
// Pairs of triangles within the radius that are too many on a curved surface; and how they are estimated.
constexpr std::size_t kMostPairs = 8'000'000, kSampledTriangles = 256;
// Relative to the radius: a place this near to a crease is of a rounded edge or corner.
constexpr double kNearCrease = 2;

class CreasedMaker {
 public:
  CreasedMaker(const CreasedInput& in, std::span<const std::uint32_t> shells)
      : in_(in),
        shells_(shells),
        outer_(in.welded.shells[shells.front()]),
        center_(outer_.center()) {
    for (const std::uint32_t s : shells) {
      const Shell& shell = in.welded.shells[s];
      const auto first = in.welded.triangles_by_shell.begin() + shell.first_triangle;
      triangles_.insert(triangles_.end(), first, first + shell.triangle_count);
    }
    has_smooth_edges_ = std::ranges::any_of(triangles_, [&](std::uint32_t t) {
      const auto kinds = in.kinds.subspan(std::size_t{3} * t, 3);
      return std::ranges::count(kinds, EdgeKind::smooth) > 0;
    });
  }

  // Closed, and there is a face on both sides of every edge.
  [[nodiscard]] bool is_solid() const {
    for (const std::uint32_t s : shells_) {
      if (!in_.welded.shells[s].closed) return false;
    }
    for (const std::uint32_t t : triangles_) {
      for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
        if (in_.welded.twin[h] > kLastHalfEdge) return false;
      }
    }
    return true;
  }

  [[nodiscard]] std::optional<MadeCreased> make() const {
    if (has_smooth_edges_ && in_.is_outside) return std::nullopt;
    SolidSurface surface = make_surface();
    if (has_smooth_edges_ && is_too_fine(surface)) return std::nullopt;
    join_smooth_faces(surface);
    std::optional<std::vector<CreaseCurve>> creases = find_creases(
        {in_.welded, in_.regions, in_.kinds, shells_, surface, center_, outer_.size(), in_.radius});
    if (!creases || !covers(surface, *creases)) return std::nullopt;
    std::vector<TriangleBand> bands = parallel_collect<TriangleBand>(
        triangles_.size(), kTrianglesAtOnce,
        [&](std::size_t i, auto& list) { append_bands(surface, triangles_[i], list); });
    const double tolerance = crease_tolerance(outer_.size(), in_.radius);
    CreaseShape shape;
    if (!in_.is_outside) shape = make_crease_shape(surface, *creases, in_.radius, tolerance);
    CreasedSolid solid{std::move(surface), CreasePipes(std::move(*creases), in_.radius), in_.radius,
                       tolerance, std::move(shape)};
    if (!in_.is_outside) solid.shape.grooves = find_grooves(solid);
    std::vector<PlainCrease> plain = find_plain_creases(solid, in_.regions.planes);
    return MadeCreased{std::move(solid), std::move(bands), std::move(plain)};
  }

 private:
  [[nodiscard]] SolidSurface make_surface() const {
    std::vector<SurfaceTriangle> triangles;
    triangles.reserve(triangles_.size());
    for (const std::uint32_t t : triangles_) {
      if (in_.regions.region[t] == kNone) continue;
      const Triangle& corners = in_.welded.triangles[t];
      const auto at = [&](std::size_t k) {
        return Vec3d(in_.welded.vertices[corners[k]]) - center_;
      };
      triangles.push_back({at(0), at(1), at(2), in_.regions.region[t], t});
    }
    return {std::move(triangles), in_.radius};
  }

  void join_smooth_faces(SolidSurface& surface) const {
    if (!has_smooth_edges_) return;
    std::vector<FacePair> smooth, sharp;
    for (const std::uint32_t t : triangles_) {
      for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
        const FacePair faces(in_.regions.region[t], in_.regions.region[in_.welded.twin[h] / 3]);
        if (in_.kinds[h] == EdgeKind::smooth) smooth.push_back(faces);
        if (in_.kinds[h] == EdgeKind::convex) sharp.push_back(faces);
      }
    }
    std::ranges::sort(smooth);
    std::ranges::sort(sharp);
    smooth.erase(std::unique(smooth.begin(), smooth.end()), smooth.end());
    surface.set_joined(find_smooth_reach({surface, smooth, sharp, in_.regions, in_.radius}));
  }

  // Facets by far smaller than the radius cost the square of their number.
  [[nodiscard]] bool is_too_fine(const SolidSurface& surface) const {
    const std::span<const SurfaceTriangle> triangles = surface.triangles();
    const std::size_t step = std::max<std::size_t>(1, triangles.size() / kSampledTriangles);
    std::size_t near = 0, sampled = 0;
    for (std::size_t i = 0; i < triangles.size(); i += step, ++sampled) {
      const Vec3d middle = (triangles[i].p0 + triangles[i].p1 + triangles[i].p2) / 3.0;
      const Vec3d reach(in_.radius);
      surface.for_each_near(middle - reach, middle + reach,
                            [&](const SurfaceTriangle&) { ++near; });
    }
    return near / sampled * triangles.size() > kMostPairs;
  }

  // Whether each face is kept somewhere, or has a crease, or one near: none vanishes that walls too near have taken
  // away.
  [[nodiscard]] bool covers(const SolidSurface& surface,
                            std::span<const CreaseCurve> creases) const {
    std::vector<std::uint32_t> rounded;
    for (const CreaseCurve& c : creases) rounded.insert(rounded.end(), {c.face_a, c.face_b});
    std::ranges::sort(rounded);
    const BoxTree near = tree_of(creases);
    const auto is_at_crease = [&](Vec3d x) {
      bool found = false;
      near.for_each_near(x, x, [&](std::uint32_t i) {
        const CreaseCurve& c = creases[i];
        found = found || length(x - c.at(nearest_parameter(c, x))) <= kNearCrease * in_.radius;
      });
      return found;
    };
    const double least = in_.radius - crease_tolerance(outer_.size(), in_.radius);
    return std::ranges::all_of(surface.triangles(), [&](const SurfaceTriangle& t) {
      if (std::ranges::binary_search(rounded, t.region)) return true;
      const Vec3d middle = (t.p0 + t.p1 + t.p2) / 3.0;
      const Vec3d normal = in_.regions.planes[t.region].normal;
      return !surface.is_near(middle - normal * in_.radius, least, t.region) ||
             is_at_crease(middle);
    });
  }

  [[nodiscard]] BoxTree tree_of(std::span<const CreaseCurve> creases) const {
    std::vector<Box> boxes;
    for (std::uint32_t i = 0; i < creases.size(); ++i) {
      const CreaseCurve& c = creases[i];
      const Vec3d p0 = c.at(c.u0), p1 = c.at(c.u1);
      const double bulge = c.is_line ? 0 : 0.5 * (c.u1 - c.u0) * std::max(length(c.a), length(c.b));
      const Vec3d reach(kNearCrease * in_.radius + bulge);
      boxes.push_back({min(p0, p1) - reach, max(p0, p1) + reach, i});
    }
    return BoxTree(std::move(boxes));
  }

  void append_bands(const SolidSurface& surface, std::uint32_t t,
                    std::vector<TriangleBand>& bands) const {
    // Pieces of split triangles have no barycentrics of their own.
    if (t >= in_.mesh.triangles.size() || in_.regions.region[t] == kNone) return;
    const Triangle& corners = in_.mesh.triangles[t];
    const auto at = [&](std::size_t k) { return Vec3d(in_.mesh.positions[corners[k]]) - center_; };
    const SurfaceTriangle triangle{at(0), at(1), at(2), in_.regions.region[t], t};
    const Vec3d normal = in_.regions.planes[triangle.region].normal;
    for (const DepthAtCorners& d : find_depths(surface, triangle, normal, in_.radius)) {
      bands.push_back({t, {float(d.d0), float(d.d1 - d.d0), float(d.d2 - d.d0), kNone}});
    }
  }

  const CreasedInput& in_;
  std::span<const std::uint32_t> shells_;
  const Shell& outer_;
  Vec3d center_;
  std::vector<std::uint32_t> triangles_;  // of the mesh
  bool has_smooth_edges_ = false;
};

}  // namespace

std::optional<MadeCreased> make_creased_solid(const CreasedInput& input,
                                              std::span<const std::uint32_t> shells) {
  const CreasedMaker maker(input, shells);
  if (!maker.is_solid()) return std::nullopt;
  return maker.make();
}

}  // namespace arris
