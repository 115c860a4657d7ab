#include "io/gltf_json.h"

#include <fmt/format.h>

#include <cmath>

#include "arris/error.h"

namespace arris {
namespace {

using nlohmann::json;

// Integers beyond 2^53 are not exact in JSON; no size in a file comes near.
constexpr double kMaxCount = 9007199254740992.0;

// The path of `wanted` below `value`, e.g. ".meshes[3].name"; nothing if it is not there.
std::optional<std::string> find_path(const json& value, const json* wanted) {
  if (&value == wanted) return "";
  if (value.is_object()) {
    for (const auto& [key, member] : value.items()) {
      if (auto rest = find_path(member, wanted)) return "." + key + *rest;
    }
  } else if (value.is_array()) {
    for (std::size_t i = 0; i < value.size(); ++i) {
      if (auto rest = find_path(value[i], wanted)) return fmt::format("[{}]{}", i, *rest);
    }
  }
  return std::nullopt;
}

// Counts brackets outside strings; the parser itself checks that they match.
void check_nesting(std::string_view text, const std::string& where) {
  int depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_string) {
      if (c == '\\') ++i;
      in_string = c != '"';
    } else if (c == '"') {
      in_string = true;
    } else if (c == '[' || c == '{') {
      if (++depth > kMaxJsonDepth) {
        throw Error(Error::Kind::input, where,
                    fmt::format("byte {}: values are nested more than {} deep", i, kMaxJsonDepth));
      }
    } else if (c == ']' || c == '}') {
      --depth;
    }
  }
}

// nlohmann's text without the exception's name in front and the bytes from the file at its end.
std::string reason_of(const json::exception& error) {
  std::string text = error.what();
  if (const auto end = text.find("] "); text.starts_with('[') && end != std::string::npos) {
    text.erase(0, end + 2);
  }
  if (const auto quoted = text.find("; last read"); quoted != std::string::npos) {
    text.erase(quoted);
  }
  return text;
}

}  // namespace

JsonFile parse_json_file(std::string_view text, const std::string& where) {
  check_nesting(text, where);
  try {
    return {json::parse(text), where};
  } catch (const json::exception& error) {
    throw Error(Error::Kind::input, where, "not valid JSON: " + reason_of(error));
  }
}

void JsonValue::fail(const std::string& what) const {
  std::string path = find_path(file_->root, value_).value_or("");
  if (path.starts_with('.')) path.erase(0, 1);
  throw Error(Error::Kind::input, path.empty() ? file_->where : file_->where + ": " + path, what);
}

std::optional<JsonValue> JsonValue::find(const char* key) const {
  if (!value_->is_object()) fail("must be an object");
  const auto member = value_->find(key);
  if (member == value_->end()) return std::nullopt;
  return JsonValue(file_, &*member);
}

JsonValue JsonValue::get(const char* key) const {
  const std::optional<JsonValue> member = find(key);
  if (!member) fail(fmt::format("\"{}\" is missing", key));
  return *member;
}

std::size_t JsonValue::size() const {
  if (!value_->is_array()) fail("must be an array");
  return value_->size();
}

JsonValue JsonValue::at(std::size_t index) const {
  return {file_, &(*value_)[index]};
}

std::optional<JsonValue> JsonValue::extension(const char* name) const {
  const std::optional<JsonValue> extensions = find("extensions");
  return extensions ? extensions->find(name) : std::nullopt;
}

bool JsonValue::as_bool() const {
  if (!value_->is_boolean()) fail("must be true or false");
  return value_->get<bool>();
}

std::string JsonValue::as_string() const {
  if (!value_->is_string()) fail("must be a string");
  return value_->get<std::string>();
}

double JsonValue::as_number() const {
  if (!value_->is_number()) fail("must be a number");
  return value_->get<double>();
}

std::uint64_t JsonValue::as_count() const {
  const double number = as_number();
  if (number < 0 || number > kMaxCount || number != std::floor(number)) {
    fail(fmt::format("{} is not a whole number of 0 or more", number));
  }
  return std::uint64_t(number);
}

std::uint32_t JsonValue::as_index(std::size_t count, const char* of_what) const {
  const std::uint64_t index = as_count();
  if (index >= count)
    fail(fmt::format("{} is out of range: the file has {} {}", index, count, of_what));
  return std::uint32_t(index);
}

Vec3d JsonValue::as_vec3() const {
  if (size() != 3) fail(fmt::format("must have 3 numbers, not {}", size()));
  return {at(0).as_number(), at(1).as_number(), at(2).as_number()};
}

std::string JsonValue::string(const char* key, const std::string& fallback) const {
  const std::optional<JsonValue> member = find(key);
  return member ? member->as_string() : fallback;
}

bool JsonValue::flag(const char* key) const {
  const std::optional<JsonValue> member = find(key);
  return member && member->as_bool();
}

double JsonValue::number(const char* key, double fallback) const {
  const std::optional<JsonValue> member = find(key);
  return member ? member->as_number() : fallback;
}

double JsonValue::number(const char* key, double fallback, double least, double most) const {
  const double value = number(key, fallback);
  if (!(value >= least && value <= most)) {
    get(key).fail(fmt::format("{} is outside {} to {}", value, least, most));
  }
  return value;
}

std::uint64_t JsonValue::count(const char* key, std::uint64_t fallback) const {
  const std::optional<JsonValue> member = find(key);
  return member ? member->as_count() : fallback;
}

Vec3d JsonValue::vec3(const char* key, Vec3d fallback) const {
  const std::optional<JsonValue> member = find(key);
  return member ? member->as_vec3() : fallback;
}

std::optional<std::uint32_t> JsonValue::index(const char* key, std::size_t count,
                                              const char* of_what) const {
  const std::optional<JsonValue> member = find(key);
  if (!member) return std::nullopt;
  return member->as_index(count, of_what);
}

}  // namespace arris
