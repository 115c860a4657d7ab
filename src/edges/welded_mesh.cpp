#include "edges/welded_mesh.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "arris/error.h"

namespace arris {
namespace {

void check_mesh(const MeshView& mesh, const std::string& name) {
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    if (!is_finite(mesh.positions[i])) {
      throw Error(Error::Kind::input, name,
                  "vertex " + std::to_string(i) + " has a coordinate that is not a finite number");
    }
  }
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (const std::uint32_t i : mesh.triangles[t]) {
      if (i >= mesh.positions.size()) {
        throw Error(Error::Kind::input, name,
                    "triangle " + std::to_string(t) + " uses vertex " + std::to_string(i) +
                        ", but there are only " + std::to_string(mesh.positions.size()));
      }
    }
  }
  for (const VertexPair& pair : mesh.sharp_edges.value_or(std::span<const VertexPair>())) {
    if (std::max(pair[0], pair[1]) >= mesh.positions.size()) {
      throw Error(Error::Kind::input, name,
                  "a sharp edge has the vertices " + std::to_string(pair[0]) + " and " +
                      std::to_string(pair[1]) + ", but there are only " +
                      std::to_string(mesh.positions.size()));
    }
  }
  for (const EdgeRadius& edge : mesh.edge_radii) {
    const std::uint32_t vertex = std::max(edge.vertices[0], edge.vertices[1]);
    if (vertex >= mesh.positions.size()) {
      throw Error(Error::Kind::input, name,
                  "an edge with a radius has the vertex " + std::to_string(vertex) +
                      ", but there are only " + std::to_string(mesh.positions.size()));
    }
    if (!(edge.radius >= 0) || !std::isfinite(edge.radius)) {
      throw Error(Error::Kind::input, name,
                  "the edge of the vertices " + std::to_string(edge.vertices[0]) + " and " +
                      std::to_string(edge.vertices[1]) + " has the radius " +
                      std::to_string(edge.radius) + "; it must be a number not below 0");
    }
  }
  if (mesh.triangles.size() > kLastHalfEdge / 3) {
    throw Error(Error::Kind::input, name,
                "has " + std::to_string(mesh.triangles.size()) + " triangles; at most " +
                    std::to_string(kLastHalfEdge / 3) + " can be rounded in one mesh");
  }
}

std::vector<VertexPair> weld_pairs(std::span<const VertexPair> pairs,
                                   std::span<const std::uint32_t> vertex_of) {
  std::vector<VertexPair> welded;
  welded.reserve(pairs.size());
  for (const VertexPair& pair : pairs) {
    const std::uint32_t a = vertex_of[pair[0]], b = vertex_of[pair[1]];
    if (a != b) welded.push_back({std::min(a, b), std::max(a, b)});
  }
  std::sort(welded.begin(), welded.end());
  welded.erase(std::unique(welded.begin(), welded.end()), welded.end());
  return welded;
}

std::vector<EdgeRadius> weld_radii(std::span<const EdgeRadius> edges,
                                   std::span<const std::uint32_t> vertex_of) {
  std::vector<EdgeRadius> welded;
  for (const EdgeRadius& edge : edges) {
    const std::uint32_t a = vertex_of[edge.vertices[0]], b = vertex_of[edge.vertices[1]];
    if (a != b) welded.push_back({{std::min(a, b), std::max(a, b)}, edge.radius});
  }
  std::ranges::sort(welded, {},
                    [](const EdgeRadius& e) { return std::pair(e.vertices, e.radius); });
  const auto is_same = [](const EdgeRadius& e, const EdgeRadius& f) {
    return e.vertices == f.vertices;
  };
  welded.erase(std::unique(welded.begin(), welded.end(), is_same), welded.end());
  return welded;
}

std::uint32_t hash_position(Vec3f p) {
  // Adding zero turns -0 into +0, so that both weld.
  const auto bits = [](float f) { return std::bit_cast<std::uint32_t>(f + 0.0F); };
  std::uint64_t h = bits(p.x) * 0x9E3779B97F4A7C15ULL;
  h = (h ^ (h >> 32) ^ bits(p.y)) * 0xC2B2AE3D27D4EB4FULL;
  h = (h ^ (h >> 29) ^ bits(p.z)) * 0x9E3779B97F4A7C15ULL;
  return std::uint32_t(h >> 32);
}

