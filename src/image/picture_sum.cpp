#include "image/picture_sum.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "arris/error.h"

namespace arris {
namespace {

enum class Join { mean, nearest, first };

Join join_of(const std::string& layer) {
  if (layer == "depth") return Join::nearest;
  if (layer == "object") return Join::first;
  return Join::mean;
}

// A double is the exact sum of three floats (53 bits in 3 x 24).
constexpr std::array<const char*, 3> kParts{"high", "middle", "low"};
constexpr const char* kPrefix = "sum";

std::string part_name(const std::string& layer, const char* part) {
  return fmt::format("{}.{}.{}", kPrefix, layer.empty() ? "color" : layer, part);
}

void check_match(const PictureSum& sum, const Picture& picture) {
  const auto fail = [](const std::string& what) { throw Error(Error::Kind::input, "", what); };
  const Image& color = picture.color;
  if (color.width_px != sum.width_px || color.height_px != sum.height_px) {
    fail(fmt::format("is {} x {} pixels large, the part before {} x {}", color.width_px,
                     color.height_px, sum.width_px, sum.height_px));
  }
  if (picture.layers.size() + 1 != sum.images.size()) {
    fail(fmt::format("has {} layers, the part before {}", picture.layers.size(),
                     sum.images.size() - 1));
  }
}

const Image& image_of(const Picture& picture, const ImageSum& sum) {
  if (sum.name.empty()) return picture.color;
  for (const Layer& layer : picture.layers) {
    if (layer.name == sum.name && layer.image.channels == sum.channels) return layer.image;
  }
  throw Error(Error::Kind::input, "",
              fmt::format("lacks the layer \"{}\" of the part before", sum.name));
}

void add_image(ImageSum& sum, const Image& mean, double samples, bool is_first) {
  const Join join = join_of(sum.name);
  for (std::size_t i = 0; i < sum.values.size(); ++i) {
    const double value = double(mean.values[i]);
    double& total = sum.values[i];
    if (join == Join::mean) {
      total += value * samples;
    } else if (is_first) {
      total = value;
    } else if (join == Join::nearest && value > 0) {  // 0: nothing was hit
      total = total > 0 ? std::min(total, value) : value;
    }
  }
}

}  // namespace

void add_picture(PictureSum& sum, const Picture& mean, std::uint64_t samples) {
  const bool is_first = sum.images.empty();
  if (is_first) {
    sum.width_px = mean.color.width_px;
    sum.height_px = mean.color.height_px;
    const auto make = [&](const std::string& name, const Image& image) {
      sum.images.push_back({name, image.channels, std::vector<double>(image.values.size())});
    };
    make("", mean.color);
    for (const Layer& layer : mean.layers) make(layer.name, layer.image);
  }
  check_match(sum, mean);
  for (ImageSum& image : sum.images) {
    add_image(image, image_of(mean, image), double(samples), is_first);
  }
  sum.samples += samples;
}

Picture mean_picture(const PictureSum& sum) {
  Picture picture;
  for (const ImageSum& in : sum.images) {
    Image image(sum.width_px, sum.height_px, in.channels);
    const double divisor = join_of(in.name) == Join::mean ? double(sum.samples) : 1;
    for (std::size_t i = 0; i < in.values.size(); ++i) {
      image.values[i] = float(in.values[i] / divisor);
    }
    if (in.name.empty()) {
      picture.color = std::move(image);
    } else {
      picture.layers.push_back({in.name, std::move(image)});
    }
  }
  return picture;
}

Picture pack_sum(const PictureSum& sum) {
  Picture packed = mean_picture(sum);
  for (const ImageSum& in : sum.images) {
    std::vector<double> rest = in.values;
    for (const char* part : kParts) {
      Image image(sum.width_px, sum.height_px, in.channels);
      for (std::size_t i = 0; i < rest.size(); ++i) {
        image.values[i] = float(rest[i]);
        rest[i] -= double(image.values[i]);
      }
      packed.layers.push_back({part_name(in.name, part), std::move(image)});
    }
  }
  return packed;
}

PictureSum unpack_sum(const Picture& packed, std::uint64_t samples) {
  PictureSum sum{packed.color.width_px, packed.color.height_px, samples, {}};
  const auto find = [&](const std::string& name) -> const Image* {
    for (const Layer& layer : packed.layers) {
      if (layer.name == name) return &layer.image;
    }
    return nullptr;
  };
  const auto unpack = [&](const std::string& name) {
    ImageSum image{name, 0, {}};
    for (const char* part : kParts) {
      const Image* in = find(part_name(name, part));
      if (in == nullptr) {
        throw Error(Error::Kind::input, "",
                    fmt::format("lacks the layer \"{}\"", part_name(name, part)));
      }
      image.channels = in->channels;
      image.values.resize(in->values.size());
      for (std::size_t i = 0; i < in->values.size(); ++i) image.values[i] += double(in->values[i]);
    }
    sum.images.push_back(std::move(image));
  };
  unpack("");
  for (const Layer& layer : packed.layers) {
    if (!layer.name.starts_with(fmt::format("{}.", kPrefix))) unpack(layer.name);
  }
  return sum;
}

}  // namespace arris
