#include "io/child_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <string_view>
#include <system_error>
#include <thread>

#include "arris/error.h"

extern char** environ;

namespace arris {
namespace {

namespace fs = std::filesystem;

int exit_code_of(int status) {
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
}

pid_t start(const ChildProcess& process) {
  std::vector<std::string> arguments = process.arguments;
  std::vector<char*> argv{const_cast<char*>(process.program.c_str())};
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 1, process.log.c_str(), O_WRONLY | O_CREAT | O_TRUNC,
                                   0600);
  posix_spawn_file_actions_adddup2(&actions, 1, 2);
  if (!process.folder.empty()) {
    posix_spawn_file_actions_addchdir_np(&actions, process.folder.c_str());
  }
  pid_t child = 0;
  const int problem =
      posix_spawn(&child, process.program.c_str(), &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (problem != 0) {
    throw Error(Error::Kind::failed, process.program.string(),
                fmt::format("can't be started: {}", std::strerror(problem)));
  }
  return child;
}

}  // namespace

std::optional<fs::path> find_program(const std::string& name) {
  const char* const list = std::getenv("PATH");
  std::string_view folders(list == nullptr ? "" : list);
  while (!folders.empty()) {
    const std::string_view folder = folders.substr(0, folders.find(':'));
    folders.remove_prefix(std::min(folders.size(), folder.size() + 1));
    const fs::path program = fs::path(folder) / name;
    std::error_code ignored;
    if (!folder.empty() && fs::is_regular_file(program, ignored) &&
        ::access(program.c_str(), X_OK) == 0) {
      return program;
    }
  }
  return std::nullopt;
}

ScratchFolder::ScratchFolder(const std::string& purpose) {
  std::string name = (fs::temp_directory_path() / fmt::format("arris-{}-XXXXXX", purpose)).string();
  if (::mkdtemp(name.data()) == nullptr) {
    throw Error(Error::Kind::failed, name,
                fmt::format("can't make a temporary folder: {}", std::strerror(errno)));
  }
  path_ = name;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

std::optional<int> run(const ChildProcess& process) {
  using Clock = std::chrono::steady_clock;
  const pid_t child = start(process);
  const auto end = Clock::now() + std::chrono::seconds(process.most_seconds.value_or(0));
  auto pause = std::chrono::milliseconds(2);
  int status = 0;
  while (::waitpid(child, &status, WNOHANG) == 0) {
    const bool is_stopped = process.stop != nullptr && *process.stop;
    if (is_stopped || (process.most_seconds && Clock::now() > end)) {
      ::kill(child, SIGKILL);
      ::waitpid(child, &status, 0);
      if (!is_stopped) return std::nullopt;
      throw Error(Error::Kind::failed, process.program.string(), "stopped");
    }
    std::this_thread::sleep_for(pause);
    pause = std::min(pause * 2, std::chrono::milliseconds(50));
  }
  return exit_code_of(status);
}

}  // namespace arris
