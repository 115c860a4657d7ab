// background_job.h — one piece of work at a time, beside its owner
// What       start() runs a function in a thread of its own; take() hands its result or exception over once it is there
// Limits     one thread at a time owns it; `done` is called in the other one
#pragma once

#include <atomic>
#include <exception>
#include <functional>
#include <optional>
#include <thread>
#include <utility>

namespace arris::view {

template <class Result>
class BackgroundJob {
 public:
  BackgroundJob() = default;
  BackgroundJob(const BackgroundJob&) = delete;
  BackgroundJob& operator=(const BackgroundJob&) = delete;
  // Waits for the work.
  ~BackgroundJob() { join(); }

  [[nodiscard]] bool is_running() const { return thread_.joinable(); }

  // Precondition: nothing is running.
  void start(std::function<Result()> work, std::function<void()> done) {
    finished_ = false;
    thread_ = std::thread([this, work = std::move(work), done = std::move(done)] {
      try {
        result_ = work();
      } catch (...) {
        error_ = std::current_exception();
      }
      finished_ = true;
      done();
    });
  }

  // Nothing while the work goes on; throws what it has thrown.
  std::optional<Result> take() {
    if (!is_running() || !finished_) return std::nullopt;
    join();
    if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
    return std::exchange(result_, std::nullopt);
  }

 private:
  void join() {
    if (thread_.joinable()) thread_.join();
  }

  std::thread thread_;
  std::atomic<bool> finished_ = false;
  std::optional<Result> result_;
  std::exception_ptr error_;
};

}  // namespace arris::view
