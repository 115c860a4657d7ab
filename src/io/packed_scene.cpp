#include "io/packed_scene.h"

#include <array>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

#include "arris/error.h"

namespace arris {
namespace {

// To be changed with what follows it.
constexpr std::array<char, 16> kMark = {'a', 'r', 'r', 'i', 's', ' ', 'p', 'a',
                                        'c', 'k', 'e', 'd', ' ', '0', '0', '2'};

class Packer {
 public:
  template <class T>
  void put(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    put_bytes(&value, sizeof(T));
  }
  template <class T>
  void put_all(const std::vector<T>& values) {
    static_assert(std::is_trivially_copyable_v<T>);
    put(std::uint64_t(values.size()));
    put_bytes(values.data(), values.size() * sizeof(T));
  }
  void put_text(std::string_view text) {
    put(std::uint64_t(text.size()));
    put_bytes(text.data(), text.size());
  }

  std::vector<std::uint8_t> bytes;

 private:
  void put_bytes(const void* data, std::size_t size) {
    const auto* const first = static_cast<const std::uint8_t*>(data);
    bytes.insert(bytes.end(), first, first + size);
  }
};

class Unpacker {
 public:
  explicit Unpacker(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  template <class T>
  T take() {
    static_assert(std::is_trivially_copyable_v<T>);
    T value{};
    std::memcpy(&value, take_bytes(1, sizeof(T)), sizeof(T));
    return value;
  }
  template <class T>
  std::vector<T> take_all() {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto count = take<std::uint64_t>();
    const std::uint8_t* const data = take_bytes(count, sizeof(T));
    std::vector<T> values(count);
    if (count > 0) std::memcpy(values.data(), data, count * sizeof(T));
    return values;
  }
  std::string take_text() {
    const auto size = take<std::uint64_t>();
    return {reinterpret_cast<const char*>(take_bytes(size, 1)), size};
  }
  // Each thing takes more than a byte.
  std::uint64_t take_count() {
    const auto count = take<std::uint64_t>();
    if (count > bytes_.size()) fail();
    return count;
  }

  void expect(const std::array<char, 16>& mark) {
    if (take<std::array<char, 16>>() != mark) fail();
  }
  void expect_end() const {
    if (!bytes_.empty()) fail();
  }

 private:
  const std::uint8_t* take_bytes(std::uint64_t count, std::size_t size) {
    if (count > bytes_.size() / size) fail();
    const std::uint8_t* const first = bytes_.data();
    bytes_ = bytes_.subspan(count * size);
    return first;
  }
  [[noreturn]] static void fail() {
    throw Error(Error::Kind::failed, "",
                "arris-step handed on no scene that this program understands; install both from "
                "one build");
  }

  std::span<const std::uint8_t> bytes_;
};

}  // namespace

std::vector<std::uint8_t> pack_scene(const Scene& scene) {
  Packer packer;
  packer.put(kMark);
  packer.put(std::uint64_t(scene.materials.size()));
  for (const Material& material : scene.materials.read()) {
    packer.put_text(material.name);
    packer.put(material.base_color);
    packer.put(material.opacity);
  }
  packer.put(std::uint64_t(scene.meshes.size()));
  for (const Mesh& mesh : scene.meshes.read()) {
    packer.put_text(mesh.name);
    packer.put_all(mesh.positions);
    packer.put_all(mesh.triangles);
    packer.put_all(mesh.normals);
    packer.put_all(mesh.triangle_materials);
    packer.put(std::uint8_t(mesh.sharp_edges ? 1 : 0));
    packer.put_all(mesh.sharp_edges.value_or(std::vector<VertexPair>()));
    packer.put_all(mesh.edge_radii);
  }
  packer.put(std::uint64_t(scene.objects.size()));
  for (const Object& object : scene.objects) {
    packer.put_text(object.name);
    packer.put(object.mesh);
    packer.put(object.material);
    packer.put(object.world_from_object);
  }
  packer.put(std::uint64_t(scene.notes.size()));
  for (const std::string& note : scene.notes) packer.put_text(note);
  return std::move(packer.bytes);
}

Scene unpack_scene(std::span<const std::uint8_t> bytes) {
  Unpacker unpacker(bytes);
  Scene scene;
  unpacker.expect(kMark);
  for (std::uint64_t n = unpacker.take_count(); n > 0; --n) {
    Material& material = scene.materials.emplace_back();
    material.name = unpacker.take_text();
    material.base_color = unpacker.take<Rgb>();
    material.opacity = unpacker.take<float>();
  }
  for (std::uint64_t n = unpacker.take_count(); n > 0; --n) {
    Mesh& mesh = scene.meshes.emplace_back();
    mesh.name = unpacker.take_text();
    mesh.positions = unpacker.take_all<Vec3f>();
    mesh.triangles = unpacker.take_all<Triangle>();
    mesh.normals = unpacker.take_all<Vec3f>();
    mesh.triangle_materials = unpacker.take_all<MaterialId>();
    const bool knows_sharp_edges = unpacker.take<std::uint8_t>() != 0;
    std::vector<VertexPair> sharp_edges = unpacker.take_all<VertexPair>();
    if (knows_sharp_edges) mesh.sharp_edges = std::move(sharp_edges);
    mesh.edge_radii = unpacker.take_all<EdgeRadius>();
  }
  for (std::uint64_t n = unpacker.take_count(); n > 0; --n) {
    Object& object = scene.objects.emplace_back();
    object.name = unpacker.take_text();
    object.mesh = unpacker.take<MeshId>();
    object.material = unpacker.take<MaterialId>();
    object.world_from_object = unpacker.take<Affine3d>();
  }
  for (std::uint64_t n = unpacker.take_count(); n > 0; --n) {
    scene.notes.push_back(unpacker.take_text());
  }
  unpacker.expect_end();
  return scene;
}

}  // namespace arris
