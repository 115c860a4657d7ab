#include "io/csg_arguments.h"

#include <fmt/format.h>

#include <array>

#include "base/utf8_text.h"

namespace arris {

Error ScadArguments::error(const std::string& what) const {
  return {Error::Kind::input, fmt::format("{}:{}", file_, node_.line), node_.name + ": " + what};
}

const ScadValue* ScadArguments::find(std::string_view name) const {
  std::size_t position = 0;
  const ScadValue* found = nullptr;
  for (const ScadArgument& argument : node_.arguments) {
    std::string_view known = argument.name;
    if (known.empty()) {
      known = position < by_position_.size() ? by_position_[position] : std::string_view();
      ++position;
    }
    if (known == name) found = &argument.value;
  }
  const bool is_undef = found != nullptr && std::holds_alternative<std::monostate>(found->data);
  return is_undef ? nullptr : found;
}

double ScadArguments::number(std::string_view name, double otherwise) const {
  const ScadValue* value = find(name);
  if (value == nullptr) return otherwise;
  if (const auto* number = std::get_if<double>(&value->data)) return *number;
  throw error(fmt::format("{} must be a number", name));
}

bool ScadArguments::flag(std::string_view name, bool otherwise) const {
  const ScadValue* value = find(name);
  if (value == nullptr) return otherwise;
  if (const auto* flag = std::get_if<bool>(&value->data)) return *flag;
  if (const auto* number = std::get_if<double>(&value->data)) return *number != 0;
  throw error(fmt::format("{} must be true or false", name));
}

std::string ScadArguments::text(std::string_view name) const {
  const ScadValue* value = find(name);
  if (value == nullptr) return "";
  if (const auto* text = std::get_if<std::string>(&value->data)) return *text;
  throw error(fmt::format("{} must be a text in quotes", name));
}

const ScadList& ScadArguments::list_of(const ScadValue& value, std::string_view name) const {
  if (const auto* list = std::get_if<ScadList>(&value.data)) return *list;
  throw error(fmt::format("{} must be a list", name));
}

std::vector<double> ScadArguments::numbers_of(const ScadValue& value, std::string_view name,
                                              std::size_t least, std::size_t most) const {
  const ScadList& list = list_of(value, name);
  std::vector<double> numbers;
  numbers.reserve(list.size());
  for (const ScadValue& element : list) {
    const auto* number = std::get_if<double>(&element.data);
    if (number == nullptr) throw error(fmt::format("{} holds what is no number", name));
    numbers.push_back(*number);
  }
  if (numbers.size() < least || numbers.size() > most) {
    throw error(fmt::format(
        "{} holds {} numbers; {} are needed", name, numbers.size(),
        least == most ? fmt::format("{}", least) : fmt::format("{} to {}", least, most)));
  }
  return numbers;
}

std::vector<double> ScadArguments::numbers(std::string_view name, std::size_t count,
                                           double otherwise) const {
  const ScadValue* value = find(name);
  if (value == nullptr) return std::vector<double>(count, otherwise);
  if (const auto* number = std::get_if<double>(&value->data)) {
    return std::vector<double>(count, *number);
  }
  std::vector<double> numbers = numbers_of(*value, name, count, 3);
  numbers.resize(count);
  return numbers;
}

Affine3d ScadArguments::matrix() const {
  std::array<std::array<double, 4>, 4> m{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
  if (const ScadValue* value = find("m")) {
    const ScadList& rows = list_of(*value, "the matrix");
    if (rows.size() > 4)
      throw error(fmt::format("the matrix has {} rows; 4 are needed", rows.size()));
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const std::vector<double> row = numbers_of(rows[i], "a row of the matrix", 0, 4);
      for (std::size_t k = 0; k < row.size(); ++k) m[i][k] = row[k];
    }
  }
  if (m[3][0] != 0 || m[3][1] != 0 || m[3][2] != 0) {
    throw error("the matrix's last row makes a perspective; it must be [0, 0, 0, 1]");
  }
  const auto column = [&](std::size_t k) { return Vec3d(m[0][k], m[1][k], m[2][k]) / m[3][3]; };
  return {{column(0), column(1), column(2)}, column(3)};
}

}  // namespace arris
