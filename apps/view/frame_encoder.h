// frame_encoder.h — linear pictures as JPEG files for the viewer's page
// What       the display curve of 8-bit output (make_codes()), rows in parallel, then turbojpeg (JpegEncoder), in a
//            thread of its own (FrameEncoder), so that the next frame is made meanwhile
// Guarantee  within one code of what a saved PNG has, before JPEG's own loss
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "arris/image.h"
#include "view/view_renderer.h"

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

// 3 channels. exposure: stops. out: its memory is used again.
void make_codes(const Image& linear, double exposure, int threads, Rgb8Picture& out);

// One thread at a time may call it; it keeps its memory.
class JpegEncoder {
 public:
  JpegEncoder();
  std::vector<std::uint8_t> encode(const Rgb8Picture& picture, const JpegSettings& settings);

 private:
  struct Destroy {
    void operator()(void* handle) const;
  };
  std::unique_ptr<void, Destroy> compressor_;
};

class FrameEncoder {
 public:
  struct Outputs {
    std::function<void(std::shared_ptr<const ViewFrame>)> send_frame;
    std::function<void(const std::string&)> send_error;
  };

  // Outputs are called by the encoder's thread.
  explicit FrameEncoder(Outputs outputs);
  FrameEncoder(const FrameEncoder&) = delete;
  FrameEncoder& operator=(const FrameEncoder&) = delete;
  // No output follows.
  ~FrameEncoder();

  // Fills the frame's `jpeg` and sends it. A frame that still waits gives way to a newer one. Returns the memory of a
  // picture that is done with.
  Rgb8Picture put(std::shared_ptr<ViewFrame> frame, Rgb8Picture picture,
                  const JpegSettings& settings);

 private:
  struct Job {
    std::shared_ptr<ViewFrame> frame;
    Rgb8Picture picture;
    JpegSettings settings;
  };

  void run();

  Outputs outputs_;
  JpegEncoder jpeg_;
  std::mutex mutex_;
  std::condition_variable wake_;
  std::optional<Job> waiting_;
  Rgb8Picture spare_;
  bool stopped_ = false;
  std::thread thread_;  // the last: all else is there when it starts
};

}  // namespace arris::view
