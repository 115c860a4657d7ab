// sample_passes.h — how a progressive render is cut into passes, and when it ends
// What       passes of growing size, so that a stop or a time limit is honoured soon and the cost of
//            starting a pass stays small. A pass that takes long, or about which nothing is known yet, is
//            dropped when the render must end: a picture holds whole samples only. Which passes are made
//            never changes the picture, only how many samples it holds.
// Cost       progress is reported at most every kReportSeconds, from one thread at a time
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <mutex>

#include "arris/render.h"

namespace arris {

class SamplePasses {
 public:
  explicit SamplePasses(const RenderOptions& options);

  // The samples of the next pass; empty if the render has ended. Call it after each pass is complete.
  [[nodiscard]] SampleRange next();
  // The pass under way may turn out to be dropped.
  [[nodiscard]] bool is_droppable() const { return droppable_; }
  // Nothing of the pass under way is needed any more: drop() it. From any thread.
  [[nodiscard]] bool must_drop() const;
  void drop() { position_ = pass_first_; }
  // All samples of the passes made.
  [[nodiscard]] SampleRange done() const { return {options_.samples.first, position_}; }
  [[nodiscard]] double elapsed_seconds() const;

  // Tells the caller that `part` of the pass under way is done; from any thread.
  void report(double part);

 private:
  [[nodiscard]] bool must_end(std::uint32_t made) const;

  const RenderOptions& options_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::uint32_t position_;        // where the next pass starts
  std::uint32_t pass_first_ = 0;  // of the pass under way
  bool droppable_ = false;
  std::mutex report_mutex_;
  double reported_seconds_ = 0;
};

}  // namespace arris
