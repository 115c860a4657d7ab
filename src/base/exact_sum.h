// exact_sum.h — sums of samples without rounding
// What       a fixed-point number of 128 bits in units of 2^-64
// Guarantee  the sum does not depend on the order or the grouping of what is added
//            (tests/base/exact_sum_test.cpp)
// Limits     a sample counts for at most kLargest, and by whole units; 2^24 samples fit
#pragma once

#include <algorithm>
#include <cmath>

namespace arris {

class ExactSum {
 public:
  __extension__ using Units = __int128;
  static constexpr double kUnit = 0x1p-64;
  static constexpr double kLargest = 0x1p32;  // of one sample: 2^56 is left for the sum

  ExactSum() = default;
  static ExactSum from_units(Units units) {
    ExactSum sum;
    sum.units_ = units;
    return sum;
  }

  void add(float sample) {
    units_ += Units(std::clamp(double(sample), -kLargest, kLargest) / kUnit);
  }
  // Wraps round where files hold sums that no render makes.
  void add(const ExactSum& other) { units_ = Units(Bits(units_) + Bits(other.units_)); }

  [[nodiscard]] Units units() const { return units_; }
  [[nodiscard]] double value() const { return double(units_) * kUnit; }
  friend bool operator==(const ExactSum&, const ExactSum&) = default;

 private:
  __extension__ using Bits = unsigned __int128;
  Units units_ = 0;
};

}  // namespace arris
