// answer_table.h — remembers what has been found out about cells, as far as there is room
// What       a table of hashes of cells with an answer each, made when the first is asked for. An answer may be
//            overwritten by another cell's; where many are asked for, the table is replaced by larger ones.
// In / Out   what is found for a hash must not depend on anything else but roundings
// Threads    may be used by several
// Cost       8 bytes to an entry, 8 kB to 4 MB
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

namespace arris {

// For hashes of several values: hash = hash_with(hash, value). One round of SplitMix64. G. L. Steele, D. Lea, C. H.
// Flood, "Fast splittable pseudorandom number generators" (2014).
constexpr std::uint64_t hash_with(std::uint64_t hash, std::uint64_t value) {
  std::uint64_t x = (hash ^ value) + 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31U);
}

class AnswerTable {
 public:
  // Answers are 0, 1 or 2. find: gives what isn't known.
  template <class Find>
  [[nodiscard]] unsigned answer(std::uint64_t hash, const Find& find) const {
    const Level& level = current();
    std::atomic<std::uint64_t>& entry = level.entries[hash >> (64 - level.bits)];
    const std::uint64_t known = entry.load(std::memory_order_relaxed);
    if ((known & ~kAnswerBits) == (hash & ~kAnswerBits) && (known & kAnswerBits) != 0) {
      return unsigned(known & kAnswerBits) - 1;
    }
    const unsigned found = find();
    entry.store((hash & ~kAnswerBits) | (found + 1), std::memory_order_relaxed);
    if (level.stores.fetch_add(1, std::memory_order_relaxed) == level.most_stores) grow(level);
    return found;
  }

 private:
  static constexpr std::uint64_t kAnswerBits = 3;  // 0: nothing is known

  struct Level {
    explicit Level(int bits);

    int bits;
    std::uint64_t most_stores;  // before the next level is made
    // A hash, and an answer in its lowest bits.
    std::unique_ptr<std::atomic<std::uint64_t>[]> entries;
    mutable std::atomic<std::uint64_t> stores{0};
  };
  struct Levels {
    std::atomic<const Level*> current{nullptr};
    std::mutex mutex;
    std::vector<std::unique_ptr<const Level>>
        all;  // other threads may still look into smaller ones
  };

  [[nodiscard]] const Level& current() const {
    const Level* level = levels_->current.load(std::memory_order_acquire);
    return level != nullptr ? *level : first();
  }
  [[nodiscard]] const Level& first() const;
  void grow(const Level& from) const;

  std::unique_ptr<Levels> levels_ = std::make_unique<Levels>();
};

}  // namespace arris
