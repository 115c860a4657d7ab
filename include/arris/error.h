// error.h — errors in the user's data
// What       thrown by load, validate and prepare; never while rendering
// Guarantee  what() is one complete message: place, value, limit, remedy
#pragma once

#include <stdexcept>
#include <string>

namespace arris {

class Error : public std::runtime_error {
 public:
  enum class Kind {
    input,   // the user's file or option is wrong (exit code 2)
    failed,  // the work could not be done: disk full, missing program (exit code 1)
  };

  // where: "leg.stl" or "scene.toml:12" or "object \"leg\""; may be empty.
  // what: value, limit and what to do.
  Error(Kind kind, std::string where, const std::string& what)
      : std::runtime_error(where.empty() ? what : where + ": " + what),
        kind_(kind),
        where_(std::move(where)) {}

  [[nodiscard]] Kind kind() const { return kind_; }
  [[nodiscard]] const std::string& where() const { return where_; }

 private:
  Kind kind_;
  std::string where_;
};

}  // namespace arris
