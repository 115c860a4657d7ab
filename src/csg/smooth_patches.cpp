#include "csg/smooth_patches.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace arris {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Boxes of patches are wider by this part of the leaf's coordinates: faces move onto equal ones.
constexpr double kBoxSlack = 2 * kMergedDeviation;
// Pieces of a rounded leaf's surface go on beyond their neighbours by this part of the radius.
constexpr double kBesideRounding = 1e-4;

SpaceQuadratic plane_form(const CsgPlane& plane) {
  SpaceQuadratic form;
  form.b = plane.normal * 0.5;
  form.c = -plane.d;
  return form;
}

// u·(w u) - constant with u = L p + t.
SpaceQuadratic quadric_form(const CsgQuadric& quadric) {
  const Affine3d& m = quadric.unit_from_object;
  const Vec3d w = weights_of(quadric.form);
  const Mat3d weighted{w * m.linear.x, w * m.linear.y, w * m.linear.z};
  SpaceQuadratic form;
  form.q = transpose(m.linear) * weighted;
  form.b = transpose(m.linear) * (w * m.translation);
  form.c = dot(m.translation, w * m.translation) - constant_of(quadric.form);
  return form;
}

// n.x x sy + n.y y sx - k sx sy, where the scales grow with z.
SpaceQuadratic wall_form(const PrismLeaf& prism, const RegionEdge& edge) {
  const Vec2d n{edge.b.y - edge.a.y, edge.a.x - edge.b.x}, growth = prism.growth();
  const double k = n.x * edge.a.x + n.y * edge.a.y, z0 = prism.shape.z_low;
  const Vec2d s{1 - growth.x * z0, 1 - growth.y * z0};  // at z = 0
  SpaceQuadratic own;
  own.q = {{0, 0, n.x * growth.y / 2},
           {0, 0, n.y * growth.x / 2},
           {n.x * growth.y / 2, n.y * growth.x / 2, -k * growth.x * growth.y}};
  own.b = {n.x * s.y / 2, n.y * s.x / 2, -k * (s.x * growth.y + s.y * growth.x) / 2};
  own.c = -k * s.x * s.y;
  // In the tree's space.
  const Affine3d& m = prism.primitive_from_object;
  const Mat3d turned = transpose(m.linear);
  SpaceQuadratic form;
  form.q = turned * (own.q * m.linear);
  form.b = turned * (own.q * m.translation + own.b);
  form.c = own.value(m.translation);
  return form;
}

Box3d box_of_points(std::initializer_list<Vec3d> points) {
  Box3d box{Vec3d(kInfinity), Vec3d(-kInfinity)};
  for (const Vec3d& p : points) box = {min(box.low, p), max(box.high, p)};
  return box;
}

// Of an axis-parallel box of another frame.
Box3d map_box(const Affine3d& m, const Box3d& box) {
  Box3d out{Vec3d(kInfinity), Vec3d(-kInfinity)};
  for (const Vec3d& p : corners_of(box)) {
    const Vec3d q = transform_point(m, p);
    out = {min(out.low, q), max(out.high, q)};
  }
  return out;
}

// normal·x ≤ d in another frame.
CsgHalfSpace map_to(const Affine3d& other_from_own, const CsgHalfSpace& own) {
  const Mat3d turned = transpose(other_from_own.linear);
  return {turned * own.normal, own.d - dot(own.normal, other_from_own.translation)};
}

// Where an edge's cylinder is the rounded leaf's surface: no vertex of the core is farther out. The two that decide are
// seen along the edge at the widest angle.
std::vector<CsgHalfSpace> sides_of_edge(const RoundedLeaf& rounded, Vec3d a, Vec3d b) {
  const Vec3d along = normalize(b - a);
  std::vector<Vec3d> inward;
  Vec3d middle;
  for (const Vec3d& v : rounded.vertices) {
    const Vec3d d = v - a, across = d - along * dot(d, along);
    if (!(length(across) > 1e-9 * length(d))) continue;
    inward.push_back(normalize(across));
    middle += inward.back();
  }
  std::vector<CsgHalfSpace> sides{{along, dot(along, b)}, {-along, -dot(along, a)}};
  for (const double sign : {-1.0, 1.0}) {
    const Vec3d turned = cross(along, middle) * sign;
    const auto widest = std::ranges::min_element(
        inward, {}, [&](Vec3d d) { return dot(d, turned) >= 0 ? dot(d, middle) : kInfinity; });
    if (widest != inward.end()) sides.push_back({*widest, dot(*widest, a)});
  }
  return sides;
}

