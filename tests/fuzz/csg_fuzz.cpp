// Any bytes give a sound scene or one Error of kind input. Without files beside it and without openscad.
#include "fuzz/scene_reading.h"
#include "io/csg_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  for (const auto facets :
       {arris::LoadOptions::Facets::exact, arris::LoadOptions::Facets::as_written}) {
    arris::test::check_reading({data, size}, [&](std::span<const std::uint8_t> bytes) {
      return arris::read_csg(bytes, "part.csg", {}, {facets});
    });
  }
  return 0;
}
