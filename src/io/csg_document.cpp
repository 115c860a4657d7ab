#include "io/csg_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <utility>

#include "arris/error.h"
#include "base/utf8_text.h"

namespace arris {
namespace {

constexpr int kMaxListDepth = 16;
constexpr std::size_t kMaxWordBytes = 1000;

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '$';
}
bool is_digit(char c) {
  return c >= '0' && c <= '9';
}
bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\v' || c == '\f';
}

void append_utf8(std::string& text, std::uint32_t code) {
  if (code < 0x80) {
    text += char(code);
  } else if (code < 0x800) {
    text += char(0xC0U | (code >> 6U));
    text += char(0x80U | (code & 0x3FU));
  } else {
    text += char(0xE0U | (code >> 12U));
    text += char(0x80U | ((code >> 6U) & 0x3FU));
    text += char(0x80U | (code & 0x3FU));
  }
}

class Parser {
 public:
  Parser(std::span<const std::uint8_t> bytes, const std::string& file)
      : text_(reinterpret_cast<const char*>(bytes.data()), bytes.size()), file_(file) {
    if (text_.size() > kMaxScadBytes) {
      throw Error(Error::Kind::input, file,
                  fmt::format("has {} bytes; .csg files of at most {} are read", text_.size(),
                              kMaxScadBytes));
    }
    if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;
  }

  ScadNode parse() {
    ScadNode root;
    root.name = "union";
    root.line = 1;
    while (skip_blanks(), at_ < text_.size()) parse_statement(root.children, 1);
    return root;
  }

 private:
  [[nodiscard]] Error error(const std::string& what) const {
    return {Error::Kind::input, fmt::format("{}:{}", file_, line_), what};
  }
  [[nodiscard]] char peek() const { return at_ < text_.size() ? text_[at_] : '\0'; }
  // What stands here, for a message.
  [[nodiscard]] std::string here() const {
    if (at_ >= text_.size()) return "the end of the file";
    std::size_t end = at_ + 1;
    if (is_letter(text_[at_]) || is_digit(text_[at_])) {
      while (end < text_.size() && (is_letter(text_[end]) || is_digit(text_[end]))) ++end;
    }
    return in_quotes(text_.substr(at_, end - at_));
  }

  void skip_to(std::size_t end) {
    line_ += std::uint32_t(
        std::count(text_.begin() + std::ptrdiff_t(at_), text_.begin() + std::ptrdiff_t(end), '\n'));
    at_ = end;
  }

  void skip_blanks() {
    while (at_ < text_.size()) {
      if (is_blank(text_[at_])) {
        if (text_[at_] == '\n') ++line_;
        ++at_;
      } else if (text_.substr(at_, 2) == "//") {
        skip_to(std::min(text_.find('\n', at_), text_.size()));
      } else if (text_.substr(at_, 2) == "/*") {
        const std::size_t end = text_.find("*/", at_ + 2);
        if (end == std::string_view::npos) throw error("a comment begins here and has no end");
        skip_to(end + 2);
      } else {
        return;
      }
    }
  }

  bool take(char c) {
    skip_blanks();
    if (peek() != c || at_ >= text_.size()) return false;
    ++at_;
    return true;
  }

  void need(char c, std::string_view after) {
    if (take(c)) return;
    throw error(fmt::format("found {} where '{}' should follow {}", here(), c, after));
  }

