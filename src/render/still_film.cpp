#include "render/still_film.h"

#include <algorithm>

#include "base/parallel_for.h"

namespace arris {
namespace {

constexpr std::size_t kChunk = 1U << 14U;  // pixels

template <class Call>
void for_chunks(std::size_t count, int threads, const Call& call) {
  parallel_for((count + kChunk - 1) / kChunk, {.grain = 1, .threads = threads},
               [&](std::size_t c) { call(c * kChunk, std::min(count, (c + 1) * kChunk)); });
}

}  // namespace

void StillFilm::clear() {
  if (total_ == 0) return;
  std::fill(pixels_.begin(), pixels_.end(), Pixel{});
  total_ = 0;
}

void StillFilm::add(std::size_t pixel, Rgb sum, std::uint32_t paths) {
  pixels_[pixel].sum += sum;
  pixels_[pixel].paths += paths;
  total_ += paths;
}

std::uint32_t StillFilm::least_paths() const {
  if (total_ == 0) return 0;
  return std::min_element(pixels_.begin(), pixels_.end(),
                          [](const Pixel& a, const Pixel& b) { return a.paths < b.paths; })
      ->paths;
}

void StillFilm::blend_into(Image& picture, float interpolated_paths, int threads) const {
  if (total_ == 0) return;
  for_chunks(pixels_.size(), threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const Pixel& pixel = pixels_[i];
      if (pixel.paths == 0) continue;
      const float n = float(pixel.paths);
      const float k =
          interpolated_paths > 0 ? interpolated_paths / (1 + n / interpolated_paths) : 0.0F;
      const float whole = 1 / (n + k);
      float* const out = picture.values.data() + 3 * i;
      out[0] = (out[0] * k + pixel.sum.x) * whole;
      out[1] = (out[1] * k + pixel.sum.y) * whole;
      out[2] = (out[2] * k + pixel.sum.z) * whole;
    }
  });
}

void StillFilm::fill_wanted(std::span<std::uint8_t> wanted, int threads) const {
  std::uint32_t most = 0;
  for (const Pixel& pixel : pixels_) most = std::max(most, pixel.paths);
  for_chunks(pixels_.size(), threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      // Those that are behind first.
      wanted[i] = std::uint8_t(std::min<std::uint32_t>(255, 1 + 8 * (most - pixels_[i].paths)));
    }
  });
}

}  // namespace arris
