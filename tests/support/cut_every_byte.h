// cut_every_byte.h — a reader against every prefix of a file and against changed bytes
// What       cut_every_byte(file, read) gives read() each prefix, change_every_byte(file, read) the
// file
//            with one byte set to each of a few values
// Guarantee  the test fails unless each call returns a sound scene or throws one arris::Error of
// kind
//            input with a one-line message; each input is a heap copy of its exact size, so that
//            the address sanitizer sees a read past its end
// Legend     read: Scene(std::span<const std::uint8_t>)
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <exception>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "arris/error.h"
#include "arris/scene.h"

namespace arris::test {

inline std::vector<std::uint8_t> bytes_of(std::string_view text) {
  return {text.begin(), text.end()};
}

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
  for (const Object& object : scene.objects) {
    if (object.mesh.index >= scene.meshes.size()) return "an object's mesh id";
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

template <class Read>
void cut_every_byte(std::span<const std::uint8_t> file, Read&& read) {
  for (std::size_t size = 0; size <= file.size(); ++size) {
    ASSERT_EQ(problem_of_reading(file.first(size), read), "") << "cut after " << size << " bytes";
  }
}

template <class Read>
void change_every_byte(std::span<const std::uint8_t> file, Read&& read) {
  std::vector<std::uint8_t> changed(file.begin(), file.end());
  for (std::size_t i = 0; i < changed.size(); ++i) {
    const std::uint8_t old = changed[i];
    for (const int value : {0, 1, 0x7F, 0x80, 0xFF, old ^ 1, old ^ 0x80, int(' '), int('\n'),
                            int('-'), int('9'), int('"'), int('/')}) {
      changed[i] = std::uint8_t(value);
      ASSERT_EQ(problem_of_reading(changed, read), "") << "byte " << i << " set to " << value;
    }
    changed[i] = old;
  }
}

}  // namespace arris::test
