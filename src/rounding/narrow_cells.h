// narrow_cells.h — remembers beside which cells of space there are no thin walls
// What       is_between_walls() searches all that is within two radii; nearly everywhere the answer is no, for all
//            places near. Cells that have walls near say no more than that.
// Threads    may be used by several; what is answered does not depend on their order
// Cost       that of an answer table, which is not among the solid's bytes()
#pragma once

#include "arris/math.h"
#include "rounding/answer_table.h"
#include "rounding/solid_surface.h"

namespace arris {

class NarrowCells {
 public:
  // Nothing can be asked.
  NarrowCells() = default;
  explicit NarrowCells(double radius) : radius_(radius) {}

  // Whether is_between_walls() may hold of a ball.
  [[nodiscard]] bool may_be_between_walls(const SolidSurface& surface, Vec3d center,
                                          double radius) const;

 private:
  double radius_ = 0;
  AnswerTable table_;
};

}  // namespace arris
