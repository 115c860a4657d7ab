// rounded_box — rounds a unit cube and shoots one ray at its edge
#include <arris/rounding.h>
#include <arris/version.h>

#include <cmath>
#include <cstdio>
#include <vector>

int main() {
  std::vector<arris::Vec3f> positions;
  for (int corner = 0; corner < 8; ++corner) {
    positions.emplace_back(corner & 1 ? 1.F : 0.F, corner & 2 ? 1.F : 0.F, corner & 4 ? 1.F : 0.F);
  }
  const std::vector<arris::Triangle> triangles = {
      {0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
      {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5},
  };
  const arris::Rounding rounding = arris::make_rounding({positions, triangles}, {.radius = 0.1});

  // Straight down at (0.98, 0.5): a ray tracer would report triangle 2 at u = 0.48, v = 0.5, t = 1.
  const arris::Ray ray{{0.98, 0.5, 2}, {0, 0, -1}};
  const arris::MeshHit hit{2, 0.48, 0.5, 1};
  if (rounding.is_kept(hit.triangle, hit.u, hit.v)) {
    std::puts("the hit stands");
    return 1;
  }
  const arris::Resolution resolution = rounding.resolve(ray, hit);
  const arris::Vec3d normal = resolution.hit.normal;
  std::printf("arris %s: t = %.6f instead of 1, normal %.4f %.4f %.4f\n", arris::version(),
              resolution.hit.t, normal.x, normal.y, normal.z);

  // The edge became a cylinder of radius 0.1 around the line x = z = 0.9.
  const double expected = 2 - (0.9 + std::sqrt(0.1 * 0.1 - 0.08 * 0.08));
  return std::abs(resolution.hit.t - expected) < 1e-6 ? 0 : 1;
}
