// texture_levels.h — textures at lower resolutions, so that few lookups average over many texels
// What       each level has half the width and height of the one before, down to one texel; a texel is the mean of
//            those below it by area, in linear light
// Cost       a third of the texels again
// Source     L. Williams, "Pyramidal Parametrics", SIGGRAPH 1983
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "arris/scene.h"

namespace arris {

class TextureLevels {
 public:
  TextureLevels() = default;
  // Of the textures that `wanted` names, by their place among all.
  TextureLevels(std::span<const Texture> textures, const std::vector<bool>& wanted, int threads);

  // The one whose texels are nearest to `texels` of the finest, and not larger; of a texture that was not wanted
  // itself.
  [[nodiscard]] const Texture& find(std::span<const Texture> textures, TextureId id,
                                    float texels) const;

 private:
  std::vector<std::vector<Texture>> coarser_;  // by texture, from the second level on
};

// Half as wide and high, rounded down, but at least one texel.
Texture halve_texture(const Texture& texture, int threads);

}  // namespace arris
