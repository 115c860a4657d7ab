#include "render/prepared_scene.h"

#include <chrono>
#include <numeric>
#include <string>

#include "arris/error.h"
#include "render/camera.h"
#include "render/scene_geometry.h"

namespace arris {
namespace {

void throw_if_invalid(const Scene& scene) {
  const std::vector<std::string> problems = validate_scene(scene);
  if (problems.empty()) {
    return;
  }
  std::string text;
  for (const std::string& problem : problems) {
    text += (text.empty() ? "" : "\n") + problem;
  }
  throw Error(Error::Kind::input, "", text);
}

}  // namespace

PreparedScene::PreparedScene(std::shared_ptr<const SceneGeometry> geometry, SceneRounding rounding)
    : geometry_(std::move(geometry)), rounding_(std::move(rounding)) {
  const Scene& s = geometry_->scene;
  stats_.build_seconds = geometry_->build_seconds;
  stats_.objects = s.objects.size();
  for (const Object& object : s.objects) {
    stats_.triangles += s.meshes[object.mesh.index].triangles.size();
  }
  stats_.geometry_bytes = geometry_->embree.bytes();
  for (const Mesh& mesh : s.meshes) {
    stats_.geometry_bytes += mesh.positions.size() * sizeof(Vec3f) +
                             mesh.normals.size() * sizeof(Vec3f) + mesh.uvs.size() * sizeof(Vec2f) +
                             mesh.triangles.size() * sizeof(Triangle) +
                             mesh.triangle_materials.size() * sizeof(MaterialId);
  }
  stats_.round_seconds = rounding_.seconds;
  stats_.rounded_edges = rounding_.edges;
  stats_.rounded_corners = rounding_.corners;
  stats_.rounding_bytes = rounding_.bytes;
  stats_.rounding = rounding_.summaries;
}

PreparedScene::~PreparedScene() = default;

const Scene& PreparedScene::scene() const {
  return geometry_->scene;
}

std::shared_ptr<const PreparedScene> prepare_scene(Scene scene, const PrepareOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  throw_if_invalid(scene);
  if (!scene.camera) {
    scene.camera = frame_scene(scene);
  }
  if (!scene.environment) {
    scene.environment = StudioEnvironment{.strength = 1, .up = scene.up};
  }
  auto geometry = std::make_shared<SceneGeometry>(std::move(scene),
                                                  EmbreeSceneOptions{.threads = options.threads});
  geometry->build_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  SceneRounding rounding = make_scene_rounding(*geometry, geometry->scene.rounding,
                                               {options.threads, options.detection});
  return std::make_shared<const PreparedScene>(std::move(geometry), std::move(rounding));
}

std::shared_ptr<const PreparedScene> prepare_again(const PreparedScene& prepared,
                                                   const RoundingSettings& scene_default,
                                                   const PrepareOptions& options) {
  SceneRounding rounding =
      make_scene_rounding(prepared.geometry(), scene_default, {options.threads, options.detection});
  return std::make_shared<const PreparedScene>(prepared.shared_geometry(), std::move(rounding));
}

const PrepareStats& prepare_stats(const PreparedScene& prepared) {
  return prepared.stats();
}
const Scene& scene_of(const PreparedScene& prepared) {
  return prepared.scene();
}

}  // namespace arris
