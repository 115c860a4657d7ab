#include "arris/input.h"

#include <array>
#include <cstdint>
#include <cstdio>
#include <vector>

#include "arris/error.h"
#include "io/file_kind.h"
#include "io/scene_bytes.h"

namespace arris::program {
namespace {

std::vector<std::uint8_t> read_stdin() {
  std::vector<std::uint8_t> bytes;
  std::array<std::uint8_t, 65536> block;
  while (const std::size_t count = std::fread(block.data(), 1, block.size(), stdin)) {
    bytes.insert(bytes.end(), block.begin(), block.begin() + std::ptrdiff_t(count));
  }
  if (std::ferror(stdin) != 0) throw Error(Error::Kind::failed, "stdin", "can't be read");
  return bytes;
}

}  // namespace

Input load_input(const std::string& name, const LoadOptions& options) {
  if (name != "-") {
    return {name, load_scene(name, options), is_scene_file(name)};
  }
  const std::vector<std::uint8_t> bytes = read_stdin();
  const std::string extension = find_scene_extension(bytes, "stdin");
  return {"stdin", read_scene(bytes, extension, "stdin", options), extension == ".toml"};
}

}  // namespace arris::program