// Welded vertex of each position; fills `vertices`.
std::vector<std::uint32_t> weld_positions(std::span<const Vec3f> positions,
                                          std::vector<Vec3f>& vertices) {
  const std::size_t slots = std::bit_ceil(std::max<std::size_t>(16, positions.size() * 2));
  std::vector<std::uint32_t> table(slots, kNone);
  std::vector<std::uint32_t> vertex_of(positions.size());
  vertices.reserve(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    std::size_t slot = hash_position(positions[i]) & (slots - 1);
    while (table[slot] != kNone && vertices[table[slot]] != positions[i]) {
      slot = (slot + 1) & (slots - 1);
    }
    if (table[slot] == kNone) {
      table[slot] = std::uint32_t(vertices.size());
      vertices.push_back(positions[i]);
    }
    vertex_of[i] = table[slot];
  }
  return vertex_of;
}

bool is_degenerate(const Triangle& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

// Whether the corners lie in one line: no other triangle's side is told from it by an angle.
bool has_no_area(const Triangle& t, std::span<const Vec3f> vertices) {
  constexpr double kFlat = 1e-9;  // height, of the longest side
  const Vec3d a(vertices[t[0]]), b(vertices[t[1]]), c(vertices[t[2]]);
  const double longest =
      std::max({length_squared(b - a), length_squared(c - b), length_squared(a - c)});
  return !(length(cross(b - a, c - a)) > kFlat * longest);
}

// Unit vector from the edge into the triangle of half-edge h, perpendicular to the edge.
Vec3d direction_into_face(const WeldedMesh& mesh, std::uint32_t h, Vec3d edge) {
  const Vec3d a(mesh.vertices[mesh.origin(h)]);
  const Vec3d c(mesh.vertices[mesh.origin(WeldedMesh::previous(h))]);
  const Vec3d d = c - a;
  return normalize(d - edge * dot(d, edge));
}

// Pairs the half-edges of one edge where k solids touch (k along it, k against it): going around the edge
// from a face through its own material, the first face of the other direction closes the wedge.
void pair_around_edge(WeldedMesh& mesh, std::span<const std::uint32_t> half_edges) {
  const std::uint32_t first = half_edges[0];
  const Vec3d edge = normalize(Vec3d(mesh.vertices[mesh.target(first)]) -
                               Vec3d(mesh.vertices[mesh.origin(first)]));
  const Vec3d axis_x = direction_into_face(mesh, first, edge);
  const Vec3d axis_y = cross(edge, axis_x);
  struct Spoke {
    double angle;
    bool along;
    std::uint32_t half_edge;
  };
  std::vector<Spoke> spokes;
  std::size_t along_count = 0;
  for (const std::uint32_t h : half_edges) {
    const Vec3d d = direction_into_face(mesh, h, edge);
    const bool along = mesh.origin(h) == mesh.origin(first);
    along_count += along ? 1 : 0;
    spokes.push_back({std::atan2(dot(d, axis_y), dot(d, axis_x)), along, h});
  }
  const bool has_angles =
      std::ranges::none_of(spokes, [](const Spoke& s) { return std::isnan(s.angle); });
  if (along_count * 2 != half_edges.size() || !has_angles) {
    for (const std::uint32_t h : half_edges) mesh.twin[h] = kNonManifold;
    return;
  }
  // A face whose half-edge runs along the edge has its outward normal towards larger angles (edge × d) and
  // its material towards smaller ones: its partner is the next face of the other direction below it. Faces of
  // two solids that share a plane lie at one angle; they are a full turn apart, not a wedge of no thickness.
  constexpr double kSameAngle = 1e-5;
  std::vector<bool> used(spokes.size(), false);
  for (const Spoke& spoke : spokes) {
    if (!spoke.along) continue;
    std::size_t partner = spokes.size();
    double smallest_wedge = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < spokes.size(); ++j) {
      if (spokes[j].along || used[j]) continue;
      double wedge = spoke.angle - spokes[j].angle;
      while (wedge < kSameAngle) wedge += 2 * kPi;
      if (wedge < smallest_wedge) {
        smallest_wedge = wedge;
        partner = j;
      }
    }
    used[partner] = true;
    mesh.twin[spoke.half_edge] = spokes[partner].half_edge;
    mesh.twin[spokes[partner].half_edge] = spoke.half_edge;
  }
}

