// mtl.h — material libraries of OBJ files
// What       adds the library's materials and textures to a scene; docs/formats.md has the mapping
// Errors     kind input, where = "library.mtl:line"
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>

#include "arris/scene.h"
#include "io/mesh_readers.h"

namespace arris {

inline constexpr std::size_t kMaxMaterials = 65536;

// Materials by the name's bytes in the file.
using MaterialNames = std::map<std::string, MaterialId, std::less<>>;

class MtlReader {
 public:
  MtlReader(const ObjFiles& files, Scene& scene) : files_(files), scene_(scene) {}

  // `library`: its name as the model gives it, `file`: as errors give it.
  void read(std::span<const std::uint8_t> bytes, const std::string& library,
            const std::string& file);

  [[nodiscard]] const MaterialNames& names() const { return names_; }

 private:
  class Library;

  const ObjFiles& files_;
  Scene& scene_;
  MaterialNames names_;
  std::map<std::string, TextureId> textures_;  // by file and colour space
};

}  // namespace arris
