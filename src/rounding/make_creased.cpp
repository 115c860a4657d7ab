#include "rounding/make_creased.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel_collect.h"
#include "rounding/creases.h"
#include "rounding/growing_ball.h"
#include "rounding/near_triangles.h"
#include "rounding/smooth_reach.h"
#include "rounding/thin_walls.h"

namespace arris {
namespace {

// Triangles, and edges, that one thread looks at at a time.
constexpr std::size_t kTrianglesAtOnce = 256, kEdgesAtOnce = 64, kGridsAtOnce = 16;
// Pairs of triangles within the radius that are too many on a curved surface; and how they are estimated.
constexpr std::size_t kMostPairs = 8'000'000, kSampledTriangles = 256;
// Of the radius' square: triangles of which less would be spared have no grid.
constexpr double kLargeArea = 16;
// Relative to the radius: a place this near to a crease is of a rounded edge or corner.
constexpr double kNearCrease = 2;

class CreasedMaker {
 public:
  CreasedMaker(const CreasedInput& in, std::span<const std::uint32_t> shells,
               std::optional<Vec3d> center)
      : in_(in),
        shells_(shells),
        outer_(in.welded.shells[shells.front()]),
        center_(center.value_or(outer_.center())),
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
    if (!has_own_radii_) {
      r_ = in.radius;
    } else if (r_ > outer_.size()) {
      // Such edges get what fits; the others don't mind.
      r_ = outer_.size();
      for (const double radius : in.radii) lowered_.push_back(std::min(radius, r_));
    }
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
    // Such balls fit nowhere in the solid, and their fillets would be larger than it; or no edge has a radius.
    if (r_ > outer_.size() || r_ == 0) return std::nullopt;
    SolidSurface surface = make_surface();
    if (has_smooth_edges_ && is_too_fine(surface)) return std::nullopt;
    const auto [smooth, sharp] = pairs_of_faces();
    if (!smooth.empty()) {
      surface.set_joined(find_smooth_reach({surface, smooth, sharp, in_.regions, r_}));
    }
    surface.set_walls(find_thin_walls({surface, smooth, sharp, in_.regions, r_}));
    VariedCreases found = find(surface);
    if (found.curves.empty()) return std::nullopt;
    auto [bands, lists] = find_bands(surface);
    ClearCells clear = find_clear_cells(surface, bands);
    CreasedSolid solid{std::move(surface),
                       CreasePipes(std::move(found.curves)),
                       std::move(found.field),
                       r_,
                       crease_tolerance(outer_.size(), r_),
                       std::move(clear),
                       NearLists(lists),
                       {},
                       StuckPlaces(r_),
                       NarrowCells(r_)};
    if (in_.is_outside) {
      solid.mouths = OpenMouths(solid.surface, solid.pipes, solid.tolerance);
    }
    solid.surface.set_firm(faces_that_vanish(solid));
    std::vector<PlainCrease> plain = find_plain_creases(solid, in_.regions.planes);
    append_sharp_parts(solid, found.clamped);
    return MadeCreased{std::move(solid), std::move(bands), std::move(found.clamped),
                       std::move(plain)};
  }

 private:
  [[nodiscard]] VariedCreases find(const SolidSurface& surface) const {
    const CreaseInput input{in_.welded, in_.regions, in_.kinds,     shells_,
                            surface,    center_,     outer_.size(), r_};
    const bool clamp = in_.on_overlap == OnOverlap::clamp;
    if (has_own_radii_) {
      const std::span<const double> radii = lowered_.empty() ? in_.radii : lowered_;
      return find_varied_creases({input, radii, clamp});
    }
    FoundCreases found = find_creases(input);
    if (clamp && !found.missing.empty()) {
      const std::vector<double> radii(in_.kinds.size(), r_);
      return find_varied_creases({input, radii, clamp});
    }
    return {std::move(found.curves), RadiusField(r_), {}};
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
    return {triangles, r_};
  }

  // Faces that meet in smooth edges, and in convex ones, each pair in both orders; sorted.
  struct FacePairs {
    std::vector<FacePair> smooth, sharp;
  };
  [[nodiscard]] FacePairs pairs_of_faces() const {
    FacePairs out;
    for_edges([&](std::uint32_t h, FacePair faces) {
      if (in_.kinds[h] == EdgeKind::smooth) out.smooth.push_back(faces);
      if (in_.kinds[h] == EdgeKind::convex) out.sharp.push_back(faces);
    });
    sort_pairs(out.smooth);
    sort_pairs(out.sharp);
    return out;
  }

