#include "rounding/answer_table.h"

namespace arris {
namespace {

constexpr int kLeastBits = 10, kMostBits = 19;
constexpr int kMoreBits = 3;  // of the next level

}  // namespace

AnswerTable::Level::Level(int bits)
    : bits(bits),
      most_stores(std::uint64_t{1} << (bits - 1)),
      entries(std::make_unique<std::atomic<std::uint64_t>[]>(std::size_t{1} << bits)) {}

const AnswerTable::Level& AnswerTable::first() const {
  const std::lock_guard lock(levels_->mutex);
  if (levels_->all.empty()) {
    levels_->all.push_back(std::make_unique<const Level>(kLeastBits));
    levels_->current.store(levels_->all.back().get(), std::memory_order_release);
  }
  return *levels_->all.back();
}

void AnswerTable::grow(const Level& from) const {
  if (from.bits >= kMostBits) return;
  const std::lock_guard lock(levels_->mutex);
  if (levels_->all.back().get() != &from) return;
  levels_->all.push_back(std::make_unique<const Level>(from.bits + kMoreBits));
  levels_->current.store(levels_->all.back().get(), std::memory_order_release);
}

}  // namespace arris
