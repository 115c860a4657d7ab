// bands_test.cpp — bands stay few and their making quick, however many edges a face has
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "arris/rounding.h"

namespace arris {
namespace {

// A plate of n × n cells, n odd: every second cell of every second row is a square hole.
class PerforatedPlate {
 public:
  explicit PerforatedPlate(int n) : n_(n) {
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) {
        if (is_solid(i, j)) add_cell(i, j);
      }
    }
  }

  [[nodiscard]] MeshView view() const { return {positions_, triangles_}; }

 private:
  using Corner = std::array<int, 3>;

  [[nodiscard]] bool is_solid(int i, int j) const {
    return i >= 0 && j >= 0 && i < n_ && j < n_ && (i % 2 == 0 || j % 2 == 0);
  }

  std::uint32_t vertex(const Corner& c) {
    const auto [at, is_new] = vertices_.try_emplace(c, std::uint32_t(positions_.size()));
    if (is_new) positions_.push_back(Vec3f(float(c[0]), float(c[1]), float(c[2])));
    return at->second;
  }

  void add_quad(const std::array<Corner, 4>& q) {
    const std::uint32_t a = vertex(q[0]), b = vertex(q[1]), c = vertex(q[2]), d = vertex(q[3]);
    triangles_.push_back({a, b, c});
    triangles_.push_back({a, c, d});
  }

  void add_cell(int i, int j) {
    const int k = i + 1, l = j + 1;
    add_quad({{{i, j, 1}, {k, j, 1}, {k, l, 1}, {i, l, 1}}});
    add_quad({{{i, j, 0}, {i, l, 0}, {k, l, 0}, {k, j, 0}}});
    if (!is_solid(i - 1, j)) add_quad({{{i, j, 0}, {i, j, 1}, {i, l, 1}, {i, l, 0}}});
    if (!is_solid(i + 1, j)) add_quad({{{k, l, 0}, {k, l, 1}, {k, j, 1}, {k, j, 0}}});
    if (!is_solid(i, j - 1)) add_quad({{{k, j, 0}, {k, j, 1}, {i, j, 1}, {i, j, 0}}});
    if (!is_solid(i, j + 1)) add_quad({{{i, l, 0}, {i, l, 1}, {k, l, 1}, {k, l, 0}}});
  }

  int n_;
  std::map<Corner, std::uint32_t> vertices_;
  std::vector<Vec3f> positions_;
  std::vector<Triangle> triangles_;
};

double bytes_per_triangle(int cells) {
  const PerforatedPlate plate(cells);
  const Rounding rounding = make_rounding(plate.view(), {.radius = 0.1});
  return double(rounding.report().bytes) / double(plate.view().triangles.size());
}

TEST(Bands, memory_of_a_perforated_plate_grows_with_its_holes_alone) {
  EXPECT_LT(bytes_per_triangle(61), 1.1 * bytes_per_triangle(21));
}

}  // namespace
}  // namespace arris
