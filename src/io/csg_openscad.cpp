#include "io/csg_openscad.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <string_view>
#include <system_error>

#include "base/utf8_text.h"
#include "io/child_process.h"
#include "io/file_bytes.h"

namespace arris {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kMaxOutputBytes = std::uint64_t(1) << 30;

// The first line of the program's own words that complains, without the scratch folder's name.
std::string complaint(const fs::path& log) {
  std::error_code ignored;
  const auto quote = [folder = log.parent_path().string() + "/"](std::string_view line) {
    std::string text(line);
    for (std::size_t at; (at = text.find(folder)) != std::string::npos;) {
      text.erase(at, folder.size());
    }
    return in_quotes(text);
  };
  if (!fs::exists(log, ignored)) return "";
  const std::vector<std::uint8_t> bytes = read_file_bytes(log);
  std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  std::string_view last;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    if (line.starts_with("ERROR") || line.find("error") != std::string_view::npos) {
      return quote(line);
    }
    if (!line.empty()) last = line;
  }
  return last.empty() ? "" : quote(last);
}

bool says_empty(const fs::path& log) {
  const std::vector<std::uint8_t> bytes = read_file_bytes(log);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return text.find("top level object is empty") != std::string_view::npos;
}

OpenScadOutput convert(const fs::path& program, const ScratchFolder& folder, const fs::path& input,
                       const fs::path& output, const std::atomic<bool>* stop) {
  const fs::path log = folder / "log.txt";
  const std::optional<int> code = run({.program = program,
                                       .arguments = {"-o", output.string(), input.string()},
                                       .log = log,
                                       .most_seconds = kOpenScadSeconds,
                                       .stop = stop});
  if (!code) return fmt::format("openscad took longer than {} s", kOpenScadSeconds);
  std::error_code ignored;
  if (*code == 0 && fs::exists(output, ignored)) return read_file_bytes(output, kMaxOutputBytes);
  if (says_empty(log)) return std::vector<std::uint8_t>{};
  return fmt::format("openscad ended with {}: {}", *code, complaint(log));
}

}  // namespace

std::optional<fs::path> find_openscad() {
  return find_program("openscad");
}

OpenScadOutput flatten_by_openscad(const fs::path& program, const fs::path& scad,
                                   const std::atomic<bool>* stop) {
  const ScratchFolder folder("openscad");
  return convert(program, folder, fs::absolute(scad), folder / "flat.csg", stop);
}

OpenScadOutput mesh_by_openscad(const fs::path& program, const std::string& csg,
                                const std::atomic<bool>* stop) {
  const ScratchFolder folder("openscad");
  const fs::path input = folder / "part.csg";
  write_file_whole(input, {reinterpret_cast<const std::uint8_t*>(csg.data()), csg.size()});
  return convert(program, folder, input, folder / "part.off", stop);
}

}  // namespace arris
