// fresh_samples.h — which samples show what is so
// What       Of samples within reach those that are stale count only where no other is: what has changed is seen in the
//            first new sample, though many old ones lie around it.
// Source     ours; Bala, Walter, Greenberg (2003) replace old points by their age alone
#pragma once

#include "edgepoint/edge_point_image.h"
#include "edgepoint/pixel_view.h"
#include "edgepoint/point_cache.h"

namespace arris {

// Sets a band's rows of EdgePointImage::fresh.
void find_fresh_samples(const PointCache& cache, RowBand band, EdgePointImage& image);

}  // namespace arris
