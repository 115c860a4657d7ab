// arris-step INPUT OUTPUT — reads a STEP file by Open CASCADE, for src/io/step.cpp
// What       OUTPUT gets the parts as meshes (io/packed_scene.h) and the exit code is 0, or what is wrong with the
//            file as text and 2. Anything else is a crash, of which whoever started this knows.
// Limits     memory: kMostBytes and a multiple of the file's size. Ends with the program that has started it.
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <string>
#include <string_view>
#include <system_error>

#include "arris/error.h"
#include "io/file_bytes.h"
#include "io/packed_scene.h"
#include "step/step_document.h"

namespace arris::step {
namespace {

constexpr int kDone = 0, kFailed = 1, kRefused = 2;
constexpr std::uintmax_t kMostBytes = std::uintmax_t(4) << 30;
constexpr std::uintmax_t kMostBytesPerByte = 400;

// Sanitizers take terabytes of addresses.
#ifdef ARRIS_SANITIZED
constexpr bool kLimited = false;
#else
constexpr bool kLimited = true;
#endif

void limit_memory(const std::filesystem::path& input) {
  std::error_code ignored;
  const std::uintmax_t size = std::filesystem::file_size(input, ignored);
  rlimit limit{};
  if (ignored || ::getrlimit(RLIMIT_AS, &limit) != 0) return;
  limit.rlim_cur = std::min<rlim_t>(limit.rlim_max, kMostBytes + kMostBytesPerByte * size);
  ::setrlimit(RLIMIT_AS, &limit);
}

void write_text(const std::filesystem::path& path, std::string_view text) {
  write_file_whole(path, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

int run(const std::filesystem::path& input, const std::filesystem::path& output) {
  try {
    write_file_whole(output, pack_scene(read_step_document(input)));
    return kDone;
  } catch (const Error& error) {
    write_text(output, error.what());
    return kRefused;
  }
}

}  // namespace
}  // namespace arris::step

int main(int count, char** arguments) {
  if (count != 3) {
    std::fputs(
        "arris-step INPUT OUTPUT: reads STEP files for Arris; give them to arris, which "
        "starts it\n",
        stderr);
    return arris::step::kRefused;
  }
  ::signal(SIGINT, SIG_IGN);  // the program that started this one decides
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  ::prctl(PR_SET_DUMPABLE, 0);  // a crash is an answer: no core file
  if (arris::step::kLimited) arris::step::limit_memory(arguments[1]);
  int code = arris::step::kFailed;
  try {
    code = arris::step::run(arguments[1], arguments[2]);
  } catch (const std::exception& exception) {
    std::fprintf(stderr, "%s\n", exception.what());
  }
  // What Open CASCADE keeps till the end needs no tidying up.
  std::_Exit(code);
}
