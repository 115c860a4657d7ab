#include "io/picture_file.h"

#include <ImfArray.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <ImfTiledOutputFile.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "arris/error.h"
#include "image/srgb.h"
#include "io/file_bytes.h"
#include "io/picture_exr.h"
#include "io/picture_hdr.h"
#include "io/picture_pfm.h"
#include "support/cut_every_byte.h"
#include "support/temporary_folder.h"

namespace arris {
namespace {

using test::TemporaryFolder;
using testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;

Image gradient(int width, int height, int channels, float scale = 1) {
  Image image(width, height, channels);
  for (std::size_t i = 0; i < image.values.size(); ++i) image.values[i] = scale * float(i) - 3;
  return image;
}

Picture small_picture() {
  Picture picture{gradient(7, 5, 3, 0.37F), {}};
  picture.layers.push_back({"albedo", gradient(7, 5, 3, 0.1F)});
  picture.layers.push_back({"depth", gradient(7, 5, 1, 1e20F)});
  picture.layers.push_back({"tint", gradient(7, 5, 4, 2)});
  return picture;
}

std::string error_of(const Bytes& bytes) {
  try {
    decode_picture(bytes, "in");
  } catch (const Error& error) {
    EXPECT_EQ(int(error.kind()), int(Error::Kind::input));
    return error.what();
  }
  return "no error";
}

Bytes bytes_of(std::string_view text) {
  return {text.begin(), text.end()};
}

// Two pixels wide: 1.0, 0.5, 0.25 and black.
const std::string kFlatHdr = std::string("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n") +
                             "\x80\x40\x20\x81" + std::string(4, '\0');

// ---- round trips

TEST(PictureFile, exr_keeps_every_value_layer_and_attribute) {
  const Picture picture = small_picture();
  const PictureFile read = decode_exr(encode_exr(picture, {{"arris.samples", "0..64"}}), "a");
  EXPECT_EQ(read.picture.color.values, picture.color.values);
  ASSERT_EQ(read.picture.layers.size(), 3U);
  for (const Layer& layer : picture.layers) {
    const auto found = std::find_if(read.picture.layers.begin(), read.picture.layers.end(),
                                    [&](const Layer& l) { return l.name == layer.name; });
    ASSERT_NE(found, read.picture.layers.end()) << layer.name;
    EXPECT_EQ(found->image.channels, layer.image.channels);
    EXPECT_EQ(found->image.values, layer.image.values);
  }
  EXPECT_EQ(read.attributes, (Attributes{{"arris.samples", "0..64"}}));
}

TEST(PictureFile, pfm_keeps_every_value) {
  for (const int channels : {1, 3}) {
    const Image image = gradient(7, 5, channels, 1e-3F);
    const Image read = decode_pfm(encode_pfm(image), "a");
    EXPECT_EQ(read.values, image.values);
    EXPECT_EQ(read.channels, channels);
  }
}

TEST(PictureFile, png_without_tone_mapping_returns_the_nearest_code) {
  Image image(256, 1, 3);
  for (std::size_t i = 0; i < 768; ++i) {
    const std::size_t code = i / 3;
    image.values[i] = linear_from_srgb(float(code) / 255);
  }
  SaveOptions options;
  options.tone_map = false;
  const Bytes png = encode_picture({image, {}}, PictureFormat::png, options);
  EXPECT_EQ(decode_picture(png, "a").picture.color.values, image.values);
}

TEST(PictureFile, exposure_doubles_the_light_per_stop) {
  const Image image = [] {
    Image grey(1, 1, 3);
    grey.values.assign(3, 0.1F);
    return grey;
  }();
  SaveOptions options;
  options.tone_map = false;
  options.exposure = 2;
  const Bytes png = encode_picture({image, {}}, PictureFormat::png, options);
  EXPECT_NEAR(decode_picture(png, "a").picture.color.values[0], 0.4F, 0.004F);
}

TEST(PictureFile, transparency_becomes_a_layer) {
  Image image(2, 1, 4);
  image.values = {1, 1, 1, 1, 0, 0, 0, 0.2F};
  const PictureFile file = decode_picture(encode_picture({image, {}}, PictureFormat::png, {}), "a");
  ASSERT_EQ(file.picture.layers.size(), 1U);
  EXPECT_EQ(file.picture.layers[0].name, "alpha");
  EXPECT_NEAR(file.picture.layers[0].image.values[1], 0.2F, 1e-3F);
}

TEST(PictureFile, save_and_load_by_extension_with_layers_beside) {
  const TemporaryFolder folder;
  const Picture picture = small_picture();
  for (const char* name : {"a.png", "a.jpg", "a.JPEG", "a.exr", "a.pfm"}) {
    save_picture(picture, folder / name);
    EXPECT_EQ(load_picture(folder / name).color.width_px, 7) << name;
  }
  EXPECT_EQ(load_picture(folder / "a.depth.pfm").color.at(3, 2, 0),
            picture.layers[1].image.at(3, 2, 0));
  EXPECT_THROW(save_picture(picture, folder / "a.gif"), Error);
  EXPECT_THROW(save_picture(picture, folder / "a"), Error);
}

TEST(PictureFile, values_that_are_no_numbers_are_saved_as_black_or_white) {
  Image image(3, 1, 3);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  image.values = {nan, nan, nan, inf, inf, inf, -inf, -1, -0.0F};
  for (const bool tone_map : {true, false}) {
    SaveOptions options;
    options.tone_map = tone_map;
    const auto values =
        decode_picture(encode_picture({image, {}}, PictureFormat::png, options), "a")
            .picture.color.values;
    EXPECT_EQ(values, (std::vector<float>{0, 0, 0, 1, 1, 1, 0, 0, 0})) << tone_map;
  }
}

// ---- files of other programs

TEST(PictureFile, reads_big_endian_pfm_from_bottom_to_top) {
  Bytes bytes = bytes_of("Pf\n1 2\n1.0\n");
  for (const int byte : {0x3F, 0x80, 0, 0, 0x40, 0, 0, 0}) bytes.push_back(std::uint8_t(byte));
  EXPECT_EQ(decode_pfm(bytes, "a").values, (std::vector<float>{2, 1}));
}

TEST(PictureFile, reads_flat_radiance_pixels) {
  EXPECT_EQ(decode_hdr(bytes_of(kFlatHdr), "a").values,
            (std::vector<float>{1, 0.5F, 0.25F, 0, 0, 0}));
}

TEST(PictureFile, divides_radiance_pixels_by_their_exposure) {
  std::string text = kFlatHdr;
  text.insert(text.find("FORMAT"), "EXPOSURE=2\nEXPOSURE= 4\n");
  EXPECT_EQ(decode_hdr(bytes_of(text), "a").values[0], 0.125F);
}

TEST(PictureFile, reads_both_radiance_run_length_schemes_and_mirrored_pictures) {
  const std::string pixel = "\x80\x40\x20\x81";
  const std::string old_scheme = "#?RGBE\n\n+Y 2 -X 300\n" + pixel +
                                 std::string("\1\1\1\x2B\1\1\1\1", 8) + std::string(4, '\0') +
                                 std::string("\1\1\1\x2B\1\1\1\1", 8);
  const Image image = decode_hdr(bytes_of(old_scheme), "a");
  ASSERT_EQ(image.height_px, 2);
  EXPECT_EQ(image.at(0, 1, 0), 1.0F);
  EXPECT_EQ(image.at(299, 1, 2), 0.25F);
  EXPECT_EQ(image.at(0, 0, 0), 0.0F);

  // Eight pixels by planes: a run of 8, a run of 5 and 3 values, 8 values, a run.
  const std::string planes = std::string("\2\2\0\x08", 4) + "\x88\x80" +
                             "\x85\x40\x03\x10\x20\x30" + "\x08" + "abcdefgh" + "\x88\x81";
  const Image planar = decode_hdr(bytes_of("#?RADIANCE\n\n-Y 1 +X 8\n" + planes), "a");
  EXPECT_EQ(planar.at(7, 0, 0), 1.0F);
  EXPECT_EQ(planar.at(4, 0, 1), 0.5F);
  EXPECT_EQ(planar.at(6, 0, 1), 0.25F);
  EXPECT_EQ(planar.at(2, 0, 2), float('c') / 128);
}

TEST(PictureFile, reads_half_tiled_and_offset_exr) {
  const TemporaryFolder folder;
  const std::string path = folder / "tiled.exr";
  {
    Imf::Header header(40, 30);
    header.dataWindow() = Imath::Box2i({-5, 10}, {34, 39});
    header.channels().insert("N.X", Imf::Channel(Imf::HALF));
    header.channels().insert("N.Y", Imf::Channel(Imf::HALF));
    header.channels().insert("N.Z", Imf::Channel(Imf::HALF));
    header.channels().insert("Y", Imf::Channel(Imf::HALF));
    header.setTileDescription(Imf::TileDescription(16, 16));
    Imf::Array2D<half> pixels(30, 40);
    for (int y = 0; y < 30; ++y) {
      for (int x = 0; x < 40; ++x) pixels[y][x] = half(float(y * 40 + x));
    }
    Imf::TiledOutputFile file(path.c_str(), header);
    Imf::FrameBuffer frame;
    for (const char* channel : {"N.X", "N.Y", "N.Z", "Y"}) {
      frame.insert(channel, Imf::Slice(Imf::HALF, reinterpret_cast<char*>(&pixels[-10][5]), 2, 80));
    }
    file.setFrameBuffer(frame);
    file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
  }
  const Picture picture = load_picture(path);
  EXPECT_EQ(picture.color.at(39, 0, 2), 39.0F);
  EXPECT_EQ(picture.color.at(3, 29, 1), 1163.0F);
  ASSERT_EQ(picture.layers.size(), 1U);
  EXPECT_EQ(picture.layers[0].name, "N");
  EXPECT_EQ(picture.layers[0].image.at(3, 29, 1), 1163.0F);
}

// ---- what is wrong

TEST(PictureFile, cut_or_changed_files_give_one_clear_error_or_a_picture) {
  const auto read = [](std::span<const std::uint8_t> bytes) {
    const PictureFile file = decode_picture(bytes, "in");
    EXPECT_EQ(file.picture.color.values.size(), std::size_t(file.picture.color.width_px) *
                                                    std::size_t(file.picture.color.height_px) * 3);
    Scene scene;
    scene.materials.emplace_back();
    return scene;
  };
  const Picture picture = small_picture();
  for (const PictureFormat format :
       {PictureFormat::png, PictureFormat::jpeg, PictureFormat::exr, PictureFormat::pfm}) {
    const Bytes file = encode_picture(picture, format);
    test::cut_every_byte(file, read);
    test::change_every_byte(file, read);
  }
  test::cut_every_byte(bytes_of(kFlatHdr), read);
  test::change_every_byte(bytes_of(kFlatHdr), read);
}

TEST(PictureFile, files_cut_at_any_byte_are_errors) {
  const Picture picture = small_picture();
  for (const Bytes& whole :
       {encode_exr(picture, {}), encode_pfm(picture.color), bytes_of(kFlatHdr)}) {
    ASSERT_EQ(error_of(whole), "no error");
    for (std::size_t size = 0; size < whole.size(); ++size) {
      ASSERT_THAT(error_of(Bytes(whole.begin(), whole.begin() + std::ptrdiff_t(size))),
                  testing::StartsWith("in: "))
          << size;
    }
  }
}

TEST(PictureFile, absurd_sizes_are_refused_before_memory_is_taken) {
  EXPECT_THAT(error_of(bytes_of("PF\n99999 99999\n-1\n")),
              HasSubstr("99999 x 99999 pixels is too large"));
  EXPECT_THAT(error_of(bytes_of("PF\n8192 8192\n-1\n")),
              HasSubstr("can't be in a file of 16 bytes"));
  EXPECT_THAT(error_of(bytes_of("PF\n-1 5\n-1\n")), HasSubstr("-1 x 5 pixels is no picture"));
  EXPECT_THAT(error_of(bytes_of("#?RGBE\n\n-Y 8192 +X 8192\n")), HasSubstr("can't be in a file"));
}

TEST(PictureFile, says_what_is_wrong_in_the_header) {
  EXPECT_THAT(error_of({}), HasSubstr("is empty"));
  EXPECT_THAT(error_of(bytes_of("GIF89a")), HasSubstr("no PNG, JPEG, EXR, PFM or Radiance HDR"));
  EXPECT_THAT(error_of(bytes_of("PF\nx 2\n-1\n")), HasSubstr("width and height"));
  EXPECT_THAT(error_of(bytes_of("PF\n1 2\n0\n")), HasSubstr("byte order"));
  EXPECT_THAT(error_of(bytes_of("PF\n1 2\n-1\nabc")), HasSubstr("need 24 bytes, it holds 3"));
  EXPECT_THAT(error_of(bytes_of("#?RGBE\nFORMAT=32-bit_rle_xyze\n\n")), HasSubstr("convert it"));
  EXPECT_THAT(error_of(bytes_of("#?RGBE\n\n+X 8 -Y 8\n")), HasSubstr("use -Y height +X width"));
}

TEST(PictureFile, what_is_wrong_with_an_exr_is_said_to_its_end) {
  Bytes bytes = encode_picture(small_picture(), PictureFormat::exr);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  // The type of the attribute, so that OpenEXR reads another one than it expects.
  bytes[text.find("displayWindow") + 14] = 'x';
  EXPECT_EQ(error_of(bytes),
            "in: is a corrupt or incomplete EXR: Unexpected type for image attribute "
            "\"displayWindow\"");
}

TEST(PictureFile, an_exr_attribute_larger_than_the_file_is_refused_before_memory_is_taken) {
  Bytes bytes = encode_picture(small_picture(), PictureFormat::exr);
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::size_t size =
      text.find("displayWindow") + std::string_view("displayWindow.box2i.").size();
  bytes[size + 3] = 0x7F;
  EXPECT_THAT(
      error_of(bytes),
      testing::StartsWith("in: is a corrupt or incomplete EXR: attribute \"displayWindow\" has "
                          "2130706448 bytes, but only "));
}

TEST(PictureFile, a_size_that_the_format_does_not_take_is_refused) {
  const auto refusal = [](PictureFormat format, int width, int height) {
    try {
      encode_picture({Image(width, height, 3), {}}, format);
    } catch (const Error& error) {
      EXPECT_EQ(int(error.kind()), int(Error::Kind::input));
      return std::string(error.what());
    }
    return std::string();
  };
  for (const PictureFormat format :
       {PictureFormat::png, PictureFormat::jpeg, PictureFormat::exr, PictureFormat::pfm}) {
    EXPECT_EQ(refusal(format, 0, 0),
              "0 x 0 pixels are no picture; use 1 to " +
                  std::string(format == PictureFormat::jpeg ? "65500" : "65535") + " on a side");
    EXPECT_EQ(refusal(format, 3, 2), "");
  }
  EXPECT_EQ(refusal(PictureFormat::jpeg, 65501, 1),
            "65501 x 1 pixels are too many for JPEG; use at most 65500 on a side, or .png");
  EXPECT_EQ(refusal(PictureFormat::jpeg, 65500, 1), "");
  EXPECT_EQ(refusal(PictureFormat::png, 65501, 1), "");
}

}  // namespace
}  // namespace arris
