#include "io/picture_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "arris/error.h"
#include "image/srgb.h"
#include "io/file_bytes.h"
#include "io/file_kind.h"
#include "io/picture_exr.h"
#include "io/picture_hdr.h"
#include "io/picture_jpeg.h"
#include "io/picture_limits.h"
#include "io/picture_pfm.h"
#include "io/picture_png.h"

namespace arris {
namespace {

constexpr std::uint64_t kMaxPictureBytes = kMaxFileBytes;

// ---- 8 and 16 bits to linear

// Alpha becomes a layer, unless every pixel is opaque.
template <class Sample>
Picture linear_picture(int width, int height, const std::vector<std::array<Sample, 4>>& pixels) {
  constexpr std::size_t kCodes = std::size_t(1) << (8 * sizeof(Sample));
  std::vector<float> linear(kCodes);
  for (std::size_t i = 0; i < kCodes; ++i) {
    linear[i] = linear_from_srgb(float(i) / float(kCodes - 1));
  }
  Picture picture{Image(width, height, 3), {}};
  Image alpha(width, height, 1);
  bool opaque = true;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) picture.color.values[3 * i + c] = linear[pixels[i][c]];
    alpha.values[i] = float(pixels[i][3]) / float(kCodes - 1);
    opaque = opaque && pixels[i][3] == kCodes - 1;
  }
  if (!opaque) picture.layers.push_back({"alpha", std::move(alpha)});
  return picture;
}

Picture three_channels(Image image) {
  if (image.channels == 3) return {std::move(image), {}};
  Picture picture{Image(image.width_px, image.height_px, 3), {}};
  for (std::size_t i = 0; i < picture.color.values.size(); ++i) {
    picture.color.values[i] = image.values[i / 3];
  }
  return picture;
}

// ---- linear to 8 bits

Samples8 display_samples(const Image& image, const SaveOptions& options) {
  Samples8 out{image.width_px, image.height_px, image.channels, {}};
  out.samples.resize(image.values.size());
  const float scale = float(std::exp2(options.exposure));
  const auto clip = [&](float value) { return srgb_from_linear(value * scale); };
  const std::size_t channels = std::size_t(image.channels);
  for (std::size_t i = 0; i < image.values.size(); i += channels) {
    const float* in = &image.values[i];
    Rgb color = channels == 1 ? Rgb(in[0]) : Rgb{in[0], in[1], in[2]};
    color = options.tone_map ? tone_map(color, options.exposure)
                             : Rgb{clip(color.x), clip(color.y), clip(color.z)};
    for (std::size_t c = 0; c < std::min<std::size_t>(channels, 3); ++c) {
      out.samples[i + c] = quantize8(color[int(c)]);
    }
    if (channels == 4) out.samples[i + 3] = quantize8(in[3]);
  }
  return out;
}

}  // namespace

PictureFile decode_picture(std::span<const std::uint8_t> bytes, const std::string& name) {
  if (is_png(bytes)) {
    const Rgba16Image image = decode_png16(bytes, name);
    return {linear_picture(image.width_px, image.height_px, image.pixels), {}, ValueEncoding::srgb};
  }
  if (is_jpeg(bytes)) {
    const Rgba8Image image = decode_jpeg(bytes, name);
    return {linear_picture(image.width_px, image.height_px, image.texels), {}, ValueEncoding::srgb};
  }
  if (is_exr(bytes)) return decode_exr(bytes, name);
  if (is_pfm(bytes)) return {three_channels(decode_pfm(bytes, name)), {}};
  if (is_hdr(bytes)) return {three_channels(decode_hdr(bytes, name)), {}};
  throw Error(Error::Kind::input, name,
              bytes.empty() ? "is empty; a picture is needed"
                            : "is no PNG, JPEG, EXR, PFM or Radiance HDR picture");
}

PictureFile load_picture_file(const std::filesystem::path& path) {
  return decode_picture(read_file_bytes(path, kMaxPictureBytes), path.string());
}

Picture load_picture(const std::filesystem::path& path) {
  return load_picture_file(path).picture;
}

PictureFormat picture_format(const std::filesystem::path& path) {
  const std::string extension = extension_of(path);
  if (extension == ".png") return PictureFormat::png;
  if (extension == ".jpg" || extension == ".jpeg") return PictureFormat::jpeg;
  if (extension == ".exr") return PictureFormat::exr;
  if (extension == ".pfm") return PictureFormat::pfm;
  throw Error(Error::Kind::input, path.string(),
              extension.empty() ? "has no extension; use .png, .jpg, .exr or .pfm"
                                : fmt::format("\"{}\" is no picture format that can be written; "
                                              "use .png, .jpg, .exr or .pfm",
                                              extension));
}

std::string problem_with_size(PictureFormat format, int width_px, int height_px) {
  const int most = format == PictureFormat::jpeg ? kMaxJpegSide : int(kMaxPictureSide);
  if (width_px >= 1 && height_px >= 1 && width_px <= most && height_px <= most) return "";
  const std::string size = fmt::format("{} x {} pixels", width_px, height_px);
  if (format == PictureFormat::jpeg && width_px >= 1 && height_px >= 1) {
    return fmt::format("{} are too many for JPEG; use at most {} on a side, or .png", size, most);
  }
  return fmt::format("{} are no picture; use 1 to {} on a side", size, most);
}

std::vector<std::uint8_t> encode_picture(const Picture& picture, PictureFormat format,
                                         const SaveOptions& options) {
  const std::string problem =
      problem_with_size(format, picture.color.width_px, picture.color.height_px);
  if (!problem.empty()) throw Error(Error::Kind::input, "", problem);
  switch (format) {
    case PictureFormat::png:
      return encode_png(display_samples(picture.color, options));
    case PictureFormat::jpeg:
      return encode_jpeg(display_samples(picture.color, options), options.jpeg_quality);
    case PictureFormat::exr:
      return encode_exr(picture, options.attributes);
    case PictureFormat::pfm:
      return encode_pfm(picture.color);
  }
  return {};
}

std::filesystem::path layer_file(const std::filesystem::path& path, const std::string& layer) {
  std::filesystem::path file = path;
  return file.replace_extension("." + layer + ".pfm");
}

std::filesystem::path shown_layer_file(const std::filesystem::path& path,
                                       const std::string& layer) {
  return layer_file(path, layer).replace_extension(".png");
}

void save_picture(const Picture& picture, const std::filesystem::path& path,
                  const SaveOptions& options) {
  const PictureFormat format = picture_format(path);
  NewFiles files;
  files.add(path, encode_picture(picture, format, options));
  SaveOptions shown;
  shown.tone_map = false;
  for (const Layer& layer : picture.layers) {
    if (format == PictureFormat::exr) break;
    files.add(layer_file(path, layer.name), encode_pfm(layer.image));
    const std::vector<std::string>& names = options.shown_layers;
    if (std::ranges::find(names, layer.name) == names.end()) continue;
    files.add(shown_layer_file(path, layer.name), encode_png(display_samples(layer.image, shown)));
  }
  files.appear();
}

}  // namespace arris
