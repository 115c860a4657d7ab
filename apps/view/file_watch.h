// file_watch.h — whether the files that a model was read from have changed
// What       a Reading notes each file as it is when it is read; look() compares them with how they are now
// Guarantee  a save at any time after the file was read is noticed, also while the rest of the model is read; a file
//            that is being written is not: it must be the same in two looks. A reading that fails adds its files to
//            those of the one before.
// Limits     times and sizes of files are looked at, not contents; any thread may call
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <string>

#include "io/file_reads.h"

namespace arris::view {

class FileWatch {
 public:
  // From here to its end the thread reads a model.
  class Reading {
   public:
    explicit Reading(FileWatch& watch);
    Reading(const Reading&) = delete;
    Reading& operator=(const Reading&) = delete;
    ~Reading();
    void succeed() { has_all_ = true; }

   private:
    FileWatch& watch_;
    bool has_all_ = false;
    FileReads reads_;
  };

  struct Look {
    bool changed = false;  // since the reading, or the look that has said so
    std::string problem;   // a file that was deleted, or that can't be read; empty: none
  };
  Look look();

 private:
  struct Stamp {
    std::filesystem::file_time_type time;
    std::uintmax_t size = 0;
    bool readable = true;
    friend bool operator==(const Stamp&, const Stamp&) = default;
  };
  struct File {
    std::optional<Stamp> read, seen;  // empty: it is not there
  };
  using Files = std::map<std::filesystem::path, File>;
  static std::optional<Stamp> stamp_of(const std::filesystem::path& file);

  std::mutex mutex_;
  Files files_, being_read_;
  bool reading_ = false;
  std::string problem_;  // of the last look
};

}  // namespace arris::view
