#include "beam/lit_regions.h"

#include <utility>

namespace arris {

void LitRegions::look(const ShadowLooker& shadows, const LookTree& tree, const Rect& rect,
                      ShadowLists& lists, std::uint64_t& regions,
                      const ShadowLooker::Unlit& unlit) {
  rect_ = rect;
  trees_.clear();
  const auto side = std::size_t(rect.width());
  tree_of_pixel_.assign(shadows.light_count() * side * side, 0);
  std::vector<Rect> open;
  for (std::uint32_t light = 0; light < shadows.light_count(); ++light) {
    open.push_back(rect);
    while (!open.empty()) {
      const Rect part = open.back();
      open.pop_back();
      LitTree lit{part, tree, true};
      lit.complete = shadows.add_shadow(lit.tree, part, light, lists, regions, unlit);
      if (!lit.complete && part.width() > 1) {
        for (const Rect& quarter : quarters_of(part)) open.push_back(quarter);
        continue;
      }
      for (double y = part.y0; y < part.y1; ++y) {
        for (double x = part.x0; x < part.x1; ++x) {
          tree_of_pixel_[place_of(light, x, y)] = std::uint32_t(trees_.size());
        }
      }
      trees_.push_back(std::move(lit));
    }
  }
}

}  // namespace arris
