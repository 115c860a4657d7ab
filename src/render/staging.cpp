#include "render/staging.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "render/camera.h"
#include "render/ground_frame.h"
#include "scene/limits.h"
#include "scene/material_presets.h"
#include "scene/scene_bounds.h"

namespace arris {
namespace {

// In the frame's coordinates.
Bounds bounds_in(const Scene& scene, const GroundFrame& frame) {
  Bounds bounds;
  for (const Object& object : scene.objects) {
    visit_positions(scene, object, [&](Vec3d p) {
      bounds.add({dot(p, frame.east), dot(p, frame.north), dot(p, frame.up)});
    });
  }
  return bounds;
}

// Radii of the ground in units of the model's: solid inside, gone at its rim.
constexpr double kSolidRadius = 4, kRimRadius = 24;
// Below the model, so that its underside and the ground don't coincide; too little to be seen.
constexpr double kGroundGap = 2e-4;

// Opaque in the middle, transparent from the rim on; smooth at both ends, so that no ring shows.
Texture make_fade() {
  constexpr int kSide = 512;
  Texture texture;
  texture.name = "ground fade";
  texture.width_px = texture.height_px = kSide;
  texture.wrap_u = texture.wrap_v = Texture::Wrap::clamp;
  for (int y = 0; y < kSide; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const double distance =
          std::hypot(x + 0.5 - kSide / 2.0, y + 0.5 - kSide / 2.0) / (kSide / 2.0) * kRimRadius;
      const double t = std::clamp((kRimRadius - distance) / (kRimRadius - kSolidRadius), 0.0, 1.0);
      const double opacity = t * t * (3 - 2 * t);
      texture.texels.push_back({255, 255, 255, std::uint8_t(std::lround(255 * opacity))});
    }
  }
  return texture;
}

// With this the lit ground is about as bright as the backdrop behind it, so that the two blend: the
// studio's is made for it, and under a white sky the two are nearly the same anyway.
constexpr float kGroundAlbedo = 0.82F;

Material make_ground_material(TextureId fade) {
  Material material;
  material.name = "ground";
  material.base_color = Rgb(kGroundAlbedo);
  material.roughness = 1;
  material.specular = 0;
  material.base_color_texture = fade;
  return material;
}

// Below all objects.
Ground find_ground(const Scene& scene) {
  const GroundFrame frame = make_ground_frame(scene.up);
  const Bounds bounds = bounds_in(scene, frame);
  const double radius = bounds.diagonal() / 2;
  if (!(radius > 0)) return {{}, 0};
  const Vec3d middle = bounds.center();
  return {frame.east * middle.x + frame.north * middle.y +
              frame.up * (bounds.lower.z - kGroundGap * radius),
          kRimRadius * radius};
}

std::uint64_t add_ground(Scene& scene) {
  if (!scene.ground) scene.ground = find_ground(scene);
  const auto [center, radius] = *scene.ground;
  if (!(radius > 0)) {
    scene.ground.reset();
    return 0;
  }
  const GroundFrame frame = make_ground_frame(scene.up);
  Mesh mesh;
  mesh.name = "ground";
  for (const auto& [u, v] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
    mesh.positions.emplace_back(center + frame.east * (u * radius) + frame.north * (v * radius));
    mesh.uvs.push_back({float(u + 1) / 2, float(1 - v) / 2});
  }
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  scene.textures.push_back(make_fade());
  scene.materials.push_back(
      make_ground_material(TextureId{std::uint32_t(scene.textures.size() - 1)}));
  scene.meshes.push_back(std::move(mesh));
  Object object;
  object.name = "ground";
  object.mesh = MeshId{std::uint32_t(scene.meshes.size() - 1)};
  object.material = MaterialId{std::uint32_t(scene.materials.size() - 1)};
  object.rounding = RoundingSettings{};  // none
  scene.objects.push_back(object);
  return 2;
}

void apply_material(Scene& scene, const StageOptions& options) {
  for (Material& each : scene.materials) {
    if (options.material) {
      each = *options.material;
    } else if (options.source == StageOptions::Source::model && is_unset(each)) {
      each = *find_material_preset("plastic-grey");
    }
  }
}

void apply_lighting(Scene& scene, std::optional<Lighting> lighting) {
  if (lighting) {
    scene.lights.clear();
    scene.animation.lights.clear();
    scene.environment = make_environment(*lighting, scene.up);
  } else if (!scene.environment && scene.lights.empty()) {
    scene.environment = make_environment(Lighting::studio, scene.up);
  } else if (!scene.environment) {
    scene.environment = ConstantEnvironment{};
  }
}

void replace_parts(Camera& camera, const CameraOptions& options) {
  camera.position = options.position.value_or(camera.position);
  camera.target = options.target.value_or(camera.target);
  camera.up = options.up.value_or(camera.up);
  camera.fov_deg = options.fov_deg.value_or(camera.fov_deg);
  // A view from straight above has north on top, one from below as well.
  const Vec3d view = camera.target - camera.position;
  const bool along_up = length(cross(view, camera.up)) <= 1e-6 * length(view) * length(camera.up);
  if (!options.up && along_up) camera.up = make_ground_frame(camera.up).north;
}

void apply_camera(Scene& scene, const CameraOptions& options) {
  if (!scene.camera) scene.camera = frame_scene(scene, options.fov_deg.value_or(Camera{}.fov_deg));
  replace_parts(*scene.camera, options);
  for (CameraKey& key : scene.animation.camera) replace_parts(key.camera, options);
}

double reach_of(Vec3d p) {
  return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
}

// How far out what a model gets lies; 0: it gets none.
struct AddedReach {
  double camera = 0, ground = 0;
};

AddedReach added_reach(const Scene& scene, bool framed, bool has_ground) {
  AddedReach reach;
  if (framed) reach.camera = reach_of(scene.camera->position);
  if (!has_ground) return reach;
  for (const Vec3f& p : scene.meshes.back().positions) {
    reach.ground = std::max(reach.ground, reach_of(Vec3d(p)));
  }
  return reach;
}

// It is all in proportion to the model.
std::string problem_with(const AddedReach& added, const Scene& scene) {
  const double reach = std::max(added.camera, added.ground);
  if (reach <= kMaxCoordinate) return "";
  double model = 0;
  const std::size_t objects = scene.objects.size() - (added.ground > 0 ? 1 : 0);
  for (std::size_t i = 0; i < objects; ++i) {
    const Bounds bounds = world_bounds(scene, scene.objects[i]);
    if (!bounds.is_empty())
      model = std::max({model, reach_of(bounds.lower), reach_of(bounds.upper)});
  }
  const double scale = std::floor(kMaxCoordinate / reach * 1000) / 1000;
  return fmt::format(
      "is too large to be framed: it reaches out to {:.4g}, its {} would to {:.4g}, and "
      "coordinates can be up to {:g}; scale it to {:g} of its size or less, or use {}--ground off",
      model, added.camera > added.ground ? "camera" : "ground", reach, kMaxCoordinate, scale,
      added.camera > kMaxCoordinate ? "--camera-position and " : "");
}

}  // namespace

