// convex_solids.h — seeded convex solids and the many ways in which a mesh can describe one
// What       regular and random convex polyhedra in double; make_mesh() turns one into float
// positions
//            and triangles with a chosen style: triangulation, split edges, T-junctions, unwelded
//            corners, orientation, shuffling, scale, translation. The planes handed to the oracle
//            are those of the float corners actually used.
// Guarantee  same seed, same mesh
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <numeric>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "arris/math.h"
#include "support/convex_oracle.h"

namespace arris::oracle {

// Faces are loops of vertex indices, counter-clockwise seen from outside.
struct Polyhedron {
  std::string name;
  std::vector<Vec3d> vertices;
  std::vector<std::vector<std::uint32_t>> faces;
};

using Random = std::mt19937_64;

inline double uniform(Random& rng, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(rng);
}
inline int uniform_int(Random& rng, int low, int high) {
  return std::uniform_int_distribution<int>(low, high)(rng);
}
inline Vec3d random_direction(Random& rng) {
  std::normal_distribution<double> gauss;
  for (;;) {
    const Vec3d v{gauss(rng), gauss(rng), gauss(rng)};
    if (length(v) > 1e-3) return normalize(v);
  }
}
inline Mat3d random_rotation(Random& rng) {
  const Vec3d x = random_direction(rng);
  const Vec3d y = normalize(cross(x, random_direction(rng)));
  return {x, y, cross(x, y)};
}

// --- polyhedra -----------------------------------------------------------------------------------

// Orders the points of a face counter-clockwise about its outward normal.
inline std::vector<std::uint32_t> ordered_loop(const std::vector<Vec3d>& points,
                                               std::vector<std::uint32_t> face, Vec3d normal) {
  Vec3d middle;
  for (auto i : face) middle += points[i];
  middle = middle / double(face.size());
  const Vec3d u = normalize(points[face[0]] - middle);
  const Vec3d v = cross(normal, u);
  std::sort(face.begin(), face.end(), [&](std::uint32_t a, std::uint32_t b) {
    const Vec3d pa = points[a] - middle, pb = points[b] - middle;
    return std::atan2(dot(pa, v), dot(pa, u)) < std::atan2(dot(pb, v), dot(pb, u));
  });
  return face;
}

// Convex hull by trying every triple of points; coplanar triples become one face.
// Precondition: every point is a corner of the hull, or well inside it.
inline Polyhedron hull_of(std::string name, const std::vector<Vec3d>& points) {
  Vec3d low = points[0], high = points[0];
  for (Vec3d p : points) {
    low = min(low, p);
    high = max(high, p);
  }
  const double flat = 1e-9 * max_component(high - low);
  std::map<std::vector<std::uint32_t>, Vec3d> faces;  // corners → outward normal
  const auto count = std::uint32_t(points.size());
  for (std::uint32_t i = 0; i < count; ++i)
    for (std::uint32_t j = i + 1; j < count; ++j)
      for (std::uint32_t k = j + 1; k < count; ++k) {
        const Vec3d area = cross(points[j] - points[i], points[k] - points[i]);
        if (length(area) < flat * flat) continue;
        const Vec3d n = normalize(area);
        bool above = false, below = false;
        std::vector<std::uint32_t> on;
        for (std::uint32_t m = 0; m < count && !(above && below); ++m) {
          const double side = dot(n, points[m] - points[i]);
          if (side > flat)
            above = true;
          else if (side < -flat)
            below = true;
          else
            on.push_back(m);
        }
        if (above == below) continue;
        faces.emplace(std::move(on), above ? -n : n);
      }
  Polyhedron hull{std::move(name), {}, {}};
  std::map<std::uint32_t, std::uint32_t> used;
  for (const auto& [corners, normal] : faces) {
    std::vector<std::uint32_t> loop = ordered_loop(points, corners, normal);
    for (auto& i : loop) {
      const auto [at, is_new] = used.emplace(i, std::uint32_t(hull.vertices.size()));
      if (is_new) hull.vertices.push_back(points[i]);
      i = at->second;
    }
    hull.faces.push_back(std::move(loop));
  }
  return hull;
}

// Corners of {n_k·x ≤ d_k} by trying every triple of planes. Precondition: bounded, not empty.
inline Polyhedron intersection_of(std::string name, const std::vector<Plane>& planes) {
  std::vector<Vec3d> corners;
  for (std::size_t i = 0; i < planes.size(); ++i)
    for (std::size_t j = i + 1; j < planes.size(); ++j)
      for (std::size_t k = j + 1; k < planes.size(); ++k) {
        const Mat3d rows{planes[i].normal, planes[j].normal, planes[k].normal};
        if (std::abs(determinant(rows)) < 1e-6) continue;
        const Vec3d x =
            inverse(transpose(rows)) * Vec3d(planes[i].offset, planes[j].offset, planes[k].offset);
        if (find_violated(planes, 0, x, 1e-9)) continue;
        const bool known = std::any_of(corners.begin(), corners.end(),
                                       [&](Vec3d c) { return length(c - x) < 1e-7; });
        if (!known) corners.push_back(x);
      }
  return hull_of(std::move(name), corners);
}

inline Polyhedron box(Vec3d size) {
  std::vector<Vec3d> p;
  for (int i = 0; i < 8; ++i)
    p.push_back(Vec3d(i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5) * size);
  return hull_of("box", p);
}
inline Polyhedron cube() {
  Polyhedron p = box({1, 1, 1});
  p.name = "cube";
  return p;
}
inline Polyhedron tetrahedron() {
  return hull_of("tetrahedron", {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}});
}
inline Polyhedron octahedron() {
  return hull_of("octahedron",
                 {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}});
}
inline Polyhedron icosahedron() {
  const double g = std::numbers::phi;
  std::vector<Vec3d> p;
  for (double a : {-1.0, 1.0})
    for (double b : {-g, g}) {
      p.push_back({0, a, b});
      p.push_back({a, b, 0});
      p.push_back({b, 0, a});
    }
  return hull_of("icosahedron", p);
}
inline Polyhedron dodecahedron() {
  const double g = std::numbers::phi;
  std::vector<Vec3d> p;
  for (double a : {-1.0, 1.0})
    for (double b : {-1.0, 1.0}) {
      for (double c : {-1.0, 1.0}) p.push_back({a, b, c});
      p.push_back({0, a / g, b * g});
      p.push_back({a / g, b * g, 0});
      p.push_back({b * g, 0, a / g});
    }
  return hull_of("dodecahedron", p);
}
inline Polyhedron prism(int sides, double height) {
  std::vector<Vec3d> p;
  for (int i = 0; i < sides; ++i) {
    const double a = 2 * kPi * i / sides;
    for (double z : {-0.5, 0.5}) p.push_back({std::cos(a), std::sin(a), z * height});
  }
  return hull_of("prism" + std::to_string(sides), p);
}
// All faces at the apex touch one ball: the edges' axes meet there.
inline Polyhedron pyramid(int sides, double height) {
  std::vector<Vec3d> p{{0, 0, height}};
  for (int i = 0; i < sides; ++i) {
    const double a = 2 * kPi * i / sides;
    p.push_back({std::cos(a), std::sin(a), 0});
  }
  return hull_of("pyramid" + std::to_string(sides), p);
}
// `sides` faces of different slopes through one apex: no ball touches all of them, so that the apex
// becomes several vertices of the erosion.
inline Polyhedron crooked_pyramid(Random& rng, int sides) {
  for (;;) {
    std::vector<Plane> planes{{{0, 0, -1}, 0.4}};
    for (int i = 0; i < sides; ++i) {
      const double a = 2 * kPi * (i + uniform(rng, -0.25, 0.25)) / sides;
      const double slope = uniform(rng, 0.25, 0.75);
      const Vec3d n = normalize(Vec3d(std::cos(a), std::sin(a), slope));
      planes.push_back({n, n.z});  // through (0, 0, 1)
    }
    Polyhedron p = intersection_of("crooked_pyramid" + std::to_string(sides), planes);
    if (p.faces.size() == planes.size()) return p;
  }
}
// Convex hull of random points near a sphere: triangles, corners with 3 to about 9 faces.
inline Polyhedron hull_stone(Random& rng, int points) {
  const Vec3d stretch{uniform(rng, 0.5, 1), uniform(rng, 0.5, 1), uniform(rng, 0.5, 1)};
  std::vector<Vec3d> p;
  for (int i = 0; i < points; ++i)
    p.push_back(random_direction(rng) * uniform(rng, 0.7, 1) * stretch);
  return hull_of("hull_stone" + std::to_string(points), p);
}
// Intersection of random half-spaces within a box: polygons, corners with 3 faces.
inline Polyhedron cut_stone(Random& rng, int cuts) {
  std::vector<Plane> planes;
  for (int axis = 0; axis < 3; ++axis)
    for (double side : {-1.0, 1.0}) {
      Vec3d n;
      n[axis] = side;
      planes.push_back({n, uniform(rng, 0.7, 1.1)});
    }
  for (int i = 0; i < cuts; ++i) planes.push_back({random_direction(rng), uniform(rng, 0.6, 1)});
  return intersection_of("cut_stone" + std::to_string(cuts), planes);
}

