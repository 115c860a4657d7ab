// creased_hit.h — what becomes of a hit on the mesh of a solid that is rounded by what balls fit
// What       By searches of its surface and pipes (creased_solid.h), the same for the space outside where it has
//            fillets; most hits need none, as they lie beside a plain stretch of a crease (plain_crease.h)
#pragma once

#include <cstdint>
#include <optional>

#include "arris/rounding.h"
#include "rounding/rounding_data.h"

namespace arris {

struct FaceHit {
  std::uint32_t face;
  Vec3d direction;  // unit
  double scale;     // length of the ray's direction
  double t;         // refined
  Vec3d x;          // relative to the solid's centre
};

struct CreasedEvent {
  const FaceHit& at;
  const Ray& ray;
  const MeshHit& hit;
  RayStart start;
};

// Nothing: the local network decides.
std::optional<Resolution> resolve_creased(const Rounding::Data& data, const Solid& solid,
                                          const CreasedEvent& event);

}  // namespace arris
