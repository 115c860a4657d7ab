#include "rounding/methods.h"

#include <charconv>
#include <sstream>
#include <stdexcept>

namespace arris::bench {
namespace {

Method parse_method(const std::string& word) {
  if (word == "none") return {word, "no rounding", RoundMethod::none, 0};
  if (word == "exact") return {word, "exact", RoundMethod::exact, 0};
  if (word == "shader") return {word, "bevel shader", RoundMethod::shader, 0};
  if (word.starts_with("mesh:")) {
    int count = 0;
    const char* end = word.data() + word.size();
    const auto [rest, error] = std::from_chars(word.data() + 5, end, count);
    if (error == std::errc{} && rest == end && count > 0)
      return {word, std::to_string(count) + (count == 1 ? " subdivision" : " subdivisions"),
              RoundMethod::mesh, count};
  }
  throw std::invalid_argument("unknown method \"" + word + "\"; use none, exact, shader or mesh:N");
}

void apply(RoundingSettings& settings, const Method& method) {
  if (settings.method == RoundMethod::none) return;
  settings.method = method.method;
  if (method.method == RoundMethod::mesh) settings.subdivisions = method.subdivisions;
}

}  // namespace

std::vector<Method> parse_methods(const std::string& list) {
  std::vector<Method> methods;
  std::istringstream words(list);
  for (std::string word; std::getline(words, word, ',');) methods.push_back(parse_method(word));
  if (methods.empty()) throw std::invalid_argument("no methods; use for example none,exact");
  return methods;
}

Scene with_method(Scene scene, const Method& method) {
  if (scene.rounding) apply(*scene.rounding, method);
  for (Object& object : scene.objects)
    if (object.rounding) apply(*object.rounding, method);
  return scene;
}

}  // namespace arris::bench
