// step_mesh.h — solids of Open CASCADE as meshes
// What       faces are cut into triangles so fine that a smooth surface stays within kDeflection of the part's size
//            and turns by about kAngleInside at most from triangle to triangle, well below the angle from which an edge
//            is sharp; normals are those of the surfaces
// Guarantee  faces that share an edge share the points on it, so that solids are closed (tests/io/step_test.cpp)
// Limits     faces that Open CASCADE can't cut are left out and counted
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "arris/scene.h"

class TopoDS_Face;
class TopoDS_Shape;

namespace arris::step {

inline constexpr double kDeflection = 0.0005;  // of the diagonal of the part's box
inline constexpr double kAngle = 0.15;         // from piece to piece of an edge
inline constexpr double kAngleInside =
    0.3;  // and within a face, where half of it costs thrice the triangles

// Gives all faces of the shape their triangles.
void tessellate(const TopoDS_Shape& part);

struct PartMesh {
  Mesh mesh;
  std::optional<MaterialId> material;  // of all faces
  std::size_t missing_faces = 0;
};
// Of a tessellated shape. Empty: the object's material.
using MaterialOfFace = std::function<std::optional<MaterialId>(const TopoDS_Face&)>;
PartMesh make_mesh(const std::vector<TopoDS_Face>& faces, const MaterialOfFace& material_of);

}  // namespace arris::step
