#include "edgepoint/point_rows.h"

#include <algorithm>
#include <array>
#include <bit>

#undef HWY_TARGET_INCLUDE
// NOLINTNEXTLINE(readability-identifier-naming)
#define HWY_TARGET_INCLUDE "edgepoint/point_rows.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each kind of processor

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include "edgepoint/bit_lanes-inl.h"

#ifndef ARRIS_EDGEPOINT_POINT_ROWS_ONCE
#define ARRIS_EDGEPOINT_POINT_ROWS_ONCE
namespace arris {

// A point gets no older than that, in kFramesOfAge.
inline constexpr std::uint32_t kOld = 15;

// What looks are read against.
struct LookReading {
  std::uint32_t frame;
  std::uint32_t exponent;  // radiance_exponent()
};

}  // namespace arris
#endif

HWY_BEFORE_NAMESPACE();
namespace arris::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Unsigned = hn::RebindToUnsigned<PixelLanes>;
using Integers = hn::Vec<Unsigned>;

constexpr std::uint32_t kNone = 0xffffffff;  // both halves of a key without a point

// Calls for each vector of pixels: where it begins, and the lower and upper halves of their keys. Beyond the row's end
// there are no points.
template <class Call>
HWY_INLINE void for_keys(std::span<const PointKey> row, const Call& call) {
  const Unsigned u;
  const std::size_t lanes = hn::Lanes(u);
  Integers low, high;
  std::size_t x = 0;
  for (; x + lanes <= row.size(); x += lanes) {
    hn::LoadInterleaved2(u, reinterpret_cast<const std::uint32_t*>(row.data() + x), low, high);
    call(x, low, high);
  }
  if (x == row.size()) return;
  std::array<PointKey, hn::MaxLanes(Unsigned())> last;
  std::copy(row.begin() + std::ptrdiff_t(x), row.end(), last.begin());
  hn::LoadInterleaved2(u, reinterpret_cast<const std::uint32_t*>(last.data()), low, high);
  call(x, low, high);
}

std::uint64_t occupied(std::span<const PointKey> keys) {
  std::uint64_t bits = 0;
  for_keys(keys, [&](std::size_t x, Integers /*low*/, Integers high) HWY_ATTR {
    const Unsigned u;
    bits |= bits_of(u, hn::Ne(high, hn::Set(u, kNone))) << x;
  });
  return bits;
}

void inverse_depths(std::span<const PointKey> row, float* out) {
  for_keys(row, [&](std::size_t x, Integers /*low*/, Integers high) HWY_ATTR {
    const PixelLanes f;
    hn::StoreU(hn::Div(hn::Set(f, 1.0F), hn::BitCast(f, high)), f, out + x);
  });
}

void widen(std::span<const PointKey> row, const DepthColumns& columns) {
  for_keys(row, [&](std::size_t x, Integers /*low*/, Integers high) HWY_ATTR {
    const Unsigned u;
    const auto some = hn::Ne(high, hn::Set(u, kNone));
    hn::StoreU(hn::Min(hn::LoadU(u, columns.nearest + x), high), u, columns.nearest + x);
    hn::StoreU(hn::Max(hn::LoadU(u, columns.farthest + x), hn::IfThenElseZero(some, high)), u,
               columns.farthest + x);
    hn::StoreU(hn::Add(hn::LoadU(u, columns.count + x), hn::IfThenElseZero(some, hn::Set(u, 1))), u,
               columns.count + x);
  });
}

// looks: of each pixel's point, or anything.
void unpack(std::span<const PointKey> row, const PointLook* looks, LookReading reading,
            ColorRow colors, std::uint8_t* wishes) {
  for_keys(row, [&](std::size_t x, Integers /*low*/, Integers high) HWY_ATTR {
    const Unsigned u;
    const PixelLanes f;
    const hn::RebindToSigned<PixelLanes> s;
    const hn::Rebind<std::uint8_t, PixelLanes> bytes;
    const auto some = hn::Ne(high, hn::Set(u, kNone));
    Integers packed, rest;
    hn::LoadInterleaved2(u, reinterpret_cast<const std::uint32_t*>(looks + x), packed, rest);
    packed = hn::IfThenElseZero(some, packed);
    const auto nine = hn::Set(u, 511);
    // As in unpack_radiance().
    const auto exponent = hn::Add(hn::ShiftRight<27>(packed), hn::Set(u, reading.exponent));
    const auto scale = hn::BitCast(f, hn::ShiftLeft<23>(exponent));
    const auto channel = [&](Integers v) HWY_ATTR {
      return hn::Mul(hn::ConvertTo(f, hn::BitCast(s, hn::And(v, nine))), scale);
    };
    hn::StoreU(channel(packed), f, colors.r + x);
    hn::StoreU(channel(hn::ShiftRight<9>(packed)), f, colors.g + x);
    hn::StoreU(channel(hn::ShiftRight<18>(packed)), f, colors.b + x);
    // PointLook::stale, a step of which is 1/256, and born.
    const auto byte = hn::Set(u, 255);
    const auto stale = hn::And(hn::ShiftRight<8>(rest), byte), born = hn::ShiftRight<16>(rest);
    const auto age = hn::And(hn::Sub(hn::Set(u, reading.frame / kFramesOfAge), born), byte);
    const auto by_age = hn::Add(hn::Min(age, hn::Set(u, kOld)), hn::Set(u, 1));
    const auto wish = hn::IfThenElseZero(some, hn::Max(by_age, stale));
    hn::StoreU(hn::DemoteTo(bytes, hn::BitCast(s, wish)), bytes, wishes + x);
  });
}

