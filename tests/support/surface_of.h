// surface_of.h — a mesh as the surface that roundings search
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "rounding/solid_surface.h"
#include "support/nonconvex_solids.h"

namespace arris::oracle {

// Each triangle a face of its own.
inline SolidSurface surface_of(const TriangleSoup& mesh, double radius) {
  std::vector<SurfaceTriangle> triangles;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const auto at = [&](std::size_t k) { return Vec3d(mesh.positions[mesh.triangles[i][k]]); };
    triangles.push_back({at(0), at(1), at(2), i, i});
  }
  return {std::move(triangles), radius};
}

}  // namespace arris::oracle
