// toml_parse.cpp — toml++'s tree as ours, so that only this file needs its headers
#include <fmt/format.h>

#include <algorithm>

#include "arris/error.h"
#include "base/utf8_text.h"
#include "io/toml_document.h"

// toml++ 3.3 asserts what a file may break ("[=" in parse_key()) and then reports it as an error. With
// NDEBUG its assertions become promises to the compiler; so they are nothing here, in every build.
#undef NDEBUG
#define TOML_ASSERT(expr) static_assert(true)
#include <toml++/toml.h>

namespace arris {
namespace {

// No scene needs more; they bound the recursion of the parser and of destructors.
constexpr int kMaxBrackets = 32;
constexpr int kMaxDots = 8;

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

TomlPlace place_of(const toml::source_region& region) {
  return {std::max(region.begin.line, 1U), std::max(region.begin.column, 1U)};
}

// Walks the text once before the parser sees it: bounds its nesting, and keeps away from it what it
// mishandles (toml++ 3.3 meets undefined behaviour at accented letters and control characters outside
// of strings; TOML allows neither).
class TextCheck {
 public:
  TextCheck(std::string_view text, const std::string& where) : text_(text), where_(where) {}

  void run() {
    for (; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (c == '"' || c == '\'') {
        skip_string(c);
      } else if (c == '#') {
        skip_comment();
      } else {
        check_outside(c);
      }
    }
  }

 private:
  void check_outside(char c) {
    check_control(c);
    if (std::uint8_t(c) >= 0x80) fail("a letter that is not ASCII must stand in quotes");
    if (c == '[' || c == '{') ++brackets_;
    if ((c == ']' || c == '}') && brackets_ > 0) --brackets_;
    if (c == '.') {
      ++dots_;
    } else if (std::string_view("=,[]{}\n").find(c) != std::string_view::npos) {
      dots_ = 0;
    }
    if (brackets_ > kMaxBrackets) fail(fmt::format("nested more than {} deep", kMaxBrackets));
    if (dots_ > kMaxDots) fail(fmt::format("the key has more than {} dots", kMaxDots));
  }

  // Also counts lines.
  void check_control(char c) {
    if (c == '\n') {
      ++line_;
      line_start_ = at_ + 1;
    } else if ((std::uint8_t(c) < 0x20 && c != '\t' && c != '\r') || c == 0x7F) {
      fail("a control character; only tabs and line ends may stand in the file");
    }
  }

  void skip_comment() {
    while (at_ < text_.size() && text_[at_] != '\n') check_control(text_[at_++]);
    if (at_ < text_.size()) check_outside('\n');
  }

  // Leaves at_ on the last character of the string.
  void skip_string(char quote) {
    const bool is_long = stands_three_times(quote);
    for (at_ += is_long ? 3 : 1; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      check_control(c);
      if (c == '\n' && !is_long) return;  // the parser reports it
      if (c == '\\' && quote == '"') {
        if (++at_ < text_.size()) check_control(text_[at_]);
      } else if (c == quote && !is_long) {
        return;
      } else if (c == quote && stands_three_times(quote)) {
        at_ += 2;
        // A long string may end in one or two quotes of its own.
        for (int i = 0; i < 2 && at_ + 1 < text_.size() && text_[at_ + 1] == quote; ++i) ++at_;
        return;
      }
    }
  }

  [[nodiscard]] bool stands_three_times(char quote) const {
    return text_.substr(at_, 3) == std::string(3, quote);
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw Error(Error::Kind::input, fmt::format("{}:{}:{}", where_, line_, at_ - line_start_ + 1),
                what);
  }

  std::string_view text_;
  const std::string& where_;
  std::size_t at_ = 0, line_ = 1, line_start_ = 0;
  int brackets_ = 0, dots_ = 0;
};

TomlValue convert(const toml::node& node);

TomlTable convert(const toml::table& table) {
  TomlTable members;
  members.reserve(table.size());
  for (const auto& [key, value] : table) {
    members.push_back({std::string(key.str()), place_of(key.source()), convert(value)});
  }
  return members;
}

TomlValue convert(const toml::node& node) {
  TomlValue value;
  value.place = place_of(node.source());
  switch (node.type()) {
    case toml::node_type::table:
      value.data = convert(*node.as_table());
      break;
    case toml::node_type::array: {
      TomlArray elements;
      for (const toml::node& element : *node.as_array()) elements.push_back(convert(element));
      value.data = std::move(elements);
      break;
    }
    case toml::node_type::string:
      value.data = node.as_string()->get();
      break;
    case toml::node_type::integer:
      value.data = node.as_integer()->get();
      break;
    case toml::node_type::floating_point:
      value.data = node.as_floating_point()->get();
      break;
    case toml::node_type::boolean:
      value.data = node.as_boolean()->get();
      break;
    default:
      value.data = TomlDate{};
      break;
  }
  return value;
}

// The parser's message may quote what it read.
std::string on_one_line(std::string_view text) {
  std::string line(text.substr(0, 300));
  std::ranges::replace_if(
      line, [](char c) { return std::uint8_t(c) < 0x20 || c == 0x7F; }, ' ');
  return line;
}

}  // namespace

TomlTable parse_toml(std::string_view text, const std::string& where) {
  if (!is_utf8(text)) {
    throw Error(Error::Kind::input, where, "is not UTF-8 text; save it as UTF-8");
  }
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  TextCheck(text, where).run();
  try {
    return convert(toml::parse(text));
  } catch (const toml::parse_error& error) {
    const TomlPlace place = place_of(error.source());
    throw Error(Error::Kind::input, fmt::format("{}:{}:{}", where, place.line, place.column),
                on_one_line(error.description()));
  }
}

}  // namespace arris
