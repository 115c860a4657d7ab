#include "beam/beam_view.h"

#include <cmath>

namespace arris {
namespace {

// c + x·sx + y·sy
LinearVec make_linear(const Vec3i& c, const Vec3i& sx, const Vec3i& sy) {
  return {{c.x, sx.x, sy.x}, {c.y, sx.y, sy.y}, {c.z, sx.z, sy.z}};
}
Linear dot(Vec3d n, const LinearVec& v) {
  return v.x * Interval(n.x) + v.y * Interval(n.y) + v.z * Interval(n.z);
}
LinearVec map_linear(const Mat3d& m, const LinearVec& v) {
  const Mat3d rows = transpose(m);
  return {dot(rows.x, v), dot(rows.y, v), dot(rows.z, v)};
}
LinearVec add_scaled(const LinearVec& a, const Linear& weight, Vec3d v) {
  return {a.x + weight * Interval(v.x), a.y + weight * Interval(v.y), a.z + weight * Interval(v.z)};
}
// Of a polynomial that is known to be constant.
Linear scaled(const Linear& a, const Linear& only_constant) {
  return a * only_constant.c;
}

}  // namespace

PlaneForm make_form(const ViewFrame& frame, const CsgPlane& plane) {
  return {dot(plane.normal, frame.origin) - frame.weight * Interval(plane.d),
          dot(plane.normal, frame.direction)};
}

// One of origin and direction is constant, so no product has a degree above 2.
QuadricForm make_form(const ViewFrame& frame, const CsgQuadric& quadric) {
  const Affine3d& m = quadric.unit_from_object;
  const Vec3d w = weights_of(quadric.form);
  const LinearVec o = add_scaled(map_linear(m.linear, frame.origin), frame.weight, m.translation);
  const LinearVec d = map_linear(m.linear, frame.direction);
  const bool fixed = frame.direction_fixed;
  const auto times = [fixed](const Linear& of_o, const Linear& of_d) {
    return fixed ? scaled(of_o, of_d) : scaled(of_d, of_o);
  };
  QuadricForm form;
  form.value = squared(o.x) * Interval(w.x) + squared(o.y) * Interval(w.y) +
               squared(o.z) * Interval(w.z) -
               squared(frame.weight) * Interval(constant_of(quadric.form));
  form.curvature =
      squared(d.x) * Interval(w.x) + squared(d.y) * Interval(w.y) + squared(d.z) * Interval(w.z);
  form.half_slope = times(o.x, d.x) * Interval(w.x) + times(o.y, d.y) * Interval(w.y) +
                    times(o.z, d.z) * Interval(w.z);
  form.discriminant = squared(form.half_slope) -
                      (fixed ? form.value * form.curvature.c : form.curvature * form.value.c);
  form.along = o.z;
  return form;
}

ViewFrame make_eye_frame(const EyeRays& eye, const BeamSolid& solid) {
  const Affine3d& m = solid.object_from_world;
  ViewFrame frame;
  const Vec3i origin =
      map_vector(m.linear, to_intervals(eye.position)) + to_intervals(m.translation);
  frame.origin = make_linear(origin, Vec3i(0), Vec3i(0));
  frame.direction = make_linear(map_vector(m.linear, to_intervals(eye.corner)),
                                map_vector(m.linear, to_intervals(eye.step_x)),
                                map_vector(m.linear, to_intervals(eye.step_y)));
  return frame;
}

// a: -ha / sa, b: -hb / sb; their difference times sa sb.
Quadratic plane_before_plane(const PlaneForm& a, const PlaneForm& b, bool direction_fixed) {
  if (direction_fixed) return Quadratic(scaled(b.height, a.slope) - scaled(a.height, b.slope));
  return Quadratic(scaled(a.slope, b.height) - scaled(b.slope, a.height));
}

// value + 2 t half_slope + t² curvature at t = -h / s, times s².
Quadratic quadric_at_plane(const QuadricForm& q, const PlaneForm& p, bool direction_fixed) {
  if (direction_fixed) {
    const Interval s = p.slope.c;
    return q.value * square(s) - (p.height * q.half_slope) * (Interval(2) * s) +
           squared(p.height) * q.curvature.c;
  }
  const Interval h = p.height.c;
  return squared(p.slope) * q.value.c - (p.slope * q.half_slope) * (Interval(2) * h) +
         q.curvature * square(h);
}

// -h / s + half_slope / curvature, times s · curvature.
Quadratic plane_beyond_middle(const QuadricForm& q, const PlaneForm& p, bool direction_fixed) {
  if (direction_fixed) {
    return Quadratic(q.half_slope * p.slope.c - p.height * q.curvature.c);
  }
  return p.slope * q.half_slope - q.curvature * p.height.c;
}

namespace {

// A point of the lit plane is (origin · weight + direction · far) / weight, where weight = |slope|, far = |height| of
// the lit plane in the eye's view: both polynomials of first degree, the second one constant.
struct LitPoints {
  Linear weight;
  Interval far;
};

LitPoints make_lit_points(const PlaneForm& lit) {
  const bool above = lit.height.c.lo > 0;
  return above ? LitPoints{-lit.slope, lit.height.c} : LitPoints{lit.slope, -lit.height.c};
}

// In the space of the solid. Precondition: `lit` seen from the eye.
ViewFrame make_light_frame(const EyeRays& eye, const BeamSolid& solid, const LitPoints& lit,
                           const LightPlace& light, double reach) {
  const ViewFrame seen = make_eye_frame(eye, solid);
  const Vec3i eye_at{seen.origin.x.c, seen.origin.y.c, seen.origin.z.c};
  const auto lit_axis = [&](Interval origin, const Linear& direction) {
    return lit.weight * origin + direction * lit.far;
  };
  const LinearVec point{lit_axis(eye_at.x, seen.direction.x), lit_axis(eye_at.y, seen.direction.y),
                        lit_axis(eye_at.z, seen.direction.z)};
  const Affine3d& m = solid.object_from_world;
  ViewFrame frame;
  if (light.is_directional) {
    const Vec3d travels = light.direction * (1 / length(light.direction));
    const Vec3i d = map_vector(m.linear, to_intervals(travels));
    const Interval back(-reach);
    frame.direction = make_linear(d, Vec3i(0), Vec3i(0));
    frame.origin = {point.x + lit.weight * (d.x * back), point.y + lit.weight * (d.y * back),
                    point.z + lit.weight * (d.z * back)};
    frame.weight = lit.weight;
    frame.direction_fixed = true;
    return frame;
  }
  const Vec3i at = map_vector(m.linear, to_intervals(light.position)) + to_intervals(m.translation);
  frame.origin = make_linear(at, Vec3i(0), Vec3i(0));
  frame.direction = {point.x - lit.weight * at.x, point.y - lit.weight * at.y,
                     point.z - lit.weight * at.z};
  return frame;
}

}  // namespace

BeamView::BeamView(std::span<const BeamSolid> solids, const EyeRays& eye) : solids_(solids) {
  for (const BeamSolid& solid : solids) {
    const ViewFrame frame = make_eye_frame(eye, solid);
    std::vector<PlaneForm>& planes = planes_.emplace_back();
    for (const CsgPlane& plane : solid.solid->surfaces().planes()) {
      planes.push_back(make_form(frame, plane));
    }
    std::vector<QuadricForm>& quadrics = quadrics_.emplace_back();
    for (const CsgQuadric& quadric : solid.solid->surfaces().quadrics()) {
      quadrics.push_back(make_form(frame, quadric));
    }
    frames_.push_back(frame);
  }
}

BeamView::BeamView(std::span<const BeamSolid> solids, const EyeRays& eye, LitPlane lit,
                   const LightPlace& light, double reach)
    : solids_(solids) {
  const BeamSolid& of = solids[lit.solid];
  const PlaneForm plane =
      make_form(make_eye_frame(eye, of), of.solid->surfaces().planes()[lit.plane]);
  const LitPoints points = make_lit_points(plane);
  for (const BeamSolid& solid : solids) {
    frames_.push_back(make_light_frame(eye, solid, points, light, reach));
  }
}

}  // namespace arris
