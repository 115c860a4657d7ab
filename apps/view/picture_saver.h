// picture_saver.h — the picture that is shown, as PNG files to save
// What       encodes in a thread of its own, so that no frame waits; requests for one picture share its file
// Guarantee  at most one picture waits, however many ask: those who have asked for an older one get the newer
// Limits     holds the last file until another picture is asked for
#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "arris/image.h"

namespace arris::view {

// Null: there is none, and `error` says why.
using PngFile = std::shared_ptr<const std::vector<std::uint8_t>>;
using PictureSaved = std::function<void(PngFile png, const std::string& error)>;

class PictureSaver {
 public:
  PictureSaver();
  PictureSaver(const PictureSaver&) = delete;
  PictureSaver& operator=(const PictureSaver&) = delete;
  // No call of a PictureSaved follows.
  ~PictureSaver();

  // number: another one for each picture. The picture is copied only if it has to be encoded. exposure: stops. `done`
  // is called by this thread or the saver's.
  void put(std::uint64_t number, const Image& picture, double exposure, PictureSaved done);

 private:
  struct Job {
    std::uint64_t number = 0;
    Image picture;
    double exposure = 0;
    std::vector<PictureSaved> done;
  };
  struct Saved {
    std::uint64_t number = 0;
    PngFile png;
    std::string error;
  };

  void run();

  std::mutex mutex_;
  std::condition_variable wake_;
  std::optional<Job> waiting_, encoding_;  // of the latter the picture is the thread's
  std::optional<Saved> saved_;
  bool stopped_ = false;
  std::thread thread_;  // the last: all else is there when it starts
};

}  // namespace arris::view
