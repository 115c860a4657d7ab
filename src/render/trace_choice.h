// trace_choice.h — whether the next frame is made from edges and points, or by tracing every pixel
// What       estimates what a frame would take in which every pixel has a point's paths, from what shading has cost
//            so far, and holds it against a limit. Once frames are traced they stay so until it is clearly above.
// Guarantee  by rays: depends on the calls alone, at any number of threads and on any machine
// Limits     by rays, a ray costs what it would on two cores of 2023 in scenes of middling size; what edges and points
//            cost themselves is not looked at
#pragma once

#include <cstdint>

namespace arris {

// What shading has done, and how long threads were at it in sum.
struct ShadingCost {
  std::uint64_t items = 0, rays = 0;
  double thread_seconds = 0;
};

enum class CostMeasure { rays, seconds };

class TraceChoice {
 public:
  // below_ms: of a traced frame; 0: none is.
  TraceChoice(double below_ms, CostMeasure measure) : below_ms_(below_ms), measure_(measure) {}

  void add(const ShadingCost& more, int threads);
  // frame_ms: what frames of edges and points take; by seconds only.
  bool decide(double pixels, double frame_ms);
  // Milliseconds of a traced frame; 0: nothing is known.
  [[nodiscard]] double estimate_ms(double pixels) const { return item_ms_ * pixels; }

 private:
  double below_ms_;
  CostMeasure measure_;
  ShadingCost pending_;
  double item_ms_ = 0;
  bool traces_ = false;
};

}  // namespace arris
