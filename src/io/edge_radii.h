// edge_radii.h — rounding radii of single edges, collected while a mesh is read
// What       radii that a file gives edges, and those of sides of faces between vertices that it gives a value
// Guarantee  take() names each pair of vertices once, in ascending order; what is said of an edge itself goes before
//            what its vertices have, a later radius before an earlier one
// Cost       n log n in the edges and sides added
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "arris/scene.h"

namespace arris {

class EdgeRadii {
 public:
  // Stands for none, as do all negative radii and NaN.
  static constexpr float kNone = -1;

  // None: the edge has no radius of its own, whatever its vertices have.
  void add_edge(std::uint32_t a, std::uint32_t b, float radius);
  // The smaller of both vertices' values; none if one of them is.
  void add_side(std::uint32_t a, std::uint32_t b, std::span<const float> vertex_radii);

  std::vector<EdgeRadius> take();

 private:
  std::vector<EdgeRadius> edges_, sides_;
};

}  // namespace arris
