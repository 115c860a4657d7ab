// reading_problem.h — what is wrong with how a reader takes some bytes
// Guarantee  problem_of_reading() is empty only if read() returns a sound scene or throws one
//            arris::Error of kind input with a place and a message of one line; read() gets a heap copy of
//            the exact size, so that the address sanitizer sees a read past its end
// Legend     read: Scene(std::span<const std::uint8_t>)
#pragma once

#include <cmath>
#include <cstdint>
#include <exception>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "arris/error.h"
#include "arris/scene.h"
#include "scene/validate_csg.h"

namespace arris::test {

// What is unsound in a mesh; empty if nothing is.
inline std::string problem_of(const Mesh& mesh, const Scene& scene) {
  if (mesh.triangles.empty()) return "a mesh without triangles";
  for (const Vec3f& position : mesh.positions) {
    if (!is_finite(position)) return "a position that is not finite";
  }
  for (const Triangle& triangle : mesh.triangles) {
    for (const std::uint32_t vertex : triangle) {
      if (vertex >= mesh.positions.size()) return "a vertex index out of range";
    }
  }
  if (!mesh.normals.empty() && mesh.normals.size() != mesh.positions.size())
    return "normals' count";
  for (const Vec3f& normal : mesh.normals) {
    if (!(std::abs(length(normal) - 1) < 1e-4F)) return "a normal that is not unit";
  }
  if (!mesh.uvs.empty() && mesh.uvs.size() != mesh.positions.size()) return "uvs' count";
  if (!mesh.triangle_materials.empty() && mesh.triangle_materials.size() != mesh.triangles.size()) {
    return "triangle_materials' count";
  }
  for (const MaterialId id : mesh.triangle_materials) {
    if (id.index >= scene.materials.size()) return "a triangle's material id";
  }
  return "";
}

// What is unsound in a loaded scene; empty if nothing is.
inline std::string problem_of(const Scene& scene) {
  if (scene.materials.empty()) return "no material";
  for (const Mesh& mesh : scene.meshes) {
    if (const std::string problem = problem_of(mesh, scene); !problem.empty()) return problem;
  }
  std::vector<std::string> problems;
  for (std::size_t i = 0; i < scene.csg_trees.size(); ++i) check_csg_tree(scene, i, problems);
  if (!problems.empty()) return problems[0];
  for (const Object& object : scene.objects) {
    if (object.csg && object.csg->index >= scene.csg_trees.size()) return "an object's CSG id";
    if (!object.csg && object.mesh.index >= scene.meshes.size()) return "an object's mesh id";
    if (object.material.index >= scene.materials.size()) return "an object's material id";
  }
  return "";
}

// What is wrong with how read() takes the bytes; empty if nothing is.
template <class Read>
std::string problem_of_reading(std::span<const std::uint8_t> bytes, Read&& read) {
  const std::vector<std::uint8_t> copy(bytes.begin(), bytes.end());
  try {
    return problem_of(read(std::span<const std::uint8_t>(copy)));
  } catch (const Error& error) {
    const std::string_view message = error.what();
    if (error.kind() != Error::Kind::input) return "kind is not input: " + std::string(message);
    if (error.where().empty()) return "no place named: " + std::string(message);
    for (const char c : message) {
      if (std::uint8_t(c) < 0x20 || c == 0x7F)
        return "control character in " + std::string(message);
    }
  } catch (const std::exception& exception) {
    return std::string("not an arris::Error: ") + exception.what();
  }
  return "";
}

}  // namespace arris::test
