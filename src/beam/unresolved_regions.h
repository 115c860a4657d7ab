// unresolved_regions.h — what a pixel shows where looks leave it unknown
// What       All that may be seen in such a region is listed, open between nothing and what it may fill; a ray says
//            what to take for the region. What was found shows: more rays are then aimed at the leaves that no ray has
//            met (aimed_points.h), and those they meet take a part of what the region's own ray stood for.
// Guarantee  bounds are those of the looks: rays change estimates only
// Cost       a ray for each region, and a few dozen at most for the pixel. For one thread
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "beam/beam_view.h"
#include "beam/pixel_surfaces.h"
#include "beam/region_look.h"

namespace arris {

class UnresolvedRegions {
 public:
  // All must outlive it. What is found is added to `surfaces`.
  UnresolvedRegions(std::span<const BeamSolid> solids, const EyeRays& eye, const BeamView& view,
                    PixelSurfaces& surfaces)
      : solids_(solids), eye_(eye), view_(view), surfaces_(surfaces) {}

  // For the next pixel.
  void clear() { regions_.clear(); }
  // Precondition: the end is `unknown`. `parts` are what may be seen in the rectangle.
  void add(const LookTree& tree, const EndArea& end, const Rect& rect,
           const std::vector<BeamPart>& parts);
  // Once all of the pixel's regions are added; `parts` are what may be seen in it.
  void add_forced_samples(const std::vector<BeamPart>& parts);

  // That were followed since it was made.
  [[nodiscard]] std::uint64_t ray_count() const { return ray_count_; }

 private:
  using LeafName = std::pair<std::uint32_t, std::uint32_t>;  // solid, leaf
  struct Region {
    Rect rect;
    std::optional<SeenSurface> seen;  // by the ray that stands in
    double left = 0;                  // of what that stands for
    std::vector<LeafName> leaves;     // that are put in order there, ascending; none: too many
  };
  struct Aim {
    std::size_t region = 0;  // of regions_
    Vec2d at;
  };

  void add_candidate(const SeenSurface& seen, const EndArea& end, const Rect& rect);
  void add_all_faces(const BeamPart& part, const EndArea& end, const Rect& rect);
  [[nodiscard]] std::vector<Aim> aims_at(const LeafPlace& place) const;
  [[nodiscard]] std::vector<Aim> aims_at_contacts(const LeafPlace& place, int& left) const;
  std::optional<SeenSurface> force(const Aim& aim, const std::vector<BeamPart>& parts);
  std::optional<SeenSurface> seen_by_ray(const std::vector<BeamPart>& parts, Vec2d at);

  std::span<const BeamSolid> solids_;
  const EyeRays& eye_;
  const BeamView& view_;
  PixelSurfaces& surfaces_;
  std::vector<Region> regions_;
  std::uint64_t ray_count_ = 0;
};

}  // namespace arris
