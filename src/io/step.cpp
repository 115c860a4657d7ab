// step.cpp — STEP files (ISO 10303-21), by way of arris-step
// What       Open CASCADE is 67 libraries, and files can make it crash or loop: it runs in a program of its own
//            (apps/step), which is there where Arris was built with ARRIS_BUILD_STEP. It writes the parts as meshes,
//            or what is wrong, to a file.
#include <fmt/format.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "base/utf8_text.h"
#include "io/child_process.h"
#include "io/file_bytes.h"
#include "io/mesh_readers.h"
#include "io/mesh_scene.h"
#include "io/packed_scene.h"
#include "io/step_syntax.h"

namespace arris {
namespace {

namespace fs = std::filesystem;

constexpr const char* kProgram = "arris-step";
// Parts that fill a megabyte take some seconds; a few files make Open CASCADE loop for ever.
constexpr int kMostSeconds = 120, kMostSecondsPerMegabyte = 30;
// Of arris-step: OUTPUT holds what is wrong.
constexpr int kRefused = 2;
// Of the loader: one of its libraries is not there.
constexpr int kNotLoaded = 127;

// Beside the running program, where arris was installed, or on the PATH.
std::optional<fs::path> find_arris_step() {
  std::error_code ignored;
  const fs::path beside = fs::read_symlink("/proc/self/exe", ignored).parent_path() / kProgram;
  for (const fs::path& program : {beside, fs::path(ARRIS_INSTALLED_PROGRAMS) / kProgram}) {
    if (fs::is_regular_file(program, ignored) && ::access(program.c_str(), X_OK) == 0) {
      return program;
    }
  }
  return find_program(kProgram);
}

Error problem(const std::string& file, const std::string& what) {
  return {Error::Kind::input, file, what};
}

// Not by read_file_bytes(), which would tell that the model is made of this file, too.
std::string read_scratch(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::string content((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  if (!stream) throw Error(Error::Kind::failed, path.string(), "can't be read");
  return content;
}

void name_after_file(Scene& scene, const std::string& file) {
  scene.name = name_from_file(file);
  for (Mesh& mesh : scene.meshes) {
    if (mesh.name.empty()) mesh.name = scene.name;
  }
  for (Object& object : scene.objects) {
    if (object.name.empty()) object.name = scene.name;
  }
}

}  // namespace

Scene read_step(std::span<const std::uint8_t> bytes, const std::string& file,
                const std::atomic<bool>* stop) {
  check_step_syntax(bytes, file);
  const std::optional<fs::path> program = find_arris_step();
  if (!program) {
    throw Error(
        Error::Kind::failed, file,
        "STEP files are read by arris-step, which is not here: this Arris was built without "
        "it. Install Debian's libocct-data-exchange-dev, build with "
        "-DARRIS_BUILD_STEP=ON and put arris-step beside the program or on the PATH; or "
        "export the model as STL");
  }
  const ScratchFolder folder("step");
  const fs::path input = folder / "model.step", output = folder / "scene";
  write_file_whole(input, bytes);
  const int most_seconds = kMostSeconds + kMostSecondsPerMegabyte * int(bytes.size() >> 20);
  const std::optional<int> code =
      run({*program, {input.string(), output.string()}, folder / "log", {}, most_seconds, stop});
  if (!code) {
    throw problem(file,
                  fmt::format("takes Open CASCADE longer than {} seconds, which is the limit; "
                              "split the model, or export it as STL",
                              most_seconds));
  }
  if (*code == kRefused) throw problem(file, read_scratch(output));
  if (*code == kNotLoaded) {
    // "PROGRAM: error while loading shared libraries: NAME: …"
    std::string log = read_scratch(folder / "log");
    if (const std::size_t colon = log.find(": "); colon != std::string::npos) {
      log.erase(0, colon + 2);
    }
    throw Error(Error::Kind::failed, program->string(),
                fmt::format("can't run: {}; install Debian's libocct-data-exchange-7.6",
                            in_quotes(log.substr(0, log.find('\n')))));
  }
  if (*code != 0) {
    throw problem(
        file,
        fmt::format(
            "Open CASCADE, which reads STEP files, broke down over it: {}; "
            "export it again, or as STL",
            find_missing_entity(bytes, file).value_or("what it says is not sound, or too large")));
  }
  const std::string packed = read_scratch(output);
  Scene scene = unpack_scene({reinterpret_cast<const std::uint8_t*>(packed.data()), packed.size()});
  name_after_file(scene, file);
  return scene;
}

}  // namespace arris
