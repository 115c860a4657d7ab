#include "scene/scene_fingerprint.h"

#include <array>
#include <cstring>
#include <span>
#include <type_traits>

namespace arris {
namespace {

// FNV-1a over eight bytes at a time, then mixed: speed matters, geometry has many bytes.
class Fingerprint {
 public:
  template <class Number>
  requires std::is_arithmetic_v<Number> || std::is_enum_v<Number>
  void add(Number value) {
    std::uint64_t word = 0;
    std::memcpy(&word, &value, sizeof(value));
    add_word(word);
  }
  template <class T>
  void add(const Vec3<T>& v) {
    add(v.x);
    add(v.y);
    add(v.z);
  }
  template <class Tag>
  void add(Id<Tag> id) {
    add(id.index);
  }
  template <class T>
  void add(const std::optional<T>& value) {
    add(value.has_value());
    if (value) add(*value);
  }
  template <class T, std::size_t N>
  void add(const std::array<T, N>& values) {
    for (const T& value : values) add(value);
  }
  // Elements without padding bytes.
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void add(const std::vector<T>& values) {
    add(values.size());
    std::span<const std::byte> bytes = std::as_bytes(std::span(values));
    for (; bytes.size() >= 8; bytes = bytes.subspan(8)) {
      std::uint64_t word = 0;
      std::memcpy(&word, bytes.data(), 8);
      add_word(word);
    }
    for (const std::byte byte : bytes) add_word(std::uint64_t(byte));
  }

  void add(const Mesh& mesh) {
    add(mesh.positions);
    add(mesh.triangles);
    add(mesh.normals);
    add(mesh.uvs);
    add(mesh.triangle_materials);
    if (mesh.sharp_edges) add(*mesh.sharp_edges);
    add(mesh.edge_radii);
  }
  void add(const Texture& texture) {
    add(texture.width_px);
    add(texture.height_px);
    add(texture.texels);
    add(texture.srgb);
    add(texture.wrap_u);
    add(texture.wrap_v);
  }
  void add(const Material& m) {
    add(m.base_color);
    for (const float value : {m.metallic, m.roughness, m.ior, m.specular, m.transmission,
                              m.clearcoat, m.clearcoat_roughness, m.opacity, m.normal_scale}) {
      add(value);
    }
    add(m.specular_color);
    add(m.emission);
    add(m.alpha_cutoff);
    add(m.glossy_mix);
    for (const auto& texture :
         {m.base_color_texture, m.metallic_roughness_texture, m.emission_texture, m.normal_texture,
          m.transmission_texture, m.clearcoat_texture, m.clearcoat_roughness_texture}) {
      add(texture);
    }
  }
  void add(const Affine3d& m) {
    add(m.linear.x);
    add(m.linear.y);
    add(m.linear.z);
    add(m.translation);
  }
  void add(const RoundingSettings& r) {
    add(r.method);
    add(r.radius.index());
    if (const auto* radius = std::get_if<double>(&r.radius)) add(*radius);
    if (const auto* share = std::get_if<PercentOfInradius>(&r.radius)) add(share->percent);
    add(r.edges);
    add(r.min_angle);
    add(r.subdivisions);
    add(r.shader.delta);
    add(r.shader.perturb);
    add(r.shader.divisions);
    add(r.on_overlap);
    add_each(r.rules);
  }
  void add(const EdgeRule& rule) {
    add(rule.radius);
    add(rule.is_part);
    add(rule.turn);
    add(rule.kind);
    add(rule.box);
    add(rule.segments);
  }
  // Its points follow each other without padding.
  void add(const CsgRegion& region) { add_each(region.outlines); }
  void add(const CsgSphere& sphere) { add(sphere.radius); }
  void add(const CsgBox& box) {
    add(box.low);
    add(box.high);
  }
  void add(const CsgCone& cone) {
    for (const double value : {cone.z_low, cone.z_high, cone.radius_low, cone.radius_high}) {
      add(value);
    }
  }
  void add(const CsgTorus& torus) {
    add(torus.ring_radius);
    add(torus.tube_radius);
  }
  void add(const CsgHalfSpace& half_space) {
    add(half_space.normal);
    add(half_space.d);
  }
  void add(const CsgPolyhedron& polyhedron) {
    add_each(polyhedron.faces);
    add(polyhedron.vertices);
  }
  void add(const CsgMesh& mesh) {
    add(mesh.vertices);
    add(mesh.triangles);
  }
  void add(const CsgPrism& prism) {
    add(prism.region);
    for (const double value : {prism.z_low, prism.z_high, prism.scale_high.x, prism.scale_high.y}) {
      add(value);
    }
  }
  void add(const CsgRevolution& revolution) { add(revolution.region); }
  void add(const CsgRounded& rounded) {
    add(rounded.core);
    add(rounded.radius);
  }
  void add(const CsgLeaf& leaf) {
    add(leaf.primitive);
    add(leaf.object_from_primitive);
    add(leaf.material);
  }
  void add(const CsgNode& node) {
    add(node.leaf);
    add(node.operation);
    add(node.children);
  }
  void add(const CsgTree& tree) {
    add_each(tree.nodes);
    add_each(tree.leaves);
  }
  void add(const Object& object) {
    add(object.mesh);
    add(object.csg);
    add(object.material);
    add(object.world_from_object);
    add(object.rounding);
    add(object.auto_radius);
  }
  void add(const Camera& camera) {
    add(camera.position);
    add(camera.target);
    add(camera.up);
    add(camera.fov_deg);
  }

