#include <algorithm>
#include <cmath>

#include "io/csg_extrude.h"
#include "io/csg_mesh.h"

namespace arris {
namespace {

class Turner {
 public:
  Turner(const RotaryExtrusion& extrusion, const LeafMaker& make_leaf)
      : e_(extrusion), make_leaf_(make_leaf) {}

  [[nodiscard]] SolidShape turn(const FlatShape& shape) const {
    if (shape.leaf) return std::visit([&](const auto& leaf) { return turn(leaf); }, *shape.leaf);
    std::vector<SolidShape> parts;
    for (const FlatShape& child : shape.children) parts.push_back(turn(child));
    return combine(shape.operation, std::move(parts));
  }

  // What lies between the start and the end of the angle.
  [[nodiscard]] SolidShape wedge() const {
    const double first = std::min(e_.start, e_.start + e_.angle), size = std::abs(e_.angle);
    const auto side = [&](double angle, double sign) {
      return make_leaf_(CsgHalfSpace{{sign * std::sin(angle), -sign * std::cos(angle), 0}, 0});
    };
    std::vector<SolidShape> sides{side(first, 1), side(first + size, -1)};
    return combine(size <= kPi ? CsgOperation::intersect : CsgOperation::unite, std::move(sides));
  }

  [[nodiscard]] bool is_full() const { return std::abs(e_.angle) >= 2 * kPi; }

 private:
  [[nodiscard]] SolidShape turn(const FlatDisc& disc) const {
    if (e_.steps > 0) return turn(facets_of(disc));
    const std::optional<double> radius = round_radius(disc);
    const Bounds2d bounds = bounds_of(disc);
    const double width = bounds.high.x - bounds.low.x;
    const bool on_axis = std::abs(disc.center.x) <= 1e-9 * width;
    const Affine3d up{Mat3d{}, {0, 0, disc.center.y}};
    if (radius && on_axis) return make_leaf_(CsgSphere{*radius}, up);
    if (radius && disc.center.x > 0) return make_leaf_(CsgTorus{disc.center.x, *radius}, up);
    const double slant = std::abs(disc.u.x * disc.u.y + disc.v.x * disc.v.y);
    const double height = bounds.high.y - bounds.low.y;
    if (on_axis && slant <= 1e-9 * width * height) {
      const Mat3d stretched{{width / 2, 0, 0}, {0, width / 2, 0}, {0, 0, height / 2}};
      return make_leaf_(CsgSphere{1}, {stretched, up.translation});
    }
    return turn(facets_of(disc));
  }

  [[nodiscard]] SolidShape turn(const CsgRegion& region) const {
    CsgRegion right = clip_to_right(region);
    if (right.outlines.empty()) return {};
    if (e_.steps > 0) return make_leaf_(faceted(right));
    if (const auto cylinder = as_cylinder(right)) return make_leaf_(*cylinder);
    return make_leaf_(CsgRevolution{std::move(right)});
  }

  // A rectangle beside the axis.
  static std::optional<CsgCone> as_cylinder(const CsgRegion& region) {
    const Outline& o = region.outlines[0];
    const Bounds2d b = bounds_of(region);
    if (region.outlines.size() != 1 || o.size() != 4 || b.low.x != 0) return std::nullopt;
    if (std::abs(signed_area(o)) != b.high.x * (b.high.y - b.low.y)) return std::nullopt;
    return CsgCone{b.low.y, b.high.y, b.high.x, b.high.x};
  }

  // A full turn begins at the -x axis. Less of it goes on beyond its ends, which the wedge makes.
  [[nodiscard]] CsgMesh faceted(const CsgRegion& region) const {
    std::vector<MeshRing> rings;
    const auto add = [&](double angle) {
      rings.push_back(
          [=](Vec2d p) { return Vec3d(p.x * std::cos(angle), p.x * std::sin(angle), p.y); });
    };
    const double first = std::min(e_.start, e_.start + e_.angle), size = std::abs(e_.angle);
    const double step = size / e_.steps;
    // Rings go clockwise: outlines then have the inside where sweep_mesh() wants it.
    const double beyond = std::min(step, (2 * kPi - size) / 3);
    if (!is_full()) add(first + size + beyond);
    for (int i = e_.steps; i >= (is_full() ? 1 : 0); --i) add(first + step * i);
    if (!is_full()) add(first - beyond);
    return sweep_mesh(region, rings, is_full() ? RingEnds::joined : RingEnds::closed_by_faces);
  }

  const RotaryExtrusion& e_;
  const LeafMaker& make_leaf_;
};

}  // namespace

SolidShape revolve(const FlatShape& shape, const RotaryExtrusion& extrusion,
                   const LeafMaker& make_leaf) {
  const Turner turner(extrusion, make_leaf);
  SolidShape solid = turner.turn(shape);
  if (turner.is_full() || solid.is_empty()) return solid;
  std::vector<SolidShape> parts;
  parts.push_back(std::move(solid));
  parts.push_back(turner.wedge());
  return combine(CsgOperation::intersect, std::move(parts));
}

}  // namespace arris
