#include "shading/rectangle_light.h"

#include "base/scalar.h"
#include "base/trigonometry.h"

namespace arris {
namespace {

// Edges count as orthogonal if their cosine is below this.
constexpr float kOrthogonalCosine = 1e-4F;
constexpr float kTwoPi = 2.0F * float(kPi);

// The rectangle seen from the origin, in its own axes: x0…x1, y0…y1 in the plane z0 < 0 (Ureña et al., sec. 3).
struct SphericalRectangle {
  float x0, x1, y0, y1, z0;
  float b0, b1, k;
  float solid_angle;
};

SphericalRectangle make_spherical_rectangle(const RectangleEmitter& light, Vec3f point) {
  const Vec3f d = light.corner - point;
  SphericalRectangle q{};
  q.x0 = dot(d, light.axis_u);
  q.y0 = dot(d, light.axis_v);
  q.x1 = q.x0 + light.length_u;
  q.y1 = q.y0 + light.length_v;
  q.z0 = dot(d, light.normal);  // negative in front
  const float z2 = q.z0 * q.z0;
  // z components of the normals of the planes through the origin and each edge
  const float n0 = -q.y0 / std::sqrt(z2 + q.y0 * q.y0);
  const float n1 = q.x1 / std::sqrt(z2 + q.x1 * q.x1);
  const float n2 = q.y1 / std::sqrt(z2 + q.y1 * q.y1);
  const float n3 = -q.x0 / std::sqrt(z2 + q.x0 * q.x0);
  // interior angles of the spherical quadrilateral
  const float g0 = angle_of_cosine(-n0 * n1);
  const float g1 = angle_of_cosine(-n1 * n2);
  const float g2 = angle_of_cosine(-n2 * n3);
  const float g3 = angle_of_cosine(-n3 * n0);
  q.b0 = n0;
  q.b1 = n2;
  q.k = kTwoPi - g2 - g3;
  q.solid_angle = g0 + g1 - q.k;
  return q;
}

// Point in the rectangle's axes (Ureña et al., sec. 4).
Vec3f sample_spherical_rectangle(const SphericalRectangle& q, Vec2f u) {
  const Vec2f circle = unit_circle((u.x * q.solid_angle + q.k) / kTwoPi);
  const float fu = (circle.x * q.b0 - q.b1) / circle.y;
  const float cu = std::copysign(1.0F / std::sqrt(fu * fu + q.b0 * q.b0), fu);
  const float cu_inside = clamp_to(cu, -0.9999999F, 0.9999999F);
  const float x = -(cu_inside * q.z0) / std::sqrt(1.0F - cu_inside * cu_inside);
  const float xu = clamp_to(x, q.x0, q.x1);
  const float d2 = xu * xu + q.z0 * q.z0;
  const float h0 = q.y0 / std::sqrt(d2 + q.y0 * q.y0);
  const float h1 = q.y1 / std::sqrt(d2 + q.y1 * q.y1);
  const float hv = h0 + u.y * (h1 - h0);
  const float left = 1.0F - hv * hv;
  const float yv = left > 1e-6F ? hv * std::sqrt(d2 / left) : q.y1;
  return {xu, clamp_to(yv, q.y0, q.y1), q.z0};
}

}  // namespace

RectangleEmitter make_rectangle_emitter(const AreaLight& light) {
  const Vec3d normal = cross(light.edge_u, light.edge_v);
  const double area = length(normal);
  RectangleEmitter e;
  e.corner = Vec3f(light.corner);
  e.edge_u = Vec3f(light.edge_u);
  e.edge_v = Vec3f(light.edge_v);
  e.normal = Vec3f(normal / area);
  e.axis_u = Vec3f(normalize(light.edge_u));
  e.axis_v = Vec3f(normalize(light.edge_v));
  e.dual_u = Vec3f(cross(light.edge_v, normal) / (area * area));
  e.dual_v = Vec3f(cross(normal, light.edge_u) / (area * area));
  e.radiance = light.radiance;
  e.length_u = float(length(light.edge_u));
  e.length_v = float(length(light.edge_v));
  e.area = float(area);
  e.orthogonal = std::fabs(dot(e.axis_u, e.axis_v)) < kOrthogonalCosine;
  e.visible_to_camera = light.visible_to_camera;
  return e;
}

std::optional<RectangleSample> sample_near_rectangle(const RectangleEmitter& light, Vec3f point,
                                                     Vec2f u) {
  const SphericalRectangle q = make_spherical_rectangle(light, point);
  if (!(q.solid_angle > 0.0F)) {
    return std::nullopt;
  }
  const Vec3f p = sample_spherical_rectangle(q, u);
  const Vec3f d = light.axis_u * p.x + light.axis_v * p.y + light.normal * p.z;
  const float distance = length(d);
  return RectangleSample{d * (1.0F / distance), distance, 1.0F / q.solid_angle};
}

float pdf_near_rectangle(const RectangleEmitter& light, Vec3f point) {
  const SphericalRectangle q = make_spherical_rectangle(light, point);
  return q.solid_angle > 0.0F ? 1.0F / q.solid_angle : 0.0F;
}

}  // namespace arris
