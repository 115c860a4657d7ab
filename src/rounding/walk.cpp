#include "rounding/walk.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace arris {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// A ray along a rim of many pieces passes them all; nothing passes more.
constexpr int kMaxSteps = 4096;
constexpr int kMaxDescent = 64;
// Slack of region planes, relative to the solid's size.
constexpr double kPlaneSlack = 1e-9;

// A plane through `point`; the arc lies on the side of `normal`.
struct EndPlane {
  Vec3d point, normal;
};

class Network {
 public:
  explicit Network(const Rounding::Data& data) : data_(data) {}

  [[nodiscard]] const Arc& arc(std::uint32_t index) const { return data_.arcs[index]; }
  [[nodiscard]] const Node& node(std::uint32_t index) const { return data_.nodes[index]; }
  [[nodiscard]] const Face& face(std::uint32_t index) const { return data_.faces[index]; }
  [[nodiscard]] std::uint32_t link(const Node& n, std::uint32_t i) const {
    return data_.links[n.first_link + i];
  }
  // A cap's last link: the face it lies in, or kNone.
  [[nodiscard]] std::uint32_t wall_of(const Node& n) const { return link(n, n.link_count - 1); }
  // Direction in which arc `index` leaves node `from`.
  [[nodiscard]] Vec3d leaving(std::uint32_t index, std::uint32_t from) const {
    const Vec3d e(arc(index).line.axis);
    return arc(index).node0 == from ? e : -e;
  }
  [[nodiscard]] std::uint32_t other_at_mitre(const Node& n, std::uint32_t index) const {
    return link(n, 0) == index ? link(n, 1) : link(n, 0);
  }

  // The end of arc `index` at node0 (end = 0) or node1 (end = 1); e is the arc's axis.
  [[nodiscard]] EndPlane end_plane(std::uint32_t index, int end, Vec3d e) const {
    const Arc& a = arc(index);
    const std::uint32_t node_index = end == 0 ? a.node0 : a.node1;
    const Vec3d leaving_here = end == 0 ? e : -e;
    const Node& n = node(node_index);
    const Vec3d point = end == 0 ? Vec3d(a.line.p0) : a.line.p1();
    switch (n.kind) {
      case Node::Kind::sphere:
        break;
      case Node::Kind::mitre:
        return {Vec3d(n.position),
                normalize(leaving_here - leaving(other_at_mitre(n, index), node_index))};
      case Node::Kind::cap:
        if (wall_of(n) != kNone) return {point, Vec3d(face(wall_of(n)).normal)};
        break;
    }
    return {point, leaving_here};
  }

 private:
  const Rounding::Data& data_;
};

struct Root {
  bool inside;      // the start already is within r
  bool receding;    // the distance grows from the start on
  double distance;  // to the entry, or infinity
};

// Entry into the ball or cylinder of radius r: |offset + s·direction| = r with both already projected.
inline Root find_entry(Vec3d offset, Vec3d direction, double r) {
  const double b = dot(offset, direction);
  const double c = length_squared(offset) - r * r;
  if (c <= 0) return {true, false, 0};
  if (b >= 0) return {false, true, kInfinity};
  const double a = length_squared(direction);
  const double discriminant = b * b - a * c;
  if (discriminant < 0) return {false, false, kInfinity};
  // c / (…) is the smaller root without cancellation.
  return {false, false, c / (-b + std::sqrt(discriminant))};
}

class Walk {
 public:
  Walk(const Rounding::Data& data, const Solid& solid, Vec3d x, Vec3d direction)
      : net_(data), solid_(solid), r_(data.radius), x_(x), d_(direction) {}

  std::optional<WalkHit> run(Place place) {
    for (int step = 0; step < kMaxSteps; ++step) {
      done_ = true;
      hit_.reset();
      place = place.is_node ? at_node(place.index) : at_arc(place.index);
      if (done_) return hit_;
    }
    return std::nullopt;
  }

 private:
  void advance(double s) {
    x_ += d_ * s;
    travelled_ += s;
  }

  void set_hit(double s, Vec3d normal, Feature feature) {
    hit_ = WalkHit{travelled_ + s, normal, feature, kNone};
  }

