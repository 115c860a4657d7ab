// film.h — sums of samples per pixel, and the picture they make
// What       the colour and the first-hit layers (AOVs) of a render under way
// Guarantee  sums are exact, so a picture depends on the samples it holds, not on how they were grouped in passes,
//            tiles, threads or parts (image/picture_sum.h)
// Cost       48 bytes a pixel for the colour and at most as many for each layer; different pixels may be
//            written by different threads. A copy is what a film held at that time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "arris/math.h"
#include "arris/scene.h"
#include "image/picture_sum.h"

namespace arris {

// What one sample saw first: through surfaces that let it straight through, but not by reflection.
struct FirstHit {
  bool hit = false;
  bool rounded = false;  // on a rounded edge or corner
  float bevel_fac = 0;   // the bevel shader's Fac; 0 without that shader
  Rgb albedo;
  Vec3f normal;              // shading normal, towards the camera; 0 without a hit
  Vec3f geometric_normal;    // towards the camera; 0 without a hit
  float depth = 0;           // distance from the camera
  std::uint32_t object = 0;  // the object's index plus 1; 0: none
};

// The AOVs a film can hold: their names, in the order of Film's layers.
std::vector<std::string> film_layer_names();

// A layer besides: the squares of the samples' radiances times exposure_scale(), from which their variance follows.
// Exact sums hold no more than 2^32: what is far brighter than the picture's white is to have room in them.
inline constexpr const char* kSquaresLayer = "squares";
// What the picture's exposure multiplies radiances by.
float exposure_scale(const ImageSettings& image);

class Film {
 public:
  // Throws Error for a layer name it does not know.
  Film(const ImageSettings& image, const std::vector<std::string>& layers);

  // Call for a pixel's samples in order: "object" is what the first one saw.
  void add(std::size_t pixel, Rgb radiance, const FirstHit& first);

  // Of `samples` samples. "normal" and "albedo" count a miss as 0; "depth" is that of the nearest surface
  // seen, 0 where there is none. The film is empty afterwards.
  [[nodiscard]] PictureSum take_sum(std::uint32_t samples);

 private:
  void add_layers(std::size_t pixel, const FirstHit& first);

  using Layer = std::optional<std::size_t>;  // index of sum_.images, if asked for

  float scale_;     // of squares' radiances
  PictureSum sum_;  // the colour first
  Layer albedo_, normal_, depth_, object_, rounded_, bevel_fac_, squares_;
  std::vector<std::uint8_t> object_known_;
};

}  // namespace arris