std::vector<CsgHalfSpace> sides_of_vertex(const RoundedLeaf& rounded, Vec3d v) {
  std::vector<CsgHalfSpace> sides;
  for (const auto& [a, b] : rounded.edges) {
    if (a != v && b != v) continue;
    const Vec3d away = normalize(a == v ? b - a : a - b);
    sides.push_back({away, dot(away, v)});
  }
  return sides;
}

}  // namespace

double SmoothSurface::value(Vec3d p) const {
  if (const auto* form = std::get_if<SpaceQuadratic>(&form_)) return form->value(p);
  const auto& torus = std::get<TorusLeaf>(form_);
  const Vec3d q = transform_point(torus.primitive_from_object, p);
  const double off = std::sqrt(q.x * q.x + q.y * q.y) - torus.ring_radius;
  return std::sqrt(off * off + q.z * q.z) - torus.tube_radius;
}

Vec3d SmoothSurface::gradient(Vec3d p) const {
  if (const auto* form = std::get_if<SpaceQuadratic>(&form_)) return form->gradient(p);
  const auto& torus = std::get<TorusLeaf>(form_);
  const Vec3d q = transform_point(torus.primitive_from_object, p);
  const double rho = std::sqrt(q.x * q.x + q.y * q.y), from_ring = rho - torus.ring_radius;
  const double off = std::sqrt(from_ring * from_ring + q.z * q.z);
  if (!(rho > 0 && off > 0)) return {};
  const double across = from_ring / (rho * off);
  return transpose(torus.primitive_from_object.linear) *
         Vec3d(q.x * across, q.y * across, q.z / off);
}

bool SmoothSurface::misses(const Box3d& box) const {
  const Vec3d middle = (box.low + box.high) * 0.5, h = (box.high - box.low) * 0.5;
  if (const auto* form = std::get_if<SpaceQuadratic>(&form_)) {
    const auto reach = [&](Vec3d v) {
      return std::abs(v.x) * h.x + std::abs(v.y) * h.y + std::abs(v.z) * h.z;
    };
    const double bend = reach(form->q.x) * h.x + reach(form->q.y) * h.y + reach(form->q.z) * h.z;
    return std::abs(form->value(middle)) > reach(form->gradient(middle)) + bend;
  }
  // Distances change by no more than the way.
  const Mat3d& m = std::get<TorusLeaf>(form_).primitive_from_object.linear;
  return std::abs(value(middle)) > length(m.x) * h.x + length(m.y) * h.y + length(m.z) * h.z;
}

void SmoothSurface::collect_crossings(Vec3d a, Vec3d b, std::vector<double>& out) const {
  const Vec3d d = b - a;
  const auto add = [&](double t) {
    if (t > 0 && t < 1) out.push_back(t);
  };
  if (const auto* form = std::get_if<SpaceQuadratic>(&form_)) {
    const double c0 = form->value(a), c1 = dot(form->gradient(a), d), c2 = dot(d, form->q * d);
    const double discriminant = c1 * c1 - 4 * c0 * c2;
    if (!(discriminant >= 0)) return;
    const double q = -(c1 + std::copysign(std::sqrt(discriminant), c1)) / 2;
    add(c0 / q);
    add(q / c2);
    return;
  }
  constexpr int kSteps = 16;
  double before = value(a);
  for (int i = 1; i <= kSteps; ++i) {
    const double after = value(a + d * (double(i) / kSteps));
    if ((before > 0) != (after > 0)) add((i - 1 + before / (before - after)) / kSteps);
    before = after;
  }
}

bool SmoothSurface::is_tame(const Box3d& box) const {
  const auto* torus = std::get_if<TorusLeaf>(&form_);
  if (torus == nullptr) return true;
  const Mat3d& m = torus->primitive_from_object.linear;
  const Vec3d h = (box.high - box.low) * 0.5;
  return length(m.x) * h.x + length(m.y) * h.y + length(m.z) * h.z < torus->tube_radius / 2;
}

