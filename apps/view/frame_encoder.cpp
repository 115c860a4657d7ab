#include "view/frame_encoder.h"

#include <turbojpeg.h>

#include <cstddef>
#include <exception>
#include <utility>

#include "arris/error.h"
#include "base/parallel_for.h"
#include "image/display_codes.h"
#include "image/display_curve.h"

namespace arris::view {

void make_codes(const Image& linear, double exposure, int threads, Rgb8Picture& out) {
  out.width_px = linear.width_px;
  out.height_px = linear.height_px;
  out.samples.resize(linear.values.size());
  const float scale = exposure_scale(exposure);
  const auto width = std::size_t(linear.width_px);
  parallel_for(
      std::size_t(linear.height_px), {.grain = 32, .threads = threads}, [&](std::size_t y) {
        const std::size_t first = 3 * width * y;
        make_display_codes(linear.values.data() + first, width, scale, out.samples.data() + first);
      });
}

void JpegEncoder::Destroy::operator()(void* handle) const {
  tjDestroy(handle);
}

JpegEncoder::JpegEncoder() : compressor_(tjInitCompress()) {
  if (!compressor_) throw Error(Error::Kind::failed, "JPEG", tjGetErrorStr2(nullptr));
}

std::vector<std::uint8_t> JpegEncoder::encode(const Rgb8Picture& picture,
                                              const JpegSettings& settings) {
  unsigned char* buffer = nullptr;
  unsigned long size = 0;
  const int chroma = settings.chroma == ChromaDetail::full ? TJSAMP_444 : TJSAMP_420;
  const bool ok =
      tjCompress2(compressor_.get(), picture.samples.data(), picture.width_px, 0, picture.height_px,
                  TJPF_RGB, &buffer, &size, chroma, settings.quality, TJFLAG_FASTDCT) == 0;
  const std::unique_ptr<unsigned char, void (*)(unsigned char*)> owner(buffer, tjFree);
  if (!ok) throw Error(Error::Kind::failed, "JPEG", tjGetErrorStr2(compressor_.get()));
  return {buffer, buffer + size};
}

FrameEncoder::FrameEncoder(Outputs outputs)
    : outputs_(std::move(outputs)), thread_([this] { run(); }) {}

FrameEncoder::~FrameEncoder() {
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

Rgb8Picture FrameEncoder::put(std::shared_ptr<ViewFrame> frame, Rgb8Picture picture,
                              const JpegSettings& settings) {
  Rgb8Picture spare;
  {
    const std::lock_guard lock(mutex_);
    spare = waiting_ ? std::move(waiting_->picture) : std::move(spare_);
    waiting_ = Job{std::move(frame), std::move(picture), settings};
  }
  wake_.notify_all();
  return spare;
}

void FrameEncoder::run() {
  for (;;) {
    std::optional<Job> job;
    {
      std::unique_lock lock(mutex_);
      wake_.wait(lock, [&] { return stopped_ || waiting_; });
      if (stopped_) return;
      job = std::exchange(waiting_, std::nullopt);
    }
    try {
      job->frame->jpeg = jpeg_.encode(job->picture, job->settings);
      outputs_.send_frame(std::move(job->frame));
    } catch (const std::exception& error) {
      outputs_.send_error(error.what());
    }
    const std::lock_guard lock(mutex_);
    spare_ = std::move(job->picture);
  }
}

}  // namespace arris::view
