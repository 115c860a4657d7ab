#include "arris/io.h"
#include "image/display_curve.h"
#include "image/srgb.h"

namespace arris {

Rgb tone_map(Rgb linear, double exposure) {
  const Rgb shown = eval_display_curve(linear, exposure_scale(exposure));
  return {srgb_from_linear(shown.x), srgb_from_linear(shown.y), srgb_from_linear(shown.z)};
}

}  // namespace arris