// Unit outward normal and offset of a loop of corners (Newell).
inline Plane plane_of(const std::vector<Vec3d>& corners) {
  Vec3d middle, area;
  for (Vec3d p : corners) middle += p;
  middle = middle / double(corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i)
    area += cross(corners[i] - middle, corners[(i + 1) % corners.size()] - middle);
  const Vec3d n = normalize(area);
  return {n, dot(n, middle)};
}

// Smallest turn between two neighbouring faces, in radians.
inline double least_turn(const Polyhedron& p) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, Vec3d> normal_of;
  for (const auto& face : p.faces) {
    std::vector<Vec3d> corners;
    for (auto i : face) corners.push_back(p.vertices[i]);
    for (std::size_t i = 0; i < face.size(); ++i)
      normal_of[{face[i], face[(i + 1) % face.size()]}] = plane_of(corners).normal;
  }
  double least = kPi;
  for (const auto& [edge, n] : normal_of) {
    const Vec3d m = normal_of.at({edge.second, edge.first});
    least = std::min(least, std::atan2(length(cross(n, m)), dot(n, m)));
  }
  return least;
}

inline double shortest_edge(const Polyhedron& p) {
  double least = kInfinity;
  for (const auto& face : p.faces)
    for (std::size_t i = 0; i < face.size(); ++i)
      least =
          std::min(least, length(p.vertices[face[i]] - p.vertices[face[(i + 1) % face.size()]]));
  return least;
}

