#include "csg/polynomial_roots.h"

#include <cmath>

namespace arris {
namespace {

// Halving a range of any two doubles of like size ends after as many steps.
constexpr int kMaxSteps = 80;

double eval(const std::array<double, 5>& c, double x) {
  return (((c[4] * x + c[3]) * x + c[2]) * x + c[1]) * x + c[0];
}

// Newton's steps where they stay inside and shrink the bracket, halves otherwise.
double bracketed_root(const std::array<double, 5>& c, const std::array<double, 5>& slope,
                      double low, double high, bool rising) {
  double x = low + (high - low) / 2;
  double last = high - low;
  for (int i = 0; i < kMaxSteps; ++i) {
    const double f = eval(c, x);
    if (f == 0) return x;
    ((f > 0) == rising ? high : low) = x;
    const double step = f / eval(slope, x);
    double next = x - step;
    if (!(next > low && next < high) || std::abs(step) > last / 2) {
      next = low + (high - low) / 2;
    }
    last = std::abs(next - x);
    if (next == x || next <= low || next >= high) return next;
    x = next;
  }
  return x;
}

Roots roots_of_degree(const std::array<double, 5>& c, int degree, double low, double high) {
  Roots roots;
  if (degree == 0) return roots;
  std::array<double, 5> slope{};
  for (std::size_t i = 1; i < 5; ++i) slope[i - 1] = double(i) * c[i];
  const Roots turns = roots_of_degree(slope, degree - 1, low, high);
  double from = low, f_from = eval(c, low);
  for (std::size_t i = 0; i <= turns.count; ++i) {
    const double to = i < turns.count ? turns.values[i] : high;
    const double f_to = eval(c, to);
    if ((f_from <= 0) != (f_to <= 0) && roots.count < roots.values.size()) {
      roots.values[roots.count++] = bracketed_root(c, slope, from, to, f_to > f_from);
    }
    from = to;
    f_from = f_to;
  }
  return roots;
}

}  // namespace

Roots find_roots(const std::array<double, 5>& coefficients, double low, double high) {
  return roots_of_degree(coefficients, 4, low, high);
}

}  // namespace arris
