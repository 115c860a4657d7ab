#include "render/edge_objects.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <utility>
#include <variant>

#include "base/parallel_for.h"
#include "edgepoint/frame_maker.h"
#include "edges/welded_mesh.h"
#include "render/rounded_edges.h"
#include "render/scene_geometry.h"

namespace arris {
namespace {

// Between the normals on the two sides of an edge: below, the eye sees a smooth surface. The paper's angle is set
// for each mesh (§6.2).
constexpr double kSharpTurn = radians(8);

// What a mesh shows on its own, whatever object it is.
class Seams {
 public:
  Seams(const Mesh& mesh, bool textured) : mesh_(mesh), textured_(textured && !mesh.uvs.empty()) {}

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

bool is_textured(const Scene& scene, const Object& object) {
  const auto textured = [&](MaterialId id) {
    return scene.materials[id.index].base_color_texture.has_value();
  };
  const std::vector<MaterialId>& own = scene.meshes[object.mesh.index].triangle_materials;
  return textured(object.material) || std::any_of(own.begin(), own.end(), textured);
}

// Edges of a mesh that are put into the world at a time.
constexpr std::size_t kEdgeChunk = 4096;

// Roundings of less than so many pixels' radius are seen as edges.
constexpr double kSeenRadius = 0.75;

RoundedView make_rounded_view(const PixelView& view) {
  const Vec3d forward = transpose(view.pixel_from_world).z;
  return {view.eye, normalize(forward), kSeenRadius * double(pixel_size(view)) * length(forward)};
}

double world_radius(const RoundedGeometry& geometry) {
  const double radius = geometry.rounding->data().radius;
  if (geometry.frame == nullptr) return radius;
  return radius / std::cbrt(std::abs(determinant(geometry.frame->rounding_from_world.linear)));
}

// Area lights are seen from their front.
void add_light_outlines(const Scene& scene, Vec3d eye, std::vector<WorldEdge>& edges,
                        EdgeTotals& totals) {
  for (const Light& light : scene.lights) {
    const auto* area = std::get_if<AreaLight>(&light);
    if (area == nullptr || !area->visible_to_camera) continue;
    if (dot(cross(area->edge_u, area->edge_v), eye - area->corner) <= 0) continue;
    const Vec3d corners[4] = {area->corner, area->corner + area->edge_u,
                              area->corner + area->edge_u + area->edge_v,
                              area->corner + area->edge_v};
    for (std::size_t i = 0; i < 4; ++i) {
      edges.push_back({Vec3f(corners[i]), Vec3f(corners[(i + 1) % 4])});
    }
    totals.sharp += 4;
  }
}

FaceVoids voids_of(const PreparedScene& prepared, std::uint32_t geometry) {
  const Rounding::Data& data = prepared.rounding().geometries[geometry].rounding->data();
  FaceVoids voids;
  voids.first = data.band_begin;
  voids.bands.reserve(data.bands.size());
  for (const Band& b : data.bands)
    voids.bands.push_back({double(b.c0), double(b.cu), double(b.cv)});
  return voids;
}

}  // namespace

struct EdgeObjects::MeshEdges {
  EdgeMesh mesh;
  EdgeTree tree;
  FaceTree faces;
  std::vector<std::uint32_t> sharp;
  bool outward = false;  // closed, with its normals outside: what faces away is hidden

