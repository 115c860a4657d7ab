#include "edgepoint/edge_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace arris {
namespace {

Vec3d normal_of(std::span<const Vec3f> vertices, const Triangle& t) {
  const Vec3d a(vertices[t[0]]);
  return cross(Vec3d(vertices[t[1]]) - a, Vec3d(vertices[t[2]]) - a);
}

// A triangle not wider than what float coordinates of their size can tell apart has no normal.
constexpr double kThinnest = 1.0 / (1 << 22);

bool is_thin(std::span<const Vec3f> vertices, const Triangle& t) {
  Vec3d farthest;
  double longest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3d a(vertices[t[k]]);
    farthest = max(farthest, max(a, -a));
    longest = std::max(longest, length(Vec3d(vertices[t[(k + 1) % 3]]) - a));
  }
  return length(normal_of(vertices, t)) <= longest * (kThinnest * max_component(farthest));
}

// The welded mesh with its triangles of no area taken out of the way.
class Faces {
 public:
  explicit Faces(const WeldedMesh& mesh) : mesh_(mesh), empty_(mesh.triangles.size()) {
    for (std::size_t t = 0; t < empty_.size(); ++t) {
      empty_[t] = is_thin(mesh.vertices, mesh.triangles[t]) ? 1 : 0;
    }
  }

  [[nodiscard]] bool is_empty(std::uint32_t face) const { return empty_[face] != 0; }
  // The longest edge of an empty triangle lies upon its other two.
  [[nodiscard]] bool is_covered(std::uint32_t h) const {
    return is_empty(h / 3) && longest_edge(h / 3) == h;
  }
  // What lies on the side of half-edge h: its triangle, or what is beyond it if that is empty.
  [[nodiscard]] std::uint32_t face_at(std::uint32_t h) const {
    // Empty triangles could lie around in a circle.
    constexpr int kMaxSteps = 64;
    for (int step = 0; step < kMaxSteps && h <= kLastHalfEdge; ++step) {
      if (!is_empty(h / 3)) return h / 3;
      h = mesh_.twin[longest_edge(h / 3)];
    }
    return kNone;
  }

 private:
  [[nodiscard]] std::uint32_t longest_edge(std::uint32_t face) const {
    std::uint32_t longest = 3 * face;
    double most = -1;
    for (std::uint32_t h = 3 * face; h < 3 * face + 3; ++h) {
      const double size = length_squared(Vec3d(mesh_.vertices[mesh_.target(h)]) -
                                         Vec3d(mesh_.vertices[mesh_.origin(h)]));
      if (size > most) most = size, longest = h;
    }
    return longest;
  }

  const WeldedMesh& mesh_;
  std::vector<std::uint8_t> empty_;
};

// The corner of the face that is farthest from the plane.
double farthest_above(const EdgeMesh& mesh, std::uint32_t face, Vec3d normal, Vec3d origin) {
  double most = -std::numeric_limits<double>::infinity();
  for (const std::uint32_t v : mesh.triangles[face]) {
    most = std::max(most, dot(normal, Vec3d(mesh.vertices[v]) - origin));
  }
  return most;
}

// What the two faces make of an edge.
std::uint8_t flags_of(const EdgeMesh& mesh, const MeshEdge& edge, double cos_sharp) {
  const Vec3d n0 = face_normal(mesh, edge.face0), n1 = face_normal(mesh, edge.face1);
  const double l0 = length(n0), l1 = length(n1);
  std::uint8_t flags = 0;
  if (dot(n0, n1) < cos_sharp * (l0 * l1)) flags |= EdgeMesh::kSharp;
  // Far above rounding: each face reaches to the front of the other.
  constexpr double kRounding = 1e-12;
  const Vec3d p(mesh.vertices[edge.v0]);
  const double size = length(mesh.bounds_max - mesh.bounds_min) * kRounding;
  if (farthest_above(mesh, edge.face1, n0, p) > l0 * size &&
      farthest_above(mesh, edge.face0, n1, p) > l1 * size) {
    flags |= EdgeMesh::kConcave;
  }
  return flags;
}

