#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "arris/command_line.h"
#include "arris/commands.h"
#include "arris/error.h"
#include "arris/io.h"
#include "arris/output_files.h"
#include "arris/values.h"
#include "image/compare.h"
#include "image/srgb.h"
#include "io/picture_file.h"

namespace arris::program {
namespace {

// As a screen shows it, in linear values.
Image shown(const Image& image) {
  Image out = image;
  for (std::size_t i = 0; i + 2 < out.values.size(); i += 3) {
    const Rgb color = tone_map({image.values[i], image.values[i + 1], image.values[i + 2]}, 0);
    for (std::size_t c = 0; c < 3; ++c) {
      out.values[i + c] = linear_from_srgb(float(quantize8(color[int(c)])) / 255);
    }
  }
  return out;
}

void print_difference(const ImageDifference& d) {
  fmt::print("RMSE        {:.9g}\n", d.rmse);
  fmt::print("max error   {:.9g} at pixel {}, {}\n", d.max_error, d.max_x, d.max_y);
  fmt::print("PSNR        {:.4g} dB (peak {:.6g})\n", d.psnr_db, d.peak);
  fmt::print("FLIP        {:.6f}\n", d.flip);
  if (d.nonfinite_pixels > 0) {
    fmt::print("not finite  {} pixels, left out of RMSE, max error and PSNR\n", d.nonfinite_pixels);
  }
}

void print_json(const ImageDifference& d) {
  nlohmann::ordered_json json;
  json["rmse"] = d.rmse;
  json["max_error"] = d.max_error;
  json["max_error_pixel"] = {d.max_x, d.max_y};
  json["psnr_db"] = std::isfinite(d.psnr_db) ? nlohmann::ordered_json(d.psnr_db) : nullptr;
  json["peak"] = d.peak;
  json["flip"] = d.flip;
  json["nonfinite_pixels"] = d.nonfinite_pixels;
  fmt::print("{}\n", json.dump());
}

void check_diff(const std::string& path, const std::string& a, const std::string& b) {
  picture_format(path);
  const NamedFile output{"--diff", path};
  const NamedFile inputs[] = {{"A", a}, {"B", b}};
  check_outputs({&output, 1}, inputs);
}

void save_diff(const std::string& path, const Image& a, const Image& b) {
  SaveOptions options;
  options.tone_map = false;
  save_picture({flip_colors(flip_map(a, b)), {}}, path, options);
}

}  // namespace

int run_compare(const Arguments& arguments) {
  const std::string& path_a = arguments.positionals[0];
  const std::string& path_b = arguments.positionals[1];
  const auto max_rmse = find_given(arguments, "--max-rmse");
  const double limit = max_rmse ? parse_real(*max_rmse, {0, 1e30}) : 0;
  const auto diff = arguments.find("--diff");
  if (diff) check_diff(*diff, path_a, path_b);
  const PictureFile file_a = load_picture_file(path_a), file_b = load_picture_file(path_b);
  const ValueEncoding encoding =
      file_a.encoding == file_b.encoding ? file_a.encoding : ValueEncoding::srgb;
  const auto image = [&](const PictureFile& file) {
    return file.encoding == encoding ? file.picture.color : shown(file.picture.color);
  };
  const Image a = image(file_a), b = image(file_b);
  const ImageDifference difference = compare_images(a, b, encoding);
  if (diff) save_diff(*diff, a, b);
  if (!arguments.has("--quiet")) {
    arguments.has("--json") ? print_json(difference) : print_difference(difference);
  }
  const bool passes = difference.rmse <= limit && difference.nonfinite_pixels == 0;
  return max_rmse && !passes ? 1 : 0;
}

}  // namespace arris::program
