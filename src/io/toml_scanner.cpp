#include "io/toml_scanner.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>

#include "arris/error.h"
#include "base/utf8_text.h"

namespace arris {
namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

bool is_hex_digit(char c) {
  return is_digit(c) || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F');
}

bool is_bare_key_character(char c) {
  return is_digit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == '-';
}

bool is_bare_value_character(char c) {
  return is_bare_key_character(c) || c == '+' || c == '.' || c == ':';
}

// Without the underscores, each of which must stand between two digits.
std::optional<std::string> without_underscores(std::string_view text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '_') {
      plain += text[i];
    } else if (i == 0 || i + 1 == text.size() || !is_hex_digit(text[i - 1]) ||
               !is_hex_digit(text[i + 1])) {
      return std::nullopt;
    }
  }
  return plain;
}

std::optional<std::int64_t> parse_integer(std::string_view digits, int base) {
  std::int64_t value = 0;
  const auto [end, error] =
      std::from_chars(digits.data(), digits.data() + digits.size(), value, base);
  if (digits.empty() || error != std::errc{} || end != digits.data() + digits.size()) {
    return std::nullopt;
  }
  return value;
}

// Digits, then a fraction or an exponent or both; no leading zeros.
bool is_decimal(std::string_view text) {
  const auto skip_digits = [&] {
    const auto count = std::size_t(std::ranges::find_if_not(text, is_digit) - text.begin());
    text.remove_prefix(count);
    return count;
  };
  if (text.starts_with('-')) text.remove_prefix(1);
  if (text.size() > 1 && text[0] == '0' && is_digit(text[1])) return false;
  if (skip_digits() == 0) return false;
  if (text.starts_with('.')) {
    text.remove_prefix(1);
    if (skip_digits() == 0) return false;
  }
  if (text.starts_with('e') || text.starts_with('E')) {
    text.remove_prefix(1);
    if (text.starts_with('+') || text.starts_with('-')) text.remove_prefix(1);
    if (skip_digits() == 0) return false;
  }
  return text.empty();
}

std::string_view long_quote(char quote) {
  return quote == '"' ? "\"\"\"" : "'''";
}

using Scalar = decltype(TomlValue::data);

std::optional<Scalar> parse_decimal(std::string_view text) {
  if (!is_decimal(text)) return std::nullopt;
  if (text.find_first_of(".eE") == std::string_view::npos) {
    if (const auto integer = parse_integer(text, 10)) return *integer;
    return std::nullopt;
  }
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{}) return std::nullopt;
  return value;
}

std::optional<Scalar> parse_number(std::string_view word) {
  const bool has_sign = word.starts_with('+') || word.starts_with('-');
  const std::string_view unsigned_word = word.substr(has_sign ? 1 : 0);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (unsigned_word == "inf") return word[0] == '-' ? -kInfinity : kInfinity;
  if (unsigned_word == "nan") return std::numeric_limits<double>::quiet_NaN();
  const std::optional<std::string> plain = without_underscores(word);
  if (!plain) return std::nullopt;
  for (const auto& [prefix, base] : {std::pair("0x", 16), std::pair("0o", 8), std::pair("0b", 2)}) {
    if (!plain->starts_with(prefix)) continue;
    const std::string_view digits = std::string_view(*plain).substr(2);
    if (digits.empty() || !is_hex_digit(digits[0])) return std::nullopt;  // no sign here
    if (const auto integer = parse_integer(digits, base)) return *integer;
    return std::nullopt;
  }
  if (word.starts_with("+-")) return std::nullopt;
  return parse_decimal(std::string_view(*plain).substr(plain->starts_with('+') ? 1 : 0));
}

// 1979-05-27… or 07:32…
bool looks_like_date(std::string_view word) {
  const auto digits = std::size_t(std::ranges::find_if_not(word, is_digit) - word.begin());
  return digits < word.size() &&
         ((digits == 4 && word[4] == '-') || (digits == 2 && word[2] == ':'));
}

void append_utf8(std::uint32_t code, std::string& text) {
  if (code < 0x80) {
    text += char(code);
  } else if (code < 0x800) {
    text += {char(0xC0 | (code >> 6)), char(0x80 | (code & 63))};
  } else if (code < 0x10000) {
    text += {char(0xE0 | (code >> 12)), char(0x80 | ((code >> 6) & 63)), char(0x80 | (code & 63))};
  } else {
    text += {char(0xF0 | (code >> 18)), char(0x80 | ((code >> 12) & 63)),
             char(0x80 | ((code >> 6) & 63)), char(0x80 | (code & 63))};
  }
}

}  // namespace

void TomlScanner::fail_at(TomlPlace place, const std::string& what) const {
  throw Error(Error::Kind::input, fmt::format("{}:{}:{}", where_, place.line, place.column), what);
}

TomlPlace TomlScanner::place() const {
  return {line_, std::uint32_t(at_ - line_start_ + 1)};
}

bool TomlScanner::skip(std::string_view word) {
  if (!starts_with(word)) return false;
  at_ += word.size();
  return true;
}

void TomlScanner::expect(std::string_view word, const char* what) {
  if (!skip(word)) fail(fmt::format("{} is expected here", what));
}

