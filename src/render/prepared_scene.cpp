#include "render/prepared_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <string>

#include "arris/error.h"
#include "base/parallel_for.h"
#include "render/bevel_shader.h"
#include "render/camera.h"
#include "render/meshed_bevels.h"
#include "render/scene_geometry.h"
#include "scene/limits.h"
#include "scene/scene_bounds.h"
#include "scene/validate_placement.h"

namespace arris {
namespace {

void note_vanished_triangles(Scene& scene) {
  std::uint64_t triangles = 0, drawn = 0;
  const Scene& read = scene;
  for (const Object& object : scene.objects) {
    if (object.csg) continue;
    triangles += read.meshes[object.mesh.index].triangles.size();
    drawn += count_drawn_triangles(scene, object);
  }
  if (drawn == triangles) return;
  const std::string note =
      triangles - drawn == 1
          ? "1 triangle has no area and is not drawn"
          : fmt::format("{} triangles have no area and are not drawn", triangles - drawn);
  // A scene that is prepared again says it already.
  if (std::ranges::find(scene.notes, note) == scene.notes.end()) scene.notes.push_back(note);
}

void fill_in(Scene& scene) {
  if (!scene.camera) {
    scene.camera = frame_scene(scene);
  }
  if (!scene.environment) {
    scene.environment = StudioEnvironment{.strength = 1, .up = scene.up};
  }
}

// Bevel meshes have come after the described ones, and into the objects.
bool has_same_meshes(const SceneGeometry& before, const Scene& moved) {
  const std::size_t described = before.meshed.described_meshes;
  if (before.meshed.described_objects.empty()) return moved.meshes.is_same_as(before.scene.meshes);
  return moved.meshes.size() == described &&
         std::equal(moved.meshes.read().begin(), moved.meshes.read().end(),
                    before.scene.meshes.read().begin(), [](const Mesh& a, const Mesh& b) {
                      return a.positions.size() == b.positions.size() &&
                             a.triangles.size() == b.triangles.size();
                    });
}

void check_same_parts(const SceneGeometry& before, const Scene& moved) {
  const Scene& scene = before.scene;
  const std::vector<Object>& objects =
      before.meshed.described_objects.empty() ? scene.objects : before.meshed.described_objects;
  const auto is_same = [](const Object& a, const Object& b) {
    return a.mesh == b.mesh && a.csg == b.csg && a.material == b.material &&
           a.rounding == b.rounding;
  };
  const bool same =
      has_same_meshes(before, moved) && moved.csg_trees.is_same_as(scene.csg_trees) &&
      moved.materials.is_same_as(scene.materials) && moved.textures.is_same_as(scene.textures) &&
      moved.environment == scene.environment && std::ranges::equal(objects, moved.objects, is_same);
  if (same) return;
  throw Error(Error::Kind::input, "",
              "a moved scene has other meshes, solids, materials, textures, objects or environment "
              "than the one that was prepared; change camera, transforms and lights of a copy of "
              "it, or prepare it with prepare_scene()");
}

bool has_same_places(const Scene& a, const Scene& b) {
  return std::ranges::equal(a.objects, b.objects, {}, &Object::world_from_object,
                            &Object::world_from_object);
}

void check_places(const Scene& moved) {
  const std::vector<std::string> problems = validate_placement(moved);
  if (problems.empty()) return;
  throw Error(Error::Kind::input, "", fmt::format("{}", fmt::join(problems, "\n")));
}

void check_reach(const Scene& moved, const std::vector<Bounds>& bounds) {
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    if (bounds[i].is_empty()) continue;
    const Vec3d reach = max(bounds[i].upper, -bounds[i].lower);
    if (max_component(reach) <= kMaxCoordinate) continue;
    throw Error(Error::Kind::input, fmt::format("object \"{}\"", moved.objects[i].name),
                fmt::format("reaches out to {:g}; coordinates can be up to {:g}, scale it down",
                            max_component(reach), kMaxCoordinate));
  }
}

// The bevel shader rounds nothing: a note says what it does.
std::vector<RoundingSummary> shader_summaries(const SceneGeometry& geometry,
                                              const std::vector<BevelShader>& shaders) {
  std::vector<RoundingSummary> summaries;
  for (std::size_t i = 0; i < shaders.size(); ++i) {
    if (!(shaders[i].delta > 0)) continue;
    const Object& object = geometry.scene.objects[geometry.embree.records()[i].object.index];
    RoundingSummary summary;
    summary.object = object.name;
    summary.object_index = geometry.embree.records()[i].object.index;
    summary.notes.push_back(
        {0, "",
         fmt::format(
             "bevel shader of depth {:.4g}: normals bend near edges, the geometry stays sharp",
             shaders[i].delta)});
    summaries.push_back(std::move(summary));
  }
  return summaries;
}

// What was asked for CSG solids, and isn't done.
void add_csg_notes(const Scene& scene, const std::optional<RoundingSettings>& scene_default,
                   std::vector<RoundingSummary>& summaries) {
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    const std::optional<RoundingSettings>& s = object.rounding ? object.rounding : scene_default;
    if (!object.csg || !s || s->method == RoundMethod::none) continue;
    RoundingSummary summary;
    summary.object = object.name;
    summary.object_index = i;
    summary.notes.push_back({0, "", "CSG solids stay sharp: only meshes are rounded"});
    summaries.push_back(std::move(summary));
  }
}

