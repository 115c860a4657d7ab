// toml_document.h — a TOML file as a tree of values with their places
// What       parse_toml() reads the text; TomlTableReader takes a table apart key by key, checks
//            types and ranges and collects every problem with its line and column
// Guarantee  work and memory are linear in the text; nesting is bounded
// Errors     parse_toml(): kind input with line and column; the reader only collects
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "arris/math.h"

namespace arris {

struct TomlPlace {
  std::uint32_t line = 1, column = 1;
};

struct TomlValue;
struct TomlMember;
using TomlArray = std::vector<TomlValue>;
using TomlTable = std::vector<TomlMember>;
struct TomlDate {};  // dates and times: no key takes one

struct TomlValue {
  TomlPlace place;
  std::variant<TomlTable, TomlArray, std::string, std::int64_t, double, bool, TomlDate> data;
};

struct TomlMember {
  std::string key;
  TomlPlace place;
  TomlValue value;
};

TomlTable parse_toml(std::string_view text, const std::string& where);

// What is wrong in a file, at which places.
class TomlProblems {
 public:
  explicit TomlProblems(std::string where) : where_(std::move(where)) {}

  void add(TomlPlace place, std::string what);
  [[nodiscard]] bool empty() const { return problems_.empty(); }
  [[nodiscard]] std::size_t count() const { return problems_.size(); }
  // One line for each problem, in the file's order. Throws Error unless there is none.
  void throw_if_any();

 private:
  struct Problem {
    TomlPlace place;
    std::string what;
  };
  std::string where_;
  std::vector<Problem> problems_;
};

struct TomlRange {
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool least_excluded = false;
};

// Coordinates beyond this lose too many digits in float.
inline constexpr TomlRange kTomlCoordinate{-1e9, 1e9};
inline constexpr TomlRange kTomlPositive{0, 1e9, true};
inline constexpr TomlRange kTomlNotNegative{0, 1e9};
inline constexpr TomlRange kTomlUnit{0, 1};

// A word of a fixed list and what it stands for.
template <class T>
struct TomlWord {
  std::string_view word;
  T value;
};

// Every getter returns nothing if the key is missing, or if its value is wrong, which it reports.
class TomlTableReader {
 public:
  // `title` begins messages: "[camera]", "material \"brass\"".
  TomlTableReader(const TomlTable& table, TomlPlace place, std::string title,
                  TomlProblems& problems)
      : table_(table), place_(place), title_(std::move(title)), problems_(problems) {}

  [[nodiscard]] const TomlMember* find(std::string_view key);
  [[nodiscard]] bool has(std::string_view key);
  [[nodiscard]] TomlPlace place() const { return place_; }
  [[nodiscard]] const std::string& title() const { return title_; }

  std::optional<bool> boolean(std::string_view key);
  std::optional<double> number(std::string_view key, TomlRange range);
  std::optional<int> integer(std::string_view key, int least, int most);
  std::optional<std::string> string(std::string_view key);
  std::optional<Vec2d> vec2(std::string_view key, TomlRange range);
  std::optional<Vec3d> vec3(std::string_view key, TomlRange range);
  // A vector that is not 0.
  std::optional<Vec3d> direction(std::string_view key);
  template <class T>
  std::optional<T> word(std::string_view key, std::span<const TomlWord<T>> words) {
    std::vector<std::string> names;
    for (const TomlWord<T>& entry : words) names.emplace_back(entry.word);
    const std::optional<std::size_t> index = word_index(key, names);
    if (!index) return std::nullopt;
    return words[*index].value;
  }

  // Values that are not the member of a table.
  std::optional<double> number_of(const TomlValue& value, std::string_view name, TomlRange range);
  std::optional<std::vector<double>> numbers_of(const TomlValue& value, std::string_view name,
                                                std::size_t count, TomlRange range);

  // `what` at the place of the key, or of the table if the key is missing.
  void report(std::string_view key, const std::string& what);
  void report_missing(std::string_view key);
  // Keys that no call asked for: to be called last.
  void report_unknown();

 private:
  std::optional<std::size_t> word_index(std::string_view key,
                                        const std::vector<std::string>& names);
  std::optional<std::vector<double>> numbers(std::string_view key, std::size_t count,
                                             TomlRange range);
  void report_at(TomlPlace place, std::string_view name, const std::string& what);

  const TomlTable& table_;
  TomlPlace place_;
  std::string title_;
  TomlProblems& problems_;
  std::vector<std::string> known_;
};

}  // namespace arris
