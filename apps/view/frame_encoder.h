// frame_encoder.h — linear pictures as JPEG files for the viewer's page
// What       the display curve of 8-bit output (tone_map()), rows in parallel and by a table, then turbojpeg
// Guarantee  within one code of what a saved PNG has, before JPEG's own loss
// Cost       one thread at a time may call an encoder; it keeps its memory
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "arris/image.h"

namespace arris::view {

enum class ChromaDetail { half, full };  // 4:2:0, 4:4:4

struct JpegSettings {
  int quality = 90;
  ChromaDetail chroma = ChromaDetail::full;
};

struct Rgb8Picture {
  int width_px = 0, height_px = 0;
  std::vector<std::uint8_t> samples;  // 3 a pixel, row 0 at the top
};

class FrameEncoder {
 public:
  explicit FrameEncoder(int threads);
  FrameEncoder(const FrameEncoder&) = delete;
  FrameEncoder& operator=(const FrameEncoder&) = delete;
  ~FrameEncoder();

  // 3 channels. exposure: stops.
  const Rgb8Picture& tone_map(const Image& linear, double exposure);
  // Of what tone_map() made last.
  std::vector<std::uint8_t> encode(const JpegSettings& settings);

 private:
  struct Destroy {
    void operator()(void* handle) const;
  };
  int threads_;
  std::unique_ptr<void, Destroy> compressor_;
  Rgb8Picture picture_;
};

}  // namespace arris::view
