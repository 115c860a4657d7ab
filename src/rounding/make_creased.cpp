#include "rounding/make_creased.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel_collect.h"
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
        center_(outer_.center()),
        r_(in.radius) {
    for (const std::uint32_t s : shells) {
      const Shell& shell = in.welded.shells[s];
      const auto first = in.welded.triangles_by_shell.begin() + shell.first_triangle;
      triangles_.insert(triangles_.end(), first, first + shell.triangle_count);
    }
    has_smooth_edges_ = std::ranges::any_of(triangles_, [&](std::uint32_t t) {
      const auto kinds = in.kinds.subspan(std::size_t{3} * t, 3);
      return std::ranges::count(kinds, EdgeKind::smooth) > 0;
    });
    if (in.radii.empty()) return;
    r_ = 0;
    for (const std::uint32_t t : triangles_) {
      for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
        if (in.kinds[h] != EdgeKind::convex) continue;
        has_own_radii_ = has_own_radii_ || in.radii[h] != in.radius;
        r_ = std::max(r_, in.radii[h]);
      }
    }
    if (!has_own_radii_) r_ = in.radius;
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
    const std::vector<FacePair> sharp = join_smooth_faces(surface);
    VariedCreases found = find(surface);
    std::vector<CreaseCurve>& creases = found.curves;
    if (creases.empty()) return std::nullopt;
    // Fillets are all or none: the space outside has no faces to keep beside them.
    if (in_.is_outside && !found.missing.empty()) return std::nullopt;
    std::vector<FacePair> thin;
    if (!in_.is_outside) thin = find_thin_walls({surface, {}, sharp, in_.regions, r_});
    const std::uint64_t thin_walls = thin.size() / 2;
    // Edges that stay sharp end thin walls, too.
    for (const auto& [a, b] : found.missing) thin.insert(thin.end(), {{a, b}, {b, a}});
    sort_pairs(thin);
    surface.set_thin(thin);
    const std::vector<FacePair> hidden = pairs_that_hide_faces(surface, creases);
    if (!hidden.empty()) {
      if (in_.is_outside) return std::nullopt;
      thin.insert(thin.end(), hidden.begin(), hidden.end());
      sort_pairs(thin);
      surface.set_thin(thin);
    }
    std::vector<std::uint32_t> loose;
    for (const FacePair& pair : thin) loose.push_back(pair.first);
    // The field knows the nearest edge alone: where edges turn by different angles, it may miss a rounding's end.
    if (!found.field.is_uniform()) {
      for (const SurfaceTriangle& t : surface.triangles()) loose.push_back(t.region);
      std::ranges::sort(loose);
    }
    loose.erase(std::unique(loose.begin(), loose.end()), loose.end());
    std::vector<TriangleBand> bands = parallel_collect<TriangleBand>(
        triangles_.size(), kTrianglesAtOnce,
        [&](std::size_t i, auto& list) { append_bands(surface, triangles_[i], list); });
    const double tolerance = crease_tolerance(outer_.size(), r_);
    CreasedSolid solid{
        std::move(surface), CreasePipes(std::move(creases)), std::move(found.field), r_, tolerance,
        std::move(loose)};
    std::vector<PlainCrease> plain = find_plain_creases(solid, in_.regions.planes);
    for (const std::uint32_t h : edges_between(found.missing)) found.smaller.push_back({h, 0});
    return MadeCreased{std::move(solid), std::move(bands), std::move(found.smaller),
                       std::move(plain), thin_walls};
  }

 private:
  [[nodiscard]] VariedCreases find(const SolidSurface& surface) const {
    const CreaseInput input{in_.welded, in_.regions, in_.kinds,     shells_,
                            surface,    center_,     outer_.size(), r_};
    const bool clamp = in_.on_overlap == OnOverlap::clamp && !in_.is_outside;
    if (has_own_radii_) return find_varied_creases({input, in_.radii, clamp});
    FoundCreases found = find_creases(input);
    if (clamp && !found.missing.empty()) {
      const std::vector<double> radii(in_.kinds.size(), r_);
      return find_varied_creases({input, radii, clamp});
    }
    return {std::move(found.curves), RadiusField(r_), {}, std::move(found.missing)};
  }

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
    return {std::move(triangles), r_};
  }

  // Comes out: faces that meet in convex edges, each pair in both orders; sorted.
  std::vector<FacePair> join_smooth_faces(SolidSurface& surface) const {
    std::vector<FacePair> smooth, sharp;
    for_edges([&](std::uint32_t h, FacePair faces) {
      if (in_.kinds[h] == EdgeKind::smooth) smooth.push_back(faces);
      if (in_.kinds[h] == EdgeKind::convex) sharp.push_back(faces);
    });
    sort_pairs(smooth);
    sort_pairs(sharp);
    if (!smooth.empty()) {
      surface.set_joined(find_smooth_reach({surface, smooth, sharp, in_.regions, r_}));
    }
    return sharp;
  }

  template <class Visit>
  void for_edges(const Visit& visit) const {
    for (const std::uint32_t t : triangles_) {
      for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
        visit(h, FacePair(in_.regions.region[t], in_.regions.region[in_.welded.twin[h] / 3]));
      }
    }
  }

  [[nodiscard]] std::vector<std::uint32_t> edges_between(std::span<const FacePair> pairs) const {
    std::vector<std::uint32_t> edges;
    if (pairs.empty()) return edges;
    for_edges([&](std::uint32_t h, FacePair faces) {
      if (in_.kinds[h] != EdgeKind::convex || h > in_.welded.twin[h]) return;
      if (std::ranges::binary_search(pairs, FacePair(std::minmax(faces.first, faces.second))))
        edges.push_back(h);
    });
    return edges;
  }

  // Facets by far smaller than the radius cost the square of their number.
  [[nodiscard]] bool is_too_fine(const SolidSurface& surface) const {
    const std::span<const SurfaceTriangle> triangles = surface.triangles();
    const std::size_t step = std::max<std::size_t>(1, triangles.size() / kSampledTriangles);
    std::size_t near = 0, sampled = 0;
    for (std::size_t i = 0; i < triangles.size(); i += step, ++sampled) {
      const Vec3d middle = (triangles[i].p0 + triangles[i].p1 + triangles[i].p2) / 3.0;
      const Vec3d reach(r_);
      surface.for_each_near(middle - reach, middle + reach,
                            [&](const SurfaceTriangle&) { ++near; });
    }
    return near / sampled * triangles.size() > kMostPairs;
  }

  static void sort_pairs(std::vector<FacePair>& pairs) {
    std::ranges::sort(pairs);
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  }

  // No face vanishes that walls too near have taken away: each is kept somewhere, or has a crease, or one near. Comes
  // out: the others and what is too near to them, each pair in both orders.
  [[nodiscard]] std::vector<FacePair> pairs_that_hide_faces(
      const SolidSurface& surface, std::span<const CreaseCurve> creases) const {
    std::vector<std::uint32_t> rounded;
    for (const CreaseCurve& c : creases) rounded.insert(rounded.end(), {c.face_a, c.face_b});
    std::ranges::sort(rounded);
    const BoxTree near = tree_of(creases);
    const auto is_at_crease = [&](Vec3d x) {
      bool found = false;
      near.for_each_near(x, x, [&](std::uint32_t i) {
        const CreaseCurve& c = creases[i];
        found = found || length(x - c.at(nearest_parameter(c, x))) <= kNearCrease * r_;
      });
      return found;
    };
    const double least = r_ - crease_tolerance(outer_.size(), r_);
    std::vector<FacePair> pairs;
    for (const SurfaceTriangle& t : surface.triangles()) {
      if (std::ranges::binary_search(rounded, t.region)) continue;
      const Vec3d middle = (t.p0 + t.p1 + t.p2) / 3.0;
      const Vec3d c = middle - in_.regions.planes[t.region].normal * r_;
      if (!surface.is_blocked(c, least, t.region, middle) || is_at_crease(middle)) continue;
      surface.for_each_near(c - Vec3d(least), c + Vec3d(least), [&](const SurfaceTriangle& other) {
        if (other.region == t.region || surface.is_joined(t.region, other.region)) return;
        if (length(c - nearest_on_triangle(c, other)) >= least) return;
        pairs.emplace_back(t.region, other.region);
        pairs.emplace_back(other.region, t.region);
      });
    }
    return pairs;
  }

  [[nodiscard]] BoxTree tree_of(std::span<const CreaseCurve> creases) const {
    std::vector<Box> boxes;
    for (std::uint32_t i = 0; i < creases.size(); ++i) {
      const CreaseCurve& c = creases[i];
      const Vec3d p0 = c.at(c.u0), p1 = c.at(c.u1);
      const double bulge = c.is_line ? 0 : 0.5 * (c.u1 - c.u0) * std::max(length(c.a), length(c.b));
      const Vec3d reach(kNearCrease * r_ + bulge);
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
    for (const DepthAtCorners& d : find_depths(surface, triangle, normal, r_)) {
      bands.push_back({t, {float(d.d0), float(d.d1 - d.d0), float(d.d2 - d.d0), kNone}});
    }
  }

  const CreasedInput& in_;
  std::span<const std::uint32_t> shells_;
  const Shell& outer_;
  Vec3d center_;
  double r_;  // the largest of its edges
  bool has_own_radii_ = false;
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
