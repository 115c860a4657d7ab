#include "render/shade_workers.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "base/flush_denormals.h"

namespace arris {

ShadeWorkers::ShadeWorkers(int threads) {
  const int count = threads > 0 ? threads : std::max(1, int(std::thread::hardware_concurrency()));
  for (int i = 0; i < count; ++i) threads_.emplace_back([this] { run(); });
}

ShadeWorkers::~ShadeWorkers() {
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
  }
  wake_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void ShadeWorkers::set_plan(std::shared_ptr<const ShadePlan> plan) {
  {
    const std::lock_guard lock(mutex_);
    plan_ = std::move(plan);
  }
  wake_.notify_all();
}

void ShadeWorkers::set_paused(bool paused) {
  {
    const std::lock_guard lock(mutex_);
    paused_ = paused;
  }
  if (!paused) wake_.notify_all();
}

std::vector<ShadeWorkers::Batch> ShadeWorkers::collect() {
  const std::lock_guard lock(mutex_);
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
  return std::exchange(batches_, {});
}

void ShadeWorkers::run() {
  const FlushDenormals flush;
  for (;;) {
    std::shared_ptr<const ShadePlan> plan;
    std::size_t first = 0;
    {
      std::unique_lock lock(mutex_);
      wake_.wait(lock, [&] {
        return stopped_ || (!paused_ && plan_ && plan_->begun < plan_->items.size());
      });
      if (stopped_) return;
      plan = plan_;
      first = plan->begun.fetch_add(ShadePlan::kStep);
    }
    ShadeResults results;
    std::exception_ptr error;
    const auto start = std::chrono::steady_clock::now();
    try {
      const std::size_t last = std::min(first + ShadePlan::kStep, plan->items.size());
      for (std::size_t i = first; i < last && !paused_; ++i)
        shade_item(*plan, plan->items[i], results);
    } catch (...) {
      error = std::current_exception();
    }
    results.thread_seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    const std::lock_guard lock(mutex_);
    if (error) error_ = error;
    if (batches_.empty() || batches_.back().plan != plan) batches_.push_back({plan, {}});
    batches_.back().results.append(results);
  }
}

}  // namespace arris
