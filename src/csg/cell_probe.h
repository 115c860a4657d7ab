// cell_probe.h — is a point in a solid? Asked of the cell that it lies in
// What       contains() evaluates the few leaves of a cell; find_cell() names the cell that holds a point, if any does:
//            elsewhere the solid has no surface
// Guarantee  const: safe from any number of threads
// Cost       a few leaves' planes and quadrics
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "csg/csg_cells.h"
#include "csg/place_tree.h"

namespace arris {

struct CsgSurfacePoint {
  double t = 0;
  Vec3d position;
  std::uint32_t leaf = 0, face = 0;  // CsgBoundary's
};

class CellProbe {
 public:
  explicit CellProbe(std::shared_ptr<const CsgCells> cells);

  [[nodiscard]] const CsgCells& cells() const { return *cells_; }
  [[nodiscard]] const CsgSolid& solid() const { return cells_->solid(); }
  [[nodiscard]] const PlaceTree& tree() const { return tree_; }
  // Precondition: near the cell.
  [[nodiscard]] bool contains(std::uint32_t cell, Vec3d p) const;
  // `guess`: looked at first.
  [[nodiscard]] std::optional<std::uint32_t> find_cell(
      Vec3d p, std::optional<std::uint32_t> guess = std::nullopt) const;
  // Whether the ray enters or leaves the solid between.
  [[nodiscard]] bool meets(const Ray& ray, double t_min, double t_max) const;
  // Where the ray first enters the solid beyond t_min.
  [[nodiscard]] std::optional<CsgSurfacePoint> first_met(const Ray& ray, double t_min) const;
  // How far from a surface points are asked about, to tell its two sides: far above the rounding of coordinates and
  // the deviation of merged surfaces, far below what is to be seen.
  [[nodiscard]] double reach() const { return reach_; }
  // Of the solid's bounds.
  [[nodiscard]] double size() const { return size_; }

 private:
  std::shared_ptr<const CsgCells> cells_;
  PlaceTree tree_;
  double reach_ = 0, size_ = 0;
};

}  // namespace arris
