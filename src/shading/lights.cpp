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

// Collects emitters with the power that decides how often each is drawn. That of far lights (directional, environment,
// sun) grows with the scene's disc, most of which nobody may see: a wide floor would leave nothing to the lamps. So far
// and near ones are drawn equally often where there are both.
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

  void add_environment(std::shared_ptr<const EnvironmentLight> environment) {
    set_.environment = std::move(environment);
    if (set_.environment->kind == EnvironmentKind::map) {
      add(EmitterKind::environment, 0, disc_area_ * set_.environment->map.power);
    }
    if (!set_.environment->suns.empty()) {
      const SunDisc& sun = set_.environment->suns.front();
      add(EmitterKind::sun, 0, disc_area_ * sun.solid_angle * mean(sun.radiance));
    }
  }

  LightSet finish() {
    balance_far_and_near();
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
  static bool is_far(const Emitter& e) {
    return e.kind == EmitterKind::directional || e.kind == EmitterKind::environment ||
           e.kind == EmitterKind::sun;
  }

  void balance_far_and_near() {
    double far = 0, near = 0;
    for (std::size_t i = 0; i < powers_.size(); ++i) {
      (is_far(set_.emitters[i]) ? far : near) += double(powers_[i]);
    }
    if (far == 0 || near == 0) return;
    for (std::size_t i = 0; i < powers_.size(); ++i) {
      powers_[i] = float(double(powers_[i]) / (is_far(set_.emitters[i]) ? far : near));
    }
  }

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

}  // namespace

LightSet make_light_set(std::span<const Light> lights, const Environment& environment,
                        std::span<const EmissiveTriangle> triangles, const SceneBounds& bounds) {
  return make_light_set(
      lights, std::make_shared<const EnvironmentLight>(make_environment_light(environment)),
      triangles, bounds);
}

LightSet make_light_set(std::span<const Light> lights,
                        std::shared_ptr<const EnvironmentLight> environment,
                        std::span<const EmissiveTriangle> triangles, const SceneBounds& bounds) {
  LightSetBuilder builder(bounds);
  for (const Light& light : lights) {
    std::visit(builder, light);
  }
  for (const EmissiveTriangle& triangle : triangles) {
    builder.add_triangle(triangle);
  }
  builder.add_environment(std::move(environment));
  return builder.finish();
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

}  // namespace arris
