// csg_document.h — OpenSCAD's .csg text as a tree of nodes
// What       node := [%#*]* name "(" arguments ")" ( ";" | "{" node* "}" ); what `%` or `*` marks is left out, `#`
//            changes nothing. Numbers, inf, nan, undef, true, false, strings, lists; comments as in OpenSCAD.
// Guarantee  memory is a small multiple of the text's; nesting is limited, so that trees may be walked and
//            destroyed by recursion
// Limits     a quote ends a string only before a blank, comma, bracket or parenthesis: OpenSCAD 2021.01 writes the
//            quotes inside strings without their backslash
// Errors     kind input, where = "file:line"
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace arris {

struct ScadValue;
using ScadList = std::vector<ScadValue>;
struct ScadValue {
  // monostate: undef
  std::variant<std::monostate, bool, double, std::string, ScadList> data;
};

struct ScadArgument {
  std::string name;  // empty: by position
  ScadValue value;
};

enum class ScadDimension : std::uint8_t { none, flat, solid };

struct ScadNode {
  std::string name;
  std::uint32_t line = 0;
  // What it makes: as the first of its children that makes something, or as its name says.
  ScadDimension dimension = ScadDimension::none;
  std::vector<ScadArgument> arguments;
  std::vector<ScadNode> children;
};

inline constexpr int kMaxScadDepth = 400;
inline constexpr std::size_t kMaxScadBytes = std::size_t(256) << 20;

// The root's children are the file's nodes; its name is "union".
ScadNode parse_csg(std::span<const std::uint8_t> bytes, const std::string& file);

// As text that OpenSCAD reads; file names are taken relative to `folder` and written as absolute ones.
std::string csg_text(const ScadNode& node, const std::string& folder);

}  // namespace arris
