// crease_curve.h — the curves on which balls of the radius touch a solid's surface from inside in two places
// What       A segment, or an arc of an ellipse: where the offsets of two features of the surface meet. Faces are
//            offset to planes, concave edges to cylinders of the radius, concave corners to spheres.
//            | features | curve |
//            |---|---|
//            | face, face | line |
//            | face, concave edge | ellipse in the offset plane; two lines if the edge is parallel to the face |
//            | two concave edges that meet | two ellipses, in planes through the corner of normals a − b, a + b |
//            | face, concave corner | circle in the offset plane |
//            | others | equidistant_curve.h |
// Legend     r radius; a, b unit directions of edges; u parameter: x(u) = center + a·u, or center + a·cos u + b·sin u
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "arris/math.h"
#include "edges/flat_regions.h"
#include "edges/welded_mesh.h"

namespace arris {

struct CreaseCurve {
  Vec3d center, a, b;
  bool is_line = true;  // else an ellipse with half axes a and b
  double u0 = 0, u1 = 0;
  std::uint32_t face_a = kNone, face_b = kNone;  // regions of those of the features that are faces
  double r0 = 0, r1 = 0;  // of the balls at u0 and u1, and linear between; the same but on a line

  [[nodiscard]] Vec3d at(double u) const;
  [[nodiscard]] Vec3d derivative(double u) const;
  // Of the balls' radius along a line, by u.
  [[nodiscard]] double growth() const { return r0 == r1 ? 0 : (r1 - r0) / (u1 - u0); }
  [[nodiscard]] double radius_at(double u) const { return r0 + growth() * (u - u0); }
};

// The roots within [u0, u1] of α + n·x(u).
void add_crossings(const CreaseCurve& curve, Vec3d normal, double alpha,
                   std::vector<double>& roots);

// The nearest point of the curve to x, by its parameter.
double nearest_parameter(const CreaseCurve& curve, Vec3d x);

// The distance from the balls around a segment, or around a short part of an arc; below 0 within them.
double distance_to_balls(const CreaseCurve& part, Vec3d x);
// Of a segment whose balls' radius grows by `growth` of the way: the place along it of the ball nearest to a point, by
// the point's place along and distance from the axis.
inline double nearest_ball(double along, double across, double growth) {
  return along + growth * across / std::sqrt(1 - growth * growth);
}

// Lines and ellipses have their whole extent, or [−extent, extent].
std::optional<CreaseCurve> face_face_crease(const Plane& a, const Plane& b, double radius,
                                            Vec3d near, double extent);
struct EdgeLine {
  Vec3d point, direction;  // unit
};
std::vector<CreaseCurve> face_edge_creases(const Plane& face, const EdgeLine& edge, double radius,
                                           double extent);
// Edges through one corner.
std::vector<CreaseCurve> edge_edge_creases(Vec3d corner, Vec3d direction0, Vec3d direction1,
                                           double radius);
std::optional<CreaseCurve> face_corner_crease(const Plane& face, Vec3d corner, double radius);
CreaseCurve crease_circle(Vec3d center, Vec3d normal, double radius);

}  // namespace arris
