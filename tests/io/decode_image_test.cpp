#include "io/decode_image.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <png.h>

#include <cstdlib>
#include <random>

#include "arris/error.h"
#include "io/picture_jpeg.h"
#include "io/picture_png.h"

namespace arris {
namespace {

using testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;
using Texel = std::array<std::uint8_t, 4>;

Samples8 noise(int width, int height, int channels) {
  std::mt19937 random(7);
  Samples8 image{width, height, channels, {}};
  for (int i = 0; i < width * height * channels; ++i) {
    image.samples.push_back(std::uint8_t(random()));
  }
  return image;
}

// What other programs write: any colour type, depth and interlacing; libpng packs nothing by
// itself.
Bytes png_of(int width, int height, int type, int depth, int interlace, const Bytes& row) {
  Bytes bytes;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(
      png, &bytes,
      [](png_structp p, png_bytep data, std::size_t count) {
        auto* out = static_cast<Bytes*>(png_get_io_ptr(p));
        out->insert(out->end(), data, data + count);
      },
      nullptr);
  png_set_IHDR(png, info, png_uint_32(width), png_uint_32(height), depth, type, interlace,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  const std::array<png_color, 3> palette{{{255, 0, 0}, {0, 255, 0}, {1, 2, 3}}};
  const std::array<png_byte, 1> transparency{77};
  if (type == PNG_COLOR_TYPE_PALETTE) {
    png_set_PLTE(png, info, palette.data(), palette.size());
    png_set_tRNS(png, info, transparency.data(), transparency.size(), nullptr);
  }
  png_write_info(png, info);
  const std::vector<png_bytep> rows(std::size_t(height), const_cast<png_bytep>(row.data()));
  png_write_image(png, const_cast<png_bytepp>(rows.data()));
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  return bytes;
}

std::string error_of(const Bytes& bytes) {
  try {
    decode_image(bytes, "wood.png");
  } catch (const Error& error) {
    EXPECT_EQ(int(error.kind()), int(Error::Kind::input));
    return error.what();
  }
  return "no error";
}

TEST(DecodeImage, png_returns_what_was_encoded) {
  for (const int channels : {1, 3, 4}) {
    const Samples8 image = noise(5, 3, channels);
    const Rgba8Image decoded = decode_image(encode_png(image), "a");
    ASSERT_EQ(decoded.width_px, 5);
    ASSERT_EQ(decoded.height_px, 3);
    for (std::size_t i = 0; i < decoded.texels.size(); ++i) {
      const std::uint8_t* s = &image.samples[i * std::size_t(channels)];
      const Texel expected = channels == 1   ? Texel{s[0], s[0], s[0], 255}
                             : channels == 3 ? Texel{s[0], s[1], s[2], 255}
                                             : Texel{s[0], s[1], s[2], s[3]};
      EXPECT_EQ(decoded.texels[i], expected) << i;
    }
  }
}

TEST(DecodeImage, reads_every_kind_of_png) {
  for (const int interlace : {PNG_INTERLACE_NONE, PNG_INTERLACE_ADAM7}) {
    const auto first_row = [&](int type, int depth, const Bytes& row) {
      const Rgba8Image image = decode_image(png_of(3, 4, type, depth, interlace, row), "a");
      EXPECT_EQ(image.texels.size(), 12U);
      return std::vector<Texel>(image.texels.begin(), image.texels.begin() + 3);
    };
    EXPECT_EQ(first_row(PNG_COLOR_TYPE_GRAY, 1, {0b10100000}),
              (std::vector<Texel>{{255, 255, 255, 255}, {0, 0, 0, 255}, {255, 255, 255, 255}}));
    EXPECT_EQ(first_row(PNG_COLOR_TYPE_GRAY, 4, {0x0F, 0x80}),
              (std::vector<Texel>{{0, 0, 0, 255}, {255, 255, 255, 255}, {136, 136, 136, 255}}));
    EXPECT_EQ(first_row(PNG_COLOR_TYPE_PALETTE, 2, {0b00011000}),
              (std::vector<Texel>{{255, 0, 0, 77}, {0, 255, 0, 255}, {1, 2, 3, 255}}));
    EXPECT_EQ(first_row(PNG_COLOR_TYPE_GRAY_ALPHA, 8, {9, 1, 8, 2, 7, 3}),
              (std::vector<Texel>{{9, 9, 9, 1}, {8, 8, 8, 2}, {7, 7, 7, 3}}));
    EXPECT_EQ(first_row(PNG_COLOR_TYPE_GRAY, 16, {0xFF, 0xFF, 0x80, 0x80, 0x00, 0xFF}),
              (std::vector<Texel>{{255, 255, 255, 255}, {128, 128, 128, 255}, {1, 1, 1, 255}}));
  }
}

TEST(DecodeImage, png16_keeps_all_bits) {
  const Bytes png = png_of(1, 1, PNG_COLOR_TYPE_RGB, 16, PNG_INTERLACE_NONE,
                           {0x12, 0x34, 0x56, 0x78, 0x9A, 0xBC});
  const Rgba16Image image = decode_png16(png, "a");
  EXPECT_EQ(image.pixels[0], (std::array<std::uint16_t, 4>{0x1234, 0x5678, 0x9ABC, 0xFFFF}));
}

TEST(DecodeImage, jpeg_returns_nearly_what_was_encoded) {
  Samples8 image{40, 30, 3, {}};
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < 40; ++x) {
      for (const int value : {x * 6, y * 8, 255 - x * 6}) {
        image.samples.push_back(std::uint8_t(value));
      }
    }
  }
  const Rgba8Image decoded = decode_image(encode_jpeg(image, 95), "a");
  ASSERT_EQ(decoded.texels.size(), 1200U);
  for (std::size_t i = 0; i < 1200; ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_LE(std::abs(int(decoded.texels[i][c]) - int(image.samples[3 * i + c])), 4);
    }
    EXPECT_EQ(decoded.texels[i][3], 255);
  }
}

