#include "io/gltf_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "arris/error.h"
#include "io/gltf_buffers.h"
#include "io/gltf_document.h"
#include "io/gltf_material.h"
#include "io/gltf_mesh.h"
#include "io/mesh_scene.h"
#include "scene/limits.h"
#include "scene/scene_bounds.h"

namespace arris {
namespace {

// Luminous efficacy at 555 nm, by which Blender and the SI unit go from watts to lumens.
constexpr double kLumensPerWatt = 683;

Vec3d unit_or(Vec3d v, Vec3d fallback) {
  const double size = length(v);
  return size > 0 && std::isfinite(size) ? v / size : fallback;
}

// Nodes in depth-first order with their transforms. The document's nodes form trees.
template <class Visit>
void visit_nodes(const GltfDocument& document, Visit&& visit) {
  struct Entry {
    std::uint32_t node;
    Affine3d world_from_node;
  };
  std::vector<Entry> stack;
  const auto push = [&](const std::vector<std::uint32_t>& nodes,
                        const Affine3d& world_from_parent) {
    for (std::size_t i = nodes.size(); i-- > 0;) {
      const std::uint32_t node = nodes[i];
      stack.push_back({node, world_from_parent * document.nodes[node].parent_from_node});
    }
  };
  push(document.roots, {});
  while (!stack.empty()) {
    const Entry entry = stack.back();
    stack.pop_back();
    visit(entry.node, entry.world_from_node);
    push(document.nodes[entry.node].children, entry.world_from_node);
  }
}

class SceneBuilder {
 public:
  SceneBuilder(const GltfDocument& document, std::string where)
      : document_(document), where_(std::move(where)) {}

  void add_materials(GltfMaterials materials) {
    scene_.materials = std::move(materials.materials);
    scene_.textures = std::move(materials.textures);
    add_notes(materials.notes);
  }

  void add_meshes(GltfMeshes meshes) {
    const MaterialId none{std::uint32_t(document_.materials.size())};
    bool none_is_used = scene_.materials.empty();
    for (Mesh& mesh : meshes.meshes) {
      const auto& ids = mesh.triangle_materials;
      none_is_used = none_is_used || std::ranges::find(ids, none) != ids.end();
      mesh_materials_.push_back(ids.empty() ? MaterialId{} : ids.front());
      if (std::ranges::count(ids, mesh_materials_.back()) == std::ptrdiff_t(ids.size())) {
        mesh.triangle_materials.clear();
        mesh.triangle_materials.shrink_to_fit();
      }
    }
    if (none_is_used) {
      scene_.materials.emplace_back();
      scene_.materials.back().name = "default";
    }
    meshes_ = std::move(meshes.meshes);
    add_notes(meshes.notes);
  }

  Scene build() {
    scene_.name = name_from_file(where_);
    scene_.up = {0, 1, 0};
    scene_.rounding = document_.rounding;
    mesh_ids_.resize(meshes_.size());
    visit_nodes(document_, [&](std::uint32_t index, const Affine3d& world_from_node) {
      const GltfNode& node = document_.nodes[index];
      if (!is_finite(world_from_node.translation) ||
          !std::isfinite(determinant(world_from_node.linear))) {
        throw Error(Error::Kind::input, fmt::format("{}: nodes[{}]", where_, index),
                    "the node's transform times its parents' is not finite");
      }
      if (node.mesh) add_object(index, world_from_node);
      if (node.camera) add_camera(document_.cameras[*node.camera], world_from_node);
      if (node.light) add_light(document_.lights[*node.light], world_from_node);
    });
    if (scene_.objects.empty()) {
      throw Error(Error::Kind::input, where_, "the scene has no triangles to show");
    }
    aim_camera();
    add_count(flattened_, "objects with a scale of 0 left out");
    add_count(orthographic_, "orthographic cameras left out");
    add_notes(document_.notes);
    return std::move(scene_);
  }

