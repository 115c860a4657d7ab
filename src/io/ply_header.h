// ply_header.h — what the header of a PLY file says about the data after it
// Source     G. Turk, "The PLY Polygon File Format" (1994)
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/text_scanner.h"

namespace arris {

enum class PlyEncoding { ascii, little_endian, big_endian };
enum class PlyType : std::uint8_t { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

std::size_t size_of(PlyType type);
bool is_integer(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;    // of the value, or of a list's items
  std::optional<PlyType> count_type;  // of lists
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::ascii;
  std::vector<PlyElement> elements;
};

// Reads up to and with the line "end_header".
PlyHeader read_ply_header(TextScanner& text);

}  // namespace arris
