#include "image/display_codes.h"

#include <algorithm>
#include <array>
#include <bit>

#include "image/display_curve.h"
#include "image/srgb.h"

#undef HWY_TARGET_INCLUDE
// NOLINTNEXTLINE(readability-identifier-naming)
#define HWY_TARGET_INCLUDE "image/display_codes.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each kind of processor

#include <hwy/highway.h>

#ifndef ARRIS_IMAGE_DISPLAY_CODES_ONCE
#define ARRIS_IMAGE_DISPLAY_CODES_ONCE
namespace arris {

// Codes of values from 2^-13 to 1, whose upper 9 bits of the fraction count: 1/512 of a value is less than half a code.
// What is below 2^-13 is code 0 (the first code begins at 1.5e-4).
struct CodeTable {
  static constexpr int kFractionBits = 9, kOctaves = 13;
  static constexpr int kShift = 23 - kFractionBits;
  static constexpr float kLeast = 1.0F / float(1 << kOctaves);
  static constexpr std::uint32_t kFirst = std::uint32_t(127 - kOctaves) << kFractionBits;
  static constexpr std::size_t kSize = (std::size_t(kOctaves) << kFractionBits) + 1;

  std::array<std::int32_t, kSize> codes;

  CodeTable() : codes() {
    for (std::size_t i = 0; i + 1 < kSize; ++i) {
      const std::uint32_t bits = ((kFirst + std::uint32_t(i)) << kShift) + (1U << (kShift - 1));
      codes[i] = quantize8(srgb_from_linear(std::bit_cast<float>(bits)));
    }
    codes.back() = 255;
  }
  // value: 0 to 1
  [[nodiscard]] std::int32_t of(float value) const {
    return codes[(std::bit_cast<std::uint32_t>(std::max(value, kLeast)) >> kShift) - kFirst];
  }
};

}  // namespace arris
#endif

HWY_BEFORE_NAMESPACE();
namespace arris::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Lanes = hn::CappedTag<float, 16>;
using Vector = hn::Vec<Lanes>;

HWY_INLINE Vector displayable(Vector value) {
  const Lanes f;
  return hn::IfThenElseZero(hn::Gt(value, hn::Zero(f)),
                            hn::Min(value, hn::Set(f, kBrightestShown)));
}

// eval_display_curve(), a vector of pixels at a time.
HWY_INLINE void eval_curve(float scale, Vector& r, Vector& g, Vector& b) {
  const Lanes f;
  const auto exposed = [&](Vector value) HWY_ATTR {
    return displayable(hn::Mul(displayable(value), hn::Set(f, scale)));
  };
  r = exposed(r);
  g = exposed(g);
  b = exposed(b);
  const Vector fresnel = hn::Set(f, DisplayCurve::kFresnel);
  const Vector least = hn::Min(r, hn::Min(g, b));
  const Vector small =
      hn::NegMulAdd(hn::Mul(least, least), hn::Set(f, 1 / (4 * DisplayCurve::kFresnel)), least);
  const Vector offset =
      hn::IfThenElse(hn::Lt(least, hn::Set(f, 2 * DisplayCurve::kFresnel)), small, fresnel);
  r = hn::Sub(r, offset);
  g = hn::Sub(g, offset);
  b = hn::Sub(b, offset);
  const Vector peak = hn::Max(r, hn::Max(g, b));
  const auto is_bright = hn::Ge(peak, hn::Set(f, DisplayCurve::kStartCompression));
  if (hn::AllFalse(f, is_bright)) return;
  constexpr float kRange = 1 - DisplayCurve::kStartCompression;
  const Vector one = hn::Set(f, 1);
  const Vector new_peak =
      hn::Sub(one, hn::Div(hn::Set(f, kRange * kRange),
                           hn::Add(peak, hn::Set(f, kRange - DisplayCurve::kStartCompression))));
  const Vector white = hn::Sub(one, hn::Div(one, hn::MulAdd(hn::Set(f, DisplayCurve::kDesaturation),
                                                            hn::Sub(peak, new_peak), one)));
  const Vector factor = hn::Mul(hn::Div(new_peak, peak), hn::Sub(one, white));
  const Vector added = hn::Mul(new_peak, white);
  const auto compressed = [&](Vector value) HWY_ATTR {
    return hn::IfThenElse(is_bright, hn::MulAdd(value, factor, added), value);
  };
  r = compressed(r);
  g = compressed(g);
  b = compressed(b);
}

void make_codes(const float* rgb, std::size_t pixels, float scale, const CodeTable& table,
                std::uint8_t* codes) {
  const Lanes f;
  const hn::RebindToSigned<Lanes> i32;
  const hn::Rebind<std::uint8_t, Lanes> u8;
  const auto codes_of = [&](Vector value) HWY_ATTR {
    const Vector inside = hn::Min(hn::Max(value, hn::Set(f, CodeTable::kLeast)), hn::Set(f, 1));
    const auto at = hn::Sub(hn::ShiftRight<CodeTable::kShift>(hn::BitCast(i32, inside)),
                            hn::Set(i32, std::int32_t(CodeTable::kFirst)));
    return hn::DemoteTo(u8, hn::GatherIndex(i32, table.codes.data(), at));
  };
  std::size_t i = 0;
  for (; i + hn::Lanes(f) <= pixels; i += hn::Lanes(f)) {
    Vector r, g, b;
    hn::LoadInterleaved3(f, rgb + 3 * i, r, g, b);
    eval_curve(scale, r, g, b);
    hn::StoreInterleaved3(codes_of(r), codes_of(g), codes_of(b), u8, codes + 3 * i);
  }
  for (; i < pixels; ++i) {
    const Rgb shown = eval_display_curve({rgb[3 * i], rgb[3 * i + 1], rgb[3 * i + 2]}, scale);
    codes[3 * i] = std::uint8_t(table.of(std::min(shown.x, 1.0F)));
    codes[3 * i + 1] = std::uint8_t(table.of(std::min(shown.y, 1.0F)));
    codes[3 * i + 2] = std::uint8_t(table.of(std::min(shown.z, 1.0F)));
  }
}

}  // namespace
}  // namespace arris::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace arris {

HWY_EXPORT(make_codes);

void make_display_codes(const float* rgb, std::size_t pixels, float scale, std::uint8_t* codes) {
  static const CodeTable kTable;
  HWY_DYNAMIC_DISPATCH(make_codes)(rgb, pixels, scale, kTable, codes);
}

}  // namespace arris
#endif
