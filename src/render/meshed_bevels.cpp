#include "render/meshed_bevels.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <tuple>
#include <utility>

#include "base/parallel_for.h"
#include "render/scene_rounding.h"
#include "rounding/bevel_mesh.h"

namespace arris {
namespace {

// The mesh with the transform's linear part applied.
Mesh transformed_mesh(const Mesh& mesh, const Mat3d& linear) {
  Mesh out = mesh;
  const Affine3d m{linear, {}};
  for (Vec3f& p : out.positions) p = Vec3f(transform_point(m, Vec3d(p)));
  const bool mirrored = determinant(linear) < 0;
  for (Vec3f& n : out.normals) n = Vec3f(normalize(transform_normal(m, Vec3d(n))));
  if (mirrored) {
    for (Triangle& t : out.triangles) std::swap(t[1], t[2]);
  }
  return out;
}

// One bevel mesh to be built, and the objects that use it.
struct Task {
  std::uint32_t object = 0;  // the first that needs it
  RoundingOptions options;
  int subdivisions = 1;
  std::optional<double> scale;  // of a similarity; empty: in world axes
  std::vector<std::uint32_t> users;
  BevelMesh result;
};

class Mesher {
 public:
  Mesher(Scene& scene, const std::optional<RoundingSettings>& scene_default, int threads)
      : scene_(scene), default_(scene_default), threads_(threads) {}

  MeshedBevels make() {
    const auto start = std::chrono::steady_clock::now();
    collect_tasks();
    if (tasks_.empty()) return {};
    out_.described_objects = scene_.objects;
    out_.described_meshes = scene_.meshes.size();
    parallel_for(tasks_.size(), {.grain = 1, .threads = threads_},
                 [&](std::size_t i) { build(tasks_[i]); });
    for (Task& task : tasks_) attach(task);
    out_.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return std::move(out_);
  }

 private:
  // Read only, so that nothing is copied.
  [[nodiscard]] const Mesh& mesh_of(const Object& object) const {
    return std::as_const(scene_).meshes[object.mesh.index];
  }
  [[nodiscard]] const RoundingSettings* settings_of(const Object& object) const {
    if (object.rounding) return &*object.rounding;
    return default_ ? &*default_ : nullptr;
  }

  void collect_tasks() {
    std::vector<double> radii(scene_.objects.size(), 0);
    parallel_for(radii.size(), {.grain = 8, .threads = threads_}, [&](std::size_t i) {
      const Object& object = scene_.objects[i];
      const RoundingSettings* const s = settings_of(object);
      if (s == nullptr || s->method != RoundMethod::mesh) return;
      if (object.csg || mesh_of(object).triangles.empty()) return;
      radii[i] = resolve_radius(scene_, object, *s);
    });
    std::map<std::tuple<std::uint32_t, double, RoundEdges, double, int>, std::size_t> shared;
    for (std::uint32_t i = 0; i < radii.size(); ++i) {
      if (!(radii[i] > 0)) continue;
      const Object& object = scene_.objects[i];
      const RoundingSettings& s = *settings_of(object);
      Task task;
      task.object = i;
      task.subdivisions = std::max(1, s.subdivisions);
      task.options.radius = radii[i];
      task.options.edges = s.edges;
      task.options.min_angle = s.min_angle;
      task.options.too_large =
          std::holds_alternative<AutoRadius>(s.radius) ? TooLarge::leave_sharp : TooLarge::error;
      task.scale = similarity_scale(object.world_from_object.linear);
      if (task.scale) {
        task.options.radius /= *task.scale;
        const auto [at, is_new] = shared.try_emplace(
            {object.mesh.index, task.options.radius, s.edges, s.min_angle, task.subdivisions},
            tasks_.size());
        if (!is_new) {
          tasks_[at->second].users.push_back(i);
          continue;
        }
      }
      task.users.push_back(i);
      tasks_.push_back(std::move(task));
    }
  }

  void build(Task& task) const {
    const Object& object = scene_.objects[task.object];
    const Mesh& mesh = mesh_of(object);
    const std::string place = "object \"" + object.name + "\"";
    task.result = task.scale
                      ? make_bevel_mesh(mesh, task.options, task.subdivisions, place)
                      : make_bevel_mesh(transformed_mesh(mesh, object.world_from_object.linear),
                                        task.options, task.subdivisions, place);
  }

  void attach(Task& task) {
    const MeshId mesh{std::uint32_t(scene_.meshes.size())};
    scene_.meshes.push_back(std::move(task.result.mesh));
    for (const std::uint32_t i : task.users) {
      Object& object = scene_.objects[i];
      object.mesh = mesh;
      if (!task.scale) object.world_from_object.linear = {};
      out_.edges += task.result.rounded_edges;
      out_.corners += task.result.rounded_corners;
      out_.summaries.push_back({object.name,
                                i,
                                task.options.radius * task.scale.value_or(1),
                                task.result.rounded_edges,
                                task.result.rounded_corners,
                                task.result.notes,
                                {}});
    }
  }

  Scene& scene_;
  const std::optional<RoundingSettings>& default_;
  int threads_;
  std::vector<Task> tasks_;
  MeshedBevels out_;
};

}  // namespace

MeshedBevels mesh_bevels(Scene& scene, const std::optional<RoundingSettings>& scene_default,
                         int threads) {
  return Mesher(scene, scene_default, threads).make();
}

Scene described_scene(Scene scene, const MeshedBevels& meshed) {
  if (meshed.described_objects.empty()) return scene;
  scene.objects = meshed.described_objects;
  scene.meshes.resize(meshed.described_meshes);
  return scene;
}

std::uint64_t bytes_of(const Mesh& mesh) {
  const auto of = [](const auto& v) { return v.size() * sizeof(v[0]); };
  return of(mesh.positions) + of(mesh.normals) + of(mesh.uvs) + of(mesh.triangles) +
         of(mesh.triangle_materials);
}

}  // namespace arris
