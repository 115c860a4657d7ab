// key_index.h — equal positions, or equal corners, share one vertex
// What       gives each distinct key a number, in the order of their first appearance
// In         keys of three 32-bit words that are equal if and only if their bits are
// Guarantee  deterministic. Keys made to collide in the hash cost bounded time: past kMaxProbes they are
//            numbered anew, which preparation's welding mends
// Cost       constant per key; 12 bytes per distinct key and 8 to 16 of table
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace arris {

template <class Key>
class KeyIndex {
 public:
  KeyIndex() : KeyIndex(0) {}
  // `expected`: about how many distinct keys there will be.
  explicit KeyIndex(std::size_t expected) {
    const std::size_t slots = std::bit_ceil(std::clamp(2 * expected, kMinSlots, kMaxFirstSlots));
    slots_.assign(slots, kEmpty);
    shift_ = 64 - std::countr_zero(slots);
  }

  std::uint32_t add(const Key& key) {
    if (2 * keys_.size() >= slots_.size()) grow();
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = slot_of(key);
    for (std::size_t probe = 0; probe < kMaxProbes; ++probe, slot = (slot + 1) & mask) {
      if (slots_[slot] == kEmpty) {
        slots_[slot] = std::uint32_t(keys_.size());
        break;
      }
      if (keys_[slots_[slot]] == key) return slots_[slot];
    }
    keys_.push_back(key);
    return std::uint32_t(keys_.size() - 1);
  }

  // Brings the table's place for a key that will be added soon into the cache.
  void prefetch(const Key& key) const { __builtin_prefetch(&slots_[slot_of(key)]); }

  [[nodiscard]] const std::vector<Key>& keys() const { return keys_; }
  std::vector<Key> take_keys() { return std::move(keys_); }

 private:
  static constexpr std::uint32_t kEmpty = ~std::uint32_t(0);
  static constexpr std::size_t kMaxProbes = 64;
  static constexpr std::size_t kMinSlots = 8;
  // A larger table is taken only once it is filled.
  static constexpr std::size_t kMaxFirstSlots = std::size_t(1) << 22;

  [[nodiscard]] std::size_t slot_of(const Key& key) const {
    const auto words = std::bit_cast<std::array<std::uint32_t, 3>>(key);
    std::uint64_t h = (std::uint64_t(words[0]) << 32 | words[1]) * 0x9E3779B97F4A7C15U;
    h = (h ^ (h >> 32) ^ words[2]) * 0xD6E8FEB86659FD93U;
    h = (h ^ (h >> 32)) * 0xD6E8FEB86659FD93U;
    return std::size_t(h >> shift_);
  }

  void grow() {
    --shift_;
    slots_.assign(2 * slots_.size(), kEmpty);
    const std::size_t mask = slots_.size() - 1;
    for (std::size_t i = 0; i < keys_.size(); ++i) {
      std::size_t slot = slot_of(keys_[i]);
      for (std::size_t probe = 0; probe < kMaxProbes; ++probe, slot = (slot + 1) & mask) {
        if (slots_[slot] != kEmpty) continue;
        slots_[slot] = std::uint32_t(i);
        break;
      }
    }
  }

  std::vector<Key> keys_;
  std::vector<std::uint32_t> slots_;  // a power of two, at most half full
  int shift_ = 0;                     // 64 - log2(slots_.size())
};

}  // namespace arris