  // Returns the next place, with done_ = false; else hit_ holds the outcome.
  Place at_arc(std::uint32_t index) {
    const Arc& a = net_.arc(index);
    const Vec3d e(a.line.axis);
    const Vec3d rel = x_ - Vec3d(a.line.p0);
    const Vec3d offset = rel - e * dot(rel, e);
    const Vec3d across = d_ - e * dot(d_, e);
    const Root root = find_entry(offset, across, r_);
    if (root.receding && solid_.exact) return {};
    const Leaving leaving =
        solid_.exact ? leaving_between_spheres(a, rel, e) : leaving_arc(index, e);
    if (root.distance <= leaving.distance) {
      if (root.distance == kInfinity) return {};
      if (!solid_.exact && root.distance > exit_through_faces(a, rel)) return {};
      set_hit(root.distance, (offset + across * root.distance) / r_, Feature::edge);
      hit_->arc = index;
      if (root.inside) hit_->normal = normalize(offset);
      return {};
    }
    if (exit_through_faces(a, rel) <= leaving.distance) return {};
    advance(leaving.distance);
    const std::uint32_t node_index = leaving.end == 0 ? a.node0 : a.node1;
    const Node& n = net_.node(node_index);
    if (n.kind == Node::Kind::cap) {
      set_hit(0, leaving.plane_normal, Feature::face);
      return {};
    }
    done_ = false;
    if (n.kind == Node::Kind::mitre) return {net_.other_at_mitre(n, index), false};
    return {node_index, true};
  }

  // Where the ray crosses an end plane of the arc outward, and which.
  struct Leaving {
    double distance = kInfinity;
    int end = 0;
    Vec3d plane_normal;
  };

  [[nodiscard]] Leaving leaving_arc(std::uint32_t index, Vec3d e) const {
    Leaving leaving;
    for (const int end : {0, 1}) {
      const EndPlane p = net_.end_plane(index, end, e);
      const double approach = -dot(p.normal, d_);
      if (approach <= 0) continue;
      const double s = std::max(0.0, dot(p.normal, x_ - p.point) / approach);
      if (s < leaving.distance) leaving = {s, end, p.normal};
    }
    return leaving;
  }

  // The same where both nodes are spheres, as in every exact solid.
  [[nodiscard]] Leaving leaving_between_spheres(const Arc& a, Vec3d rel, Vec3d e) const {
    const double along = dot(rel, e);
    const double speed = dot(d_, e);
    if (speed > 0) return {std::max(0.0, (double(a.line.length) - along) / speed), 1, -e};
    if (speed < 0) return {std::max(0.0, -along / speed), 0, e};
    return {};
  }

  // Where the ray leaves the solid through one of the arc's faces: r above the axis.
  [[nodiscard]] double exit_through_faces(const Arc& a, Vec3d rel) const {
    return std::min(exit_through(net_.face(a.face_a), rel), exit_through(net_.face(a.face_b), rel));
  }

  [[nodiscard]] double exit_through(const Face& face, Vec3d rel) const {
    const double approach = dot(Vec3d(face.normal), d_);
    if (approach <= 0) return kInfinity;
    return (r_ - dot(Vec3d(face.normal), rel)) / approach;
  }

  Place at_node(std::uint32_t index) {
    const Node& n = net_.node(index);
    const Vec3d offset = x_ - Vec3d(n.position);
    const Root root = find_entry(offset, d_, r_);
    if (root.receding && solid_.exact) return {};
    double leave = kInfinity;
    std::uint32_t next = kNone;
    Vec3d next_direction;
    for (std::uint32_t i = 0; i < n.link_count; ++i) {
      const std::uint32_t arc = net_.link(n, i);
      const Vec3d e = net_.leaving(arc, index);
      const double approach = dot(e, d_);
      if (approach <= 0) continue;
      const double s = std::max(0.0, -dot(e, offset) / approach);
      if (s < leave) {
        leave = s;
        next = arc;
        next_direction = e;
      }
    }
    if (root.distance <= leave) {
      if (root.distance == kInfinity) return {};
      set_hit(root.distance, (offset + d_ * root.distance) / r_, Feature::corner);
      if (root.inside) hit_->normal = normalize(offset);
      return {};
    }
    if (root.receding && leave == kInfinity) return {};
    if (net_.arc(next).is_stub() && exit_through_faces(net_.arc(next), offset) < leave) return {};
    advance(leave);
    if (net_.arc(next).is_stub()) {
      set_hit(0, -next_direction, Feature::corner);
      return {};
    }
    done_ = false;
    return {next, false};
  }

  Network net_;
  const Solid& solid_;
  double r_;
  Vec3d x_, d_;
  double travelled_ = 0;
  bool done_ = true;
  std::optional<WalkHit> hit_;
};

}  // namespace