void add_edges(EdgeMesh& out, const WeldedMesh& mesh, const EdgeMeshOptions& options) {
  const Faces faces(mesh);
  const double cos_sharp = std::cos(options.min_sharp_angle);
  out.edges.reserve(mesh.triangles.size() * 3 / 2);
  out.flags.reserve(mesh.triangles.size() * 3 / 2);
  for (std::uint32_t h = 0; h < mesh.twin.size(); ++h) {
    const std::uint32_t twin = mesh.twin[h];
    const bool paired = twin <= kLastHalfEdge;
    if ((paired && twin < h) || mesh.shell[h / 3] == kNone) continue;
    if (faces.is_covered(h) || (paired && faces.is_covered(twin))) continue;
    const std::uint32_t left = faces.face_at(h), right = paired ? faces.face_at(twin) : kNone;
    if (left == kNone && right == kNone) continue;
    const bool turned = left == kNone;
    MeshEdge edge{mesh.origin(h), mesh.target(h), turned ? right : left, turned ? kNone : right};
    if (turned) std::swap(edge.v0, edge.v1);
    if (edge.face0 == edge.face1) continue;
    std::uint8_t flags = EdgeMesh::kSharp;
    if (edge.face1 != kNone) {
      flags = flags_of(out, edge, cos_sharp);
      if (options.is_marked && options.is_marked(h, twin)) flags |= EdgeMesh::kSharp;
    } else {
      out.closed = false;
    }
    out.edges.push_back(edge);
    out.flags.push_back(flags);
  }
}

void add_adjacency(EdgeMesh& mesh) {
  mesh.first_around.assign(mesh.vertices.size() + 1, 0);
  for (const MeshEdge& e : mesh.edges) {
    ++mesh.first_around[e.v0 + 1];
    ++mesh.first_around[e.v1 + 1];
  }
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    mesh.first_around[v + 1] += mesh.first_around[v];
  }
  mesh.edges_around.resize(2 * mesh.edges.size());
  std::vector<std::uint32_t> at(mesh.first_around.begin(), mesh.first_around.end() - 1);
  for (std::uint32_t e = 0; e < mesh.edges.size(); ++e) {
    mesh.edges_around[at[mesh.edges[e].v0]++] = e;
    mesh.edges_around[at[mesh.edges[e].v1]++] = e;
  }
}

}  // namespace

HomogeneousPoint transform(const Affine3d& m, const HomogeneousPoint& p) {
  return {transform_vector(m, p.xyz) + m.translation * p.w, p.w};
}

EdgeMesh make_edge_mesh(const WeldedMesh& mesh, const EdgeMeshOptions& options) {
  EdgeMesh out;
  out.vertices = mesh.vertices;
  out.triangles = mesh.triangles;
  if (!mesh.vertices.empty()) {
    Vec3f low = mesh.vertices[0], high = low;
    for (const Vec3f p : mesh.vertices) {
      low = min(low, p);
      high = max(high, p);
    }
    out.bounds_min = Vec3d(low);
    out.bounds_max = Vec3d(high);
  }
  add_edges(out, mesh, options);
  add_adjacency(out);
  return out;
}

Vec3d face_normal(const EdgeMesh& mesh, std::uint32_t face) {
  return normal_of(mesh.vertices, mesh.triangles[face]);
}

bool is_front(const EdgeMesh& mesh, std::uint32_t face, const HomogeneousPoint& viewpoint) {
  const Vec3d a(mesh.vertices[mesh.triangles[face][0]]);
  return dot(face_normal(mesh, face), viewpoint.xyz - a * viewpoint.w) > 0;
}

bool is_silhouette(const EdgeMesh& mesh, std::uint32_t edge, const HomogeneousPoint& viewpoint) {
  const MeshEdge& e = mesh.edges[edge];
  return e.face1 == kNone ||
         is_front(mesh, e.face0, viewpoint) != is_front(mesh, e.face1, viewpoint);
}

bool is_drawn(const EdgeMesh& mesh, std::uint32_t edge, const HomogeneousPoint& viewpoint) {
  const MeshEdge& e = mesh.edges[edge];
  if (e.face1 == kNone) return true;
  const bool front0 = is_front(mesh, e.face0, viewpoint);
  const bool front1 = is_front(mesh, e.face1, viewpoint);
  return front0 != front1 || (front0 && mesh.is_sharp(edge));
}

bool may_be_silhouette(const EdgeMesh& mesh, std::uint32_t edge,
                       std::span<const HomogeneousPoint> viewpoints) {
  const MeshEdge& e = mesh.edges[edge];
  if (e.face1 == kNone) return true;
  bool any_front = false, any_back = false;
  for (const HomogeneousPoint& v : viewpoints) {
    for (const std::uint32_t face : {e.face0, e.face1}) {
      (is_front(mesh, face, v) ? any_front : any_back) = true;
    }
  }
  return any_front && any_back;
}

}  // namespace arris
