// console.h — what the program says on stderr, and how much of it
// What       report(): one line a person may want to know; detail(): more with --verbose; show_progress():
//            a bar with time left on a terminal, else a line now and then. --quiet silences all of them.
#pragma once

#include <string>

#include "arris/render.h"

namespace arris::program {

class Arguments;

class Console {
 public:
  explicit Console(const Arguments& arguments);

  void report(const std::string& line);
  void detail(const std::string& line);
  void show_progress(const Progress& progress);
  // Removes the bar, so that other lines can follow.
  void end_progress();

 private:
  enum class Level { quiet, normal, verbose };
  Level level_ = Level::normal;
  bool is_terminal_ = false;
  bool bar_shown_ = false;
  double next_line_seconds_ = 0;
};

// Writes to stderr. What can't be written is lost, and changes nothing else.
void print_message(const std::string& text);

// "12 s", "3 min 20 s", "2 h 5 min".
std::string format_duration(double seconds);

}  // namespace arris::program