void TomlScanner::skip_blanks() {
  while (peek() == ' ' || peek() == '\t') ++at_;
}

bool TomlScanner::skip_line_end() {
  if (!skip("\n") && !skip("\r\n")) return false;
  ++line_;
  line_start_ = at_;
  return true;
}

void TomlScanner::skip_comment() {
  if (peek() != '#') return;
  while (!at_end() && peek() != '\n' && !starts_with("\r\n")) (void)take_text_character();
}

void TomlScanner::skip_blanks_and_lines() {
  do {
    skip_blanks();
    skip_comment();
  } while (skip_line_end());
}

void TomlScanner::end_line() {
  skip_blanks();
  skip_comment();
  if (!at_end() && !skip_line_end()) fail("the line should end here");
}

// Tabs are the only control characters that text may hold.
char TomlScanner::take_text_character() {
  const char c = peek();
  if ((std::uint8_t(c) < 0x20 && c != '\t') || c == 0x7F) {
    fail(at_end() ? "the text ends inside a string"
                  : "no control character or line end may stand here");
  }
  ++at_;
  return c;
}

std::string TomlScanner::scan_key_part() {
  if (peek() == '"' || peek() == '\'') {
    if (starts_with("\"\"\"") || starts_with("'''")) fail("a key can't be a long string");
    return scan_string();
  }
  const std::size_t begin = at_;
  while (is_bare_key_character(peek())) ++at_;
  if (at_ == begin) fail("a key is expected here; quote it if it has other than A-Z a-z 0-9 _ -");
  return std::string(text_.substr(begin, at_ - begin));
}

std::string TomlScanner::scan_string() {
  const char quote = peek();
  if (starts_with(long_quote(quote))) return scan_long_string(quote);
  ++at_;
  std::string text;
  while (peek() != quote || at_end()) {
    if (quote == '"' && peek() == '\\') {
      scan_escape(text);
    } else {
      text += take_text_character();
    }
  }
  ++at_;
  return text;
}

std::string TomlScanner::scan_long_string(char quote) {
  const std::string_view three = long_quote(quote);
  at_ += 3;
  skip_line_end();
  std::string text;
  while (!starts_with(three)) {
    if (quote == '"' && peek() == '\\') {
      scan_escape(text);
    } else if (skip_line_end()) {
      text += '\n';
    } else {
      text += take_text_character();
    }
  }
  at_ += 3;
  // The string itself may end in one or two quotes.
  for (int i = 0; i < 2 && peek() == quote; ++i) text += text_[at_++];
  return text;
}

void TomlScanner::scan_escape(std::string& text) {
  constexpr std::string_view kLetters = "btnfr\"\\", kMeanings = "\b\t\n\f\r\"\\";
  const TomlPlace start = place();
  ++at_;
  const char letter = peek();
  if (const auto index = kLetters.find(letter); !at_end() && index != std::string_view::npos) {
    text += kMeanings[index];
    ++at_;
    return;
  }
  if (letter != 'u' && letter != 'U') return scan_line_continuation();
  ++at_;
  const std::string_view digits = text_.substr(at_, letter == 'u' ? 4 : 8);
  const bool is_whole =
      digits.size() == (letter == 'u' ? 4 : 8) && std::ranges::all_of(digits, is_hex_digit);
  const auto code = is_whole ? parse_integer(digits, 16) : std::nullopt;
  if (!code || *code > 0x10FFFF || (*code >= 0xD800 && *code < 0xE000)) {
    fail_at(start, "\\u needs 4 and \\U 8 hexadecimal digits of a Unicode character");
  }
  append_utf8(std::uint32_t(*code), text);
  at_ += digits.size();
}

// A backslash at the end of a line of a long string swallows the space up to the next word.
void TomlScanner::scan_line_continuation() {
  const TomlPlace start = place();
  skip_blanks();
  if (!skip_line_end()) fail_at(start, "no such escape; use \\\\ for a backslash");
  do {
    skip_blanks();
  } while (skip_line_end());
}

TomlValue TomlScanner::scan_scalar() {
  TomlValue value;
  value.place = place();
  if (peek() == '"' || peek() == '\'') {
    value.data = scan_string();
    return value;
  }
  return scan_bare_value();
}

TomlValue TomlScanner::scan_bare_value() {
  TomlValue value;
  value.place = place();
  const std::size_t begin = at_;
  while (is_bare_value_character(peek())) ++at_;
  const std::string_view word = text_.substr(begin, at_ - begin);
  if (word == "true" || word == "false") {
    value.data = word == "true";
  } else if (looks_like_date(word)) {
    // The time may stand after a space.
    if (peek() == ' ' && at_ + 1 < text_.size() && is_digit(text_[at_ + 1])) {
      ++at_;
      while (is_bare_value_character(peek())) ++at_;
    }
    value.data = TomlDate{};
  } else if (const auto number = parse_number(word)) {
    value.data = *number;
  } else {
    fail_at(value.place, word.empty() ? "a value is expected here"
                                      : in_quotes(word) + " is no value; texts need quotes");
  }
  return value;
}

}  // namespace arris
