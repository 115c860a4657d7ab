// csg_shadows.h — where shadow events meet solids of solids
// What       follows rays along each event from its beginning to the first surface of the solid, and joins those that
//            meet the same face
// In / Out   world coordinates
//            Of area lights the penumbra is that of a receiver that lies as the light does.
// Guarantee  every piece lies on the solid, within the chord of a step (tests/render/rounded_shadow_test.cpp)
// Limits     events of one light point only, not those of a vertex and an edge of an area light. What else lies between
//            the event and the solid hides nothing, nor does the solid: edges may be shown where none are.
// Cost       some rays for each event, by its length
#pragma once

#include <span>
#include <vector>

#include "edgepoint/edge_raster.h"
#include "edgepoint/shadow_events.h"
#include "render/csg_edges.h"

namespace arris {

std::vector<SoftEdge> find_edges_on_solid(std::span<const ShadowEvent> events,
                                          const CsgEdges& solid, const Affine3d& world);

}  // namespace arris
