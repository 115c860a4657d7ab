// Any model gives a sound scene or one Error of kind input.
#include <string_view>

#include "fuzz/obj_files_in_memory.h"
#include "fuzz/scene_reading.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static constexpr std::string_view kLibrary = "newmtl a\nKd 1 0 0\nnewmtl b\nmap_Kd a.png\n";
  static const arris::ObjFiles files =
      arris::test::obj_files_in_memory({kLibrary.begin(), kLibrary.end()});
  arris::test::check_reading({data, size}, [](std::span<const std::uint8_t> bytes) {
    return arris::read_obj(bytes, "part.obj", files);
  });
  return 0;
}
