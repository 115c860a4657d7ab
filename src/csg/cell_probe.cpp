#include "csg/cell_probe.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace arris {
namespace {

// Of the solid's size and coordinates.
constexpr double kReach = 1e-5;

bool is_in(const Box3d& half_open, Vec3d p) {
  const Vec3d a = half_open.low, b = half_open.high;
  return p.x >= a.x && p.x < b.x && p.y >= a.y && p.y < b.y && p.z >= a.z && p.z < b.z;
}

}  // namespace

CellProbe::CellProbe(std::shared_ptr<const CsgCells> cells) : cells_(std::move(cells)) {
  std::vector<std::uint32_t> items;
  std::vector<Box3d> boxes;
  for (std::uint32_t i = 0; i < cells_->cells().size(); ++i) {
    items.push_back(i);
    boxes.push_back(cells_->cells()[i].bounds);
  }
  if (items.empty()) return;
  tree_ = PlaceTree(std::move(items), boxes, 0);
  const Box3d& all = tree_.bounds();
  size_ = length(all.high - all.low);
  reach_ = kReach * std::max({max_component(all.high), max_component(-all.low), size_ / 4});
}

bool CellProbe::contains(std::uint32_t cell, Vec3d p) const {
  const CsgExpressionView view = cells_->expression_of(cells_->cells()[cell]);
  const SurfaceTable& surfaces = solid().surfaces();
  if (view.leaves.size() > kTruthLeaves) {
    return CsgExpression::eval_steps(view.steps, [&](std::uint32_t slot) {
      return arris::contains(solid().leaf(view.leaves[slot]), surfaces, p);
    });
  }
  std::uint64_t state = 0;
  for (std::size_t slot = 0; slot < view.leaves.size(); ++slot) {
    const bool in = arris::contains(solid().leaf(view.leaves[slot]), surfaces, p);
    state |= std::uint64_t(in ? 1 : 0) << slot;
  }
  return ((view.truth >> state) & 1) != 0;
}

std::optional<std::uint32_t> CellProbe::find_cell(Vec3d p,
                                                  std::optional<std::uint32_t> guess) const {
  if (guess && is_in(cells_->cells()[*guess].own, p)) return guess;
  std::optional<std::uint32_t> found;
  tree_.visit(
      [&](const Box3d& box) {
        return p.x >= box.low.x && p.x <= box.high.x && p.y >= box.low.y && p.y <= box.high.y &&
               p.z >= box.low.z && p.z <= box.high.z;
      },
      [&](std::uint32_t cell) {
        if (is_in(cells_->cells()[cell].own, p)) found = cell;
        return !found;
      });
  return found;
}

bool CellProbe::meets(const Ray& ray, double t_min, double t_max) const {
  thread_local BoundarySearch search;
  bool found = false;
  tree_.visit([&](const Box3d& box) { return line_meets_box(box, ray, t_min, t_max); },
              [&](std::uint32_t cell) {
                cells_->visit_boundaries(cell, ray, t_min, t_max, search,
                                         [&](const CsgBoundary&) { return found = true; });
                return !found;
              });
  return found;
}

std::optional<CsgSurfacePoint> CellProbe::first_met(const Ray& ray, double t_min) const {
  thread_local BoundarySearch search;
  double t_max = std::numeric_limits<double>::infinity();
  std::optional<CsgSurfacePoint> first;
  tree_.visit([&](const Box3d& box) { return line_meets_box(box, ray, t_min, t_max); },
              [&](std::uint32_t cell) {
                cells_->visit_boundaries(
                    cell, ray, t_min, t_max, search, [&](const CsgBoundary& b) {
                      if (!b.entering) return false;
                      first = {b.t, ray.origin + ray.direction * b.t, b.leaf, b.face};
                      t_max = b.t;
                      return true;
                    });
                return true;
              });
  return first;
}

}  // namespace arris
