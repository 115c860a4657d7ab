// gltf_mesh.h — glTF meshes as triangles
// What       one Mesh for each glTF mesh: its primitives are joined, so that a solid with several
//            materials stays one solid; materials go with the triangles. Edges of triangles get the smaller
//            _ARRIS_RADIUS of their ends as a radius, if both have one
// Guarantee  positions and uvs are finite, normals unit, indices in range; only vertices that
//            triangles use are kept
// Limits     points and lines are left out with a note. Normals that are missing in some of a mesh's
//            primitives, zero or not finite are replaced by those of the triangles.
// Errors     kind input, naming mesh, primitive and vertex
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/gltf_buffers.h"

namespace arris {

// Which coordinates a material's textures use: Mesh has room for one set.
struct GltfUvChoice {
  std::uint32_t set = 0;
  GltfUvTransform transform;
  bool needed = false;  // the material has textures
};

struct GltfMeshes {
  std::vector<Mesh> meshes;  // one per glTF mesh; no triangles: nothing to show
  std::vector<std::string> notes;
};

// `uv_choices` by material; a primitive without material gets the id after the last.
GltfMeshes make_gltf_meshes(const GltfSource& source, const std::vector<GltfUvChoice>& uv_choices);

}  // namespace arris
