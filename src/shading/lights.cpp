#include "shading/lights.h"

#include <cmath>
#include <cstddef>
#include <utility>
#include <variant>

#include "base/scalar.h"

namespace arris {
namespace {

constexpr float kPiF = float(kPi);

float mean(Rgb c) {
  return (c.x + c.y + c.z) * (1.0F / 3.0F);
}

// Collects emitters with the power that decides how often each is drawn.
class LightSetBuilder {
 public:
  explicit LightSetBuilder(const SceneBounds& bounds)
      : disc_area_(kPiF * bounds.radius * bounds.radius) {}

  void operator()(const PointLight& light) {
    add(EmitterKind::point, set_.points.size(), 4.0F * kPiF * mean(light.intensity));
    set_.points.push_back({Vec3f(light.position), light.intensity});
  }

  void operator()(const SpotLight& light) {
    const double cos_outer = std::cos(light.outer_angle);
    const double width = std::fmax(1e-4, std::cos(light.inner_angle) - cos_outer);
    const double solid_angle = 2.0 * kPi * (1.0 - 0.5 * (std::cos(light.inner_angle) + cos_outer));
    add(EmitterKind::spot, set_.spots.size(), float(solid_angle) * mean(light.intensity));
    set_.spots.push_back({Vec3f(light.position), Vec3f(normalize(light.direction)), light.intensity,
                          float(1.0 / width), float(-cos_outer / width)});
  }

  void operator()(const DirectionalLight& light) {
    add(EmitterKind::directional, set_.directionals.size(), disc_area_ * mean(light.irradiance));
    set_.directionals.push_back({Vec3f(-normalize(light.direction)), light.irradiance});
  }

  void operator()(const AreaLight& light) {
    const RectangleEmitter e = make_rectangle_emitter(light);
    add(EmitterKind::rectangle, set_.rectangles.size(), kPiF * e.area * mean(e.radiance));
    set_.rectangles.push_back(e);
  }

  void add_triangle(const EmissiveTriangle& t) {
    const Vec3f edge_b = t.b - t.a;
    const Vec3f edge_c = t.c - t.a;
    const Vec3f normal = cross(edge_b, edge_c);
    const float twice_area = length(normal);
    const bool has_area = twice_area > 0.0F;
    const float sides = t.both_sides ? 2.0F : 1.0F;
    add(EmitterKind::triangle, set_.triangles.size(),
        sides * kPiF * 0.5F * twice_area * mean(t.radiance));
    set_.triangles.push_back({t.a, edge_b, edge_c, has_area ? normal * (1.0F / twice_area) : normal,
                              t.radiance, has_area ? 2.0F / twice_area : 0.0F, t.both_sides});
  }

  void add_environment(const Environment& environment) {
    set_.environment = make_environment_light(environment);
    if (set_.environment.kind == EnvironmentKind::map) {
      add(EmitterKind::environment, 0, disc_area_ * set_.environment.map.power);
    }
    if (!set_.environment.suns.empty()) {
      const SunDisc& sun = set_.environment.suns.front();
      add(EmitterKind::sun, 0, disc_area_ * sun.solid_angle * mean(sun.radiance));
    }
  }

  LightSet finish() {
    set_.selection = make_alias_table(powers_);
    set_.rectangle_probability.resize(set_.rectangles.size());
    set_.triangle_probability.resize(set_.triangles.size());
    for (std::size_t i = 0; i < set_.emitters.size(); ++i) {
      const Emitter e = set_.emitters[i];
      const float probability = set_.selection.probability[i];
      switch (e.kind) {
        case EmitterKind::rectangle:
          set_.rectangle_probability[e.index] = probability;
          break;
        case EmitterKind::triangle:
          set_.triangle_probability[e.index] = probability;
          break;
        case EmitterKind::environment:
          set_.environment_probability = probability;
          break;
        case EmitterKind::sun:
          set_.sun_probability = probability;
          break;
        case EmitterKind::point:
        case EmitterKind::spot:
        case EmitterKind::directional:
          break;
      }
    }
    return std::move(set_);
  }

