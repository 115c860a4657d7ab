#include "csg/csg_outline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

#include "base/parallel_for.h"

namespace arris {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Around a circle or a ring.
constexpr int kSteps = 64;
constexpr int kWallSteps = 8;
constexpr double kInset = 1e-6;  // of a stretch: its very ends may be beyond the wall's
// Where a curve enters or leaves the solid's surface: halvings of a step.
constexpr int kHalvings = 10;
// Steps round a torus or a wall that are longer than the first part of it, or farther from the curve than the second,
// are halved, at most so often.
constexpr double kLongStep = 0.1;
constexpr double kOffCurve = 5e-4;
constexpr int kMostHalvings = 6;

// The part of a line in a box.
bool clip_line(const Box3d& box, Vec3d origin, Vec3d direction, double& t0, double& t1) {
  for (int k = 0; k < 3; ++k) {
    if (direction[k] == 0) {
      if (origin[k] < box.low[k] || origin[k] > box.high[k]) return false;
      continue;
    }
    const double u = (box.low[k] - origin[k]) / direction[k];
    const double v = (box.high[k] - origin[k]) / direction[k];
    t0 = std::max(t0, std::min(u, v));
    t1 = std::min(t1, std::max(u, v));
  }
  return t0 < t1;
}

class PatchOutline {
 public:
  PatchOutline(const CellProbe& probe, const SmoothPatch& patch, const SmoothSurface& surface,
               std::vector<OutlineSegment>& out)
      : probe_(probe), patch_(patch), surface_(surface), out_(out) {}

  void add_quadric(const CsgQuadric& quadric, const Affine3d& object_from_unit, Vec3d eye) {
    const Vec3d e = transform_point(quadric.unit_from_object, eye);
    switch (quadric.form) {
      case CsgQuadric::Form::ellipsoid:
        return add_circle(object_from_unit, e);
      case CsgQuadric::Form::cylinder: {
        // e·(cos, sin) = 1
        const double size = std::hypot(e.x, e.y);
        if (!(size > 1)) return;
        const double middle = std::atan2(e.y, e.x), half = std::acos(1 / size);
        for (const double angle : {middle - half, middle + half}) {
          const Vec3d p{std::cos(angle), std::sin(angle), 0};
          add_line(transform_point(object_from_unit, p), object_from_unit.linear.z);
        }
        return;
      }
      case CsgQuadric::Form::cone: {
        // e·(cos, sin) = e_z
        const double size = std::hypot(e.x, e.y);
        if (!(size > std::abs(e.z))) return;
        const double middle = std::atan2(e.y, e.x), half = std::acos(e.z / size);
        for (const double angle : {middle - half, middle + half}) {
          add_line(object_from_unit.translation,
                   transform_vector(object_from_unit, {std::cos(angle), std::sin(angle), 1}));
        }
      }
    }
  }

  void add_torus(const TorusLeaf& torus, Vec3d eye) {
    const Affine3d object_from_primitive = inverse(torus.primitive_from_object);
    const Vec3d e = transform_point(torus.primitive_from_object, eye);
    for (const double side : {-1.0, 1.0}) {
      const auto at = [&](double phi) -> std::optional<Vec3d> {
        const double c = std::cos(phi), s = std::sin(phi);
        const double a = torus.ring_radius - (e.x * c + e.y * s), b = -e.z;
        const double size = std::hypot(a, b);
        if (size < torus.tube_radius) return std::nullopt;
        const double psi = std::atan2(b, a) + side * std::acos(-torus.tube_radius / size);
        const double rho = torus.ring_radius + torus.tube_radius * std::cos(psi);
        return transform_point(object_from_primitive,
                               {rho * c, rho * s, torus.tube_radius * std::sin(psi)});
      };
      add_curve(at, 0, 2 * kPi, kSteps, Sides::any);
    }
  }

  // On each generating line the polar plane is met once.
  void add_wall(const PrismLeaf& prism, const RegionEdge& edge, Vec3d eye) {
    const Affine3d object_from_primitive = inverse(prism.primitive_from_object);
    const SpaceQuadratic polar = std::get<SpaceQuadratic>(surface_.form()).polar(eye);
    const auto at = [&](double u) -> std::optional<Vec3d> {
      const Vec2d p{edge.a.x + (edge.b.x - edge.a.x) * u, edge.a.y + (edge.b.y - edge.a.y) * u};
      const Vec2d s = prism.shape.scale_high;
      const Vec3d low = transform_point(object_from_primitive, {p.x, p.y, prism.shape.z_low});
      const Vec3d high =
          transform_point(object_from_primitive, {p.x * s.x, p.y * s.y, prism.shape.z_high});
      const double h0 = polar.value(low), h1 = polar.value(high);
      if ((h0 > 0) == (h1 > 0)) return std::nullopt;
      return low + (high - low) * (h0 / (h0 - h1));
    };
    // Lines meet the plane between where their lower and their upper ends do, which move along straight lines.
    std::array<double, 4> ends{0, 0, 0, 1};
    for (std::size_t high = 0; high < 2; ++high) {
      const auto value = [&](double u) {
        const Vec2d p{edge.a.x + (edge.b.x - edge.a.x) * u, edge.a.y + (edge.b.y - edge.a.y) * u};
        const Vec2d s = high == 1 ? prism.shape.scale_high : Vec2d{1, 1};
        const double z = high == 1 ? prism.shape.z_high : prism.shape.z_low;
        return polar.value(transform_point(object_from_primitive, {p.x * s.x, p.y * s.y, z}));
      };
      const double v0 = value(0), v1 = value(1);
      if ((v0 > 0) != (v1 > 0)) ends[high + 1] = v0 / (v0 - v1);
    }
    std::ranges::sort(ends);
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
      const double inset = (ends[i + 1] - ends[i]) * kInset;
      if (inset > 0) add_curve(at, ends[i] + inset, ends[i + 1] - inset, kWallSteps, Sides::any);
    }
  }

