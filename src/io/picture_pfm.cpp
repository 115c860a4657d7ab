#include "io/picture_pfm.h"

#include <fmt/format.h>

#include <bit>
#include <cstring>

#include "arris/error.h"
#include "io/header_text.h"
#include "io/picture_limits.h"

namespace arris {
namespace {

float float_at(const std::uint8_t* bytes, bool little_endian) {
  std::uint32_t bits = 0;
  for (int i = 0; i < 4; ++i)
    bits |= std::uint32_t(bytes[i]) << (little_endian ? 8 * i : 24 - 8 * i);
  return std::bit_cast<float>(bits);
}

}  // namespace

bool is_pfm(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= 3 && bytes[0] == 'P' && (bytes[1] == 'F' || bytes[1] == 'f') &&
         (bytes[2] == '\n' || bytes[2] == ' ' || bytes[2] == '\r' || bytes[2] == '\t');
}

Image decode_pfm(std::span<const std::uint8_t> bytes, const std::string& name) {
  const auto fail = [&](const std::string& what) { throw Error(Error::Kind::input, name, what); };
  HeaderText header(bytes);
  const std::string_view kind = header.word();
  if (kind != "PF" && kind != "Pf") fail("is not a PFM file: it must begin with PF or Pf");
  const auto width = parse_number<std::int64_t>(header.word());
  const auto height = parse_number<std::int64_t>(header.word());
  const auto scale = parse_number<double>(header.word());
  if (!width || !height) fail("is a corrupt PFM: line 2 must hold width and height");
  if (!scale || *scale == 0) fail("is a corrupt PFM: line 3 must hold -1.0 or 1.0 (byte order)");

  const int channels = kind == "PF" ? 3 : 1;
  check_picture_size({*width, *height, channels * 4}, bytes.size(), name);
  Image image(int(*width), int(*height), channels);
  const std::size_t needed = 4 * image.values.size();
  const std::span<const std::uint8_t> pixels = bytes.subspan(header.position());
  if (pixels.size() < needed) {
    fail(fmt::format("is an incomplete PFM: {} x {} pixels need {} bytes, it holds {}", *width,
                     *height, needed, pixels.size()));
  }
  const std::size_t row = std::size_t(*width) * std::size_t(channels);
  for (std::size_t y = 0; y < std::size_t(*height); ++y) {
    float* out = &image.values[(std::size_t(*height) - 1 - y) * row];
    for (std::size_t i = 0; i < row; ++i) out[i] = float_at(&pixels[4 * (y * row + i)], *scale < 0);
  }
  return image;
}

std::vector<std::uint8_t> encode_pfm(const Image& image) {
  static_assert(std::endian::native == std::endian::little);
  const std::string header = fmt::format("{}\n{} {}\n-1.0\n", image.channels == 1 ? "Pf" : "PF",
                                         image.width_px, image.height_px);
  std::vector<std::uint8_t> bytes(header.begin(), header.end());
  const std::size_t row_bytes = std::size_t(image.width_px) * std::size_t(image.channels) * 4;
  bytes.reserve(bytes.size() + row_bytes * std::size_t(image.height_px));
  for (int y = image.height_px - 1; y >= 0; --y) {
    const auto* row = reinterpret_cast<const std::uint8_t*>(&image.values[image.offset(0, y)]);
    bytes.insert(bytes.end(), row, row + row_bytes);
  }
  return bytes;
}

}  // namespace arris
