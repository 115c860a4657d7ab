// Every picture reader: the format is what the bytes themselves say.
#include <cstddef>
#include <cstdint>

#include "arris/error.h"
#include "io/decode_image.h"
#include "io/picture_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::uint8_t> bytes(data, size);
  try {
    arris::decode_picture(bytes, "fuzz");
  } catch (const arris::Error&) {
  }
  try {
    arris::decode_image(bytes, "fuzz");
  } catch (const arris::Error&) {
  }
  return 0;
}
