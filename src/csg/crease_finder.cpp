#include "csg/crease_finder.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <utility>

#include "base/parallel_for.h"
#include "csg/surface_curve.h"

namespace arris {
namespace {

// As many patches are tried in pairs.
constexpr std::size_t kFewSurfaces = 6;
// Boxes below, in parts of the solid, are not halved to have fewer.
constexpr double kLeastBox = 1.0 / 512;
constexpr double kHalf = 0.5169;  // not in the very middle, where symmetric solids have their edges
// Cells are looked at this far beyond their own box, in parts of the solid's size.
constexpr double kMargin = 1e-7;
// Surfaces this near, in parts of CellProbe::reach(), pass through the curve, too.
constexpr double kThrough = 0.1;
// Stretches of a segment shorter than this part of it are left out.
constexpr double kShortStretch = 1e-7;
// Directions closer than this are one.
constexpr double kOneDirection = radians(0.05);

// A surface in a box, with all patches that lie on it.
struct Active {
  std::uint32_t surface;
  Box3d box;
  std::vector<std::uint32_t> patches;
};

// How the solid lies round a point of a curve, in the plane across it.
struct Around {
  struct Side {
    double angle;
    Vec3d direction;  // of the surface, away from the curve
    Vec3d normal;     // outward
  };
  std::vector<Side> sides;  // where the solid begins or ends
};

// What the search is the same for in all cells.
struct CreaseSearch {
  const CellProbe& probe;
  const SmoothPatches& patches;
  const PlaceTree& tree;  // of the patches
  bool many_materials = false;
  const std::atomic<bool>* stop = nullptr;

  // A single cell may take minutes. What is found by then is lost.
  [[nodiscard]] bool is_stopped() const {
    return stop != nullptr && stop->load(std::memory_order_relaxed);
  }
};

class CellCreases {
 public:
  CellCreases(const CreaseSearch& search, std::uint32_t cell, std::vector<CreaseSegment>& out)
      : search_(search),
        probe_(search.probe),
        patches_(search.patches),
        tree_(search.tree),
        cell_(cell),
        many_materials_(search.many_materials),
        view_(probe_.cells().expression_of(probe_.cells().cells()[cell])),
        out_(out) {}

  void find() {
    const CsgCell& cell = probe_.cells().cells()[cell_];
    const Vec3d margin(kMargin * probe_.size());
    const Box3d own{cell.own.low - margin, cell.own.high + margin};
    const Box3d box = intersection({cell.bounds.low - margin, cell.bounds.high + margin}, own);
    std::vector<std::uint32_t> all;
    tree_.visit([&](const Box3d& other) { return !intersection(other, box).is_empty(); },
                [&](std::uint32_t patch) {
                  if (std::ranges::binary_search(view_.leaves, patches_.patches()[patch].leaf)) {
                    all.push_back(patch);
                  }
                  return true;
                });
    std::ranges::sort(all);
    divide(box, all);
  }

  void add_mesh_edge(const MeshLeafEdge& edge, Vec3d a, Vec3d b) {
    const std::uint32_t through[] = {edge.surface0, edge.surface1};
    std::vector<std::uint32_t> near;
    tree_.visit([&](const Box3d& box) { return meets(box, a, b); },
                [&](std::uint32_t patch) {
                  const SmoothPatch& p = patches_.patches()[patch];
                  if (std::ranges::binary_search(view_.leaves, p.leaf)) near.push_back(p.surface);
                  return true;
                });
    add_segment(a, b, {through, 2}, near, [](Vec3d p) { return std::optional<Vec3d>(p); });
  }

 private:
  static bool meets(const Box3d& box, Vec3d a, Vec3d b) {
    return !intersection(box, {min(a, b), max(a, b)}).is_empty();
  }

  // Those of the patches that the box may hold a piece of the solid's surface of.
  [[nodiscard]] std::vector<std::uint32_t> keep_near(const Box3d& box,
                                                     std::span<const std::uint32_t> all) const {
    std::vector<std::uint32_t> kept;
    std::map<std::uint32_t, bool> is_on;
    const SpaceCell space = make_cell(box);
    for (const std::uint32_t i : all) {
      const SmoothPatch& patch = patches_.patches()[i];
      if (!may_hold(patch, box)) continue;
      if (patches_.surface(patch.surface).misses(box)) continue;
      const auto [at, is_new] = is_on.insert({patch.leaf, false});
      if (is_new) at->second = probe_.solid().cover_of(patch.leaf, space) == Cover::on;
      if (at->second) kept.push_back(i);
    }
    return kept;
  }