  std::string word() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && (is_letter(text_[at_]) || is_digit(text_[at_]))) ++at_;
    if (at_ - begin > kMaxWordBytes) {
      throw error(fmt::format("a word of {} bytes; the file is damaged", at_ - begin));
    }
    return std::string(text_.substr(begin, at_ - begin));
  }

  void parse_statement(std::vector<ScadNode>& siblings, int depth) {
    if (take(';')) return;
    bool hidden = false;
    for (skip_blanks(); at_ < text_.size() && (peek() == '%' || peek() == '#' || peek() == '*');
         skip_blanks()) {
      hidden |= peek() != '#';
      ++at_;
    }
    if (!is_letter(peek()) || peek() == '$') {
      throw error("found " + here() +
                  " where a node should begin; .csg files hold nodes like cube(size = [1, 1, 1], "
                  "center = false); — OpenSCAD's own language has the extension .scad");
    }
    if (depth > kMaxScadDepth) {
      throw error(fmt::format("nodes are nested more than {} deep", kMaxScadDepth));
    }
    ScadNode node = parse_node(depth);
    if (!hidden) siblings.push_back(std::move(node));
  }

  ScadNode parse_node(int depth) {
    ScadNode node;
    node.line = line_;
    node.name = word();
    skip_blanks();
    if (peek() != '(') {
      throw error("found " + here() + " where '(' should follow " + in_quotes(node.name) +
                  "; OpenSCAD's own language has the extension .scad");
    }
    ++at_;
    parse_arguments(node);
    if (take(';')) return node;
    need('{', "the arguments of " + in_quotes(node.name) + ", or ';'");
    while (!take('}')) {
      if (at_ >= text_.size()) {
        throw error(fmt::format("the file ends inside {} of line {}: '}}' is missing",
                                in_quotes(node.name), node.line));
      }
      parse_statement(node.children, depth + 1);
    }
    return node;
  }

  void parse_arguments(ScadNode& node) {
    while (!take(')')) {
      if (!node.arguments.empty()) {
        need(',', "an argument of " + in_quotes(node.name));
        if (take(')')) return;
      }
      skip_blanks();
      ScadArgument& argument = node.arguments.emplace_back();
      const std::size_t begin = at_;
      if (is_letter(peek())) {
        std::string name = word();
        if (take('=')) {
          argument.name = std::move(name);
        } else {
          at_ = begin;
        }
      }
      argument.value = parse_value(0);
    }
  }

  ScadValue parse_value(int depth) {
    skip_blanks();
    const char c = peek();
    if (c == '[') return {parse_list(depth + 1)};
    if (c == '"') return {parse_string()};
    double sign = 1;
    while (peek() == '-' || peek() == '+') {
      if (peek() == '-') sign = -sign;
      ++at_;
      skip_blanks();
    }
    if (is_digit(peek()) || peek() == '.') return {sign * parse_number()};
    if (is_letter(peek())) {
      const std::size_t begin = at_;
      const std::string name = word();
      if (name == "inf") return {sign * std::numeric_limits<double>::infinity()};
      if (name == "nan") return {std::numeric_limits<double>::quiet_NaN()};
      if (name == "true") return {true};
      if (name == "false") return {false};
      if (name == "undef") return {};
      at_ = begin;
    }
    throw error("found " + here() + " where a number, text, list, true, false or undef should be");
  }

  double parse_number() {
    std::size_t end = at_;
    const auto digits = [&] {
      while (end < text_.size() && is_digit(text_[end])) ++end;
    };
    digits();
    if (end < text_.size() && text_[end] == '.') ++end;
    digits();
    if (end < text_.size() && (text_[end] == 'e' || text_[end] == 'E')) {
      std::size_t exponent = end + 1;
      if (exponent < text_.size() && (text_[exponent] == '+' || text_[exponent] == '-')) ++exponent;
      if (exponent < text_.size() && is_digit(text_[exponent])) {
        end = exponent;
        digits();
      }
    }
    double value = 0;
    const auto [stop, problem] = std::from_chars(text_.data() + at_, text_.data() + end, value);
    if (problem == std::errc::result_out_of_range) {
      const bool tiny = text_.substr(at_, end - at_).find("e-") != std::string_view::npos ||
                        text_.substr(at_, end - at_).find("E-") != std::string_view::npos ||
                        text_[at_] == '0' || text_[at_] == '.';
      value = tiny ? 0 : std::numeric_limits<double>::infinity();
    } else if (problem != std::errc() || stop != text_.data() + end) {
      throw error("found " + in_quotes(text_.substr(at_, end - at_)) + " where a number should be");
    }
    at_ = end;
    return value;
  }

  // A quote may stand inside: it ends the string only where an argument can end.
  [[nodiscard]] bool ends_string(std::size_t quote) const {
    std::size_t next = quote + 1;
    while (next < text_.size() && is_blank(text_[next])) ++next;
    return next >= text_.size() || text_[next] == ',' || text_[next] == ')' || text_[next] == ']';
  }

  std::string parse_string() {
    const std::uint32_t begin_line = line_;
    std::string value;
    for (++at_; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (c == '"' && ends_string(at_)) {
        ++at_;
        return value;
      }
      if (c == '\n') ++line_;
      if (c == '\\' && at_ + 1 < text_.size()) {
        parse_escape(value);
      } else {
        value += c;
      }
    }
    line_ = begin_line;
    throw error("a text begins here and has no end: '\"' is missing");
  }

  // At the backslash; ends at the escape's last byte.
  void parse_escape(std::string& value) {
    const char c = text_[++at_];
    if (c == '\n') ++line_;
    const auto hex = [&](std::size_t count) -> std::optional<std::uint32_t> {
      if (at_ + count >= text_.size()) return std::nullopt;
      std::uint32_t code = 0;
      const char* const begin = text_.data() + at_ + 1;
      const auto [stop, problem] = std::from_chars(begin, begin + count, code, 16);
      if (problem != std::errc() || stop != begin + count) return std::nullopt;
      at_ += count;
      return code;
    };
    switch (c) {
      case 'n':
        value += '\n';
        return;
      case 't':
        value += '\t';
        return;
      case 'r':
        value += '\r';
        return;
      case '"':
      case '\\':
        value += c;
        return;
      case 'x':
        if (const auto code = hex(2)) return append_utf8(value, *code);
        break;
      case 'u':
        if (const auto code = hex(4)) return append_utf8(value, *code);
        break;
      default:
        break;
    }
    value += '\\';
    value += c;
  }

  ScadList parse_list(int depth) {
    if (depth > kMaxListDepth) {
      throw error(fmt::format("lists are nested more than {} deep", kMaxListDepth));
    }
    ScadList list;
    ++at_;
    while (!take(']')) {
      if (!list.empty()) {
        need(',', "an element of a list");
        if (take(']')) break;
      }
      list.push_back(parse_value(depth));
    }
    list.shrink_to_fit();
    return list;
  }

  std::string_view text_;
  const std::string& file_;
  std::size_t at_ = 0;
  std::uint32_t line_ = 1;
};