// --- meshes --------------------------------------------------------------------------------------

enum class Triangulation { fan, random_ears, centre };
enum class Sharing { welded, per_face, per_triangle };
enum class EdgeSplit {
  none,
  shared,
  t_junction
};  // t_junction: only one face has the extra points

struct MeshStyle {
  Triangulation triangulation = Triangulation::fan;
  Sharing sharing = Sharing::welded;
  EdgeSplit split = EdgeSplit::none;
  bool shuffled = false;
  bool inward = false;  // all triangles turned inside out
  bool rotated = false;
  double scale = 1;
  double offset = 0;  // translation, in sizes of the solid
};

inline MeshStyle random_style(Random& rng) {
  MeshStyle s;
  s.triangulation = Triangulation(uniform_int(rng, 0, 2));
  s.sharing = Sharing(uniform_int(rng, 0, 2));
  s.split = uniform_int(rng, 0, 1) != 0 ? EdgeSplit::shared : EdgeSplit::none;
  s.shuffled = uniform_int(rng, 0, 1) != 0;
  s.rotated = uniform_int(rng, 0, 3) != 0;
  s.scale = std::pow(10, uniform(rng, -3, 3));
  return s;
}

struct SolidMesh {
  std::string name;
  std::vector<Vec3f> positions;
  std::vector<Triangle> triangles;
  ConvexSolid solid;                           // from the float corners
  std::vector<Vec3d> corners;                  // float values
  std::vector<std::pair<Vec3d, Vec3d>> edges;  // between corners, each once
  double quantum = 0;                          // rounding error of the float positions

  [[nodiscard]] MeshView view() const { return {positions, triangles}; }
};

// Sine of the angle at point i of a loop: 0 where it is collinear with its neighbours.
inline double corner_sine(const std::vector<Vec3d>& loop, std::size_t i) {
  const Vec3d a = loop[i] - loop[(i + loop.size() - 1) % loop.size()];
  const Vec3d b = loop[(i + 1) % loop.size()] - loop[i];
  return length(cross(a, b)) / (length(a) * length(b));
}

// How wide the loop still is without point i: the largest sine at its other points.
inline double width_without(std::vector<Vec3d> loop, std::size_t i) {
  loop.erase(loop.begin() + std::ptrdiff_t(i));
  double widest = 0;
  for (std::size_t j = 0; j < loop.size(); ++j) widest = std::max(widest, corner_sine(loop, j));
  return widest;
}

enum class EarOrder { first, random };

