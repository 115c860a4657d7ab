// creased_solids.h — solids with concave edges, each with a radius that fits: brackets, bosses, pockets, stars, saddles
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "support/nonconvex_solids.h"

namespace arris::oracle {

// A block with another one on it, or let into it if `height` < 0.
inline TriangleSoup block_with_boss(std::string name, double base, double top, double height,
                                    double lean = 0) {
  TriangleSoup mesh{std::move(name), {}, {}};
  const auto ring = [&](double half, double z, double shift) {
    for (const auto& [x, y] :
         {std::pair(-1, -1), std::pair(1, -1), std::pair(1, 1), std::pair(-1, 1)})
      mesh.positions.push_back({float(x * half + shift), float(y * half), float(z)});
  };
  ring(2, -1.5, 0);
  ring(2, 0, 0);
  ring(base, 0, 0);
  ring(top, height, lean);
  const auto quad = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  quad(3, 2, 1, 0);
  for (std::uint32_t i = 0; i < 4; ++i) {
    const std::uint32_t j = (i + 1) % 4;
    quad(i, j, j + 4, i + 4);
    quad(i + 4, j + 4, j + 8, i + 8);
    quad(i + 8, j + 8, j + 12, i + 12);
  }
  quad(12, 13, 14, 15);
  return mesh;
}

// A plate with a pocket, 2 by 2 and 0.6 deep, from which a slot of the same floor leads out along x.
inline TriangleSoup plate_with_slot(double width) {
  const Grid at{{{-2, -1, 1, 2}, {-2, -1, -0.5 * width, 0.5 * width, 1, 2}, {-1, -0.6, 0}}};
  return solid_of_cells("slot", at, [](int x, int y, int z) {
    const bool in_pocket = x == 1 && y >= 1 && y <= 3, in_slot = x == 2 && y == 2;
    return z == 0 || !(in_pocket || in_slot);
  });
}

inline TriangleSoup plain_l() {
  return prism_over("L", {{0, 0}, {2, 0}, {2, 0.8}, {0.8, 0.8}, {0.8, 2}, {0, 2}}, {});
}

struct CreasedCase {
  TriangleSoup mesh;
  double radius;
};

inline std::vector<CreasedCase> make_creased_cases() {
  std::vector<CreasedCase> cases;
  const double w = 0.8;
  const Outline l{{0, 0}, {2, 0}, {2, w}, {w, w}, {w, 2}, {0, 2}};
  cases.push_back({prism_over("L", l, {1, 1, 0}), 0.15});
  TriangleSoup sheared = prism_over("sheared L", l, {1, 1, 0});
  for (Vec3f& p : sheared.positions) p = {p.x + 0.4F * p.z, p.y - 0.3F * p.z, p.z};
  cases.push_back({sheared, 0.12});
  cases.push_back({prism_over("tapered L", l, {1, 0.8, 0}), 0.12});
  cases.push_back({block_with_boss("boss", 0.8, 0.8, 0.9), 0.15});
  cases.push_back({block_with_boss("tapered boss", 0.9, 0.6, 0.8), 0.14});
  cases.push_back({block_with_boss("undercut boss", 0.6, 0.9, 0.8), 0.12});
  cases.push_back({block_with_boss("leaning boss", 0.7, 0.7, 0.9, 0.4), 0.12});
  cases.push_back({block_with_boss("pocket", 0.8, 0.8, -0.7), 0.15});
  cases.push_back({block_with_boss("slanted pocket", 0.9, 0.6, -0.7), 0.15});
  cases.push_back({block_with_boss("leaning pocket", 0.8, 0.7, -0.7, 0.25), 0.13});
  cases.push_back({prism_over("star", star_outline(5, 0.45), {0.8, 1, 0}), 0.06});
  cases.push_back({prism_over("cross",
                              {{-w, -2},
                               {w, -2},
                               {w, -w},
                               {2, -w},
                               {2, w},
                               {w, w},
                               {w, 2},
                               {-w, 2},
                               {-w, w},
                               {-2, w},
                               {-2, -w},
                               {-w, -w}},
                              {1, 1, 0}),
                   0.14});
  // Saddles: two convex and two concave edges at a corner.
  TriangleSoup saddle{"saddle", {}, {}};
  saddle.positions = {{-1, -1, -1},   {1, -1, -1},  {1, 1, -1},     {-1, 1, -1}, {-1, -1, 0.6F},
                      {1, -1, -0.4F}, {1, 1, 0.6F}, {-1, 1, -0.4F}, {0, 0, 0.1F}};
  saddle.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 5}, {0, 5, 4}, {1, 2, 6}, {1, 6, 5}, {2, 3, 7},
                      {2, 7, 6}, {3, 0, 4}, {3, 4, 7}, {4, 5, 8}, {5, 6, 8}, {6, 7, 8}, {7, 4, 8}};
  cases.push_back({saddle, 0.08});
  return cases;
}

}  // namespace arris::oracle
