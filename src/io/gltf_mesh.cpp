#include "io/gltf_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "arris/error.h"
#include "io/edge_radii.h"

namespace arris {
namespace {

// What one vertex and its share of a triangle take in memory, rounded up.
constexpr std::uint64_t kBytesPerCorner = 64;
// The same of radii of edges.
constexpr std::uint64_t kRadiusBytesPerCorner = 32;

Vec2f apply(const GltfUvTransform& transform, Vec2f uv) {
  const double c = std::cos(transform.rotation), s = std::sin(transform.rotation);
  const double u = uv.x * transform.scale.x, v = uv.y * transform.scale.y;
  return {float(transform.offset.x + c * u + s * v), float(transform.offset.y - s * u + c * v)};
}

bool is_unit_possible(Vec3f n) {
  const float squared = length_squared(n);
  return squared > 1e-12F && squared < std::numeric_limits<float>::infinity();
}

// Of a triangle without area some direction, so that no normal is NaN.
Vec3f flat_normal(const Mesh& mesh, const Triangle& t) {
  const Vec3d a(mesh.positions[t[0]]), b(mesh.positions[t[1]]), c(mesh.positions[t[2]]);
  const Vec3d n = cross(b - a, c - a);
  const double size = length(n);
  return size > 0 ? Vec3f(n / size) : Vec3f(0, 0, 1);
}

bool are_surfaces(GltfMode mode) {
  return mode != GltfMode::points && mode != GltfMode::lines;
}

// Corner numbers 3k, 3k+1, 3k+2 of triangle k, as positions in the list of vertices.
std::vector<std::array<std::uint64_t, 3>> list_triangles(GltfMode mode, std::uint64_t corners,
                                                         const std::string& where) {
  std::vector<std::array<std::uint64_t, 3>> triangles;
  if (mode == GltfMode::triangles) {
    if (corners % 3 != 0) {
      throw Error(Error::Kind::input, where,
                  fmt::format("{} vertices are no whole number of triangles", corners));
    }
    triangles.reserve(corners / 3);
    for (std::uint64_t i = 0; i < corners; i += 3) triangles.push_back({i, i + 1, i + 2});
    return triangles;
  }
  for (std::uint64_t i = 0; i + 2 < corners; ++i) {
    if (mode == GltfMode::triangle_fan) {
      triangles.push_back({i + 1, i + 2, 0});
    } else {  // every second triangle of a strip is turned round
      triangles.push_back({i, i + 1 + i % 2, i + 2 - i % 2});
    }
  }
  return triangles;
}

struct PrimitiveReaders {
  ElementReader position;
  std::optional<ElementReader> normal, uv, radius, indices;
  GltfUvTransform uv_transform;
  std::string where;
  GltfMode mode = GltfMode::triangles;
  bool share_vertices = true;  // false: a primitive without normals beside others that have them
};

// Takes primitives one after another and appends their triangles to meshes.
class MeshBuilder {
 public:
  MeshBuilder(const GltfSource& source, const std::vector<GltfUvChoice>& uv_choices)
      : source_(source), uv_choices_(uv_choices) {}

  GltfMeshes build() {
    for (std::uint32_t i = 0; i < source_.document.meshes.size(); ++i) {
      result_.meshes.push_back(build_mesh(i));
    }
    if (skipped_ > 0) {
      result_.notes.push_back(fmt::format("{} primitives of points and lines left out", skipped_));
    }
    if (lacking_uvs_ > 0) {
      result_.notes.push_back(fmt::format(
          "{} primitives have textures but lack the texture coordinates for them", lacking_uvs_));
    }
    return std::move(result_);
  }

