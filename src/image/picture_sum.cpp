#include "image/picture_sum.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "arris/error.h"

namespace arris {
namespace {

// A sum has 121 bits with its sign; the first float takes 24 of them and the others, being signed, 25 each.
constexpr int kParts = 5;
constexpr const char* kPrefix = "sum.";
constexpr double kLargestPart = 0x1p57;

std::string part_name(const std::string& layer, int part) {
  return fmt::format("{}{}.{}", kPrefix, layer.empty() ? "color" : layer, part);
}

bool is_part(const Layer& layer) {
  return layer.name.starts_with(kPrefix);
}

[[noreturn]] void fail(const std::string& what) {
  throw Error(Error::Kind::input, "", what);
}

const Layer* find_layer(const Picture& picture, const std::string& name) {
  const auto found =
      std::ranges::find_if(picture.layers, [&](const Layer& layer) { return layer.name == name; });
  return found == picture.layers.end() ? nullptr : &*found;
}

void check_match(const PictureSum& sum, const PictureSum& other) {
  if (other.width_px != sum.width_px || other.height_px != sum.height_px) {
    fail(fmt::format("is {} x {} pixels large, the part before {} x {}", other.width_px,
                     other.height_px, sum.width_px, sum.height_px));
  }
  if (other.images.size() != sum.images.size()) {
    fail(fmt::format(
        "has {} layers, the part before {}; join parts that were rendered with the same --aov",
        other.images.size() - 1, sum.images.size() - 1));
  }
}

const ImageSum& find_image(const PictureSum& sum, const ImageSum& like) {
  for (const ImageSum& image : sum.images) {
    if (image.name == like.name && image.channels == like.channels) return image;
  }
  fail(fmt::format("lacks the layer \"{}\" of the part before", like.name));
}

void add_image(ImageSum& sum, const ImageSum& other) {
  for (std::size_t i = 0; i < sum.sums.size(); ++i) sum.sums[i].add(other.sums[i]);
  if (sum.join != Join::nearest) return;
  for (std::size_t i = 0; i < sum.values.size(); ++i) {
    float& nearest = sum.values[i];
    const float value = other.values[i];
    if (value > 0) nearest = nearest > 0 ? std::min(nearest, value) : value;
  }
}

Image mean_image(const PictureSum& sum, const ImageSum& in) {
  Image image(sum.width_px, sum.height_px, in.channels);
  const double samples = std::max<double>(1, double(sum.samples));
  for (std::size_t i = 0; i < in.sums.size(); ++i) {
    image.values[i] = float(in.sums[i].value() / samples);
  }
  if (in.join != Join::sum) image.values = in.values;
  return image;
}

ImageSum sum_of_image(const std::string& name, const Image& mean, double samples) {
  ImageSum sum =
      make_image_sum(name, mean.channels, std::size_t(mean.width_px) * std::size_t(mean.height_px));
  for (std::size_t i = 0; i < sum.sums.size(); ++i) {
    const double total = double(mean.values[i]) * samples;
    if (!(std::abs(total) < kLargestPart)) fail("holds values that are no numbers, or too large");
    sum.sums[i] = ExactSum::from_units(ExactSum::Units(total / ExactSum::kUnit));
  }
  if (sum.join != Join::sum) sum.values = mean.values;
  return sum;
}

void unpack_image(const Picture& packed, ImageSum& sum) {
  std::vector<ExactSum> sums(sum.sums.size());
  for (int part = 0; part < kParts; ++part) {
    const Layer* layer = find_layer(packed, part_name(sum.name, part));
    if (layer == nullptr || layer->image.values.size() != sums.size()) {
      fail(fmt::format("lacks the layer \"{}\"", part_name(sum.name, part)));
    }
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const auto value = double(layer->image.values[i]);
      if (!(std::abs(value) < kLargestPart)) {
        fail(fmt::format("holds sums in the layer \"{}\" that no render makes", layer->name));
      }
      sums[i].add(ExactSum::from_units(ExactSum::Units(value / ExactSum::kUnit)));
    }
  }
  sum.sums = std::move(sums);
}

}  // namespace

ImageSum make_image_sum(const std::string& name, int channels, std::size_t pixels) {
  ImageSum sum{name, channels, Join::sum, {}, {}};
  if (name == "depth") sum.join = Join::nearest;
  if (name == "object") sum.join = Join::first;
  const std::size_t values = pixels * std::size_t(channels);
  if (sum.join == Join::sum) {
    sum.sums.resize(values);
  } else {
    sum.values.resize(values);
  }
  return sum;
}

void add_sum(PictureSum& sum, const PictureSum& other) {
  if (sum.images.empty()) {
    sum = other;
    return;
  }
  check_match(sum, other);
  for (ImageSum& image : sum.images) add_image(image, find_image(other, image));
  sum.samples += other.samples;
}

Picture mean_picture(const PictureSum& sum) {
  Picture picture;
  for (const ImageSum& in : sum.images) {
    Image image = mean_image(sum, in);
    if (in.name.empty()) {
      picture.color = std::move(image);
    } else {
      picture.layers.push_back({in.name, std::move(image)});
    }
  }
  return picture;
}

PictureSum sum_of_mean(const Picture& mean, std::uint64_t samples) {
  PictureSum sum{mean.color.width_px, mean.color.height_px, samples, {}};
  sum.images.push_back(sum_of_image("", mean.color, double(samples)));
  for (const Layer& layer : mean.layers) {
    if (!is_part(layer))
      sum.images.push_back(sum_of_image(layer.name, layer.image, double(samples)));
  }
  return sum;
}

Picture pack_sum(const PictureSum& sum) {
  Picture packed = mean_picture(sum);
  for (const ImageSum& in : sum.images) {
    if (in.join != Join::sum) continue;
    std::vector<ExactSum> rest = in.sums;
    for (int part = 0; part < kParts; ++part) {
      Image image(sum.width_px, sum.height_px, in.channels);
      for (std::size_t i = 0; i < rest.size(); ++i) {
        const auto units = float(rest[i].units());
        image.values[i] = units * float(ExactSum::kUnit);
        rest[i].add(ExactSum::from_units(-ExactSum::Units(units)));
      }
      packed.layers.push_back({part_name(in.name, part), std::move(image)});
    }
  }
  return packed;
}

bool holds_sum(const Picture& picture) {
  return std::ranges::any_of(picture.layers, is_part);
}

PictureSum unpack_sum(const Picture& packed, std::uint64_t samples) {
  PictureSum sum = sum_of_mean(packed, samples);
  for (ImageSum& image : sum.images) {
    if (image.join == Join::sum) unpack_image(packed, image);
  }
  return sum;
}

}  // namespace arris
