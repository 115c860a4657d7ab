// Any bytes give a sound scene or one Error of kind input.
#include "fuzz/scene_reading.h"
#include "io/gltf_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  arris::test::check_reading({data, size}, [](std::span<const std::uint8_t> bytes) {
    return arris::read_gltf(bytes, "part.gltf", "/nonexistent");
  });
  return 0;
}
