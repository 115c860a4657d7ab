#include "render/film.h"

#include <algorithm>

#include "arris/error.h"

namespace arris {
namespace {

Image make_image(int width_px, int height_px, const std::vector<Vec3d>& sums, double scale) {
  Image image(width_px, height_px, 3);
  for (std::size_t i = 0; i < sums.size(); ++i) {
    for (int channel = 0; channel < 3; ++channel) {
      image.values[3 * i + std::size_t(channel)] = float(sums[i][channel] * scale);
    }
  }
  return image;
}

template <class Value>
Image make_gray_image(int width_px, int height_px, std::size_t count, const Value& value) {
  Image image(width_px, height_px, 1);
  for (std::size_t i = 0; i < count; ++i) {
    image.values[i] = float(value(i));
  }
  return image;
}

}  // namespace

std::vector<std::string> film_layer_names() {
  return {"albedo", "normal", "depth", "object", "rounded"};
}

Film::Film(int width_px, int height_px, const std::vector<std::string>& layers)
    : width_px_(width_px), height_px_(height_px), has_layers_(!layers.empty()) {
  const std::vector<std::string> known = film_layer_names();
  for (const std::string& name : layers) {
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      throw Error(Error::Kind::input, "aov \"" + name + "\"",
                  "not one of albedo, normal, depth, object, rounded");
    }
  }
  const auto size_of = [&](const char* name) {
    const bool wanted = std::find(layers.begin(), layers.end(), name) != layers.end();
    return wanted ? std::size_t(width_px) * std::size_t(height_px) : 0;
  };
  color_.resize(std::size_t(width_px) * std::size_t(height_px));
  albedo_.resize(size_of("albedo"));
  normal_.resize(size_of("normal"));
  depth_.resize(size_of("depth"));
  rounded_.resize(size_of("rounded"));
  object_.resize(size_of("object"));
  object_known_.resize(object_.size());
}

void Film::add_layers(std::size_t pixel, const FirstHit& first) {
  if (!albedo_.empty()) {
    albedo_[pixel] += Vec3d(first.albedo);
  }
  if (!normal_.empty()) {
    normal_[pixel] += Vec3d(first.normal);
  }
  if (!depth_.empty() && first.hit) {
    const float nearest = depth_[pixel];
    depth_[pixel] = nearest > 0 ? std::min(nearest, first.depth) : first.depth;
  }
  if (!rounded_.empty()) {
    rounded_[pixel] += first.rounded ? 1 : 0;
  }
  if (!object_.empty() && object_known_[pixel] == 0) {
    object_known_[pixel] = 1;
    object_[pixel] = first.object;
  }
}

Image Film::layer(const std::string& name, double scale) const {
  if (name == "albedo") {
    return make_image(width_px_, height_px_, albedo_, scale);
  }
  if (name == "normal") {
    return make_image(width_px_, height_px_, normal_, scale);
  }
  if (name == "depth") {
    return make_gray_image(width_px_, height_px_, depth_.size(),
                           [&](std::size_t i) { return depth_[i]; });
  }
  if (name == "object") {
    return make_gray_image(width_px_, height_px_, object_.size(),
                           [&](std::size_t i) { return object_[i]; });
  }
  return make_gray_image(width_px_, height_px_, rounded_.size(),
                         [&](std::size_t i) { return rounded_[i] * scale; });
}

Picture Film::picture(std::uint32_t samples, const std::vector<std::string>& layers) const {
  const double scale = samples > 0 ? 1.0 / samples : 0.0;
  Picture picture;
  picture.color = make_image(width_px_, height_px_, color_, scale);
  for (const std::string& name : layers) {
    picture.layers.push_back({name, layer(name, scale)});
  }
  return picture;
}

}  // namespace arris
