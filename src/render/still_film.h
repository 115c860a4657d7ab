// still_film.h — what a view that stands still adds up to
// What       Each pixel keeps the sum of its own paths, of the path tracer's sample sequence. The picture goes over
//            from what is interpolated to their mean as their number grows, so that a still view converges to what
//            paths of the shader give: for EdgePointShader::gi the path traced picture.
// Guarantee  the weight of what is interpolated falls with the square of the number of paths
// Cost       16 bytes a pixel
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "arris/image.h"
#include "arris/math.h"

namespace arris {

class StillFilm {
 public:
  explicit StillFilm(std::size_t pixels) : pixels_(pixels) {}

  void clear();
  void add(std::size_t pixel, Rgb sum, std::uint32_t paths);
  [[nodiscard]] std::uint32_t paths_of(std::size_t pixel) const { return pixels_[pixel].paths; }
  // Of the pixel with the fewest.
  [[nodiscard]] std::uint32_t least_paths() const;

  // What is interpolated stands for so many paths at first; 0: where there are paths, they alone count.
  void blend_into(Image& picture, float interpolated_paths, int threads) const;
  // How much each pixel wants more paths, 1 to 255.
  void fill_wanted(std::span<std::uint8_t> wanted, int threads) const;

 private:
  struct Pixel {
    Rgb sum;
    std::uint32_t paths = 0;
  };
  std::vector<Pixel> pixels_;
  std::uint64_t total_ = 0;
};

}  // namespace arris
