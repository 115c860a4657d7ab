#include "io/picture_limits.h"

#include <fmt/format.h>

#include "arris/error.h"

namespace arris {

void check_picture_size(const PictureSize& size, std::size_t file_bytes, const std::string& name) {
  const auto fail = [&](const std::string& what) {
    throw Error(Error::Kind::input, name,
                fmt::format("{} x {} pixels {}", size.width_px, size.height_px, what));
  };
  if (size.width_px < 1 || size.height_px < 1) fail("is no picture; both must be at least 1");
  if (size.width_px > kMaxPictureSide || size.height_px > kMaxPictureSide) {
    fail(fmt::format("is too large; use at most {} on a side", kMaxPictureSide));
  }
  const std::int64_t pixels = size.width_px * size.height_px;
  if (pixels > kMaxPicturePixels) {
    fail(fmt::format("is too large; use at most {} pixels in all", kMaxPicturePixels));
  }
  if (pixels * size.bytes_per_pixel / kMaxExpansion > std::int64_t(file_bytes)) {
    fail(fmt::format("can't be in a file of {} bytes: the file is corrupt or incomplete",
                     file_bytes));
  }
}

}  // namespace arris
