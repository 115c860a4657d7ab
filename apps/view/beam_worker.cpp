#include "view/beam_worker.h"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "arris/error.h"
#include "arris/render.h"
#include "io/picture_file.h"

namespace arris::view {

BeamWorker::~BeamWorker() {
  {
    const std::lock_guard lock(mutex_);
    next_.reset();
    ended_ = true;
    stop_ = true;
  }
  if (thread_.joinable()) thread_.join();
}

// The thread lives until nothing is left to be done.
void BeamWorker::start(Scene scene, const BeamSettings& settings, int threads,
                       std::function<void()> changed) {
  {
    const std::lock_guard lock(mutex_);
    next_ = Request{std::move(scene), settings, threads, std::move(changed)};
    stop_ = true;
    status_.reset();
    png_.clear();
    if (running_) return;
    running_ = true;
  }
  if (thread_.joinable()) thread_.join();
  thread_ = std::thread([this] { run(); });
}

void BeamWorker::stop() {
  const std::lock_guard lock(mutex_);
  // The thread may be on its way out.
  const bool is_made = next_ || (running_ && !stop_);
  next_.reset();
  stop_ = true;
  if (!is_made && status_) return;  // there is something to be said
  const bool ready = !png_.empty();
  status_ = Status{ready ? 1.0 : 0.0, ready, !ready, ""};
}

void BeamWorker::run() {
  for (;;) {
    std::optional<Request> request;
    {
      const std::lock_guard lock(mutex_);
      if (!next_ || ended_) {
        running_ = false;
        return;
      }
      request = std::exchange(next_, std::nullopt);
      stop_ = false;
    }
    try {
      render(*request);
    } catch (const std::exception& error) {
      set_status(*request, {0, false, false, error.what()});
    }
  }
}

void BeamWorker::render(const Request& request) {
  const std::vector<std::string> problems = beam_problems(request.scene);
  if (!problems.empty()) {
    throw Error(Error::Kind::input, "", fmt::format("{}", fmt::join(problems, "\n")));
  }
  set_status(request, {});
  const auto prepared = prepare_scene(request.scene, {.threads = request.threads, .stop = &stop_});
  RenderOptions options;
  options.samples.last = std::uint32_t(request.scene.image.samples_per_pixel);
  options.threads = request.threads;
  options.stop = &stop_;
  double said = 0;
  options.on_progress = [&](const Progress& progress) {
    constexpr double kStep = 0.01;
    if (progress.done < said + kStep || progress.done >= 1) return;
    said = progress.done;
    set_status(request, {progress.done, false, false, ""});
  };
  RenderResult result = make_beam_renderer(request.settings)->render(*prepared, options);
  if (stop_) return;
  result.picture.layers.clear();
  SaveOptions save;
  save.exposure = request.scene.image.exposure;
  std::vector<std::uint8_t> png = encode_picture(result.picture, PictureFormat::png, save);
  {
    const std::lock_guard lock(mutex_);
    if (stop_) return;
    png_ = std::move(png);
    status_ = Status{1, true, false, ""};
  }
  request.changed();
}

void BeamWorker::set_status(const Request& request, Status status) {
  {
    const std::lock_guard lock(mutex_);
    if (stop_) return;
    status_ = std::move(status);
  }
  request.changed();
}

std::optional<BeamWorker::Status> BeamWorker::take_status() {
  const std::lock_guard lock(mutex_);
  return std::exchange(status_, std::nullopt);
}

std::vector<std::uint8_t> BeamWorker::picture() const {
  const std::lock_guard lock(mutex_);
  return png_;
}

}  // namespace arris::view
