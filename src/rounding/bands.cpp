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
        const double d = length(
            (Vec3d(network.arcs[a].arc.line.p0) + network.arcs[a].arc.line.p1()) * 0.5 - middle);
        if (d < nearest) {
          nearest = d;
          arc = a;
        }
      }
      out_.push_back({t, {float(solid_.size), 0, 0, first_arc + arc}});
    }
  }

 private:
  struct DepthAndAlong {
    double depth, along;
  };

  // Does the triangle have points of some depth within the edge's extent? Both are linear on it: what of it is
  // deep enough is a triangle or quadrilateral whose extent along the edge is that of its corners.
  [[nodiscard]] bool reaches(const std::array<DepthAndAlong, 3>& corners, double along_min,
                             double along_max) const {
    const double least = kDepthTolerance * solid_.size;
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    const auto include = [&](double along) {
      low = std::min(low, along);
      high = std::max(high, along);
    };
    for (std::size_t i = 0; i < 3; ++i) {
      const DepthAndAlong& p = corners[i];
      const DepthAndAlong& q = corners[(i + 1) % 3];
      if (p.depth > least) include(p.along);
      if ((p.depth > least) != (q.depth > least)) {
        include(p.along + (q.along - p.along) * (least - p.depth) / (q.depth - p.depth));
      }
    }
    return low <= high && (solid_.exact || (high >= along_min && low <= along_max));
  }

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
      std::array<DepthAndAlong, 3> corners;
      for (std::size_t c = 0; c < 3; ++c) {
        const Vec3d p = corner(t, c);
        corners[c] = {dot(j.normal, p) - offset, dot(axis, p)};
      }
      if (!reaches(corners, along_min, along_max)) continue;
      const double c0 = corners[0].depth;
      out_.push_back(
          {t, {float(c0), float(corners[1].depth - c0), float(corners[2].depth - c0), arc}});
    }
  }

  [[nodiscard]] std::pair<double, double> extent_along(const NetworkArc& source, Vec3d axis) const {
    const std::array<double, 4> along = {dot(axis, Vec3d(source.arc.line.p0)),
                                         dot(axis, source.arc.line.p1()), dot(axis, source.v0),
                                         dot(axis, source.v1)};
    const auto [low, high] = std::ranges::minmax(along);
    // Where the face widens at an obtuse corner its band goes on past the edge's end.
    return {low - in_.radius, high + in_.radius};
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
