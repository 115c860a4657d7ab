// toml_writer.h — a tree of TOML values as text, and changing such trees
// Guarantee  parse_toml() reads the text as the same tree: keys, texts and numbers, whatever is in them
// Limits     dates, which parse_toml() reads without their value, become some date; comments are not part of a tree
// In         keys and texts are UTF-8
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>

#include "io/toml_document.h"

namespace arris {

using TomlData = decltype(TomlValue::data);

// [a], [a.b] and [[a.b]] at the top, inline below.
std::string write_toml(const TomlTable& table);

TomlValue* find_toml(TomlTable& table, std::string_view key);
// Replaces the value of a key, or adds it at the end.
void set_toml(TomlTable& table, std::string_view key, TomlData data);
void erase_toml(TomlTable& table, std::initializer_list<std::string_view> keys);

}  // namespace arris