// Cuts ears of a convex loop that may have collinear points; makes no degenerate triangle where one can be avoided.
inline std::vector<Triangle> cut_ears(std::vector<Vec3d> loop, std::vector<std::uint32_t> index,
                                      EarOrder order, Random& rng) {
  constexpr double kCollinear = 1e-3;
  std::vector<Triangle> triangles;
  while (loop.size() > 3) {
    std::vector<std::size_t> ears;
    std::size_t best = 0;
    double best_width = -1;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const double width = std::min(corner_sine(loop, i), width_without(loop, i));
      if (width > kCollinear) ears.push_back(i);
      if (width > best_width) {
        best_width = width;
        best = i;
      }
    }
    if (ears.empty()) ears.push_back(best);
    const std::size_t n = loop.size();
    const std::size_t i = order == EarOrder::first
                              ? ears.front()
                              : ears[std::size_t(uniform_int(rng, 0, int(ears.size()) - 1))];
    triangles.push_back({index[(i + n - 1) % n], index[i], index[(i + 1) % n]});
    loop.erase(loop.begin() + std::ptrdiff_t(i));
    index.erase(index.begin() + std::ptrdiff_t(i));
  }
  triangles.push_back({index[0], index[1], index[2]});
  return triangles;
}

// Builds the mesh of one polyhedron face by face, then shares, orients and shuffles.
class MeshBuilder {
 public:
  MeshBuilder(const Polyhedron& polyhedron, const MeshStyle& style, std::uint64_t seed)
      : polyhedron_(polyhedron), style_(style), rng_(seed) {
    mesh_.name = polyhedron.name;
  }

  SolidMesh build() {
    place_corners();
    set_solid();
    for (const auto& face : polyhedron_.faces) add_face(face);
    if (style_.sharing != Sharing::welded) unshare();
    for (Triangle& t : mesh_.triangles) orient(t);
    if (style_.shuffled) shuffle();
    return std::move(mesh_);
  }

 private:
  // Corners as floats: everything after works on these.
  void place_corners() {
    const Mat3d turn = style_.rotated ? random_rotation(rng_) : Mat3d{};
    Vec3d low(kInfinity), high(-kInfinity);
    std::vector<Vec3d> placed;
    for (Vec3d p : polyhedron_.vertices) {
      placed.push_back(turn * p * style_.scale);
      low = min(low, placed.back());
      high = max(high, placed.back());
    }
    const Vec3d shift = Vec3d(1, -0.7, 0.4) * (style_.offset * max_component(high - low));
    double reach = 0;
    for (Vec3d p : placed) {
      mesh_.positions.push_back(Vec3f(p + shift));
      mesh_.corners.push_back(Vec3d(mesh_.positions.back()));
      for (int axis = 0; axis < 3; ++axis)
        reach = std::max(reach, std::abs(mesh_.corners.back()[axis]));
    }
    mesh_.quantum = reach * 0x1p-24;
  }

  void set_solid() {
    Vec3d low(kInfinity), high(-kInfinity);
    for (Vec3d p : mesh_.corners) {
      low = min(low, p);
      high = max(high, p);
      mesh_.solid.center += p / double(mesh_.corners.size());
    }
    mesh_.solid.size = max_component(high - low);
    for (const auto& face : polyhedron_.faces) {
      std::vector<Vec3d> loop;
      for (std::size_t i = 0; i < face.size(); ++i) {
        const auto a = face[i], b = face[(i + 1) % face.size()];
        loop.push_back(mesh_.corners[a] - mesh_.solid.center);
        if (a < b) mesh_.edges.emplace_back(mesh_.corners[a], mesh_.corners[b]);
      }
      mesh_.solid.planes.push_back(plane_of(loop));
    }
  }

  // The extra vertices of edge a→b in that order; made when first asked for, so that both faces
  // share them.
  std::vector<std::uint32_t> split_points(std::uint32_t a, std::uint32_t b) {
    if (style_.split == EdgeSplit::none) return {};
    if (style_.split == EdgeSplit::t_junction && a < b) return {};
    const auto key = std::minmax(a, b);
    auto found = splits_.find(key);
    if (found == splits_.end()) {
      const int pieces = uniform_int(rng_, 2, 3);
      std::vector<double> at;
      for (int i = 1; i < pieces; ++i) at.push_back((i + uniform(rng_, -0.3, 0.3)) / pieces);
      std::vector<std::uint32_t> points;
      for (double u : at) {
        const Vec3d p = mesh_.corners[key.first] * (1 - u) + mesh_.corners[key.second] * u;
        points.push_back(std::uint32_t(mesh_.positions.size()));
        mesh_.positions.push_back(Vec3f(p));
      }
      found = splits_.emplace(key, std::move(points)).first;
    }
    std::vector<std::uint32_t> points = found->second;
    if (a > b) std::reverse(points.begin(), points.end());
    return points;
  }