bool may_hold(const SmoothPatch& patch, Vec3d p) {
  return !intersection(patch.box, {p, p}).is_empty() &&
         std::ranges::all_of(
             patch.within, [&](const CsgHalfSpace& side) { return dot(side.normal, p) <= side.d; });
}

bool may_hold(const SmoothPatch& patch, const Box3d& box) {
  if (intersection(patch.box, box).is_empty()) return false;
  const Vec3d middle = (box.low + box.high) * 0.5, h = (box.high - box.low) * 0.5;
  return std::ranges::all_of(patch.within, [&](const CsgHalfSpace& side) {
    const Vec3d n = side.normal;
    return dot(n, middle) <=
           side.d + std::abs(n.x) * h.x + std::abs(n.y) * h.y + std::abs(n.z) * h.z;
  });
}

struct SmoothPatches::Adder {
  SmoothPatches& out;
  const CsgSolid& solid;
  std::uint32_t leaf;

  [[nodiscard]] std::uint32_t quadric_surface(std::uint32_t quadric) const {
    return std::uint32_t(solid.surfaces().planes().size()) + quadric;
  }
  [[nodiscard]] const Box3d& bounds() const { return solid.leaf(leaf).bounds; }

  std::uint32_t add_patch(std::uint32_t surface, const Box3d& box, std::uint32_t face = 0) const {
    const double size = max_component(max(max(box.high, -box.low), Vec3d(0)));
    const Vec3d slack(std::isfinite(size) ? kBoxSlack * size : 0);
    out.patches_.push_back(
        {surface,
         leaf,
         face,
         intersection(intersection({box.low - slack, box.high + slack}, bounds()), solid.bounds()),
         {}});
    return std::uint32_t(out.patches_.size() - 1);
  }
  std::uint32_t add_surface(SmoothSurface::Form form) const {
    out.surfaces_.emplace_back(std::move(form));
    return std::uint32_t(out.surfaces_.size() - 1);
  }
  void add_quadric(std::uint32_t quadric, const Box3d& box, std::vector<CsgHalfSpace> within,
                   std::uint32_t face = 0) const {
    out.curved_.push_back(
        {solid.surfaces().quadrics()[quadric], add_patch(quadric_surface(quadric), box, face)});
    out.patches_.back().within = std::move(within);
  }
  void add_rounding(const CsgQuadric& quadric, const Box3d& box,
                    const std::vector<CsgHalfSpace>& within) const {
    out.curved_.push_back({quadric, add_patch(add_surface(quadric_form(quadric)), box)});
    const auto& rounded = std::get<RoundedLeaf>(solid.leaf(leaf).shape);
    for (CsgHalfSpace side : within) {
      side.d += kBesideRounding * rounded.radius;
      out.patches_.back().within.push_back(map_to(rounded.primitive_from_object, side));
    }
  }

