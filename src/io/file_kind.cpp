#include "io/file_kind.h"

namespace arris {

std::string extension_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) {
    if (c >= 'A' && c <= 'Z') c = char(c + ('a' - 'A'));
  }
  return extension;
}

}  // namespace arris
