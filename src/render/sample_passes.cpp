#include "render/sample_passes.h"

#include <algorithm>

namespace arris {
namespace {

constexpr double kPassSeconds = 0.5;  // a pass aims at this, so that a stop is soon honoured
constexpr double kReportSeconds = 0.1;

}  // namespace

SamplePasses::SamplePasses(const RenderOptions& options)
    : options_(options), position_(options.samples.first), pass_first_(options.samples.first) {}

double SamplePasses::elapsed_seconds() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

// A stop ends the render whatever it holds, a time limit once it holds the least samples.
bool SamplePasses::must_end(std::uint32_t made) const {
  if (options_.stop != nullptr && options_.stop->load(std::memory_order_relaxed)) {
    return true;
  }
  return options_.time_limit_seconds > 0 && made >= options_.least_samples &&
         elapsed_seconds() >= options_.time_limit_seconds;
}

bool SamplePasses::must_drop() const {
  return droppable_ && must_end(pass_first_ - options_.samples.first);
}

// The first pass is one sample: it measures how long a sample takes.
SampleRange SamplePasses::next() {
  const std::uint32_t first = options_.samples.first;
  const std::uint32_t left = std::max(options_.samples.last, position_) - position_;
  const std::uint32_t made = position_ - first;
  if (must_end(made)) {
    return {position_, position_};
  }
  std::uint32_t count = 1;
  const bool can_end = options_.stop != nullptr || options_.time_limit_seconds > 0;
  droppable_ = can_end;
  if (made > 0) {
    const double elapsed = elapsed_seconds();
    droppable_ = can_end && elapsed / made > kPassSeconds;
    double seconds = kPassSeconds;
    if (options_.time_limit_seconds > 0) {
      seconds = std::min(seconds, options_.time_limit_seconds - elapsed);
    }
    const double samples = seconds * made / std::max(elapsed, 1e-9);
    count = samples < 1 ? 1 : samples > left ? left : std::uint32_t(samples);
  }
  pass_first_ = position_;
  position_ += std::min(count, left);
  return {pass_first_, position_};
}

void SamplePasses::report(double part) {
  if (!options_.on_progress) {
    return;
  }
  const std::unique_lock lock(report_mutex_, std::try_to_lock);
  const double elapsed = elapsed_seconds();
  if (!lock.owns_lock() || (elapsed < reported_seconds_ + kReportSeconds)) {
    return;
  }
  reported_seconds_ = elapsed;
  const double all = double(options_.samples.last) - options_.samples.first;
  const double made = pass_first_ - options_.samples.first + part * (position_ - pass_first_);
  double done = made / all;
  if (options_.time_limit_seconds > 0) {
    done = std::max(done, elapsed / options_.time_limit_seconds);
  }
  options_.on_progress({std::min(done, 1.0), elapsed});
}

}  // namespace arris
