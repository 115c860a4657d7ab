// obj_objects.h — the objects of an OBJ file, from faces of shared positions, uvs and normals
// What       gathers polygons by object; finish() makes one mesh of each
// Guarantee  each mesh has only the vertices that it needs; vertices appear in the order of their first use
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "arris/scene.h"
#include "geometry/polygon.h"
#include "io/key_index.h"

namespace arris {

// Indices from 0 into the file's positions, texture coordinates and normals; kNone: none given.
struct ObjCorner {
  static constexpr std::int32_t kNone = -1;
  std::int32_t position = 0;
  std::int32_t uv = kNone;
  std::int32_t normal = kNone;
  friend bool operator==(const ObjCorner&, const ObjCorner&) = default;
};

// What an OBJ file's v, vt and vn lines say.
struct ObjPool {
  std::vector<Vec3f> positions;
  std::vector<Vec2f> uvs;
  std::vector<Vec3f> normals;  // of any length
};

class ObjObjects {
 public:
  // Statement "o": faces that follow are of a new object, whatever its name.
  void start_object(std::string_view name);
  // Statement "g": of the group of this name, unless the file has objects.
  void start_group(std::string_view name);
  // False if there are kMaxObjects already.
  [[nodiscard]] bool has_room() const;

  // False if the polygons so far are too intricate to cut into triangles.
  [[nodiscard]] bool add(std::span<const ObjCorner> corners, std::uint32_t material,
                         const ObjPool& pool);

  [[nodiscard]] bool empty() const { return parts_.empty(); }
  // Adds the objects to the scene; `materials`: by the numbers given to add().
  void finish(const ObjPool& pool, std::span<const MaterialId> materials, Scene& scene);

 private:
  struct Part {
    std::string name;
    KeyIndex<ObjCorner> corners;
    std::vector<Triangle> triangles;
    std::vector<std::uint32_t> materials;  // one per triangle
  };
  static constexpr std::size_t kNoPart = ~std::size_t(0);

  Part& current_part();

  std::vector<Part> parts_;  // those with faces
  std::map<std::string, std::size_t, std::less<>> groups_;
  std::string name_;  // of the current part
  std::size_t current_ = kNoPart;
  bool has_objects_ = false;
  PolygonTriangulator triangulator_;
  std::vector<Vec3f> polygon_;
};

}  // namespace arris
