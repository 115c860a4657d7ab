// beam_shape.h — a solid or a mesh as beams read it
// What       An expression over leaves of three kinds:
//            - those of a CsgSolid made of convex leaves (convex_solid.h); some stay that are not convex;
//            - facets: triangles, each of which stands for what is behind it as the eye or a light sees it. A ray meets
//              a facet if it passes its three edges on one side; the planes through the eye and an edge are linear in
//              the picture (beam_view.h), and two facets at an edge share them, so that no ray passes between;
//            - volumes: all of space if the eye, or the light, is inside a closed mesh, else nothing.
//            A closed mesh among other leaves is the parity of its volume and its facets. A mesh by itself is the union
//            of its facets: it may be open, or meet itself, and what is nearest is seen.
// Frames     the shape's own space
// Limits     triangles without area are left out: they have no picture
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <variant>
#include <vector>

#include "beam/leaf_tree.h"
#include "csg/csg_solid.h"

namespace arris {

// In the expressions of what a mirror shows: where rays begin, which is beyond the mirror's plane (beam_mirror.h).
inline constexpr std::uint32_t kStartLeaf = ~std::uint32_t{0};

struct MeshTriangle {
  std::array<Vec3d, 3> corners;
  std::uint32_t number = 0;  // for its owner
};

struct Facet {
  PlaneRef plane;  // not flipped: its normal is where the corners turn counter-clockwise
  std::array<std::uint32_t, 3> edges{};  // of the shape
  std::array<bool, 3> turned{};          // the edge runs against the facet's turn
  std::uint32_t triangle = 0;            // MeshTriangle::number, or that of the CSG leaf's mesh
  std::uint32_t source = 0;              // the CSG leaf
};

class BeamShape {
 public:
  struct Edge {
    Vec3d a, b;
  };

  // Errors: as CsgSolid.
  explicit BeamShape(const CsgTree& tree);
  explicit BeamShape(std::span<const MeshTriangle> triangles);
  BeamShape(const BeamShape&) = delete;
  BeamShape(BeamShape&&) = default;

  [[nodiscard]] const CsgExpression& root() const { return root_; }
  [[nodiscard]] const Box3d& bounds() const { return bounds_; }
  [[nodiscard]] const std::vector<CsgPlane>& planes() const { return planes_; }
  [[nodiscard]] const std::vector<CsgQuadric>& quadrics() const {
    return csg_.surfaces().quadrics();
  }
  [[nodiscard]] const std::vector<Edge>& edges() const { return edges_; }

  // Leaves: those of csg(), then the facets, then the volumes.
  [[nodiscard]] const CsgSolid& csg() const { return csg_; }
  [[nodiscard]] std::size_t leaf_count() const { return first_volume() + volumes_.size(); }
  [[nodiscard]] std::size_t facet_count() const { return facets_.size(); }
  [[nodiscard]] const Box3d& leaf_box(std::uint32_t leaf) const;
  [[nodiscard]] bool is_mesh() const { return csg_.leaf_count() == 0; }
  // Null: another kind of leaf.
  [[nodiscard]] const ConvexLeaf* convex(std::uint32_t leaf) const {
    return leaf < csg_.leaf_count() ? std::get_if<ConvexLeaf>(&csg_.leaf(leaf).shape) : nullptr;
  }
  [[nodiscard]] const Facet* facet(std::uint32_t leaf) const {
    return leaf >= csg_.leaf_count() && leaf < first_volume() ? &facets_[leaf - csg_.leaf_count()]
                                                              : nullptr;
  }
  [[nodiscard]] const ClosedMesh* volume(std::uint32_t leaf) const {
    return leaf >= first_volume() && leaf < leaf_count() ? volumes_[leaf - first_volume()]
                                                         : nullptr;
  }
  // One of csg() that is not convex.
  [[nodiscard]] bool is_whole(std::uint32_t leaf) const {
    return leaf < csg_.leaf_count() && convex(leaf) == nullptr;
  }
  [[nodiscard]] bool is_flat(std::uint32_t leaf, std::uint32_t face) const {
    return facet(leaf) != nullptr ||
           (convex(leaf) != nullptr && face < convex(leaf)->planes.size());
  }

  // Of root(), what matters where meets(box) holds for each box around the place.
  [[nodiscard]] CsgExpression root_near(const std::function<bool(const Box3d&)>& meets) const {
    return tree_.near(meets);
  }
  // Where the ray meets a facet ahead of its origin.
  [[nodiscard]] std::optional<double> meet(const Facet& facet, const Ray& ray) const;

 private:
  using EdgePlaces = std::map<std::array<double, 6>, std::uint32_t>;

  [[nodiscard]] std::size_t first_volume() const { return csg_.leaf_count() + facets_.size(); }
  void make_tree();
  // False: it has no area.
  bool add_facet(const MeshTriangle& triangle, PlaneRef plane, EdgePlaces& known);

  CsgSolid csg_;
  std::vector<CsgPlane> planes_;
  std::vector<Facet> facets_;
  std::vector<Box3d> boxes_;  // of facets
  std::vector<Edge> edges_;
  std::vector<const ClosedMesh*> volumes_;
  Box3d bounds_;
  CsgExpression root_;
  LeafTree tree_;
};

// Where it stands.
struct BeamSolid {
  const BeamShape* shape = nullptr;
  Affine3d object_from_world;
};

// A plane or quadric of one solid's table.
struct BeamSurface {
  // What a ray does at a quadric: enters from outside at the nearer root, leaves it again at the farther one; leaves
  // it having started inside; enters a cone's half having started in the other half.
  // whole: the surface of a leaf that is not convex, and `index` is the leaf.
  enum class Root : std::uint8_t { none, nearer, farther, leaving, other_half, whole };
  std::uint32_t solid = 0, index = 0;
  Root root = Root::none;  // none: a plane

  friend bool operator==(const BeamSurface&, const BeamSurface&) = default;
  [[nodiscard]] bool is_plane() const { return root == Root::none; }
  [[nodiscard]] bool is_whole() const { return root == Root::whole; }
  // The same plane, or the same quadric.
  [[nodiscard]] bool lies_on(const BeamSurface& other) const {
    return solid == other.solid && index == other.index && is_plane() == other.is_plane() &&
           is_whole() == other.is_whole();
  }
};

}  // namespace arris
