// polynomial_roots.h — the roots of a polynomial of degree four or less in a range
// What       isolates by the roots of the derivative, then bisects; ascending
// Guarantee  every root at which the sign changes is found, to the last bits of double evaluation
// Limits     where the polynomial touches zero without changing sign it may find two roots or none
#pragma once

#include <array>
#include <cstddef>

namespace arris {

struct Roots {
  std::array<double, 4> values{};
  std::size_t count = 0;
};

// coefficients[i] belongs to x to the power i.
Roots find_roots(const std::array<double, 5>& coefficients, double low, double high);

}  // namespace arris
