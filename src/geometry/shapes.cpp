#include "geometry/shapes.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <map>
#include <utility>
#include <vector>

namespace arris {
namespace {

using Polygon = std::vector<std::uint32_t>;

void add_polygon(const Polygon& polygon, Mesh& mesh) {
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    mesh.triangles.push_back({polygon[0], polygon[i - 1], polygon[i]});
  }
}

// Convex and around the origin: polygons are turned so that they face away from it.
Mesh make_polyhedron(const std::vector<Vec3d>& corners, const std::vector<Polygon>& faces,
                     double radius) {
  Mesh mesh;
  for (const Vec3d& corner : corners) mesh.positions.emplace_back(normalize(corner) * radius);
  for (Polygon face : faces) {
    const Vec3d a = corners[face[0]], b = corners[face[1]], c = corners[face[2]];
    if (dot(cross(b - a, c - a), a) < 0) std::ranges::reverse(face);
    add_polygon(face, mesh);
  }
  return mesh;
}

// A ring of points at one height; a radius of 0 gives one point.
Polygon add_ring(double radius, double z, int segments, Mesh& mesh) {
  Polygon ring;
  for (int i = 0; i < (radius > 0 ? segments : 1); ++i) {
    const double angle = 2 * kPi * i / segments;
    ring.push_back(std::uint32_t(mesh.positions.size()));
    mesh.positions.emplace_back(Vec3d(radius * std::cos(angle), radius * std::sin(angle), z));
  }
  return ring;
}

// Quads or triangles between two rings, the first one below.
void add_band(const Polygon& below, const Polygon& above, Mesh& mesh) {
  const std::size_t segments = std::max(below.size(), above.size());
  const auto at = [&](const Polygon& ring, std::size_t i) {
    return ring.size() == 1 ? ring[0] : ring[i % ring.size()];
  };
  for (std::size_t i = 0; i < segments; ++i) {
    const std::uint32_t a = at(below, i), b = at(below, i + 1);
    const std::uint32_t c = at(above, i + 1), d = at(above, i);
    if (a != b) mesh.triangles.push_back({a, b, c});
    if (c != d) mesh.triangles.push_back({a, c, d});
  }
}

void add_caps(const Polygon& bottom, const Polygon& top, Mesh& mesh) {
  add_polygon({bottom.rbegin(), bottom.rend()}, mesh);
  add_polygon(top, mesh);
}

// With normals. A tip has a vertex for each segment, whose normal is that of the segment's middle.
void add_cone_side(const ConeShape& shape, Mesh& mesh) {
  const double rise = shape.bottom_radius - shape.top_radius;
  const auto add_vertex = [&](double radius, double z, int step) {
    const double angle = 2 * kPi * (radius > 0 ? step : step + 0.5) / shape.segments;
    const Vec3d out(std::cos(angle), std::sin(angle), 0);
    mesh.positions.emplace_back(out * radius + Vec3d(0, 0, z));
    mesh.normals.emplace_back(normalize(out * shape.height + Vec3d(0, 0, rise)));
  };
  for (int i = 0; i < shape.segments; ++i) {
    add_vertex(shape.bottom_radius, -shape.height / 2, i);
    add_vertex(shape.top_radius, shape.height / 2, i);
  }
  for (int i = 0; i < shape.segments; ++i) {
    const auto here = std::uint32_t(2 * i), next = std::uint32_t(2 * ((i + 1) % shape.segments));
    const std::uint32_t tip_or_next = shape.top_radius > 0 ? next + 1 : here + 1;
    if (shape.bottom_radius > 0) mesh.triangles.push_back({here, next, tip_or_next});
    if (shape.top_radius > 0) mesh.triangles.push_back({here, next + 1, here + 1});
  }
}

constexpr double kGolden = std::numbers::phi;

std::vector<Vec3d> icosahedron_corners() {
  std::vector<Vec3d> corners;
  for (const double s : {-1.0, 1.0}) {
    for (const double t : {-kGolden, kGolden}) {
      corners.emplace_back(0, s, t);
      corners.emplace_back(s, t, 0);
      corners.emplace_back(t, 0, s);
    }
  }
  return corners;
}

// All triples of corners at the least distance from each other.
std::vector<Polygon> icosahedron_faces(const std::vector<Vec3d>& corners) {
  const auto near = [&](std::uint32_t i, std::uint32_t k) {
    return length_squared(corners[i] - corners[k]) < 4.5;  // edges have length 2
  };
  std::vector<Polygon> faces;
  for (std::uint32_t i = 0; i < 12; ++i) {
    for (std::uint32_t j = i + 1; j < 12; ++j) {
      for (std::uint32_t k = j + 1; k < 12; ++k) {
        if (near(i, j) && near(j, k) && near(i, k)) faces.push_back({i, j, k});
      }
    }
  }
  return faces;
}

}  // namespace

