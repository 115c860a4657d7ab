// child_process.h — other programs, run without a shell
// Errors     Error{failed} naming the program or folder, where the system can't start or make it
#pragma once

#include <atomic>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace arris {

// On the PATH.
std::optional<std::filesystem::path> find_program(const std::string& name);

// A folder of its own, gone with the object.
class ScratchFolder {
 public:
  // `purpose` is part of the folder's name.
  explicit ScratchFolder(const std::string& purpose);
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const {
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

struct ChildProcess {
  std::filesystem::path program;
  std::vector<std::string> arguments;
  std::filesystem::path log;          // replaced by what it says
  std::filesystem::path folder{};     // that it runs in; empty: this program's
  std::optional<int> most_seconds{};  // it is ended then
  // Set from any thread: it is ended, and run() throws Error{failed}.
  const std::atomic<bool>* stop = nullptr;
};

// Waits for its end. Its exit code, 128 if a signal ended it; nothing if its time was over.
std::optional<int> run(const ChildProcess& process);

}  // namespace arris