TEST(DecodeImage, reads_grey_jpegs) {
  const Rgba8Image image = decode_image(encode_jpeg({8, 8, 1, Bytes(64, 200)}, 95), "a");
  EXPECT_EQ(image.texels[0], (Texel{200, 200, 200, 255}));
}

TEST(DecodeImage, files_cut_at_any_byte_are_errors) {
  for (const Bytes& whole : {encode_png(noise(6, 5, 4)), encode_jpeg(noise(20, 9, 3), 80)}) {
    ASSERT_EQ(error_of(whole), "no error");
    for (std::size_t size = 0; size < whole.size(); ++size) {
      EXPECT_THAT(error_of(Bytes(whole.begin(), whole.begin() + std::ptrdiff_t(size))),
                  HasSubstr("wood.png: is "))
          << size;
    }
  }
}

TEST(DecodeImage, damaged_pngs_are_errors) {
  const Bytes whole = encode_png(noise(6, 5, 4));
  for (std::size_t i = 0; i < whole.size(); ++i) {
    if (i >= 33 && i < 46) continue;  // the sRGB chunk, on which the pixels don't depend
    Bytes damaged = whole;
    damaged[i] ^= 0x10;
    EXPECT_NE(error_of(damaged), "no error") << i;
  }
}

TEST(DecodeImage, absurd_sizes_are_refused_before_memory_is_taken) {
  Bytes png = encode_png(noise(1, 1, 3));
  // Width and height 65,535 in the header, with its checksum.
  png[18] = png[19] = png[22] = png[23] = 0xFF;
  const std::uint32_t crc = [&] {
    std::uint32_t c = ~0U;
    for (std::size_t i = 12; i < 29; ++i) {
      c ^= png[i];
      for (int bit = 0; bit < 8; ++bit) c = (c >> 1) ^ (0xEDB88320U & (0U - (c & 1U)));
    }
    return ~c;
  }();
  for (std::size_t i = 0; i < 4; ++i) png[29 + i] = std::uint8_t(crc >> (24 - 8 * i));
  EXPECT_THAT(error_of(png), HasSubstr("65535 x 65535 pixels is too large"));
}

TEST(DecodeImage, other_files_are_named_as_such) {
  EXPECT_EQ(error_of({}), "wood.png: is empty; a PNG or JPEG picture is needed");
  EXPECT_EQ(error_of({'G', 'I', 'F', '8'}),
            "wood.png: is neither PNG nor JPEG; convert it to one of them");
}

}  // namespace
}  // namespace arris
