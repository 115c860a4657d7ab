#include "rounding/answer_table.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace arris {
namespace {

constexpr int kLeastBits = 9, kMostBits = 19;

}  // namespace

AnswerTable::AnswerTable(double answers)
    : bits_(std::clamp(int(std::ceil(std::log2(std::max(answers, 1.0)))), kLeastBits, kMostBits)),
      table_(std::make_unique<Table>()) {}

std::atomic<std::uint64_t>& AnswerTable::entry_of(std::uint64_t hash) const {
  std::call_once(table_->once, [&] {
    table_->entries = std::make_unique<std::atomic<std::uint64_t>[]>(std::size_t{1} << bits_);
  });
  return table_->entries[hash >> (64 - bits_)];
}

}  // namespace arris