 private:
  // Whether the solid must lie on the surface's inner side.
  enum class Sides : std::uint8_t { inside, any };

  [[nodiscard]] bool is_boundary(std::uint32_t cell, Vec3d p, Sides sides) const {
    const Vec3d g = surface_.gradient(p);
    const double size = length(g);
    if (!(size > 0)) return false;
    const Vec3d step = g * (probe_.reach() / size);
    const bool in = probe_.contains(cell, p - step);
    if (sides == Sides::inside) return in && !probe_.contains(cell, p + step);
    return in != probe_.contains(cell, p + step);
  }
  [[nodiscard]] std::optional<std::uint32_t> boundary_cell(std::optional<Vec3d> p,
                                                           Sides sides) const {
    if (!p || !may_hold(patch_, *p)) return std::nullopt;
    const std::optional<std::uint32_t> cell = probe_.find_cell(*p, last_cell_);
    if (cell) last_cell_ = cell;
    return cell && is_boundary(*cell, *p, sides) ? cell : std::nullopt;
  }

  // Between its crossings with leaves all points of a line are alike.
  void add_line(Vec3d origin, Vec3d direction) {
    double t0 = -kInfinity, t1 = kInfinity;
    if (!clip_line(patch_.box, origin, direction, t0, t1)) return;
    for (const CsgHalfSpace& side : patch_.within) {
      const double height = side.d - dot(side.normal, origin);
      const double slope = dot(side.normal, direction);
      if (slope == 0 && height < 0) return;
      if (slope > 0) t1 = std::min(t1, height / slope);
      if (slope < 0) t0 = std::max(t0, height / slope);
    }
    if (!(t0 < t1)) return;
    origin += direction * t0;
    direction *= t1 - t0;
    thread_local LeafCrossings crossings;
    thread_local std::vector<double> cuts;
    probe_.tree().visit(
        [&](const Box3d& box) {
          return line_meets_box(box, {origin, direction}, 0, 1);
        },
        [&](std::uint32_t i) {
          const CsgCell& cell = probe_.cells().cells()[i];
          const CsgExpressionView view = probe_.cells().expression_of(cell);
          if (!std::ranges::binary_search(view.leaves, patch_.leaf)) return true;
          double from = 0, to = 1;
          if (!clip_line(intersection(cell.own, cell.bounds), origin, direction, from, to)) {
            return true;
          }
          cuts.assign({from, to});
          for (const std::uint32_t leaf : view.leaves) {
            if (leaf == patch_.leaf) continue;  // within it to its end
            for (const Crossing& c : crossings.find(
                     probe_.solid().leaf(leaf), probe_.solid().surfaces(), {origin, direction})) {
              if (c.t > from && c.t < to) cuts.push_back(c.t);
            }
          }
          std::ranges::sort(cuts);
          add_stretches(i, origin, direction, cuts);
          return true;
        });
  }
  void add_stretches(std::uint32_t cell, Vec3d origin, Vec3d direction,
                     const std::vector<double>& cuts) {
    double begin = cuts[0];
    bool is_in = false;
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
      const Vec3d middle = origin + direction * ((cuts[i] + cuts[i + 1]) / 2);
      // What is too short to be seen is like what is beside it.
      const bool in =
          cuts[i + 1] - cuts[i] < 1e-7 ? is_in : is_boundary(cell, middle, Sides::inside);
      if (in && !is_in) begin = cuts[i];
      if (!in && is_in)
        out_.push_back({origin + direction * begin, origin + direction * cuts[i], cell});
      is_in = in;
    }
    if (is_in) out_.push_back({origin + direction * begin, origin + direction * cuts.back(), cell});
  }

  // e·u = 1 on the unit sphere.
  void add_circle(const Affine3d& object_from_unit, Vec3d e) {
    const double distance = length(e);
    if (!(distance > 1)) return;
    const Vec3d z = e / distance;
    const Vec3d x = normalize(cross(z, std::abs(z.x) < 0.6 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0)));
    const Vec3d y = cross(z, x);
    const double height = 1 / distance, radius = std::sqrt(1 - height * height);
    const Vec3d center = transform_point(object_from_unit, z * height);
    const Vec3d u = transform_vector(object_from_unit, x * radius);
    const Vec3d v = transform_vector(object_from_unit, y * radius);
    add_curve(
        [&](double angle) {
          return std::optional(center + u * std::cos(angle) + v * std::sin(angle));
        },
        0, 2 * kPi, kSteps, Sides::inside);
  }

  // A curve p(t), which may not exist for some t, in steps; each is halved where it begins or ends to be seen.
  template <class At>
  void add_curve(const At& at, double from, double to, int steps, Sides sides) {
    Place last = place(at, from, sides);
    for (int i = 1; i <= steps; ++i) {
      const Place next = place(at, from + (to - from) * i / steps, sides);
      add_step(at, last, next, sides, kMostHalvings);
      last = next;
    }
  }
  struct Place {
    double t;
    std::optional<Vec3d> p;
    std::optional<std::uint32_t> cell;  // of the solid's surface
  };
  template <class At>
  [[nodiscard]] Place place(const At& at, double t, Sides sides) const {
    const std::optional<Vec3d> p = at(t);
    return {t, p, boundary_cell(p, sides)};
  }
  template <class At>
  [[nodiscard]] bool is_coarse(const At& at, const Place& a, const Place& b) const {
    if (!a.p || !b.p) return true;
    const double size = length(patch_.box.high - patch_.box.low);
    if (length(*a.p - *b.p) > kLongStep * size) return true;
    const std::optional<Vec3d> middle = at((a.t + b.t) / 2);
    return !middle || length(*middle - (*a.p + *b.p) * 0.5) > kOffCurve * size;
  }
  template <class At>
  void add_step(const At& at, Place a, Place b, Sides sides, int halvings) {
    if (!a.cell && !b.cell) return;
    if (sides == Sides::any && halvings > 0 && is_coarse(at, a, b)) {
      const Place middle = place(at, (a.t + b.t) / 2, sides);
      add_step(at, a, middle, sides, halvings - 1);
      add_step(at, middle, b, sides, halvings - 1);
      return;
    }
    const bool reversed = !a.cell;
    if (reversed) std::swap(a, b);
    if (!b.cell) {
      // From a, where it is seen, to the last place where it is.
      Place seen = a;
      for (int i = 0; i < kHalvings; ++i) {
        const Place middle = place(at, (seen.t + b.t) / 2, sides);
        (middle.cell ? seen : b) = middle;
      }
      b = seen;
    }
    if (a.t != b.t) out_.push_back({*a.p, *b.p, *a.cell});
  }

  const CellProbe& probe_;
  const SmoothPatch& patch_;
  const SmoothSurface& surface_;
  std::vector<OutlineSegment>& out_;
  mutable std::optional<std::uint32_t> last_cell_;  // where to look first
};

}  // namespace

