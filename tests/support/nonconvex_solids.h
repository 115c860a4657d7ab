// nonconvex_solids.h — seeded solids that are not convex, and all that makes them hard to round
// What       prisms over outlines with notches, fingers and blades, straight, tapered or twisted; solids of random
//            cells of a grid with uneven spacing: pockets, slots, steps, walls; stars of thin spikes. Each may be
//            skewed.
// Guarantee  same seed, same mesh; closed, outward
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "arris/rounding.h"
#include "support/convex_solids.h"

namespace arris::oracle {

struct TriangleSoup {
  std::string name;
  std::vector<Vec3f> positions;
  std::vector<Triangle> triangles;

  [[nodiscard]] MeshView view() const { return {positions, triangles}; }
  [[nodiscard]] double size() const {
    Vec3f low = positions[0], high = low;
    for (Vec3f p : positions) {
      low = min(low, p);
      high = max(high, p);
    }
    return double(length(high - low));
  }
};

using Outline = std::vector<std::pair<double, double>>;  // counter-clockwise

// Triangles of a simple polygon, by cutting off ears.
inline std::vector<Triangle> cut_ears(const Outline& outline) {
  const auto side = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const auto [ax, ay] = outline[a];
    const auto [bx, by] = outline[b];
    const auto [cx, cy] = outline[c];
    return (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
  };
  std::vector<std::uint32_t> left(outline.size());
  for (std::uint32_t i = 0; i < left.size(); ++i) left[i] = i;
  std::vector<Triangle> out;
  while (left.size() > 2) {
    bool found = false;
    for (std::size_t i = 0; i < left.size() && !found; ++i) {
      const std::uint32_t a = left[(i + left.size() - 1) % left.size()], b = left[i],
                          c = left[(i + 1) % left.size()];
      if (side(a, b, c) <= 0) continue;
      bool empty = true;
      for (std::uint32_t p : left) {
        if (p == a || p == b || p == c) continue;
        empty = empty && !(side(a, b, p) >= 0 && side(b, c, p) >= 0 && side(c, a, p) >= 0);
      }
      if (!empty) continue;
      out.push_back({a, b, c});
      left.erase(left.begin() + std::ptrdiff_t(i));
      found = true;
    }
    if (!found) break;
  }
  return out;
}

struct PrismShape {
  double height = 1;
  double taper = 1;  // size of the top against the bottom
  double twist = 0;  // of the top, radians: the sides fold into two triangles each
};

inline TriangleSoup prism_over(std::string name, const Outline& outline, PrismShape shape) {
  TriangleSoup mesh{std::move(name), {}, {}};
  const auto n = std::uint32_t(outline.size());
  for (const auto& [x, y] : outline) mesh.positions.push_back({float(x), float(y), 0});
  const double c = std::cos(shape.twist) * shape.taper, s = std::sin(shape.twist) * shape.taper;
  for (const auto& [x, y] : outline)
    mesh.positions.push_back({float(c * x - s * y), float(s * x + c * y), float(shape.height)});
  for (const Triangle& t : cut_ears(outline)) {
    mesh.triangles.push_back({t[2], t[1], t[0]});
    mesh.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    mesh.triangles.push_back({i, j, j + n});
    mesh.triangles.push_back({i, j + n, i + n});
  }
  return mesh;
}

inline Outline teeth_around(int count, double inner, double width) {
  Outline outline;
  for (int i = 0; i < count; ++i) {
    const double step = 2 * kPi / count, a = step * i;
    for (const auto& [at, radius] : {std::pair(-0.5 * width, inner), std::pair(-0.3 * width, 1.0),
                                     std::pair(0.3 * width, 1.0), std::pair(0.5 * width, inner)})
      outline.push_back({radius * std::cos(a + at * step), radius * std::sin(a + at * step)});
  }
  return outline;
}

inline Outline star_outline(int points, double inner) {
  Outline outline;
  for (int i = 0; i < 2 * points; ++i) {
    const double radius = i % 2 == 0 ? 1 : inner, a = kPi * i / points;
    outline.push_back({radius * std::cos(a), radius * std::sin(a)});
  }
  return outline;
}

// L, U, T, cross, comb, star, gear, bent blade; w: width of the thinnest part.
inline std::vector<std::pair<std::string, Outline>> make_outlines(Random& rng, double w) {
  std::vector<std::pair<std::string, Outline>> all;
  all.push_back({"L", {{0, 0}, {2, 0}, {2, w}, {w, w}, {w, 2}, {0, 2}}});
  all.push_back({"U", {{0, 0}, {1, 0}, {1, 1}, {1 - w, 1}, {1 - w, w}, {w, w}, {w, 1}, {0, 1}}});
  all.push_back(
      {"T", {{-w, 0}, {w, 0}, {w, 1}, {1.2, 1}, {1.2, 1 + w}, {-1.2, 1 + w}, {-1.2, 1}, {-w, 1}}});
  all.push_back({"cross",
                 {{-w, -1},
                  {w, -1},
                  {w, -w},
                  {1, -w},
                  {1, w},
                  {w, w},
                  {w, 1},
                  {-w, 1},
                  {-w, w},
                  {-1, w},
                  {-1, -w},
                  {-w, -w}}});
  Outline comb{{0, 0}, {2, 0}};
  for (int i = 4; i >= 0; --i) {
    const double x = 0.4 * i, wide = std::min(w, 0.3);
    comb.push_back({x + 0.05 + wide, i == 4 ? 0.4 : 0.3});
    comb.push_back({x + 0.05 + wide, uniform(rng, 0.6, 1.2)});
    comb.push_back({x + 0.05, comb.back().second});
    comb.push_back({x + 0.05, i == 0 ? 0.35 : 0.3});
  }
  all.push_back({"comb", comb});
  all.push_back({"star", star_outline(uniform_int(rng, 3, 7), uniform(rng, 0.15, 0.7))});
  all.push_back({"gear", teeth_around(uniform_int(rng, 4, 9), uniform(rng, 0.5, 0.9),
                                      uniform(rng, 0.4, 0.9))});
  all.push_back({"wedge", {{0, 0}, {2, -0.3 * w}, {2.5, 0.1}, {2, 0.3 * w}}});
  all.push_back({"chevron", {{0, 0}, {1, 1}, {0, 2}, {w, 1}}});
  return all;
}

// The planes between the cells of a grid, along each axis.
using Grid = std::array<std::vector<double>, 3>;

// Some of the cells of a grid: is_full(x, y, z), of the cell's place. Faces of one plane are not joined: the kernel
// joins them.
template <class IsFull>
TriangleSoup solid_of_cells(std::string name, const Grid& at, const IsFull& is_full) {
  TriangleSoup mesh{std::move(name), {}, {}};
  std::map<std::array<int, 3>, std::uint32_t> vertices;
  const auto vertex = [&](std::array<int, 3> p) {
    const auto [found, is_new] = vertices.emplace(p, std::uint32_t(mesh.positions.size()));
    if (is_new)
      mesh.positions.push_back({float(at[0][std::size_t(p[0])]), float(at[1][std::size_t(p[1])]),
                                float(at[2][std::size_t(p[2])])});
    return found->second;
  };
  const auto count = [&](std::size_t axis) { return int(at[axis].size()) - 1; };
  const auto is_within = [&](std::array<int, 3> c) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (c[axis] < 0 || c[axis] >= count(axis)) return false;
    }
    return true;
  };
  for (int z = 0; z < count(2); ++z)
    for (int y = 0; y < count(1); ++y)
      for (int x = 0; x < count(0); ++x) {
        if (!is_full(x, y, z)) continue;
        for (std::size_t axis = 0; axis < 3; ++axis)
          for (int up : {0, 1}) {
            std::array<int, 3> next{x, y, z};
            next[axis] += up == 1 ? 1 : -1;
            if (is_within(next) && is_full(next[0], next[1], next[2])) continue;
            std::array<int, 3> p{x, y, z};
            p[axis] += up;
            const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
            std::array<std::array<int, 3>, 4> loop{p, p, p, p};
            ++loop[1][u];
            ++loop[2][u], ++loop[2][v];
            ++loop[3][v];
            if (up == 0) std::swap(loop[1], loop[3]);
            const std::uint32_t a = vertex(loop[0]), b = vertex(loop[1]), c = vertex(loop[2]),
                                d = vertex(loop[3]);
            mesh.triangles.push_back({a, b, c});
            mesh.triangles.push_back({a, c, d});
          }
      }
  return mesh;
}

