#include "beam/convex_solid.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "beam/outline_parts.h"

namespace arris {
namespace {

using NodeIndex = std::uint32_t;

// Slabs of a solid of revolution thinner than this part of its height are rounding.
constexpr double kThinSlab = 1e-12;

class Maker {
 public:
  explicit Maker(const CsgTree& tree) : tree_(tree), out_(tree) {
    for (const CsgLeaf& leaf : tree.leaves) leaves_.push_back(place_leaf(leaf, surfaces_));
  }

  CsgSolid make() {
    for (std::uint32_t i = 0; i < tree_.leaves.size(); ++i) {
      if (!leaves_[i]) continue;
      leaf_ = &tree_.leaves[i];
      const std::size_t nodes = out_.nodes.size(), pieces = leaves_.size();
      const std::optional<NodeIndex> root =
          std::visit([&](const auto& primitive) { return expand(primitive); }, leaf_->primitive);
      if (!root) {
        out_.nodes.resize(nodes);
        leaves_.resize(pieces);
        continue;
      }
      for (std::size_t n = 0; n < tree_.nodes.size(); ++n) {
        if (tree_.nodes[n].leaf == i) out_.nodes[n] = inner(CsgOperation::unite, {*root});
      }
    }
    out_.leaves.resize(leaves_.size());
    return CsgSolid(out_, std::move(leaves_), std::move(surfaces_));
  }

 private:
  static CsgNode inner(CsgOperation operation, std::vector<NodeIndex> children = {}) {
    return {CsgNode::kInner, operation, std::move(children)};
  }
  NodeIndex add_node(CsgOperation operation) {
    out_.nodes.push_back(inner(operation));
    return NodeIndex(out_.nodes.size() - 1);
  }
  void add_child(NodeIndex parent, NodeIndex child) {
    out_.nodes[parent].children.push_back(child);
  }
  // A leaf of the same placement and material. Nothing: it has no points.
  std::optional<NodeIndex> add_leaf(CsgPrimitive primitive,
                                    const std::vector<CsgHalfSpace>& cuts = {}) {
    std::optional<PlacedLeaf> placed = place_leaf(
        {std::move(primitive), leaf_->object_from_primitive, leaf_->material}, surfaces_);
    if (!placed) return std::nullopt;
    auto& convex = std::get<ConvexLeaf>(placed->shape);
    for (const CsgHalfSpace& cut : cuts) {
      // As a leaf of its own it has the planes that this one needs.
      const std::optional<PlacedLeaf> half =
          place_leaf({cut, leaf_->object_from_primitive, leaf_->material}, surfaces_);
      if (!half) return std::nullopt;
      convex.planes.push_back(std::get<ConvexLeaf>(half->shape).planes[0]);
    }
    out_.nodes.push_back({std::uint32_t(leaves_.size()), CsgOperation::unite, {}});
    leaves_.push_back(std::move(placed));
    return NodeIndex(out_.nodes.size() - 1);
  }
  void add_leaf_to(NodeIndex parent, CsgPrimitive primitive,
                   const std::vector<CsgHalfSpace>& cuts = {}) {
    const std::optional<NodeIndex> leaf = add_leaf(std::move(primitive), cuts);
    if (leaf) add_child(parent, *leaf);
  }

  // The node that stands for the primitive; nothing: it stays.
  template <class Primitive>
  std::optional<NodeIndex> expand(const Primitive& /*primitive*/) {
    return std::nullopt;
  }

