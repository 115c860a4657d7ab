// toml_parse.cpp — toml++'s tree as ours, so that only this file needs its headers
#include <fmt/format.h>

#include <toml++/toml.h>

#include <algorithm>

#include "arris/error.h"
#include "base/utf8_text.h"
#include "io/toml_document.h"

namespace arris {
namespace {

// No scene needs more; they bound the recursion of the parser and of destructors.
constexpr int kMaxBrackets = 32;
constexpr int kMaxDots = 8;

TomlPlace place_of(const toml::source_region& region) {
  return {std::max(region.begin.line, 1U), std::max(region.begin.column, 1U)};
}

// Walks the text once, outside of strings and comments, before the parser sees it.
class NestingCheck {
 public:
  NestingCheck(std::string_view text, const std::string& where) : text_(text), where_(where) {}

  void run() {
    for (; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (c == '"' || c == '\'') {
        skip_string(c);
      } else if (c == '#') {
        at_ = std::min(text_.find('\n', at_), text_.size()) - 1;
      } else {
        count(c);
      }
    }
  }

 private:
  void count(char c) {
    if (c == '\n') ++line_;
    if (c == '[' || c == '{') ++brackets_;
    if ((c == ']' || c == '}') && brackets_ > 0) --brackets_;
    if (c == '.') {
      ++dots_;
    } else if (std::string_view("=,[]{}\n").find(c) != std::string_view::npos) {
      dots_ = 0;
    }
    if (brackets_ <= kMaxBrackets && dots_ <= kMaxDots) return;
    throw Error(Error::Kind::input, fmt::format("{}:{}", where_, line_),
                fmt::format("values are nested more than {} deep, or a key has more than {} dots",
                            kMaxBrackets, kMaxDots));
  }

  // Leaves at_ on the last character of the string.
  void skip_string(char quote) {
    const std::string_view rest = text_.substr(at_);
    const bool is_long = rest.size() >= 3 && rest[1] == quote && rest[2] == quote;
    at_ += is_long ? 3 : 1;
    for (; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (c == '\n') ++line_;
      if (c == '\n' && !is_long) return;  // the parser reports it
      if (c == '\\' && quote == '"') {
        ++at_;
      } else if (c == quote && (!is_long || ends_long(quote))) {
        if (is_long) at_ += 2;
        return;
      }
    }
  }

  [[nodiscard]] bool ends_long(char quote) const {
    return at_ + 2 < text_.size() && text_[at_ + 1] == quote && text_[at_ + 2] == quote;
  }

  std::string_view text_;
  const std::string& where_;
  std::size_t at_ = 0, line_ = 1;
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
  NestingCheck(text, where).run();
  try {
    return convert(toml::parse(text));
  } catch (const toml::parse_error& error) {
    const TomlPlace place = place_of(error.source());
    throw Error(Error::Kind::input, fmt::format("{}:{}:{}", where, place.line, place.column),
                on_one_line(error.description()));
  }
}

}  // namespace arris
