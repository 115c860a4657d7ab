// text_scanner.h — lines, words and numbers of a text file
// What       walks a text in memory without copying; knows the line it is in
// Guarantee  numbers are read independently of the locale and correctly rounded; one that is
//            malformed, infinite, NaN or beyond float is an error that names line and value
// Limits     lines end with LF, CR LF or CR; blanks are space, tab, VT and FF
// Errors     kind input, where = "file:line"
// Cost       linear; long lines cost no memory
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "arris/error.h"

namespace arris {

// A correctly rounded float; too small a number is 0. Nothing for what is no finite float.
std::optional<float> parse_float(std::string_view word);

std::optional<std::int64_t> parse_integer(std::string_view word);

std::string_view trim(std::string_view text);

// ASCII letters only.
bool equal_ignoring_case(std::string_view a, std::string_view b);

class TextScanner {
 public:
  // A UTF-8 byte order mark is skipped. `file` is named in errors.
  TextScanner(std::span<const std::uint8_t> bytes, std::string file);

  // Moves to the next line; false at the end of the text. Call it before the first line, too.
  bool next_line();

  // The next word of this line; empty at its end.
  std::string_view word();
  // The next word of this line or a later one; empty at the end of the text.
  std::string_view word_of_text();
  // What is left of this line, trimmed.
  [[nodiscard]] std::string_view rest_of_line() const { return trim(line_); }
  // Leaves out what follows the mark in this line.
  void cut_line_at(char mark);
  void skip_line() { line_ = {}; }

  // The next word of this line as a number; `what` says which one is expected.
  float number(std::string_view what);
  float to_number(std::string_view word, std::string_view what) const;

  [[nodiscard]] std::size_t line_number() const { return line_number_; }
  // Offset of the first byte that next_line() has not taken.
  [[nodiscard]] std::size_t offset() const { return std::size_t(next_ - begin_); }
  [[nodiscard]] std::size_t bytes_left() const { return std::size_t(end_ - next_) + line_.size(); }

  [[nodiscard]] Error error(const std::string& what) const;

 private:
  const char* begin_;
  const char* next_;  // start of the line after this one
  const char* end_;
  // The first LF at next_ or later, once looked for; end_ if there is none.
  const char* newline_ = nullptr;
  std::string_view line_;
  std::size_t line_number_ = 0;
  std::string file_;
};

}  // namespace arris
