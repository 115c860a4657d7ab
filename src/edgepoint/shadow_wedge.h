// shadow_wedge.h — an event as a plane with two coordinates
// What       EventWedge: s along the event, and nearness to the light, in which segments of the plane are straight
// In / Out   world coordinates
// Source     Bala, Walter, Greenberg 2003, section 6.4
// Derivation With the apex A, the rays r0 and r1 and N = r0 × r1, a point of the plane is A + a r0 + b r1 with
//            a = (r1 × N)·(p − A) / N², b = (N × r0)·(p − A) / N². It lies on the ray r0 + s (r1 − r0), s = b / (a +
//            b), u = a + b times as far as the ray's vector. A line of the plane, x a + y b = 1, is x (1 − s) + y s = 1
//            / u: linear in s and the nearness 1 / u. With parallel rays d from o0 + s (o1 − o0) it is linear in s and
//            u as it is; the nearness is then −u.
#pragma once

#include <array>
#include <optional>

#include "edgepoint/shadow_events.h"

namespace arris {

// direction·p + offset.
struct LinearForm {
  Vec3d direction;
  double offset = 0;

  [[nodiscard]] double at(Vec3d p) const { return dot(direction, p) + offset; }
};

struct EventWedge {
  LinearForm plane;  // zero on it
  LinearForm a, b;   // both at least 0 within
  LinearForm u;      // distance from the apex, or from the origin if parallel
  bool parallel = false;
  Vec3d apex;              // or o0
  std::array<Vec3d, 2> r;  // or o1 − o0 and d
  double begin = 0;        // nearness where the event begins
  double contact = 0;      // nearer by no more than this is a contact with the beginning
  double last_u = 0;       // what is farther does not count

  [[nodiscard]] double nearness(double u_at) const { return parallel ? -u_at : 1 / u_at; }
  [[nodiscard]] Vec3d point(double s, double k) const {
    return parallel ? apex + r[0] * s - r[1] * k : apex + (r[0] + (r[1] - r[0]) * s) * (1 / k);
  }
};

// From the light through the beginning and on; for EV events: from the vertex on. None if it has no width.
std::optional<EventWedge> make_wedge(const ShadowEvent& event);
// Of an EV event, from the vertex to the light's edge.
std::optional<EventWedge> make_wedge_to_light(const ShadowEvent& event);

}  // namespace arris
