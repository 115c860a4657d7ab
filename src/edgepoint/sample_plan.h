// sample_plan.h — which pixels to shade next
// What       picks about a given number of pixels, each with a chance in proportion to the square of how much it
//            wants a sample, so that where nothing is known there is something after two frames or three; spread
//            evenly: the chances are held against a dither pattern that moves from frame to frame
// Guarantee  the same plan at any number of threads; in the order of tiles, so that what arrives together lies
//            together
// Source     Bala, Walter, Greenberg (2003), §5.3 "Prioritized sampling"; the pattern: J. Jimenez, "Next Generation
//            Post Processing in Call of Duty" (2014), interleaved gradient noise
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace arris {

struct SamplePlanSettings {
  int width_px = 0, height_px = 0;
  std::size_t count = 0;  // about so many
  std::uint32_t frame = 0;
  int threads = 0;  // 0: all
};

// About how many samples would leave nothing much wanted: pixels, counted the more the more they want one, from a
// quarter of what wants one most on. threads: 0 for all.
std::size_t count_urgent(std::span<const std::uint8_t> wanted, int threads = 0);

// Offsets of pixels.
std::vector<std::uint32_t> plan_samples(std::span<const std::uint8_t> wanted,
                                        const SamplePlanSettings& settings);

}  // namespace arris
