#include "io/position_index.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace arris {
namespace {

constexpr int kFirstBits = 8;
// More slots than this are taken only when they are filled.
constexpr std::size_t kMaxReserved = std::size_t(1) << 22;

std::uint64_t hash_of(Vec3f position) {
  const std::uint64_t x = std::bit_cast<std::uint32_t>(position.x);
  const std::uint64_t y = std::bit_cast<std::uint32_t>(position.y);
  const std::uint64_t z = std::bit_cast<std::uint32_t>(position.z);
  std::uint64_t h = (x << 32 | y) * 0x9E3779B97F4A7C15U;
  h = (h ^ (h >> 32) ^ z) * 0xD6E8FEB86659FD93U;
  h = (h ^ (h >> 32)) * 0xD6E8FEB86659FD93U;
  return h;
}

}  // namespace

PositionIndex::PositionIndex(std::size_t expected) {
  // A closed mesh has six corners for each of its vertices.
  const std::size_t slots = std::bit_ceil(std::min(expected / 3 + 1, kMaxReserved));
  const int bits = std::max(kFirstBits, std::countr_zero(slots));
  slots_.assign(std::size_t(1) << bits, kEmpty);
  shift_ = 64 - bits;
}

std::size_t PositionIndex::slot_of(Vec3f position) const {
  return std::size_t(hash_of(position) >> shift_);
}

void PositionIndex::prefetch(Vec3f position) const {
  __builtin_prefetch(&slots_[slot_of(position + Vec3f(0.0F))]);
}

std::uint32_t PositionIndex::add(Vec3f position) {
  position += Vec3f(0.0F);  // -0 becomes 0
  if (2 * positions_.size() >= slots_.size()) grow();
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = slot_of(position);
  for (std::size_t probe = 0; probe < kMaxProbes; ++probe, slot = (slot + 1) & mask) {
    if (slots_[slot] == kEmpty) {
      slots_[slot] = std::uint32_t(positions_.size());
      break;
    }
    if (positions_[slots_[slot]] == position) return slots_[slot];
  }
  positions_.push_back(position);
  return std::uint32_t(positions_.size() - 1);
}

void PositionIndex::grow() {
  --shift_;
  slots_.assign(2 * slots_.size(), kEmpty);
  const std::size_t mask = slots_.size() - 1;
  for (std::size_t i = 0; i < positions_.size(); ++i) {
    std::size_t slot = slot_of(positions_[i]);
    for (std::size_t probe = 0; probe < kMaxProbes; ++probe, slot = (slot + 1) & mask) {
      if (slots_[slot] != kEmpty) continue;
      slots_[slot] = std::uint32_t(i);
      break;
    }
  }
}

}  // namespace arris
