#include "rounding/bands.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace arris {
namespace {

// A band shallower than this, relative to the size, is no band.
constexpr double kDepthTolerance = 1e-7;

class BandMaker {
 public:
  BandMaker(const BandInput& input, const Solid& solid, std::vector<TriangleBand>& out)
      : in_(input), solid_(solid), out_(out) {}

  void add(const NetworkArc& source, std::uint32_t arc) {
    add_on(source, arc, source.arc.face_a, source.arc.face_b);
    add_on(source, arc, source.arc.face_b, source.arc.face_a);
  }

  // All of a face that E doesn't have: every point of it is in the void.
  void add_whole(std::uint32_t face, const ShellNetwork& network, std::uint32_t first_arc) {
    for (std::uint32_t i = in_.triangle_begin[face]; i < in_.triangle_begin[face + 1]; ++i) {
      const std::uint32_t t = in_.triangles[i];
      const Vec3d middle = (corner(t, 0) + corner(t, 1) + corner(t, 2)) / 3.0;
      double nearest = std::numeric_limits<double>::infinity();
      std::uint32_t arc = 0;
      for (std::uint32_t a = 0; a < network.arcs.size(); ++a) {
        if (network.arcs[a].arc.is_stub()) continue;
        const double d =
            length((Vec3d(network.arcs[a].arc.p0) + Vec3d(network.arcs[a].arc.p1)) * 0.5 - middle);
        if (d < nearest) {
          nearest = d;
          arc = a;
        }
      }
      out_.push_back({t, {float(solid_.size), 0, 0, first_arc + arc}});
    }
  }

 private:
  [[nodiscard]] Vec3d corner(std::uint32_t triangle, std::size_t k) const {
    return Vec3d(in_.mesh.positions[in_.mesh.triangles[triangle][k]]) - solid_.center;
  }

  // Bands on `face` of its arc with face `other`.
  void add_on(const NetworkArc& source, std::uint32_t arc, std::uint32_t face,
              std::uint32_t other) {
    const Plane& k = in_.regions.planes[face];
    const Plane& j = in_.regions.planes[other];
    const Vec3d axis = normalize(cross(k.normal, j.normal));
    const auto [along_min, along_max] = extent_along(source, axis);
    const double offset =
        in_.radius * dot(j.normal, k.normal) + (j.d - in_.radius);  // of n_j·I: depth 0
    for (std::uint32_t i = in_.triangle_begin[face]; i < in_.triangle_begin[face + 1]; ++i) {
      const std::uint32_t t = in_.triangles[i];
      std::array<double, 3> depth{};
      double lowest = std::numeric_limits<double>::infinity();
      double highest = -lowest;
      double deepest = -lowest;
      for (std::size_t c = 0; c < 3; ++c) {
        const Vec3d p = corner(t, c);
        depth[c] = dot(j.normal, p) - offset;
        deepest = std::max(deepest, depth[c]);
        lowest = std::min(lowest, dot(axis, p));
        highest = std::max(highest, dot(axis, p));
      }
      if (deepest <= kDepthTolerance * solid_.size) continue;
      if (!solid_.exact && (highest < along_min || lowest > along_max)) continue;
      out_.push_back(
          {t, {float(depth[0]), float(depth[1] - depth[0]), float(depth[2] - depth[0]), arc}});
    }
  }

  [[nodiscard]] std::pair<double, double> extent_along(const NetworkArc& source, Vec3d axis) const {
    const std::array<double, 4> along = {dot(axis, Vec3d(source.arc.p0)),
                                         dot(axis, Vec3d(source.arc.p1)), dot(axis, source.v0),
                                         dot(axis, source.v1)};
    const auto [low, high] = std::ranges::minmax(along);
    // Where the face widens at an obtuse corner its band goes on past the edge's end.
    return {low - 2 * in_.radius, high + 2 * in_.radius};
  }

  const BandInput& in_;
  const Solid& solid_;
  std::vector<TriangleBand>& out_;
};

}  // namespace

void append_bands(const BandInput& input, const ShellNetwork& network, const Solid& solid,
                  std::uint32_t first_arc, std::vector<TriangleBand>& bands) {
  BandMaker maker(input, solid, bands);
  std::vector<bool> has_arc(solid.rewired ? solid.face_count : 0, false);
  for (std::uint32_t a = 0; a < network.arcs.size(); ++a) {
    const NetworkArc& source = network.arcs[a];
    if (source.arc.is_stub()) continue;
    maker.add(source, first_arc + a);
    if (!solid.rewired) continue;
    has_arc[source.arc.face_a - solid.first_face] = true;
    has_arc[source.arc.face_b - solid.first_face] = true;
  }
  for (std::uint32_t f = 0; f < has_arc.size(); ++f) {
    if (!has_arc[f]) maker.add_whole(solid.first_face + f, network, first_arc);
  }
}

}  // namespace arris
