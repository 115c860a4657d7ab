// shade_workers.h — threads that shade while frames are made
// What       Threads take items of the newest plan and keep the results until they are collected. While paused they
//            begin no item, so that a frame has the processor for itself; what they leave of a step they took is asked
//            for again by the next plan.
// Guarantee  set_plan(), collect() and the pauses wait for no shading: at most for a lock that is held to copy
//            results
// Limits     items that have begun under an older plan are finished and kept with its number
// Source     Bala, Walter, Greenberg (2003), Fig. 2: the asynchronous shader
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "render/shade_plan.h"

namespace arris {

class ShadeWorkers {
 public:
  explicit ShadeWorkers(int threads);
  ShadeWorkers(const ShadeWorkers&) = delete;
  ShadeWorkers& operator=(const ShadeWorkers&) = delete;
  ~ShadeWorkers();

  [[nodiscard]] int thread_count() const { return int(threads_.size()); }
  void set_plan(std::shared_ptr<const ShadePlan> plan);
  void set_paused(bool paused);

  struct Batch {
    std::shared_ptr<const ShadePlan> plan;  // of which these are
    ShadeResults results;
  };
  // What has come since the last call. Throws what a shader has thrown.
  std::vector<Batch> collect();

 private:
  void run();

  std::mutex mutex_;
  std::condition_variable wake_;
  std::shared_ptr<const ShadePlan> plan_;
  std::vector<Batch> batches_;
  std::exception_ptr error_;
  bool stopped_ = false;
  std::atomic<bool> paused_{false};  // changes under the mutex
  std::vector<std::thread> threads_;
};

}  // namespace arris
