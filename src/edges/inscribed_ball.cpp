#include "edges/inscribed_ball.h"

#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace arris {
namespace {

using Vec4 = std::array<double, 4>;
using Mat4 = std::array<Vec4, 4>;

// Gaussian elimination with row pivoting; false if singular.
bool solve(Mat4 a, Vec4 b, Vec4& x) {
  for (std::size_t c = 0; c < 4; ++c) {
    std::size_t pivot = c;
    for (std::size_t r = c + 1; r < 4; ++r) {
      if (std::abs(a[r][c]) > std::abs(a[pivot][c])) pivot = r;
    }
    if (std::abs(a[pivot][c]) < 1e-14) return false;
    std::swap(a[c], a[pivot]);
    std::swap(b[c], b[pivot]);
    for (std::size_t r = c + 1; r < 4; ++r) {
      const double f = a[r][c] / a[c][c];
      for (std::size_t k = c; k < 4; ++k) a[r][k] -= f * a[c][k];
      b[r] -= f * b[c];
    }
  }
  for (std::size_t c = 4; c-- > 0;) {
    for (std::size_t k = c + 1; k < 4; ++k) b[c] -= a[c][k] * x[k];
    x[c] = b[c] / a[c][c];
  }
  return true;
}

Mat4 transposed(const Mat4& m) {
  Mat4 t{};
  for (std::size_t r = 0; r < 4; ++r) {
    for (std::size_t c = 0; c < 4; ++c) t[c][r] = m[r][c];
  }
  return t;
}

Vec4 row_of(const Plane& plane) {
  return {plane.normal.x, plane.normal.y, plane.normal.z, 1};
}

}  // namespace

InscribedBall largest_inscribed_ball(std::span<const Plane> planes, double size) {
  // A large tetrahedron around everything is the first basis: its multipliers are positive.
  const double s = 1 / std::sqrt(3.0);
  std::array<Plane, 4> basis = {Plane{{s, s, s}, 4 * size}, Plane{{s, -s, -s}, 4 * size},
                                Plane{{-s, s, -s}, 4 * size}, Plane{{-s, -s, s}, 4 * size}};
  InscribedBall ball;
  for (std::size_t step = 0; step < 64 + 4 * planes.size(); ++step) {
    Mat4 rows{};
    Vec4 d{};
    for (std::size_t i = 0; i < 4; ++i) {
      rows[i] = row_of(basis[i]);
      d[i] = basis[i].d;
    }
    Vec4 z{};
    Vec4 lambda{};
    if (!solve(rows, d, z) || !solve(transposed(rows), {0, 0, 0, 1}, lambda)) break;
    ball = {{z[0], z[1], z[2]}, z[3]};
    const Plane* worst = nullptr;
    double violation = 1e-13 * size;
    for (const Plane& plane : planes) {
      const double v = dot(plane.normal, ball.center) + ball.radius - plane.d;
      if (v > violation) {
        violation = v;
        worst = &plane;
      }
    }
    if (worst == nullptr) break;
    Vec4 mu{};
    if (!solve(transposed(rows), row_of(*worst), mu)) break;
    std::size_t leaving = 4;
    double smallest = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 4; ++i) {
      if (mu[i] > 1e-12 && lambda[i] / mu[i] < smallest) {
        smallest = lambda[i] / mu[i];
        leaving = i;
      }
    }
    if (leaving == 4) break;
    basis[leaving] = *worst;
  }
  return ball;
}

}  // namespace arris
