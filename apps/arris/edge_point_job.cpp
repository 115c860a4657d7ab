#include "arris/edge_point_job.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace arris::program {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

void EdgePointJob::set_scene(std::shared_ptr<const PreparedScene> scene, const RenderJob& job) {
  start_ = Clock::now();
  time_limit_seconds_ = job.options.time_limit_seconds;
  stop_ = job.options.stop;
  const Camera camera = *scene_of(*scene).camera;
  if (!engine_) {
    settings_.synchronous = true;
    settings_.seed = job.options.seed;
    settings_.threads = job.options.threads;
    settings_.must_end = [this](bool has_picture) {
      return is_stopped() || (has_picture && is_late());
    };
    engine_ = std::make_unique<EdgePointEngine>(std::move(scene), settings_);
  } else {
    engine_->set_scene(std::move(scene));
  }
  engine_->set_camera(camera);
}

bool EdgePointJob::is_stopped() const {
  return stop_ != nullptr && stop_->load();
}

bool EdgePointJob::is_late() const {
  return time_limit_seconds_ > 0 && seconds_since(start_) >= time_limit_seconds_;
}

void EdgePointJob::make_frame(JobResult& result) {
  picture_ = &engine_->next_frame();
  const EdgePointStats& stats = engine_->stats();
  result.rays.camera += stats.rays.camera;
  result.rays.total += stats.rays.total;
  result.rays.rounded += stats.rays.rounded;
  frames_.push_back(stats);
}

void EdgePointJob::finish(const RenderJob& job, JobResult& result) const {
  Picture picture{*picture_, {}};
  if (!job.options.aovs.empty()) picture.layers.push_back({"edges", engine_->classes_picture()});
  const std::uint32_t count = std::max(1U, engine_->stats().still_paths);
  result.sum = sum_of_mean(picture, count);
  result.part = job.part;
  result.part.samples = {{0, count}};
  result.edge_point = engine_->stats();
}

JobResult EdgePointJob::render_frame(std::shared_ptr<const PreparedScene> scene,
                                     const RenderJob& job) {
  JobResult result;
  set_scene(std::move(scene), job);
  make_frame(result);
  finish(job, result);
  result.complete = true;
  result.seconds = seconds_since(start_);
  return result;
}

JobResult EdgePointJob::render_still(std::shared_ptr<const PreparedScene> scene,
                                     const RenderJob& job) {
  const RenderOptions& options = job.options;
  JobResult result;
  set_scene(std::move(scene), job);
  for (;;) {
    make_frame(result);
    const std::uint32_t paths = engine_->stats().still_paths;
    result.complete = paths >= options.samples.last;
    const double seconds = seconds_since(start_);
    if (options.on_progress) {
      const double of_paths = double(paths) / double(options.samples.last);
      const double of_time =
          options.time_limit_seconds > 0 ? seconds / options.time_limit_seconds : 0;
      options.on_progress({std::min(1.0, std::max(of_paths, of_time)), seconds});
    }
    if (result.complete || is_late() || is_stopped()) break;
  }
  finish(job, result);
  result.seconds = seconds_since(start_);
  return result;
}

}  // namespace arris::program
