// corner_tracer.h — the paper's own rule: regions are uniform if their corner rays say so
// What       Regions are split in four until they are uniform or smallest. Uniform (§2.1): no primitive meets the beam;
//            or the four corner rays meet the same face of the same solid first, and without the operations the same
//            faces in the same order, and every primitive of the list. Colour (§2.4): a quarter for what each corner
//            ray sees, of each pixel in large regions, of the region in small ones.
//            Lights (§2.2): a uniform region is cut further until each light's pyramid is lit or shadowed
//            (corner_lights.h); in the smallest regions each corner has a shadow ray of its own.
// Guarantee  none: see docs/beam.md for where it fails. lo and hi are what the rule believes.
// Limits     the smallest regions that are ambiguous for the eye, and surfaces of leaves that are not convex, have no
//            light pyramids: lit_known is 0, and shadows are for rays
// Source     J.-M. Hasenfratz and D. Ghazanfarpour, "Rendering CSG scenes with general antialiasing", 1996
#pragma once

#include "beam/beam_tracer.h"
#include "beam/separation.h"

namespace arris {

class CornerTracer {
 public:
  // As BeamTracer.
  CornerTracer(std::span<const BeamSolid> solids, const EyeRays& eye, int width_px, int height_px,
               const BeamOptions& options = {}, std::span<const LightPlace> lights = {});

  [[nodiscard]] std::vector<BeamTile> make_tiles() const;
  BeamStats trace_tile(const BeamTile& tile,
                       const std::function<void(const BeamPixel&)>& sink) const;

 private:
  class Tracer;
  [[nodiscard]] Pyramid beam_of(const Rect& rect) const;

  std::span<const BeamSolid> solids_;
  EyeRays eye_;
  int width_px_, height_px_;
  BeamOptions options_;
  std::span<const LightPlace> lights_;
};

}  // namespace arris
