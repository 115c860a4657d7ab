#include "io/gltf_buffers.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "arris/error.h"
#include "io/uri_bytes.h"

namespace arris {
namespace {

constexpr std::uint32_t kGlbMagic = 0x46546C67;   // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;  // "JSON"
constexpr std::uint32_t kBinaryChunk = 0x004E4942;
constexpr std::size_t kGlbHeaderBytes = 12, kChunkHeaderBytes = 8;

// Shared vertices and strips decode to a few times their size; see DecodeBudget.
constexpr std::uint64_t kBudgetPerByte = 64;
constexpr std::uint64_t kLeastBudget = std::uint64_t(16) << 20;

[[noreturn]] void fail(const std::string& where, const std::string& what) {
  throw Error(Error::Kind::input, where, what);
}

std::uint32_t read_u32(std::span<const std::uint8_t> bytes, std::size_t at) {
  std::uint32_t value = 0;
  std::memcpy(&value, bytes.data() + at, 4);
  return value;
}

template <class T>
T load_as(const std::uint8_t* at) {
  T value;
  std::memcpy(&value, at, sizeof(T));
  return value;
}

std::uint32_t bytes_of(GltfComponent component) {
  switch (component) {
    case GltfComponent::i8:
    case GltfComponent::u8:
      return 1;
    case GltfComponent::i16:
    case GltfComponent::u16:
      return 2;
    case GltfComponent::u32:
    case GltfComponent::f32:
      break;
  }
  return 4;
}

std::uint32_t load_index(const std::uint8_t* at, GltfComponent component) {
  switch (component) {
    case GltfComponent::u8:
      return *at;
    case GltfComponent::u16:
      return load_as<std::uint16_t>(at);
    default:
      return load_as<std::uint32_t>(at);
  }
}

bool is_index_type(GltfComponent component) {
  return component == GltfComponent::u8 || component == GltfComponent::u16 ||
         component == GltfComponent::u32;
}

void check_type(const GltfAccessor& accessor, GltfElement wanted, const std::string& where) {
  const int components = wanted == GltfElement::vec3 ? 3 : wanted == GltfElement::vec2 ? 2 : 1;
  if (accessor.components != components) {
    fail(where,
         fmt::format("has {} components where {} are needed", accessor.components, components));
  }
  if (wanted == GltfElement::index && !is_index_type(accessor.component)) {
    fail(where, "indices must be unsigned integers");
  }
  if (wanted == GltfElement::scalar && accessor.component != GltfComponent::f32) {
    fail(where, "the values must be floats (componentType 5126)");
  }
}

// `count` elements of `element_bytes`, `stride` apart, from `offset` on.
struct ElementRange {
  std::uint64_t offset = 0, count = 0;
  std::uint32_t element_bytes = 0, stride = 0;
};

// The bytes from the first element on; throws unless the last one ends inside the view.
std::span<const std::uint8_t> slice(std::span<const std::uint8_t> view, const ElementRange& range,
                                    const std::string& where) {
  if (range.count == 0) return {};
  if (range.stride < range.element_bytes) {
    fail(where, fmt::format("elements of {} bytes overlap: the byteStride is {}",
                            range.element_bytes, range.stride));
  }
  const bool fits =
      range.offset <= view.size() && range.element_bytes <= view.size() - range.offset &&
      range.count - 1 <= (view.size() - range.offset - range.element_bytes) / range.stride;
  if (!fits) {
    fail(where,
         fmt::format("{} elements of {} bytes, {} apart, from byte {} on end outside the "
                     "bufferView of {} bytes",
                     range.count, range.element_bytes, range.stride, range.offset, view.size()));
  }
  return view.subspan(range.offset);
}

// The accessor's elements packed one after another, sparse ones replaced.
std::vector<std::uint8_t> unpack(const GltfAccessor& accessor, const GltfBuffers& buffers,
                                 std::span<const std::uint8_t> base, std::uint32_t stride,
                                 const std::string& where) {
  const std::uint32_t element = bytes_of(accessor.component) * std::uint32_t(accessor.components);
  std::vector<std::uint8_t> packed(accessor.count * element);
  for (std::uint64_t i = 0; accessor.view && i < accessor.count; ++i) {
    std::memcpy(packed.data() + i * element, base.data() + i * stride, element);
  }
  if (!accessor.sparse) return packed;
  const GltfSparse& sparse = *accessor.sparse;
  if (!is_index_type(sparse.index_component))
    fail(where, "sparse indices must be unsigned integers");
  const std::uint32_t index_bytes = bytes_of(sparse.index_component);
  const auto indices = slice(buffers.views[sparse.index_view],
                             {sparse.index_offset, sparse.count, index_bytes, index_bytes}, where);
  const auto values = slice(buffers.views[sparse.value_view],
                            {sparse.value_offset, sparse.count, element, element}, where);
  for (std::uint64_t i = 0; i < sparse.count; ++i) {
    const std::uint32_t at = load_index(indices.data() + i * index_bytes, sparse.index_component);
    if (at >= accessor.count) {
      fail(where, fmt::format("sparse index {} is beyond the {} elements", at, accessor.count));
    }
    std::memcpy(packed.data() + std::uint64_t(at) * element, values.data() + i * element, element);
  }
  return packed;
}

}  // namespace

bool is_glb(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= 4 && read_u32(bytes, 0) == kGlbMagic;
}

GlbParts split_glb(std::span<const std::uint8_t> bytes, const std::string& where) {
  if (bytes.size() < kGlbHeaderBytes + kChunkHeaderBytes) fail(where, "the GLB header is cut off");
  if (const std::uint32_t version = read_u32(bytes, 4); version != 2) {
    fail(where, fmt::format("GLB version {} can't be read; export as glTF 2.0", version));
  }
  if (const std::uint32_t length = read_u32(bytes, 8); length > bytes.size()) {
    fail(where, fmt::format("cut off: the header announces {} bytes, the file has {}", length,
                            bytes.size()));
  }
  GlbParts parts;
  std::size_t at = kGlbHeaderBytes;
  for (int chunk = 0; at + kChunkHeaderBytes <= bytes.size() && chunk < 2; ++chunk) {
    const std::uint64_t length = read_u32(bytes, at);
    const std::uint32_t type = read_u32(bytes, at + 4);
    at += kChunkHeaderBytes;
    if (length > bytes.size() - at) {
      fail(where, fmt::format("chunk {} is cut off: {} of {} bytes are there", chunk,
                              bytes.size() - at, length));
    }
    const auto body = bytes.subspan(at, length);
    if (chunk == 0 && type != kJsonChunk) fail(where, "the first chunk of a GLB must be JSON");
    if (chunk == 0) parts.json = {reinterpret_cast<const char*>(body.data()), body.size()};
    if (chunk == 1 && type == kBinaryChunk) parts.binary = body;
    at += std::size_t((length + 3) / 4 * 4);
  }
  return parts;
}

GltfBuffers load_gltf_buffers(const GltfDocument& document, std::span<const std::uint8_t> binary,
                              const std::optional<std::filesystem::path>& base_folder,
                              const std::string& where) {
  GltfBuffers result;
  std::map<std::string_view, std::span<const std::uint8_t>> by_uri;
  result.loaded.reserve(document.buffers.size());
  for (std::size_t i = 0; i < document.buffers.size(); ++i) {
    const GltfBuffer& buffer = document.buffers[i];
    const std::string place = fmt::format("{}: buffers[{}]", where, i);
    if (!buffer.uri && (i > 0 || binary.empty()) && buffer.byte_length > 0) {
      fail(place, "has no \"uri\", and the file has no binary chunk for it");
    }
    std::span<const std::uint8_t> bytes = i == 0 ? binary : std::span<const std::uint8_t>{};
    if (buffer.uri) {
      const auto [entry, is_new] = by_uri.try_emplace(*buffer.uri);
      if (is_new) {
        entry->second = result.loaded.emplace_back(load_uri(*buffer.uri, base_folder, place));
        result.total_bytes += entry->second.size();
      }
      bytes = entry->second;
    }
    if (buffer.byte_length > bytes.size()) {
      fail(place,
           fmt::format("announces {} bytes, only {} are there", buffer.byte_length, bytes.size()));
    }
    result.buffers.push_back(bytes.first(buffer.byte_length));
  }
  result.total_bytes += binary.size();
  for (std::size_t i = 0; i < document.views.size(); ++i) {
    const GltfBufferView& view = document.views[i];
    const auto bytes = result.buffers[view.buffer];
    if (view.offset > bytes.size() || view.length > bytes.size() - view.offset) {
      fail(fmt::format("{}: bufferViews[{}]", where, i),
           fmt::format("{} bytes from byte {} on end outside buffer {} of {} bytes", view.length,
                       view.offset, view.buffer, bytes.size()));
    }
    result.views.push_back(bytes.subspan(view.offset, view.length));
  }
  return result;
}

DecodeBudget::DecodeBudget(std::uint64_t bytes_present, std::string where)
    : limit_(std::max(kLeastBudget, bytes_present * kBudgetPerByte)),
      left_(limit_),
      where_(std::move(where)) {}

void DecodeBudget::charge(std::uint64_t count, std::uint64_t bytes_each) {
  if (count > left_ / bytes_each) {
    fail(where_, fmt::format("its accessors describe more than {} bytes, far more than the file "
                             "holds; write shared data once",
                             limit_));
  }
  left_ -= count * bytes_each;
}

float ElementReader::number(std::uint64_t i, std::uint32_t component) const {
  const std::uint8_t* at = first_ + i * stride_;
  switch (component_) {
    case GltfComponent::f32:
      return load_as<float>(at + 4 * component);
    case GltfComponent::u8:
      return float(at[component]) / (normalized_ ? 255.0F : 1.0F);
    case GltfComponent::u16:
      return float(load_as<std::uint16_t>(at + 2 * component)) / (normalized_ ? 65535.0F : 1.0F);
    case GltfComponent::i8: {
      const auto value = float(load_as<std::int8_t>(at + component));
      return normalized_ ? std::max(value / 127.0F, -1.0F) : value;
    }
    case GltfComponent::i16: {
      const auto value = float(load_as<std::int16_t>(at + 2 * component));
      return normalized_ ? std::max(value / 32767.0F, -1.0F) : value;
    }
    case GltfComponent::u32:
      break;
  }
  return float(load_as<std::uint32_t>(at + 4 * component));
}

std::uint32_t ElementReader::index(std::uint64_t i) const {
  return load_index(first_ + i * stride_, component_);
}

ElementReader make_element_reader(const GltfSource& source, std::uint32_t index,
                                  GltfElement wanted) {
  const GltfAccessor& accessor = source.document.accessors[index];
  const std::string place = fmt::format("{}: accessors[{}]", source.where, index);
  check_type(accessor, wanted, place);
  const std::uint32_t element = bytes_of(accessor.component) * std::uint32_t(accessor.components);
  ElementReader reader;
  reader.count_ = accessor.count;
  reader.component_ = accessor.component;
  reader.normalized_ = accessor.normalized;
  reader.stride_ = element;
  std::span<const std::uint8_t> base;
  if (accessor.view) {
    const std::uint32_t stride = source.document.views[*accessor.view].stride;
    if (stride != 0) reader.stride_ = stride;
    base = slice(source.buffers.views[*accessor.view],
                 {accessor.offset, accessor.count, element, reader.stride_}, place);
  }
  if (accessor.sparse || !accessor.view) {
    source.budget.charge(accessor.count, element);
    reader.own_ = unpack(accessor, source.buffers, base, reader.stride_, place);
    reader.stride_ = element;
    reader.first_ = reader.own_.data();
  } else {
    reader.first_ = base.data();
  }
  return reader;
}

}  // namespace arris