std::optional<Place> find_place(const Rounding::Data& data, const Solid& solid, std::uint32_t arc,
                                Vec3d x) {
  const Network net(data);
  const double slack = kPlaneSlack * solid.size;
  Place place{arc, false};
  for (int step = 0; step < kMaxDescent; ++step) {
    if (place.is_node) {
      const Node& n = net.node(place.index);
      std::uint32_t next = kNone;
      double farthest = slack;
      for (std::uint32_t i = 0; i < n.link_count; ++i) {
        const double along = dot(net.leaving(net.link(n, i), place.index), x - Vec3d(n.position));
        if (along > farthest) {
          farthest = along;
          next = net.link(n, i);
        }
      }
      if (next == kNone) return place;
      if (net.arc(next).is_stub()) return std::nullopt;
      place = {next, false};
      continue;
    }
    const Arc& a = net.arc(place.index);
    const Vec3d e(a.line.axis);
    if (solid.exact) {
      const double along = dot(x - Vec3d(a.line.p0), e);
      if (along >= -slack && along <= double(a.line.length) + slack) return place;
      place = {along < 0 ? a.node0 : a.node1, true};
      continue;
    }
    int beyond = -1;
    double farthest = slack;
    for (const int end : {0, 1}) {
      const EndPlane p = net.end_plane(place.index, end, e);
      const double distance = dot(p.normal, p.point - x);
      if (distance > farthest) {
        farthest = distance;
        beyond = end;
      }
    }
    if (beyond < 0) return place;
    const std::uint32_t node_index = beyond == 0 ? a.node0 : a.node1;
    const Node& n = net.node(node_index);
    if (n.kind == Node::Kind::cap) return std::nullopt;
    place = n.kind == Node::Kind::mitre ? Place{net.other_at_mitre(n, place.index), false}
                                        : Place{node_index, true};
  }
  return search_place(data, solid, x);
}

std::optional<Place> search_place(const Rounding::Data& data, const Solid& solid, Vec3d x) {
  const Network net(data);
  std::optional<Place> best;
  double nearest = kInfinity;
  for (std::uint32_t i = solid.first_arc; i < solid.first_arc + solid.arc_count; ++i) {
    const Arc& a = net.arc(i);
    if (a.is_stub()) continue;
    const double along = dot(x - Vec3d(a.line.p0), Vec3d(a.line.axis));
    if (along < 0 || along > double(a.line.length)) continue;
    const double d = distance_to_place(data, {i, false}, x);
    if (d < nearest) {
      nearest = d;
      best = Place{i, false};
    }
  }
  for (std::uint32_t i = solid.first_node; i < solid.first_node + solid.node_count; ++i) {
    const double d = distance_to_place(data, {i, true}, x);
    // Arcs first where both are as near.
    if (net.node(i).kind == Node::Kind::sphere && d < nearest - kPlaneSlack * solid.size) {
      nearest = d;
      best = Place{i, true};
    }
  }
  return best;
}

double distance_to_place(const Rounding::Data& data, Place place, Vec3d x) {
  const Network net(data);
  if (place.is_node) return length(x - Vec3d(net.node(place.index).position));
  const Arc& a = net.arc(place.index);
  return length(cross(x - Vec3d(a.line.p0), Vec3d(a.line.axis)));
}

ShortWalk walk_short(const Rounding::Data& data, std::uint32_t arc, Vec3d x, Vec3d direction) {
  const ArcLine& line = data.arcs[arc].line;
  const Vec3d e(line.axis);
  const Vec3d rel = x - Vec3d(line.p0);
  const double along = dot(rel, e);
  if (along < 0 || along > double(line.length)) return {};
  const double speed = dot(direction, e);
  const Vec3d offset = rel - e * along;
  const Vec3d across = direction - e * speed;
  const Root root = find_entry(offset, across, data.radius);
  if (root.receding) return {true, std::nullopt};
  if (root.distance == kInfinity || root.inside) return {};
  const double end = along + speed * root.distance;
  if (end < 0 || end > double(line.length)) return {};
  const Vec3d normal = (offset + across * root.distance) * (1 / data.radius);
  return {true, WalkHit{root.distance, normal, Feature::edge, arc}};
}

std::optional<WalkHit> walk(const Rounding::Data& data, const Solid& solid, Place place, Vec3d x,
                            Vec3d direction) {
  return Walk(data, solid, x, direction).run(place);
}

}  // namespace arris
