#include "rounding/make_creased.h"

#include <utility>

#include "rounding/crease_grooves.h"
#include "rounding/creases.h"

namespace arris {
namespace {

// Each curve is cut at the whole outlines of its faces: of a plate with many holes that takes the square of their
// number.
constexpr std::uint32_t kMostCreasedTriangles = 1000;

class CreasedMaker {
 public:
  CreasedMaker(const CreasedInput& in, std::uint32_t shell_index)
      : in_(in),
        shell_index_(shell_index),
        shell_(in.welded.shells[shell_index]),
        center_(shell_.center()) {}

  // Closed, and nothing about it is curved.
  [[nodiscard]] bool is_flat_solid() const {
    if (!shell_.closed || shell_.triangle_count > kMostCreasedTriangles) return false;
    for (std::uint32_t i = 0; i < shell_.triangle_count; ++i) {
      for (std::uint32_t h = 3 * triangle(i); h < 3 * triangle(i) + 3; ++h) {
        const EdgeKind kind = in_.kinds[h];
        if (kind != EdgeKind::flat && kind != EdgeKind::convex && kind != EdgeKind::concave) {
          return false;
        }
      }
    }
    return true;
  }

  std::optional<CreasedSolid> make(std::vector<TriangleBand>& bands) const {
    SolidSurface surface = make_surface();
    std::optional<std::vector<CreaseCurve>> creases = find_creases(
        {in_.welded, in_.regions, in_.kinds, surface, center_, shell_.size(), in_.radius},
        shell_index_);
    if (!creases) return std::nullopt;
    append_bands(surface, bands);
    const double tolerance = crease_tolerance(shell_.size(), in_.radius);
    CreaseShape shape;
    if (in_.with_outlines) {
      shape = make_crease_shape(surface, *creases, in_.radius, tolerance);
    }
    CreasedSolid solid{std::move(surface), CreasePipes(std::move(*creases), in_.radius), in_.radius,
                       tolerance, std::move(shape)};
    if (in_.with_outlines) solid.shape.grooves = find_grooves(solid);
    return solid;
  }

 private:
  [[nodiscard]] std::uint32_t triangle(std::uint32_t i) const {
    return in_.welded.triangles_by_shell[shell_.first_triangle + i];
  }

  [[nodiscard]] SolidSurface make_surface() const {
    std::vector<SurfaceTriangle> triangles;
    for (std::uint32_t i = 0; i < shell_.triangle_count; ++i) {
      const std::uint32_t t = triangle(i);
      if (in_.regions.region[t] == kNone) continue;
      const Triangle& corners = in_.welded.triangles[t];
      const auto at = [&](std::size_t k) {
        return Vec3d(in_.welded.vertices[corners[k]]) - center_;
      };
      triangles.push_back({at(0), at(1), at(2), in_.regions.region[t]});
    }
    return SolidSurface(std::move(triangles));
  }

  void append_bands(const SolidSurface& surface, std::vector<TriangleBand>& bands) const {
    for (std::uint32_t i = 0; i < shell_.triangle_count; ++i) {
      const std::uint32_t t = triangle(i);
      // Pieces of split triangles have no barycentrics of their own.
      if (t >= in_.mesh.triangles.size() || in_.regions.region[t] == kNone) continue;
      const Triangle& corners = in_.mesh.triangles[t];
      const auto at = [&](std::size_t k) {
        return Vec3d(in_.mesh.positions[corners[k]]) - center_;
      };
      const SurfaceTriangle triangle{at(0), at(1), at(2), in_.regions.region[t]};
      const Vec3d normal = in_.regions.planes[triangle.region].normal;
      for (const DepthAtCorners& d : find_depths(surface, triangle, normal, in_.radius)) {
        bands.push_back({t, {float(d.d0), float(d.d1 - d.d0), float(d.d2 - d.d0), kNone}});
      }
    }
  }

  const CreasedInput& in_;
  std::uint32_t shell_index_;
  const Shell& shell_;
  Vec3d center_;
};

}  // namespace

std::optional<CreasedSolid> make_creased_solid(const CreasedInput& input, std::uint32_t shell,
                                               std::vector<TriangleBand>& bands) {
  const CreasedMaker maker(input, shell);
  if (!maker.is_flat_solid()) return std::nullopt;
  return maker.make(bands);
}

}  // namespace arris