Environment make_environment(Lighting lighting, Vec3d up) {
  switch (lighting) {
    case Lighting::studio:
      return StudioEnvironment{.strength = 1, .up = up};
    case Lighting::sky: {
      const GroundFrame frame = make_ground_frame(up);
      SkyEnvironment sky;
      sky.up = up;
      sky.sun_direction = frame.north * -0.5 - frame.east * 0.45 + frame.up * 0.75;
      return sky;
    }
    case Lighting::white:
      return ConstantEnvironment{Rgb(1.0F)};
  }
  return ConstantEnvironment{};
}

StagingReport stage_model(Scene& scene, const StageOptions& options) {
  const bool is_model = options.source == StageOptions::Source::model;
  const bool has_camera = scene.camera.has_value();
  if (!has_camera && options.camera.up) scene.up = *options.camera.up;
  apply_material(scene, options);
  apply_lighting(scene, options.lighting);
  if (is_model && options.rounded && !scene.rounding) {
    RoundingSettings automatic;
    automatic.method = RoundMethod::exact;
    scene.rounding = automatic;
  }
  apply_camera(scene, options.camera);
  StagingReport report;
  const bool has_ground =
      options.ground.value_or(scene.ground.has_value() || (is_model && !has_camera));
  if (has_ground) {
    report.ground_triangles = add_ground(scene);
  } else {
    scene.ground.reset();
  }
  const bool framed = !has_camera && !options.camera.position;
  report.problem = problem_with(added_reach(scene, framed, report.ground_triangles > 0), scene);
  return report;
}

}  // namespace arris
