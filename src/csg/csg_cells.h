// csg_cells.h — a solid cut into cells in which few of its leaves matter
// What       the bounds are halved until the part of the tree that is undecided in a cell is small, or halving no
//            longer helps; cells that are wholly inside or outside hold no surface and are dropped. A ray meets the
//            boxes of the cells (some other structure finds them) and evaluates the few leaves of each.
// Guarantee  the cells' own boxes are disjoint, half-open, and hold every boundary in exactly one: nothing falls
//            between two, and nothing is met twice. What the cells find is what the whole tree finds, to the last bit
//            (tests/csg/cells_test.cpp). The same cells at any number of threads.
// Limits     where many leaves' surfaces meet in a point, halving ends with all of them in a cell
// Errors     Error{input} naming the tree if nothing bounds it
// Cost       building: about n log n leaf classifications, parallel. A difference of n separate holes makes as many
//            cells as a union of n tiles.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "csg/csg_solid.h"

namespace arris {

struct CsgCell {
  Box3d own;     // boundaries in low ≤ p < high are this cell's
  Box3d bounds;  // all boundaries that are this cell's lie in it, with a margin
  std::uint64_t truth = 0;
  std::uint32_t first_leaf = 0, leaf_count = 0;
  std::uint32_t first_step = 0, step_count = 0;
};

struct CellOptions {
  int threads = 0;         // 0: all
  std::uint32_t few = 2;   // cells with as many leaves are not halved
  std::uint32_t many = 8;  // up to here halving must pay at once; beyond, after a few times
  // Halvings beyond those that part n leaves: along curves where surfaces meet, halving pays for ever, and the
  // cells double.
  std::uint32_t more_depth = 14;
  const std::atomic<bool>* stop = nullptr;  // set: Error{failed}
};

class CsgCells {
 public:
  CsgCells(std::shared_ptr<const CsgSolid> solid, const std::string& name,
           const CellOptions& options = {});

  [[nodiscard]] const CsgSolid& solid() const { return *solid_; }
  [[nodiscard]] const std::vector<CsgCell>& cells() const { return cells_; }
  [[nodiscard]] CsgExpressionView expression_of(const CsgCell& cell) const {
    return {{leaves_.data() + cell.first_leaf, cell.leaf_count},
            {steps_.data() + cell.first_step, cell.step_count},
            cell.truth};
  }
  [[nodiscard]] std::uint64_t bytes() const;

  // Calls visit(boundary) for the cell's own boundaries in (t_min, t_max), ascending, until it returns true.
  template <class Visit>
  void visit_boundaries(std::uint32_t cell, const Ray& ray, double t_min, double t_max,
                        BoundarySearch& search, const Visit& visit) const;

 private:
  std::shared_ptr<const CsgSolid> solid_;
  std::vector<CsgCell> cells_;
  std::vector<std::uint32_t> leaves_;
  std::vector<CsgStep> steps_;
};

// Where the line is between the planes of the box: misses are certain but for the box's margin.
inline bool line_meets_box(const Box3d& box, const Ray& ray, double t_min, double t_max) {
  double t0 = t_min, t1 = t_max;
  for (int k = 0; k < 3; ++k) {
    const double o = ray.origin[k], d = ray.direction[k];
    if (d == 0) {
      if (o < box.low[k] || o > box.high[k]) return false;
      continue;
    }
    const double inverse = 1 / d;
    const double a = (box.low[k] - o) * inverse, b = (box.high[k] - o) * inverse;
    t0 = std::max(t0, std::min(a, b));
    t1 = std::min(t1, std::max(a, b));
  }
  return t0 <= t1;
}

template <class Visit>
void CsgCells::visit_boundaries(std::uint32_t cell, const Ray& ray, double t_min, double t_max,
                                BoundarySearch& search, const Visit& visit) const {
  const CsgCell& c = cells_[cell];
  if (!line_meets_box(c.bounds, ray, t_min, t_max)) return;
  for (const CsgBoundary& boundary : search.find(*solid_, expression_of(c), ray)) {
    if (!(boundary.t > t_min && boundary.t < t_max)) continue;
    const Vec3d p = ray.origin + ray.direction * boundary.t;
    const bool own = p.x >= c.own.low.x && p.x < c.own.high.x && p.y >= c.own.low.y &&
                     p.y < c.own.high.y && p.z >= c.own.low.z && p.z < c.own.high.z;
    if (own && visit(boundary)) return;
  }
}

}  // namespace arris