 private:
  void add_object(std::uint32_t index, const Affine3d& world_from_node) {
    const GltfNode& node = document_.nodes[index];
    const std::uint32_t mesh = *node.mesh;
    if (!mesh_ids_[mesh] && meshes_[mesh].triangles.empty()) return;
    if (!is_invertible(world_from_node.linear)) {
      ++flattened_;
      return;
    }
    if (!mesh_ids_[mesh]) {
      mesh_ids_[mesh] = MeshId{std::uint32_t(scene_.meshes.size())};
      scene_.meshes.push_back(std::move(meshes_[mesh]));
    }
    Object object;
    object.name = node.name.empty() ? document_.meshes[mesh].name : node.name;
    object.mesh = *mesh_ids_[mesh];
    object.material = mesh_materials_[mesh];
    object.world_from_object = world_from_node;
    object.rounding = node.rounding ? node.rounding : document_.meshes[mesh].rounding;
    scene_.objects.push_back(std::move(object));
  }

  // glTF's cameras have a direction. Who turns the view turns it about the target: beside the model's middle.
  void aim_camera() {
    if (!scene_.camera) return;
    Camera& camera = *scene_.camera;
    const Vec3d forward = camera.target - camera.position;
    const double along = dot(world_bounds(scene_).center() - camera.position, forward);
    if (along > 0 && std::isfinite(along)) camera.target = camera.position + forward * along;
  }

  void add_camera(const GltfCamera& from, const Affine3d& world_from_node) {
    if (!from.vertical_fov) ++orthographic_;
    if (!from.vertical_fov || scene_.camera) return;
    Camera camera;
    camera.position = world_from_node.translation;
    camera.target = camera.position + unit_or(-world_from_node.linear.z, {0, 0, -1});
    camera.up = unit_or(world_from_node.linear.y, {0, 1, 0});
    camera.fov_deg = degrees(*from.vertical_fov);
    scene_.camera = camera;
  }

  void add_light(const GltfLight& light, const Affine3d& world_from_node) {
    const Vec3d position = world_from_node.translation;
    const Vec3d direction = unit_or(-world_from_node.linear.z, {0, 0, -1});
    const Rgb radiometric(light.intensity / kLumensPerWatt);
    switch (light.kind) {
      case GltfLightKind::point:
        scene_.lights.emplace_back(PointLight{position, radiometric});
        break;
      case GltfLightKind::spot:
        scene_.lights.emplace_back(
            SpotLight{position, direction, radiometric, light.inner_angle, light.outer_angle});
        break;
      case GltfLightKind::directional:
        scene_.lights.emplace_back(DirectionalLight{direction, radiometric});
        break;
    }
  }

  void add_notes(const std::vector<std::string>& notes) {
    scene_.notes.insert(scene_.notes.end(), notes.begin(), notes.end());
  }
  void add_count(std::size_t count, const char* what) {
    if (count > 0) scene_.notes.push_back(fmt::format("{} {}", count, what));
  }

  const GltfDocument& document_;
  std::string where_;
  Scene scene_;
  std::vector<Mesh> meshes_;                     // by glTF index; moved to the scene when used
  std::vector<MaterialId> mesh_materials_;       // by glTF index: of the first triangle
  std::vector<std::optional<MeshId>> mesh_ids_;  // by glTF index
  std::size_t flattened_ = 0, orthographic_ = 0;
};

}  // namespace

Scene read_gltf(std::span<const std::uint8_t> bytes, const std::string& name,
                const std::optional<std::filesystem::path>& base_folder) {
  GlbParts parts{{reinterpret_cast<const char*>(bytes.data()), bytes.size()}, {}};
  if (is_glb(bytes)) parts = split_glb(bytes, name);
  const GltfDocument document = parse_gltf_document(parts.json, name);
  const GltfBuffers buffers = load_gltf_buffers(document, parts.binary, base_folder, name);
  DecodeBudget budget(buffers.total_bytes + parts.json.size(), name);
  const GltfSource source{document, buffers, budget, name};
  GltfMaterials materials = make_gltf_materials(source, base_folder);
  GltfMeshes meshes = make_gltf_meshes(source, materials.uv_choices);
  SceneBuilder builder(document, name);
  builder.add_materials(std::move(materials));
  builder.add_meshes(std::move(meshes));
  return builder.build();
}

}  // namespace arris
