// run_program.h — runs the built program in a folder and keeps what it says
#pragma once

#include <fmt/format.h>
#include <sys/wait.h>

#include <array>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include "support/temporary_folder.h"

namespace arris::test {

inline std::string read_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline void write_text(const std::filesystem::path& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

// An axis-parallel cube from (0,0,0) to (size,size,size), ASCII STL.
inline std::string cube_stl(double size) {
  constexpr std::array<std::array<int, 3>, 12> kTriangles{{{0, 2, 1},
                                                           {1, 2, 3},
                                                           {4, 5, 6},
                                                           {5, 7, 6},
                                                           {0, 1, 4},
                                                           {1, 5, 4},
                                                           {2, 6, 3},
                                                           {3, 6, 7},
                                                           {0, 4, 2},
                                                           {2, 4, 6},
                                                           {1, 3, 5},
                                                           {3, 7, 5}}};
  std::string text = "solid cube\n";
  for (const auto& triangle : kTriangles) {
    text += "facet normal 0 0 0\nouter loop\n";
    for (const int corner : triangle) {
      text += "vertex";
      for (int axis = 0; axis < 3; ++axis) {
        text += fmt::format(" {}", (corner >> axis & 1) != 0 ? size : 0.0);
      }
      text += "\n";
    }
    text += "endloop\nendfacet\n";
  }
  return text + "endsolid cube\n";
}

struct Outcome {
  int code = -1;
  std::string out, err;
};

// A folder with cube.stl in it (side 2), in which commands run.
class Workplace {
 public:
  Workplace() { write_text(folder_ / "cube.stl", cube_stl(2)); }

  // A shell command in which "arris" is the program under test.
  [[nodiscard]] Outcome shell(const std::string& command) const {
    const std::string script = fmt::format("arris() {{ '{}/arris' \"$@\"; }}; cd '{}'; {}",
                                           ARRIS_BINARY_DIR, folder_.path().string(), command);
    write_text(folder_ / "script.sh", script);
    const std::string line =
        fmt::format("sh '{0}/script.sh' >'{0}/out.txt' 2>'{0}/err.txt'", folder_.path().string());
    const int status = std::system(line.c_str());  // NOLINT: commands of the tests
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_text(folder_ / "out.txt"),
            read_text(folder_ / "err.txt")};
  }
  [[nodiscard]] Outcome arris(const std::string& arguments) const {
    return shell(fmt::format("arris {}", arguments));
  }
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const {
    return folder_ / name;
  }
  [[nodiscard]] std::string read(const std::string& name) const {
    return read_text(folder_ / name);
  }

 private:
  TemporaryFolder folder_;
};

}  // namespace arris::test
