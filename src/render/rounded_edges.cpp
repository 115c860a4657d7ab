#include "render/rounded_edges.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>

#include "rounding/crease_outline.h"

namespace arris {
namespace {

// A circle is drawn as chords of at most this angle: off by r/1000.
constexpr double kStep = radians(5);
// Rays almost along an edge would stay in its void for ever: they are followed for as many radii.
constexpr double kFarthest = 100;
// Of n·n_face: rounding of float positions.
constexpr double kSlack = 1e-5;
// Of the turn between two faces: with less, they look smooth however narrow their rounding is.
const double kSmooth = std::cos(radians(8));

struct Angles {
  double from, to;
};

class Outline {
 public:
  Outline(const Rounding::Data& data, const RoundedView& view, const Affine3d& world,
          double world_radius, Vec3d eye, VoidDepths depths, std::vector<RoundedTangent>& out)
      : data_(data),
        view_(view),
        world_(world),
        world_radius_(world_radius),
        eye_(eye),
        depths_(depths),
        out_(out) {}

  void add_solid(const Solid& solid) {
    if (solid.hollow) return;  // drawn with the shell around it
    center_ = solid.center;
    const Vec3d eye = eye_ - center_;
    if (solid.creased != kNone) {
      // None if even at its nearest it is too far away.
      const double reach = solid.size * (world_radius_ / data_.radius);
      const Vec3d nearest = transform_point(world_, center_) - view_.forward * reach;
      if (!is_seen_rounded(view_, world_radius_, nearest)) return;
      return add_creased(*data_.creased[solid.creased], eye);
    }
    arc_is_crossed_.assign(solid.arc_count, false);
    for (std::uint32_t i = 0; i < solid.arc_count; ++i) {
      const Arc& arc = data_.arcs[solid.first_arc + i];
      arc_is_crossed_[i] = add_cylinder(arc, eye);
      if (view_.crease_at_depth > 0 && !arc.is_stub()) add_crease(arc, eye);
    }
    for (std::uint32_t i = 0; i < solid.node_count; ++i) {
      const Node& node = data_.nodes[solid.first_node + i];
      if (node.kind == Node::Kind::sphere) add_sphere(solid, node, eye);
    }
  }

 private:
  [[nodiscard]] Vec3d face_normal(std::uint32_t face) const {
    return Vec3d(data_.faces[face].normal);
  }

  void add_creased(const CreasedSolid& solid, Vec3d eye) {
    for (const CreaseLine& line : find_crease_outline(solid, eye, depths_)) {
      emit(line.a, line.b, line.void_depth);
    }
    if (depths_ == VoidDepths::found) return;  // for shadows, to which only outlines matter
    for (const CreaseGroove& groove : solid.shape().grooves) {
      const Vec3d to_eye = eye - groove.p0;
      if (dot(groove.normal0, to_eye) > 0 || dot(groove.normal1, to_eye) > 0) {
        emit(groove.p0, groove.p1, 0);
      }
    }
    if (view_.crease_at_depth <= 0) return;
    for (const CreaseLine& line : find_crease_middles(solid, eye)) {
      emit_crease(line.a, line.b, line.across);
    }
  }

  // na, nb: the normals there.
  void emit(Vec3d a, Vec3d b, Vec3d na, Vec3d nb) {
    emit(a, b, std::max(void_depth(a, na), void_depth(b, nb)));
  }
  void emit(Vec3d a, Vec3d b, double depth) {
    const Vec3d p = transform_point(world_, a + center_), q = transform_point(world_, b + center_);
    if (!is_seen_rounded(view_, world_radius_, (p + q) * 0.5)) return;
    out_.push_back({{Vec3f(p), Vec3f(q)}, depth * (world_radius_ / data_.radius)});
  }

