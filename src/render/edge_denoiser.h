// edge_denoiser.h — a noisy picture, filtered up to its edges
// What       Edges are found as for moving views, and so is which pixels they part. Light, which is what is left when
//            surfaces' albedos are divided out, is averaged within reach; then pixels are put together again from
//            their regions, by area, and the picture's filter is applied last.
// In         a picture whose pixels are squares (ImageSettings::Filter::box), with layer "squares"
// Guarantee  the same picture at any number of threads; tends to the path traced one as its noise falls
// Limits     reflections, refractions, caustics and shadows of area lights have no edges: they are kept where they
//            stand out of the noise. Pixels with several edges, and such with a region of which nothing is known, are
//            averaged with those within three pixels alone that are crossed likewise. Of more than a million shadow
//            events the rest is left out: shadows blur there.
// Source     reachability of Bala, Walter, Greenberg (2003), §5.2, as the stop that others approximate by depth and
//            normals: Schied et al., "Spatiotemporal Variance-Guided Filtering", HPG 2017
#pragma once

#include <cstdint>

#include "arris/image.h"
#include "render/prepared_scene.h"

namespace arris {

struct DenoiseSettings {
  std::uint64_t samples = 1;  // of each pixel
  ImageSettings::Filter filter = ImageSettings::Filter::box;
  std::uint32_t seed = 0;
  int threads = 0;
};

// squares: the means of the film's layer of that name.
Image denoise_within_edges(const PreparedScene& scene, const Image& noisy, const Image& squares,
                           const DenoiseSettings& settings);

}  // namespace arris
