#include "io/toml_writer.h"

#include <fmt/format.h>

#include <algorithm>

namespace arris {
namespace {

std::string escaped(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') {
      out += fmt::format("\\u{:04X}", unsigned(static_cast<unsigned char>(c)));
    } else {
      out += c;
    }
  }
  return out + "\"";
}

std::string key_text(std::string_view key) {
  constexpr std::string_view kBare =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-";
  const bool is_bare = !key.empty() && key.find_first_not_of(kBare) == std::string_view::npos;
  return is_bare ? std::string(key) : escaped(key);
}

std::string inline_text(const TomlValue& value);

struct InlineText {
  std::string operator()(const TomlTable& table) const {
    if (table.empty()) return "{}";
    std::string out;
    for (const TomlMember& member : table) {
      out += fmt::format("{}{} = {}", out.empty() ? "{ " : ", ", key_text(member.key),
                         inline_text(member.value));
    }
    return out + " }";
  }
  std::string operator()(const TomlArray& array) const {
    std::string out;
    for (const TomlValue& element : array) out += (out.empty() ? "" : ", ") + inline_text(element);
    return "[" + out + "]";
  }
  std::string operator()(const std::string& text) const { return escaped(text); }
  std::string operator()(std::int64_t number) const { return fmt::format("{}", number); }
  // The shortest that is read back as the same number.
  std::string operator()(double number) const {
    return fmt::format("{}", number == 0 ? 0.0 : number);
  }
  std::string operator()(bool value) const { return value ? "true" : "false"; }
  std::string operator()(TomlDate) const { return "1970-01-01"; }
};

std::string inline_text(const TomlValue& value) {
  return std::visit(InlineText{}, value.data);
}

bool is_array_of_tables(const TomlValue& value) {
  const auto* array = std::get_if<TomlArray>(&value.data);
  return array != nullptr && !array->empty() && std::ranges::all_of(*array, [](const TomlValue& v) {
           return std::holds_alternative<TomlTable>(v.data);
         });
}

// Deeper tables stand inline, so that a header has few parts; so do those of an [[array]]'s elements.
constexpr int kHeaderDepth = 2;

class Writer {
 public:
  // path: of the table's header, with a dot at its end; depth: its parts.
  void write_members(const TomlTable& table, const std::string& path, int depth) {
    const auto has_header = [&](const TomlValue& value) {
      return depth < kHeaderDepth &&
             (is_array_of_tables(value) || std::holds_alternative<TomlTable>(value.data));
    };
    for (const TomlMember& member : table) {
      if (!has_header(member.value)) {
        out += key_text(member.key) + " = " + inline_text(member.value) + "\n";
      }
    }
    for (const TomlMember& member : table) {
      if (!has_header(member.value)) continue;
      const std::string name = path + key_text(member.key);
      if (const auto* inner = std::get_if<TomlTable>(&member.value.data)) {
        write_table(*inner, name, depth + 1);
      } else {
        for (const TomlValue& element : std::get<TomlArray>(member.value.data)) {
          out += "\n[[" + name + "]]\n";
          write_element(std::get<TomlTable>(element.data), name);
        }
      }
    }
  }

  std::string out;

 private:
  void write_table(const TomlTable& table, const std::string& name, int depth) {
    const bool only_names_others =
        !table.empty() && depth < kHeaderDepth && std::ranges::all_of(table, [](const auto& m) {
          return std::holds_alternative<TomlTable>(m.value.data) || is_array_of_tables(m.value);
        });
    if (!only_names_others) out += "\n[" + name + "]\n";
    write_members(table, name + ".", depth);
  }

  void write_element(const TomlTable& table, const std::string& name) {
    for (const TomlMember& member : table) {
      if (is_array_of_tables(member.value)) continue;
      out += key_text(member.key) + " = " + inline_text(member.value) + "\n";
    }
    for (const TomlMember& member : table) {
      if (!is_array_of_tables(member.value)) continue;
      for (const TomlValue& element : std::get<TomlArray>(member.value.data)) {
        out += "\n[[" + name + "." + key_text(member.key) + "]]\n";
        for (const TomlMember& inner : std::get<TomlTable>(element.data)) {
          out += key_text(inner.key) + " = " + inline_text(inner.value) + "\n";
        }
      }
    }
  }
};

}  // namespace

std::string write_toml(const TomlTable& table) {
  Writer writer;
  writer.write_members(table, "", 0);
  return std::move(writer.out);
}

TomlValue* find_toml(TomlTable& table, std::string_view key) {
  const auto member = std::ranges::find(table, key, &TomlMember::key);
  return member == table.end() ? nullptr : &member->value;
}

void set_toml(TomlTable& table, std::string_view key, TomlData data) {
  if (TomlValue* value = find_toml(table, key)) {
    value->data = std::move(data);
  } else {
    table.push_back({std::string(key), {}, {{}, std::move(data)}});
  }
}

void erase_toml(TomlTable& table, std::initializer_list<std::string_view> keys) {
  std::erase_if(table, [&](const TomlMember& member) {
    return std::ranges::find(keys, member.key) != keys.end();
  });
}

}  // namespace arris
