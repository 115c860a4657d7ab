#include "beam/beam_shadow.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace arris {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Each lit plane has a view and lists of its own: too dear for the facets of a large mesh.
constexpr std::size_t kMostLitFacets = 256;

Sign sign_of(double x) {
  return x > 0 ? Sign::positive : x < 0 ? Sign::negative : Sign::unknown;
}

// On which side of the plane, in the solid's space.
Sign side_of(const CsgPlane& plane, Vec3d p) {
  return sign_of(dot(plane.normal, p) - plane.d);
}

// How far from the light the farthest rays meet the plane.
double depth_of(const PlaneForm& plane, const Rect& rect) {
  const Interval height = absolute(range_over(plane.height, rect));
  const Interval slope = absolute(range_over(plane.slope, rect));
  return slope.lo > 0 ? next_up(height.hi / slope.lo) : kInfinity;
}

// No two points of the solids are farther apart.
double diameter_of(std::span<const BeamSolid> solids) {
  Box3d all{Vec3d(kInfinity), Vec3d(-kInfinity)};
  for (const BeamSolid& s : solids) {
    const Box3d& own = s.shape->bounds();
    if (own.is_empty()) continue;
    const Affine3d world_from_object = inverse(s.object_from_world);
    all = hull(all, box_of(map_cell(world_from_object, make_cell(own))));
  }
  return all.is_empty() ? 0 : length(all.high - all.low);
}

}  // namespace

ShadowLooker::ShadowLooker(std::span<const BeamSolid> solids, const EyeRays& eye,
                           std::span<const LightPlace> lights)
    : solids_(solids), eye_(eye), lights_(lights), reach_(2 * diameter_of(solids)) {}

namespace {

struct Placed {
  LitPlane lit;
  std::uint32_t leaf = 0;
  std::optional<LookTree> seen_by_light;  // nothing: the light is behind
};

// The light's tree in the place of a surface's node: its ends are that surface, lit or not.
void splice(LookTree& tree, std::uint32_t at, std::uint32_t bit,
            const std::optional<LookTree>& seen_by_light) {
  LookNode surface = tree.nodes[at];
  if (!seen_by_light) {
    surface.lit |= bit;
    surface.lit_known |= bit;
    tree.nodes[at] = surface;
    return;
  }
  replace_node(tree, at, *seen_by_light, [&](const LookNode& seen) {
    LookNode end = surface;
    if (seen.kind == LookNode::Kind::unknown) {
      end.light_open = true;
      return end;
    }
    const bool reached =
        seen.kind == LookNode::Kind::nothing || seen.seen.surface == surface.seen.surface;
    end.lit_known |= bit;
    end.lit |= reached ? bit : 0;
    return end;
  });
}

}  // namespace

std::vector<std::uint32_t> ShadowLooker::find_lit(const LookTree& tree, const Unlit& unlit) const {
  std::vector<std::uint32_t> lit;
  for (std::uint32_t i = 0; i < tree.nodes.size(); ++i) {
    const LookNode& node = tree.nodes[i];
    if (node.kind != LookNode::Kind::surface || !node.seen.surface.is_plane()) continue;
    if (node.mirrors != 0 || (unlit && unlit(node))) continue;
    const BeamShape& shape = *solids_[node.seen.solid].shape;
    const bool is_facet = shape.facet(node.seen.leaf) != nullptr;
    if (!is_facet || shape.facet_count() <= kMostLitFacets) lit.push_back(i);
  }
  return lit;
}

bool ShadowLooker::add_shadows(LookTree& tree, const Rect& rect, ShadowLists& lists,
                               std::uint64_t& regions, const Unlit& unlit) const {
  if (!is_joint() || !(reach_ > 0) || !std::isfinite(reach_)) return true;
  bool complete = true;
  std::vector<std::uint32_t> surfaces = find_lit(tree, unlit);
  for (std::uint32_t light = 0; light < lights_.size(); ++light) {
    complete = add_light(tree, rect, light, 1U << light, surfaces, lists, regions) && complete;
  }
  return complete;
}

