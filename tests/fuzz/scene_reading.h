// scene_reading.h — stops the fuzzer where a reader breaks its word
#pragma once

#include <cstdio>
#include <cstdlib>
#include <utility>

#include "support/reading_problem.h"

namespace arris::test {

template <class Read>
void check_reading(std::span<const std::uint8_t> bytes, Read&& read) {
  const std::string problem = problem_of_reading(bytes, std::forward<Read>(read));
  if (problem.empty()) return;
  std::fprintf(stderr, "%s\n", problem.c_str());
  std::abort();
}

}  // namespace arris::test