  // On both sides of a point where rays from the eye touch.
  [[nodiscard]] double void_depth(Vec3d p, Vec3d n) const {
    const Vec3d d = normalize(p - (eye_ - center_));
    double before = kFarthest, after = kFarthest, least_cosine = 1;
    for (const Vec3d& m : normals_) {
      const double along = dot(m, d), way = (1 - dot(m, n)) / std::abs(along);
      if (along != 0) (along > 0 ? after : before) = std::min(along > 0 ? after : before, way);
      for (const Vec3d& other : normals_) least_cosine = std::min(least_cosine, dot(m, other));
    }
    const double tangent = std::sqrt((1 - least_cosine) / std::max(1 + least_cosine, 1e-9));
    double across = 1;
    for (const Vec3d& axis : axes_) across = std::min(across, length(d - axis * dot(d, axis)));
    const double neighbor = 2 * tangent / std::max(across, 1 / kFarthest);
    return data_.radius * std::min(std::max(before, after) + neighbor, kFarthest);
  }

  // Where along the axis the cylinder ends for a line at an offset from it: at a mitre in its slanted plane.
  [[nodiscard]] double end_of(const Arc& arc, bool last, Vec3d offset) const {
    const double plain = last ? double(arc.line.length) : 0.0;
    const Node& node = data_.nodes[last ? arc.node1 : arc.node0];
    if (node.kind != Node::Kind::mitre) return plain;
    const Vec3d axis(arc.line.axis), away = last ? -axis : axis;
    const std::uint32_t self = std::uint32_t(&arc - data_.arcs.data());
    for (std::uint32_t i = 0; i < node.link_count; ++i) {
      const std::uint32_t other = data_.links[node.first_link + i];
      if (other == self || other == kNone) continue;
      const Arc& arc2 = data_.arcs[other];
      const std::uint32_t here = std::uint32_t(&node - data_.nodes.data());
      const Vec3d away2 = arc2.node0 == here ? Vec3d(arc2.line.axis) : -Vec3d(arc2.line.axis);
      const Vec3d normal = away - away2;
      const double along = dot(normal, axis);
      if (std::abs(along) < 1e-9) return plain;
      return plain - dot(normal, offset) / along;
    }
    return plain;
  }

  // The middle of a cylinder between two faces that are seen, as far as the middles of the corners that it ends at.
  void add_crease(const Arc& arc, Vec3d eye) {
    const Vec3d axis(arc.line.axis), p0(arc.line.p0), middle = p0 + axis * (0.5 * arc.line.length);
    const Vec3d na = face_normal(arc.face_a), nb = face_normal(arc.face_b);
    if (dot(na, nb) > kSmooth || !is_seen(middle, na, eye) || !is_seen(middle, nb, eye)) return;
    const Vec3d offset = normalize(na + nb) * data_.radius;
    const double t0 = end_of(arc, false, offset), t1 = end_of(arc, true, offset);
    if (t0 >= t1) return;
    const Vec3d a = p0 + axis * t0 + offset, b = p0 + axis * t1 + offset;
    emit_crease(a, b, na - nb);
    for (const bool last : {false, true}) {
      const Node& node = data_.nodes[last ? arc.node1 : arc.node0];
      if (node.kind != Node::Kind::sphere) continue;
      const Vec3d to = middle_of(node);
      if (is_seen(Vec3d(node.position), to, eye)) {
        emit_crease(last ? b : a, Vec3d(node.position) + to * data_.radius, na - nb);
      }
    }
  }

  // across: between the normals on its two sides.
  void emit_crease(Vec3d a, Vec3d b, Vec3d across) {
    const Vec3d p = transform_point(world_, a + center_), q = transform_point(world_, b + center_);
    const Vec3d middle = (p + q) * 0.5;
    if (!is_seen_rounded(view_, world_radius_, middle)) return;
    const Vec3d side = cross(q - p, middle - view_.eye);
    const double size = length(side);
    const double depth = dot(middle - view_.eye, view_.forward);
    const double width = std::abs(dot(transform_vector(world_, across), side)) * data_.radius;
    if (size > 0 && width < view_.crease_at_depth * depth * size) {
      out_.push_back({{Vec3f(p), Vec3f(q)}});
    }
  }

