// Scene files: a valid scene or one arris::Error. Objects' files are boxes, so that no file is opened.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "arris/error.h"
#include "arris/render.h"
#include "geometry/shapes.h"
#include "io/toml_scene.h"

namespace {

arris::Scene load_box(const std::filesystem::path&) {
  arris::Scene scene;
  scene.meshes.push_back(arris::make_box_mesh({1, 1, 1}));
  scene.meshes[0].triangle_materials.resize(scene.meshes[0].triangles.size());
  scene.materials.resize(1);
  scene.objects.resize(2);
  return scene;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  try {
    const arris::Scene scene = arris::read_toml_scene(text, "fuzz", "/nonexistent", load_box);
    if (!arris::validate_scene(scene).empty()) std::abort();
  } catch (const arris::Error&) {
  }
  return 0;
}
