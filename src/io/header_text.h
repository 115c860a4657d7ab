// header_text.h — walks through the text in front of a picture's pixels
#pragma once

#include <charconv>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace arris {

class HeaderText {
 public:
  explicit HeaderText(std::span<const std::uint8_t> bytes)
      : text_(reinterpret_cast<const char*>(bytes.data()), bytes.size()) {}

  // Up to the next line feed, which is skipped; empty at the end of the file.
  std::optional<std::string_view> line() {
    const std::size_t end = text_.find('\n', position_);
    if (end == std::string_view::npos) return std::nullopt;
    const std::string_view found = text_.substr(position_, end - position_);
    position_ = end + 1;
    return found;
  }

  // Up to the next white space, of which one character is skipped.
  std::string_view word() {
    while (position_ < text_.size() && is_space(text_[position_])) ++position_;
    const std::size_t first = position_;
    while (position_ < text_.size() && !is_space(text_[position_])) ++position_;
    const std::string_view found = text_.substr(first, position_ - first);
    if (position_ < text_.size()) ++position_;
    return found;
  }

  [[nodiscard]] std::size_t position() const { return position_; }

 private:
  static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

  std::string_view text_;
  std::size_t position_ = 0;
};

// For messages: without control characters; "…" stands for what goes beyond max_bytes.
inline std::string printable(std::string_view text, std::size_t max_bytes = 60) {
  std::string shown(text.substr(0, max_bytes));
  for (char& c : shown) {
    if (c < ' ' || c > '~') c = '?';
  }
  return text.size() > max_bytes ? shown + "…" : shown;
}

template <class Number>
std::optional<Number> parse_number(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace arris