void find_twins(WeldedMesh& mesh) {
  const auto half_edge_count = std::uint32_t(mesh.triangles.size() * 3);
  mesh.twin.assign(half_edge_count, kBoundary);
  // Half-edges by their smaller vertex (counting sort), then by the other one.
  std::vector<std::uint32_t> begin(mesh.vertices.size() + 2, 0);
  const auto low = [&](std::uint32_t h) { return std::min(mesh.origin(h), mesh.target(h)); };
  const auto high = [&](std::uint32_t h) { return std::max(mesh.origin(h), mesh.target(h)); };
  for (std::uint32_t h = 0; h < half_edge_count; ++h) {
    if (!is_degenerate(mesh.triangles[h / 3])) ++begin[low(h) + 2];
  }
  for (std::size_t v = 2; v < begin.size(); ++v) begin[v] += begin[v - 1];
  struct Entry {
    std::uint32_t high, half_edge;
  };
  std::vector<Entry> entries(begin.back());
  for (std::uint32_t h = 0; h < half_edge_count; ++h) {
    if (!is_degenerate(mesh.triangles[h / 3])) entries[begin[low(h) + 1]++] = {high(h), h};
  }
  std::vector<std::uint32_t> group;
  for (std::size_t v = 0; v + 1 < begin.size(); ++v) {
    const auto first = entries.begin() + begin[v];
    const auto last = entries.begin() + begin[v + 1];
    std::sort(first, last, [](const Entry& a, const Entry& b) {
      return a.high != b.high ? a.high < b.high : a.half_edge < b.half_edge;
    });
    for (auto i = first; i != last;) {
      auto j = i;
      while (j != last && j->high == i->high) ++j;
      if (j - i == 2) {
        const bool opposite = mesh.origin(i[0].half_edge) != mesh.origin(i[1].half_edge);
        mesh.twin[i[0].half_edge] = opposite ? i[1].half_edge : kNonManifold;
        mesh.twin[i[1].half_edge] = opposite ? i[0].half_edge : kNonManifold;
      } else if (j - i > 2) {
        group.clear();
        for (auto k = i; k != j; ++k) group.push_back(k->half_edge);
        pair_around_edge(mesh, group);
      }
      i = j;
    }
  }
}

// Vertices of open edges that lie within other open edges. Splitting the triangles there closes the mesh.
class JunctionHealer {
 public:
  explicit JunctionHealer(WeldedMesh& mesh) : mesh_(mesh) {}

  // Returns whether any triangle was split: twins must then be found again.
  bool heal() {
    collect_open();
    if (open_.empty()) return false;
    std::uint64_t tests = 0;
    for (const std::uint32_t h : open_) {
      find_junctions(h, tests);
      if (junctions_.empty()) continue;
      const std::uint32_t t = h / 3;
      if (split_[t]) continue;  // one edge of a triangle at a time: the next round finds the others
      split_[t] = true;
      split(h);
      mesh_.healed_junctions += junctions_.size();
      any_ = true;
    }
    return any_;
  }

 private:
  void collect_open() {
    Vec3f low(std::numeric_limits<float>::infinity());
    Vec3f high(-std::numeric_limits<float>::infinity());
    for (std::uint32_t h = 0; h < mesh_.twin.size(); ++h) {
      if (mesh_.twin[h] != kBoundary || is_degenerate(mesh_.triangles[h / 3])) continue;
      open_.push_back(h);
      vertices_.push_back(mesh_.origin(h));
      vertices_.push_back(mesh_.target(h));
      low = min(low, mesh_.vertices[mesh_.origin(h)]);
      high = max(high, mesh_.vertices[mesh_.origin(h)]);
    }
    if (open_.empty()) return;
    const Vec3f extent = high - low;
    axis_ = extent.x >= extent.y ? (extent.x >= extent.z ? 0 : 2) : (extent.y >= extent.z ? 1 : 2);
    const Vec3f reach = max(max(high, -low), extent);
    tolerance_ = kJunctionTolerance * double(max_component(reach));
    const auto along = [&](std::uint32_t v) { return mesh_.vertices[v][axis_]; };
    std::ranges::sort(vertices_, [&](std::uint32_t a, std::uint32_t b) {
      return along(a) != along(b) ? along(a) < along(b) : a < b;
    });
    vertices_.erase(std::unique(vertices_.begin(), vertices_.end()), vertices_.end());
    split_.assign(mesh_.triangles.size(), false);
  }

  // Vertices strictly within the edge, in order along it.
  void find_junctions(std::uint32_t h, std::uint64_t& tests) {
    junctions_.clear();
    const Vec3d a(mesh_.vertices[mesh_.origin(h)]);
    const Vec3d b(mesh_.vertices[mesh_.target(h)]);
    const double edge_length = length(b - a);
    if (edge_length <= 2 * tolerance_) return;
    const Vec3d edge = (b - a) / edge_length;
    const double low = std::min(a[axis_], b[axis_]) - tolerance_;
    const double high = std::max(a[axis_], b[axis_]) + tolerance_;
    auto v = std::ranges::lower_bound(
        vertices_, low, {}, [&](std::uint32_t i) { return double(mesh_.vertices[i][axis_]); });
    for (; v != vertices_.end() && mesh_.vertices[*v][axis_] <= high; ++v) {
      if (++tests > kMaxJunctionTests) return;
      const Vec3d p = Vec3d(mesh_.vertices[*v]) - a;
      const double along = dot(p, edge);
      if (along <= tolerance_ || along >= edge_length - tolerance_) continue;
      if (length(p - edge * along) <= tolerance_) junctions_.push_back({along, *v});
    }
    std::ranges::sort(junctions_);
  }

