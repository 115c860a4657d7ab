// hole_filler.h — colours for pixels that no sample reaches
// What       the mean colour of the nearest resolved pixels of the picture, found on ever coarser grids, so that what
//            comes into view is not black until its first sample
// Limits     knows no edges: it is a guess for a frame or two
// Cost       nothing without holes, else one pass over the picture
#pragma once

#include <cstdint>
#include <span>

#include "arris/image.h"

namespace arris {

// holes: offsets of pixels, each once.
void fill_holes(std::span<const std::uint32_t> holes, Image& picture);

}  // namespace arris
