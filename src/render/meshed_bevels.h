// meshed_bevels.h — objects whose rounding is explicit geometry
// What       puts a bevel mesh (rounding/bevel_mesh.h) in the place of the mesh of every object whose rounding method
//            is `mesh`. The described meshes stay, so that another rounding can be prepared from them. Objects that
//            share a mesh, and radius over scale, share a bevel mesh; an object that its transform shears or
//            scales unevenly gets its own, in world axes about its origin.
// Errors     Error{input} naming the object, if a radius doesn't fit
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "arris/render.h"
#include "arris/scene.h"

namespace arris {

struct MeshedBevels {
  std::vector<Object> described_objects;  // as they were; empty if nothing was meshed
  std::size_t described_meshes = 0;       // bevel meshes follow them
  double seconds = 0;
  std::uint64_t edges = 0, corners = 0;
  std::vector<RoundingSummary> summaries;
};

// Precondition: a valid scene with a camera.
MeshedBevels mesh_bevels(Scene& scene, const std::optional<RoundingSettings>& scene_default,
                         int threads);

// The scene as it was before mesh_bevels().
Scene described_scene(Scene scene, const MeshedBevels& meshed);

// Memory of a mesh's arrays.
std::uint64_t bytes_of(const Mesh& mesh);

}  // namespace arris
