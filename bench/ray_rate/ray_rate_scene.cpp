#include "ray_rate/ray_rate_scene.h"

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "arris/io.h"
#include "base/hash.h"

namespace arris::bench {
namespace {

constexpr double kBrickWidth = 1.6, kBrickHeight = 0.96, kKnobRadius = 0.24, kKnobHeight = 0.18;

void add_prism(Mesh& mesh, int sides, Vec3d base, double radius, double height) {
  const auto first = std::uint32_t(mesh.positions.size());
  const auto n = std::uint32_t(sides);
  for (std::uint32_t i = 0; i < 2 * n; ++i) {
    const double angle = 2 * kPi * (i % n) / sides;
    mesh.positions.push_back(Vec3f(
        base + Vec3d(radius * std::cos(angle), radius * std::sin(angle), i < n ? 0 : height)));
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t a = first + i, b = first + (i + 1) % n;
    mesh.triangles.insert(mesh.triangles.end(), {{a, b, b + n}, {a, b + n, a + n}});
    if (i > 1) {
      mesh.triangles.push_back({first + n, first + n + i - 1, first + n + i});
    }
  }
}

void add_box(Mesh& mesh, Vec3d half) {
  const auto first = std::uint32_t(mesh.positions.size());
  for (int i = 0; i < 8; ++i) {
    mesh.positions.push_back(
        Vec3f(Vec3d((i & 1) != 0 ? half.x : -half.x, (i & 2) != 0 ? half.y : -half.y,
                    (i & 4) != 0 ? half.z : -half.z)));
  }
  constexpr Triangle kSides[] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                 {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  for (const Triangle& t : kSides) {
    mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
}

Mesh make_brick() {
  Mesh mesh;
  mesh.name = "brick";
  add_box(mesh, {kBrickWidth / 2 - 0.01, kBrickWidth - 0.01, kBrickHeight / 2 - 0.005});
  for (int i = 0; i < 8; ++i) {
    const Vec3d base{(i % 2 - 0.5) * 0.8, (i / 2 - 1.5) * 0.8, kBrickHeight / 2 - 0.005};
    add_prism(mesh, 16, base, kKnobRadius, kKnobHeight);
  }
  return mesh;
}

Material make_plastic(Rgb color) {
  Material material;
  material.base_color = color;
  material.roughness = 0.2F;
  material.glossy_mix = 0.1F;
  return material;
}

// In [0, 1), from a counter.
double random_number(std::uint32_t& counter) {
  return double(hash_bits(++counter)) * 0x1p-32;
}

void stack_bricks(Scene& scene) {
  constexpr int kColumns = 18, kRows = 14, kBricks = 726;
  std::uint32_t counter = 0;
  std::vector<int> heights(kColumns * kRows, 1);
  for (int left = kBricks - kColumns * kRows; left > 0;) {
    int& height = heights[std::size_t(random_number(counter) * kColumns * kRows)];
    if (height < 6) {
      ++height;
      --left;
    }
  }
  for (int column = 0; column < kColumns * kRows; ++column) {
    for (int level = 0; level < heights[std::size_t(column)]; ++level) {
      const double angle = radians(10 * random_number(counter) - 5);
      Object object;
      object.name = "brick";
      object.material.index = std::uint32_t(random_number(counter) * 5);
      object.world_from_object.linear = {
          {std::cos(angle), std::sin(angle), 0}, {-std::sin(angle), std::cos(angle), 0}, {0, 0, 1}};
      object.world_from_object.translation = {
          (column % kColumns - 8.5) * 1.95 + 0.08 * random_number(counter),
          (column / kColumns - 6.5) * 3.45 + 0.08 * random_number(counter),
          kBrickHeight * (0.5 + level)};
      scene.objects.push_back(object);
    }
  }
}

void add_ground(Scene& scene) {
  Mesh mesh;
  mesh.name = "ground";
  mesh.positions = {{-80, -80, 0}, {80, -80, 0}, {80, 80, 0}, {-80, 80, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  Object ground;
  ground.name = "ground";
  ground.mesh.index = std::uint32_t(scene.meshes.size());
  ground.material.index = std::uint32_t(scene.materials.size());
  scene.meshes.push_back(mesh);
  scene.materials.push_back(make_plastic(Rgb(0.5F)));
  scene.objects.push_back(ground);
}

void set_image(Scene& scene) {
  scene.image.width_px = 960;
  scene.image.height_px = 540;
  scene.image.max_depth = 8;
  scene.image.filter = ImageSettings::Filter::box;
}

Vec3d to_vector(const nlohmann::json& j) {
  return {j.at(0), j.at(1), j.at(2)};
}

void apply_description(Scene& scene, const nlohmann::json& j) {
  const nlohmann::json& place = j.at("y_up_as_in_glb_and_obj");
  Camera camera;
  camera.position = to_vector(place.at("camera").at("position"));
  camera.target = to_vector(place.at("camera").at("target"));
  camera.up = to_vector(place.at("camera").at("up"));
  camera.fov_deg = place.at("camera").at("vertical_fov_deg");
  scene.camera = camera;
  const nlohmann::json& light = place.at("area_light");
  const Vec3d corner = to_vector(light.at("corners").at(0));
  AreaLight area{.corner = corner,
                 .edge_u = to_vector(light.at("corners").at(1)) - corner,
                 .edge_v = to_vector(light.at("corners").at(3)) - corner,
                 .radiance = Rgb(light.at("radiance").get<float>()),
                 .visible_to_camera = false};
  if (dot(cross(area.edge_u, area.edge_v), to_vector(light.at("normal"))) < 0) {
    std::swap(area.edge_u, area.edge_v);
  }
  scene.lights = {area};
  scene.environment = ConstantEnvironment{Rgb(to_vector(j.at("sky").at("radiance")))};
  for (Material& material : scene.materials) {
    material.glossy_mix = j.at("materials").at("w").get<float>();
    material.roughness = j.at("materials").at("blender_roughness").get<float>();
  }
}

}  // namespace

Scene make_blocks_scene() {
  Scene scene;
  scene.name = "blocks";
  scene.meshes.push_back(make_brick());
  for (const Rgb color : {Rgb(0.7F, 0.1F, 0.08F), Rgb(0.08F, 0.25F, 0.62F), Rgb(0.8F, 0.62F, 0.1F),
                          Rgb(0.12F, 0.45F, 0.16F), Rgb(0.75F, 0.75F, 0.72F)}) {
    scene.materials.push_back(make_plastic(color));
  }
  stack_bricks(scene);
  add_ground(scene);
  Camera camera;
  camera.position = {17, -34, 20};
  camera.target = {0.3, -2.5, 0.3};
  camera.fov_deg = 34;
  scene.camera = camera;
  scene.lights.push_back(AreaLight{.corner = {-33.660316, -22.346609, 28.348049},
                                   .edge_u = {11.313703, -11.313707, 0},
                                   .edge_v = {8.006930, 8.006935, 11.303902},
                                   .radiance = Rgb(21.484375F),
                                   .visible_to_camera = false});
  AreaLight& light = std::get<AreaLight>(scene.lights[0]);
  if (cross(light.edge_u, light.edge_v).z > 0) {
    std::swap(light.edge_u, light.edge_v);
  }
  scene.environment = ConstantEnvironment{{0.217F, 0.259F, 0.35F}};
  set_image(scene);
  return scene;
}

Scene load_measured_scene(const std::string& path) {
  Scene scene = load_scene(path);
  const std::filesystem::path description = std::filesystem::path(path).replace_extension(".json");
  if (std::ifstream file(description); file) {
    apply_description(scene, nlohmann::json::parse(file));
  }
  set_image(scene);
  return scene;
}

}  // namespace arris::bench