CsgOutline::CsgOutline(std::shared_ptr<const CellProbe> probe,
                       std::shared_ptr<const SmoothPatches> patches)
    : probe_(std::move(probe)), patches_(std::move(patches)) {
  for (const SmoothPatches::Curved& c : patches_->curved()) {
    object_from_unit_.push_back(inverse(c.quadric.unit_from_object));
  }
}

std::size_t CsgOutline::patch_count() const {
  return patches_->curved().size() + patches_->tori().size() + patches_->walls().size();
}

std::vector<OutlineSegment> CsgOutline::find(Vec3d eye, int threads) const {
  constexpr std::size_t kBlock = 8;
  const std::size_t curved = patches_->curved().size(), tori = patches_->tori().size();
  const auto outline_of = [&](std::uint32_t patch, std::vector<OutlineSegment>& out) {
    const SmoothPatch& p = patches_->patches()[patch];
    return PatchOutline(*probe_, p, patches_->surface(p.surface), out);
  };
  const auto add = [&](std::size_t i, std::vector<OutlineSegment>& out) {
    if (i < curved) {
      const SmoothPatches::Curved& c = patches_->curved()[i];
      outline_of(c.patch, out).add_quadric(c.quadric, object_from_unit_[i], eye);
    } else if (i < curved + tori) {
      const std::uint32_t patch = patches_->tori()[i - curved];
      const std::uint32_t leaf = patches_->patches()[patch].leaf;
      outline_of(patch, out).add_torus(std::get<TorusLeaf>(probe_->solid().leaf(leaf).shape), eye);
    } else {
      const CurvedWall& wall = patches_->walls()[i - curved - tori];
      const auto& prism = std::get<PrismLeaf>(probe_->solid().leaf(wall.leaf).shape);
      outline_of(wall.patch, out).add_wall(prism, prism.region.edges()[wall.edge], eye);
    }
  };
  const std::size_t blocks = (patch_count() + kBlock - 1) / kBlock;
  std::vector<std::vector<OutlineSegment>> found(blocks);
  parallel_for(blocks, {.grain = 1, .threads = threads}, [&](std::size_t block) {
    const std::size_t first = block * kBlock, last = std::min(first + kBlock, patch_count());
    for (std::size_t i = first; i < last; ++i) add(i, found[block]);
  });
  std::vector<OutlineSegment> all;
  for (const std::vector<OutlineSegment>& f : found) all.insert(all.end(), f.begin(), f.end());
  return all;
}

}  // namespace arris