  [[nodiscard]] bool is_seen(Vec3d axis_point, Vec3d n, Vec3d eye) const {
    return dot(n, eye - axis_point) > data_.radius;
  }

  // The mean of the normals of the faces that meet there.
  [[nodiscard]] Vec3d middle_of(const Node& node) const {
    Vec3d sum;
    for (std::uint32_t i = 0; i < node.link_count; ++i) {
      const Arc& arc = data_.arcs[data_.links[node.first_link + i]];
      sum += face_normal(arc.face_a) + face_normal(arc.face_b);
    }
    return normalize(sum);
  }

  // True if an outline crosses the cylinder.
  bool add_cylinder(const Arc& arc, Vec3d eye) {
    if (arc.is_stub()) return false;
    const Vec3d axis(arc.line.axis), p0(arc.line.p0);
    const Vec3d to_eye = eye - p0;
    const Vec3d across = to_eye - axis * dot(to_eye, axis);
    const double distance = length(across);
    if (distance <= data_.radius) return false;
    // n is across/distance turned about the axis by ± the angle whose cosine is r / distance.
    const double cosine = data_.radius / distance, sine = std::sqrt(1 - cosine * cosine);
    const Vec3d x = across / distance, y = cross(axis, x);
    const Vec3d na = face_normal(arc.face_a), nb = face_normal(arc.face_b);
    normals_ = {na, nb};
    axes_ = {axis};
    bool crossed = false;
    for (const double side : {-1.0, 1.0}) {
      const Vec3d n = x * cosine + y * (side * sine);
      // Between the two faces' normals, which turn about the axis from a to b.
      if (dot(cross(na, n), axis) < -kSlack || dot(cross(n, nb), axis) < -kSlack) continue;
      if (dot(n, na + nb) < 0) continue;
      crossed = true;
      const Vec3d offset = n * data_.radius;
      const double t0 = end_of(arc, false, offset), t1 = end_of(arc, true, offset);
      if (t0 < t1) emit(p0 + axis * t0 + offset, p0 + axis * t1 + offset, n, n);
    }
    return crossed;
  }

  void add_sphere(const Solid& solid, const Node& node, Vec3d eye) {
    const std::span<const std::uint32_t> links(data_.links.data() + node.first_link,
                                               node.link_count);
    // The circle enters and leaves the sphere's part of the surface where a cylinder's line does.
    const bool any = std::any_of(links.begin(), links.end(), [&](std::uint32_t arc) {
      return arc_is_crossed_[arc - solid.first_arc] || data_.arcs[arc].is_stub();
    });
    const Vec3d center(node.position), to_eye = eye - center;
    const double distance = length(to_eye);
    if (!any || distance <= data_.radius) return;
    normals_.clear();
    axes_.clear();
    for (const std::uint32_t arc : links) {
      normals_.push_back(face_normal(data_.arcs[arc].face_a));
      normals_.push_back(face_normal(data_.arcs[arc].face_b));
      axes_.push_back(Vec3d(data_.arcs[arc].line.axis));
    }
    const double cosine = data_.radius / distance, sine = std::sqrt(1 - cosine * cosine);
    const Vec3d z = to_eye / distance;
    const Vec3d x = normalize(std::abs(z.x) < 0.6 ? cross(z, {1, 0, 0}) : cross(z, {0, 1, 0}));
    const Vec3d y = cross(z, x);
    const auto normal_at = [&](double angle) {
      return z * cosine + x * (sine * std::cos(angle)) + y * (sine * std::sin(angle));
    };
    for (const Angles& part : parts_inside(node, links, z, x, y, cosine, sine)) {
      const int steps = std::max(1, int(std::ceil((part.to - part.from) / kStep)));
      Vec3d from = normal_at(part.from);
      for (int i = 1; i <= steps; ++i) {
        const Vec3d to = normal_at(part.from + (part.to - part.from) * i / steps);
        emit(center + from * data_.radius, center + to * data_.radius, from, to);
        from = to;
      }
    }
  }