  // (a, b, c) with vertices m1 … mn on a→b: (a, m1, c), (m1, m2, c), … (mn, b, c).
  void split(std::uint32_t h) {
    const std::uint32_t b = mesh_.target(h);
    const std::uint32_t c = mesh_.origin(WeldedMesh::previous(h));
    const std::uint32_t a = mesh_.origin(h);
    mesh_.triangles[h / 3] = {a, junctions_[0].second, c};
    for (std::size_t i = 0; i < junctions_.size(); ++i) {
      const std::uint32_t next = i + 1 < junctions_.size() ? junctions_[i + 1].second : b;
      mesh_.triangles.push_back({junctions_[i].second, next, c});
    }
  }

  WeldedMesh& mesh_;
  std::vector<std::uint32_t> open_, vertices_;
  std::vector<bool> split_;
  std::vector<std::pair<double, std::uint32_t>> junctions_;
  double tolerance_ = 0;
  int axis_ = 0;
  bool any_ = false;
};

void collect_shell(WeldedMesh& mesh, std::uint32_t seed) {
  const auto index = std::uint32_t(mesh.shells.size());
  Shell shell;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  shell.bounds_min = Vec3d(kInfinity);
  shell.bounds_max = Vec3d(-kInfinity);
  shell.first_triangle = std::uint32_t(mesh.triangles_by_shell.size());
  mesh.shell[seed] = index;
  mesh.triangles_by_shell.push_back(seed);
  for (std::size_t i = shell.first_triangle; i < mesh.triangles_by_shell.size(); ++i) {
    const std::uint32_t t = mesh.triangles_by_shell[i];
    for (std::uint32_t k = 0; k < 3; ++k) {
      const Vec3d p(mesh.vertices[mesh.triangles[t][k]]);
      shell.bounds_min = min(shell.bounds_min, p);
      shell.bounds_max = max(shell.bounds_max, p);
      const std::uint32_t twin = mesh.twin[3 * t + k];
      if (twin > kLastHalfEdge) {
        shell.closed = false;
      } else if (mesh.shell[twin / 3] == kNone) {
        mesh.shell[twin / 3] = index;
        mesh.triangles_by_shell.push_back(twin / 3);
      }
    }
  }
  shell.triangle_count = std::uint32_t(mesh.triangles_by_shell.size()) - shell.first_triangle;
  const Vec3d center = shell.center();
  for (std::uint32_t i = 0; i < shell.triangle_count; ++i) {
    const Triangle& t = mesh.triangles[mesh.triangles_by_shell[shell.first_triangle + i]];
    const Vec3d a = Vec3d(mesh.vertices[t[0]]) - center;
    const Vec3d b = Vec3d(mesh.vertices[t[1]]) - center;
    const Vec3d c = Vec3d(mesh.vertices[t[2]]) - center;
    shell.volume += dot(a, cross(b, c)) / 6;
  }
  mesh.shells.push_back(shell);
}

}  // namespace

WeldedMesh make_welded_mesh(const MeshView& mesh, const std::string& name) {
  check_mesh(mesh, name);
  WeldedMesh welded;
  const std::vector<std::uint32_t> vertex_of = weld_positions(mesh.positions, welded.vertices);
  welded.triangles.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    Triangle& corners =
        welded.triangles.emplace_back(Triangle{vertex_of[t[0]], vertex_of[t[1]], vertex_of[t[2]]});
    if (!has_no_area(corners, welded.vertices)) continue;
    corners = {corners[0], corners[0], corners[0]};
    ++welded.degenerate_triangles;
  }
  welded.edge_radii = weld_radii(mesh.edge_radii, vertex_of);
  welded.source.resize(welded.vertices.size());
  for (std::uint32_t i = 0; i < vertex_of.size(); ++i) welded.source[vertex_of[i]] = i;
  if (mesh.sharp_edges) welded.sharp_edges = weld_pairs(*mesh.sharp_edges, vertex_of);
  find_twins(welded);
  while (JunctionHealer(welded).heal()) find_twins(welded);
  welded.shell.assign(welded.triangles.size(), kNone);
  welded.triangles_by_shell.reserve(welded.triangles.size());
  for (std::uint32_t t = 0; t < welded.triangles.size(); ++t) {
    if (welded.shell[t] == kNone && !is_degenerate(welded.triangles[t])) collect_shell(welded, t);
  }
  return welded;
}

}  // namespace arris
