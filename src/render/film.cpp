#include "render/film.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "arris/error.h"

namespace arris {
namespace {

void add_to(ImageSum& image, std::size_t pixel, Vec3f value) {
  for (int channel = 0; channel < 3; ++channel) {
    image.sums[3 * pixel + std::size_t(channel)].add(value[channel]);
  }
}

int channels_of(const std::string& layer) {
  return layer == "albedo" || layer == "normal" || layer == kSquaresLayer ? 3 : 1;
}

}  // namespace

std::vector<std::string> film_layer_names() {
  return {"albedo", "normal", "depth", "object", "rounded", "bevel_fac"};
}

float exposure_scale(const ImageSettings& image) {
  return std::exp2(float(image.exposure));
}

Film::Film(const ImageSettings& image, const std::vector<std::string>& layers)
    : scale_(exposure_scale(image)) {
  const std::vector<std::string> known = film_layer_names();
  const std::size_t pixels = std::size_t(image.width_px) * std::size_t(image.height_px);
  sum_.width_px = image.width_px;
  sum_.height_px = image.height_px;
  sum_.images.push_back(make_image_sum("", 3, pixels));
  for (const std::string& name : layers) {
    if (name != kSquaresLayer && std::find(known.begin(), known.end(), name) == known.end()) {
      throw Error(Error::Kind::input, "aov \"" + name + "\"",
                  fmt::format("not one of {}", fmt::join(known, ", ")));
    }
    sum_.images.push_back(make_image_sum(name, channels_of(name), pixels));
  }
  const auto find = [&](const char* name) -> Layer {
    const auto found = std::ranges::find(sum_.images, name, &ImageSum::name);
    return found == sum_.images.end() ? Layer() : Layer(found - sum_.images.begin());
  };
  albedo_ = find("albedo");
  normal_ = find("normal");
  depth_ = find("depth");
  object_ = find("object");
  rounded_ = find("rounded");
  bevel_fac_ = find("bevel_fac");
  squares_ = find(kSquaresLayer);
  if (object_) object_known_.resize(pixels);
}

void Film::add(std::size_t pixel, Rgb radiance, const FirstHit& first) {
  add_to(sum_.images.front(), pixel, radiance);
  if (squares_) {
    const Rgb scaled = radiance * scale_;
    add_to(sum_.images[*squares_], pixel, scaled * scaled);
  }
  if (sum_.images.size() > 1) add_layers(pixel, first);
}

void Film::add_layers(std::size_t pixel, const FirstHit& first) {
  if (albedo_) add_to(sum_.images[*albedo_], pixel, first.albedo);
  if (normal_) add_to(sum_.images[*normal_], pixel, first.normal);
  if (depth_ && first.hit) {
    float& nearest = sum_.images[*depth_].values[pixel];
    nearest = nearest > 0 ? std::min(nearest, first.depth) : first.depth;
  }
  if (rounded_) sum_.images[*rounded_].sums[pixel].add(first.rounded ? 1.0F : 0.0F);
  if (bevel_fac_) sum_.images[*bevel_fac_].sums[pixel].add(first.bevel_fac);
  if (object_ && object_known_[pixel] == 0) {
    object_known_[pixel] = 1;
    sum_.images[*object_].values[pixel] = float(first.object);
  }
}

PictureSum Film::take_sum(std::uint32_t samples) {
  sum_.samples = samples;
  return std::move(sum_);
}

}  // namespace arris