Mesh make_box_mesh(Vec3d size) {
  const Vec3d h = size * 0.5;
  Mesh mesh;
  mesh.name = "box";
  for (int i = 0; i < 8; ++i) {
    mesh.positions.emplace_back(
        Vec3d((i & 1) != 0 ? h.x : -h.x, (i & 2) != 0 ? h.y : -h.y, (i & 4) != 0 ? h.z : -h.z));
  }
  for (const Polygon& face : std::initializer_list<Polygon>{
           {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
    add_polygon(face, mesh);
  }
  return mesh;
}

Mesh make_plane_mesh(Vec2d size) {
  const Vec2d h{size.x / 2, size.y / 2};
  Mesh mesh;
  mesh.name = "plane";
  for (const Vec3d& p :
       {Vec3d(-h.x, -h.y, 0), Vec3d(h.x, -h.y, 0), Vec3d(h.x, h.y, 0), Vec3d(-h.x, h.y, 0)}) {
    mesh.positions.emplace_back(p);
  }
  mesh.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  add_polygon({0, 1, 2, 3}, mesh);
  return mesh;
}

Mesh make_sphere_mesh(double radius, int segments) {
  const int rings = std::max(2, segments / 2);
  Mesh mesh;
  mesh.name = "sphere";
  Polygon below = add_ring(0, -radius, segments, mesh);
  for (int i = 1; i <= rings; ++i) {
    const double angle = kPi * i / rings;
    const Polygon ring =
        i == rings ? add_ring(0, radius, segments, mesh)
                   : add_ring(radius * std::sin(angle), -radius * std::cos(angle), segments, mesh);
    add_band(below, ring, mesh);
    below = ring;
  }
  for (const Vec3f& p : mesh.positions) mesh.normals.emplace_back(normalize(Vec3d(p)));
  return mesh;
}

Mesh make_icosphere_mesh(double radius, int subdivisions) {
  Mesh mesh = make_icosahedron_mesh(radius);
  mesh.name = "icosphere";
  for (int round = 0; round < subdivisions; ++round) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [entry, is_new] =
          middles.try_emplace(std::minmax(a, b), std::uint32_t(mesh.positions.size()));
      if (is_new) {
        const Vec3d sum = Vec3d(mesh.positions[a]) + Vec3d(mesh.positions[b]);
        mesh.positions.emplace_back(normalize(sum) * radius);
      }
      return entry->second;
    };
    std::vector<Triangle> finer;
    finer.reserve(mesh.triangles.size() * 4);
    for (const Triangle& t : mesh.triangles) {
      const std::uint32_t a = middle(t[0], t[1]), b = middle(t[1], t[2]), c = middle(t[2], t[0]);
      finer.insert(finer.end(), {{t[0], a, c}, {t[1], b, a}, {t[2], c, b}, {a, b, c}});
    }
    mesh.triangles = std::move(finer);
  }
  return mesh;
}

Mesh make_prism_mesh(const ConeShape& shape) {
  Mesh mesh;
  mesh.name = "prism";
  const Polygon bottom = add_ring(shape.bottom_radius, -shape.height / 2, shape.segments, mesh);
  const Polygon top = add_ring(shape.top_radius, shape.height / 2, shape.segments, mesh);
  add_band(bottom, top, mesh);
  add_caps(bottom, top, mesh);
  return mesh;
}

Mesh make_cone_mesh(const ConeShape& shape) {
  Mesh mesh;
  mesh.name = "cone";
  add_cone_side(shape, mesh);
  const Polygon bottom = add_ring(shape.bottom_radius, -shape.height / 2, shape.segments, mesh);
  mesh.normals.resize(mesh.positions.size(), Vec3f(0, 0, -1));
  const Polygon top = add_ring(shape.top_radius, shape.height / 2, shape.segments, mesh);
  mesh.normals.resize(mesh.positions.size(), Vec3f(0, 0, 1));
  add_caps(bottom, top, mesh);
  return mesh;
}

Mesh make_tetrahedron_mesh(double radius) {
  Mesh mesh = make_polyhedron({{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}},
                              {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}}, radius);
  mesh.name = "tetrahedron";
  return mesh;
}

Mesh make_octahedron_mesh(double radius) {
  std::vector<Polygon> faces;
  for (std::uint32_t x : {0U, 1U}) {
    for (std::uint32_t y : {2U, 3U}) {
      for (std::uint32_t z : {4U, 5U}) faces.push_back({x, y, z});
    }
  }
  Mesh mesh = make_polyhedron({{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
                              faces, radius);
  mesh.name = "octahedron";
  return mesh;
}

Mesh make_icosahedron_mesh(double radius) {
  const std::vector<Vec3d> corners = icosahedron_corners();
  Mesh mesh = make_polyhedron(corners, icosahedron_faces(corners), radius);
  mesh.name = "icosahedron";
  return mesh;
}

// The dual of the icosahedron: a corner for each of its faces, a pentagon for each of its corners.
Mesh make_dodecahedron_mesh(double radius) {
  const std::vector<Vec3d> axes = icosahedron_corners();
  const std::vector<Polygon> triples = icosahedron_faces(axes);
  std::vector<Vec3d> corners;
  for (const Polygon& t : triples) corners.push_back(axes[t[0]] + axes[t[1]] + axes[t[2]]);
  std::vector<Polygon> pentagons;
  for (std::uint32_t axis = 0; axis < axes.size(); ++axis) {
    Polygon pentagon;
    for (std::uint32_t i = 0; i < triples.size(); ++i) {
      if (std::ranges::find(triples[i], axis) != triples[i].end()) pentagon.push_back(i);
    }
    const Vec3d first = corners[pentagon[0]];
    const Vec3d x = first - axes[axis] * (dot(first, axes[axis]) / length_squared(axes[axis]));
    const Vec3d y = cross(axes[axis], x);
    std::ranges::sort(pentagon, {}, [&](std::uint32_t i) {
      return std::atan2(dot(corners[i], y) / length(y), dot(corners[i], x) / length(x));
    });
    pentagons.push_back(pentagon);
  }
  Mesh mesh = make_polyhedron(corners, pentagons, radius);
  mesh.name = "dodecahedron";
  return mesh;
}

}  // namespace arris
