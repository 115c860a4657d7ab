// hash.h — mixing integers into well distributed bits
// Source     the constants: C. Wellons, "Prospecting for Hash Functions" (2018)
#pragma once

#include <cstdint>

namespace arris {

// Bijective; every input bit changes every output bit with probability near 1/2.
constexpr std::uint32_t hash_bits(std::uint32_t x) {
  x ^= x >> 16U;
  x *= 0x21f0aaadU;
  x ^= x >> 15U;
  x *= 0xd35a2d97U;
  x ^= x >> 15U;
  return x;
}

constexpr std::uint32_t hash_combine(std::uint32_t seed, std::uint32_t value) {
  return hash_bits(seed ^ (value * 0x9e3779b9U + 0x7f4a7c15U));
}

}  // namespace arris
