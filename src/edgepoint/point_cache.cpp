#include "edgepoint/point_cache.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/check.h"

namespace arris {
namespace {

constexpr int kMostExponent = 31;
constexpr std::size_t kNoBlock = ~std::size_t{0};

// By more than rounding.
bool turns(const Mat3d& m) {
  const Mat3d none;
  const auto differs = [](Vec3d a, Vec3d b) { return length_squared(a - b) > 1e-18; };
  return differs(m.x, none.x) || differs(m.y, none.y) || differs(m.z, none.z);
}

}  // namespace

std::uint32_t pack_radiance(Rgb radiance, int stops) {
  static constexpr float kMost = 65408;  // (1 − 2⁻⁹) 2¹⁶
  const auto clamped = [](float v) { return v > 0 ? std::min(v, kMost) : 0.0F; };
  const float exposed = std::ldexp(1.0F, stops);
  const Rgb c{clamped(radiance.x * exposed), clamped(radiance.y * exposed),
              clamped(radiance.z * exposed)};
  const float largest = max_component(c);
  if (!(largest > 0)) return 0;
  int exponent = std::max(-kRadianceBias - 1, std::ilogb(largest)) + 1 + kRadianceBias;
  float scale = std::ldexp(1.0F, kRadianceBits + kRadianceBias - exponent);
  if (std::lround(largest * scale) == 1 << kRadianceBits) {
    ++exponent;
    scale *= 0.5F;
  }
  const auto mantissa = [&](float v) { return std::uint32_t(std::lround(v * scale)); };
  return mantissa(c.x) | mantissa(c.y) << 9U | mantissa(c.z) << 18U |
         std::uint32_t(std::min(exponent, kMostExponent)) << 27U;
}

PointCache::PointCache(std::size_t capacity, int stops, bool keeps_painted)
    : most_blocks_((capacity + kPointBlock - 1) / kPointBlock + 2), stops_(stops) {
  ARRIS_CHECK(most_blocks_ <= kMostPoints / kPointBlock, double(capacity));
  open_.fill(kNoBlock);
  const std::size_t places = most_blocks_ * kPointBlock;
  x_.resize(places);
  y_.resize(places);
  z_.resize(places);
  looks_.resize(places);
  normal_.resize(places);
  lower_object_.resize(places);
  if (keeps_painted) painted_.resize(places);
}

std::size_t PointCache::room_for(bool far, std::uint32_t frame) {
  std::size_t& open = open_[far ? 1 : 0];
  if (open != kNoBlock && blocks_[open].count < kPointBlock) return open;
  if (blocks_.size() < most_blocks_) {
    open = blocks_.size();
    blocks_.emplace_back();
  } else {
    // Of those of which as little is seen, the one that is oldest.
    std::size_t worst = kNoBlock;
    for (std::size_t i = 0; i < blocks_.size(); ++i) {
      if (i == open_[0] || i == open_[1]) continue;
      const auto rank = [&](std::size_t b) {
        return std::pair(blocks_[b].seen / 16, blocks_[b].filled);
      };
      if (worst == kNoBlock || rank(i) < rank(worst)) worst = i;
    }
    open = worst;
    blocks_[open] = PointBlock();
  }
  blocks_[open].is_far = far;
  blocks_[open].filled = frame;
  return open;
}

void PointCache::put(PointBlock& block, PointNumber number, const ShadedPoint& point,
                     std::uint32_t frame) {
  x_[number] = point.position.x;
  y_[number] = point.position.y;
  z_[number] = point.position.z;
  ARRIS_CHECK(point.object <= kFarObject, double(point.object));
  looks_[number] = {pack_radiance(point.radiance, stops_), 0, std::uint8_t(frame / kFramesOfAge),
                    std::uint8_t(point.object >> 16U)};
  lower_object_[number] = std::uint16_t(point.object);
  if (!painted_.empty()) {
    painted_[number] = std::uint8_t(std::lround(255 * std::clamp(point.painted, 0.0F, 1.0F)));
  }
  normal_[number] = block.is_far ? kNoNormal : pack_normal(point.normal);
  const bool is_only = block.count == 1;
  block.lower = is_only ? point.position : min(block.lower, point.position);
  block.upper = is_only ? point.position : max(block.upper, point.position);
}

void PointCache::add(std::span<const ShadedPoint> points, std::uint32_t frame) {
  for (const ShadedPoint& point : points) {
    const bool far = point.object == kFarObject;
    const std::size_t old = point.replaces / kPointBlock;
    if (old < blocks_.size() && point.replaces % kPointBlock < blocks_[old].count) {
      if (blocks_[old].is_far == far) {
        put(blocks_[old], point.replaces, point, frame);
        continue;
      }
      x_[point.replaces] = std::numeric_limits<float>::quiet_NaN();  // it is seen nowhere
    }
    const std::size_t open = room_for(far, frame);
    PointBlock& block = blocks_[open];
    const auto number = PointNumber(open * kPointBlock + block.count);
    ++block.count;
    put(block, number, point, frame);
  }
}

void PointCache::move(std::span<const std::optional<Affine3d>> to_from) {
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    PointBlock& block = blocks_[b];
    const auto first = PointNumber(b * kPointBlock);
    for (PointNumber i = first; i < first + block.count; ++i) {
      const std::uint32_t object = objects()[i];
      if (object >= to_from.size() || !to_from[object]) continue;
      const Vec3f p(transform_point(*to_from[object], Vec3d(position(i))));
      x_[i] = p.x;
      y_[i] = p.y;
      z_[i] = p.z;
      if (turns(to_from[object]->linear)) normal_[i] = kNoNormal;
      make_stale(kMovedStale, looks_[i]);
      block.lower = min(block.lower, p);
      block.upper = max(block.upper, p);
    }
  }
}

void PointCache::make_stale(Staleness staleness) {
  const std::size_t last = blocks_.size() * kPointBlock;
  for (std::size_t i = 0; i < last; ++i) make_stale(staleness, looks_[i]);
}

void PointCache::set_seen(std::span<const std::uint32_t> seen) {
  for (std::size_t i = 0; i < seen.size(); ++i) blocks_[i].seen = seen[i];
}

std::size_t PointCache::size() const {
  std::size_t count = 0;
  for (const PointBlock& block : blocks_) count += block.count;
  return count;
}

std::size_t PointCache::bytes() const {
  return x_.size() * (3 * sizeof(float) + sizeof(PackedNormal) + sizeof(PointLook) +
                      sizeof(std::uint16_t)) +
         painted_.size() + blocks_.size() * sizeof(PointBlock);
}

}  // namespace arris
