// lit_regions.h — which lights reach what a region of many pixels shows, where lights are looked at one by one
// What       What one light reaches is asked of the whole region, then of its quarters where the answer is open, down
//            to pixels, so that pixels in the middle of light or shadow share one look.
// Cost       at most a third more looks than one for each pixel and light
#pragma once

#include <cstdint>
#include <vector>

#include "beam/beam_shadow.h"

namespace arris {

struct LitTree {
  Rect rect;             // for which it holds
  LookTree tree;         // with the signs and the bit of one light; see ShadowLooker::add_shadow
  bool complete = true;  // else a part of a pixel may tell more
};

class LitRegions {
 public:
  // Precondition: `tree` holds for the rectangle, of whole pixels. Looks are added to `regions`.
  void look(const ShadowLooker& shadows, const LookTree& tree, const Rect& rect, ShadowLists& lists,
            std::uint64_t& regions, const ShadowLooker::Unlit& unlit);
  // Precondition: the pixel is in the rectangle.
  [[nodiscard]] const LitTree& tree_of(std::uint32_t light, const Rect& pixel) const {
    return trees_[tree_of_pixel_[place_of(light, pixel.x0, pixel.y0)]];
  }

 private:
  [[nodiscard]] std::size_t place_of(std::uint32_t light, double x, double y) const {
    const auto side = std::size_t(rect_.width());
    return (light * side + std::size_t(y - rect_.y0)) * side + std::size_t(x - rect_.x0);
  }

  Rect rect_;
  std::vector<LitTree> trees_;
  std::vector<std::uint32_t> tree_of_pixel_;  // by light and pixel
};

}  // namespace arris
