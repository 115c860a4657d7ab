// ply_rows.h — the rows of a PLY file's elements, from text or from binary data
// What       AsciiRows and BinaryRows have the same functions, called in the order begin_row(), then for
//            each property value(), value_or_nan(), or length() and its items, or skip(), then end_row()
// Errors     kind input; a value that is missing, malformed or, where a finite one is asked for, not finite
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "base/utf8_text.h"
#include "io/ply_header.h"
#include "io/text_scanner.h"

namespace arris {

// Where a row is, for errors.
struct PlyPlace {
  std::string_view element;
  std::uint64_t row = 0;
};

class AsciiRows {
 public:
  // One digit and what separates it from the next.
  static constexpr std::size_t min_bytes(PlyType /*type*/) { return 2; }

  explicit AsciiRows(TextScanner after_header) : text_(std::move(after_header)) {}

  [[nodiscard]] std::size_t bytes_left() const { return text_.bytes_left() + 1; }
  void begin_row(const PlyPlace& place) {
    while (text_.next_line()) {
      if (!text_.rest_of_line().empty()) return;
    }
    throw text_.error("the file ends where " + std::string(place.element) + " " +
                      std::to_string(place.row) + " should be: it is cut off");
  }
  double value(PlyType type, std::string_view what) { return to_number(word(what), type, what); }
  double value_or_nan(PlyType type, std::string_view what) {
    const std::string_view found = word(what);
    const bool is_nan = equal_ignoring_case(found, "nan") || equal_ignoring_case(found, "-nan");
    return is_nan ? std::numeric_limits<double>::quiet_NaN() : to_number(found, type, what);
  }
  double length(PlyType type) { return value(type, "a list's length"); }
  void skip(PlyType /*type*/, std::uint64_t count) {
    for (; count > 0; --count) {
      if (text_.word().empty()) throw text_.error("the line ends before the element's last value");
    }
  }
  void end_row() {
    const std::string_view word = text_.word();
    if (word.empty()) return;
    throw text_.error("found " + in_quotes(word) + " after the element's last value");
  }
  void end_file() {
    while (text_.next_line()) {
      if (text_.rest_of_line().empty()) continue;
      throw text_.error("more lines follow than the header's counts say");
    }
  }
  [[nodiscard]] Error error(const std::string& what) const { return text_.error(what); }

 private:
  std::string_view word(std::string_view what) {
    const std::string_view found = text_.word();
    if (found.empty()) throw text_.error("the line ends where " + std::string(what) + " should be");
    return found;
  }
  [[nodiscard]] double to_number(std::string_view found, PlyType type,
                                 std::string_view what) const {
    if (!is_integer(type)) return double(text_.to_number(found, what));
    const std::optional<std::int64_t> number = parse_integer(found);
    if (number) return double(*number);
    throw text_.error(std::string(what) + " is " + in_quotes(found) + ", which is not an integer");
  }

  TextScanner text_;
};

template <std::endian Order>
class BinaryRows {
 public:
  static constexpr std::size_t min_bytes(PlyType type) { return size_of(type); }

  BinaryRows(std::span<const std::uint8_t> bytes, std::size_t offset, std::string file)
      : bytes_(bytes), offset_(offset), file_(std::move(file)) {}

  [[nodiscard]] std::size_t bytes_left() const { return bytes_.size() - offset_; }
  void begin_row(const PlyPlace& place) {
    place_ = place;
    row_offset_ = offset_;
  }
  double value(PlyType type, std::string_view what) {
    const double number = take(type);
    if (std::isfinite(number)) return number;
    throw error(std::string(what) + " is not a finite number; export the model again");
  }
  double value_or_nan(PlyType type, std::string_view what) {
    const double number = take(type);
    if (!std::isinf(number)) return number;
    throw error(std::string(what) + " is infinite; export the model again");
  }
  double length(PlyType type) { return take(type); }
  void skip(PlyType type, std::uint64_t count) {
    if (count > bytes_left() / size_of(type)) fail_end();
    offset_ += std::size_t(count) * size_of(type);
  }
  void end_row() {}
  // Blanks and zeros may follow.
  void end_file() {
    for (const std::uint8_t byte : bytes_.subspan(offset_)) {
      if (byte == 0 || byte == ' ' || (byte >= '\t' && byte <= '\r')) continue;
      throw Error(Error::Kind::input, file_,
                  std::to_string(bytes_left()) + " bytes follow the last element (byte " +
                      std::to_string(offset_) + "): the header's counts are wrong");
    }
  }
  [[nodiscard]] Error error(const std::string& what) const {
    return {Error::Kind::input, file_,
            std::string(place_.element) + " " + std::to_string(place_.row) + " (byte " +
                std::to_string(row_offset_) + "): " + what};
  }

 private:
  [[noreturn]] void fail_end() const { throw error("the file ends here: it is cut off"); }

  template <class T>
  double take_as() {
    if (bytes_left() < sizeof(T)) fail_end();
    std::array<std::uint8_t, sizeof(T)> raw;
    std::memcpy(raw.data(), bytes_.data() + offset_, sizeof(T));
    offset_ += sizeof(T);
    if constexpr (Order != std::endian::native) std::reverse(raw.begin(), raw.end());
    return double(std::bit_cast<T>(raw));
  }

  double take(PlyType type) {
    switch (type) {
      case PlyType::int8:
        return take_as<std::int8_t>();
      case PlyType::uint8:
        return take_as<std::uint8_t>();
      case PlyType::int16:
        return take_as<std::int16_t>();
      case PlyType::uint16:
        return take_as<std::uint16_t>();
      case PlyType::int32:
        return take_as<std::int32_t>();
      case PlyType::uint32:
        return take_as<std::uint32_t>();
      case PlyType::float32:
        return take_as<float>();
      case PlyType::float64:
        break;
    }
    return take_as<double>();
  }

  std::span<const std::uint8_t> bytes_;
  std::size_t offset_;
  std::size_t row_offset_ = 0;
  std::string file_;
  PlyPlace place_;
};

}  // namespace arris