  std::optional<NodeIndex> expand(const CsgPrism& prism) {
    if (prism.scale_high.x != prism.scale_high.y) return std::nullopt;
    const std::optional<std::vector<OutlinePart>> parts = find_outline_parts(prism.region);
    if (!parts) return std::nullopt;
    const NodeIndex root = add_node(CsgOperation::unite);
    for (const OutlinePart& part : *parts) add_prism_part(prism, part, root);
    return root;
  }
  void add_prism_part(const CsgPrism& prism, const OutlinePart& part, NodeIndex parent) {
    const NodeIndex node = add_node(CsgOperation::subtract);
    add_child(parent, node);
    add_leaf_to(node, make_prism(prism, part.hull));
    for (const OutlinePart& pocket : part.pockets) add_prism_part(prism, pocket, node);
  }
  static CsgPolyhedron make_prism(const CsgPrism& prism, const std::vector<Vec2d>& polygon) {
    CsgPolyhedron out;
    out.faces.push_back({{0, 0, -1}, -prism.z_low});
    out.faces.push_back({{0, 0, 1}, prism.z_high});
    const double scale = prism.scale_high.x;
    const double growth = (scale - 1) / (prism.z_high - prism.z_low);
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec2d a = polygon[i], b = polygon[(i + 1) % polygon.size()];
      // a·x + b·y = c at z_low, where c grows with the scale.
      Vec3d n{b.y - a.y, a.x - b.x, 0};
      const double c = n.x * a.x + n.y * a.y;
      n.z = -c * growth;
      const double size = length(n);
      out.faces.push_back({n * (1 / size), c * (1 - growth * prism.z_low) / size});
      out.vertices.push_back({a.x, a.y, prism.z_low});
      out.vertices.push_back({a.x * scale, a.y * scale, prism.z_high});
    }
    return out;
  }

  // Heights z are the region's y, distances from the axis its x.
  std::optional<NodeIndex> expand(const CsgRevolution& revolution) {
    const Region region(revolution.region);
    std::vector<double> heights;
    for (const RegionEdge& e : region.edges()) heights.push_back(e.a.y);
    std::ranges::sort(heights);
    const double thin = kThinSlab * (heights.back() - heights.front());
    const NodeIndex root = add_node(CsgOperation::unite);
    for (std::size_t i = 0; i + 1 < heights.size(); ++i) {
      if (heights[i + 1] - heights[i] > thin) {
        add_slab(region, {heights[i], heights[i + 1]}, root);
      }
    }
    return root;
  }
  struct Slab {
    double low = 0, high = 0;
  };
  static double radius_at(const RegionEdge& e, double z) {
    if (z == e.a.y) return e.a.x;
    if (z == e.b.y) return e.b.x;
    return std::max(0.0, e.a.x + (e.b.x - e.a.x) * ((z - e.a.y) / (e.b.y - e.a.y)));
  }
  static CsgCone frustum(const RegionEdge& e, const Slab& slab) {
    return {slab.low, slab.high, radius_at(e, slab.low), radius_at(e, slab.high)};
  }
  // Rings between edges where the outline winds round the inside.
  void add_slab(const Region& region, const Slab& slab, NodeIndex parent) {
    std::vector<RegionEdge> across;
    for (const RegionEdge& e : region.edges()) {
      const bool spans = std::min(e.a.y, e.b.y) <= slab.low && std::max(e.a.y, e.b.y) >= slab.high;
      if (spans && e.a.y != e.b.y) across.push_back(e);
    }
    const double middle = slab.low / 2 + slab.high / 2;
    std::ranges::sort(across, {}, [&](const RegionEdge& e) { return radius_at(e, middle); });
    int winding = 0;
    std::optional<RegionEdge> inner_edge;
    for (const RegionEdge& e : across) {
      const int before = winding;
      winding += e.b.y > e.a.y ? 1 : -1;
      if (before == 0) inner_edge = e;
      if (winding == 0) add_ring(frustum(*inner_edge, slab), frustum(e, slab), parent);
    }
  }
  void add_ring(const CsgCone& hole, const CsgCone& whole, NodeIndex parent) {
    const NodeIndex node = add_node(CsgOperation::subtract);
    add_child(parent, node);
    add_leaf_to(node, whole);
    if (hole.radius_low > 0 || hole.radius_high > 0) add_leaf_to(node, hole);
  }

