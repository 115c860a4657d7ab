// gltf_document.h — a glTF 2.0 file's JSON as plain structs
// What       parse_gltf_document() reads the parts that Arris uses and checks their types, ranges and
//            references; what the numbers point to in the buffers is checked by gltf_buffers.h
// Guarantee  every index in the result is inside the array it refers to; the node graph is a forest;
//            all numbers are finite. Work and memory are linear in the text.
// Errors     kind input, with the JSON path: `part.gltf: meshes[3].primitives[0].indices: …`
// Source     Khronos, glTF 2.0 Specification (2021), and its KHR extensions (kGltfExtensions in the .cpp)
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "arris/scene.h"

namespace arris {

enum class GltfComponent : std::uint8_t { i8, u8, i16, u16, u32, f32 };

struct GltfBuffer {
  std::optional<std::string> uri;  // empty: the GLB's binary chunk
  std::uint64_t byte_length = 0;
};

struct GltfBufferView {
  std::uint32_t buffer = 0;
  std::uint64_t offset = 0, length = 0;
  std::uint32_t stride = 0;  // 0: elements are packed
};

struct GltfSparse {
  std::uint64_t count = 0;
  std::uint32_t index_view = 0, value_view = 0;
  std::uint64_t index_offset = 0, value_offset = 0;
  GltfComponent index_component = GltfComponent::u16;
};

struct GltfAccessor {
  std::optional<std::uint32_t> view;  // empty: zeros
  std::uint64_t offset = 0, count = 0;
  GltfComponent component = GltfComponent::f32;
  int components = 1;  // 1 to 4; 0 for matrices, which no mesh uses
  bool normalized = false;
  std::optional<GltfSparse> sparse;
};

struct GltfImage {
  std::string name;
  std::optional<std::string> uri;
  std::optional<std::uint32_t> view;
};

struct GltfTexture {
  std::uint32_t image = 0;
  Texture::Wrap wrap_u = Texture::Wrap::repeat, wrap_v = Texture::Wrap::repeat;
};

// KHR_texture_transform: uv' = offset + rotate(scale * uv).
struct GltfUvTransform {
  Vec2d offset;
  Vec2d scale{1, 1};
  double rotation = 0;
  friend bool operator==(const GltfUvTransform&, const GltfUvTransform&) = default;
};

struct GltfTextureUse {
  std::uint32_t texture = 0;
  std::uint32_t uv_set = 0;
  GltfUvTransform transform;
};

enum class GltfSlot : std::uint8_t {
  base_color,
  metallic_roughness,
  emission,
  normal,
  transmission,
  clearcoat,
  clearcoat_roughness,
};
inline constexpr std::size_t kGltfSlotCount = 7;

struct GltfMaterial {
  Material factors;    // all but the textures
  bool opaque = true;  // alphaMode OPAQUE: the texture's alpha means nothing
  std::array<std::optional<GltfTextureUse>, kGltfSlotCount> textures;  // by GltfSlot
};

enum class GltfMode : std::uint8_t { points, lines, triangles, triangle_strip, triangle_fan };

struct GltfPrimitive {
  std::uint32_t position = 0;
  std::optional<std::uint32_t> normal;
  std::vector<std::uint32_t> uv_sets;   // TEXCOORD_0, 1, …: accessors
  std::optional<std::uint32_t> radius;  // _ARRIS_RADIUS
  std::optional<std::uint32_t> indices;
  std::optional<std::uint32_t> material;
  GltfMode mode = GltfMode::triangles;
};

struct GltfMesh {
  std::string name;
  std::vector<GltfPrimitive> primitives;
  std::optional<RoundingSettings> rounding;  // extras.arris_radius
};

struct GltfNode {
  std::string name;
  std::vector<std::uint32_t> children;
  std::optional<std::uint32_t> mesh, camera, light;
  Affine3d parent_from_node;
  std::optional<RoundingSettings> rounding;
};

// Looks along -Z with +Y up; empty: orthographic.
struct GltfCamera {
  std::optional<double> vertical_fov;
};

enum class GltfLightKind : std::uint8_t { point, spot, directional };
struct GltfLight {
  GltfLightKind kind = GltfLightKind::point;
  Vec3d intensity{1, 1, 1};  // colour × candela, or × lux if directional
  double inner_angle = 0, outer_angle = kPi / 4;
};

struct GltfDocument {
  std::vector<GltfBuffer> buffers;
  std::vector<GltfBufferView> views;
  std::vector<GltfAccessor> accessors;
  std::vector<GltfImage> images;
  std::vector<GltfTexture> textures;
  std::vector<GltfMaterial> materials;
  std::vector<GltfMesh> meshes;
  std::vector<GltfNode> nodes;
  std::vector<std::uint32_t> roots;  // of the scene to show
  std::vector<GltfCamera> cameras;
  std::vector<GltfLight> lights;
  std::optional<RoundingSettings> rounding;  // extras.arris_radius of the scene, else of asset
  std::vector<std::string> notes;            // what was left out
};

GltfDocument parse_gltf_document(std::string_view json_text, const std::string& where);

}  // namespace arris
