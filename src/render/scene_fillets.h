// scene_fillets.h — the fillets of all objects, as a ray meets them
// What       Fillets of concave edges lie before the mesh, and at their ends a ray may pass one without meeting the
//            mesh (arris/rounding.h): their boxes, in a tree of the world, are looked through beside the meshes
// Cost       a ray that comes near no fillet visits a few boxes
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "arris/rounding.h"
#include "rounding/box_tree.h"

namespace arris {

struct RoundedGeometry;
struct TraceRay;

class SceneFillets {
 public:
  SceneFillets() : tree_({}) {}
  explicit SceneFillets(std::span<const RoundedGeometry> geometries);

  [[nodiscard]] bool is_empty() const { return places_.empty(); }

  struct Met {
    std::uint32_t geometry = 0, triangle = 0;  // a triangle beside the fillet
    RoundedHit hit;                            // normal in world space
  };
  // The nearest on the ray, before t_max. `geometries` as when it was made.
  [[nodiscard]] std::optional<Met> meet(std::span<const RoundedGeometry> geometries,
                                        const TraceRay& ray, double t_max) const;

 private:
  struct Place {
    std::uint32_t geometry, box;  // of Rounding::fillet_boxes()
  };
  std::vector<Place> places_;
  BoxTree tree_;
};

}  // namespace arris
