#include "rounding/corner.h"

#include <cmath>
#include <limits>

namespace arris {
namespace {

// Relative to the solid's size: nodes nearer than this are one.
constexpr double kSameNode = 1e-7;

// The face planes around the vertex form a convex polygon of normals; the erosion's vertices triangulate it. Each
// triangle (i, l, j) is the vertex where planes i, l, j meet; l is the first plane met when travelling
// along the line of planes i and j into the cone.
class ConeSplitter {
 public:
  ConeSplitter(std::span<const Plane> planes, double size) : planes_(planes), size_(size) {
    out_.node_of_edge.assign(planes.size(), kNone);
  }

  std::optional<CornerErosion> split() {
    const auto last = std::uint32_t(planes_.size() - 1);
    // Edge 0 between planes `last` and 0 leaves the corner along n_0 × n_last; come in from afar.
    const Vec3d axis = cross(planes_[0].normal, planes_[last].normal);
    if (!(length(axis) > 0)) return std::nullopt;
    const Vec3d inward = -normalize(axis);
    pending_.push_back({0, last, inward, kNone});
    while (!pending_.empty()) {
      const Span span = pending_.back();
      pending_.pop_back();
      if (!visit(span)) return std::nullopt;
    }
    return std::move(out_);
  }

 private:
  // Planes first and last meet in an arc; those between them are still to be placed.
  struct Span {
    std::uint32_t first, last;
    Vec3d travel;        // along the arc, away from `node`
    std::uint32_t node;  // where the arc starts, or kNone for edge 0
  };

  bool visit(const Span& span) {
    const Plane& a = planes_[span.first];
    const Plane& b = planes_[span.last];
    const Vec3d start =
        span.node == kNone ? nearest_on_offset_line(a, b, 0, Vec3d()) : out_.nodes[span.node];
    double nearest = std::numeric_limits<double>::infinity();
    std::uint32_t apex = kNone;
    for (std::uint32_t l = span.first + 1; l < span.last; ++l) {
      const double approach = dot(planes_[l].normal, span.travel);
      if (approach <= 0) continue;
      const double distance = (planes_[l].d - dot(planes_[l].normal, start)) / approach;
      if (distance < nearest) {
        nearest = distance;
        apex = l;
      }
    }
    if (apex == kNone) return false;
    std::uint32_t node = span.node;
    if (span.node == kNone || nearest > kSameNode * size_) {
      node = std::uint32_t(out_.nodes.size());
      out_.nodes.push_back(start + span.travel * nearest);
      if (span.node != kNone) add_short_arc(span, node);
    }
    if (span.node == kNone) out_.node_of_edge[0] = node;
    go_on(span.first, apex, planes_[span.last], node);
    go_on(apex, span.last, planes_[span.first], node);
    return true;
  }

  void add_short_arc(const Span& span, std::uint32_t node) {
    const Vec3d axis = cross(planes_[span.first].normal, planes_[span.last].normal);
    const bool forward = dot(axis, span.travel) > 0;
    out_.short_arcs.push_back(
        {span.node, node, forward ? span.first : span.last, forward ? span.last : span.first});
  }

  // The arc of planes i and j leaves `node` away from plane `opposite`.
  void go_on(std::uint32_t i, std::uint32_t j, const Plane& opposite, std::uint32_t node) {
    if (j == i + 1) {
      out_.node_of_edge[j] = node;
      return;
    }
    Vec3d travel = normalize(cross(planes_[i].normal, planes_[j].normal));
    if (dot(travel, opposite.normal) > 0) travel = -travel;
    pending_.push_back({i, j, travel, node});
  }

  static constexpr std::uint32_t kNone = 0xffffffffU;
  std::span<const Plane> planes_;
  double size_;
  std::vector<Span> pending_;
  CornerErosion out_;
};

}  // namespace

std::optional<CornerErosion> erode_corner(std::span<const Plane> planes, double size) {
  return ConeSplitter(planes, size).split();
}

std::optional<Mitre> make_mitre_plane(const AxisLine& a, const AxisLine& b) {
  const Vec3d bend = a.direction - b.direction;
  if (length_squared(bend) < 1e-4) return std::nullopt;
  const Vec3d normal = normalize(bend);
  // Closest points of the two axes; nearly straight chains have none worth having.
  Mitre mitre;
  const double c = dot(a.direction, b.direction);
  const double s2 = 1 - c * c;
  if (s2 > 1e-8) {
    const Vec3d w = a.point - b.point;
    const double ta = (c * dot(b.direction, w) - dot(a.direction, w)) / s2;
    const double tb = (dot(b.direction, w) - c * dot(a.direction, w)) / s2;
    mitre.center = (a.point + a.direction * ta + b.point + b.direction * tb) * 0.5;
  } else {
    mitre.center = (a.point + b.point) * 0.5;
  }
  const auto meet = [&](const AxisLine& line) {
    const double t = dot(normal, mitre.center - line.point) / dot(normal, line.direction);
    return line.point + line.direction * t;
  };
  mitre.end_a = meet(a);
  mitre.end_b = meet(b);
  return mitre;
}

Vec3d nearest_on_offset_line(const Plane& a, const Plane& b, double radius, Vec3d near) {
  const double c = dot(a.normal, b.normal);
  const double ra = a.d - radius - dot(a.normal, near);
  const double rb = b.d - radius - dot(b.normal, near);
  const double s2 = length_squared(cross(a.normal, b.normal));  // 1 − c², without cancellation
  return near + a.normal * ((ra - c * rb) / s2) + b.normal * ((rb - c * ra) / s2);
}

}  // namespace arris
