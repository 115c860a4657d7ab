#include "render/edge_objects.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <variant>

#include "base/parallel_for.h"
#include "edgepoint/frame_maker.h"
#include "edges/welded_mesh.h"
#include "render/rounded_edges.h"
#include "render/scene_geometry.h"
#include "rounding/crease_outline.h"

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

// Meshes of fewer edges are one thread's work.
constexpr std::size_t kWholeMesh = 16'384;

// Pixels around the picture from which edges are kept, as when they are projected.
constexpr double kAround = 2;

// Roundings of less than so many pixels' radius are seen as edges.
constexpr double kSeenRadius = 0.75;
// Roundings of less than so many pixels' width have an edge along their middle: points are further apart, and the
// border between two faces would be as ragged as they lie.
constexpr double kCreaseWidth = 2.5;

RoundedView make_rounded_view(const PixelView& view, Creases creases) {
  const Vec3d forward = transpose(view.pixel_from_world).z;
  const double pixel = double(pixel_size(view)) * length(forward);
  return {view.eye, normalize(forward), kSeenRadius * pixel,
          creases == Creases::drawn ? kCreaseWidth * pixel : 0};
}

double world_radius(const RoundedGeometry& geometry) {
  const double radius = geometry.rounding->data().radius;
  if (geometry.frame == nullptr) return radius;
  return radius / std::cbrt(std::abs(determinant(geometry.frame->rounding_from_world.linear)));
}

// Before the eye and beside none of the picture's sides, in an object's coordinates.
std::array<HalfSpace, 5> seen_part(const PixelView& view, const Affine3d& world) {
  // Of what project() gives: (x w, y w, w).
  const std::array<Vec3d, 5> sides{Vec3d{0, 0, 1}, Vec3d{1, 0, kAround}, Vec3d{0, 1, kAround},
                                   Vec3d{-1, 0, view.width_px + kAround},
                                   Vec3d{0, -1, view.height_px + kAround}};
  const Mat3d from_pixel = transpose(view.pixel_from_world), from_world = transpose(world.linear);
  std::array<HalfSpace, 5> out;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const Vec3d in_world = from_pixel * sides[i];
    out[i] = {from_world * in_world, dot(in_world, world.translation - view.eye)};
  }
  return out;
}

// Area lights are seen from their front.
void add_light_outlines(const Scene& scene, Vec3d eye, std::vector<WorldEdge>& edges) {
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

// An edge between two faces of a creased solid, or of one with fillets.
class CreasedEdge {
 public:
  CreasedEdge(const Rounding::Data& data, const Affine3d& rounding_from_object,
              const EdgeMesh& mesh, std::uint32_t index)
      : mesh_(mesh),
        edge_(mesh.edges[index]),
        face0_(data.face[edge_.face0]),
        face1_(data.face[edge_.face1]) {
    if (face0_ == kNone || face1_ == kNone || face0_ == face1_) return;
    const Solid& solid = data.solids[data.faces[face0_].solid];
    const bool has_fillet = solid.filled != kNone && mesh.is_concave(index);
    if (!has_fillet && solid.creased == kNone) return;
    solid_ = has_fillet ? &data.filled[solid.filled]->outside : data.creased[solid.creased].get();
    const float outward = has_fillet ? -1 : 1;  // of the space outside
    const auto at = [&](std::uint32_t v) {
      return transform_point(rounding_from_object, Vec3d(mesh.vertices[v])) - solid.center;
    };
    between_ = {at(edge_.v0),
                at(edge_.v1),
                Vec3d(data.faces[face0_].normal * outward),
                Vec3d(data.faces[face1_].normal * outward),
                face0_,
                face1_};
    for (const std::uint32_t v : mesh.triangles[edge_.face1]) {
      if (v != edge_.v0 && v != edge_.v1) convex_ = dot(between_.normal0, at(v) - between_.p0) < 0;
    }
  }

  [[nodiscard]] bool is_one() const { return solid_ != nullptr; }
  // Of the solid that is rounded there: the one outside for fillets.
  [[nodiscard]] bool is_convex() const { return convex_; }
  // In the mesh's space; nothing: all of it is.
  [[nodiscard]] std::optional<std::vector<EdgeEnds>> find_kept() const {
    const std::vector<std::pair<double, double>> parts =
        convex_ ? solid_->find_sharp_parts(between_) : find_kept_parts(*solid_, between_);
    if (parts.size() == 1 && parts[0] == std::pair(0.0, 1.0)) return std::nullopt;
    const Vec3d p(mesh_.vertices[edge_.v0]), q(mesh_.vertices[edge_.v1]);
    std::vector<EdgeEnds> ends;
    for (const auto& [from, to] : parts) {
      ends.push_back({Vec3f(p + (q - p) * from), Vec3f(p + (q - p) * to)});
    }
    return ends;
  }

 private:
  const EdgeMesh& mesh_;
  const MeshEdge& edge_;
  std::uint32_t face0_, face1_;
  const CreasedSolid* solid_ = nullptr;
  FaceEdge between_{};
  bool convex_ = false;
};

}  // namespace