  // The core; over each face a prism, along each edge the part of a cylinder and about each vertex the part of a
  // sphere that is nearer to it than to the others.
  std::optional<NodeIndex> expand(const CsgRounded& rounded) {
    SurfaceTable unused;
    const std::optional<PlacedLeaf> placed = place_leaf({rounded, {}, {}}, unused);
    if (!placed || !(rounded.radius > 0)) return std::nullopt;
    const auto& leaf = std::get<RoundedLeaf>(placed->shape);
    const NodeIndex root = add_node(CsgOperation::unite);
    add_leaf_to(root, rounded.core);
    for (const RoundedLeaf::Face& face : leaf.faces) add_moved_face(leaf, face, root);
    for (const RoundedLeaf::Edge& edge : leaf.edges) add_rounded_edge(leaf, edge, root);
    for (const Vec3d& vertex : leaf.vertices) add_rounded_vertex(leaf, vertex, root);
    return root;
  }
  void add_moved_face(const RoundedLeaf& leaf, const RoundedLeaf::Face& face, NodeIndex root) {
    CsgPolyhedron prism;
    prism.faces = face.sides;
    prism.faces.push_back({face.plane.normal, face.plane.d + leaf.radius});
    prism.faces.push_back({-face.plane.normal, -face.plane.d});
    for (const Vec3d& v : leaf.vertices) {
      if (!is_on(face.plane, v, leaf)) continue;
      prism.vertices.push_back(v);
      prism.vertices.push_back(v + face.plane.normal * leaf.radius);
    }
    add_leaf_to(root, prism);
  }
  static bool is_on(const CsgHalfSpace& plane, Vec3d p, const RoundedLeaf& leaf) {
    double size = 0;
    for (const Vec3d& v : leaf.vertices) size = std::max(size, length(v - leaf.vertices[0]));
    return std::abs(dot(plane.normal, p) - plane.d) <= 1e-7 * size;
  }
  static bool is_through(const CsgHalfSpace& side, const RoundedLeaf::Edge& edge,
                         const RoundedLeaf& leaf) {
    return is_on(side, edge.a, leaf) && is_on(side, edge.b, leaf);
  }
  static CsgHalfSpace turned(const CsgHalfSpace& h) { return {-h.normal, -h.d}; }

  void add_rounded_edge(const RoundedLeaf& leaf, const RoundedLeaf::Edge& edge, NodeIndex root) {
    std::vector<CsgHalfSpace> cuts;
    for (const RoundedLeaf::Face& face : leaf.faces) {
      for (const CsgHalfSpace& side : face.sides) {
        const bool of_edge = is_on(face.plane, edge.a, leaf) && is_on(face.plane, edge.b, leaf) &&
                             is_through(side, edge, leaf);
        if (of_edge) cuts.push_back(turned(side));
      }
    }
    add_round(root, CsgCone{0, length(edge.b - edge.a), leaf.radius, leaf.radius},
              {turned_to(edge.b - edge.a), edge.a}, cuts);
  }
  void add_rounded_vertex(const RoundedLeaf& leaf, Vec3d vertex, NodeIndex root) {
    std::vector<CsgHalfSpace> cuts;
    for (const RoundedLeaf::Edge& edge : leaf.edges) {
      if (!(edge.a == vertex) && !(edge.b == vertex)) continue;
      const Vec3d along = normalize((edge.a == vertex ? edge.b : edge.a) - vertex);
      cuts.push_back({along, dot(along, vertex)});
    }
    add_round(root, CsgSphere{leaf.radius}, {Mat3d{}, vertex}, cuts);
  }
  // A rotation that takes the z axis there.
  static Mat3d turned_to(Vec3d axis) {
    const Vec3d z = normalize(axis);
    const Vec3d side = std::abs(z.x) < 0.5 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0);
    const Vec3d x = normalize(cross(side, z));
    return {x, cross(z, x), z};
  }
  // A round primitive with a place of its own; `cuts` are in the leaf's frame.
  void add_round(NodeIndex root, CsgPrimitive primitive, const Affine3d& place,
                 const std::vector<CsgHalfSpace>& cuts) {
    const CsgLeaf& whole = *leaf_;
    CsgLeaf placed = whole;
    placed.object_from_primitive = whole.object_from_primitive * place;
    std::vector<CsgHalfSpace> own;  // cuts as the primitive sees them
    for (const CsgHalfSpace& cut : cuts) {
      own.push_back(
          {transpose(place.linear) * cut.normal, cut.d - dot(cut.normal, place.translation)});
    }
    leaf_ = &placed;
    add_leaf_to(root, std::move(primitive), own);
    leaf_ = &whole;
  }

  const CsgTree& tree_;
  CsgTree out_;
  SurfaceTable surfaces_;
  std::vector<std::optional<PlacedLeaf>> leaves_;  // of the tree, then pieces
  const CsgLeaf* leaf_ = nullptr;                  // that is being expanded
};

}  // namespace

CsgSolid make_convex_solid(const CsgTree& tree) {
  return Maker(tree).make();
}

}  // namespace arris