 private:
  // Emitters without power are kept in their arrays and never drawn.
  void add(EmitterKind kind, std::size_t index, float power) {
    if (power > 0.0F) {
      set_.emitters.push_back({kind, std::uint32_t(index)});
      powers_.push_back(power);
    }
  }

  LightSet set_;
  std::vector<float> powers_;
  float disc_area_;
};

// Falls with the square of the distance, which never is zero.
struct Falloff {
  Vec3f wi;
  float distance;
  float inverse_square;
};
Falloff falloff_towards(Vec3f position, Vec3f point) {
  const Vec3f d = position - point;
  const float squared = max_of(length_squared(d), 1e-30F);
  const float distance = std::sqrt(squared);
  return {d * (1.0F / distance), distance, 1.0F / squared};
}

LightSample sample_point(const PointEmitter& light, Vec3f point) {
  const Falloff f = falloff_towards(light.position, point);
  return {.wi = f.wi,
          .distance = f.distance,
          .radiance = light.intensity * f.inverse_square,
          .pdf = 1.0F,
          .is_delta = true};
}

std::optional<LightSample> sample_spot(const SpotEmitter& light, Vec3f point) {
  const Falloff f = falloff_towards(light.position, point);
  const float linear = -dot(f.wi, light.axis) * light.cos_scale + light.cos_offset;
  if (linear <= 0.0F) {
    return std::nullopt;
  }
  const float clamped = min_of(linear, 1.0F);
  return LightSample{.wi = f.wi,
                     .distance = f.distance,
                     .radiance = light.intensity * (f.inverse_square * clamped * clamped),
                     .pdf = 1.0F,
                     .is_delta = true};
}

float pdf_triangle(const TriangleEmitter& light, Vec3f wi, float distance) {
  const float cos_l = -dot(wi, light.normal);
  const float facing = light.both_sides ? std::fabs(cos_l) : cos_l;
  return facing > 0.0F ? distance * distance * light.inverse_area / facing : 0.0F;
}

std::optional<LightSample> sample_triangle(const TriangleEmitter& light, Vec3f point, Vec2f u) {
  const float r = std::sqrt(u.x);
  const Vec2f barycentric{r * (1.0F - u.y), r * u.y};
  const Vec3f p = light.a + light.edge_b * barycentric.x + light.edge_c * barycentric.y;
  const Falloff f = falloff_towards(p, point);
  const float pdf = pdf_triangle(light, f.wi, f.distance);
  if (!(pdf > 0.0F)) {
    return std::nullopt;
  }
  return LightSample{.wi = f.wi,
                     .distance = f.distance,
                     .radiance = light.radiance,
                     .pdf = pdf,
                     .barycentric = barycentric};
}

// Map and sun are one integrand, drawn by a mixture: both count wherever they overlap.
EnvironmentValue eval_map_and_sun(const LightSet& lights, Vec3f wi, MapPoint at) {
  const EnvironmentMap& map = lights.environment.map;
  EnvironmentValue value{eval_environment_map(map, map.radiance, at),
                         lights.environment_probability * pdf_environment_map(map, at)};
  for (const SunDisc& sun : lights.environment.suns) {
    if (is_in_sun(sun, wi)) {
      value.radiance += sun.radiance;
      value.pdf += lights.sun_probability / sun.solid_angle;
    }
  }
  return value;
}

std::optional<LightSample> sample_far(const LightSet& lights, Vec3f wi, MapPoint at) {
  const EnvironmentValue value = eval_map_and_sun(lights, wi, at);
  if (!(value.pdf > 0.0F)) {
    return std::nullopt;
  }
  return LightSample{.wi = wi, .radiance = value.radiance, .pdf = value.pdf};
}

std::optional<LightSample> sample_emitter(const LightSet& lights, Emitter emitter, Vec3f point,
                                          Vec2f u) {
  switch (emitter.kind) {
    case EmitterKind::point:
      return sample_point(lights.points[emitter.index], point);
    case EmitterKind::spot:
      return sample_spot(lights.spots[emitter.index], point);
    case EmitterKind::directional: {
      const DirectionalEmitter& light = lights.directionals[emitter.index];
      return LightSample{
          .wi = light.wi, .radiance = light.irradiance, .pdf = 1.0F, .is_delta = true};
    }
    case EmitterKind::rectangle: {
      const RectangleEmitter& light = lights.rectangles[emitter.index];
      const auto sample = sample_rectangle(light, point, u);
      if (!sample) {
        return std::nullopt;
      }
      return LightSample{.wi = sample->wi,
                         .distance = sample->distance,
                         .radiance = light.radiance,
                         .pdf = sample->pdf};
    }
    case EmitterKind::triangle:
      return sample_triangle(lights.triangles[emitter.index], point, u);
    case EmitterKind::environment: {
      const EnvironmentMapSample sample = sample_environment_map(lights.environment.map, u);
      return sample_far(lights, sample.wi, sample.at);
    }
    case EmitterKind::sun: {
      const Vec3f wi = sample_sun(lights.environment.suns.front(), u);
      return sample_far(lights, wi, map_point(lights.environment.map, wi));
    }
  }
  return std::nullopt;
}

}  // namespace

LightSet make_light_set(std::span<const Light> lights, const Environment& environment,
                        std::span<const EmissiveTriangle> triangles, const SceneBounds& bounds) {
  LightSetBuilder builder(bounds);
  for (const Light& light : lights) {
    std::visit(builder, light);
  }
  for (const EmissiveTriangle& triangle : triangles) {
    builder.add_triangle(triangle);
  }
  builder.add_environment(environment);
  return builder.finish();
}

std::optional<LightSample> sample_light(const LightSet& lights, Vec3f point, float u_select,
                                        Vec2f u) {
  if (lights.emitters.empty()) {
    return std::nullopt;
  }
  const std::uint32_t drawn = sample_alias_table(lights.selection, u_select);
  const Emitter emitter = lights.emitters[drawn];
  std::optional<LightSample> sample = sample_emitter(lights, emitter, point, u);
  if (sample) {
    // Environments have their selection in the mixture's density.
    const bool is_far =
        emitter.kind == EmitterKind::environment || emitter.kind == EmitterKind::sun;
    sample->pdf *= is_far ? 1.0F : lights.selection.probability[drawn];
    sample->kind = emitter.kind;
    sample->index = emitter.index;
  }
  return sample;
}

EnvironmentValue eval_environment_with_pdf(const LightSet& lights, Vec3f wi) {
  const EnvironmentLight& environment = lights.environment;
  return environment.kind == EnvironmentKind::constant
             ? EnvironmentValue{environment.constant, 0}
             : eval_map_and_sun(lights, wi, map_point(environment.map, wi));
}

Rgb eval_environment(const LightSet& lights, Vec3f wi) {
  return eval_environment_with_pdf(lights, wi).radiance;
}

float pdf_environment(const LightSet& lights, Vec3f wi) {
  return eval_environment_with_pdf(lights, wi).pdf;
}

Rgb eval_backdrop(const LightSet& lights, Vec3f wi) {
  const EnvironmentLight& environment = lights.environment;
  return environment.backdrop.empty() ? eval_environment(lights, wi)
                                      : eval_environment_map(environment.map, environment.backdrop,
                                                             map_point(environment.map, wi));
}

std::optional<AreaLightHit> find_area_light(const LightSet& lights, Vec3f origin, Vec3f dir,
                                            float t_max, RayKind kind) {
  std::optional<AreaLightHit> nearest;
  for (std::size_t i = 0; i < lights.rectangles.size(); ++i) {
    const RectangleEmitter& light = lights.rectangles[i];
    if (kind == RayKind::camera && !light.visible_to_camera) {
      continue;
    }
    if (const auto t = intersect_rectangle(light, origin, dir, nearest ? nearest->t : t_max)) {
      nearest = AreaLightHit{std::uint32_t(i), *t, light.radiance};
    }
  }
  return nearest;
}

float pdf_area_light(const LightSet& lights, std::uint32_t index, Vec3f point, Vec3f wi,
                     float distance) {
  return lights.rectangle_probability[index] *
         pdf_rectangle(lights.rectangles[index], point, wi, distance);
}

float pdf_emissive_triangle(const LightSet& lights, std::uint32_t index, Vec3f wi, float distance) {
  return lights.triangle_probability[index] * pdf_triangle(lights.triangles[index], wi, distance);
}

}  // namespace arris
