// toml_scanner.h — the words of a TOML text: keys, strings, numbers, spaces
// Guarantee  reads each byte once; at the end of the text peek() is 0
// Errors     kind input with line and column
// Source     TOML v1.0.0 (2021)
#pragma once

#include <string>
#include <string_view>

#include "io/toml_document.h"

namespace arris {

class TomlScanner {
 public:
  // Precondition: the text is UTF-8.
  TomlScanner(std::string_view text, const std::string& where) : text_(text), where_(where) {}

  [[noreturn]] void fail(const std::string& what) const { fail_at(place(), what); }
  [[noreturn]] void fail_at(TomlPlace place, const std::string& what) const;

  [[nodiscard]] TomlPlace place() const;
  [[nodiscard]] bool at_end() const { return at_ == text_.size(); }
  [[nodiscard]] char peek() const { return at_end() ? '\0' : text_[at_]; }
  [[nodiscard]] bool starts_with(std::string_view word) const {
    return text_.substr(at_).starts_with(word);
  }

  // Steps over `word` if it comes next.
  bool skip(std::string_view word);
  // Steps over `word`; an error naming `what` if it does not come next.
  void expect(std::string_view word, const char* what);
  void skip_blanks();            // spaces and tabs
  void skip_blanks_and_lines();  // also comments and line ends
  void end_line();               // comment, then the line's or the text's end

  std::string scan_key_part();  // bare or quoted
  TomlValue scan_scalar();      // string, number, boolean or date

 private:
  std::string scan_string();
  std::string scan_long_string(char quote);
  void scan_escape(std::string& text);
  void scan_line_continuation();
  char take_text_character();
  void skip_comment();
  bool skip_line_end();
  TomlValue scan_bare_value();

  std::string_view text_;
  const std::string& where_;
  std::size_t at_ = 0, line_start_ = 0;
  std::uint32_t line_ = 1;
};

}  // namespace arris
