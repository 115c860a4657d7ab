#include "view/picture_saver.h"

#include <exception>
#include <utility>

#include "io/picture_file.h"

namespace arris::view {
namespace {

PngFile encode(Image picture, double exposure) {
  SaveOptions options;
  options.exposure = exposure;
  return std::make_shared<const std::vector<std::uint8_t>>(
      encode_picture({std::move(picture), {}}, PictureFormat::png, options));
}

}  // namespace

PictureSaver::PictureSaver() : thread_([this] { run(); }) {}

PictureSaver::~PictureSaver() {
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

void PictureSaver::put(std::uint64_t number, const Image& picture, double exposure,
                       PictureSaved done) {
  Saved saved;
  {
    const std::lock_guard lock(mutex_);
    if (encoding_ && encoding_->number == number) {
      encoding_->done.push_back(std::move(done));
      return;
    }
    if (!saved_ || saved_->number != number) {
      if (!waiting_) waiting_ = Job{};
      if (waiting_->picture.values.empty() || waiting_->number != number) {
        waiting_->picture = picture;
      }
      waiting_->number = number;
      waiting_->exposure = exposure;
      waiting_->done.push_back(std::move(done));
      wake_.notify_all();
      return;
    }
    saved = *saved_;
  }
  done(saved.png, saved.error);
}

void PictureSaver::run() {
  for (;;) {
    Image picture;
    double exposure = 0;
    {
      std::unique_lock lock(mutex_);
      wake_.wait(lock, [&] { return stopped_ || waiting_; });
      if (stopped_) return;
      encoding_ = std::exchange(waiting_, std::nullopt);
      picture = std::move(encoding_->picture);
      exposure = encoding_->exposure;
    }
    Saved saved;
    try {
      saved.png = encode(std::move(picture), exposure);
    } catch (const std::exception& error) {
      saved.error = error.what();
    }
    std::vector<PictureSaved> done;
    {
      const std::lock_guard lock(mutex_);
      if (stopped_) return;
      saved.number = encoding_->number;
      done = std::move(encoding_->done);
      encoding_.reset();
      saved_ = saved;
    }
    for (const PictureSaved& each : done) each(saved.png, saved.error);
  }
}

}  // namespace arris::view
