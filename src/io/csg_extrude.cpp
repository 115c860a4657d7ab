#include "io/csg_extrude.h"

#include <algorithm>
#include <cmath>

#include "io/csg_hull.h"
#include "io/csg_mesh.h"

namespace arris {
namespace {

class Extruder {
 public:
  Extruder(const LinearExtrusion& extrusion, const LeafMaker& make_leaf)
      : e_(extrusion), make_leaf_(make_leaf), height_(extrusion.z_high - extrusion.z_low) {}

  // level: how many shapes this one is taken from or intersected with; it reaches farther than they do.
  [[nodiscard]] SolidShape extrude(const FlatShape& shape, int level) const {
    if (shape.leaf) {
      return std::visit([&](const auto& leaf) { return extrude(leaf, level); }, *shape.leaf);
    }
    std::vector<SolidShape> parts;
    for (const FlatShape& child : shape.children) {
      const bool beyond = shape.operation != CsgOperation::unite && !parts.empty();
      parts.push_back(extrude(child, beyond ? level + 1 : level));
    }
    return combine(shape.operation, std::move(parts));
  }

 private:
  // The section at share t of the height; t may lie outside 0..1.
  [[nodiscard]] Vec2d scale_at(double t) const {
    return {1 + (e_.scale.x - 1) * t, 1 + (e_.scale.y - 1) * t};
  }
  [[nodiscard]] double z_at(double t) const { return e_.z_low + height_ * t; }

  // Shares of the height between which a shape of this level is swept. Sections keep a size above 0.
  struct Range {
    double low, high;
  };
  [[nodiscard]] Range range(int level) const {
    const double beyond = 0.5 * level / (level + 1);
    const double most = std::max(e_.scale.x, e_.scale.y), least = std::min(e_.scale.x, e_.scale.y);
    return {-beyond * (most > 1 ? std::min(1.0, 1 / (most - 1)) : 1),
            1 + beyond * (least < 1 ? std::min(1.0, least / (1 - least)) : 1)};
  }

  [[nodiscard]] SolidShape extrude(const FlatDisc& disc, int level) const {
    const std::optional<double> radius = round_radius(disc);
    const bool on_axis = std::hypot(disc.center.x, disc.center.y) <=
                         1e-9 * std::hypot(disc.u.x + disc.v.x, disc.u.y + disc.v.y);
    const bool keeps_shape = e_.scale.x == e_.scale.y && (e_.twist == 0 || (radius && on_axis));
    if (!keeps_shape) return extrude(facets_of(disc), level);
    const Range r = range(level);
    const double size = radius ? *radius : std::hypot(disc.u.x, disc.u.y);
    const CsgCone cone{z_at(r.low), z_at(r.high), size * scale_at(r.low).x,
                       size * scale_at(r.high).x};
    // The section's middle is s(z) times that of the disc.
    const double slope = (e_.scale.x - 1) / height_, at_zero = 1 - slope * e_.z_low;
    const Vec2d c = disc.center, u = disc.u * (1 / size), v = disc.v * (1 / size);
    Affine3d local{{{u.x, u.y, 0}, {v.x, v.y, 0}, {c.x * slope, c.y * slope, 1}},
                   {c.x * at_zero, c.y * at_zero, 0}};
    // A circle is the same however it is turned.
    if (radius) local.linear.x = {1, 0, 0}, local.linear.y = {0, 1, 0};
    return make_leaf_(cone, local);
  }

  [[nodiscard]] SolidShape extrude(const CsgRegion& region, int level) const {
    const Range r = range(level);
    if (e_.twist != 0) return make_leaf_(twisted(region, r));
    const Vec2d low = scale_at(r.low), high = scale_at(r.high);
    CsgPrism prism{region, z_at(r.low), z_at(r.high), {high.x / low.x, high.y / low.y}};
    for (Outline& outline : prism.region.outlines) {
      for (Vec2d& p : outline) p = {p.x * low.x, p.y * low.y};
    }
    const bool is_flat_sided = e_.scale.x == e_.scale.y && is_convex(region) &&
                               region.outlines[0].size() + 2 <= kMaxPolyhedronFaces;
    if (is_flat_sided) {
      if (const auto box = as_box(prism)) return make_leaf_(*box);
      if (auto hull = hull_polyhedron(ends_of(prism))) return make_leaf_(*std::move(hull));
    }
    return make_leaf_(std::move(prism));
  }

  static std::vector<Vec3d> ends_of(const CsgPrism& prism) {
    std::vector<Vec3d> points;
    for (const Vec2d& p : prism.region.outlines[0]) {
      points.emplace_back(p.x, p.y, prism.z_low);
      points.emplace_back(p.x * prism.scale_high.x, p.y * prism.scale_high.y, prism.z_high);
    }
    return points;
  }

  static std::optional<CsgBox> as_box(const CsgPrism& prism) {
    const Outline& o = prism.region.outlines[0];
    if (o.size() != 4 || prism.scale_high != Vec2d{1, 1}) return std::nullopt;
    const Bounds2d b = bounds_of(prism.region);
    for (const Vec2d& p : o) {
      if ((p.x != b.low.x && p.x != b.high.x) || (p.y != b.low.y && p.y != b.high.y))
        return std::nullopt;
    }
    if (signed_area(o) != (b.high.x - b.low.x) * (b.high.y - b.low.y)) return std::nullopt;
    return CsgBox{{b.low.x, b.low.y, prism.z_low}, {b.high.x, b.high.y, prism.z_high}};
  }

  // Sections at equal steps, and straight on beyond both ends.
  [[nodiscard]] CsgMesh twisted(const CsgRegion& region, Range r) const {
    std::vector<MeshRing> rings;
    const auto add = [&](double t, double z) {
      const double angle = -e_.twist * t;
      const Vec2d scale = scale_at(t);
      rings.push_back([=](Vec2d p) {
        return Vec3d(scale.x * (p.x * std::cos(angle) - p.y * std::sin(angle)),
                     scale.y * (p.x * std::sin(angle) + p.y * std::cos(angle)), z);
      });
    };
    if (r.low < 0) add(0, z_at(r.low));
    for (int i = 0; i <= e_.slices; ++i) add(double(i) / e_.slices, z_at(double(i) / e_.slices));
    if (r.high > 1) add(1, z_at(r.high));
    return sweep_mesh(region, rings, RingEnds::closed_by_faces);
  }

  const LinearExtrusion& e_;
  const LeafMaker& make_leaf_;
  double height_;
};

}  // namespace

SolidShape extrude(const FlatShape& shape, const LinearExtrusion& extrusion,
                   const LeafMaker& make_leaf) {
  return Extruder(extrusion, make_leaf).extrude(shape, 0);
}

}  // namespace arris