  template <class Visit>
  void for_edges(const Visit& visit) const {
    for (const std::uint32_t t : triangles_) {
      for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
        visit(h, faces_at(h));
      }
    }
  }

  // Of edges that have no room for the radius, and are not yet among what is clamped.
  void append_sharp_parts(const CreasedSolid& solid, std::vector<ClampedPart>& clamped) const {
    std::vector<std::uint32_t> known, edges;
    for (const ClampedPart& part : clamped) {
      if (part.radius == 0) known.push_back(part.half_edge);
    }
    std::ranges::sort(known);
    for_edges([&](std::uint32_t h, FacePair) {
      const bool is_rounded = in_.radii.empty() || in_.radii[h] > 0;
      if (in_.kinds[h] != EdgeKind::convex || h > in_.welded.twin[h] || !is_rounded) return;
      if (!std::ranges::binary_search(known, h)) edges.push_back(h);
    });
    const std::vector<ClampedPart> parts =
        parallel_collect<ClampedPart>(edges.size(), kEdgesAtOnce, [&](std::size_t i, auto& list) {
          const std::uint32_t h = edges[i];
          const auto [face, other] = faces_at(h);
          const auto at = [&](std::uint32_t v) { return Vec3d(in_.welded.vertices[v]) - center_; };
          const FaceEdge edge{at(in_.welded.origin(h)),
                              at(in_.welded.target(h)),
                              in_.regions.planes[face].normal,
                              in_.regions.planes[other].normal,
                              face,
                              other};
          for (const auto& [from, to] : solid.find_sharp_parts(edge)) {
            list.push_back({h, 0, from, to});
          }
        });
    clamped.insert(clamped.end(), parts.begin(), parts.end());
  }

