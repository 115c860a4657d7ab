// methods.h — the rows of the paper's table: none, exact, shader, mesh:N
#pragma once

#include <string>
#include <vector>

#include "arris/scene.h"

namespace arris::bench {

struct Method {
  std::string name;   // as on the command line
  std::string title;  // as in the paper, whose "our method" is "exact"
  RoundMethod method = RoundMethod::none;
  int subdivisions = 0;
};

// "none,exact,mesh:3". Throws std::invalid_argument that names the word.
std::vector<Method> parse_methods(const std::string& list);

// The scene with all its rounded objects rounded that way, by their own radii.
Scene with_method(Scene scene, const Method& method);

}  // namespace arris::bench