bool ShadowLooker::add_shadow(LookTree& tree, const Rect& rect, std::uint32_t light,
                              ShadowLists& lists, std::uint64_t& regions,
                              const Unlit& unlit) const {
  if (!(reach_ > 0) || !std::isfinite(reach_)) return true;
  std::vector<std::uint32_t> surfaces = find_lit(tree, unlit);
  return add_light(tree, rect, light, 1, surfaces, lists, regions);
}

bool ShadowLooker::add_light(LookTree& tree, const Rect& rect, std::uint32_t light,
                             std::uint32_t bit, std::vector<std::uint32_t>& surfaces,
                             ShadowLists& lists, std::uint64_t& regions) const {
  bool complete = true;
  const auto first_new = std::uint32_t(tree.nodes.size());
  std::vector<Placed> looks;  // one for each plane, however often it is seen
  for (const std::uint32_t node : surfaces) {
    const BeamSurface surface = tree.nodes[node].seen.surface;
    const std::uint32_t leaf = tree.nodes[node].seen.leaf;
    auto known = std::ranges::find_if(looks, [&](const Placed& p) {
      return p.lit.solid == surface.solid && p.lit.plane == surface.index && p.leaf == leaf;
    });
    if (known == looks.end()) {
      const LitPlane lit{surface.solid, surface.index};
      looks.push_back({lit, leaf, look_from_light(lit, leaf, light, rect, lists)});
      known = looks.end() - 1;
      ++regions;
      complete = complete && (!known->seen_by_light || known->seen_by_light->complete);
    }
    splice(tree, node, bit, known->seen_by_light);
  }
  // What stands in their places now, and what was added below.
  std::erase_if(surfaces,
                [&](std::uint32_t i) { return tree.nodes[i].kind != LookNode::Kind::surface; });
  for (std::uint32_t i = first_new; i < tree.nodes.size(); ++i) {
    if (tree.nodes[i].kind == LookNode::Kind::surface) surfaces.push_back(i);
  }
  return complete;
}

namespace {

// A leaf that ends at the plane and lies behind it is not in the light's way.
bool is_behind(const ConvexLeaf* convex, std::uint32_t plane, Sign light_side) {
  return convex != nullptr && std::ranges::any_of(convex->planes, [&](PlaneRef ref) {
           return ref.plane == plane && (light_side == Sign::positive) == !ref.flipped;
         });
}

}  // namespace

namespace {

// What lies between a light and a box, in the space of one solid.
struct Shaft {
  Box3d target;
  bool is_directional = false;
  Vec3d light;  // position, or the way to it

  // May the box meet light + s (target - light) for an s in [0, 1], or target + s light for an s > 0?
  [[nodiscard]] bool meets(const Box3d& box) const {
    const auto axis = [&](int k) { return Interval(target.low[k], target.high[k]); };
    const Vec3i to{axis(0), axis(1), axis(2)}, at = to_intervals(light);
    return (is_directional ? depths_in(box, to, at, kInfinity) : depths_in(box, at, to - at, 1))
        .has_value();
  }
};

// Of a beam between two depths.
Box3d box_of_beam(const EyeRays& eye, const Rect& rect, double near, double far) {
  Box3d box{Vec3d(kInfinity), Vec3d(-kInfinity)};
  for (int i = 0; i < 8; ++i) {
    const Vec2d at{(i & 1) != 0 ? rect.x1 : rect.x0, (i & 2) != 0 ? rect.y1 : rect.y0};
    const Ray ray = ray_through(eye, at);
    const Vec3d p = ray.origin + ray.direction * ((i & 4) != 0 ? far : near);
    box = hull(box, {p, p});
  }
  return box;
}

}  // namespace

// Of what of a leaf a tile sees.
Box3d ShadowLooker::box_of_target(std::uint32_t solid, std::uint32_t leaf, const Rect& tile) const {
  const Affine3d world_from_object = inverse(solids_[solid].object_from_world);
  const Box3d& own = solids_[solid].shape->leaf_box(leaf);
  if (!is_finite(own.low) || !is_finite(own.high)) return {Vec3d(-kInfinity), Vec3d(kInfinity)};
  const Box3d box = box_of(map_cell(world_from_object, make_cell(own)));
  // Depths along the view, from the corners of the box.
  const Vec3d view = cross(eye_.step_x, eye_.step_y);
  const double unit = dot(view, eye_.corner);
  double near = kInfinity, far = 0;
  for (const Vec3d& corner : corners_of(box)) {
    const double depth = dot(view, corner - eye_.position) / unit;
    near = std::min(near, depth);
    far = std::max(far, depth);
  }
  const Box3d beam = box_of_beam(eye_, tile, std::max(near, 0.0), std::max(far, 0.0));
  const Vec3d slack(1e-9 * (length(box.high - box.low) + length(beam.high - beam.low)));
  const Box3d both = intersection(box, beam);
  return {both.low - slack, both.high + slack};
}

