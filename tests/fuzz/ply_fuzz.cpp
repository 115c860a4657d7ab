// Any bytes give a sound scene or one Error of kind input.
#include "fuzz/scene_reading.h"
#include "io/mesh_readers.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  arris::test::check_reading({data, size}, [](std::span<const std::uint8_t> bytes) {
    return arris::read_ply(bytes, "part.ply");
  });
  return 0;
}
