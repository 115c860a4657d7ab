// edge_marks.h — which edges of a tessellated solid are sharp
// What       an edge between two faces is sharp where their surfaces' normals differ on it by kSharpTurn or more; all
//            else is smooth, also within a face: fillets stay smooth however coarse their triangles are, and chamfers
//            sharp however little they turn
// In         the faces of one solid with their first vertices in the mesh, whose normals are those of the surfaces
// Limits     a kink within one face counts as smooth
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <TopoDS_Face.hxx>

#include "arris/scene.h"

namespace arris::step {

// CAD programs join faces smoothly to within a degree or so.
inline constexpr double kSharpTurn = radians(3);

struct PlacedFace {
  TopoDS_Face face;
  std::uint32_t first_vertex = 0;  // that of its triangulation's first node
};

std::vector<VertexPair> find_sharp_edges(std::span<const PlacedFace> faces, const Mesh& mesh);

}  // namespace arris::step