  void operator()(const ConvexLeaf& convex) const {
    for (const PlaneRef& face : convex.planes) add_patch(face.plane, bounds());
    if (!convex.quadric) return;
    std::vector<CsgHalfSpace> within;
    for (const PlaneRef& face : convex.planes) {
      const double d = solid.surfaces().planes()[face.plane].d;
      within.push_back({solid.surfaces().normal_of(face), face.flipped ? -d : d});
    }
    add_quadric(*convex.quadric, bounds(), std::move(within));
  }
  void operator()(const TorusLeaf& torus) const {
    out.tori_.push_back(add_patch(add_surface(torus), bounds()));
  }
  void operator()(const PrismLeaf& prism) const {
    add_patch(prism.low.plane, bounds());
    add_patch(prism.high.plane, bounds(), 1);
    const Affine3d object_from_primitive = inverse(prism.primitive_from_object);
    const auto at = [&](Vec2d p, bool high) {
      const Vec2d s = high ? prism.shape.scale_high : Vec2d{1, 1};
      return transform_point(object_from_primitive,
                             {p.x * s.x, p.y * s.y, high ? prism.shape.z_high : prism.shape.z_low});
    };
    for (std::uint32_t i = 0; i < prism.region.edges().size(); ++i) {
      const RegionEdge& e = prism.region.edges()[i];
      const Box3d box =
          box_of_points({at(e.a, false), at(e.b, false), at(e.a, true), at(e.b, true)});
      if (prism.walls.empty()) {
        out.walls_.push_back({add_patch(add_surface(wall_form(prism, e)), box, i + 2), leaf, i});
      } else {
        add_patch(prism.walls[i].plane, box, i + 2);
      }
    }
  }
  void operator()(const RevolutionLeaf& revolution) const {
    const Affine3d object_from_primitive = inverse(revolution.primitive_from_object);
    for (std::uint32_t i = 0; i < revolution.swept.size(); ++i) {
      const RegionEdge& e = revolution.region.edges()[i];
      const double r = std::max(std::abs(e.a.x), std::abs(e.b.x));
      const double low = std::min(e.a.y, e.b.y), high = std::max(e.a.y, e.b.y);
      const Box3d box = map_box(object_from_primitive, {{-r, -r, low}, {r, r, high}});
      if (const auto* ring = std::get_if<RevolutionLeaf::Ring>(&revolution.swept[i])) {
        add_patch(ring->plane.plane, box, i);
      } else if (const auto* band = std::get_if<RevolutionLeaf::Band>(&revolution.swept[i])) {
        add_quadric(band->quadric, box,
                    {map_to(revolution.primitive_from_object, {{0, 0, 1}, high}),
                     map_to(revolution.primitive_from_object, {{0, 0, -1}, -low})},
                    i);
      }
    }
  }
  void operator()(const MeshLeaf& mesh) const {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> first_side;
    const std::vector<Vec3d>& v = mesh.mesh.vertices();
    for (std::uint32_t i = 0; i < mesh.mesh.triangles().size(); ++i) {
      const Triangle& t = mesh.mesh.triangles()[i];
      add_patch(mesh.planes[i].plane, box_of_points({v[t[0]], v[t[1]], v[t[2]]}));
      for (std::size_t k = 0; k < 3; ++k) {
        const auto key = std::minmax(t[k], t[(k + 1) % 3]);
        const auto [at, is_new] = first_side.insert({key, i});
        if (is_new) continue;
        const std::uint32_t one = mesh.planes[at->second].plane, two = mesh.planes[i].plane;
        if (one != two) out.mesh_edges_.push_back({leaf, one, two, v[key.first], v[key.second]});
      }
    }
  }
  void operator()(const RoundedLeaf& rounded) const {
    const Affine3d object_from_primitive = inverse(rounded.primitive_from_object);
    const Vec3d r(rounded.radius);
    for (const RoundedLeaf::Face& face : rounded.faces) add_patch(face.moved.plane, bounds());
    if (!(rounded.radius > 0)) return;
    for (const auto& [a, b] : rounded.edges) {
      const Vec3d z = normalize(b - a);
      const Vec3d x = normalize(cross(z, std::abs(z.x) < 0.6 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0)));
      const Affine3d own{{x * rounded.radius, cross(z, x) * rounded.radius, b - a}, a};
      add_rounding({CsgQuadric::Form::cylinder, inverse(object_from_primitive * own)},
                   map_box(object_from_primitive, {min(a, b) - r, max(a, b) + r}),
                   sides_of_edge(rounded, a, b));
    }
    for (const Vec3d& v : rounded.vertices) {
      const Affine3d own{{{r.x, 0, 0}, {0, r.x, 0}, {0, 0, r.x}}, v};
      add_rounding({CsgQuadric::Form::ellipsoid, inverse(object_from_primitive * own)},
                   map_box(object_from_primitive, {v - r, v + r}), sides_of_vertex(rounded, v));
    }
  }
};

SmoothPatches::SmoothPatches(const CsgSolid& solid) {
  for (const CsgPlane& plane : solid.surfaces().planes()) {
    surfaces_.emplace_back(plane_form(plane));
  }
  for (const CsgQuadric& quadric : solid.surfaces().quadrics()) {
    surfaces_.emplace_back(quadric_form(quadric));
  }
  for (const std::uint32_t leaf : solid.root().leaves()) {
    std::visit(Adder{*this, solid, leaf}, solid.leaf(leaf).shape);
  }
}

}  // namespace arris
