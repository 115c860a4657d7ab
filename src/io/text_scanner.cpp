#include "io/text_scanner.h"

#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "base/utf8_text.h"

namespace arris {
namespace {

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\v' || c == '\f' || c == '\r';
}

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? char(c + ('a' - 'A')) : c;
}

// from_chars takes no plus sign.
std::string_view without_plus(std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  return word;
}

// For a number that from_chars finds out of range: true if that is because it is too close to 0.
bool is_tiny(std::string_view word) {
  const std::size_t exponent = word.find_first_of("eE");
  const std::string_view digits = word.substr(0, exponent);
  const bool starts_with_zero = digits.find_first_of("123456789") > digits.find('.');
  if (exponent == std::string_view::npos) return starts_with_zero;
  // A mantissa of a few hundred digits could outweigh the exponent: such a word is no honest
  // number.
  return digits.size() < 40 && word.substr(exponent + 1, 1) == "-";
}

}  // namespace

std::optional<float> parse_float(std::string_view word) {
  word = without_plus(word);
  const char* const end = word.data() + word.size();
  float value = 0;
  const auto [stop, problem] = std::from_chars(word.data(), end, value);
  if (stop != end || word.empty()) return std::nullopt;
  if (problem == std::errc::result_out_of_range) {
    return is_tiny(word) ? std::optional<float>(0.0F) : std::nullopt;
  }
  if (problem != std::errc() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<std::int64_t> parse_integer(std::string_view word) {
  word = without_plus(word);
  const char* const end = word.data() + word.size();
  std::int64_t value = 0;
  const auto [stop, problem] = std::from_chars(word.data(), end, value);
  if (problem != std::errc() || stop != end) return std::nullopt;
  return value;
}

std::string_view trim(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

bool equal_ignoring_case(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (lower(a[i]) != lower(b[i])) return false;
  }
  return true;
}

TextScanner::TextScanner(std::span<const std::uint8_t> bytes, std::string file)
    : begin_(reinterpret_cast<const char*>(bytes.data())),
      next_(begin_),
      end_(begin_ + bytes.size()),
      file_(std::move(file)) {
  if (std::string_view(begin_, bytes.size()).starts_with("\xEF\xBB\xBF")) next_ += 3;
}

bool TextScanner::next_line() {
  line_ = {};
  if (next_ == end_) return false;
  // Kept from line to line: a file with CR alone would be searched whole for each of its lines.
  if (newline_ == nullptr || newline_ < next_) {
    const std::size_t left = std::size_t(end_ - next_);
    newline_ = static_cast<const char*>(std::memchr(next_, '\n', left));
    if (newline_ == nullptr) newline_ = end_;
  }
  const char* stop = newline_;
  // Files of old Macintosh programs end lines with CR alone.
  const auto* carriage =
      static_cast<const char*>(std::memchr(next_, '\r', std::size_t(stop - next_)));
  if (carriage != nullptr && carriage + 1 != stop) stop = carriage;
  line_ = std::string_view(next_, std::size_t(stop - next_));
  next_ = stop == end_ ? end_ : stop + 1;
  ++line_number_;
  return true;
}

std::string_view TextScanner::word() {
  std::size_t first = 0;
  while (first < line_.size() && is_blank(line_[first])) ++first;
  std::size_t last = first;
  while (last < line_.size() && !is_blank(line_[last])) ++last;
  const std::string_view found = line_.substr(first, last - first);
  line_.remove_prefix(last);
  return found;
}

std::string_view TextScanner::word_of_text() {
  while (true) {
    const std::string_view found = word();
    if (!found.empty() || !next_line()) return found;
  }
}

void TextScanner::cut_line_at(char mark) {
  line_ = line_.substr(0, line_.find(mark));
}

float TextScanner::number(std::string_view what) {
  const std::string_view found = word();
  if (found.empty()) {
    throw error("the line ends where " + std::string(what) + " should be; the file is damaged");
  }
  return to_number(found, what);
}

float TextScanner::to_number(std::string_view word, std::string_view what) const {
  if (const std::optional<float> value = parse_float(word)) return *value;
  double value = 0;
  const std::string_view plain = without_plus(word);
  const auto [stop, problem] = std::from_chars(plain.data(), plain.data() + plain.size(), value);
  const bool whole = !plain.empty() && stop == plain.data() + plain.size();
  const std::string place = std::string(what) + " is " + in_quotes(word);
  if (whole && problem != std::errc::invalid_argument && !std::isfinite(value)) {
    throw error(place + ", which is not finite; export the model again");
  }
  if (whole && problem != std::errc::invalid_argument) {
    throw error(place + ", beyond the largest number that is read (3.4e38); scale the model down");
  }
  if (word.find(',') != std::string_view::npos) {
    throw error(place + ", which is not a number; write decimals with a point, not a comma");
  }
  throw error(place + ", which is not a number");
}

Error TextScanner::error(const std::string& what) const {
  return {Error::Kind::input, file_ + ":" + std::to_string(line_number_), what};
}

}  // namespace arris