  // The angles at which the circle lies beyond the ends of all the node's arcs: n·u ≤ 0 for their directions u.
  [[nodiscard]] std::vector<Angles> parts_inside(const Node& node,
                                                 std::span<const std::uint32_t> links, Vec3d z,
                                                 Vec3d x, Vec3d y, double cosine,
                                                 double sine) const {
    const std::uint32_t here = std::uint32_t(&node - data_.nodes.data());
    std::vector<Vec3d> directions;
    std::vector<double> cuts;
    for (const std::uint32_t link : links) {
      const Arc& arc = data_.arcs[link];
      const Vec3d u = arc.node0 == here ? Vec3d(arc.line.axis) : -Vec3d(arc.line.axis);
      directions.push_back(u);
      // cosine z·u + sine (cos x·u + sin y·u) = 0
      const double a = sine * dot(x, u), b = sine * dot(y, u), c = -cosine * dot(z, u);
      const double size = std::hypot(a, b);
      if (size <= std::abs(c)) continue;
      const double middle = std::atan2(b, a), half = std::acos(c / size);
      for (const double angle : {middle - half, middle + half}) {
        cuts.push_back(angle < 0 ? angle + 2 * kPi : angle >= 2 * kPi ? angle - 2 * kPi : angle);
      }
    }
    if (cuts.empty()) cuts.push_back(0);
    std::sort(cuts.begin(), cuts.end());
    std::vector<Angles> parts;
    for (std::size_t i = 0; i < cuts.size(); ++i) {
      const Angles part{cuts[i], i + 1 < cuts.size() ? cuts[i + 1] : cuts[0] + 2 * kPi};
      if (part.to - part.from < 1e-9) continue;
      const double middle = (part.from + part.to) / 2;
      const Vec3d n = z * cosine + x * (sine * std::cos(middle)) + y * (sine * std::sin(middle));
      const bool inside = std::all_of(directions.begin(), directions.end(),
                                      [&](Vec3d u) { return dot(n, u) <= 0; });
      if (inside) parts.push_back(part);
    }
    return parts;
  }

  const Rounding::Data& data_;
  const RoundedView& view_;
  Affine3d world_;  // from the rounding's space
  double world_radius_;
  Vec3d eye_;  // in the rounding's space
  VoidDepths depths_;
  std::vector<RoundedTangent>& out_;
  Vec3d center_;
  // Of the faces beside what is added, and of the edges between them.
  std::vector<Vec3d> normals_, axes_;
  std::vector<bool> arc_is_crossed_;
};

std::vector<RoundedTangent> find_tangents(const RoundedGeometry& geometry, const RoundedView& view,
                                          VoidDepths depths) {
  const Rounding::Data& data = geometry.rounding->data();
  const Affine3d from_world =
      geometry.frame == nullptr ? Affine3d() : geometry.frame->rounding_from_world;
  const Affine3d world = inverse(from_world);
  const double scale = std::cbrt(std::abs(determinant(world.linear)));
  std::vector<RoundedTangent> tangents;
  Outline outline(data, view, world, data.radius * scale, transform_point(from_world, view.eye),
                  depths, tangents);
  for (const Solid& solid : data.solids) outline.add_solid(solid);
  return tangents;
}

}  // namespace

std::vector<RoundedTangent> find_rounded_tangents(const RoundedGeometry& geometry,
                                                  const RoundedView& view) {
  return find_tangents(geometry, view, VoidDepths::found);
}

void find_rounded_outline(const RoundedGeometry& geometry, const RoundedView& view,
                          std::vector<WorldEdge>& edges) {
  for (const RoundedTangent& t : find_tangents(geometry, view, VoidDepths::none)) {
    edges.push_back(t.edge);
  }
}

}  // namespace arris