  explicit MeshEdges(EdgeMesh made, bool is_outward)
      : mesh(std::move(made)), tree(mesh), faces(mesh), outward(is_outward) {
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
  objects_.resize(scene.objects.size());
  std::map<std::pair<std::uint32_t, bool>, std::vector<std::uint32_t>> users;
  const std::vector<GeometryRecord>& records = prepared.geometry().embree.records();
  for (std::uint32_t g = 0; g < records.size(); ++g) {
    if (records[g].triangles == nullptr) continue;
    const std::uint32_t i = records[g].object.index;
    objects_[i].geometry = g;
    users[{records[g].mesh.index, is_textured(scene, scene.objects[i])}].push_back(i);
  }
  std::vector<std::pair<std::pair<std::uint32_t, bool>, std::vector<std::uint32_t>>> tasks(
      users.begin(), users.end());
  parallel_for(tasks.size(), {.grain = 1, .threads = threads}, [&](std::size_t t) {
    const Mesh& mesh = scene.meshes[tasks[t].first.first];
    const WeldedMesh welded = make_welded_mesh({mesh.positions, mesh.triangles}, mesh.name);
    const Seams seams(mesh, tasks[t].first.second);
    EdgeMeshOptions options;
    options.min_sharp_angle = mesh.normals.empty() ? kSharpTurn : kPi;
    options.is_marked = [&](std::uint32_t h, std::uint32_t twin) { return seams.jumps(h, twin); };
    const bool outward = std::all_of(welded.shells.begin(), welded.shells.end(),
                                     [](const Shell& s) { return s.closed && s.volume > 0; });
    const auto edges = std::make_shared<const MeshEdges>(make_edge_mesh(welded, options), outward);
    for (const std::uint32_t i : tasks[t].second) {
      objects_[i].mesh = edges;
      set_rounded(prepared, objects_[i]);
    }
  });
  find_solids(prepared, threads);
}

// Objects that are made of one tree share its edges.
void EdgeObjects::find_solids(const PreparedScene& prepared, int threads) {
  std::map<const CsgCells*, std::shared_ptr<const CsgEdges>> found;
  for (const std::shared_ptr<CsgObject>& object : prepared.geometry().csg.objects) {
    std::shared_ptr<const CsgEdges>& edges = found[object->cells.get()];
    if (!edges) edges = std::make_shared<const CsgEdges>(object->cells, threads);
    objects_[object->object.index].solid = edges;
  }
}

EdgeObjects::~EdgeObjects() = default;

void EdgeObjects::set_rounded(const PreparedScene& prepared, ObjectEdges& object) {
  object.rounded = find_rounded(prepared, object);
  object.rounded_between.clear();
  object.voids = {};
  if (!object.rounded.empty()) object.voids = voids_of(prepared, object.geometry);
  for (std::uint32_t e = 0; e < object.rounded.size(); ++e) {
    if (object.rounded[e] == RoundedEdge::no) continue;
    const MeshEdge& edge = object.mesh->mesh.edges[e];
    object.rounded_between.emplace_back(std::minmax(edge.face0, edge.face1));
  }
  std::ranges::sort(object.rounded_between);
}

std::shared_ptr<const EdgeObjects> EdgeObjects::with_roundings(const PreparedScene& before,
                                                               const PreparedScene& after) const {
  std::shared_ptr<EdgeObjects> out;
  for (std::size_t i = 0; i < objects_.size(); ++i) {
    const std::uint32_t geometry = objects_[i].geometry;
    if (!objects_[i].mesh || before.rounding().geometries[geometry].rounding ==
                                 after.rounding().geometries[geometry].rounding) {
      continue;
    }
    if (!out) out = std::make_shared<EdgeObjects>(*this);
    set_rounded(after, out->objects_[i]);
  }
  return out;
}

bool EdgeObjects::is_rounded_anew(const PreparedScene& before, const PreparedScene& after) const {
  return std::ranges::any_of(objects_, [&](const ObjectEdges& object) {
    if (!object.mesh) return false;
    const Rounding* const old = before.rounding().geometries[object.geometry].rounding;
    const Rounding* const now = after.rounding().geometries[object.geometry].rounding;
    if (old == now) return false;
    return old == nullptr || now == nullptr || old->data().radius != now->data().radius ||
           old->data().arcs.size() != now->data().arcs.size();
  });
}

Sphere EdgeObjects::bounding_sphere(const PreparedScene& prepared, std::uint32_t object) const {
  Box3d box;
  if (const std::optional<Parts> parts = this->parts(prepared, object)) {
    box = {parts->mesh->bounds_min, parts->mesh->bounds_max};
  } else if (const CsgEdges* const edges = solid(object)) {
    box = edges->bounds();
  } else {
    return {};
  }
  const Vec3d half = (box.high - box.low) * 0.5;
  const Affine3d& world = prepared.scene().objects[object].world_from_object;
  const Mat3d& m = world.linear;
  return {transform_point(world, box.low + half),
          length(m.x) * half.x + length(m.y) * half.y + length(m.z) * half.z};
}

// All edges between the same two planes lie on one line: an edge is rounded if one of the arcs between its faces
// is beside it.
std::vector<EdgeObjects::RoundedEdge> EdgeObjects::find_rounded(const PreparedScene& prepared,
                                                                const ObjectEdges& object) {
  const RoundedGeometry& rounded = prepared.rounding().geometries[object.geometry];
  if (rounded.rounding == nullptr) return {};
  const Rounding::Data& data = rounded.rounding->data();
  const GeometryRecord& record = prepared.geometry().embree.records()[object.geometry];
  const Affine3d& world = prepared.scene().objects[record.object.index].world_from_object;
  const Affine3d rounding_from_object =
      rounded.frame == nullptr ? world : rounded.frame->rounding_from_world * world;
  std::multimap<std::pair<std::uint32_t, std::uint32_t>, const Arc*> arcs;
  for (const Arc& arc : data.arcs) {
    if (!arc.is_stub()) arcs.insert({std::minmax(arc.face_a, arc.face_b), &arc});
  }
  const EdgeMesh& mesh = object.mesh->mesh;
  std::vector<RoundedEdge> out(mesh.edges.size(), RoundedEdge::no);
  for (std::uint32_t e = 0; e < mesh.edges.size(); ++e) {
    const MeshEdge& edge = mesh.edges[e];
    if (edge.face0 >= data.face.size() || edge.face1 >= data.face.size()) continue;
    const auto [first, last] =
        arcs.equal_range(std::minmax(data.face[edge.face0], data.face[edge.face1]));
    for (auto it = first; it != last && out[e] == RoundedEdge::no; ++it) {
      const Arc& arc = *it->second;
      const Vec3d start = data.solids[data.faces[arc.face_a].solid].center + Vec3d(arc.line.p0);
      const auto along = [&](std::uint32_t v) {
        const Vec3d p = transform_point(rounding_from_object, Vec3d(mesh.vertices[v]));
        return dot(p - start, Vec3d(arc.line.axis));
      };
      const auto [from, to] = std::minmax({along(edge.v0), along(edge.v1)});
      // Corners take of the edge what the arc lacks.
      const double reach = 2 * data.radius;
      if (to < -reach || from > double(arc.line.length) + reach) continue;
      const bool painted =
          material_of(record, edge.face0).index != material_of(record, edge.face1).index;
      out[e] = painted ? RoundedEdge::painted : RoundedEdge::yes;
    }
  }
  return out;
}

std::vector<std::vector<WorldEdge>> EdgeObjects::find_edges(const PreparedScene& prepared,
                                                            const PixelView& view, int threads,
                                                            EdgeTotals& totals) const {
  struct Found {
    std::vector<WorldEdge> edges;
    std::uint64_t sharp = 0;
  };
  // Of one object, by chunks of its mesh's edges.
  using Chunks = std::vector<Found>;
  const Scene& scene = prepared.scene();
  const RoundedView rounded_view = make_rounded_view(view);
  std::vector<Chunks> found(objects_.size(), Chunks(1));
  parallel_for(objects_.size(), {.grain = 1, .threads = threads}, [&](std::size_t i) {
    const Affine3d& world = scene.objects[i].world_from_object;
    if (objects_[i].solid) {
      const CsgEdges::Found of_solid =
          objects_[i].solid->find(transform_point(inverse(world), view.eye), threads);
      Found& first = found[i].front();
      const auto add = [&](const CsgEdges::Segment& s) {
        first.edges.push_back(
            {Vec3f(transform_point(world, s.a)), Vec3f(transform_point(world, s.b))});
      };
      std::ranges::for_each(of_solid.sharp, add);
      std::ranges::for_each(of_solid.silhouette, add);
      first.sharp = of_solid.sharp.size();
    }
    if (!objects_[i].mesh) return;
    const MeshEdges& object = *objects_[i].mesh;
    const RoundedGeometry* rounding = nullptr;
    if (!objects_[i].rounded.empty()) {
      rounding = &prepared.rounding().geometries[objects_[i].geometry];
    }
    const double radius = rounding == nullptr ? 0 : world_radius(*rounding);
    const std::vector<std::uint32_t> seen = object.find(transform_point(inverse(world), view.eye));
    const auto add = [&](std::uint32_t e, Found& out) {
      const MeshEdge& edge = object.mesh.edges[e];
      const auto end = [&](std::uint32_t v) {
        return transform_point(world, Vec3d(object.mesh.vertices[v]));
      };
      Vec3d a = end(edge.v0), b = end(edge.v1);
      const RoundedEdge rounded = rounding == nullptr ? RoundedEdge::no : objects_[i].rounded[e];
      if (rounded != RoundedEdge::no && is_seen_rounded(rounded_view, radius, (a + b) * 0.5)) {
        if (rounded == RoundedEdge::yes) return;
        // From within the solid the edge lies behind the surface that shows it.
        a += normalize(view.eye - a) * (2 * radius);
        b += normalize(view.eye - b) * (2 * radius);
      }
      out.edges.push_back({Vec3f(a), Vec3f(b)});
      out.sharp += object.mesh.is_sharp(e) ? 1 : 0;
    };
    const std::size_t chunks =
        std::max<std::size_t>(1, (seen.size() + kEdgeChunk - 1) / kEdgeChunk);
    found[i].resize(chunks);
    parallel_for(chunks, {.grain = 1, .threads = threads}, [&](std::size_t c) {
      const std::size_t last = std::min(seen.size(), (c + 1) * kEdgeChunk);
      found[i][c].edges.reserve(last - c * kEdgeChunk);
      for (std::size_t k = c * kEdgeChunk; k < last; ++k) add(seen[k], found[i][c]);
    });
    if (rounding != nullptr) {
      find_rounded_outline(*rounding, rounded_view, found[i].front().edges);
    }
  });
  std::vector<std::vector<WorldEdge>> edges(1);
  for (Chunks& chunks : found) {
    for (Found& f : chunks) {
      totals.sharp += f.sharp;
      totals.silhouette += f.edges.size() - f.sharp;
      if (!f.edges.empty()) edges.push_back(std::move(f.edges));
    }
  }
  add_light_outlines(scene, view.eye, edges.front(), totals);
  return edges;
}

std::optional<EdgeObjects::Parts> EdgeObjects::parts(const PreparedScene& prepared,
                                                     std::uint32_t object) const {
  if (object >= objects_.size() || !objects_[object].mesh) return std::nullopt;
  const ObjectEdges& o = objects_[object];
  Parts parts;
  parts.mesh = &o.mesh->mesh;
  parts.tree = &o.mesh->tree;
  parts.faces = &o.mesh->faces;
  parts.world = &prepared.scene().objects[object].world_from_object;
  if (!o.rounded.empty()) {
    parts.rounding = &prepared.rounding().geometries[o.geometry];
    parts.voids = &o.voids;
  }
  parts.rounded_between = o.rounded_between;
  return parts;
}

}  // namespace arris
