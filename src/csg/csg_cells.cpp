#include "csg/csg_cells.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "arris/error.h"
#include "base/parallel_for.h"

namespace arris {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Cells are classified and met this much beyond their own box, in parts of the solid's coordinates: far more than the
// rounding of a point on a ray, far less than anything to be seen.
constexpr double kMargin = 1e-9;
// Cells with many leaves may be halved so often in a row without gain.
constexpr std::uint32_t kPatience = 3;
// Halving pays if it takes a cell's expected cost to this part.
constexpr double kGain = 0.9;
// What a cell costs a ray besides its leaves, in leaves.
constexpr double kCellCost = 1;

struct Draft {
  Box3d own, bounds;
  CsgExpression expression;
  std::uint32_t patience = kPatience;
  bool is_final = false;
};

double area_of(const Box3d& box) {
  if (box.is_empty()) return 0;
  const Vec3d e = box.high - box.low;
  return e.x * e.y + e.y * e.z + e.z * e.x;
}

double cost_of(const Draft& draft) {
  return area_of(draft.bounds) * (kCellCost + double(draft.expression.leaves().size()));
}

class Divider {
 public:
  Divider(const CsgSolid& solid, const CellOptions& options) : solid_(solid), options_(options) {
    const Box3d& b = solid.bounds();
    max_depth_ = options.more_depth + std::uint32_t(std::bit_width(solid.root().leaves().size()));
    margin_ = kMargin * std::max({max_component(b.high), max_component(-b.low), 0.0});
  }

  std::vector<Draft> divide() const {
    Draft root;
    root.own = {Vec3d(-kInfinity), Vec3d(kInfinity)};
    root.expression = solid_.root();
    root.bounds = root.own;
    root.bounds = surface_bounds(root);
    std::vector<Draft> level;
    if (!root.expression.is_decided() && !root.bounds.is_empty()) level.push_back(std::move(root));
    std::vector<Draft> done;
    for (std::uint32_t depth = 0; !level.empty(); ++depth) {
      std::vector<std::vector<Draft>> parts(level.size());
      parallel_for(level.size(), {.grain = 4, .threads = options_.threads, .stop = options_.stop},
                   [&](std::size_t i) { parts[i] = halve(std::move(level[i]), depth); });
      level.clear();
      for (std::vector<Draft>& part : parts) {
        for (Draft& draft : part) {
          (draft.is_final ? done : level).push_back(std::move(draft));
        }
      }
    }
    return done;
  }

 private:
  // Where the surface of what is undecided can be: near leaves only, complements or not.
  [[nodiscard]] Box3d surface_bounds(const Draft& draft) const {
    const std::vector<Box3d> boxes = solid_.boxes_of(draft.expression);
    Box3d any{Vec3d(kInfinity), Vec3d(-kInfinity)};
    for (const Box3d& box : boxes) any = hull(any, box);
    const Box3d solid = draft.expression.bounds(boxes);
    Box3d bounds = intersection(intersection(solid, any), draft.bounds);
    if (bounds.is_empty()) return bounds;
    bounds = {bounds.low - Vec3d(margin_), bounds.high + Vec3d(margin_)};
    return intersection(bounds, {draft.own.low - Vec3d(margin_), draft.own.high + Vec3d(margin_)});
  }

  // The part of a cell on one side, without surface where it is decided.
  [[nodiscard]] std::optional<Draft> part_of(const Draft& whole, int axis, double at,
                                             bool upper) const {
    Draft part;
    part.own = whole.own;
    part.bounds = whole.bounds;
    if (upper) {
      part.own.low[axis] = at;
      part.bounds.low[axis] = at - margin_;
    } else {
      part.own.high[axis] = at;
      part.bounds.high[axis] = at + margin_;
    }
    const SpaceCell cell = make_cell(part.bounds);
    part.expression = solid_.prune(whole.expression, cell);
    if (part.expression.is_decided()) return std::nullopt;
    part.bounds = surface_bounds(part);
    if (part.bounds.is_empty()) return std::nullopt;
    return part;
  }

  [[nodiscard]] std::vector<Draft> halve(Draft whole, std::uint32_t depth) const {
    std::vector<Draft> parts;
    const auto finish = [&](Draft draft) {
      draft.is_final = true;
      parts.clear();
      parts.push_back(std::move(draft));
      return std::move(parts);
    };
    const std::size_t count = whole.expression.leaves().size();
    const Vec3d extent = whole.bounds.high - whole.bounds.low;
    const int axis =
        extent.x > extent.y ? (extent.x > extent.z ? 0 : 2) : (extent.y > extent.z ? 1 : 2);
    const double at = whole.bounds.low[axis] * 0.5 + whole.bounds.high[axis] * 0.5;
    if (count <= options_.few || depth >= max_depth_ || extent[axis] < 64 * margin_) {
      return finish(std::move(whole));
    }
    double cost = 0;
    for (const bool upper : {false, true}) {
      if (std::optional<Draft> part = part_of(whole, axis, at, upper)) {
        cost += cost_of(*part);
        parts.push_back(std::move(*part));
      }
    }
    const bool pays = cost < kGain * cost_of(whole);
    if (!pays && (count <= options_.many || whole.patience == 0)) return finish(std::move(whole));
    for (Draft& part : parts) part.patience = pays ? kPatience : whole.patience - 1;
    return parts;
  }

  const CsgSolid& solid_;
  const CellOptions& options_;
  double margin_ = 0;
  std::uint32_t max_depth_ = 0;
};

}  // namespace

CsgCells::CsgCells(std::shared_ptr<const CsgSolid> solid, const std::string& name,
                   const CellOptions& options)
    : solid_(std::move(solid)) {
  if (!solid_->is_bounded()) {
    throw Error(Error::Kind::input, name,
                "a half-space or complement makes this CSG solid endless; intersect it with a box");
  }
  for (const Draft& draft : Divider(*solid_, options).divide()) {
    const CsgExpression& e = draft.expression;
    cells_.push_back({draft.own, draft.bounds, truth_table(e), std::uint32_t(leaves_.size()),
                      std::uint32_t(e.leaves().size()), std::uint32_t(steps_.size()),
                      e.leaves().size() <= kTruthLeaves ? 0 : std::uint32_t(e.steps().size())});
    leaves_.insert(leaves_.end(), e.leaves().begin(), e.leaves().end());
    if (e.leaves().size() > kTruthLeaves) {
      steps_.insert(steps_.end(), e.steps().begin(), e.steps().end());
    }
  }
}

std::uint64_t CsgCells::bytes() const {
  return cells_.size() * sizeof(CsgCell) + leaves_.size() * sizeof(std::uint32_t) +
         steps_.size() * sizeof(CsgStep);
}

}  // namespace arris
