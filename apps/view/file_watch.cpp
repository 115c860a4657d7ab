#include "view/file_watch.h"

#include <unistd.h>

#include <system_error>
#include <utility>

namespace arris::view {

namespace fs = std::filesystem;

FileWatch::Reading::Reading(FileWatch& watch)
    : watch_(watch), reads_([&watch](const fs::path& file) {
        std::error_code ignored;
        const fs::path path = fs::absolute(file, ignored);
        const std::optional<Stamp> stamp = stamp_of(path);
        const std::lock_guard lock(watch.mutex_);
        watch.being_read_.try_emplace(path, File{stamp, stamp});
      }) {
  const std::lock_guard lock(watch_.mutex_);
  watch_.being_read_.clear();
  watch_.reading_ = true;
}

FileWatch::Reading::~Reading() {
  const std::lock_guard lock(watch_.mutex_);
  Files before = std::exchange(watch_.files_, std::exchange(watch_.being_read_, {}));
  if (!has_all_) watch_.files_.merge(before);
  watch_.reading_ = false;
}

std::optional<FileWatch::Stamp> FileWatch::stamp_of(const fs::path& file) {
  std::error_code error;
  Stamp stamp;
  stamp.time = fs::last_write_time(file, error);
  if (error) return std::nullopt;
  stamp.size = fs::file_size(file, error);
  stamp.readable = !error && ::access(file.c_str(), R_OK) == 0;
  return stamp;
}

FileWatch::Look FileWatch::look() {
  const std::lock_guard lock(mutex_);
  if (reading_) return {false, problem_};
  bool all_rest = true, changed = false;
  std::string problem;
  for (auto& [path, file] : files_) {
    const std::optional<Stamp> now = stamp_of(path);
    if (now != std::exchange(file.seen, now)) {
      all_rest = false;
    } else if (!now || !now->readable) {
      problem = path.filename().string() + (now ? " can't be read any more" : " was deleted");
    } else if (now != file.read) {
      changed = true;
    }
  }
  if (!all_rest) return {false, problem_};
  // Without a file the model would be another one, or none; it is read when all are back.
  changed = problem.empty() && (changed || !problem_.empty());
  problem_ = std::move(problem);
  if (changed) {
    for (auto& [path, file] : files_) file.read = file.seen;
  }
  return {changed, problem_};
}

}  // namespace arris::view
