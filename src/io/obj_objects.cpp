#include "io/obj_objects.h"

#include <algorithm>
#include <utility>

#include "io/mesh_scene.h"

namespace arris {
namespace {

// Unit, or zero if the vector has no direction.
Vec3f unit_or_zero(Vec3d v) {
  const Vec3d unit = normalize(v);
  return is_finite(unit) ? Vec3f(unit) : Vec3f(0.0F);
}

// The triangle's own normal for corners without one: each triangle gets a vertex of its own there, the
// first one the vertex itself.
void fill_missing_normals(Mesh& mesh) {
  enum class State : std::uint8_t { given, missing, taken };
  std::vector<State> states;
  for (const Vec3f& normal : mesh.normals) {
    states.push_back(normal == Vec3f(0.0F) ? State::missing : State::given);
  }
  for (Triangle& triangle : mesh.triangles) {
    const Vec3d a(mesh.positions[triangle[0]]), b(mesh.positions[triangle[1]]),
        c(mesh.positions[triangle[2]]);
    Vec3f flat = unit_or_zero(cross(b - a, c - a));
    if (flat == Vec3f(0.0F)) flat = Vec3f(0, 0, 1);  // a triangle without area: never seen
    for (std::uint32_t& vertex : triangle) {
      if (states[vertex] == State::given) continue;
      if (states[vertex] == State::missing) {
        states[vertex] = State::taken;
        mesh.normals[vertex] = flat;
        continue;
      }
      const std::uint32_t old = std::exchange(vertex, std::uint32_t(mesh.positions.size()));
      mesh.positions.push_back(Vec3f(mesh.positions[old]));
      if (!mesh.uvs.empty()) mesh.uvs.push_back(Vec2f(mesh.uvs[old]));
      mesh.normals.push_back(flat);
      states.push_back(State::given);
    }
  }
}

// The arrays that at least one corner asks for.
Mesh make_mesh(const std::vector<ObjCorner>& corners, const ObjPool& pool) {
  Mesh mesh;
  const auto has_uv = [](const ObjCorner& c) { return c.uv != ObjCorner::kNone; };
  const auto has_normal = [](const ObjCorner& c) { return c.normal != ObjCorner::kNone; };
  const bool uvs = std::any_of(corners.begin(), corners.end(), has_uv);
  const bool normals = std::any_of(corners.begin(), corners.end(), has_normal);
  mesh.positions.reserve(corners.size());
  for (const ObjCorner& corner : corners) {
    mesh.positions.push_back(pool.positions[std::size_t(corner.position)]);
    if (uvs) mesh.uvs.push_back(has_uv(corner) ? pool.uvs[std::size_t(corner.uv)] : Vec2f{0, 1});
    if (!normals) continue;
    mesh.normals.push_back(has_normal(corner)
                               ? unit_or_zero(Vec3d(pool.normals[std::size_t(corner.normal)]))
                               : Vec3f(0.0F));
  }
  return mesh;
}

}  // namespace

void ObjObjects::start_object(std::string_view name) {
  has_objects_ = true;
  name_ = name;
  current_ = kNoPart;
}

void ObjObjects::start_group(std::string_view name) {
  if (has_objects_) return;
  name_ = name;
  const auto known = groups_.find(name);
  current_ = known == groups_.end() ? kNoPart : known->second;
}

bool ObjObjects::has_room() const {
  return current_ != kNoPart || parts_.size() < kMaxObjects;
}

ObjObjects::Part& ObjObjects::current_part() {
  if (current_ == kNoPart) {
    current_ = parts_.size();
    parts_.emplace_back().name = name_;
    if (!has_objects_) groups_.emplace(name_, current_);
  }
  return parts_[current_];
}

bool ObjObjects::add(std::span<const ObjCorner> corners, std::uint32_t material,
                     const ObjPool& pool) {
  polygon_.clear();
  for (const ObjCorner& corner : corners) {
    polygon_.push_back(pool.positions[std::size_t(corner.position)]);
  }
  const std::span<const Triangle> triangles = triangulator_.triangulate(polygon_);
  if (triangles.empty()) return false;
  Part& part = current_part();
  for (const Triangle& triangle : triangles) {
    part.triangles.push_back({part.corners.add(corners[triangle[0]]),
                              part.corners.add(corners[triangle[1]]),
                              part.corners.add(corners[triangle[2]])});
    part.materials.push_back(material);
  }
  return true;
}

void ObjObjects::finish(const ObjPool& pool, std::span<const MaterialId> materials, Scene& scene) {
  for (Part& part : parts_) {
    Mesh mesh = make_mesh(part.corners.keys(), pool);
    mesh.name = part.name.empty() ? scene.name : part.name;
    mesh.triangles = std::move(part.triangles);
    if (!mesh.normals.empty()) fill_missing_normals(mesh);
    const std::uint32_t first = part.materials.front();
    const bool mixed = std::any_of(part.materials.begin(), part.materials.end(),
                                   [&](std::uint32_t material) { return material != first; });
    if (mixed) {
      for (const std::uint32_t material : part.materials) {
        mesh.triangle_materials.push_back(materials[material]);
      }
    }
    part = Part{};  // its memory is not needed any more
    add_object(scene, std::move(mesh));
    scene.objects.back().material = materials[first];
  }
  parts_.clear();
}

}  // namespace arris
