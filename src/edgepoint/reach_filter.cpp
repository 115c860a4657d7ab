#include "edgepoint/reach_filter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "base/parallel_for.h"
#include "edgepoint/shifted_word.h"

namespace arris {
namespace {

// Of the B-spline along one axis, by distance.
constexpr std::array<float, 3> kSpline{0.375F, 0.25F, 0.0625F};
// How many standard deviations two colours may be apart; squared.
constexpr float kApart2 = 9;
// How far normals may turn, squared: about 9 degrees.
constexpr float kTurn2 = 0.15F * 0.15F;
// Colours this far apart are one, whatever their noise: relative, squared.
constexpr float kAlike2 = 1e-6F;

using Pixels = std::vector<NoisyPixel>;

// Bits of a plane as they are dx to the right and dy down; |dx| < 64, nothing beyond the picture.
std::uint64_t moved_word(const BitPlane& plane, int height, int y, int word, ReachOffset by) {
  const int from = y + by.dy;
  if (from < 0 || from >= height) return 0;
  return shifted_word(plane.row(from), word, by.dx);
}

class ReachFilter {
 public:
  ReachFilter(const EdgePointImage& image, const ReachFilterSettings& settings, Pixels& pixels)
      : image_(image),
        settings_(settings),
        reach_(image.reach),
        now_(pixels),
        is_sample_(pixels.size()) {
    for (std::size_t i = 0; i < pixels.size(); ++i) is_sample_[i] = pixels[i].known ? 1 : 0;
  }

  void run() {
    pass([&](int x, int y) { return pilot(x, y); });
    std::swap(guide_, next_);
    for (int level = 0; level < settings_.levels; ++level) {
      const int step = 1 << level;
      if (level > 0) lengthen(step / 2);
      pass([&](int x, int y) { return filtered(x, y, step); });
      std::swap(now_, next_);
      guide_ = now_;
    }
  }

 private:
  template <class Make>
  void pass(const Make& make) {
    next_.resize(now_.size());
    parallel_for(std::size_t(image_.height_px), {.grain = 4, .threads = settings_.threads},
                 [&](std::size_t y) {
                   for (int x = 0; x < image_.width_px; ++x)
                     next_[image_.offset(x, int(y))] = make(x, int(y));
                 });
  }

  // Of what reaches a pixel over `step`: call(where, weight).
  template <class Call>
  void for_reached(int x, int y, int step, const Call& call) const {
    for (std::size_t k = 0; k < kReachOffsets; ++k) {
      const auto [dx, dy] = kReachOffset[k];
      const float weight = kSpline[std::size_t(std::abs(dx))] * kSpline[std::size_t(dy)];
      if (reach_.at(k, x, y)) add(x + step * dx, y + step * dy, weight, call);
      const int bx = x - step * dx, by = y - step * dy;
      const bool inside = bx >= 0 && bx < image_.width_px && by >= 0;
      if (inside && reach_.at(k, bx, by)) add(bx, by, weight, call);
    }
  }
  template <class Call>
  void add(int x, int y, float weight, const Call& call) const {
    const std::size_t at = image_.offset(x, y);
    if (is_sample_[at] != 0) call(at, weight);
  }

  // The mean of all that reaches it: what colours are compared by at first. Also tells what is an outlier.
  [[nodiscard]] NoisyPixel pilot(int x, int y) const {
    const NoisyPixel& own = now_[image_.offset(x, y)];
    constexpr float kOwn = kSpline[0] * kSpline[0];
    NoisyPixel mean;
    float sum = 0, squares = 0;
    const auto take = [&](const NoisyPixel& p, float w) {
      mean.color += p.color * w;
      mean.variance += p.variance * w;
      sum += w;
      squares += w * w;
    };
    for_reached(x, y, 1, [&](std::size_t at, float w) {
      const Vec3f turn = own.normal - now_[at].normal;
      take(now_[at], w * std::exp(-dot(turn, turn) / kTurn2));
    });
    if (own.known) take(own, kOwn);
    if (!(sum > 0)) return own;
    mean.color *= 1 / sum;
    mean.variance *= squares / (sum * sum * sum);  // of the mean, of variances that are alike
    mean.known = true;
    mean.normal = own.normal;
    return mean;
  }

  [[nodiscard]] static float alike(const NoisyPixel& a, const NoisyPixel& b) {
    const Rgb d = a.color - b.color, v = a.variance + b.variance, m = a.color + b.color;
    float sum = 0;
    for (int c = 0; c < 3; ++c) {
      sum += d[c] * d[c] / (kApart2 * v[c] + kAlike2 * m[c] * m[c] + 1e-12F);
    }
    const Vec3f turn = a.normal - b.normal;
    return std::exp(-sum / 3 - dot(turn, turn) / kTurn2);
  }

  [[nodiscard]] NoisyPixel filtered(int x, int y, int step) const {
    const std::size_t here = image_.offset(x, y);
    const NoisyPixel& own = now_[here];
    const NoisyPixel& guide = guide_[here];
    NoisyPixel mean;
    float sum = 0;
    const auto take = [&](const NoisyPixel& p, float w) {
      mean.color += p.color * w;
      mean.variance += p.variance * (w * w);
      sum += w;
    };
    if (guide.known) {
      for_reached(x, y, step,
                  [&](std::size_t at, float w) { take(now_[at], w * alike(guide, guide_[at])); });
    }
    if (own.known) take(own, kSpline[0] * kSpline[0]);
    if (!(sum > 0)) return own;
    mean.color *= 1 / sum;
    mean.variance *= 1 / (sum * sum);
    mean.known = true;
    mean.normal = own.normal;
    return mean;
  }

  // From steps of half the length to those of twice that.
  void lengthen(int half) {
    const ReachPlanes before = reach_;
    parallel_for(std::size_t(image_.height_px), {.grain = 16, .threads = settings_.threads},
                 [&](std::size_t y) {
                   for (std::size_t k = 0; k < kReachOffsets; ++k) {
                     const ReachOffset by{half * kReachOffset[k].dx, half * kReachOffset[k].dy};
                     const BitPlane& plane = before.planes[k];
                     for (int word = 0; word < plane.words(); ++word) {
                       reach_.planes[k].row(int(y))[word] =
                           plane.row(int(y))[word] &
                           moved_word(plane, image_.height_px, int(y), word, by);
                     }
                   }
                 });
  }

  const EdgePointImage& image_;
  const ReachFilterSettings& settings_;
  ReachPlanes reach_;
  Pixels& now_;
  Pixels next_, guide_;
  std::vector<std::uint8_t> is_sample_;
};

}  // namespace

void filter_within_reach(const EdgePointImage& image, const ReachFilterSettings& settings,
                         std::vector<NoisyPixel>& pixels) {
  ReachFilter(image, settings, pixels).run();
}

}  // namespace arris
