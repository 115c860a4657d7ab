#include "render/edge_objects.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <utility>

#include "base/parallel_for.h"
#include "edges/welded_mesh.h"

namespace arris {
namespace {

// Between the normals on the two sides of an edge: below, the eye sees a smooth surface. The paper has 85° for all
// meshes, whose own turns below that then blur.
constexpr double kSharpTurn = radians(8);

// What a mesh shows on its own, whatever object it is.
class Seams {
 public:
  Seams(const Scene& scene, const Mesh& mesh, bool textured)
      : mesh_(mesh), textured_(textured && !mesh.uvs.empty()) {
    (void)scene;
  }

  // Whether shading jumps across an edge for other reasons than the turn of its faces.
  [[nodiscard]] bool jumps(std::uint32_t h, std::uint32_t twin) const {
    const std::size_t a = h / 3, b = twin / 3;
    if (a >= mesh_.triangles.size() || b >= mesh_.triangles.size()) return false;
    if (!mesh_.triangle_materials.empty() &&
        mesh_.triangle_materials[a].index != mesh_.triangle_materials[b].index) {
      return true;
    }
    const std::uint32_t a0 = vertex(h), a1 = vertex(WeldedMesh::next(h));
    const std::uint32_t b0 = vertex(WeldedMesh::next(twin)), b1 = vertex(twin);
    if (!mesh_.normals.empty() && (turns(a0, b0) || turns(a1, b1))) return true;
    return textured_ && (mesh_.uvs[a0] != mesh_.uvs[b0] || mesh_.uvs[a1] != mesh_.uvs[b1]);
  }

 private:
  [[nodiscard]] std::uint32_t vertex(std::uint32_t h) const {
    return mesh_.triangles[h / 3][h % 3];
  }
  [[nodiscard]] bool turns(std::uint32_t a, std::uint32_t b) const {
    static const float kCosine = float(std::cos(kSharpTurn));
    return a != b && dot(mesh_.normals[a], mesh_.normals[b]) < kCosine;
  }

  const Mesh& mesh_;
  bool textured_;
};

}  // namespace

struct EdgeObjects::MeshEdges {
  EdgeMesh mesh;
  EdgeTree tree;
  std::vector<std::uint32_t> sharp;
  bool outward = false;  // closed, with its normals outside: what faces away is hidden

  explicit MeshEdges(EdgeMesh made, bool is_outward)
      : mesh(std::move(made)), tree(mesh), outward(is_outward) {
    for (std::uint32_t e = 0; e < mesh.edges.size(); ++e) {
      if (mesh.is_sharp(e)) sharp.push_back(e);
    }
  }

  [[nodiscard]] bool bounds_contain(Vec3d p) const {
    const Vec3d a = mesh.bounds_min, b = mesh.bounds_max;
    return p.x >= a.x && p.y >= a.y && p.z >= a.z && p.x <= b.x && p.y <= b.y && p.z <= b.z;
  }

  // Edges that the eye may see. Of meshes whose faces may be seen from both sides, all sharp ones.
  [[nodiscard]] std::vector<std::uint32_t> find(Vec3d eye) const {
    if (outward && !bounds_contain(eye)) return tree.find_drawn({eye, 1});
    std::vector<std::uint32_t> found = sharp;
    for (const std::uint32_t e : tree.find_silhouettes({eye, 1})) {
      if (!mesh.is_sharp(e)) found.push_back(e);
    }
    return found;
  }
};

EdgeObjects::EdgeObjects(const PreparedScene& prepared, int threads) {
  const Scene& scene = prepared.scene();
  of_object_.resize(scene.objects.size());
  std::map<std::pair<std::uint32_t, bool>, std::vector<std::uint32_t>> users;
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    if (object.csg) continue;
    const Mesh& mesh = scene.meshes[object.mesh.index];
    bool textured = scene.materials[object.material.index].base_color_texture.has_value();
    for (const MaterialId id : mesh.triangle_materials) {
      textured = textured || scene.materials[id.index].base_color_texture.has_value();
    }
    users[{object.mesh.index, textured}].push_back(i);
  }
  std::vector<std::pair<std::pair<std::uint32_t, bool>, std::vector<std::uint32_t>>> tasks(
      users.begin(), users.end());
  parallel_for(tasks.size(), {.grain = 1, .threads = threads}, [&](std::size_t t) {
    const Mesh& mesh = scene.meshes[tasks[t].first.first];
    const WeldedMesh welded = make_welded_mesh({mesh.positions, mesh.triangles}, mesh.name);
    const Seams seams(scene, mesh, tasks[t].first.second);
    EdgeMeshOptions options;
    options.min_sharp_angle = mesh.normals.empty() ? kSharpTurn : 2 * kPi;
    options.is_marked = [&](std::uint32_t h, std::uint32_t twin) { return seams.jumps(h, twin); };
    const bool outward = std::all_of(welded.shells.begin(), welded.shells.end(),
                                     [](const Shell& s) { return s.closed && s.volume > 0; });
    const auto edges = std::make_shared<const MeshEdges>(make_edge_mesh(welded, options), outward);
    for (const std::uint32_t object : tasks[t].second) of_object_[object] = edges;
  });
}

EdgeObjects::~EdgeObjects() = default;

std::vector<WorldEdge> EdgeObjects::find_edges(const Scene& scene, Vec3d eye, int threads,
                                               EdgeTotals& totals) const {
  struct Found {
    std::vector<WorldEdge> edges;
    std::uint64_t sharp = 0;
  };
  std::vector<Found> found(of_object_.size());
  parallel_for(of_object_.size(), {.grain = 1, .threads = threads}, [&](std::size_t i) {
    if (!of_object_[i]) return;
    const MeshEdges& object = *of_object_[i];
    const Affine3d& world = scene.objects[i].world_from_object;
    for (const std::uint32_t e : object.find(transform_point(inverse(world), eye))) {
      const MeshEdge& edge = object.mesh.edges[e];
      const auto end = [&](std::uint32_t v) {
        return Vec3f(transform_point(world, Vec3d(object.mesh.vertices[v])));
      };
      found[i].edges.push_back({end(edge.v0), end(edge.v1)});
      found[i].sharp += object.mesh.is_sharp(e) ? 1 : 0;
    }
  });
  std::vector<WorldEdge> edges;
  for (const Found& f : found) {
    edges.insert(edges.end(), f.edges.begin(), f.edges.end());
    totals.sharp += f.sharp;
    totals.silhouette += f.edges.size() - f.sharp;
  }
  return edges;
}

std::uint64_t EdgeObjects::bytes() const {
  std::uint64_t sum = 0;
  std::vector<const MeshEdges*> counted;
  for (const auto& edges : of_object_) {
    if (!edges || std::find(counted.begin(), counted.end(), edges.get()) != counted.end()) continue;
    counted.push_back(edges.get());
    sum += edges->tree.bytes();
  }
  return sum;
}

}  // namespace arris
