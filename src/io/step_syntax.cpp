#include "io/step_syntax.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <string_view>
#include <vector>

#include "arris/error.h"
#include "base/utf8_text.h"
#include "io/mesh_readers.h"
#include "io/text_scanner.h"

namespace arris {
namespace {

constexpr std::string_view kFirst = "ISO-10303-21";
constexpr std::string_view kLast = "END-ISO-10303-21";
constexpr std::string_view kNoNumbers[] = {"nan", "inf", "infinity"};

bool is_blank(char c) {
  return c == ' ' || (c >= '\t' && c <= '\r');
}

class SyntaxCheck {
 public:
  SyntaxCheck(std::span<const std::uint8_t> bytes, const std::string& file)
      : text_(reinterpret_cast<const char*>(bytes.data()), bytes.size()), file_(file) {}

  void run() {
    begin();
    while (next_statement() != kLast) {
    }
    if (!has_data_) throw error("has no section DATA, so it holds no model");
  }

  // Of a file that run() has taken.
  std::optional<std::string> find_missing_entity() {
    wants_names_ = true;
    run();
    std::ranges::sort(entities_);
    for (const Name& name : names_) {
      if (std::ranges::binary_search(entities_, name.number)) continue;
      return fmt::format("line {} names #{}, which is not there", name.line, name.number);
    }
    return std::nullopt;
  }

 private:
  struct Name {
    std::uint64_t number = 0;
    std::size_t line = 0;
  };

  void begin() {
    if (text_.starts_with("\xEF\xBB\xBF")) at_ = 3;
    if (next_statement() != kFirst) throw error("a STEP file begins with \"ISO-10303-21;\"");
  }

  // Up to its semicolon; the word that it begins with.
  std::string_view next_statement() {
    std::string_view word;
    int depth = 0;
    while (true) {
      skip_blanks();
      if (at_ == text_.size()) throw cut_off("the file ends");
      const char c = text_[at_];
      if (c == ';') {
        ++at_;
        if (depth != 0) throw error("a statement ends within parentheses");
        has_data_ = has_data_ || word == "DATA";
        return word;
      }
      if (c == '\'' || c == '"') {
        skip_quoted(c);
      } else if (c == '(' || c == ')') {
        ++at_;
        depth += c == '(' ? 1 : -1;
        if (depth < 0) throw error("a parenthesis ends that did not begin");
        if (depth > kMaxStepDepth) {
          throw error(
              fmt::format("parentheses are more than {} levels deep; no STEP file needs so many",
                          kMaxStepDepth));
        }
      } else {
        const std::string_view plain = take_plain();
        if (wants_names_) take_names(plain, word.empty());
        if (word.empty()) word = plain;
      }
    }
  }

  void skip_blanks() {
    while (at_ < text_.size()) {
      if (is_blank(text_[at_])) {
        count_line();
        ++at_;
      } else if (text_.substr(at_).starts_with("/*")) {
        skip_comment();
      } else {
        return;
      }
    }
  }

  void skip_comment() {
    const std::size_t begin = line_;
    for (at_ += 2; at_ < text_.size(); ++at_) {
      count_line();
      if (!text_.substr(at_).starts_with("*/")) continue;
      at_ += 2;
      return;
    }
    throw cut_off(fmt::format("the comment that begins in line {} doesn't end", begin));
  }

  // A quote within is written twice: two strings, to this check.
  void skip_quoted(char quote) {
    const std::size_t begin = line_;
    for (++at_; at_ < text_.size(); ++at_) {
      count_line();
      if (text_[at_] != quote) continue;
      ++at_;
      return;
    }
    throw cut_off(fmt::format("the text in quotes that begins in line {} doesn't end", begin));
  }

  // Words, numbers and signs.
  std::string_view take_plain() {
    const std::size_t begin = at_;
    for (; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (is_blank(c) || std::string_view("'\"();").find(c) != std::string_view::npos) break;
      if (c < 0x21 || c > 0x7E) {
        throw error(fmt::format("found the byte 0x{:02x}, which no STEP file has outside of quotes",
                                unsigned(std::uint8_t(c))));
      }
      if (text_.substr(at_).starts_with("/*")) break;
    }
    const std::string_view plain = text_.substr(begin, at_ - begin);
    check_numbers(plain);
    return plain;
  }

  // Programs that can't print a number, on which Open CASCADE may loop for ever.
  void check_numbers(std::string_view plain) const {
    while (!plain.empty()) {
      const std::string_view number = plain.substr(0, plain.find(','));
      plain.remove_prefix(std::min(plain.size(), number.size() + 1));
      std::string_view digits = number;
      if (digits.starts_with('-') || digits.starts_with('+')) digits.remove_prefix(1);
      const bool is_word = std::ranges::any_of(
          kNoNumbers, [&](std::string_view word) { return equal_ignoring_case(digits, word); });
      if (is_word || number.find(".#") != std::string_view::npos) {
        throw error(
            fmt::format("found {} where a number should be; repair the model and export it "
                        "again",
                        in_quotes(number)));
      }
    }
  }

  // As in "#12=(#7,#8": an entity begins with its own.
  void take_names(std::string_view plain, bool begins) {
    for (std::size_t i = plain.find('#'); i < plain.size(); i = plain.find('#', i + 1)) {
      const char* const first = plain.data() + i + 1;
      std::uint64_t number = 0;
      if (std::from_chars(first, plain.data() + plain.size(), number).ptr == first) continue;
      if (begins && i == 0) {
        entities_.push_back(number);
      } else {
        names_.push_back({number, line_});
      }
    }
  }

  void count_line() {
    const bool pair = text_[at_] == '\r' && at_ + 1 < text_.size() && text_[at_ + 1] == '\n';
    if ((text_[at_] == '\n' || text_[at_] == '\r') && !pair) ++line_;
  }

  [[nodiscard]] Error error(const std::string& what) const {
    return {Error::Kind::input, fmt::format("{}:{}", file_, line_), what};
  }
  [[nodiscard]] Error cut_off(const std::string& what) const {
    return error(what + " before \"END-ISO-10303-21;\": it was cut off; copy or export it again");
  }

  std::string_view text_;
  const std::string& file_;
  std::size_t at_ = 0;
  std::size_t line_ = 1;
  bool has_data_ = false;
  bool wants_names_ = false;
  std::vector<std::uint64_t> entities_;
  std::vector<Name> names_;
};

}  // namespace

bool looks_like_step(std::span<const std::uint8_t> bytes) {
  std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  return text.starts_with(kFirst);
}

void check_step_syntax(std::span<const std::uint8_t> bytes, const std::string& file) {
  SyntaxCheck(bytes, file).run();
}

std::optional<std::string> find_missing_entity(std::span<const std::uint8_t> bytes,
                                               const std::string& file) {
  return SyntaxCheck(bytes, file).find_missing_entity();
}

}  // namespace arris
