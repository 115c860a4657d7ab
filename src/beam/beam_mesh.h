// beam_mesh.h — triangles as beams read them
// What       A facet is met by the rays that pass its three edges on the same side; the planes through the eye and an
//            edge are linear in the picture (beam_view.h). Two facets at an edge share them, so that no ray passes
//            between. Nothing is asked of the mesh: it may be open, or meet itself; what is nearest is seen.
// Frames     world space
// Limits     triangles without area are left out: they have no picture
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "csg/csg_expression.h"
#include "csg/leaf_crossings.h"
#include "csg/surfaces.h"

namespace arris {

struct MeshTriangle {
  std::array<Vec3d, 3> corners;
  std::uint32_t number = 0;  // for its owner
};

struct Facet {
  std::uint32_t triangle = 0;           // MeshTriangle::number
  std::array<std::uint32_t, 3> edges{};  // of the mesh
  std::array<bool, 3> turned{};          // the edge runs against the facet's turn
};

// Of facet i the plane is planes()[i], with its normal where the corners turn counter-clockwise.
class BeamMesh {
 public:
  struct Edge {
    Vec3d a, b;
  };

  explicit BeamMesh(const std::vector<MeshTriangle>& triangles);

  [[nodiscard]] const std::vector<Facet>& facets() const { return facets_; }
  [[nodiscard]] const std::vector<CsgPlane>& planes() const { return planes_; }
  [[nodiscard]] const std::vector<Edge>& edges() const { return edges_; }
  [[nodiscard]] const Box3d& box(std::uint32_t facet) const { return boxes_[facet]; }
  [[nodiscard]] const Box3d& bounds() const { return bounds_; }
  // The union of the facets; each stands for what is behind it.
  [[nodiscard]] const CsgExpression& root() const { return root_; }

  // Where the ray meets a facet ahead of its origin.
  [[nodiscard]] std::optional<double> meet(std::uint32_t facet, const Ray& ray) const;

 private:
  std::vector<Facet> facets_;
  std::vector<CsgPlane> planes_;
  std::vector<Edge> edges_;
  std::vector<Box3d> boxes_;
  Box3d bounds_;
  CsgExpression root_;
};

}  // namespace arris