  void add(const PointLight& light) {
    add(light.position);
    add(light.intensity);
  }
  void add(const SpotLight& light) {
    add(light.position);
    add(light.direction);
    add(light.intensity);
    add(light.inner_angle);
    add(light.outer_angle);
  }
  void add(const DirectionalLight& light) {
    add(light.direction);
    add(light.irradiance);
  }
  void add(const AreaLight& light) {
    add(light.corner);
    add(light.edge_u);
    add(light.edge_v);
    add(light.radiance);
    add(light.visible_to_camera);
  }
  void add(const ConstantEnvironment& environment) { add(environment.radiance); }
  void add(const SkyEnvironment& environment) {
    add(environment.sun_direction);
    add(environment.turbidity);
    add(environment.strength);
    add(environment.sun);
    add(environment.up);
  }
  void add(const HdrEnvironment& environment) {
    add(environment.width_px);
    add(environment.height_px);
    add(environment.radiance.read());
    add(environment.strength);
    add(environment.rotation);
    add(environment.up);
  }
  void add(const StudioEnvironment& environment) {
    add(environment.strength);
    add(environment.rotation);
    add(environment.up);
  }
  template <class... Kinds>
  void add(const std::variant<Kinds...>& value) {
    add(value.index());
    std::visit([&](const auto& kind) { add(kind); }, value);
  }
  template <class T>
  void add_each(const std::vector<T>& values) {
    add(values.size());
    for (const T& value : values) add(value);
  }

  [[nodiscard]] std::uint64_t value() const { return state_; }

 private:
  void add_word(std::uint64_t word) {
    constexpr std::uint64_t kPrime = 0x100000001B3;
    state_ = (state_ ^ word) * kPrime;
    state_ ^= state_ >> 29U;
  }

  std::uint64_t state_ = 0xCBF29CE484222325;
};

}  // namespace

std::uint64_t scene_fingerprint(const Scene& scene) {
  Fingerprint fingerprint;
  fingerprint.add_each(scene.meshes.read());
  fingerprint.add_each(scene.csg_trees.read());
  fingerprint.add_each(scene.materials.read());
  fingerprint.add_each(scene.textures.read());
  fingerprint.add_each(scene.objects);
  fingerprint.add_each(scene.lights);
  fingerprint.add(scene.camera);
  fingerprint.add(scene.environment);
  fingerprint.add(scene.rounding);
  fingerprint.add(scene.image.width_px);
  fingerprint.add(scene.image.height_px);
  fingerprint.add(scene.image.max_depth);
  fingerprint.add(scene.image.filter);
  return fingerprint.value();
}

}  // namespace arris
