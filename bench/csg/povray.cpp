#include "povray.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <regex>
#include <thread>

#include "arris/error.h"
#include "arris/io.h"
#include "io/child_process.h"

namespace arris::bench {
namespace {

namespace fs = std::filesystem;

// The number after the words in the statistics; 0 if they aren't there.
double number_after(const std::string& log, const std::string& words) {
  std::smatch match;
  return std::regex_search(log, match, std::regex(words + R"(\s*([0-9.]+))")) ? std::stod(match[1])
                                                                              : 0;
}

}  // namespace

std::optional<fs::path> find_povray() {
  return find_program("povray");
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
  // POV-Ray may write to the folder that it runs in.
  const int code = *run({job.program, arguments, log_file, job.folder});
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
