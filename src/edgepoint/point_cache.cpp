#include "edgepoint/point_cache.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "base/check.h"

namespace arris {
namespace {

constexpr int kMantissaBits = 9, kExponentBias = 15, kMostExponent = 31;
constexpr std::size_t kNoBlock = ~std::size_t{0};

}  // namespace

std::uint32_t pack_radiance(Rgb radiance) {
  static constexpr float kMost = 65408;  // (1 − 2⁻⁹) 2¹⁶
  const auto clamped = [](float v) { return v > 0 ? std::min(v, kMost) : 0.0F; };
  const Rgb c{clamped(radiance.x), clamped(radiance.y), clamped(radiance.z)};
  const float largest = max_component(c);
  if (!(largest > 0)) return 0;
  int exponent = std::max(-kExponentBias - 1, std::ilogb(largest)) + 1 + kExponentBias;
  float scale = std::ldexp(1.0F, kMantissaBits + kExponentBias - exponent);
  if (std::lround(largest * scale) == 1 << kMantissaBits) {
    ++exponent;
    scale *= 0.5F;
  }
  const auto mantissa = [&](float v) { return std::uint32_t(std::lround(v * scale)); };
  return mantissa(c.x) | mantissa(c.y) << 9U | mantissa(c.z) << 18U |
         std::uint32_t(std::min(exponent, kMostExponent)) << 27U;
}

Rgb unpack_radiance(std::uint32_t packed) {
  // 2^(exponent − bias − mantissa bits), made from its bits.
  const float scale =
      std::bit_cast<float>(((packed >> 27U) + 127 - kExponentBias - kMantissaBits) << 23U);
  return Rgb{float(packed & 511U), float(packed >> 9U & 511U), float(packed >> 18U & 511U)} * scale;
}

PointCache::PointCache(std::size_t capacity)
    : most_blocks_((capacity + kPointBlock - 1) / kPointBlock + 2) {
  ARRIS_CHECK(most_blocks_ <= kMostPoints / kPointBlock, double(capacity));
  open_.fill(kNoBlock);
}

PointBlock& PointCache::room_for(bool far, std::uint32_t frame) {
  std::size_t& open = open_[far ? 1 : 0];
  if (open != kNoBlock && blocks_[open]->count < kPointBlock) return *blocks_[open];
  if (blocks_.size() < most_blocks_) {
    open = blocks_.size();
    blocks_.push_back(std::make_unique<PointBlock>());
  } else {
    // Of those of which as little is seen, the one that is oldest.
    std::size_t worst = kNoBlock;
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
      if (i == open_[0] || i == open_[1]) continue;
      const auto rank = [&](std::size_t b) {
        return std::pair(blocks_[b]->seen / 16, blocks_[b]->filled);
      };
      if (worst == kNoBlock || rank(i) < rank(worst)) worst = i;
    }
    open = worst;
    blocks_[open]->count = 0;
  }
  PointBlock& block = *blocks_[open];
  block.is_far = far;
  block.seen = kPointBlock;
  block.filled = frame;
  return block;
}

void PointCache::put(PointBlock& block, std::uint32_t i, const ShadedPoint& point,
                     std::uint32_t frame) {
  block.x[i] = point.position.x;
  block.y[i] = point.position.y;
  block.z[i] = point.position.z;
  block.radiance[i] = pack_radiance(point.radiance);
  block.object[i] = point.object;
  block.born[i] = std::uint16_t(frame);
  const bool is_first = block.count == 1;
  block.lower = is_first ? point.position : min(block.lower, point.position);
  block.upper = is_first ? point.position : max(block.upper, point.position);
}

void PointCache::add(std::span<const ShadedPoint> points, std::uint32_t frame) {
  for (const ShadedPoint& point : points) {
    const bool far = point.object == kFarObject;
    if (point.replaces != kNoPoint && point.replaces / kPointBlock < blocks_.size()) {
      PointBlock& old = *blocks_[point.replaces / kPointBlock];
      const std::uint32_t place = point.replaces % kPointBlock;
      if (place < old.count) {
        if (old.is_far == far) {
          put(old, place, point, frame);
          continue;
        }
        old.x[place] = std::numeric_limits<float>::quiet_NaN();  // it is seen nowhere
      }
    }
    PointBlock& block = room_for(far, frame);
    ++block.count;
    put(block, block.count - 1, point, frame);
  }
}

void PointCache::move(std::uint32_t object, const Affine3d& to_from, std::uint32_t frame) {
  for (const std::unique_ptr<PointBlock>& block : blocks_) {
    bool moved = false;
    for (std::uint32_t i = 0; i < block->count; ++i) {
      if (block->object[i] != object) continue;
      const Vec3f p(transform_point(to_from, Vec3d(block->x[i], block->y[i], block->z[i])));
      block->x[i] = p.x;
      block->y[i] = p.y;
      block->z[i] = p.z;
      block->born[i] = std::uint16_t(frame - kStaleAge);
      block->lower = min(block->lower, p);
      block->upper = max(block->upper, p);
      moved = true;
    }
    if (moved) block->seen = std::max(block->seen, 1U);
  }
}

void PointCache::clear() {
  for (const std::unique_ptr<PointBlock>& block : blocks_) block->count = 0;
  open_.fill(kNoBlock);
  blocks_.clear();
}

void PointCache::set_seen(std::span<const std::uint32_t> seen) {
  for (std::size_t i = 0; i < seen.size(); ++i) blocks_[i]->seen = seen[i];
}

std::size_t PointCache::size() const {
  std::size_t count = 0;
  for (const std::unique_ptr<PointBlock>& block : blocks_) count += block->count;
  return count;
}

}  // namespace arris