SceneRounding round_scene(const SceneGeometry& geometry,
                          const std::optional<RoundingSettings>& scene_default,
                          const PrepareOptions& options, const SceneRounding* before = nullptr) {
  SceneRounding rounding = make_scene_rounding(
      geometry, scene_default, {options.threads, options.detection, options.stop}, before);
  rounding.shaders = make_bevel_shaders(geometry, scene_default, before);
  add_csg_notes(geometry.scene, scene_default, rounding.summaries);
  return rounding;
}

}  // namespace

PreparedScene::PreparedScene(std::shared_ptr<const SceneGeometry> geometry, SceneRounding rounding)
    : PreparedScene(std::move(geometry),
                    std::make_shared<const SceneRounding>(std::move(rounding))) {}

PreparedScene::PreparedScene(std::shared_ptr<const SceneGeometry> geometry,
                             std::shared_ptr<const SceneRounding> rounding)
    : geometry_(std::move(geometry)),
      shared_rounding_(std::move(rounding)),
      rounding_(*shared_rounding_) {
  const Scene& s = geometry_->scene;
  stats_.build_seconds = geometry_->build_seconds;
  stats_.objects = s.objects.size();
  for (const Object& object : s.objects) {
    stats_.triangles += object.csg ? 0 : s.meshes[object.mesh.index].triangles.size();
  }
  stats_.geometry_bytes = geometry_->embree.bytes() + geometry_->csg.bytes;
  // Bevel meshes count as rounding; their part of the acceleration structure counts as geometry.
  const MeshedBevels& meshed = geometry_->meshed;
  const std::size_t described =
      meshed.described_objects.empty() ? s.meshes.size() : meshed.described_meshes;
  stats_.rounding_bytes = rounding_.bytes;
  for (std::size_t i = 0; i < s.meshes.size(); ++i) {
    (i < described ? stats_.geometry_bytes : stats_.rounding_bytes) += bytes_of(s.meshes[i]);
  }
  stats_.round_seconds = rounding_.seconds + meshed.seconds;
  stats_.rounded_edges = rounding_.edges + meshed.edges;
  stats_.rounded_corners = rounding_.corners + meshed.corners;
  stats_.rounding = rounding_.summaries;
  stats_.rounding.insert(stats_.rounding.end(), meshed.summaries.begin(), meshed.summaries.end());
  const std::vector<RoundingSummary> bent = shader_summaries(*geometry_, rounding_.shaders);
  stats_.rounding.insert(stats_.rounding.end(), bent.begin(), bent.end());
}

