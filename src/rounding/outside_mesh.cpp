#include "rounding/outside_mesh.h"

#include <cstdint>
#include <utility>

namespace arris {
namespace {

EdgeKind turned_kind(EdgeKind kind) {
  if (kind == EdgeKind::convex) return EdgeKind::concave;
  return kind == EdgeKind::concave ? EdgeKind::convex : kind;
}

}  // namespace

OutsideMesh turn_inside_out(const WeldedMesh& welded, const FlatRegions& regions,
                            std::span<const EdgeKind> kinds) {
  OutsideMesh out{welded, regions, std::vector<EdgeKind>(kinds.size())};
  for (Triangle& t : out.welded.triangles) std::swap(t[1], t[2]);
  for (std::uint32_t h = 0; h < kinds.size(); ++h) {
    const std::uint32_t twin = welded.twin[h];
    out.welded.twin[turned_edge(h)] = twin <= kLastHalfEdge ? turned_edge(twin) : twin;
    out.kinds[turned_edge(h)] = turned_kind(kinds[h]);
  }
  for (Plane& plane : out.regions.planes) plane = {-plane.normal, -plane.d};
  return out;
}

}  // namespace arris
