// film.h — sums of samples per pixel, and the picture they make
// What       the colour and the first-hit layers (AOVs) of a render under way
// Guarantee  sums are double and grow sample by sample, so a picture depends on the samples it holds, not
//            on how they were grouped in passes, tiles or threads
// Cost       24 bytes a pixel for the colour and at most as many for each layer; different pixels may be
//            written by different threads. A copy is what a film held at that time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "arris/image.h"
#include "arris/math.h"

namespace arris {

// What one sample saw first: through surfaces that let it straight through, but not by reflection.
struct FirstHit {
  bool hit = false;
  bool rounded = false;  // on a rounded edge or corner
  Rgb albedo;
  Vec3f normal;              // shading normal, towards the camera; 0 without a hit
  float depth = 0;           // distance from the camera
  std::uint32_t object = 0;  // the object's index plus 1; 0: none
};

// The AOVs a film can hold: their names, in the order of Film's layers.
std::vector<std::string> film_layer_names();

class Film {
 public:
  // Throws Error for a layer name it does not know.
  Film(int width_px, int height_px, const std::vector<std::string>& layers);

  [[nodiscard]] bool has_layers() const { return has_layers_; }

  // The sum so far, to be added to sample by sample.
  [[nodiscard]] Vec3d& color_sum(std::size_t pixel) { return color_[pixel]; }
  // Call for a pixel's samples in order: "object" is what the first one saw.
  void add_layers(std::size_t pixel, const FirstHit& first);

  // Means over `samples` samples; "normal" and "albedo" count a miss as 0. "depth" is that of the nearest
  // surface seen, 0 where there is none: so parts of a render can be joined (image/picture_sum.h).
  [[nodiscard]] Picture picture(std::uint32_t samples,
                                const std::vector<std::string>& layers) const;

 private:
  [[nodiscard]] Image layer(const std::string& name, double scale) const;

  int width_px_, height_px_;
  bool has_layers_;
  std::vector<Vec3d> color_;
  std::vector<Vec3d> albedo_, normal_;  // empty unless asked for
  std::vector<double> rounded_;
  std::vector<float> depth_;  // 0: nothing hit
  std::vector<std::uint32_t> object_;
  std::vector<std::uint8_t> object_known_;
};

}  // namespace arris
