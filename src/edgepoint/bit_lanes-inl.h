// bit_lanes-inl.h — words of a BitPlane as vectors, shifted by pixels, and as masks of vectors of pixels
//
// Included once for each kind of processor that the including file is compiled for (Highway's convention for -inl.h).
#if defined(ARRIS_EDGEPOINT_BIT_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef ARRIS_EDGEPOINT_BIT_LANES_INL_H
#undef ARRIS_EDGEPOINT_BIT_LANES_INL_H
#else
#define ARRIS_EDGEPOINT_BIT_LANES_INL_H
#endif

#include <hwy/highway.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

HWY_BEFORE_NAMESPACE();
namespace arris::HWY_NAMESPACE {

using WordLanes = hwy::HWY_NAMESPACE::ScalableTag<std::uint64_t>;
using WordVector = hwy::HWY_NAMESPACE::Vec<WordLanes>;
// Of pixels; sixteen at most, as rows of colours have margins for so many.
using PixelLanes = hwy::HWY_NAMESPACE::CappedTag<float, 16>;

// The words of a row from i on, as they are for the pixels kShift to the right (to the left if negative).
template <int kShift>
HWY_INLINE WordVector shifted_words(const std::uint64_t* row, int i) {
  namespace hn = hwy::HWY_NAMESPACE;
  const WordLanes d;
  const WordVector here = hn::LoadU(d, row + i);
  if constexpr (kShift == 0) {
    return here;
  } else if constexpr (kShift > 0) {
    return hn::Or(hn::ShiftRight<kShift>(here),
                  hn::ShiftLeft<64 - kShift>(hn::LoadU(d, row + i + 1)));
  } else {
    return hn::Or(hn::ShiftLeft<-kShift>(here),
                  hn::ShiftRight<64 + kShift>(hn::LoadU(d, row + i - 1)));
  }
}

// The bits of a word from one on, for as many pixels as the tag has lanes; `first` is a multiple of that.
template <class Tag>
HWY_INLINE hwy::HWY_NAMESPACE::Mask<Tag> mask_from(Tag tag, const std::uint64_t& word,
                                                   unsigned first) {
  namespace hn = hwy::HWY_NAMESPACE;
  if constexpr (hn::MaxLanes(Tag()) >= 8) {
    return hn::LoadMaskBits(tag, reinterpret_cast<const std::uint8_t*>(&word) + first / 8);
  } else {
    const std::uint64_t bits = word >> first;
    std::array<std::uint8_t, sizeof bits> bytes;
    std::memcpy(bytes.data(), &bits, sizeof bits);
    return hn::LoadMaskBits(tag, bytes.data());
  }
}

// A mask's lanes as the lowest bits.
template <class Tag>
HWY_INLINE std::uint64_t bits_of(Tag tag, hwy::HWY_NAMESPACE::Mask<Tag> mask) {
  namespace hn = hwy::HWY_NAMESPACE;
  std::array<std::uint8_t, 8> bytes{};
  hn::StoreMaskBits(tag, mask, bytes.data());
  std::uint64_t bits = 0;
  std::memcpy(&bits, bytes.data(), sizeof bits);
  return hn::Lanes(tag) == 64 ? bits : bits & ((std::uint64_t{1} << hn::Lanes(tag)) - 1);
}

}  // namespace arris::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
