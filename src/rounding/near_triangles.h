// near_triangles.h — what balls that touch a triangle may reach into
// What       linear bounds on how deep they do, from which bands are made (bands.h); and, for triangles that have few
//            others near, lists of these, so that whether a ball fits there needs no search of the tree
// In / Out   coordinates relative to the solid's centre
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "rounding/solid_surface.h"

namespace arris {

// A linear function of the places of a triangle, by its corners. Wherever the rounding has taken it away, and perhaps
// beside, at least one of its functions is positive.
struct DepthAtCorners {
  double d0, d1, d2;
};

struct NearTriangles {
  std::vector<DepthAtCorners> depths;
  // By their place in surface.triangles(): all into which a ball may reach. Nothing: they are too many for a list.
  std::optional<std::vector<std::uint32_t>> others;
};

// Of a triangle with its normal.
NearTriangles find_near_triangles(const SolidSurface& surface, const SurfaceTriangle& triangle,
                                  Vec3d normal, double radius);

class NearLists {
 public:
  struct List {
    std::uint32_t triangle = 0;  // of the caller's mesh
    std::vector<std::uint32_t> others;
  };

  NearLists() = default;
  explicit NearLists(std::span<const List> lists);  // sorted by triangle

  // Nothing: it has no list.
  [[nodiscard]] std::optional<std::span<const std::uint32_t>> of(std::uint32_t triangle) const;
  [[nodiscard]] std::size_t bytes() const {
    return (triangles_.size() + begins_.size() + others_.size()) * sizeof(std::uint32_t);
  }

 private:
  std::vector<std::uint32_t> triangles_, begins_, others_;
};

}  // namespace arris
