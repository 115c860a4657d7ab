// render_scenes.h — small scenes with known answers
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "arris/render.h"
#include "arris/scene.h"

namespace arris::test {

inline Mesh make_box_mesh(Vec3d half) {
  Mesh mesh;
  mesh.name = "box";
  for (int i = 0; i < 8; ++i) {
    mesh.positions.push_back(
        Vec3f(Vec3d((i & 1) != 0 ? half.x : -half.x, (i & 2) != 0 ? half.y : -half.y,
                    (i & 4) != 0 ? half.z : -half.z)));
  }
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  return mesh;
}

// A square in the plane z = 0 that faces +z.
inline Mesh make_square_mesh(float half) {
  Mesh mesh;
  mesh.name = "square";
  mesh.positions = {{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  mesh.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  return mesh;
}

// A unit sphere of 20 · 4^levels triangles with vertices on it.
inline Mesh make_sphere_mesh(int levels) {
  Mesh mesh;
  mesh.name = "sphere";
  const float a = 0.525731112F, b = 0.850650808F;
  mesh.positions = {{-a, 0, b}, {a, 0, b},   {-a, 0, -b}, {a, 0, -b}, {0, b, a},  {0, b, -a},
                    {0, -b, a}, {0, -b, -a}, {b, a, 0},   {-b, a, 0}, {b, -a, 0}, {-b, -a, 0}};
  mesh.triangles = {{0, 1, 4},  {0, 4, 9},  {9, 4, 5},  {4, 8, 5},  {4, 1, 8},
                    {8, 1, 10}, {8, 10, 3}, {5, 8, 3},  {5, 3, 2},  {2, 3, 7},
                    {7, 3, 10}, {7, 10, 6}, {7, 6, 11}, {11, 6, 0}, {0, 6, 1},
                    {6, 10, 1}, {9, 11, 0}, {9, 2, 11}, {9, 5, 2},  {7, 11, 2}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t i, std::uint32_t j) {
      const auto [place, is_new] =
          middles.try_emplace(std::minmax(i, j), std::uint32_t(mesh.positions.size()));
      if (is_new) {
        mesh.positions.push_back(normalize(mesh.positions[i] + mesh.positions[j]));
      }
      return place->second;
    };
    std::vector<Triangle> finer;
    for (const auto& [i, j, k] : mesh.triangles) {
      const std::uint32_t ij = middle(i, j), jk = middle(j, k), ki = middle(k, i);
      finer.insert(finer.end(), {{i, ij, ki}, {ij, j, jk}, {ki, jk, k}, {ij, jk, ki}});
    }
    mesh.triangles = std::move(finer);
  }
  return mesh;
}

inline Material make_lambert(float albedo) {
  Material material;
  material.name = "lambert";
  material.base_color = Rgb(albedo);
  material.glossy_mix = 0.0F;
  return material;
}

inline Affine3d translation(Vec3d t) {
  return {{}, t};
}

// A black scene with an 8x8 picture, ready for objects and lights.
inline Scene make_empty_scene(Camera camera) {
  Scene scene;
  scene.camera = camera;
  scene.environment = ConstantEnvironment{};
  scene.image.width_px = 8;
  scene.image.height_px = 8;
  scene.image.filter = ImageSettings::Filter::box;
  return scene;
}

inline Object& add_object(Scene& scene, Mesh mesh, const Material& material,
                          const Affine3d& world_from_object = {}) {
  Object object;
  object.name = mesh.name + std::to_string(scene.objects.size());
  object.mesh.index = std::uint32_t(scene.meshes.size());
  object.material.index = std::uint32_t(scene.materials.size());
  object.world_from_object = world_from_object;
  scene.meshes.push_back(std::move(mesh));
  scene.materials.push_back(material);
  scene.objects.push_back(object);
  return scene.objects.back();
}

inline RenderResult render_path(Scene scene, std::uint32_t samples, RenderOptions options = {}) {
  const auto prepared = prepare_scene(std::move(scene));
  options.samples = {0, samples};
  return make_path_renderer()->render(*prepared, options);
}

inline double mean_of(const Image& image) {
  double sum = 0;
  for (const float value : image.values) {
    sum += value;
  }
  return sum / double(image.values.size());
}

}  // namespace arris::test