  [[nodiscard]] std::vector<Active> by_surface(const Box3d& box,
                                               std::span<const std::uint32_t> patches) const {
    std::map<std::uint32_t, Active> active;
    for (const std::uint32_t i : patches) {
      const SmoothPatch& patch = patches_.patches()[i];
      const Box3d part = intersection(patch.box, box);
      const auto [at, is_new] = active.insert({patch.surface, {patch.surface, part, {}}});
      if (!is_new) at->second.box = hull(at->second.box, part);
      at->second.patches.push_back(i);
    }
    std::vector<Active> out;
    for (auto& [surface, a] : active) out.push_back(std::move(a));
    return out;
  }

  void divide(const Box3d& box, std::span<const std::uint32_t> all) {
    if (search_.is_stopped()) return;
    const std::vector<std::uint32_t> patches = keep_near(box, all);
    if (patches.size() < 2) return;
    const Vec3d extent = box.high - box.low;
    const int axis =
        extent.x > extent.y ? (extent.x > extent.z ? 0 : 2) : (extent.y > extent.z ? 1 : 2);
    if (patches.size() > kFewSurfaces && extent[axis] > kLeastBox * probe_.size()) {
      Box3d low = box, high = box;
      low.high[axis] = high.low[axis] = box.low[axis] + kHalf * extent[axis];
      divide(low, patches);
      divide(high, patches);
      return;
    }
    const std::vector<Active> active = by_surface(box, patches);
    std::vector<std::uint32_t> near;
    for (const Active& a : active) near.push_back(a.surface);
    for (std::size_t i = 0; i < active.size() && !search_.is_stopped(); ++i) {
      for (std::size_t j = i + 1; j < active.size(); ++j) {
        if (may_meet(active[i], active[j])) add_curve(active[i], active[j], near);
      }
    }
  }

  [[nodiscard]] bool may_meet(const Active& a, const Active& b) const {
    if (intersection(a.box, b.box).is_empty()) return false;
    for (const std::uint32_t one : a.patches) {
      for (const std::uint32_t two : b.patches) {
        if (patches_meet(patches_.patches()[one], patches_.patches()[two])) return true;
      }
    }
    return false;
  }
  // Pieces of one rounded leaf meet smoothly, triangles of one mesh along edges that are known, what the edges of one
  // region sweep where these do.
  [[nodiscard]] bool patches_meet(const SmoothPatch& a, const SmoothPatch& b) const {
    if (a.leaf != b.leaf) return true;
    const auto share_end = [](const RegionEdge& e, const RegionEdge& f) {
      return e.a == f.a || e.a == f.b || e.b == f.a || e.b == f.b;
    };
    const CsgShape& shape = probe_.solid().leaf(a.leaf).shape;
    if (const auto* revolution = std::get_if<RevolutionLeaf>(&shape)) {
      const std::vector<RegionEdge>& edges = revolution->region.edges();
      return share_end(edges[a.face], edges[b.face]);
    }
    if (const auto* prism = std::get_if<PrismLeaf>(&shape)) {
      const std::vector<RegionEdge>& edges = prism->region.edges();
      return a.face < 2 || b.face < 2 || share_end(edges[a.face - 2], edges[b.face - 2]);
    }
    return !std::holds_alternative<RoundedLeaf>(shape) && !std::holds_alternative<MeshLeaf>(shape);
  }

  [[nodiscard]] bool may_hold_surface(const Active& active, const Box3d& box) const {
    return std::ranges::any_of(active.patches, [&](std::uint32_t i) {
      const SmoothPatch& patch = patches_.patches()[i];
      return may_hold(patch, box);
    });
  }

  void add_curve(const Active& a, const Active& b, std::span<const std::uint32_t> near) {
    const SurfaceCurve curve(patches_.surface(a.surface), patches_.surface(b.surface),
                             probe_.size());
    pieces_.clear();
    curve.collect_pieces(
        intersection(a.box, b.box),
        [&](const Box3d& box) {
          return !search_.is_stopped() && may_hold_surface(a, box) && may_hold_surface(b, box);
        },
        pieces_);
    const std::uint32_t through[] = {a.surface, b.surface};
    for (const SurfaceCurve::Piece& piece : pieces_) {
      if (search_.is_stopped()) return;
      add_segment(piece.a, piece.b, {through, 2}, near, [&](Vec3d p) { return curve.nearest(p); });
    }
  }