// A grid of uneven spacing.
inline TriangleSoup random_cells(Random& rng, int side, double share) {
  Grid at;
  for (auto& line : at) {
    line.push_back(0);
    for (int i = 0; i < side; ++i)
      line.push_back(line.back() + std::pow(10, uniform(rng, -1.2, 0)));
  }
  std::vector<bool> full(std::size_t(side * side * side), false);
  for (std::size_t i = 0; i < full.size(); ++i) full[i] = uniform(rng, 0, 1) < share;
  full[0] = true;
  return solid_of_cells("cells", at, [&](int x, int y, int z) {
    return bool(full[std::size_t((z * side + y) * side + x)]);
  });
}

// A sphere's grid of points, every other one drawn out: thin blades that meet at the poles.
inline TriangleSoup spiky_ball(Random& rng) {
  TriangleSoup mesh{"spiky ball", {}, {}};
  const auto around = std::uint32_t(2 * uniform_int(rng, 2, 5));
  const auto rings = std::uint32_t(uniform_int(rng, 1, 4));
  const double low = uniform(rng, 0.2, 0.8);
  for (std::uint32_t j = 1; j <= rings; ++j)
    for (std::uint32_t i = 0; i < around; ++i) {
      const double polar = kPi * j / (rings + 1), a = 2 * kPi * i / around;
      const double radius = i % 2 == 0 ? 1 : low;
      mesh.positions.push_back({float(radius * std::sin(polar) * std::cos(a)),
                                float(radius * std::sin(polar) * std::sin(a)),
                                float(radius * std::cos(polar))});
    }
  const auto top = std::uint32_t(mesh.positions.size());
  mesh.positions.push_back({0, 0, 1});
  mesh.positions.push_back({0, 0, -1});
  const auto at = [&](std::uint32_t j, std::uint32_t i) { return j * around + i % around; };
  for (std::uint32_t i = 0; i < around; ++i) {
    mesh.triangles.push_back({top, at(0, i), at(0, i + 1)});
    mesh.triangles.push_back({top + 1, at(rings - 1, i + 1), at(rings - 1, i)});
    for (std::uint32_t j = 0; j + 1 < rings; ++j) {
      mesh.triangles.push_back({at(j, i), at(j + 1, i), at(j + 1, i + 1)});
      mesh.triangles.push_back({at(j, i), at(j + 1, i + 1), at(j, i + 1)});
    }
  }
  return mesh;
}

