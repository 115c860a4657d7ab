// beam_growth.h — how the time of a picture grows
// What       with 10² to 10⁵ primitives in a heap that fills the picture; with the picture's size, on the plate of
//            examples/beam; and for a plate with 400 holes as one difference against 400 tiles with a hole each. By
//            the beam renderer and the path tracer, in rounds in which each has its turn; ratios are medians of those
//            in one round, against 1,000 primitives, the middle size and tiles.
#pragma once

#include <string>

namespace arris::bench {

struct BeamGrowthSettings {
  std::string folder;  // of the plate's scene; empty: no growth with the picture's size
  int largest = 100'000;
  int width_px = 640;  // of pictures, 4:3
  int path_samples = 4;
  int rounds = 3;
  int threads = 0;
};

void run_beam_growth(const BeamGrowthSettings& settings);

}  // namespace arris::bench
