// flight.h — what frames of a camera flight cost, and how good they are
// What       measure_frames(): medians of the stages, as in the paper's Table 2, its numbers of edges and classes of
//            Table 3, memory, and the time that tracing every pixel with the same shader takes. measure_quality():
//            errors of the same frames with edges, without them, and of a picture of full size that costs as much
//            shading but is not interpolated.
// How        Errors are against two independent references of few paths: the mean of (p − a)(p − b) has no part of
//            their noise in it, where that of (p − a)² has, so that it is the error against a converged picture.
// Source     Bala, Walter, Greenberg (2003), §7
#pragma once

#include <cstdint>

#include "edge_point/scenes.h"

namespace arris::bench {

struct FlightOptions {
  int width_px = 512, height_px = 512;
  int frames = 60;
  double density = 0.02;
};

struct FrameCosts {
  std::uint64_t triangles = 0;
  double prepare_ms = 0, engine_ms = 0;  // building scene and trees
  EdgePointStats median;                 // of frames of the flight, but for the first
  double longest_ms = 0;                 // of them
  double shading_ms = 0;                 // of a frame's new points, median
  double full_ms = 0;                    // of shading every pixel, from every 64th
};
FrameCosts measure_frames(const FlightScene& flight, const FlightOptions& options);

struct FlightErrors {
  double with_edges = 0, without_edges = 0, noisy = 0;  // RMSE of tone mapped values
  double flip_with = 0, flip_without = 0, flip_noisy = 0;
};
struct QualityOptions {
  FlightOptions flight;
  int pictures = 3;                    // of the flight that are judged
  std::uint32_t reference_paths = 64;  // of each pixel, of each of a picture's two references
  int point_paths = 256;               // of measure_ablation()
};
FlightErrors measure_quality(const FlightScene& flight, const QualityOptions& options);

// From the same samples of a fifth of the pixels, in a view that stands still (§7.3, Fig. 11).
FlightErrors measure_ablation(const FlightScene& flight, const QualityOptions& options);

}  // namespace arris::bench
