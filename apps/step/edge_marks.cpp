#include "step/edge_marks.h"

#include <BRep_Tool.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <algorithm>
#include <cmath>
#include <cstddef>

namespace arris::step {
namespace {

// An edge as one face's triangulation has it: vertices of the mesh.
using Chain = std::vector<std::uint32_t>;

Chain chain_of(const TopoDS_Edge& edge, const PlacedFace& placed) {
  TopLoc_Location location;
  const opencascade::handle<Poly_Triangulation> triangulation =
      BRep_Tool::Triangulation(placed.face, location);
  if (triangulation.IsNull()) return {};
  const opencascade::handle<Poly_PolygonOnTriangulation> polygon =
      BRep_Tool::PolygonOnTriangulation(edge, triangulation, location);
  if (polygon.IsNull()) return {};
  Chain chain;
  for (int i = 1; i <= polygon->NbNodes(); ++i) {
    chain.push_back(placed.first_vertex + std::uint32_t(polygon->Node(i) - 1));
  }
  return chain;
}

double turn_between(const Mesh& mesh, std::uint32_t a, std::uint32_t b) {
  const Vec3d na(mesh.normals[a]), nb(mesh.normals[b]);
  return std::atan2(length(cross(na, nb)), dot(na, nb));
}

// Of two faces at one edge.
void add_sharp_pieces(const Mesh& mesh, const Chain& a, Chain b, std::vector<VertexPair>& sharp) {
  const bool known = a.size() == b.size();
  if (known && mesh.positions[a.front()] != mesh.positions[b.front()]) std::ranges::reverse(b);
  for (std::size_t i = 0; i + 1 < a.size(); ++i) {
    // What can't be compared counts as sharp.
    if (known && std::max(turn_between(mesh, a[i], b[i]), turn_between(mesh, a[i + 1], b[i + 1])) <
                     kSharpTurn) {
      continue;
    }
    sharp.push_back({a[i], a[i + 1]});
  }
}

}  // namespace

std::vector<VertexPair> find_sharp_edges(std::span<const PlacedFace> faces, const Mesh& mesh) {
  TopTools_IndexedMapOfShape edges;  // whichever way round
  std::vector<std::vector<Chain>> chains;
  for (const PlacedFace& placed : faces) {
    for (TopExp_Explorer e(placed.face, TopAbs_EDGE); e.More(); e.Next()) {
      const TopoDS_Edge& edge = TopoDS::Edge(e.Current());
      if (BRep_Tool::Degenerated(edge)) continue;
      const auto number = std::size_t(edges.Add(edge)) - 1;
      if (number == chains.size()) chains.emplace_back();
      if (Chain chain = chain_of(edge, placed); chain.size() >= 2) {
        chains[number].push_back(std::move(chain));
      }
    }
  }
  std::vector<VertexPair> sharp;
  for (const std::vector<Chain>& uses : chains) {
    for (std::size_t i = 1; i < uses.size(); ++i) {
      add_sharp_pieces(mesh, uses[i - 1], uses[i], sharp);
    }
  }
  return sharp;
}

}  // namespace arris::step
