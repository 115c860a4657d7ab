// sample_passes.h — how a progressive render is cut into passes, and when it ends
// What       passes of growing size, so that a stop or a time limit is honoured soon and the cost of
//            starting a pass stays small. Which passes are made never changes the picture, only how
//            many samples it holds.
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
  // All samples of the passes made.
  [[nodiscard]] SampleRange done() const { return {options_.samples.first, position_}; }
  [[nodiscard]] double elapsed_seconds() const;

  // Tells the caller that `part` of the pass under way is done; from any thread.
  void report(double part);

 private:
  const RenderOptions& options_;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::uint32_t position_;        // where the next pass starts
  std::uint32_t pass_first_ = 0;  // of the pass under way
  std::mutex report_mutex_;
  double reported_seconds_ = 0;
};

}  // namespace arris
