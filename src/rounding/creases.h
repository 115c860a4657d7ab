// creases.h — the creases of a solid's erosion, whatever its shape
// What       E, the points of a solid P at distance r or more from its surface, is bounded by offsets of P's features:
//            planes of faces, cylinders about concave edges, spheres about concave corners. Where two of these meet E
//            has a crease, and opening(P) is P's kept faces and the balls of radius r around the creases. Each pair
//            of features whose offsets cross gives a curve (crease_curve.h), and the parts of it that are on E are
//            creases (crease_cutter.h).
// In / Out   coordinates relative to the solid's centre
// Guarantee  every point of a crease lies in E: balls around it hold nothing that is not in opening(P), so that a
//            crease too many does no harm
// Cost       about linear in the pairs of triangles whose offsets cross, times the triangles within r of their crease;
//            on all cores
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "edges/flat_regions.h"
#include "edges/welded_mesh.h"
#include "rounding/crease_curve.h"
#include "rounding/solid_surface.h"

namespace arris {

// A point this much nearer to the surface than r is in E all the same: corners of triangles lie beside their faces'
// planes by so much, and what is computed from them by a little of the radius.
inline double crease_tolerance(double size, double radius) {
  return 2 * kPlaneTolerance * size + 1e-6 * radius;
}

struct CreaseInput {
  const WeldedMesh& mesh;
  const FlatRegions& regions;
  std::span<const EdgeKind> kinds;        // per half-edge
  std::span<const std::uint32_t> shells;  // of one solid
  const SolidSurface& surface;            // of all these
  Vec3d center;                           // of the outermost
  double size = 0;                        // of the outermost
  double radius = 0;
};

struct FoundCreases {
  std::vector<CreaseCurve> curves;
  // Sorted: faces between which convex edges have none, and are no short pieces of a curved rim. The radius is too
  // large for what lies beside them.
  std::vector<FacePair> missing;
};

// Convex edges are sharp ones; smooth edges that bend in are concave ones all the same, and creases within one curved
// surface (SolidSurface::is_joined) are made at faces that have others.
FoundCreases find_creases(const CreaseInput& input);

}  // namespace arris
