// gltf_json.h — checked access to a JSON document; every failure names the value's path
// Cost       finding the path of a value walks the document: only done for errors
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "arris/math.h"

namespace arris {

// Nesting beyond what any glTF needs; it bounds the recursion of whoever walks the document.
inline constexpr int kMaxJsonDepth = 64;

struct JsonFile {
  nlohmann::json root;
  std::string where;
};

// Throws Error for what is not JSON, not UTF-8 or nested too deeply.
JsonFile parse_json_file(std::string_view text, const std::string& where);

// A value inside a JsonFile, which must outlive it.
class JsonValue {
 public:
  explicit JsonValue(const JsonFile& file) : file_(&file), value_(&file.root) {}

  [[noreturn]] void fail(const std::string& what) const;

  // Members; `this` must be an object.
  [[nodiscard]] std::optional<JsonValue> find(const char* key) const;
  [[nodiscard]] JsonValue get(const char* key) const;
  // Elements; `this` must be an array.
  [[nodiscard]] std::size_t size() const;
  [[nodiscard]] JsonValue at(std::size_t index) const;
  // The array `key`, empty if it is missing.
  template <class F>
  void for_each(const char* key, F&& visit) const {
    const std::optional<JsonValue> array = find(key);
    for (std::size_t i = 0; array && i < array->size(); ++i) visit(array->at(i));
  }
  // extensions.NAME
  [[nodiscard]] std::optional<JsonValue> extension(const char* name) const;

  [[nodiscard]] bool is_string() const { return value_->is_string(); }
  [[nodiscard]] bool is_object() const { return value_->is_object(); }
  [[nodiscard]] bool as_bool() const;
  [[nodiscard]] std::string as_string() const;
  [[nodiscard]] double as_number() const;
  [[nodiscard]] std::uint64_t as_count() const;
  [[nodiscard]] std::uint32_t as_index(std::size_t count, const char* of_what) const;
  [[nodiscard]] Vec3d as_vec3() const;

  [[nodiscard]] std::string string(const char* key, const std::string& fallback) const;
  [[nodiscard]] bool flag(const char* key) const;
  [[nodiscard]] double number(const char* key, double fallback) const;
  // `least` ≤ number ≤ `most`
  [[nodiscard]] double number(const char* key, double fallback, double least, double most) const;
  [[nodiscard]] std::uint64_t count(const char* key, std::uint64_t fallback) const;
  [[nodiscard]] Vec3d vec3(const char* key, Vec3d fallback) const;
  [[nodiscard]] std::optional<std::uint32_t> index(const char* key, std::size_t count,
                                                   const char* of_what) const;

 private:
  JsonValue(const JsonFile* file, const nlohmann::json* value) : file_(file), value_(value) {}

  const JsonFile* file_;
  const nlohmann::json* value_;
};

}  // namespace arris
