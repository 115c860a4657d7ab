#include "io/decode_image.h"

#include "arris/error.h"
#include "io/picture_jpeg.h"
#include "io/picture_png.h"

namespace arris {

Rgba8Image decode_image(std::span<const std::uint8_t> bytes, const std::string& name) {
  if (is_png(bytes)) return decode_png(bytes, name);
  if (is_jpeg(bytes)) return decode_jpeg(bytes, name);
  throw Error(Error::Kind::input, name,
              bytes.empty() ? "is empty; a PNG or JPEG picture is needed"
                            : "is neither PNG nor JPEG; convert it to one of them");
}

}  // namespace arris