ScadDimension dimension_by_name(const ScadNode& node) {
  constexpr std::string_view kSolid[] = {
      "cube",           "sphere",         "cylinder", "polyhedron",
      "linear_extrude", "rotate_extrude", "surface",  "roof"};
  constexpr std::string_view kFlat[] = {"square",     "circle", "polygon", "text",
                                        "projection", "offset", "fill"};
  if (std::ranges::find(kSolid, node.name) != std::end(kSolid)) return ScadDimension::solid;
  if (std::ranges::find(kFlat, node.name) != std::end(kFlat)) return ScadDimension::flat;
  if (node.name == "import") {
    for (const ScadArgument& argument : node.arguments) {
      const auto* file = std::get_if<std::string>(&argument.value.data);
      if (argument.name != "file" || file == nullptr) continue;
      std::string extension = std::filesystem::path(*file).extension().string();
      std::ranges::transform(extension, extension.begin(), [](char c) {
        return c >= 'A' && c <= 'Z' ? char(c + ('a' - 'A')) : c;
      });
      if (extension == ".dxf" || extension == ".svg") return ScadDimension::flat;
    }
    return ScadDimension::solid;
  }
  return ScadDimension::none;
}

void find_dimensions(ScadNode& node) {
  node.dimension = dimension_by_name(node);
  for (ScadNode& child : node.children) {
    find_dimensions(child);
    if (node.dimension == ScadDimension::none) node.dimension = child.dimension;
  }
}

// ------------------------------------------------------------------------------------------------ writing

void write_value(const ScadValue& value, std::string& text) {
  if (const auto* flag = std::get_if<bool>(&value.data)) {
    text += *flag ? "true" : "false";
  } else if (const auto* number = std::get_if<double>(&value.data)) {
    // OpenSCAD reads no inf or nan.
    text += std::isfinite(*number) ? fmt::format("{:.17g}", *number)
            : std::isnan(*number)  ? "(0/0)"
            : *number > 0          ? "(1/0)"
                                   : "(-1/0)";
  } else if (const auto* string = std::get_if<std::string>(&value.data)) {
    text += '"';
    for (const char c : *string) {
      if (c == '"' || c == '\\') text += '\\';
      if (c == '\n') {
        text += "\\n";
      } else if (c == '\r') {
        text += "\\r";
      } else if (c == '\t') {
        text += "\\t";
      } else {
        text += c;
      }
    }
    text += '"';
  } else if (const auto* list = std::get_if<ScadList>(&value.data)) {
    text += '[';
    for (std::size_t i = 0; i < list->size(); ++i) {
      if (i > 0) text += ", ";
      write_value((*list)[i], text);
    }
    text += ']';
  } else {
    text += "undef";
  }
}

void write_node(const ScadNode& node, const std::string& folder, std::string& text) {
  text += node.name + "(";
  for (std::size_t i = 0; i < node.arguments.size(); ++i) {
    const ScadArgument& argument = node.arguments[i];
    if (i > 0) text += ", ";
    if (!argument.name.empty()) text += argument.name + " = ";
    const auto* file = std::get_if<std::string>(&argument.value.data);
    if (argument.name == "file" && file != nullptr && !file->empty()) {
      const std::filesystem::path path = std::filesystem::path(folder) / *file;
      write_value({std::filesystem::absolute(path).lexically_normal().string()}, text);
    } else {
      write_value(argument.value, text);
    }
  }
  text += ')';
  if (node.children.empty()) {
    text += ";\n";
    return;
  }
  text += " {\n";
  for (const ScadNode& child : node.children) write_node(child, folder, text);
  text += "}\n";
}

}  // namespace

ScadNode parse_csg(std::span<const std::uint8_t> bytes, const std::string& file) {
  ScadNode root = Parser(bytes, file).parse();
  find_dimensions(root);
  return root;
}

std::string csg_text(const ScadNode& node, const std::string& folder) {
  std::string text;
  write_node(node, folder, text);
  return text;
}

}  // namespace arris
