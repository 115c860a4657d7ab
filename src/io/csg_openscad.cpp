#include "io/csg_openscad.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <span>
#include <string_view>
#include <thread>

#include "arris/error.h"
#include "base/utf8_text.h"
#include "io/file_bytes.h"

extern char** environ;

namespace arris {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMaxOutputBytes = std::uint64_t(1) << 30;

class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (fs::temp_directory_path() / "arris-openscad-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) {
      throw Error(Error::Kind::failed, name,
                  fmt::format("can't make a temporary folder: {}", std::strerror(errno)));
    }
    path_ = name;
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  [[nodiscard]] fs::path operator/(const char* name) const { return path_ / name; }

 private:
  fs::path path_;
};

// Its exit code; nothing if it was ended.
std::optional<int> run(const fs::path& program, std::vector<std::string> arguments,
                       const fs::path& log) {
  std::vector<char*> argv{const_cast<char*>(program.c_str())};
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 1, log.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
  posix_spawn_file_actions_adddup2(&actions, 1, 2);
  pid_t child = 0;
  const int problem = posix_spawn(&child, program.c_str(), &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (problem != 0) {
    throw Error(Error::Kind::failed, program.string(),
                fmt::format("can't be started: {}", std::strerror(problem)));
  }
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(kOpenScadSeconds);
  int status = 0;
  auto pause = std::chrono::milliseconds(2);
  while (::waitpid(child, &status, WNOHANG) == 0) {
    if (std::chrono::steady_clock::now() > end) {
      ::kill(child, SIGKILL);
      ::waitpid(child, &status, 0);
      return std::nullopt;
    }
    std::this_thread::sleep_for(pause);
    pause = std::min(pause * 2, std::chrono::milliseconds(50));
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128;
}

// The first line of the program's own words that complains.
std::string complaint(const fs::path& log) {
  std::error_code ignored;
  if (!fs::exists(log, ignored)) return "";
  const std::vector<std::uint8_t> bytes = read_file_bytes(log);
  std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  std::string_view last;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    if (line.starts_with("ERROR") || line.find("error") != std::string_view::npos) {
      return in_quotes(line);
    }
    if (!line.empty()) last = line;
  }
  return last.empty() ? "" : in_quotes(last);
}

bool says_empty(const fs::path& log) {
  const std::vector<std::uint8_t> bytes = read_file_bytes(log);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return text.find("top level object is empty") != std::string_view::npos;
}

OpenScadOutput convert(const fs::path& program, const ScratchFolder& folder, const fs::path& input,
                       const fs::path& output) {
  const fs::path log = folder / "log.txt";
  const std::optional<int> code = run(program, {"-o", output.string(), input.string()}, log);
  if (!code) return fmt::format("openscad took longer than {} s", kOpenScadSeconds);
  std::error_code ignored;
  if (*code == 0 && fs::exists(output, ignored)) return read_file_bytes(output, kMaxOutputBytes);
  if (says_empty(log)) return std::vector<std::uint8_t>{};
  return fmt::format("openscad ended with {}: {}", *code, complaint(log));
}

}  // namespace

std::optional<fs::path> find_openscad() {
  const char* const list = std::getenv("PATH");
  if (list == nullptr) return std::nullopt;
  std::string_view folders(list);
  while (!folders.empty()) {
    const std::string_view folder = folders.substr(0, folders.find(':'));
    folders.remove_prefix(std::min(folders.size(), folder.size() + 1));
    const fs::path program = fs::path(folder) / "openscad";
    std::error_code ignored;
    if (!folder.empty() && fs::is_regular_file(program, ignored) &&
        ::access(program.c_str(), X_OK) == 0) {
      return program;
    }
  }
  return std::nullopt;
}

OpenScadOutput flatten_by_openscad(const fs::path& program, const fs::path& scad) {
  const ScratchFolder folder;
  return convert(program, folder, fs::absolute(scad), folder / "flat.csg");
}

OpenScadOutput mesh_by_openscad(const fs::path& program, const std::string& csg) {
  const ScratchFolder folder;
  const fs::path input = folder / "part.csg";
  write_file_whole(input, {reinterpret_cast<const std::uint8_t*>(csg.data()), csg.size()});
  return convert(program, folder, input, folder / "part.off");
}

}  // namespace arris