 private:
  Mesh build_mesh(std::uint32_t index) {
    const GltfMesh& source = source_.document.meshes[index];
    Mesh mesh;
    mesh.name = source.name;
    bool with_normals = false, with_uvs = false;
    for (const GltfPrimitive& primitive : source.primitives) {
      if (!are_surfaces(primitive.mode)) continue;
      with_normals = with_normals || primitive.normal;
      with_uvs = with_uvs || find_uv_accessor(primitive);
    }
    for (std::size_t p = 0; p < source.primitives.size(); ++p) {
      const GltfPrimitive& primitive = source.primitives[p];
      if (!are_surfaces(primitive.mode)) {
        ++skipped_;
        continue;
      }
      PrimitiveReaders readers =
          open(primitive, fmt::format("{}: meshes[{}].primitives[{}]", source_.where, index, p));
      const std::size_t first_triangle = mesh.triangles.size();
      readers.share_vertices = primitive.normal || !with_normals;
      append_triangles(readers, mesh);
      if (with_normals) complete_normals(first_triangle, mesh);
      if (with_uvs) mesh.uvs.resize(mesh.positions.size());
      const MaterialId material{
          primitive.material.value_or(std::uint32_t(source_.document.materials.size()))};
      mesh.triangle_materials.resize(mesh.triangles.size(), material);
    }
    mesh.edge_radii = make_edge_radii(mesh);
    return mesh;
  }

  [[nodiscard]] const GltfUvChoice& uv_choice(const GltfPrimitive& primitive) const {
    static const GltfUvChoice kDefault;
    return primitive.material ? uv_choices_[*primitive.material] : kDefault;
  }

  [[nodiscard]] std::optional<std::uint32_t> find_uv_accessor(
      const GltfPrimitive& primitive) const {
    const std::uint32_t set = uv_choice(primitive).set;
    if (set >= primitive.uv_sets.size()) return std::nullopt;
    return primitive.uv_sets[set];
  }

  PrimitiveReaders open(const GltfPrimitive& primitive, std::string where) {
    const GltfSource source{source_.document, source_.buffers, source_.budget, where};
    PrimitiveReaders readers{make_element_reader(source, primitive.position, GltfElement::vec3),
                             {},
                             {},
                             {},
                             {},
                             {},
                             where,
                             primitive.mode};
    const auto attribute = [&](std::uint32_t accessor, GltfElement element, const char* name) {
      ElementReader reader = make_element_reader(source, accessor, element);
      if (reader.count() != readers.position.count()) {
        throw Error(Error::Kind::input, where,
                    fmt::format("{} has {} elements, POSITION {}", name, reader.count(),
                                readers.position.count()));
      }
      return reader;
    };
    if (primitive.normal)
      readers.normal = attribute(*primitive.normal, GltfElement::vec3, "NORMAL");
    if (const auto uv = find_uv_accessor(primitive)) {
      readers.uv = attribute(*uv, GltfElement::vec2, "TEXCOORD");
      readers.uv_transform = uv_choice(primitive).transform;
    } else if (uv_choice(primitive).needed) {
      ++lacking_uvs_;
    }
    if (primitive.radius)
      readers.radius = attribute(*primitive.radius, GltfElement::scalar, "_ARRIS_RADIUS");
    if (primitive.indices) {
      readers.indices = make_element_reader(source, *primitive.indices, GltfElement::index);
    }
    return readers;
  }

  void append_triangles(const PrimitiveReaders& readers, Mesh& mesh) {
    const std::uint64_t corners =
        readers.indices ? readers.indices->count() : readers.position.count();
    source_.budget.charge(corners, kBytesPerCorner);
    if (readers.radius) source_.budget.charge(corners, kRadiusBytesPerCorner);
    if (mesh.positions.size() + corners >= std::numeric_limits<std::uint32_t>::max()) {
      throw Error(Error::Kind::input, readers.where,
                  "the mesh has more than 4,294,967,294 vertices");
    }
    if (vertices_.size() < readers.position.count()) vertices_.resize(readers.position.count());
    ++serial_;
    for (const auto& corner : list_triangles(readers.mode, corners, readers.where)) {
      std::array<std::uint64_t, 3> vertex{};
      for (std::size_t k = 0; k < 3; ++k) vertex[k] = find_vertex(readers, corner[k]);
      // Strips are joined by triangles without area.
      const bool is_joint =
          vertex[0] == vertex[1] || vertex[1] == vertex[2] || vertex[2] == vertex[0];
      if (readers.mode != GltfMode::triangles && is_joint) continue;
      if (!readers.share_vertices) ++serial_;
      mesh.triangles.push_back({add_vertex(readers, vertex[0], mesh),
                                add_vertex(readers, vertex[1], mesh),
                                add_vertex(readers, vertex[2], mesh)});
    }
  }