// Stretched by up to three and sheared, then turned.
inline void skew(TriangleSoup& mesh, Random& rng) {
  const Mat3d turn = random_rotation(rng);
  const Vec3d scale{uniform(rng, 0.5, 1.5), uniform(rng, 0.5, 1.5), uniform(rng, 0.5, 1.5)};
  const double shear = uniform(rng, -0.6, 0.6), lean = uniform(rng, -0.6, 0.6);
  for (Vec3f& p : mesh.positions) {
    const Vec3d q{p.x * scale.x + shear * p.z, p.y * scale.y + lean * p.z, p.z * scale.z};
    p = Vec3f(turn * q);
  }
}

inline std::vector<TriangleSoup> make_nonconvex_solids(std::uint64_t seed) {
  Random rng(seed);
  std::vector<TriangleSoup> all;
  const double w = std::pow(10, uniform(rng, -1.5, -0.2));
  for (auto& [name, outline] : make_outlines(rng, w)) {
    PrismShape shape{std::pow(10, uniform(rng, -1, 0.3)), 1, 0};
    if (uniform_int(rng, 0, 2) == 0) shape.taper = uniform(rng, 0.6, 1.3);
    if (uniform_int(rng, 0, 3) == 0) shape.twist = uniform(rng, -0.4, 0.4) * w;
    all.push_back(prism_over(name, outline, shape));
  }
  for (int i = 0; i < 3; ++i)
    all.push_back(random_cells(rng, uniform_int(rng, 2, 4), uniform(rng, 0.3, 0.95)));
  all.push_back(spiky_ball(rng));
  if (seed % 2 == 0)
    for (TriangleSoup& mesh : all) skew(mesh, rng);
  return all;
}

}  // namespace arris::oracle
