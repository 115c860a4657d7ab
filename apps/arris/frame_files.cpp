#include "arris/frame_files.h"

#include <fmt/format.h>

namespace arris::program {
namespace {

struct Run {
  std::size_t first = std::string::npos, end = 0;
};

// The last run of #; in the folders' names it is none.
Run last_run(const std::string& pattern) {
  Run run;
  const std::size_t last = pattern.find_last_of('#');
  const std::size_t folder = pattern.find_last_of('/');
  if (last == std::string::npos || (folder != std::string::npos && last < folder)) return run;
  run.end = last + 1;
  for (run.first = last; run.first > 0 && pattern[run.first - 1] == '#';) --run.first;
  return run;
}

}  // namespace

std::string problem_with_pattern(const std::string& pattern) {
  const Run run = last_run(pattern);
  if (run.first == std::string::npos) {
    return "--frames makes several pictures: put #### where the number of the frame goes, such as "
           "f_####.png";
  }
  const std::string before = pattern.substr(0, run.first);
  const std::size_t folder = before.find_last_of('/');
  if (before.find('#', folder == std::string::npos ? 0 : folder) != std::string::npos) {
    return "has more than one run of #; leave one for the number of the frame";
  }
  return "";
}

std::string frame_file(const std::string& pattern, int frame) {
  const Run run = last_run(pattern);
  return fmt::format("{}{:0{}}{}", pattern.substr(0, run.first), frame, run.end - run.first,
                     pattern.substr(run.end));
}

}  // namespace arris::program
