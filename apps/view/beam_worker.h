// beam_worker.h — beam pictures of views, beside their frames
// What       start() makes one in a thread of its own, in place of one that is being made
// Guarantee  a picture that was stopped or replaced says nothing any more
// Limits     meshes are seen as they are, not rounded
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "arris/render.h"
#include "arris/scene.h"

namespace arris::view {

class BeamWorker {
 public:
  struct Status {
    double done = 0;
    bool ready = false, stopped = false;
    std::string error;
  };

  BeamWorker() = default;
  BeamWorker(const BeamWorker&) = delete;
  BeamWorker& operator=(const BeamWorker&) = delete;
  // Ends within about a second.
  ~BeamWorker();

  // changed: called in the other thread when status() has changed.
  void start(Scene scene, const BeamSettings& settings, int threads, std::function<void()> changed);
  // take_status() says that it was stopped, or, if nothing was being made, how things are.
  void stop();
  // What is new since the last call.
  std::optional<Status> take_status();
  // As PNG; empty: there is none.
  [[nodiscard]] std::vector<std::uint8_t> picture() const;

 private:
  struct Request {
    Scene scene;
    BeamSettings settings;
    int threads = 0;
    std::function<void()> changed;
  };
  void run();
  void render(const Request& request);
  void set_status(const Request& request, Status status);

  mutable std::mutex mutex_;
  std::optional<Request> next_;
  std::optional<Status> status_;
  std::vector<std::uint8_t> png_;
  std::atomic<bool> stop_ = false;  // nobody wants what is being made
  bool ended_ = false, running_ = false;
  std::thread thread_;
};

}  // namespace arris::view
