#include "io/picture_hdr.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <vector>

#include "arris/error.h"
#include "io/header_text.h"
#include "io/picture_limits.h"

namespace arris {
namespace {

using Rgbe = std::array<std::uint8_t, 4>;

struct Header {
  std::int64_t width = 0, height = 0;
  bool bottom_up = false, right_to_left = false;
  double exposure = 1;
  std::size_t pixels_at = 0;
};

bool begins_with(std::span<const std::uint8_t> bytes, std::string_view text) {
  return bytes.size() >= text.size() && std::equal(text.begin(), text.end(), bytes.begin());
}

// The resolution line: "-Y 512 +X 1024".
void parse_resolution(std::string_view line, Header& header, const std::string& name) {
  HeaderText words({reinterpret_cast<const std::uint8_t*>(line.data()), line.size()});
  const std::string_view y = words.word();
  const auto height = parse_number<std::int64_t>(words.word());
  const std::string_view x = words.word();
  const auto width = parse_number<std::int64_t>(words.word());
  if ((y != "-Y" && y != "+Y") || (x != "-X" && x != "+X") || !height || !width) {
    throw Error(Error::Kind::input, name,
                fmt::format("resolution \"{}\" is not understood; use -Y height +X width",
                            printable(line)));
  }
  header.height = *height;
  header.width = *width;
  header.bottom_up = y == "+Y";
  header.right_to_left = x == "-X";
}

Header parse_header(std::span<const std::uint8_t> bytes, const std::string& name) {
  HeaderText text(bytes);
  Header header;
  const auto fail = [&](const std::string& what) { throw Error(Error::Kind::input, name, what); };
  if (!is_hdr(bytes)) fail("is not a Radiance picture: it must begin with #?RADIANCE or #?RGBE");
  while (true) {
    const auto line = text.line();
    if (!line) fail("is an incomplete Radiance picture: its header has no end");
    if (line->empty() || *line == "\r") break;
    constexpr std::string_view kFormat = "FORMAT=", kExposure = "EXPOSURE=";
    if (line->starts_with(kFormat) && !line->starts_with("FORMAT=32-bit_rle_rgbe")) {
      fail(fmt::format("{} is not supported; convert it to 32-bit_rle_rgbe", printable(*line)));
    }
    if (line->starts_with(kExposure)) {
      HeaderText value({reinterpret_cast<const std::uint8_t*>(line->data()) + kExposure.size(),
                        line->size() - kExposure.size()});
      const auto exposure = parse_number<double>(value.word());
      if (!exposure || !(*exposure > 0)) fail("has an EXPOSURE that is not a positive number");
      header.exposure *= *exposure;
    }
  }
  const auto resolution = text.line();
  if (!resolution) fail("is an incomplete Radiance picture: it has no resolution line");
  parse_resolution(*resolution, header, name);
  header.pixels_at = text.position();
  return header;
}

// One scanline after another from the encoded pixels.
class Scanlines {
 public:
  Scanlines(std::span<const std::uint8_t> bytes, std::size_t width, const std::string& name)
      : bytes_(bytes), row_(width), name_(name) {}

  const std::vector<Rgbe>& next() {
    ++line_;
    constexpr std::size_t kMinPlanar = 8, kMaxPlanar = 0x7FFF;
    const Rgbe first = take_pixel();
    if (row_.size() < kMinPlanar || row_.size() > kMaxPlanar || first[0] != 2 || first[1] != 2 ||
        first[2] >= 128) {
      read_pixelwise(first);
    } else if ((std::size_t(first[2]) << 8 | first[3]) != row_.size()) {
      fail(fmt::format("says it is {} pixels wide", std::size_t(first[2]) << 8 | first[3]));
    } else {
      for (std::size_t channel = 0; channel < 4; ++channel) read_plane(channel);
    }
    return row_;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(Error::Kind::input, name_, fmt::format("scanline {}: {}", line_, what));
  }

  std::uint8_t take() {
    if (position_ == bytes_.size()) fail("the file ends too early");
    return bytes_[position_++];
  }
  Rgbe take_pixel() {
    Rgbe pixel{};
    for (std::uint8_t& value : pixel) value = take();
    return pixel;
  }

  // The old scheme: pixels, and (1, 1, 1, n) for n repeats of the one before; runs of runs count in
  // powers of 256.
  void read_pixelwise(Rgbe pixel) {
    int shift = 0;
    for (std::size_t x = 0; x < row_.size();) {
      if (pixel[0] == 1 && pixel[1] == 1 && pixel[2] == 1) {
        const std::size_t count = std::size_t(pixel[3]) << shift;
        if (x == 0 || shift > 16 || count > row_.size() - x) fail("a run does not fit");
        std::fill_n(row_.begin() + std::ptrdiff_t(x), count, row_[x - 1]);
        x += count;
        shift += 8;
      } else {
        row_[x++] = pixel;
        shift = 0;
      }
      if (x < row_.size()) pixel = take_pixel();
    }
  }

  void read_plane(std::size_t channel) {
    for (std::size_t x = 0; x < row_.size();) {
      const std::uint8_t code = take();
      const bool run = code > 128;
      const std::size_t count = run ? code - 128U : code;
      if (count == 0 || count > row_.size() - x) fail("a run does not fit");
      std::uint8_t value = run ? take() : std::uint8_t(0);
      for (std::size_t i = 0; i < count; ++i) {
        if (!run) value = take();
        row_[x++][channel] = value;
      }
    }
  }

  std::span<const std::uint8_t> bytes_;
  std::vector<Rgbe> row_;
  const std::string& name_;
  std::size_t position_ = 0;
  std::size_t line_ = 0;
};

}  // namespace

bool is_hdr(std::span<const std::uint8_t> bytes) {
  return begins_with(bytes, "#?RADIANCE") || begins_with(bytes, "#?RGBE");
}

Image decode_hdr(std::span<const std::uint8_t> bytes, const std::string& name) {
  const Header header = parse_header(bytes, name);
  check_picture_size({header.width, header.height, 12}, bytes.size(), name);
  Image image(int(header.width), int(header.height), 3);
  Scanlines scanlines(bytes.subspan(header.pixels_at), std::size_t(header.width), name);
  for (int line = 0; line < image.height_px; ++line) {
    const std::vector<Rgbe>& row = scanlines.next();
    const int y = header.bottom_up ? image.height_px - 1 - line : line;
    for (int i = 0; i < image.width_px; ++i) {
      const int x = header.right_to_left ? image.width_px - 1 - i : i;
      const Rgbe& pixel = row[std::size_t(i)];
      const double unit = pixel[3] == 0 ? 0 : std::ldexp(1 / header.exposure, int(pixel[3]) - 136);
      for (int c = 0; c < 3; ++c) {
        image.at(x, y, c) = pixel[3] == 0 ? 0.0F : float(pixel[std::size_t(c)] * unit);
      }
    }
  }
  return image;
}

}  // namespace arris
