// gltf_test_file.h — builds small glTF and GLB files in memory
// What       a JSON document beside one binary buffer; add_…() append data and return indices.
//            Tests change `json` as they like before gltf() or glb() writes the file.
#pragma once

#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "arris/math.h"

namespace arris::test {

struct GltfTestFile {
  nlohmann::json json = {{"asset", {{"version", "2.0"}}}};
  std::vector<std::uint8_t> binary;

  std::size_t add(const char* array, nlohmann::json value) {
    json[array].push_back(std::move(value));
    return json[array].size() - 1;
  }

  template <class T>
  std::size_t add_view(const std::vector<T>& values) {
    while (binary.size() % 4 != 0) binary.push_back(0);
    const std::size_t offset = binary.size(), bytes = values.size() * sizeof(T);
    binary.resize(offset + bytes);
    if (bytes > 0) std::memcpy(binary.data() + offset, values.data(), bytes);
    return add("bufferViews", {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes}});
  }

  template <class T>
  std::size_t add_accessor(const std::vector<T>& values, int component, const char* type,
                           std::size_t count) {
    return add("accessors", {{"bufferView", add_view(values)},
                             {"componentType", component},
                             {"type", type},
                             {"count", count}});
  }
  std::size_t add_vec3(const std::vector<Vec3f>& v) {
    return add_accessor(v, 5126, "VEC3", v.size());
  }
  std::size_t add_vec2(const std::vector<Vec2f>& v) {
    return add_accessor(v, 5126, "VEC2", v.size());
  }
  std::size_t add_indices(const std::vector<std::uint16_t>& v) {
    return add_accessor(v, 5123, "SCALAR", v.size());
  }

  // A mesh of one primitive.
  std::size_t add_mesh(nlohmann::json primitive) {
    return add("meshes", {{"primitives", nlohmann::json::array({std::move(primitive)})}});
  }

  std::vector<std::uint8_t> gltf() {
    if (!binary.empty() && !json.contains("buffers")) {
      json["buffers"] = {{{"byteLength", binary.size()},
                          {"uri", "data:application/octet-stream;base64," + base64(binary)}}};
    }
    const std::string text = json.dump();
    return {text.begin(), text.end()};
  }

  std::vector<std::uint8_t> glb() {
    if (!json.contains("buffers")) json["buffers"] = {{{"byteLength", binary.size()}}};
    std::string text = json.dump();
    while (text.size() % 4 != 0) text += ' ';
    std::vector<std::uint8_t> body = binary;
    while (body.size() % 4 != 0) body.push_back(0);
    std::vector<std::uint8_t> file;
    const auto put = [&](std::size_t value) {
      for (int i = 0; i < 4; ++i) file.push_back(std::uint8_t(value >> (8 * i)));
    };
    put(0x46546C67);
    put(2);
    put(12 + 8 + text.size() + 8 + body.size());
    put(text.size());
    put(0x4E4F534A);
    file.insert(file.end(), text.begin(), text.end());
    put(body.size());
    put(0x004E4942);
    file.insert(file.end(), body.begin(), body.end());
    return file;
  }

  static std::string base64(const std::vector<std::uint8_t>& bytes) {
    constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
      std::uint32_t bits = std::uint32_t(bytes[i]) << 16;
      if (i + 1 < bytes.size()) bits |= std::uint32_t(bytes[i + 1]) << 8;
      if (i + 2 < bytes.size()) bits |= bytes[i + 2];
      for (std::size_t k = 0; k < 4; ++k) {
        text += i + k > bytes.size() ? '=' : kDigits[(bits >> (18 - 6 * k)) & 63];
      }
    }
    return text;
  }
};

inline const std::vector<Vec3f>& tetrahedron_corners() {
  static const std::vector<Vec3f> kCorners = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  return kCorners;
}
// Seen from outside counter-clockwise.
inline const std::vector<std::uint16_t>& tetrahedron_indices() {
  static const std::vector<std::uint16_t> kIndices = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  return kIndices;
}

// One indexed tetrahedron under one node.
inline GltfTestFile tetrahedron_file() {
  GltfTestFile file;
  const std::size_t positions = file.add_vec3(tetrahedron_corners());
  const std::size_t indices = file.add_indices(tetrahedron_indices());
  const std::size_t mesh =
      file.add_mesh({{"attributes", {{"POSITION", positions}}}, {"indices", indices}});
  file.add("nodes", {{"mesh", mesh}, {"name", "tet"}});
  return file;
}

}  // namespace arris::test
