// interval.h — sets of real numbers between two doubles, rounded outward
// What       Interval's operations contain every real result of operands in their intervals; `Scalar` is what one
//            formula needs to serve double and Interval alike
// Guarantee  containment, also where denormals are flushed to zero; each operation is at most one ulp too wide on
//            either side, but near zero, where 2⁻¹⁰²² takes the place of the ulp (tests/base/interval_test.cpp)
// Limits     round-to-nearest arithmetic; endpoints may be infinite, never NaN for operands without NaN
// Cost       about three times the double operation
// Source     R. E. Moore, "Interval Analysis", 1966
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <limits>

namespace arris {

// The next double above, or one above that: at or above x + ulp(x)/2, which is where a rounded x may come from.
inline double next_up(double x) {
  constexpr double kTiny = std::numeric_limits<double>::min();
  if (x > -2 * kTiny && x < kTiny) return kTiny;
  if (!(x < std::numeric_limits<double>::infinity())) return x;
  const auto bits = std::bit_cast<std::uint64_t>(x);
  return std::bit_cast<double>(x > 0 ? bits + 1 : bits - 1);
}
inline double next_down(double x) {
  return -next_up(-x);
}

struct Interval {
  double lo = 0, hi = 0;

  constexpr Interval() = default;
  // A double is the interval of itself, as it is in formulas.
  constexpr Interval(double both) : lo(both), hi(both) {}  // NOLINT(google-explicit-constructor)
  constexpr Interval(double lo_, double hi_) : lo(lo_), hi(hi_) {}

  [[nodiscard]] constexpr double width() const { return hi - lo; }
  [[nodiscard]] constexpr bool contains(double x) const { return lo <= x && x <= hi; }

  friend constexpr bool operator==(const Interval&, const Interval&) = default;
  friend constexpr Interval operator-(Interval a) { return {-a.hi, -a.lo}; }
  friend Interval operator+(Interval a, Interval b) {
    return {next_down(a.lo + b.lo), next_up(a.hi + b.hi)};
  }
  friend Interval operator-(Interval a, Interval b) {
    return {next_down(a.lo - b.hi), next_up(a.hi - b.lo)};
  }
  friend Interval operator*(Interval a, Interval b) {
    const double p = times(a.lo, b.lo), q = times(a.lo, b.hi);
    const double r = times(a.hi, b.lo), s = times(a.hi, b.hi);
    return {next_down(std::min({p, q, r, s})), next_up(std::max({p, q, r, s}))};
  }
  friend Interval operator/(Interval a, Interval b) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    if (b.lo <= 0 && b.hi >= 0) return {-kInfinity, kInfinity};
    const Interval inverse{next_down(1 / b.hi), next_up(1 / b.lo)};
    if (std::isinf(a.lo) || std::isinf(a.hi) || std::isinf(b.lo) || std::isinf(b.hi)) {
      return a * inverse;
    }
    const double p = a.lo / b.lo, q = a.lo / b.hi, r = a.hi / b.lo, s = a.hi / b.hi;
    return {next_down(std::min({p, q, r, s})), next_up(std::max({p, q, r, s}))};
  }
  Interval& operator+=(Interval b) { return *this = *this + b; }
  Interval& operator-=(Interval b) { return *this = *this - b; }
  Interval& operator*=(Interval b) { return *this = *this * b; }

 private:
  // 0 · ∞ is 0 here: the infinite end stands for arbitrarily large numbers.
  static double times(double a, double b) { return a == 0 || b == 0 ? 0 : a * b; }
};

template <class T>
concept Scalar = std::same_as<T, double> || std::same_as<T, Interval>;

inline double square(double x) {
  return x * x;
}
inline double square_root(double x) {
  return x > 0 ? std::sqrt(x) : 0;
}
inline double absolute(double x) {
  return std::abs(x);
}

inline Interval absolute(Interval a) {
  if (a.lo >= 0) return a;
  if (a.hi <= 0) return -a;
  return {0, std::max(-a.lo, a.hi)};
}
inline Interval square(Interval a) {
  const Interval b = absolute(a);
  return {std::max(0.0, next_down(b.lo * b.lo)), next_up(b.hi * b.hi)};
}
// Of what is not negative in it; 0 if nothing is.
inline Interval square_root(Interval a) {
  return {a.lo > 0 ? next_down(std::sqrt(a.lo)) : 0, a.hi > 0 ? next_up(std::sqrt(a.hi)) : 0};
}
inline Interval hull(Interval a, Interval b) {
  return {std::min(a.lo, b.lo), std::max(a.hi, b.hi)};
}
// Of two intervals that contain one number.
inline Interval intersection(Interval a, Interval b) {
  return {std::max(a.lo, b.lo), std::min(a.hi, b.hi)};
}

}  // namespace arris
