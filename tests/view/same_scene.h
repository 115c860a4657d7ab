// same_scene.h — whether two scenes show the same
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <tuple>
#include <variant>
#include <vector>

#include "arris/scene.h"

namespace arris::test {

inline auto look_of(const Material& m) {
  return std::tuple(m.base_color, m.metallic, m.roughness, m.ior, m.specular, m.specular_color,
                    m.transmission, m.clearcoat, m.clearcoat_roughness, m.emission, m.opacity,
                    m.alpha_cutoff, m.glossy_mix);
}

inline void expect_same_material(const Scene& a, MaterialId in_a, const Scene& b, MaterialId in_b) {
  const Material &one = a.materials[in_a.index], &other = b.materials[in_b.index];
  EXPECT_EQ(look_of(one), look_of(other)) << one.name << " and " << other.name;
  ASSERT_EQ(one.base_color_texture.has_value(), other.base_color_texture.has_value());
  if (!one.base_color_texture) return;
  EXPECT_TRUE(a.textures[one.base_color_texture->index].texels ==
              b.textures[other.base_color_texture->index].texels);
}

inline void expect_same_object(const Scene& a, const Object& in_a, const Scene& b,
                               const Object& in_b) {
  EXPECT_EQ(in_a.world_from_object, in_b.world_from_object) << in_a.name;
  EXPECT_EQ(in_a.rounding.value_or(*a.rounding), in_b.rounding.value_or(*b.rounding)) << in_a.name;
  if (std::holds_alternative<AutoRadius>(in_b.rounding.value_or(*b.rounding).radius)) {
    EXPECT_EQ(in_a.auto_radius, in_b.auto_radius) << in_a.name;
  }
  const Mesh &one = a.meshes[in_a.mesh.index], &other = b.meshes[in_b.mesh.index];
  EXPECT_EQ(one.positions, other.positions) << in_a.name;
  for (std::size_t t = 0; t < one.triangles.size(); ++t) {
    const auto material = [&](const Mesh& mesh, const Object& object) {
      return mesh.triangle_materials.empty() ? object.material : mesh.triangle_materials[t];
    };
    expect_same_material(a, material(one, in_a), b, material(other, in_b));
  }
}

struct LightNumbers {
  using Numbers = std::vector<double>;
  static void add(Numbers& out, Vec3d v) { out.insert(out.end(), {v.x, v.y, v.z}); }
  Numbers operator()(const PointLight& l) const {
    Numbers out{0};
    add(out, l.position);
    add(out, Vec3d(l.intensity));
    return out;
  }
  Numbers operator()(const SpotLight& l) const {
    Numbers out{1, l.inner_angle, l.outer_angle};
    add(out, l.position);
    add(out, l.direction);
    add(out, Vec3d(l.intensity));
    return out;
  }
  Numbers operator()(const DirectionalLight& l) const {
    Numbers out{2};
    add(out, l.direction);
    add(out, Vec3d(l.irradiance));
    return out;
  }
  Numbers operator()(const AreaLight& l) const {
    Numbers out{3, double(l.visible_to_camera)};
    for (const Vec3d v : {l.corner, l.edge_u, l.edge_v, Vec3d(l.radiance)}) add(out, v);
    return out;
  }
};

// Names, and numbers of materials and meshes, may differ; the environment's map may be turned by whole turns.
inline void expect_same_scene(const Scene& read, const Scene& shown) {
  EXPECT_EQ(read.up, shown.up);
  EXPECT_EQ(read.camera->position, shown.camera->position);
  EXPECT_EQ(read.camera->target, shown.camera->target);
  EXPECT_EQ(read.camera->up, shown.camera->up);
  EXPECT_EQ(read.camera->fov_deg, shown.camera->fov_deg);
  EXPECT_EQ(read.image.width_px, shown.image.width_px);
  EXPECT_EQ(read.image.height_px, shown.image.height_px);
  EXPECT_EQ(read.image.samples_per_pixel, shown.image.samples_per_pixel);
  EXPECT_EQ(read.image.exposure, shown.image.exposure);
  EXPECT_EQ(read.image.filter, shown.image.filter);
  EXPECT_EQ(read.rounding, shown.rounding);
  EXPECT_EQ(read.ground, shown.ground);
  Environment map = *read.environment;  // its name is that of another folder
  if (auto* hdr = std::get_if<HdrEnvironment>(&map)) {
    const auto& own = std::get<HdrEnvironment>(*shown.environment);
    EXPECT_NEAR(std::cos(hdr->rotation), std::cos(own.rotation), 1e-12);
    hdr->name = own.name;
    hdr->rotation = own.rotation;
  }
  EXPECT_EQ(map, *shown.environment);
  ASSERT_EQ(read.lights.size(), shown.lights.size());
  for (std::size_t i = 0; i < shown.lights.size(); ++i) {
    EXPECT_EQ(std::visit(LightNumbers{}, read.lights[i]),
              std::visit(LightNumbers{}, shown.lights[i]));
  }
  ASSERT_EQ(read.objects.size(), shown.objects.size());
  for (std::size_t i = 0; i < shown.objects.size(); ++i) {
    expect_same_object(read, read.objects[i], shown, shown.objects[i]);
  }
}

}  // namespace arris::test
