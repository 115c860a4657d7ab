// edge_point_job.h — pictures of the edge-and-point renderer without a viewer
// What       the frames of a moving view, or a view that stands still until each pixel has its paths
// Guarantee  same frames at any number of threads: shading is done between them
#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <vector>

#include "arris/edge_point.h"
#include "arris/render_job.h"

namespace arris::program {

class EdgePointJob {
 public:
  explicit EdgePointJob(const EdgePointSettings& settings) : settings_(settings) {}

  // The next frame: the scene is the one of the frame before, or what prepare_moved() made of it.
  JobResult render_frame(std::shared_ptr<const PreparedScene> scene, const RenderJob& job);
  // Until each pixel has had as many paths as the job asks for samples, or it is stopped.
  // Both throw Error{failed} if they are stopped before there is a picture.
  JobResult render_still(std::shared_ptr<const PreparedScene> scene, const RenderJob& job);

  // Of all frames.
  [[nodiscard]] const std::vector<EdgePointStats>& frames() const { return frames_; }

 private:
  void set_scene(std::shared_ptr<const PreparedScene> scene, const RenderJob& job);
  void make_frame(JobResult& result);
  void finish(const RenderJob& job, JobResult& result) const;
  [[nodiscard]] bool is_stopped() const;
  [[nodiscard]] bool is_late() const;

  EdgePointSettings settings_;
  // Of the picture that is being made.
  std::chrono::steady_clock::time_point start_;
  double time_limit_seconds_ = 0;
  const std::atomic<bool>* stop_ = nullptr;
  std::unique_ptr<EdgePointEngine> engine_;
  const Image* picture_ = nullptr;
  std::vector<EdgePointStats> frames_;
};

}  // namespace arris::program
