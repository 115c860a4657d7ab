#include "edgepoint/fresh_samples.h"

#include <bit>
#include <cstdint>

namespace arris {
namespace {

// In PointLook's steps. Changes make points staler by degrees: what is little wrong is better than few samples.
constexpr std::uint32_t kStale = 256 * 24;

}  // namespace

void find_fresh_samples(const PointCache& cache, RowBand band, EdgePointImage& image) {
  const std::span<const PointLook> looks = cache.looks();
  for (int y = band.first; y < band.last; ++y) {
    const PointKey* const points = image.points.data() + image.offset(0, y);
    const std::uint64_t* const samples = image.samples.row(y);
    std::uint64_t* const fresh = image.fresh.row(y);
    for (int word = 0; word < image.samples.words(); ++word) {
      std::uint64_t stale = 0;
      for (std::uint64_t rest = samples[word]; rest != 0; rest &= rest - 1) {
        const int bit = std::countr_zero(rest);
        const std::uint64_t is_stale = looks[points[64 * word + bit].point()].stale >= kStale;
        stale |= is_stale << unsigned(bit);
      }
      fresh[word] = samples[word] & ~stale;
    }
  }
}

}  // namespace arris
