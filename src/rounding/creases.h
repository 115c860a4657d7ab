// creases.h — the creases of a solid's erosion, whatever its shape
// What       E, the points of a solid P at distance r or more from its surface, is bounded by offsets of P's features:
//            planes of faces, cylinders about concave edges, spheres about concave corners. Where two of these meet E
//            has a crease, and opening(P) is P's kept faces and the balls of radius r around the creases. Each pair
//            of features within reach gives a curve (crease_curve.h), which is cut wherever it may begin or cease to
//            be on E; a piece stays if its middle is r from both features and no nearer to anything else.
// In / Out   coordinates relative to the solid's centre
// Guarantee  every point of a crease lies in E: balls around it hold nothing that is not in opening(P), so that a
//            crease too many does no harm
// Limits     two concave edges that don't meet, or a corner and an edge, within 2 r of each other give no curve: walls
//            between them are thinner than 2 r and vanish but for what other creases hold
// Cost       about linear in the pairs of features within 2 r of each other, times the triangles that are near both
#pragma once

#include <cstdint>
#include <optional>
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
  std::span<const EdgeKind> kinds;  // per half-edge
  const SolidSurface& surface;      // of the shell
  Vec3d center;                     // of the shell
  double size = 0;                  // of the shell
  double radius = 0;
};

// Nothing: a convex edge has no crease. The radius is too large for what lies beside it, or more is taken away than
// edges.
std::optional<std::vector<CreaseCurve>> find_creases(const CreaseInput& input, std::uint32_t shell);

}  // namespace arris