const ShadowLists::List& ShadowLooker::list_for(LitPlane lit, std::uint32_t leaf,
                                                std::uint32_t light, ShadowLists& lists) const {
  const ShadowLists::Key key{light, lit.solid, lit.plane, leaf};
  const auto known = lists.lists_.find(key);
  if (known != lists.lists_.end()) return known->second;
  ShadowLists::List list{BeamView(solids_, eye_, lit, lights_[light], reach_), {}};
  const Sign light_side = side_of_light(lit, light);
  const Box3d target = box_of_target(lit.solid, leaf, lists.tile_);
  std::vector<BeamPart> roots;
  for (std::uint32_t i = 0; i < solids_.size(); ++i) {
    const BeamShape& shape = *solids_[i].shape;
    CsgExpression root = root_in_shaft(i, target, light);
    if (i == lit.solid && !root.is_decided()) {
      std::vector<Cover> covers;
      for (const std::uint32_t other : root.leaves()) {
        covers.push_back(is_behind(shape.convex(other), lit.plane, light_side) ? Cover::out
                                                                               : Cover::on);
      }
      root = root.prune(covers);
    }
    if (!root.is_decided()) roots.push_back({i, std::move(root)});
  }
  const double end = depth_of(list.view.plane(lit.solid, lit.plane), lists.tile_);
  list.parts = prune_parts(list.view, roots, lists.tile_, end).parts;
  return lists.lists_.emplace(key, std::move(list)).first->second;
}

CsgExpression ShadowLooker::root_in_shaft(std::uint32_t solid, const Box3d& target,
                                          std::uint32_t light) const {
  const BeamSolid& s = solids_[solid];
  if (!is_finite(target.low) || !is_finite(target.high)) return s.shape->root();
  if (target.is_empty()) return CsgExpression(Cover::out);  // the tile does not see the leaf
  const LightPlace& place = lights_[light];
  Shaft shaft;
  shaft.target = box_of(map_cell(s.object_from_world, make_cell(target)));
  shaft.is_directional = place.is_directional;
  shaft.light = place.is_directional ? -transform_vector(s.object_from_world, place.direction)
                                     : transform_point(s.object_from_world, place.position);
  return s.shape->root_near([&](const Box3d& box) { return shaft.meets(box); });
}

Sign ShadowLooker::side_of_light(LitPlane lit, std::uint32_t light) const {
  const BeamSolid& solid = solids_[lit.solid];
  const CsgPlane& plane = solid.shape->planes()[lit.plane];
  const LightPlace& place = lights_[light];
  if (!place.is_directional) {
    return side_of(plane, transform_point(solid.object_from_world, place.position));
  }
  return -sign_of(dot(plane.normal, transform_vector(solid.object_from_world, place.direction)));
}

std::optional<LookTree> ShadowLooker::look_from_light(LitPlane lit, std::uint32_t leaf,
                                                      std::uint32_t light, const Rect& rect,
                                                      ShadowLists& lists) const {
  const BeamSolid& solid = solids_[lit.solid];
  const CsgPlane& plane = solid.shape->planes()[lit.plane];
  const Sign eye_side = side_of(plane, transform_point(solid.object_from_world, eye_.position));
  if (eye_side * side_of_light(lit, light) != Sign::positive) return std::nullopt;
  const ShadowLists::List& list = list_for(lit, leaf, light, lists);
  const double end = depth_of(list.view.plane(lit.solid, lit.plane), rect);
  const BeamList in_the_way = prune_parts(list.view, list.parts, rect, end);
  if (in_the_way.parts.empty()) {
    LookTree nothing;
    nothing.nodes.emplace_back();
    nothing.depth_end = end;
    return nothing;
  }
  return look(list.view, in_the_way, rect, end, {.only = lit});
}

}  // namespace arris