  // Between its crossings with other surfaces all points of a segment are alike.
  template <class OnCurve>
  void add_segment(Vec3d a, Vec3d b, std::span<const std::uint32_t> through,
                   std::span<const std::uint32_t> near, const OnCurve& on_curve) {
    if (!(length(b - a) > 1e-9 * probe_.size())) return;
    cuts_.assign({0.0, 1.0});
    for (const std::uint32_t surface : near) {
      if (std::ranges::find(through, surface) != through.end()) continue;
      patches_.surface(surface).collect_crossings(a, b, cuts_);
    }
    std::ranges::sort(cuts_);
    const std::size_t before = out_.size();
    for (std::size_t i = 0; i + 1 < cuts_.size(); ++i) {
      const double t0 = cuts_[i], t1 = cuts_[i + 1];
      if (t1 - t0 < kShortStretch) continue;
      const Vec3d p = a + (b - a) * ((t0 + t1) / 2);
      const std::optional<Vec3d> on = on_curve(p);
      std::optional<CreaseSegment> found =
          classify(on.value_or(p), normalize(b - a), through, near);
      if (!found) continue;
      found->a = a + (b - a) * t0;
      found->b = a + (b - a) * t1;
      found->cell = cell_;
      found->middle = on.value_or(p);
      if (found->kind == CreaseSegment::Kind::sharp && !are_sides_flat(*found, through)) {
        found->kind = CreaseSegment::Kind::contact;
      }
      const bool goes_on = out_.size() > before && out_.back().kind == found->kind &&
                           length(found->a - out_.back().b) <= kShortStretch * length(b - a);
      if (goes_on) {
        out_.back().b = found->b;
      } else {
        out_.push_back(*found);
      }
    }
  }

  // Whether normals at the middle stand for the whole of it.
  [[nodiscard]] bool are_sides_flat(const CreaseSegment& crease,
                                    std::span<const std::uint32_t> through) const {
    static const double kCosine = std::cos(kSideTurn);
    return std::ranges::all_of(through, [&](std::uint32_t surface) {
      const Vec3d a = patches_.surface(surface).gradient(crease.a);
      const Vec3d b = patches_.surface(surface).gradient(crease.b);
      return dot(a, b) > kCosine * length(a) * length(b);
    });
  }

  [[nodiscard]] std::optional<CreaseSegment> classify(Vec3d p, Vec3d along,
                                                      std::span<const std::uint32_t> through,
                                                      std::span<const std::uint32_t> near) const {
    const Around around = look_around(p, along, through, near);
    CreaseSegment found;
    if (around.sides.empty()) return std::nullopt;
    if (around.sides.size() != 2) return found;
    found.kind = CreaseSegment::Kind::sharp;
    found.normal = {around.sides[0].normal, around.sides[1].normal};
    const double turn = std::abs(std::abs(around.sides[1].angle - around.sides[0].angle) - kPi);
    if (turn > kSoftTurn) return found;
    if (many_materials_ && material_of(p, around.sides[0]) != material_of(p, around.sides[1])) {
      return found;
    }
    found.kind = CreaseSegment::Kind::soft;
    return turn > kNoTurn ? std::optional(found) : std::nullopt;
  }

  // In which directions the surfaces leave the curve, and which of the sectors between them are in the solid.
  [[nodiscard]] Around look_around(Vec3d p, Vec3d along, std::span<const std::uint32_t> through,
                                   std::span<const std::uint32_t> near) const {
    const Vec3d x =
        normalize(cross(along, std::abs(along.x) < 0.6 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0)));
    const Vec3d y = cross(along, x);
    const auto direction = [&](double angle) { return x * std::cos(angle) + y * std::sin(angle); };
    std::vector<double> angles;
    const auto add = [&](std::uint32_t surface) {
      const Vec3d g = patches_.surface(surface).gradient(p);
      const double angle = std::atan2(dot(g, y), dot(g, x));
      if (std::hypot(dot(g, x), dot(g, y)) < 1e-3 * length(g)) return;
      for (const double turn : {-kPi / 2, kPi / 2}) {
        double side = angle + turn;
        if (side < 0) side += 2 * kPi;
        if (side >= 2 * kPi) side -= 2 * kPi;
        angles.push_back(side);
      }
    };
    for (const std::uint32_t surface : through) add(surface);
    for (const std::uint32_t surface : near) {
      if (std::ranges::find(through, surface) != through.end()) continue;
      const SmoothSurface& s = patches_.surface(surface);
      if (std::abs(s.value(p)) < kThrough * probe_.reach() * length(s.gradient(p))) add(surface);
    }
    std::ranges::sort(angles);
    std::vector<double> rays;
    for (const double angle : angles) {
      if (rays.empty() || angle - rays.back() > kOneDirection) rays.push_back(angle);
    }
    if (rays.size() > 1 && rays.front() + 2 * kPi - rays.back() < kOneDirection) rays.pop_back();
    std::vector<bool> in;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const double next = i + 1 < rays.size() ? rays[i + 1] : rays[0] + 2 * kPi;
      in.push_back(probe_.contains(cell_, p + direction((rays[i] + next) / 2) * probe_.reach()));
    }
    Around around;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const bool before = in[i == 0 ? rays.size() - 1 : i - 1];
      if (before == in[i]) continue;
      // The solid is on the side of greater angles if it begins here.
      const Vec3d outward = direction(rays[i] + (in[i] ? -kPi / 2 : kPi / 2));
      around.sides.push_back({rays[i], direction(rays[i]), outward});
    }
    return around;
  }

  [[nodiscard]] std::uint32_t material_of(Vec3d p, const Around::Side& side) const {
    const Vec3d q = p + side.direction * probe_.reach();
    thread_local BoundarySearch search;
    const CsgBoundary* best = nullptr;
    for (const CsgBoundary& b : search.find(probe_.solid(), view_, {q, side.normal})) {
      if (best == nullptr || std::abs(b.t) < std::abs(best->t)) best = &b;
    }
    return best == nullptr ? ~std::uint32_t{0} : probe_.solid().leaf(best->leaf).material.index;
  }

  const CreaseSearch& search_;
  const CellProbe& probe_;
  const SmoothPatches& patches_;
  const PlaceTree& tree_;
  std::uint32_t cell_;
  bool many_materials_;
  CsgExpressionView view_;
  std::vector<CreaseSegment>& out_;
  std::vector<SurfaceCurve::Piece> pieces_;
  std::vector<double> cuts_;
};