  void add_face(const std::vector<std::uint32_t>& face) {
    std::vector<std::uint32_t> loop;
    for (std::size_t i = 0; i < face.size(); ++i) {
      loop.push_back(face[i]);
      for (auto p : split_points(face[i], face[(i + 1) % face.size()])) loop.push_back(p);
    }
    std::vector<Vec3d> points;
    for (auto i : loop) points.push_back(Vec3d(mesh_.positions[i]));
    if (style_.triangulation == Triangulation::centre) {
      Vec3d middle;
      for (auto i : face) middle += mesh_.corners[i] / double(face.size());
      const auto m = std::uint32_t(mesh_.positions.size());
      mesh_.positions.push_back(Vec3f(middle));
      for (std::size_t i = 0; i < loop.size(); ++i)
        add_triangle({m, loop[i], loop[(i + 1) % loop.size()]});
    } else {
      const EarOrder order =
          style_.triangulation == Triangulation::fan ? EarOrder::first : EarOrder::random;
      for (Triangle t : cut_ears(points, loop, order, rng_)) add_triangle(t);
    }
    ++face_;
  }

  void add_triangle(Triangle t) {
    mesh_.triangles.push_back(t);
    face_of_.push_back(face_);
  }

  void unshare() {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t>
        copies;  // (group, vertex) → new vertex
    std::vector<Vec3f> positions;
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t)
      for (auto& v : mesh_.triangles[t]) {
        const auto group = style_.sharing == Sharing::per_face ? face_of_[t] : t;
        const auto [at, is_new] =
            copies.emplace(std::pair{group, v}, std::uint32_t(positions.size()));
        if (is_new) positions.push_back(mesh_.positions[v]);
        v = at->second;
      }
    mesh_.positions = std::move(positions);
  }

  void orient(Triangle& t) const {
    if (style_.inward) std::swap(t[1], t[2]);
  }

  void shuffle() {
    std::vector<std::uint32_t> order(mesh_.positions.size());
    std::iota(order.begin(), order.end(), 0U);
    std::shuffle(order.begin(), order.end(), rng_);
    std::vector<Vec3f> positions(order.size());
    for (std::size_t i = 0; i < order.size(); ++i) positions[order[i]] = mesh_.positions[i];
    mesh_.positions = std::move(positions);
    for (Triangle& t : mesh_.triangles) {
      for (auto& v : t) v = order[v];
      std::rotate(t.begin(), t.begin() + uniform_int(rng_, 0, 2), t.end());
    }
    std::shuffle(mesh_.triangles.begin(), mesh_.triangles.end(), rng_);
  }

  const Polyhedron& polyhedron_;
  MeshStyle style_;
  Random rng_;
  SolidMesh mesh_;
  std::uint32_t face_ = 0;
  std::vector<std::uint32_t> face_of_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> splits_;
};

inline SolidMesh make_mesh(const Polyhedron& polyhedron, const MeshStyle& style,
                           std::uint64_t seed) {
  return MeshBuilder(polyhedron, style, seed).build();
}

// Every kind of solid once; random ones anew for each seed.
inline std::vector<Polyhedron> make_solids(std::uint64_t seed) {
  Random rng(seed);
  std::vector<Polyhedron> solids{cube(), tetrahedron(), octahedron(), icosahedron(),
                                 dodecahedron()};
  solids.push_back(box({1, uniform(rng, 0.3, 1), uniform(rng, 0.3, 1)}));
  solids.push_back(box({1, uniform(rng, 0.5, 1), uniform(rng, 0.02, 0.06)}));
  solids.back().name = "slab";
  for (int sides = 3; sides <= 12; ++sides) solids.push_back(prism(sides, uniform(rng, 0.4, 2.5)));
  for (int sides = 4; sides <= 8; ++sides) solids.push_back(pyramid(sides, uniform(rng, 0.5, 2)));
  const auto add_random = [&](auto make) {
    for (;;) {
      Polyhedron made = make();
      // Below half a degree or 0.2% of the size, float positions no longer say where an edge is.
      if (least_turn(made) > radians(0.5) && shortest_edge(made) > 4e-3) {
        solids.push_back(std::move(made));
        return;
      }
    }
  };
  for (int sides = 4; sides <= 7; ++sides) add_random([&] { return crooked_pyramid(rng, sides); });
  for (int i = 0; i < 5; ++i) add_random([&] { return hull_stone(rng, uniform_int(rng, 6, 22)); });
  for (int i = 0; i < 5; ++i) add_random([&] { return cut_stone(rng, uniform_int(rng, 1, 12)); });
  return solids;
}

}  // namespace arris::oracle
