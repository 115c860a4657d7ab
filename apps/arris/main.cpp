// main.cpp — from words to a command, from errors to exit codes: 0 done, 1 failed, 2 bad usage or input
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <vector>

#include "arris/command_line.h"
#include "arris/commands.h"
#include "arris/console.h"
#include "arris/error.h"
#include "arris/version.h"

namespace arris::program {
namespace {

constexpr int kFailed = 1, kBadInput = 2;

// Text for stdout; a closed pipe or full disk is a failure.
int print_text(const std::string& text) {
  const bool ok = std::fwrite(text.data(), 1, text.size(), stdout) == text.size();
  return std::fflush(stdout) == 0 && ok ? 0 : kFailed;
}

// Errors of several lines, as validation gives them, keep the program's name on each.
void print_error(const std::string& text) {
  std::string line = "arris: ";
  for (const char c : text) {
    line += c;
    if (c == '\n') line += "arris: ";
  }
  print_message(line + "\n");
}

// A stream that the caller has closed would be the next file that is opened, a picture perhaps, and get what
// is meant for the stream. What is read from or written to the stand-in fails.
void open_standard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(stream, F_GETFD) != -1) continue;
    const int stand_in = ::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
    if (stand_in >= 0 && stand_in != stream) ::close(stand_in);
  }
}

int run(const std::vector<std::string>& words) {
  if (words.empty()) {
    print_message(help_text());
    return kBadInput;
  }
  if (words[0] == "--help" || words[0] == "-h") return print_text(help_text());
  if (words[0] == "--version") return print_text(fmt::format("arris {}\n", version()));
  if (words[0] == "--help-markdown") return print_text(help_markdown());
  const CommandRow& command = find_command(words[0]);
  const Arguments arguments = parse_arguments(command, {words.begin() + 1, words.end()});
  if (arguments.has("--help")) return print_text(help_text(command));
  const int code = command.run(arguments);
  if (std::fflush(stdout) != 0) throw Error(Error::Kind::failed, "stdout", "can't be written");
  return code;
}

}  // namespace
}  // namespace arris::program

int main(int argc, char** argv) {
  using arris::Error;
  using namespace arris::program;  // NOLINT(google-build-using-namespace): main can't be in it
  // A reader that has gone is a failed write like any other; on stderr it is none of our business.
  std::signal(SIGPIPE, SIG_IGN);
  open_standard_streams();
  try {
    return run({argv + 1, argv + argc});
  } catch (const Error& error) {
    print_error(error.what());
    return error.kind() == Error::Kind::input ? kBadInput : kFailed;
  } catch (const std::bad_alloc&) {
    print_error("there is not enough memory; use a smaller picture or fewer layers");
    return kFailed;
  } catch (const std::exception& error) {
    print_error(error.what());
    return kFailed;
  }
}
