#include "povray.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <regex>
#include <string_view>
#include <thread>

#include "arris/error.h"
#include "arris/io.h"

extern char** environ;

namespace arris::bench {
namespace {

namespace fs = std::filesystem;

// Its exit code; what it says goes into the log.
int run(const fs::path& program, const fs::path& folder, std::vector<std::string> arguments,
        const fs::path& log) {
  std::vector<char*> argv{const_cast<char*>(program.c_str())};
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 1, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_adddup2(&actions, 1, 2);
  // POV-Ray may write to the folder that it runs in.
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  pid_t child = 0;
  const int problem = posix_spawn(&child, program.c_str(), &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (problem != 0) {
    throw Error(Error::Kind::failed, program.string(),
                fmt::format("can't be started: {}", std::strerror(problem)));
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
}

// The number after the words in the statistics; 0 if they aren't there.
double number_after(const std::string& log, const std::string& words) {
  std::smatch match;
  return std::regex_search(log, match, std::regex(words + R"(\s*([0-9.]+))")) ? std::stod(match[1])
                                                                              : 0;
}

}  // namespace

std::optional<fs::path> find_povray() {
  const char* const list = std::getenv("PATH");
  std::string_view folders(list == nullptr ? "" : list);
  while (!folders.empty()) {
    const std::string_view folder = folders.substr(0, folders.find(':'));
    folders.remove_prefix(std::min(folders.size(), folder.size() + 1));
    const fs::path program = fs::path(folder) / "povray";
    if (!folder.empty() && ::access(program.c_str(), X_OK) == 0) return program;
  }
  return std::nullopt;
}

PovPicture run_povray(const PovJob& job) {
  const std::string picture = job.scene + ".exr";
  const unsigned threads =
      job.threads > 0 ? unsigned(job.threads) : std::max(1U, std::thread::hardware_concurrency());
  std::vector<std::string> arguments{"+I" + job.scene + ".pov",
                                     "+O" + picture,
                                     fmt::format("+W{}", job.width_px),
                                     fmt::format("+H{}", job.height_px),
                                     "-D",
                                     "-V",
                                     "+FE",
                                     fmt::format("+WT{}", threads)};
  arguments.insert(arguments.end(), job.options.begin(), job.options.end());
  const fs::path log_file = job.folder / (job.scene + ".log");
  const int code = run(job.program, job.folder, arguments, log_file);
  std::ifstream file(log_file);
  const std::string log{std::istreambuf_iterator<char>(file), {}};
  if (code != 0) {
    throw Error(Error::Kind::failed, job.program.string(),
                fmt::format("ended with {}: {}", code,
                            log.substr(log.size() - std::min<std::size_t>(log.size(), 600))));
  }
  PovPicture result;
  result.color = load_picture(job.folder / picture).color;
  const std::string trace = log.substr(std::min(log.size(), log.find("Trace Time:")));
  result.seconds = number_after(trace, R"(\()");
  result.cpu_seconds = number_after(trace, "with");
  result.rays =
      std::uint64_t(number_after(log, "\nRays:") + number_after(log, "Shadow Ray Tests:"));
  return result;
}

}  // namespace arris::bench
