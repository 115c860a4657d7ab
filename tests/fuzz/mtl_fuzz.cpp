// Any material library gives a sound scene or one Error of kind input.
#include <string_view>

#include "fuzz/obj_files_in_memory.h"
#include "fuzz/scene_reading.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static constexpr std::string_view kModel = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  arris::test::check_reading({data, size}, [](std::span<const std::uint8_t> library) {
    const arris::ObjFiles files =
        arris::test::obj_files_in_memory({library.begin(), library.end()});
    return arris::read_obj({reinterpret_cast<const std::uint8_t*>(kModel.data()), kModel.size()},
                           "part.obj", files);
  });
  return 0;
}
