// narrow_cells.h — remembers beside which cells of space there are no thin walls
// What       is_between_walls() searches all that is within two radii; nearly everywhere the answer is no, for all
//            places near. Cells that have walls near say no more than that.
// Threads    may be used by several; what is answered does not depend on their order
// Cost       8 bytes to a cell, up to 4 MB for each solid, made when the first is asked; not among its bytes()
#pragma once

#include "arris/math.h"
#include "rounding/answer_table.h"
#include "rounding/solid_surface.h"

namespace arris {

class NarrowCells {
 public:
  // Nothing can be asked.
  NarrowCells() = default;
  // area: of all faces.
  NarrowCells(double radius, double area);

  // Whether is_between_walls() may hold of a ball.
  [[nodiscard]] bool may_be_between_walls(const SolidSurface& surface, Vec3d center,
                                          double radius) const;

 private:
  double radius_ = 0;
  AnswerTable table_;
};

}  // namespace arris