struct EdgeObjects::MeshEdges {
  EdgeMesh mesh;
  EdgeTree tree;
  FaceTree faces;
  bool outward = false;  // closed, with its normals outside: what faces away is hidden

  explicit MeshEdges(EdgeMesh made, bool is_outward)
      : mesh(std::move(made)), tree(mesh), faces(mesh), outward(is_outward) {}

  [[nodiscard]] bool bounds_contain(Vec3d p) const {
    const Vec3d a = mesh.bounds_min, b = mesh.bounds_max;
    return p.x >= a.x && p.y >= a.y && p.z >= a.z && p.x <= b.x && p.y <= b.y && p.z <= b.z;
  }
};

EdgeObjects::EdgeObjects(const PreparedScene& prepared, int threads, Creases creases,
                         const std::atomic<bool>* stop)
    : creases_(creases) {
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
  parallel_for(tasks.size(), {.grain = 1, .threads = threads, .stop = stop}, [&](std::size_t t) {
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
  find_solids(prepared, threads, stop);
  make_tasks();
}

void EdgeObjects::make_tasks() {
  tasks_.clear();
  for (std::uint32_t i = 0; i < objects_.size(); ++i) {
    const ObjectEdges& object = objects_[i];
    if (object.solid) tasks_.push_back({i});
    if (!object.mesh) continue;
    if (!object.rounded.empty()) tasks_.push_back({i, 0, 0, true});
    const auto shares = std::uint32_t(object.mesh->tree.shares().size());
    const std::uint32_t at_once = object.mesh->mesh.edges.size() < kWholeMesh ? shares : 1;
    for (std::uint32_t s = 0; s < shares; s += at_once) tasks_.push_back({i, s, s + at_once});
  }
}

// Objects that are made of one tree share its edges, and so do scenes.
void EdgeObjects::find_solids(const PreparedScene& prepared, int threads,
                              const std::atomic<bool>* stop) {
  for (const std::shared_ptr<CsgObject>& object : prepared.geometry().csg.objects) {
    objects_[object->object.index].solid = object->edges->find(object->cells, threads, stop);
  }
}

EdgeObjects::~EdgeObjects() = default;

void EdgeObjects::set_rounded(const PreparedScene& prepared, ObjectEdges& object) {
  find_rounded(prepared, object);
  object.rounded_between.clear();
  object.voids = {};
  if (!object.rounded.empty()) object.voids = voids_of(prepared, object.geometry);
  for (std::uint32_t e = 0; e < object.rounded.size(); ++e) {
    if (object.rounded[e] == RoundedEdge::no || object.rounded[e] == RoundedEdge::partly) continue;
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
  if (out) out->make_tasks();
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
// is beside it. Of creased solids and of fillets the parts that stay sharp are known; concave edges without a fillet
// stay, except where a rounding ends at them.
void EdgeObjects::find_rounded(const PreparedScene& prepared, ObjectEdges& object) {
  object.rounded.clear();
  object.kept.clear();
  const RoundedGeometry& rounded = prepared.rounding().geometries[object.geometry];
  if (rounded.rounding == nullptr) return;
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
  std::vector<RoundedEdge>& out = object.rounded;
  out.assign(mesh.edges.size(), RoundedEdge::no);
  for (std::uint32_t e = 0; e < mesh.edges.size(); ++e) {
    const MeshEdge& edge = mesh.edges[e];
    if (edge.face0 >= data.face.size() || edge.face1 >= data.face.size()) continue;
    const RoundedEdge if_rounded =
        material_of(record, edge.face0).index != material_of(record, edge.face1).index
            ? RoundedEdge::painted
            : RoundedEdge::yes;
    if (const CreasedEdge creased(data, rounding_from_object, mesh, e); creased.is_one()) {
      std::optional<std::vector<EdgeEnds>> parts = creased.find_kept();
      if (creased.is_convex() && parts && parts->empty()) {
        out[e] = if_rounded;
      } else if (parts) {
        out[e] = RoundedEdge::partly;
        object.kept.emplace(e, std::move(*parts));
      }
      continue;
    }
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
      out[e] = if_rounded;
    }
  }
}

void EdgeObjects::find_solid(const Task& task, const PreparedScene& prepared, const PixelView& view,
                             int threads, FoundEdges::List& found) const {
  const Affine3d& world = prepared.scene().objects[task.object].world_from_object;
  const CsgEdges::Found of_solid =
      objects_[task.object].solid->find(transform_point(inverse(world), view.eye), threads);
  const auto add = [&](const CsgEdges::Segment& s) {
    found.edges.push_back({Vec3f(transform_point(world, s.a)), Vec3f(transform_point(world, s.b))});
  };
  std::ranges::for_each(of_solid.sharp, add);
  std::ranges::for_each(of_solid.silhouette, add);
  found.sharp = of_solid.sharp.size();
}

void EdgeObjects::find_shares(const Task& task, const PreparedScene& prepared,
                              const PixelView& view, FoundEdges::List& found) const {
  const ObjectEdges& object = objects_[task.object];
  const MeshEdges& mesh = *object.mesh;
  const Affine3d& world = prepared.scene().objects[task.object].world_from_object;
  const std::array<HalfSpace, 5> seen = seen_part(view, world);
  const Vec3d eye = transform_point(inverse(world), view.eye);
  // Of meshes whose faces may be seen from both sides, all sharp edges are.
  const bool from_outside = mesh.outward && !mesh.bounds_contain(eye);
  const DrawnQuery query{{eye, 1}, !from_outside, seen};
  const auto in_world = [&](Vec3f p) { return transform_point(world, Vec3d(p)); };
  const RoundedView rounded_view = make_rounded_view(view, creases_);
  const double radius =
      object.rounded.empty() ? 0 : world_radius(prepared.rounding().geometries[object.geometry]);
  for (std::uint32_t s = task.first_share; s < task.last_share; ++s) {
    const EdgeShare& share = mesh.tree.shares()[s];
    const std::span<const EdgeEnds> ends = mesh.tree.ends(share.group);
    found.places.clear();
    mesh.tree.find_drawn(share, query, found.places);
    const std::size_t before = found.edges.size();
    for (const std::uint32_t place : found.places) {
      Vec3d a = in_world(ends[place].a), b = in_world(ends[place].b);
      if (!object.rounded.empty()) {
        const std::uint32_t edge = mesh.tree.edges(share.group)[place];
        const RoundedEdge rounded = object.rounded[edge];
        if (rounded != RoundedEdge::no && is_seen_rounded(rounded_view, radius, (a + b) * 0.5)) {
          if (rounded == RoundedEdge::yes) continue;
          if (rounded == RoundedEdge::partly) {
            for (const EdgeEnds& part : object.kept.at(edge)) {
              found.edges.push_back({Vec3f(in_world(part.a)), Vec3f(in_world(part.b))});
            }
            continue;
          }
          // From within the solid the edge lies behind the surface that shows it.
          a += normalize(view.eye - a) * (2 * radius);
          b += normalize(view.eye - b) * (2 * radius);
        }
      }
      found.edges.push_back({Vec3f(a), Vec3f(b)});
    }
    if (share.group != EdgeGroup::smooth) found.sharp += found.edges.size() - before;
  }
}

void EdgeObjects::find_edges(const PreparedScene& prepared, const PixelView& view, int threads,
                             FoundEdges& found) const {
  found.lists_.resize(tasks_.size() + 1);
  parallel_for(tasks_.size(), {.grain = 1, .threads = threads}, [&](std::size_t t) {
    const Task& task = tasks_[t];
    FoundEdges::List& list = found.lists_[t];
    list.edges.clear();
    list.sharp = 0;
    if (objects_[task.object].solid) {
      find_solid(task, prepared, view, threads, list);
    } else if (task.rounded_outline) {
      find_rounded_outline(prepared.rounding().geometries[objects_[task.object].geometry],
                           make_rounded_view(view, creases_), list.edges);
    } else {
      find_shares(task, prepared, view, list);
    }
  });
  FoundEdges::List& of_lights = found.lists_.back();
  of_lights.edges.clear();
  add_light_outlines(prepared.scene(), view.eye, of_lights.edges);
  of_lights.sharp = of_lights.edges.size();
  found.spans_.clear();
  found.totals_ = {};
  for (const FoundEdges::List& list : found.lists_) {
    found.totals_.sharp += list.sharp;
    found.totals_.silhouette += list.edges.size() - list.sharp;
    if (!list.edges.empty()) found.spans_.emplace_back(list.edges);
  }
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