  static std::uint64_t find_vertex(const PrimitiveReaders& readers, std::uint64_t corner) {
    const std::uint64_t vertex = readers.indices ? readers.indices->index(corner) : corner;
    if (vertex >= readers.position.count()) {
      throw Error(Error::Kind::input, readers.where,
                  fmt::format("index {} at position {} is beyond the {} vertices", vertex, corner,
                              readers.position.count()));
    }
    return vertex;
  }

  // The mesh's number of a vertex, which is appended when first met.
  std::uint32_t add_vertex(const PrimitiveReaders& readers, std::uint64_t vertex, Mesh& mesh) {
    SeenVertex& seen = vertices_[vertex];
    if (seen.serial == serial_) return seen.number;
    seen = {serial_, std::uint32_t(mesh.positions.size())};
    const Vec3f position = readers.position.vec3(vertex);
    if (!is_finite(position)) {
      throw Error(Error::Kind::input, readers.where,
                  fmt::format("the position of vertex {} is not finite", vertex));
    }
    mesh.positions.push_back(position);
    if (readers.normal) {
      mesh.normals.resize(mesh.positions.size() - 1);
      mesh.normals.push_back(readers.normal->vec3(vertex));
    }
    if (readers.uv) append_uv(readers, vertex, mesh);
    if (readers.radius) append_radius(readers, vertex, mesh);
    return seen.number;
  }

  static void append_uv(const PrimitiveReaders& readers, std::uint64_t vertex, Mesh& mesh) {
    const Vec2f uv = apply(readers.uv_transform, readers.uv->vec2(vertex));
    if (!std::isfinite(uv.x) || !std::isfinite(uv.y)) {
      throw Error(Error::Kind::input, readers.where,
                  fmt::format("the texture coordinates of vertex {} are not finite", vertex));
    }
    mesh.uvs.resize(mesh.positions.size() - 1);
    mesh.uvs.push_back(uv);
  }

  void append_radius(const PrimitiveReaders& readers, std::uint64_t vertex, const Mesh& mesh) {
    const float radius = readers.radius->scalar(vertex);
    if (std::isinf(radius)) {
      throw Error(Error::Kind::input, readers.where,
                  fmt::format("the _ARRIS_RADIUS of vertex {} is infinite; use a negative number "
                              "where there is none",
                              vertex));
    }
    vertex_radii_.resize(mesh.positions.size() - 1, EdgeRadii::kNone);
    vertex_radii_.push_back(radius);
  }

  // Takes the vertices' radii.
  std::vector<EdgeRadius> make_edge_radii(const Mesh& mesh) {
    EdgeRadii radii;
    if (!vertex_radii_.empty()) {
      vertex_radii_.resize(mesh.positions.size(), EdgeRadii::kNone);
      for (const Triangle& t : mesh.triangles) {
        for (std::size_t k = 0; k < 3; ++k) radii.add_side(t[k], t[(k + 1) % 3], vertex_radii_);
      }
      vertex_radii_.clear();
    }
    return radii.take();
  }

  // Makes normals unit; one that can't be is replaced by that of a triangle at the vertex.
  static void complete_normals(std::size_t first_triangle, Mesh& mesh) {
    mesh.normals.resize(mesh.positions.size());
    for (std::size_t t = first_triangle; t < mesh.triangles.size(); ++t) {
      for (const std::uint32_t vertex : mesh.triangles[t]) {
        Vec3f& normal = mesh.normals[vertex];
        if (!is_unit_possible(normal)) normal = flat_normal(mesh, mesh.triangles[t]);
        normal = normalize(normal);
      }
    }
  }

  struct SeenVertex {
    std::uint64_t serial = 0;  // of the primitive that last used it
    std::uint32_t number = 0;  // in the mesh
  };

  const GltfSource& source_;
  const std::vector<GltfUvChoice>& uv_choices_;
  GltfMeshes result_;
  std::vector<SeenVertex> vertices_;
  std::vector<float> vertex_radii_;  // of one mesh; empty: it has none so far
  std::uint64_t serial_ = 0;
  std::size_t skipped_ = 0, lacking_uvs_ = 0;
};

}  // namespace

GltfMeshes make_gltf_meshes(const GltfSource& source, const std::vector<GltfUvChoice>& uv_choices) {
  return MeshBuilder(source, uv_choices).build();
}

}  // namespace arris
