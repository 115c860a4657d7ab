// mesh_scene.h — what the readers of plain mesh files share: scenes of named meshes
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "arris/error.h"
#include "arris/scene.h"

namespace arris {

// Each object costs far more memory than the line that makes it.
inline constexpr std::size_t kMaxObjects = std::size_t(1) << 18;
inline constexpr std::size_t kMaxNameBytes = 1000;
// Vertex and triangle numbers are 32 bits wide.
inline constexpr std::size_t kMaxCorners = 0xFFFF'FFFEU;

// An empty scene with one material, "default".
Scene make_mesh_scene(const std::string& file);

// The file's name without folder and extension: the name of an object that has none.
std::string name_from_file(const std::string& file);

// What is wrong with an object's or material's name: not UTF-8, too long, control
// characters. Empty if nothing is.
std::string problem_with_name(std::string_view name);

// Adds the mesh and an object of its name with the material of number 0.
void add_object(Scene& scene, Mesh mesh);

}  // namespace arris
