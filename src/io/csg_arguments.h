// csg_arguments.h — the arguments of a .csg node by name and type
// What       names that nobody asks for are ignored, as are undef values; the first argument without a name is that
//            of `by_position`, and so on
// Errors     kind input for a value of another type; where = "file:line", what names node and argument
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "arris/error.h"
#include "arris/math.h"
#include "io/csg_document.h"

namespace arris {

class ScadArguments {
 public:
  ScadArguments(const ScadNode& node, const std::string& file,
                std::span<const std::string_view> by_position = {})
      : node_(node), file_(file), by_position_(by_position) {}

  // Null if it isn't there or is undef.
  [[nodiscard]] const ScadValue* find(std::string_view name) const;
  [[nodiscard]] double number(std::string_view name, double otherwise) const;
  [[nodiscard]] bool flag(std::string_view name, bool otherwise) const;
  [[nodiscard]] std::string text(std::string_view name) const;
  // One number stands for all `count` of them.
  [[nodiscard]] std::vector<double> numbers(std::string_view name, std::size_t count,
                                            double otherwise) const;
  // A list of `count` numbers, or fewer where `least` says so.
  [[nodiscard]] std::vector<double> numbers_of(const ScadValue& value, std::string_view name,
                                               std::size_t least, std::size_t most) const;
  [[nodiscard]] const ScadList& list_of(const ScadValue& value, std::string_view name) const;
  // The 4×4 matrix of multmatrix; missing rows are those of the unit matrix. Divided by its last element.
  [[nodiscard]] Affine3d matrix() const;

  [[nodiscard]] Error error(const std::string& what) const;

 private:
  const ScadNode& node_;
  const std::string& file_;
  std::span<const std::string_view> by_position_;
};

}  // namespace arris
