// scalar.h — comparisons that compile to one instruction; std::fmin and std::fmax don't, for the sake of NaN
#pragma once

namespace arris {

constexpr float max_of(float a, float b) {
  return a > b ? a : b;
}
constexpr float min_of(float a, float b) {
  return a < b ? a : b;
}
// x in [low, high]; high if x is NaN.
constexpr float clamp_to(float x, float low, float high) {
  return max_of(low, min_of(x, high));
}

}  // namespace arris
