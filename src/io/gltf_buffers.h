// gltf_buffers.h — the bytes of a glTF file and the numbers in them
// What       split_glb() takes a GLB container apart, load_gltf_buffers() finds the bytes of all
//            buffers, make_element_reader() checks one accessor and reads its elements
// Guarantee  an ElementReader that was made reads inside its buffer for every index below count
// Errors     kind input, naming the buffer, view or accessor, the offset and the limit
#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "io/gltf_document.h"

namespace arris {

struct GlbParts {
  std::string_view json;
  std::span<const std::uint8_t> binary;
};

bool is_glb(std::span<const std::uint8_t> bytes);
GlbParts split_glb(std::span<const std::uint8_t> bytes, const std::string& where);

struct GltfBuffers {
  std::vector<std::vector<std::uint8_t>> loaded;       // from files and data: URIs
  std::vector<std::span<const std::uint8_t>> buffers;  // into `loaded` or the GLB
  std::vector<std::span<const std::uint8_t>> views;
  std::uint64_t total_bytes = 0;
};

GltfBuffers load_gltf_buffers(const GltfDocument& document, std::span<const std::uint8_t> binary,
                              const std::optional<std::filesystem::path>& base_folder,
                              const std::string& where);

// Accessors may share bytes or stand for zeros, so a short file can describe much data. What
// decoding takes is counted here and bounded by the bytes that are really there.
class DecodeBudget {
 public:
  DecodeBudget(std::uint64_t bytes_present, std::string where);
  // Throws Error if more than the budget is used.
  void charge(std::uint64_t count, std::uint64_t bytes_each);

 private:
  std::uint64_t limit_, left_;
  std::string where_;
};

// What a reader of accessors needs; `where` is the file's name.
struct GltfSource {
  const GltfDocument& document;
  const GltfBuffers& buffers;
  DecodeBudget& budget;
  std::string where;
};

enum class GltfElement : std::uint8_t { index, scalar, vec2, vec3 };

class ElementReader {
 public:
  ElementReader(ElementReader&&) = default;
  ElementReader& operator=(ElementReader&&) = default;

  [[nodiscard]] std::uint64_t count() const { return count_; }
  // Normalised integers as −1…1 or 0…1.
  [[nodiscard]] Vec3f vec3(std::uint64_t i) const {
    return {number(i, 0), number(i, 1), number(i, 2)};
  }
  [[nodiscard]] Vec2f vec2(std::uint64_t i) const { return {number(i, 0), number(i, 1)}; }
  [[nodiscard]] float scalar(std::uint64_t i) const { return number(i, 0); }
  [[nodiscard]] std::uint32_t index(std::uint64_t i) const;

 private:
  ElementReader() = default;
  friend ElementReader make_element_reader(const GltfSource&, std::uint32_t, GltfElement);
  [[nodiscard]] float number(std::uint64_t i, std::uint32_t component) const;

  const std::uint8_t* first_ = nullptr;
  std::uint64_t count_ = 0;
  std::uint32_t stride_ = 0;
  GltfComponent component_ = GltfComponent::f32;
  bool normalized_ = false;
  std::vector<std::uint8_t> own_;  // sparse accessors and zeros, packed
};

// Throws Error if the accessor's type is another or its elements end outside the buffer.
ElementReader make_element_reader(const GltfSource& source, std::uint32_t index,
                                  GltfElement wanted);

}  // namespace arris
