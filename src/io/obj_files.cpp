#include <filesystem>
#include <system_error>

#include "io/decode_image.h"
#include "io/file_bytes.h"
#include "io/mesh_readers.h"

namespace arris {
namespace {

namespace fs = std::filesystem;

// A library of more bytes than this is no library.
constexpr std::uint64_t kMaxLibraryBytes = std::uint64_t(64) << 20;

bool is_there(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

}  // namespace

ObjFiles files_beside(const fs::path& model) {
  const fs::path folder = model.parent_path();
  ObjFiles files;
  files.find_library =
      [folder](const std::string& name) -> std::optional<std::vector<std::uint8_t>> {
    const fs::path path = folder / name;
    if (!is_there(path)) return std::nullopt;
    return read_file_bytes(path, kMaxLibraryBytes);
  };
  files.find_texture = [folder](const std::string& name) -> std::optional<Texture> {
    const fs::path path = folder / name;
    if (!is_there(path)) return std::nullopt;
    Rgba8Image image = decode_image(read_file_bytes(path), path.string());
    Texture texture;
    texture.name = name;
    texture.width_px = image.width_px;
    texture.height_px = image.height_px;
    texture.texels = std::move(image.texels);
    return texture;
  };
  return files;
}

}  // namespace arris
