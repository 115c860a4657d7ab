// beam_solid.h — what may be seen: a CSG solid where it stands, or the triangles of a mesh
#pragma once

#include <cstdint>
#include <variant>
#include <vector>

#include "beam/beam_mesh.h"
#include "csg/csg_solid.h"

namespace arris {

// Leaves and surfaces are numbered as in the CsgSolid; those of a mesh are its facets and their planes.
struct BeamSolid {
  const CsgSolid* solid = nullptr;
  Affine3d object_from_world;
  const BeamMesh* mesh = nullptr;  // if it is one, `solid` is null and the placement none

  [[nodiscard]] const std::vector<CsgPlane>& planes() const {
    return mesh != nullptr ? mesh->planes() : solid->surfaces().planes();
  }
  [[nodiscard]] const CsgExpression& root() const {
    return mesh != nullptr ? mesh->root() : solid->root();
  }
  [[nodiscard]] const Box3d& bounds() const {
    return mesh != nullptr ? mesh->bounds() : solid->bounds();
  }
  [[nodiscard]] std::size_t leaf_count() const {
    return mesh != nullptr ? mesh->facets().size() : solid->leaf_count();
  }
  [[nodiscard]] const Box3d& leaf_box(std::uint32_t leaf) const {
    return mesh != nullptr ? mesh->box(leaf) : solid->leaf(leaf).bounds;
  }
  [[nodiscard]] const CsgQuadric& quadric(std::uint32_t index) const {
    return solid->surfaces().quadrics()[index];
  }
  // Null: a facet, or not convex.
  [[nodiscard]] const ConvexLeaf* convex(std::uint32_t leaf) const {
    return mesh != nullptr ? nullptr : std::get_if<ConvexLeaf>(&solid->leaf(leaf).shape);
  }
  [[nodiscard]] bool is_flat(std::uint32_t leaf, std::uint32_t face) const {
    return mesh != nullptr || (convex(leaf) != nullptr && face < convex(leaf)->planes.size());
  }
  [[nodiscard]] bool is_whole(std::uint32_t leaf) const {
    return mesh == nullptr && convex(leaf) == nullptr;
  }
};

}  // namespace arris
