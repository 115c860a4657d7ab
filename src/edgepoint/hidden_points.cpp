#include "edgepoint/hidden_points.h"

#include <cmath>
#include <cstddef>

namespace arris {
namespace {

// Depths within what a steep surface gains over some pixels say nothing.
constexpr float kPixelsDeep = 8;
// So many samples around give a plane; fewer only a mean.
constexpr int kPlaneSamples = 6;
constexpr int kFewSamples = 2;

// Least squares of inverse depth over pixel offsets.
class DepthFit {
 public:
  void add(float dx, float dy, float inverse) {
    ++count_;
    x_ += dx;
    y_ += dy;
    xx_ += dx * dx;
    xy_ += dx * dy;
    yy_ += dy * dy;
    s_ += inverse;
    sx_ += dx * inverse;
    sy_ += dy * inverse;
  }
  [[nodiscard]] int count() const { return count_; }

  // The inverse depth at the middle, and how much it changes over a pixel in x and y together.
  struct Result {
    float inverse, slope;
  };
  [[nodiscard]] Result result() const {
    const float n = float(count_), mean = s_ / n;
    if (count_ < kPlaneSamples) return {mean, 0};
    const float mx = x_ / n, my = y_ / n;
    const float a = xx_ - n * mx * mx, b = xy_ - n * mx * my, c = yy_ - n * my * my;
    const float determinant = a * c - b * b;
    // Samples in a line fix no plane.
    if (!(determinant > n)) return {mean, 0};
    const float p = sx_ - n * mx * mean, q = sy_ - n * my * mean;
    const float slope_x = (c * p - b * q) / determinant, slope_y = (a * q - b * p) / determinant;
    return {mean - slope_x * mx - slope_y * my, std::abs(slope_x) + std::abs(slope_y)};
  }

 private:
  int count_ = 0;
  float x_ = 0, y_ = 0, xx_ = 0, xy_ = 0, yy_ = 0, s_ = 0, sx_ = 0, sy_ = 0;
};

bool is_hidden(const EdgePointImage& image, int x, int y, float depth, float pixel_size) {
  DepthFit fit;
  const auto add = [&](int dx, int dy) {
    if (!image.samples.at(x + dx, y + dy)) return;
    fit.add(float(dx), float(dy), 1 / image.points[image.offset(x + dx, y + dy)].depth());
  };
  for (std::size_t k = 0; k < kReachOffsets; ++k) {
    const auto [dx, dy] = kReachOffset[k];
    // Nothing beyond the picture is reached.
    if (image.reach.at(k, x, y)) add(dx, dy);
    const bool inside = x - dx >= 0 && x - dx < image.width_px && y - dy >= 0;
    if (inside && image.reach.at(k, x - dx, y - dy)) add(-dx, -dy);
  }
  if (fit.count() < kFewSamples) return false;
  const auto [inverse, slope] = fit.result();
  if (!(inverse > 0)) return false;
  // A sample may lie anywhere in its pixel.
  const float surface = 1 / inverse;
  const float tolerance = surface * (kPixelsDeep * pixel_size + slope * surface);
  return depth > surface + tolerance;
}

}  // namespace

std::vector<std::uint32_t> find_hidden_points(const EdgePointImage& image, const DepthCells& cells,
                                              RowBand band, float pixel_size) {
  std::vector<std::uint32_t> hidden;
  for (int y = band.first; y < band.last; ++y) {
    for (int x = 0; x < image.width_px; ++x) {
      const std::size_t at = image.offset(x, y);
      const PointKey point = image.points[at];
      if (point.is_none() || !image.samples.at(x, y)) continue;
      const float depth = point.depth();
      const float nearest = cells.nearest_at(float(x) + 0.5F, float(y) + 0.5F);
      if (depth <= nearest * (1 + kPixelsDeep * pixel_size)) continue;
      if (is_hidden(image, x, y, depth, pixel_size)) hidden.push_back(std::uint32_t(at));
    }
  }
  return hidden;
}

void remove_points(std::span<const std::uint32_t> pixels, EdgePointImage& image) {
  for (const std::uint32_t at : pixels) {
    image.points[at] = PointKey();
    const int x = int(at % std::uint32_t(image.width_px)),
              y = int(at / std::uint32_t(image.width_px));
    image.samples.row(y)[x >> 6] &= ~(std::uint64_t{1} << unsigned(x & 63));
    image.codes[at].clear_sample();
  }
}

}  // namespace arris