PreparedScene::~PreparedScene() = default;

const Scene& PreparedScene::scene() const {
  return geometry_->scene;
}

void check_scene(const Scene& scene, const std::string& where) {
  const std::vector<std::string> problems = validate_scene(scene);
  if (problems.empty()) {
    return;
  }
  std::string text = problems[0];
  for (std::size_t i = 1; i < problems.size(); ++i) {
    text += fmt::format("\n{}{}{}", where, where.empty() ? "" : ": ", problems[i]);
  }
  throw Error(Error::Kind::input, where, text);
}

std::shared_ptr<const PreparedScene> prepare_scene(Scene scene, const PrepareOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  check_scene(scene, "");
  note_vanished_triangles(scene);
  fill_in(scene);
  end_if_stopped(options.stop);
  MeshedBevels meshed = mesh_bevels(scene, scene.rounding, options.threads);
  end_if_stopped(options.stop);
  std::optional<CsgSource> solids;
  if (options.solids_of != nullptr) {
    const SceneGeometry& of = options.solids_of->geometry();
    solids.emplace(CsgSource{of.scene, of.csg});
  }
  auto geometry = std::make_shared<SceneGeometry>(
      std::move(scene),
      EmbreeSceneOptions{
          .threads = options.threads, .placement = options.placement, .stop = options.stop},
      solids ? &*solids : nullptr);
  geometry->build_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() -
      meshed.seconds;
  geometry->meshed = std::move(meshed);
  end_if_stopped(options.stop);
  SceneRounding rounding = round_scene(*geometry, geometry->scene.rounding, options);
  end_if_stopped(options.stop);
  return std::make_shared<const PreparedScene>(std::move(geometry), std::move(rounding));
}

std::shared_ptr<const PreparedScene> prepare_again(const PreparedScene& prepared,
                                                   const RoundingSettings& scene_default,
                                                   const PrepareOptions& options) {
  if (scene_default.method == RoundMethod::mesh ||
      !prepared.geometry().meshed.described_objects.empty()) {
    Scene scene = described_scene(prepared.scene(), prepared.geometry().meshed);
    scene.rounding = scene_default;
    return prepare_scene(std::move(scene), options);
  }
  SceneRounding rounding = round_scene(prepared.geometry(), scene_default, options);
  return std::make_shared<const PreparedScene>(prepared.shared_geometry(), std::move(rounding));
}

std::shared_ptr<const PreparedScene> prepare_moved(const PreparedScene& prepared, Scene moved,
                                                   const PrepareOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  const SceneGeometry& before = prepared.geometry();
  fill_in(moved);
  check_same_parts(before, moved);
  const bool stays = has_same_places(before.scene, moved);
  const bool has_bevel_meshes = !before.meshed.described_objects.empty();
  if (has_bevel_meshes || (!stays && before.embree.placement() == Placement::baked)) {
    moved.rounding = prepared.rounding().scene_default;
    return prepare_scene(std::move(moved), options);
  }
  check_places(moved);
  moved.notes = before.scene.notes;
  std::shared_ptr<const PlacedGeometry> placed =
      stays ? before.placed
            : std::make_shared<const PlacedGeometry>(*before.placed, before.scene, moved);
  check_reach(moved, placed->bounds);
  auto geometry = std::make_shared<SceneGeometry>(before, std::move(moved), std::move(placed));
  geometry->build_seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (stays) return std::make_shared<const PreparedScene>(geometry, prepared.shared_rounding());
  SceneRounding rounding =
      round_scene(*geometry, prepared.rounding().scene_default, options, &prepared.rounding());
  return std::make_shared<const PreparedScene>(std::move(geometry), std::move(rounding));
}

const PrepareStats& prepare_stats(const PreparedScene& prepared) {
  return prepared.stats();
}
const Scene& scene_of(const PreparedScene& prepared) {
  return prepared.scene();
}

}  // namespace arris
