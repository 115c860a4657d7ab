#include "edgepoint/shadow_wedge.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace arris {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Of the size of the coordinates: what two rounded float positions of one place may be apart, a few times over.
constexpr double kContact = 4.0 / (1 << 23);

double size_of(Vec3d v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

LinearForm form_at(Vec3d direction, Vec3d zero) {
  return {direction, -dot(direction, zero)};
}

// The forms of rays r0 and r1 from an apex.
std::optional<EventWedge> wedge_from(Vec3d apex, Vec3d r0, Vec3d r1) {
  const Vec3d n = cross(r0, r1);
  const double n2 = length_squared(n);
  if (!(n2 > 0)) return std::nullopt;
  EventWedge w;
  w.plane = form_at(n / std::sqrt(n2), apex);
  w.a = form_at(cross(r1, n) / n2, apex);
  w.b = form_at(cross(n, r0) / n2, apex);
  w.u = form_at(w.a.direction + w.b.direction, apex);
  w.apex = apex;
  w.r = {r0, r1};
  w.last_u = kInfinity;
  return w;
}

std::optional<EventWedge> parallel_wedge(Vec3d o0, Vec3d edge, Vec3d d) {
  const Vec3d n = cross(edge, d);
  const double n2 = length_squared(n);
  if (!(n2 > 0)) return std::nullopt;
  EventWedge w;
  w.plane = form_at(n / std::sqrt(n2), o0);
  w.b = form_at(cross(d, n) / n2, o0);
  w.a = {-w.b.direction, 1 - w.b.offset};
  w.u = form_at(cross(n, edge) / n2, o0);
  w.parallel = true;
  w.apex = o0;
  w.r = {edge, d};
  w.last_u = kInfinity;
  return w;
}

double size_of(const ShadowEvent& event) {
  double size = std::max(size_of(event.origin[0]), size_of(event.origin[1]));
  for (const HomogeneousPoint& p : event.light) {
    if (p.w > 0) size = std::max(size, size_of(p.xyz / p.w));
  }
  return size;
}

Vec3d place(const HomogeneousPoint& p) {
  return p.xyz / p.w;
}

}  // namespace

std::optional<EventWedge> make_wedge(const ShadowEvent& event) {
  const double size = kContact * size_of(event);
  if (event.is_at_vertex()) {
    const Vec3d q = event.origin[0];
    std::optional<EventWedge> w =
        wedge_from(q, q - place(event.light[0]), q - place(event.light[1]));
    if (w) w->begin = kInfinity;
    return w;
  }
  const HomogeneousPoint& light = event.light[0];
  if (light.w == 0) {
    std::optional<EventWedge> w =
        parallel_wedge(event.origin[0], event.origin[1] - event.origin[0], -normalize(light.xyz));
    if (w) w->contact = size;
    return w;
  }
  const Vec3d r0 = event.origin[0] - place(light), r1 = event.origin[1] - place(light);
  std::optional<EventWedge> w = wedge_from(place(light), r0, r1);
  if (w) {
    w->begin = 1;
    w->contact = size / std::min(length(r0), length(r1));
  }
  return w;
}

std::optional<EventWedge> make_wedge_to_light(const ShadowEvent& event) {
  const Vec3d q = event.origin[0];
  const Vec3d r0 = place(event.light[0]) - q, r1 = place(event.light[1]) - q;
  std::optional<EventWedge> w = wedge_from(q, r0, r1);
  if (w) {
    w->begin = 1;
    w->contact = kContact * size_of(event) / std::min(length(r0), length(r1));
    w->last_u = 1;
  }
  return w;
}

}  // namespace arris
