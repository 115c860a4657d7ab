// sobol.h — Owen-scrambled Sobol points for one sample of one pixel
// What       a Sampler hands out the numbers of sample `sample` of pixel (x, y), one dimension after
//            another. Every pair is the two-dimensional Sobol sequence, padded: shuffled by a nested
//            uniform scramble of its index and Owen-scrambled, with hashes of (seed, x, y, dimension)
//            for seeds. A single number is the van der Corput sequence, shuffled and shifted digitally.
// Out        floats in [0, 1), multiples of 2^-24
// Guarantee  a sample's numbers depend on (seed, x, y, sample) and the dimension alone, so ranges A..B
//            are exact parts of one sequence. The first 2^k samples of a pixel put one point into each
//            of the 2^k intervals (1D), and into each elementary rectangle of area 2^-k (2D); so does
//            every aligned block of 2^k (tests/base/sobol_test.cpp).
// Limits     dimensions are independent of each other: no stratification across more than a pair
// Cost       about 2 ns for a number, 8 ns for a pair; 12 bytes of state
// Source     B. Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020;
//            the hash: N. Vegdahl, "Building a Better LK Hash" (2021);
//            the second dimension's matrix in five steps: A. Ahmed, "An Implementation Algorithm of 2D
//            Sobol Sequence" (2024)
#pragma once

#include <cstdint>

#include "arris/math.h"
#include "base/hash.h"

namespace arris {

constexpr std::uint32_t reverse_bits(std::uint32_t x) {
  x = ((x & 0x55555555U) << 1U) | ((x >> 1U) & 0x55555555U);
  x = ((x & 0x33333333U) << 2U) | ((x >> 2U) & 0x33333333U);
  x = ((x & 0x0f0f0f0fU) << 4U) | ((x >> 4U) & 0x0f0f0f0fU);
  return __builtin_bswap32(x);
}

constexpr std::uint64_t reverse_bits(std::uint64_t x) {
  x = ((x & 0x5555555555555555U) << 1U) | ((x >> 1U) & 0x5555555555555555U);
  x = ((x & 0x3333333333333333U) << 2U) | ((x >> 2U) & 0x3333333333333333U);
  x = ((x & 0x0f0f0f0f0f0f0f0fU) << 4U) | ((x >> 4U) & 0x0f0f0f0f0f0f0f0fU);
  return __builtin_bswap64(x);
}

// Owen scrambling of a number whose bits are reversed: a hash of the bits below flips each.
constexpr std::uint32_t scramble_reversed(std::uint32_t x, std::uint32_t seed) {
  x ^= x * 0x3d20adeaU;
  x += seed;
  x *= (seed >> 16U) | 1U;
  x ^= x * 0x05526c56U;
  x ^= x * 0x53a22864U;
  return x;
}

// Bit-reversed second Sobol dimension of an index: its product with Pascal's triangle modulo 2.
constexpr std::uint32_t sobol_second_reversed(std::uint32_t index) {
  index ^= (index >> 1U) & 0x55555555U;
  index ^= (index >> 2U) & 0x33333333U;
  index ^= (index >> 4U) & 0x0f0f0f0fU;
  index ^= (index >> 8U) & 0x00ff00ffU;
  index ^= index >> 16U;
  return index;
}

class Sampler {
 public:
  constexpr Sampler(std::uint32_t seed, std::uint32_t x, std::uint32_t y, std::uint32_t sample)
      : pixel_(hash_combine(hash_combine(hash_bits(seed ^ 0x68bc21ebU), x), y)),
        reversed_sample_(reverse_bits(sample)) {}

  // The dimension that comes next; paths set it at each vertex, so that all paths of a pixel use
  // the same dimension for the same decision however many numbers the earlier vertices took.
  constexpr void set_dimension(std::uint32_t dimension) { dimension_ = dimension; }

  // The shuffled index' radical inverse: the scramble of the reversed index is that already. Points of a
  // prefix lie in strata of their own, at one random offset.
  constexpr float next_1d() { return to_unit(scramble_reversed(reversed_sample_, next_seed())); }

  constexpr Vec2f next_2d() {
    const std::uint32_t seed = next_seed();
    const std::uint32_t index = reverse_bits(scramble_reversed(reversed_sample_, seed));
    const std::uint32_t x = scramble_reversed(index, seed * 0x9e3779b9U + 0x7f4a7c15U);
    const std::uint32_t y =
        scramble_reversed(sobol_second_reversed(index), seed * 0x85ebca6bU + 0x165667b1U);
    const std::uint64_t both = reverse_bits((std::uint64_t(x) << 32U) | y);  // of y, of x
    return {to_unit(std::uint32_t(both)), to_unit(std::uint32_t(both >> 32U))};
  }

 private:
  static constexpr float to_unit(std::uint32_t x) { return float(x >> 8U) * 0x1p-24F; }
  constexpr std::uint32_t next_seed() { return hash_bits(pixel_ + dimension_++ * 0x9e3779b9U); }

  std::uint32_t pixel_;
  std::uint32_t reversed_sample_;
  std::uint32_t dimension_ = 0;
};

}  // namespace arris
