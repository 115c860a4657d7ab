#include "arris/console.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "arris/command_line.h"

namespace arris::program {
namespace {

constexpr double kFirstLineSeconds = 5;
constexpr double kLineSeconds = 10;
constexpr int kBarWidth = 40;

}  // namespace

Console::Console(const Arguments& arguments)
    : is_terminal_(::isatty(STDERR_FILENO) == 1), next_line_seconds_(kFirstLineSeconds) {
  if (arguments.has("--verbose")) level_ = Level::verbose;
  if (arguments.has("--quiet")) level_ = Level::quiet;
}

void Console::report(const std::string& line) {
  if (level_ == Level::quiet) return;
  end_progress();
  print_message(line + "\n");
}

void Console::detail(const std::string& line) {
  if (level_ == Level::verbose) report(line);
}

void Console::show_progress(const Progress& progress) {
  if (level_ == Level::quiet) return;
  const double done = std::clamp(progress.done, 0.0, 1.0);
  const double left = done > 0 ? progress.elapsed_seconds * (1 - done) / done : 0;
  if (is_terminal_) {
    const int filled = int(done * kBarWidth);
    print_message(fmt::format("\r[{:=>{}}{:>{}}] {:3.0f}%  {} left\x1b[K", "", filled, "",
                              kBarWidth - filled, 100 * done, format_duration(left)));
    bar_shown_ = true;
  } else if (progress.elapsed_seconds >= next_line_seconds_) {
    print_message(fmt::format("{:.0f}% done, {} left\n", 100 * done, format_duration(left)));
    next_line_seconds_ = progress.elapsed_seconds + kLineSeconds;
  }
}

void Console::end_progress() {
  if (!bar_shown_) return;
  print_message("\r\x1b[K");
  bar_shown_ = false;
}

void print_message(const std::string& text) {
  (void)std::fwrite(text.data(), 1, text.size(), stderr);
  (void)std::fflush(stderr);
}

std::string format_duration(double seconds) {
  if (seconds < 9.95) return fmt::format("{:.1f} s", seconds);
  const auto whole = std::int64_t(std::min(std::round(seconds), 1e15));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {} s", whole / 60, whole % 60);
  return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

}  // namespace arris::program
