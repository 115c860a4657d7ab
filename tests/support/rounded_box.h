// rounded_box.h — boxes whose edges have radii of their own
#pragma once

#include <cstddef>
#include <vector>

#include "arris/rounding.h"
#include "support/convex_solids.h"
#include "support/creased_solids.h"

namespace arris::oracle {

// An edge of a box: its ends and the normals of its faces.
struct BoxEdge {
  Vec3d p0, p1, normal_a, normal_b;
  double radius;
};

// A box of the given half size, all of whose edges have radii of their own.
struct RoundedBox {
  TriangleSoup mesh{"box", {}, {}};
  std::vector<BoxEdge> edges;
  RoundingOptions options;
};

inline RoundedBox make_box(Vec3d half, Random& rng, const std::vector<double>& radii) {
  RoundedBox box;
  for (int i = 0; i < 8; ++i) {
    box.mesh.positions.push_back({float((i & 1) != 0 ? half.x : -half.x),
                                  float((i & 2) != 0 ? half.y : -half.y),
                                  float((i & 4) != 0 ? half.z : -half.z)});
  }
  box.mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                        {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  box.options.radius = radii.front();
  for (int axis = 0; axis < 3; ++axis) {
    for (int side = 0; side < 4; ++side) {
      Vec3d corner = half, a, b;
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      corner[axis] = 0;
      a[u] = (side & 1) != 0 ? 1 : -1;
      b[v] = (side & 2) != 0 ? 1 : -1;
      corner[u] *= a[u];
      corner[v] *= b[v];
      Vec3d along;
      along[axis] = half[axis];
      const double radius = radii[std::size_t(uniform_int(rng, 0, int(radii.size()) - 1))];
      box.edges.push_back({corner - along, corner + along, a, b, radius});
      EdgeRule rule;
      rule.radius = radius;
      rule.segments = {{corner - along, corner + along}};
      box.options.rules.push_back(rule);
    }
  }
  return box;
}

}  // namespace arris::oracle
