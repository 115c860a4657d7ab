// answer_table.h — remembers what has been found out about cells, as far as there is room
// What       a table of hashes of cells with an answer each, made when the first is asked for; an answer may be
//            overwritten by another cell's
// Threads    may be used by several
// Cost       8 bytes to an entry
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>

namespace arris {

// One round of SplitMix64. G. L. Steele, D. Lea, C. H. Flood, "Fast splittable pseudorandom number generators" (2014).
constexpr std::uint64_t mixed(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31U);
}

class AnswerTable {
 public:
  // Nothing can be asked.
  AnswerTable() = default;
  // For about so many answers, 512 to 512 k of which have room.
  explicit AnswerTable(double answers);

  // Answers are 0, 1 or 2. find: gives what isn't known.
  template <class Find>
  [[nodiscard]] unsigned answer(std::uint64_t hash, const Find& find) const {
    std::atomic<std::uint64_t>& entry = entry_of(hash);
    const std::uint64_t known = entry.load(std::memory_order_relaxed);
    if ((known & ~kAnswerBits) == (hash & ~kAnswerBits) && (known & kAnswerBits) != 0) {
      return unsigned(known & kAnswerBits) - 1;
    }
    const unsigned found = find();
    entry.store((hash & ~kAnswerBits) | (found + 1), std::memory_order_relaxed);
    return found;
  }

 private:
  static constexpr std::uint64_t kAnswerBits = 3;  // 0: nothing is known

  struct Table {
    std::once_flag once;
    // A hash, and an answer in its lowest bits.
    std::unique_ptr<std::atomic<std::uint64_t>[]> entries;
  };

  [[nodiscard]] std::atomic<std::uint64_t>& entry_of(std::uint64_t hash) const;

  int bits_ = 0;  // of the table's size
  std::unique_ptr<Table> table_;
};

}  // namespace arris
