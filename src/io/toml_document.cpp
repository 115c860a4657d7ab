#include "io/toml_document.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "arris/error.h"
#include "base/nearest_name.h"
#include "base/utf8_text.h"

namespace arris {
namespace {

constexpr std::size_t kMaxProblemsShown = 50;

const char* type_name(const TomlValue& value) {
  constexpr const char* kNames[] = {"a table",  "an array",  "a string",      "a whole number",
                                    "a number", "a boolean", "a date or time"};
  return kNames[value.data.index()];
}

std::optional<double> find_number(const TomlValue& value) {
  if (const auto* integer = std::get_if<std::int64_t>(&value.data)) return double(*integer);
  if (const auto* number = std::get_if<double>(&value.data)) return *number;
  return std::nullopt;
}

std::string describe(TomlRange range) {
  const bool has_least = std::isfinite(range.least), has_most = std::isfinite(range.most);
  if (range.least_excluded)
    return fmt::format("more than {:g}, at most {:g}", range.least, range.most);
  if (has_least && has_most) return fmt::format("{:g} to {:g}", range.least, range.most);
  if (has_least) return fmt::format("{:g} or more", range.least);
  return has_most ? fmt::format("{:g} or less", range.most) : "a finite number";
}

bool contains(TomlRange range, double value) {
  return std::isfinite(value) && value >= range.least && value <= range.most &&
         !(range.least_excluded && value == range.least);
}

}  // namespace

void TomlProblems::add(TomlPlace place, std::string what) {
  problems_.push_back({place, std::move(what)});
}

void TomlProblems::throw_if_any() {
  if (problems_.empty()) return;
  std::ranges::stable_sort(problems_, {}, [](const Problem& problem) {
    return std::tuple(problem.place.line, problem.place.column);
  });
  const auto place = [&](const Problem& problem) {
    return fmt::format("{}:{}:{}", where_, problem.place.line, problem.place.column);
  };
  std::string text = problems_.front().what;
  for (std::size_t i = 1; i < std::min(problems_.size(), kMaxProblemsShown); ++i) {
    text += fmt::format("\n{}: {}", place(problems_[i]), problems_[i].what);
  }
  if (problems_.size() > kMaxProblemsShown) {
    text += fmt::format("\n{}: and {} more", where_, problems_.size() - kMaxProblemsShown);
  }
  throw Error(Error::Kind::input, place(problems_.front()), text);
}

const TomlMember* TomlTableReader::find(std::string_view key) {
  if (std::ranges::find(known_, key) == known_.end()) known_.emplace_back(key);
  const auto member = std::ranges::find(table_, key, &TomlMember::key);
  return member == table_.end() ? nullptr : &*member;
}

bool TomlTableReader::has(std::string_view key) {
  return find(key) != nullptr;
}

void TomlTableReader::report_at(TomlPlace place, std::string_view name, const std::string& what) {
  problems_.add(place, fmt::format("{}{}{}: {}", title_, title_.empty() ? "" : " ", name, what));
}

void TomlTableReader::report(std::string_view key, const std::string& what) {
  const TomlMember* member = find(key);
  report_at(member != nullptr ? member->value.place : place_, key, what);
}

void TomlTableReader::report_missing(std::string_view key) {
  problems_.add(place_, fmt::format("{}: \"{}\" is missing", title_, key));
}

void TomlTableReader::report_unknown() {
  for (const TomlMember& member : table_) {
    if (std::ranges::find(known_, member.key) != known_.end()) continue;
    problems_.add(member.place,
                  fmt::format("{}{}unknown key {}{}", title_, title_.empty() ? "" : ": ",
                              in_quotes(member.key), did_you_mean(member.key, known_)));
  }
}

std::optional<bool> TomlTableReader::boolean(std::string_view key) {
  const TomlMember* member = find(key);
  if (member == nullptr) return std::nullopt;
  if (const bool* value = std::get_if<bool>(&member->value.data)) return *value;
  report(key, fmt::format("must be true or false, not {}", type_name(member->value)));
  return std::nullopt;
}

std::optional<double> TomlTableReader::number_of(const TomlValue& value, std::string_view name,
                                                 TomlRange range) {
  const std::optional<double> number = find_number(value);
  if (!number) {
    report_at(value.place, name, fmt::format("must be a number, not {}", type_name(value)));
  } else if (!contains(range, *number)) {
    report_at(value.place, name, fmt::format("is {}; use {}", *number, describe(range)));
  } else {
    return number;
  }
  return std::nullopt;
}

std::optional<double> TomlTableReader::number(std::string_view key, TomlRange range) {
  const TomlMember* member = find(key);
  if (member == nullptr) return std::nullopt;
  return number_of(member->value, key, range);
}

std::optional<int> TomlTableReader::integer(std::string_view key, int least, int most) {
  const TomlMember* member = find(key);
  if (member == nullptr) return std::nullopt;
  const std::optional<double> value = number(key, {double(least), double(most)});
  if (value && *value != std::floor(*value)) {
    report(key, fmt::format("is {}; it must be a whole number", *value));
    return std::nullopt;
  }
  return value ? std::optional(int(*value)) : std::nullopt;
}

std::optional<std::string> TomlTableReader::string(std::string_view key) {
  const TomlMember* member = find(key);
  if (member == nullptr) return std::nullopt;
  const auto* text = std::get_if<std::string>(&member->value.data);
  if (text == nullptr) {
    report(key, fmt::format("must be a string, not {}", type_name(member->value)));
    return std::nullopt;
  }
  if (text->find('\0') != std::string::npos) {
    report(key, "must not contain a null character");
    return std::nullopt;
  }
  return *text;
}

std::optional<std::vector<double>> TomlTableReader::numbers_of(const TomlValue& value,
                                                               std::string_view name,
                                                               std::size_t count, TomlRange range) {
  const auto* array = std::get_if<TomlArray>(&value.data);
  if (array == nullptr) {
    report_at(value.place, name,
              fmt::format("must be an array of {} numbers, not {}", count, type_name(value)));
    return std::nullopt;
  }
  if (array->size() != count) {
    report_at(value.place, name,
              fmt::format("has {} numbers; {} are needed", array->size(), count));
    return std::nullopt;
  }
  std::vector<double> numbers;
  for (const TomlValue& element : *array) {
    const auto number = number_of(element, name, range);
    // One line for each array: what is wrong with one number mostly is with all.
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

std::optional<std::vector<double>> TomlTableReader::numbers(std::string_view key, std::size_t count,
                                                            TomlRange range) {
  const TomlMember* member = find(key);
  if (member == nullptr) return std::nullopt;
  return numbers_of(member->value, key, count, range);
}

std::optional<Vec2d> TomlTableReader::vec2(std::string_view key, TomlRange range) {
  const auto v = numbers(key, 2, range);
  return v ? std::optional(Vec2d{(*v)[0], (*v)[1]}) : std::nullopt;
}

std::optional<Vec3d> TomlTableReader::vec3(std::string_view key, TomlRange range) {
  const auto v = numbers(key, 3, range);
  return v ? std::optional(Vec3d((*v)[0], (*v)[1], (*v)[2])) : std::nullopt;
}

std::optional<Vec3d> TomlTableReader::direction(std::string_view key) {
  const auto v = vec3(key, kTomlCoordinate);
  if (v && !(length_squared(*v) > 0)) {
    report(key, "must not be [0, 0, 0]: it is a direction");
    return std::nullopt;
  }
  return v;
}

std::optional<std::size_t> TomlTableReader::word_index(std::string_view key,
                                                       const std::vector<std::string>& names) {
  const std::optional<std::string> text = string(key);
  if (!text) return std::nullopt;
  const auto found = std::ranges::find(names, *text);
  if (found != names.end()) return std::size_t(found - names.begin());
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  report(key,
         fmt::format("{} is not one of {}{}", in_quotes(*text), list, did_you_mean(*text, names)));
  return std::nullopt;
}

}  // namespace arris