bool has_many_materials(const CsgSolid& solid) {
  const std::vector<std::uint32_t>& leaves = solid.root().leaves();
  return std::ranges::any_of(leaves, [&](std::uint32_t leaf) {
    return solid.leaf(leaf).material.index != solid.leaf(leaves[0]).material.index;
  });
}

// The part of a segment in a box.
std::optional<std::pair<Vec3d, Vec3d>> part_in(const Box3d& box, Vec3d a, Vec3d b) {
  const Vec3d d = b - a;
  double t0 = 0, t1 = 1;
  for (int k = 0; k < 3; ++k) {
    if (d[k] == 0) {
      if (a[k] < box.low[k] || a[k] > box.high[k]) return std::nullopt;
      continue;
    }
    const double u = (box.low[k] - a[k]) / d[k], v = (box.high[k] - a[k]) / d[k];
    t0 = std::max(t0, std::min(u, v));
    t1 = std::min(t1, std::max(u, v));
  }
  if (!(t0 < t1)) return std::nullopt;
  return std::pair(a + d * t0, a + d * t1);
}

std::vector<CreaseSegment> join(const std::vector<std::vector<CreaseSegment>>& parts) {
  std::vector<CreaseSegment> all;
  for (const std::vector<CreaseSegment>& part : parts) {
    all.insert(all.end(), part.begin(), part.end());
  }
  return all;
}

}  // namespace

std::vector<CreaseSegment> find_creases(const CellProbe& probe, const SmoothPatches& patches,
                                        int threads, const std::atomic<bool>* stop) {
  std::vector<std::uint32_t> items;
  std::vector<Box3d> boxes;
  for (std::uint32_t i = 0; i < patches.patches().size(); ++i) {
    boxes.push_back(patches.patches()[i].box);
    if (!boxes.back().is_empty()) items.push_back(i);
  }
  if (items.empty() || probe.cells().cells().empty()) return {};
  const PlaceTree tree(std::move(items), boxes, 0);
  const CreaseSearch search{probe, patches, tree, has_many_materials(probe.solid()), stop};
  const std::size_t count = probe.cells().cells().size();
  std::vector<std::vector<CreaseSegment>> found(count + patches.mesh_edges().size());
  parallel_for(found.size(), {.grain = 1, .threads = threads, .stop = stop}, [&](std::size_t i) {
    if (i < count) {
      CellCreases(search, std::uint32_t(i), found[i]).find();
      return;
    }
    const MeshLeafEdge& edge = patches.mesh_edges()[i - count];
    probe.tree().visit(
        [&](const Box3d& box) { return part_in(box, edge.a, edge.b).has_value(); },
        [&](std::uint32_t cell) {
          const CsgCell& c = probe.cells().cells()[cell];
          const std::span<const std::uint32_t> leaves = probe.cells().expression_of(c).leaves;
          if (!std::ranges::binary_search(leaves, edge.leaf)) return true;
          const auto part = part_in(intersection(c.own, c.bounds), edge.a, edge.b);
          if (part) {
            CellCreases(search, cell, found[i]).add_mesh_edge(edge, part->first, part->second);
          }
          return true;
        });
  });
  return join(found);
}

}  // namespace arris
