#include "view/frame_encoder.h"

#include <turbojpeg.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>

#include "arris/error.h"
#include "base/parallel_for.h"
#include "image/display_curve.h"
#include "image/srgb.h"

namespace arris::view {
namespace {

// Codes of values in [2^-13, 1), whose upper 9 bits of the fraction count: 1/512 of a value is less than half a code.
// What is below 2^-13 is code 0 (the first code begins at 1.5e-4).
constexpr int kFractionBits = 9, kOctaves = 13;
constexpr int kShift = 23 - kFractionBits;
constexpr std::uint32_t kFirst = std::uint32_t(127 - kOctaves) << kFractionBits;
constexpr std::size_t kTableSize = std::size_t(kOctaves) << kFractionBits;

std::array<std::uint8_t, kTableSize> make_table() {
  std::array<std::uint8_t, kTableSize> table{};
  for (std::size_t i = 0; i < kTableSize; ++i) {
    const std::uint32_t bits = ((kFirst + std::uint32_t(i)) << kShift) + (1U << (kShift - 1));
    table[i] = quantize8(srgb_from_linear(std::bit_cast<float>(bits)));
  }
  return table;
}

std::uint8_t code_of(float linear) {
  static const std::array<std::uint8_t, kTableSize> kCodes = make_table();
  if (!(linear > 0)) return 0;
  if (linear >= 1) return 255;
  const std::uint32_t at = std::bit_cast<std::uint32_t>(linear) >> kShift;
  return at < kFirst ? std::uint8_t(0) : kCodes[at - kFirst];
}

}  // namespace

void FrameEncoder::Destroy::operator()(void* handle) const {
  tjDestroy(handle);
}

FrameEncoder::FrameEncoder(int threads) : threads_(threads), compressor_(tjInitCompress()) {
  if (!compressor_) throw Error(Error::Kind::failed, "JPEG", tjGetErrorStr2(nullptr));
}
FrameEncoder::~FrameEncoder() = default;

const Rgb8Picture& FrameEncoder::tone_map(const Image& linear, double exposure) {
  picture_.width_px = linear.width_px;
  picture_.height_px = linear.height_px;
  picture_.samples.resize(linear.values.size());
  const float scale = exposure_scale(exposure);
  const std::size_t row = std::size_t(linear.width_px) * 3;
  parallel_for(std::size_t(linear.height_px), {.grain = 16, .threads = threads_},
               [&](std::size_t y) {
                 const float* from = linear.values.data() + y * row;
                 std::uint8_t* to = picture_.samples.data() + y * row;
                 for (std::size_t i = 0; i < row; i += 3) {
                   const Rgb shown = eval_display_curve({from[i], from[i + 1], from[i + 2]}, scale);
                   to[i] = code_of(shown.x);
                   to[i + 1] = code_of(shown.y);
                   to[i + 2] = code_of(shown.z);
                 }
               });
  return picture_;
}

std::vector<std::uint8_t> FrameEncoder::encode(const JpegSettings& settings) {
  unsigned char* buffer = nullptr;
  unsigned long size = 0;
  const int chroma = settings.chroma == ChromaDetail::full ? TJSAMP_444 : TJSAMP_420;
  const bool ok = tjCompress2(compressor_.get(), picture_.samples.data(), picture_.width_px, 0,
                              picture_.height_px, TJPF_RGB, &buffer, &size, chroma,
                              settings.quality, TJFLAG_FASTDCT) == 0;
  const std::unique_ptr<unsigned char, void (*)(unsigned char*)> owner(buffer, tjFree);
  if (!ok) throw Error(Error::Kind::failed, "JPEG", tjGetErrorStr2(compressor_.get()));
  return {buffer, buffer + size};
}

}  // namespace arris::view
