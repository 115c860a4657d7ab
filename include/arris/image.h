// image.h — pictures in memory
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace arris {

// Of files that are read and pictures that are rendered.
inline constexpr std::int64_t kMaxPictureSide = 65535;
inline constexpr std::int64_t kMaxPicturePixels = std::int64_t(1) << 27;

// Interleaved float pixels, row 0 at the top. Colour channels are linear and scene-referred.
struct Image {
  int width_px = 0;
  int height_px = 0;
  int channels = 0;  // 1, 3 or 4 (alpha last, colour not premultiplied)
  std::vector<float> values;

  Image() = default;
  Image(int width, int height, int channel_count)
      : width_px(width),
        height_px(height),
        channels(channel_count),
        values(std::size_t(width) * std::size_t(height) * std::size_t(channel_count)) {}

  [[nodiscard]] std::size_t offset(int x, int y) const {
    return (std::size_t(y) * std::size_t(width_px) + std::size_t(x)) * std::size_t(channels);
  }
  [[nodiscard]] float at(int x, int y, int channel) const {
    return values[offset(x, y) + std::size_t(channel)];
  }
  [[nodiscard]] float& at(int x, int y, int channel) {
    return values[offset(x, y) + std::size_t(channel)];
  }
};

// An auxiliary picture by its AOV name: "albedo", "normal", "depth", "object", "rounded", …
struct Layer {
  std::string name;
  Image image;
};

// What a renderer returns and what files hold.
struct Picture {
  Image color;  // 3 channels
  std::vector<Layer> layers;
};

}  // namespace arris
