#include "beam/beam_shape.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "beam/convex_solid.h"

namespace arris {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr Box3d kEverywhere{{-kInfinity, -kInfinity, -kInfinity},
                            {kInfinity, kInfinity, kInfinity}};

std::array<double, 6> place_of(Vec3d a, Vec3d b) {
  return {a.x, a.y, a.z, b.x, b.y, b.z};
}

// Triangles that lie in one plane but for the rounding of float coordinates share it.
PlaneRef plane_of(const MeshTriangle& triangle, SurfaceTable& surfaces) {
  const auto& [a, b, c] = triangle.corners;
  const Vec3d n = cross(b - a, c - a);
  const double size = length(n);
  if (!(size > 0)) return {};
  Box3d box{min(a, min(b, c)), max(a, max(b, c))};
  const double reach = std::max(max_component(box.high), max_component(-box.low));
  // The table moves planes by kMergedThickness of a leaf's thickness.
  const Vec3d half_thickness(1e-7 * reach / (2 * kMergedThickness));
  box = {box.low - half_thickness, box.high + half_thickness};
  return surfaces.add(CsgPlane{n * (1 / size), dot(n * (1 / size), a)}, box);
}

CsgExpression make_union(std::size_t count) {
  CsgTree tree;
  tree.nodes.push_back({CsgNode::kInner, CsgOperation::unite, {}});
  for (std::uint32_t i = 0; i < count; ++i) {
    tree.nodes[0].children.push_back(i + 1);
    tree.nodes.push_back({i, CsgOperation::unite, {}});
  }
  tree.leaves.resize(count);
  return CsgExpression(tree, std::vector<bool>(count, true));
}

}  // namespace

BeamShape::BeamShape(const CsgTree& tree)
    : csg_(make_convex_solid(tree)), planes_(csg_.surfaces().planes()), bounds_(csg_.bounds()) {
  const auto count = std::uint32_t(csg_.leaf_count());
  std::map<std::uint32_t, std::vector<std::uint32_t>> volumes;
  for (const std::uint32_t leaf : csg_.root().leaves()) {
    const auto* mesh = std::get_if<MeshLeaf>(&csg_.leaf(leaf).shape);
    if (mesh == nullptr) continue;
    EdgePlaces known;
    std::vector<std::uint32_t>& facets = volumes[leaf];
    for (std::uint32_t t = 0; t < mesh->mesh.triangles().size(); ++t) {
      MeshTriangle triangle{{}, t};
      for (std::size_t k = 0; k < 3; ++k) {
        triangle.corners[k] = mesh->mesh.vertices()[mesh->mesh.triangles()[t][k]];
      }
      facets.push_back(count + std::uint32_t(facets_.size()));
      if (!add_facet(triangle, mesh->planes[t], known)) {
        facets.pop_back();
        continue;
      }
      facets_.back().source = leaf;
    }
    volumes_.push_back(&mesh->mesh);
  }
  std::uint32_t number = 0;
  for (auto& [leaf, parts] : volumes) parts.push_back(std::uint32_t(first_volume()) + number++);
  root_ = csg_.root().with_parities(volumes);
  make_tree();
}

BeamShape::BeamShape(std::span<const MeshTriangle> triangles)
    : csg_(CsgTree{}), bounds_{Vec3d(kInfinity), Vec3d(-kInfinity)} {
  EdgePlaces known;
  SurfaceTable surfaces;
  for (const MeshTriangle& triangle : triangles) {
    if (add_facet(triangle, plane_of(triangle, surfaces), known)) {
      bounds_ = hull(bounds_, boxes_.back());
    }
  }
  planes_ = surfaces.planes();
  root_ = make_union(facets_.size());
  make_tree();
}

void BeamShape::make_tree() {
  std::vector<Box3d> boxes;
  for (std::uint32_t leaf = 0; leaf < leaf_count(); ++leaf) boxes.push_back(leaf_box(leaf));
  tree_ = LeafTree(root_, boxes);
}

bool BeamShape::add_facet(const MeshTriangle& triangle, PlaneRef plane, EdgePlaces& known) {
  const auto& corners = triangle.corners;
  if (!(length(cross(corners[1] - corners[0], corners[2] - corners[0])) > 0)) return false;
  Facet facet;
  facet.triangle = triangle.number;
  for (std::size_t k = 0; k < 3; ++k) {
    Vec3d a = corners[k], b = corners[(k + 1) % 3];
    facet.turned[k] = place_of(b, a) < place_of(a, b);
    if (facet.turned[k]) std::swap(a, b);
    const auto [at, is_new] = known.try_emplace(place_of(a, b), std::uint32_t(edges_.size()));
    if (is_new) edges_.push_back({a, b});
    facet.edges[k] = at->second;
  }
  facet.plane = plane;
  facets_.push_back(facet);
  boxes_.push_back(
      {min(corners[0], min(corners[1], corners[2])), max(corners[0], max(corners[1], corners[2]))});
  return true;
}

const Box3d& BeamShape::leaf_box(std::uint32_t leaf) const {
  if (leaf < csg_.leaf_count()) return csg_.leaf(leaf).bounds;
  return leaf < first_volume() ? boxes_[leaf - csg_.leaf_count()] : kEverywhere;
}

std::optional<double> BeamShape::meet(const Facet& facet, const Ray& ray) const {
  const CsgPlane& plane = planes_[facet.plane.plane];
  const double slope = dot(plane.normal, ray.direction);
  for (std::size_t k = 0; k < 3; ++k) {
    const Edge& e = edges_[facet.edges[k]];
    const double side = dot(ray.direction, cross(e.a - ray.origin, e.b - ray.origin));
    if ((facet.turned[k] != facet.plane.flipped ? -side : side) * slope < 0) return std::nullopt;
  }
  const double t = (plane.d - dot(plane.normal, ray.origin)) / slope;
  if (!(t > 0 && t < kInfinity)) return std::nullopt;
  return t;
}

}  // namespace arris
