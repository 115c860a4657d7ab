#include "io/ply_header.h"

#include <string_view>
#include <utility>

#include "base/utf8_text.h"
#include "io/mesh_scene.h"

namespace arris {
namespace {

// Names are compared with all before them.
constexpr std::size_t kMaxElements = 100;
constexpr std::size_t kMaxProperties = 1000;

struct TypeName {
  std::string_view name;
  PlyType type;
};
constexpr TypeName kTypeNames[] = {
    {"char", PlyType::int8},      {"int8", PlyType::int8},       {"uchar", PlyType::uint8},
    {"uint8", PlyType::uint8},    {"short", PlyType::int16},     {"int16", PlyType::int16},
    {"ushort", PlyType::uint16},  {"uint16", PlyType::uint16},   {"int", PlyType::int32},
    {"int32", PlyType::int32},    {"uint", PlyType::uint32},     {"uint32", PlyType::uint32},
    {"float", PlyType::float32},  {"float32", PlyType::float32}, {"double", PlyType::float64},
    {"float64", PlyType::float64}};

PlyType read_type(TextScanner& text) {
  const std::string_view word = text.word();
  for (const TypeName& candidate : kTypeNames) {
    if (candidate.name == word) return candidate.type;
  }
  throw text.error(
      "found " + in_quotes(word) +
      " where a type should be: char, uchar, short, ushort, int, uint, float or double");
}

void check_name(const TextScanner& text, const std::string& name) {
  const std::string problem = problem_with_name(name);
  if (!problem.empty()) throw text.error(problem);
}

PlyEncoding read_encoding(TextScanner& text) {
  const std::string_view encoding = text.word(), version = text.word();
  if (version != "1.0") {
    throw text.error("the version is " + in_quotes(version) + "; only 1.0 is read");
  }
  if (encoding == "ascii") return PlyEncoding::ascii;
  if (encoding == "binary_little_endian") return PlyEncoding::little_endian;
  if (encoding == "binary_big_endian") return PlyEncoding::big_endian;
  throw text.error("the format is " + in_quotes(encoding) +
                   "; ascii, binary_little_endian and binary_big_endian are read");
}

PlyElement read_element(TextScanner& text, const PlyHeader& header) {
  if (header.elements.size() == kMaxElements) {
    throw text.error("more than " + std::to_string(kMaxElements) + " elements; split the file");
  }
  PlyElement element;
  element.name = text.word();
  check_name(text, element.name);
  for (const PlyElement& other : header.elements) {
    if (other.name == element.name) {
      throw text.error("the element " + in_quotes(element.name) + " appears twice");
    }
  }
  const std::string_view word = text.word();
  const std::optional<std::int64_t> count = parse_integer(word);
  if (element.name.empty() || !count || *count < 0) {
    throw text.error("the element " + in_quotes(element.name) + " has the count " +
                     in_quotes(word) + "; a number from 0 is needed");
  }
  element.count = std::uint64_t(*count);
  return element;
}

PlyProperty read_property(TextScanner& text, const PlyHeader& header) {
  if (header.elements.empty()) throw text.error("a property comes before the first element");
  if (header.elements.back().properties.size() == kMaxProperties) {
    throw text.error("more than " + std::to_string(kMaxProperties) + " properties; leave some out");
  }
  PlyProperty property;
  TextScanner ahead = text;
  if (ahead.word() == "list") {
    text.word();
    property.count_type = read_type(text);
    if (!is_integer(*property.count_type)) {
      throw text.error("a list's length has a type that is no integer");
    }
  }
  property.type = read_type(text);
  property.name = text.word();
  check_name(text, property.name);
  if (property.name.empty()) throw text.error("the property has no name");
  for (const PlyProperty& other : header.elements.back().properties) {
    if (other.name == property.name) {
      throw text.error("the property " + in_quotes(property.name) + " appears twice");
    }
  }
  return property;
}

}  // namespace

std::size_t size_of(PlyType type) {
  switch (type) {
    case PlyType::int8:
    case PlyType::uint8:
      return 1;
    case PlyType::int16:
    case PlyType::uint16:
      return 2;
    case PlyType::int32:
    case PlyType::uint32:
    case PlyType::float32:
      return 4;
    case PlyType::float64:
      return 8;
  }
  return 8;
}

bool is_integer(PlyType type) {
  return type != PlyType::float32 && type != PlyType::float64;
}

PlyHeader read_ply_header(TextScanner& text) {
  PlyHeader header;
  if (!text.next_line() || text.word() != "ply") {
    throw text.error("does not start with the line \"ply\"; a PLY file is needed");
  }
  bool has_format = false;
  while (text.next_line()) {
    const std::string_view word = text.word();
    if (word.empty() || word == "comment" || word == "obj_info") continue;
    if (word == "end_header") {
      if (!has_format) throw text.error("the header has no line \"format\"");
      return header;
    }
    if (word == "format") {
      header.encoding = read_encoding(text);
      has_format = true;
    } else if (word == "element") {
      header.elements.push_back(read_element(text, header));
    } else if (word == "property") {
      PlyProperty property = read_property(text, header);
      header.elements.back().properties.push_back(std::move(property));
    } else {
      throw text.error(
          "found " + in_quotes(word) +
          " where format, element, property, comment, obj_info or end_header should be");
    }
  }
  throw text.error("the file ends before \"end_header\": it is cut off");
}

}  // namespace arris