  [[nodiscard]] FacePair faces_at(std::uint32_t h) const {
    return {in_.regions.region[h / 3], in_.regions.region[in_.welded.twin[h] / 3]};
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

  // Faces of which nothing is kept, and that have no crease, nor one near, nor a way for a ball to grow: walls too near
  // have taken them away. Facets at the tip of a sharp wedge are far from its crease.
  [[nodiscard]] std::vector<std::uint32_t> faces_that_vanish(const CreasedSolid& solid) const {
    const std::span<const CreaseCurve> creases = solid.pipes.creases();
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
    const std::span<const SurfaceTriangle> triangles = solid.surface.triangles();
    std::vector<std::uint32_t> faces = parallel_collect<std::uint32_t>(
        triangles.size(), kTrianglesAtOnce, [&](std::size_t i, std::vector<std::uint32_t>& list) {
          const SurfaceTriangle& t = triangles[i];
          if (std::ranges::binary_search(rounded, t.region)) return;
          const Vec3d middle = (t.p0 + t.p1 + t.p2) / 3.0;
          const Vec3d normal = in_.regions.planes[t.region].normal;
          if (solid.is_kept(middle, normal, t.region) || is_at_crease(middle)) return;
          const double r = solid.field.at(middle) - solid.tolerance;
          if (gets_stuck(solid.surface, middle, normal, t.region, r)) list.push_back(t.region);
        });
    std::ranges::sort(faces);
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    return faces;
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

  // Of the caller's mesh. Nothing: pieces of split triangles have no barycentrics of their own.
  [[nodiscard]] std::optional<SurfaceTriangle> callers_triangle(std::uint32_t t) const {
    if (t >= in_.mesh.triangles.size() || in_.regions.region[t] == kNone) return std::nullopt;
    const Triangle& corners = in_.mesh.triangles[t];
    const auto at = [&](std::size_t k) { return Vec3d(in_.mesh.positions[corners[k]]) - center_; };
    return SurfaceTriangle{at(0), at(1), at(2), in_.regions.region[t], t};
  }

  struct FoundBands {
    std::vector<TriangleBand> bands;
    std::vector<NearLists::List> lists;
  };

  // Bands in the order of the triangles; lists of those that have bands and few others near, by triangle.
  [[nodiscard]] FoundBands find_bands(const SolidSurface& surface) const {
    struct Found {
      std::uint32_t triangle;
      NearTriangles near;
    };
    const std::vector<Found> found = parallel_collect<Found>(
        triangles_.size(), kTrianglesAtOnce, [&](std::size_t i, std::vector<Found>& list) {
          const std::optional<SurfaceTriangle> triangle = callers_triangle(triangles_[i]);
          if (!triangle) return;
          const Vec3d normal = in_.regions.planes[triangle->region].normal;
          NearTriangles near = find_near_triangles(surface, *triangle, normal, r_);
          if (!near.depths.empty()) list.push_back({triangles_[i], std::move(near)});
        });
    FoundBands out;
    for (const auto& [t, near] : found) {
      for (const DepthAtCorners& d : near.depths) {
        out.bands.push_back({t, {float(d.d0), float(d.d1 - d.d0), float(d.d2 - d.d0), kNone}});
      }
      if (near.others) out.lists.push_back({t, *near.others});
    }
    std::ranges::sort(out.lists, {}, &NearLists::List::triangle);
    return out;
  }

  // Of triangles that bands tell little of. Those of a triangle come one after another.
  [[nodiscard]] ClearCells find_clear_cells(const SolidSurface& surface,
                                            std::span<const TriangleBand> bands) const {
    std::vector<std::span<const TriangleBand>> of;
    for (std::size_t i = 0, end = 0; i < bands.size(); i = end) {
      while (end < bands.size() && bands[end].triangle == bands[i].triangle) ++end;
      of.push_back(bands.subspan(i, end - i));
    }
    return ClearCells(parallel_collect<ClearCells::Grid>(
        of.size(), kGridsAtOnce, [&](std::size_t i, std::vector<ClearCells::Grid>& grids) {
          const SurfaceTriangle triangle = *callers_triangle(of[i].front().triangle);
          const Vec3d normal = in_.regions.planes[triangle.region].normal;
          const double area =
              0.5 * length(cross(triangle.p1 - triangle.p0, triangle.p2 - triangle.p0));
          if (!(area > kLargeArea * r_ * r_)) return;
          if (!spares_searches(surface, triangle, of[i], kLargeArea * r_ * r_ / area)) return;
          ClearCells::Grid grid = ClearCells::make_grid(surface, triangle, normal, r_);
          if (!grid.rows.empty()) grids.push_back(std::move(grid));
        }));
  }

  // Whether more than a share of a triangle lies in its bands and is kept, nearly.
  [[nodiscard]] bool spares_searches(const SolidSurface& surface, const SurfaceTriangle& triangle,
                                     std::span<const TriangleBand> bands, double share) const {
    constexpr int kSamples = 12;  // along each side
    const Vec3d down = in_.regions.planes[triangle.region].normal * r_;
    std::vector<Vec3d> in_bands;  // centres of balls
    for (int i = 0; i < kSamples; ++i) {
      for (int j = 0; i + j < kSamples; ++j) {
        const float u = (float(i) + 0.33F) / kSamples, v = (float(j) + 0.33F) / kSamples;
        const auto holds = [&](const TriangleBand& b) { return b.band.depth(u, v) > 0; };
        if (std::none_of(bands.begin(), bands.end(), holds)) continue;
        in_bands.push_back(triangle.p0 + (triangle.p1 - triangle.p0) * double(u) +
                           (triangle.p2 - triangle.p0) * double(v) - down);
      }
    }
    const double least = share * (kSamples * (kSamples + 1) / 2);
    std::size_t spared = 0;
    for (std::size_t i = 0; i < in_bands.size() && !(double(spared) > least); ++i) {
      if (!(double(spared + in_bands.size() - i) > least)) return false;
      spared += surface.is_near(in_bands[i], r_, triangle.region) ? 0 : 1;
    }
    return double(spared) > least;
  }

  const CreasedInput& in_;
  std::span<const std::uint32_t> shells_;
  const Shell& outer_;
  Vec3d center_;
  double r_;  // the largest of its edges
  bool has_own_radii_ = false;
  std::vector<double> lowered_;           // the input's radii, where one is larger than the solid
  std::vector<std::uint32_t> triangles_;  // of the mesh
  bool has_smooth_edges_ = false;
};

}  // namespace

std::optional<MadeCreased> make_creased_solid(const CreasedInput& input,
                                              std::span<const std::uint32_t> shells,
                                              std::optional<Vec3d> center) {
  const CreasedMaker maker(input, shells, center);
  if (!maker.is_solid()) return std::nullopt;
  return maker.make();
}

}  // namespace arris