// Fills `out` with what is wanted of up to 64 pixels; returns those of which nothing is known.
std::uint64_t wanted_of(const float* weight, const std::uint8_t* wishes, std::size_t count,
                        std::uint8_t* out) {
  const PixelLanes f;
  const hn::RebindToSigned<PixelLanes> s;
  const hn::Rebind<std::uint8_t, PixelLanes> bytes;
  std::uint64_t unknown = 0;
  for (std::size_t i = 0; i < count; i += hn::Lanes(f)) {
    const auto w = hn::LoadU(f, weight + i);
    // The less is known of it, the more: 200 / (1 + 3 w).
    const auto known = hn::MulAdd(hn::Set(f, 3.0F), w, hn::Set(f, 1.0F));
    const auto open = hn::ConvertTo(s, hn::Div(hn::Set(f, 200.0F), known));
    const auto wish = hn::PromoteTo(s, hn::LoadU(bytes, wishes + i));
    const auto none = hn::Not(hn::Gt(w, hn::Zero(f)));
    const auto wanted = hn::IfThenElse(hn::RebindMask(s, none), hn::Set(s, 255),
                                       hn::IfThenElse(hn::Eq(wish, hn::Zero(s)), open, wish));
    if (i + hn::Lanes(f) <= count) {
      hn::StoreU(hn::DemoteTo(bytes, wanted), bytes, out + i);
    } else {
      std::array<std::uint8_t, 64> last;
      hn::StoreU(hn::DemoteTo(bytes, wanted), bytes, last.data());
      std::copy_n(last.data(), count - i, out + i);
    }
    unknown |= bits_of(f, none) << i;
  }
  return count == 64 ? unknown : unknown & ((std::uint64_t{1} << count) - 1);
}

}  // namespace
}  // namespace arris::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace arris {

HWY_EXPORT(occupied);
HWY_EXPORT(inverse_depths);
HWY_EXPORT(widen);
HWY_EXPORT(unpack);
HWY_EXPORT(wanted_of);

std::uint64_t find_occupied(std::span<const PointKey> keys) {
  return HWY_DYNAMIC_DISPATCH(occupied)(keys);
}

void find_inverse_depths(std::span<const PointKey> row, float* out) {
  HWY_DYNAMIC_DISPATCH(inverse_depths)(row, out);
}

void add_depths(std::span<const PointKey> row, const DepthColumns& columns) {
  HWY_DYNAMIC_DISPATCH(widen)(row, columns);
}

void fetch_points(std::span<const PointKey> row, std::span<const PointKey> next,
                  const PointCache& cache, std::uint32_t frame, std::span<PointLook> looks,
                  ColorRow colors, std::uint8_t* wishes) {
  const std::span<const PointLook> all = cache.looks();
  if (all.empty()) return;
  // Of no point the number is beyond all. Which pixels have one can't be guessed, so there is no branch.
  const auto last = std::uint32_t(all.size() - 1);
  const auto look_of = [&](PointKey key) { return all.data() + std::min(key.point(), last); };
  for (const PointKey key : next) hwy::Prefetch(look_of(key));
  for (std::size_t x = 0; x < row.size(); ++x) looks[x] = *look_of(row[x]);
  const LookReading reading{frame, radiance_exponent(cache.stops())};
  HWY_DYNAMIC_DISPATCH(unpack)(row, looks.data(), reading, colors, wishes);
}

void find_wanted(std::span<std::uint8_t> wanted, const float* weight, const std::uint8_t* wishes,
                 std::size_t first, std::vector<std::uint32_t>& unresolved) {
  for (std::size_t x = 0; x < wanted.size(); x += 64) {
    std::uint64_t unknown = HWY_DYNAMIC_DISPATCH(wanted_of)(
        weight + x, wishes + x, std::min<std::size_t>(64, wanted.size() - x), wanted.data() + x);
    for (; unknown != 0; unknown &= unknown - 1) {
      unresolved.push_back(std::uint32_t(first + x) + std::uint32_t(std::countr_zero(unknown)));
    }
  }
}

}  // namespace arris
#endif
