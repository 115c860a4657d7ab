// motion.h — how evenly frames come while camera, an object and a light move and shading goes on beside them
// What       The camera flies, one object and one light go around, all of them in every frame, as a program would have
//            it: a frame, a pause in which there is shading, the next frame. Times are those that the caller of
//            next_frame() sees.
#pragma once

#include "edge_point/flight.h"

namespace arris::bench {

struct MotionOptions {
  FlightOptions flight;
  double pause_ms = 10;  // between frames
};

struct MotionTimes {
  double median_ms = 0, most_of_100_ms = 0, longest_ms = 0;  // of frames; the 99th percentile
  double edges_ms = 0, longest_edges_ms = 0;  // of them for edges, median and longest
  double delay_ms = 0;  // from a change to the end of the first frame that shows it, median
  double new_points = 0, shadow_edges = 0;  // of a frame, medians
  int longest_at = 0;                       // the frame's number
};
MotionTimes measure_motion(const FlightScene& flight, const MotionOptions& options);

}  // namespace arris::bench
