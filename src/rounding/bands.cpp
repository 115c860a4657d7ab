#include "rounding/bands.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "rounding/box_tree.h"

namespace arris {
namespace {

// A band shallower than this, relative to the size, is no band.
constexpr double kDepthTolerance = 1e-7;
// Faces of more triangles than this keep them in a tree.
constexpr std::uint32_t kTreeFrom = 32;

class BandMaker {
 public:
  BandMaker(const BandInput& input, const Solid& solid, std::vector<TriangleBand>& out)
      : in_(input), solid_(solid), out_(out) {}

  void add(const NetworkArc& source, std::uint32_t arc) {
    add_on(source, arc, source.arc.face_a, source.arc.face_b);
    add_on(source, arc, source.arc.face_b, source.arc.face_a);
  }

  void add_border(const BorderFace& border, std::uint32_t first_arc) {
    NetworkArc source{};
    source.v0 = border.v0;
    source.v1 = border.v1;
    source.arc.line.p0 = Vec3f(border.v0);
    add_on(source, first_arc + border.arc, border.face, border.other);
  }

  // All of a face that E doesn't have: every point of it is in the void.
  void add_whole(std::uint32_t face, const ShellNetwork& network, std::uint32_t first_arc) {
    for (const std::uint32_t t : triangles_of(face)) {
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

  // What a triangle must reach into to have a band: points of the face of some depth, within the edge's extent.
  struct Reach {
    double least, most;  // depth
    double along_min, along_max;
  };

  // Depth and along are linear on the triangle: what of it has such a depth is a polygon whose extent along the
  // edge is that of its corners.
  [[nodiscard]] static bool reaches(const std::array<DepthAndAlong, 3>& corners,
                                    const Reach& reach) {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    const auto include = [&](double along) {
      low = std::min(low, along);
      high = std::max(high, along);
    };
    for (std::size_t i = 0; i < 3; ++i) {
      const DepthAndAlong& p = corners[i];
      const DepthAndAlong& q = corners[(i + 1) % 3];
      if (p.depth > reach.least && p.depth <= reach.most) include(p.along);
      for (const double bound : {reach.least, reach.most}) {
        if ((p.depth > bound) == (q.depth > bound)) continue;
        include(p.along + (q.along - p.along) * (bound - p.depth) / (q.depth - p.depth));
      }
    }
    return low <= high && high >= reach.along_min && low <= reach.along_max;
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
    const Reach reach = reach_of(source, axis, dot(j.normal, k.normal));
    const double offset =
        in_.radius * dot(j.normal, k.normal) + (j.d - in_.radius);  // of n_j·I: depth 0
    const auto add_to = [&](std::uint32_t t) {
      std::array<DepthAndAlong, 3> corners;
      for (std::size_t c = 0; c < 3; ++c) {
        const Vec3d p = corner(t, c);
        corners[c] = {dot(j.normal, p) - offset, dot(axis, p)};
      }
      if (!reaches(corners, reach)) return;
      const double c0 = corners[0].depth;
      out_.push_back(
          {t, {float(c0), float(corners[1].depth - c0), float(corners[2].depth - c0), arc}});
    };
    const std::span<const std::uint32_t> triangles = triangles_of(face);
    if (triangles.size() <= kTreeFrom) {
      std::ranges::for_each(triangles, add_to);
      return;
    }
    const std::array<SlabBounds, 2> slabs = {
        SlabBounds{j.normal, offset + reach.least, offset + reach.most},
        SlabBounds{axis, reach.along_min, reach.along_max}};
    tree_of(face).for_each_near(slabs, add_to);
  }

  [[nodiscard]] std::span<const std::uint32_t> triangles_of(std::uint32_t face) const {
    const std::uint32_t first = in_.triangle_begin[face];
    return in_.triangles.subspan(first, in_.triangle_begin[face + 1] - first);
  }

  const BoxTree& tree_of(std::uint32_t face) {
    const auto found = trees_.find(face);
    if (found != trees_.end()) return found->second;
    std::vector<Box> boxes;
    for (const std::uint32_t t : triangles_of(face)) {
      boxes.push_back({min(min(corner(t, 0), corner(t, 1)), corner(t, 2)),
                       max(max(corner(t, 0), corner(t, 1)), corner(t, 2)), t});
    }
    return trees_.try_emplace(face, std::move(boxes)).first->second;
  }

  // cosine: between the normals of the two faces.
  [[nodiscard]] Reach reach_of(const NetworkArc& source, Vec3d axis, double cosine) const {
    const double infinity = std::numeric_limits<double>::infinity();
    const double least = kDepthTolerance * solid_.size;
    if (solid_.exact) return {least, infinity, -infinity, infinity};
    const auto [along_min, along_max] = extent_along(source, axis);
    // Depth is r·(1 − cosine) on the edge. What of a face that isn't convex lies farther out is other edges'.
    const double most = in_.radius * (2 - cosine) + kPlaneTolerance * solid_.size;
    return {least, most, along_min, along_max};
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
  std::unordered_map<std::uint32_t, BoxTree> trees_;  // by face, as needed
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
  for (const BorderFace& border : network.border_faces) maker.add_border(border, first_arc);
  for (std::uint32_t f = 0; f < has_arc.size(); ++f) {
    if (!has_arc[f]) maker.add_whole(solid.first_face + f, network, first_arc);
  }
}

}  // namespace arris
