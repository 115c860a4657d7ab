// Areas of a tree's ends against closed forms, and against lines of which the lengths in each end are solved for.
#include "beam/tree_area.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "arris/math.h"

namespace arris::test {
namespace {

using Random = std::mt19937_64;
double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

// Ends: nodes of any kind but sign.
LookNode sign_node(const Quadratic& p, std::uint32_t negative, std::uint32_t positive) {
  LookNode node;
  node.kind = LookNode::Kind::sign;
  node.polynomial = p;
  node.negative = negative;
  node.positive = positive;
  return node;
}
LookNode end_node(LookNode::Kind kind, std::uint32_t number) {
  LookNode node;
  node.kind = kind;
  node.seen.face = number;
  return node;
}
constexpr auto kSurface = LookNode::Kind::surface;
constexpr auto kNothing = LookNode::Kind::nothing;

// Positive: node 2.
LookTree one_sign(const Quadratic& p) {
  return {{sign_node(p, 1, 2), end_node(kNothing, 0), end_node(kSurface, 1)}, {}};
}
Quadratic line(double c, double x, double y) {
  return Quadratic(Linear{c, x, y});
}
// radius² - |p - middle|²
Quadratic disc(double x, double y, double radius) {
  return {radius * radius - x * x - y * y, 2 * x, 2 * y, -1, 0, -1};
}

EndArea area_of(const std::vector<EndArea>& areas, std::uint32_t node) {
  const auto at = std::ranges::find(areas, node, &EndArea::node);
  return at == areas.end() ? EndArea{} : *at;
}

void expect_area(const LookTree& tree, const Rect& rect, std::uint32_t node, double truth,
                 double tightness, const AreaOptions& options = {}) {
  const EndArea area = area_of(areas_of(tree, rect, options), node);
  EXPECT_LE(area.lo, truth + 1e-12);
  EXPECT_GE(area.hi, truth - 1e-12);
  EXPECT_LE(area.hi - area.lo, tightness);
}

TEST(tree_area, half_planes_and_strips_are_exact) {
  const Rect rect{1, 2, 3, 3};
  expect_area(one_sign(line(-1.5, 1, 0)), rect, 2, 1.5, 1e-12);
  expect_area(one_sign(line(-1.5, 1, 0)), rect, 1, 0.5, 1e-12);
  expect_area(one_sign(line(-3.5, 1, 1)), rect, 2, 2 - 0.125, 1e-12);  // a corner
  expect_area(one_sign(line(-4, 1, 1)), rect, 2, 1.5, 1e-12);
  expect_area(one_sign(line(-9, 1, 1)), rect, 1, 2, 0);
  // 2 < x + y / 2 < 2.001: thinner than any piece, 0.001 wide along x, and all of it within.
  const LookTree strip{{sign_node(line(-3, 1, 0.5), 1, 2), end_node(kNothing, 0),
                        sign_node(line(-3.001, 1, 0.5), 3, 1), end_node(kSurface, 1)},
                       {}};
  expect_area(strip, rect, 3, 0.001, 1e-12);
}

TEST(tree_area, circles_close_with_the_square_of_a_pieces_side) {
  const Rect rect{0, 0, 1, 1};
  const LookTree whole = one_sign(disc(0.5, 0.4, 0.3));
  expect_area(whole, rect, 2, kPi * 0.09, 0.01);
  double widths[3];
  for (int i = 0; i < 3; ++i) {
    const AreaOptions options{std::ldexp(1.0, -12 - 4 * i), std::ldexp(1.0, -8 - 4 * i)};
    const EndArea area = area_of(areas_of(whole, rect, options), 2);
    widths[i] = area.hi - area.lo;
    EXPECT_NEAR(area.estimate, kPi * 0.09, widths[i]);
  }
  EXPECT_LT(widths[1], widths[0] / 6);
  EXPECT_LT(widths[2], widths[1] / 6);
  expect_area(one_sign(disc(0, 0, 0.5)), rect, 2, kPi / 16, 0.005);  // a quarter
  expect_area(one_sign(disc(0.5, 0.5, 1)), rect, 2, 1, 0);
  const double speck = 1e-3;
  expect_area(one_sign(disc(0.3, 0.3, speck)), rect, 2, kPi * speck * speck, 1e-3);
  expect_area(one_sign(disc(0.3, 0.3, speck)), rect, 2, kPi * speck * speck, 0.2 * speck * speck,
              {1e-5, 1e-5});
  // An ellipse (2 (x - 0.5))² + (4 (y - 0.5))² < 1, and a hyperbola xy > 1/4.
  expect_area(one_sign({-4, 4, 16, -4, 0, -16}), rect, 2, kPi / 8, 0.01);
  expect_area(one_sign({-0.25, 0, 0, 0, 1, 0}), rect, 2, 0.75 - std::log(4) / 4, 0.01);
}

TEST(tree_area, pairs_of_lines_in_one_polynomial_are_nearly_as_exact_as_lines) {
  // (x + y - 0.9) (x - y + 0.2) > 0
  const Quadratic both(-0.18, 0.2 - 0.9, 0.2 + 0.9, 1, 0, -1);
  LookTree product = one_sign(both);
  LookTree apart{{sign_node(line(-0.9, 1, 1), 1, 2), sign_node(line(0.2, 1, -1), 3, 4),
                  sign_node(line(0.2, 1, -1), 4, 3), end_node(kSurface, 0), end_node(kNothing, 1)},
                 {}};
  const Rect rect{0, 0, 1, 1};
  const EndArea truth = area_of(areas_of(apart, rect), 3);
  EXPECT_LT(truth.hi - truth.lo, 1e-12);
  expect_area(product, rect, 2, truth.estimate, 0.004);
}

// ------------------------------------------------------------------------------------- random trees of signs

struct Sample {
  double c, x, y, xx, xy, yy;
  [[nodiscard]] double operator()(double px, double py) const {
    return c + px * (x + px * xx + py * xy) + py * (y + py * yy);
  }
};

Sample random_polynomial(Random& random, const Rect& rect) {
  const bool is_linear = random() % 3 == 0;
  const double bend = is_linear ? 0 : std::pow(10, uniform(random, -1, 1)) / rect.width();
  Sample p{0,
           uniform(random, -1, 1),
           uniform(random, -1, 1),
           bend * uniform(random, -1, 1),
           bend * uniform(random, -1, 1),
           bend * uniform(random, -1, 1)};
  // As seen from the middle, and zero somewhere in the rectangle.
  const double mx = rect.middle_x(), my = rect.middle_y();
  const Sample own = p;
  p.x = own.x - 2 * own.xx * mx - own.xy * my;
  p.y = own.y - 2 * own.yy * my - own.xy * mx;
  p.c = -p(uniform(random, rect.x0, rect.x1), uniform(random, rect.y0, rect.y1));
  return p;
}

struct RandomTree {
  LookTree look;
  std::vector<Sample> polynomials;  // by node; one of those between the coefficients' ends
};

// `spread`: how far apart the ends of coefficients are.
RandomTree random_tree(Random& random, const Rect& rect, double spread) {
  RandomTree tree;
  const auto add = [&](const auto& self, int depth) -> std::uint32_t {
    const auto index = std::uint32_t(tree.look.nodes.size());
    tree.look.nodes.emplace_back();
    tree.polynomials.emplace_back();
    if (depth == 0 || (index > 0 && random() % 4 == 0)) {
      tree.look.nodes[index] = end_node(LookNode::Kind(random() % 3), index);
      return index;
    }
    const Sample p = random_polynomial(random, rect);
    const auto around = [&](double value) {
      const double u = uniform(random, 0, 1) * spread;
      return spread > 0 ? Interval(value - u, value + (spread - u)) : Interval(value);
    };
    const Quadratic q(around(p.c), around(p.x), around(p.y), around(p.xx), around(p.xy),
                      around(p.yy));
    const std::uint32_t negative = self(self, depth - 1), positive = self(self, depth - 1);
    tree.look.nodes[index] = sign_node(q, negative, positive);
    tree.polynomials[index] = p;
    return index;
  };
  add(add, 3);
  return tree;
}

std::uint32_t end_at(const RandomTree& tree, double x, double y) {
  std::uint32_t node = 0;
  while (tree.look.nodes[node].kind == LookNode::Kind::sign) {
    const LookNode& n = tree.look.nodes[node];
    node = tree.polynomials[node](x, y) < 0 ? n.negative : n.positive;
  }
  return node;
}

// Lengths along lines of x, of which the ends are roots; lines are many, for nothing is smooth in x where roots meet.
std::vector<double> true_areas(const RandomTree& tree, const Rect& rect) {
  constexpr int kLines = 400;
  std::vector<double> areas(tree.look.nodes.size());
  std::vector<double> cuts;
  for (int i = 0; i < kLines; ++i) {
    const double x = rect.x0 + rect.width() * (i + 0.5) / kLines;
    cuts.assign({rect.y0, rect.y1});
    for (std::size_t n = 0; n < tree.polynomials.size(); ++n) {
      if (tree.look.nodes[n].kind != LookNode::Kind::sign) continue;
      const Sample& p = tree.polynomials[n];
      const double c = p.c + x * (p.x + x * p.xx), b = p.y + x * p.xy;
      const double root = std::sqrt(std::max(0.0, b * b - 4 * p.yy * c));
      const double q = b < 0 ? -b + root : -b - root;
      for (const double y : {q / (2 * p.yy), 2 * c / q}) {
        if (y > rect.y0 && y < rect.y1) cuts.push_back(y);
      }
    }
    std::ranges::sort(cuts);
    for (std::size_t k = 1; k < cuts.size(); ++k) {
      const double length = cuts[k] - cuts[k - 1];
      areas[end_at(tree, x, cuts[k - 1] + length / 2)] += length * rect.width() / kLines;
    }
  }
  return areas;
}

Rect random_square(Random& random) {
  const double side = std::pow(2, -double(random() % 5)) * 2;
  const double x = uniform(random, 0, 100), y = uniform(random, 0, 100);
  return {x, y, x + side, y + side};
}

TEST(tree_area, areas_of_random_trees_lie_in_their_bounds) {
  Random random(1);
  double open = 0, worst = 0;
  int trees = 0, ends = 0;
  for (int i = 0; i < 150; ++i) {
    const Rect rect = random_square(random);
    const bool is_spread = i % 3 == 0;
    const RandomTree tree = random_tree(random, rect, is_spread ? 1e-6 : 0);
    const std::vector<double> truth = true_areas(tree, rect);
    const std::vector<EndArea> areas = areas_of(tree.look, rect);
    double estimates = 0, widths = 0;
    for (std::uint32_t node = 0; node < truth.size(); ++node) {
      const EndArea area = area_of(areas, node);
      const double slack = 4e-4 * rect.area();  // of the lines
      ASSERT_LE(area.lo, truth[node] + slack) << i << ", node " << node;
      ASSERT_GE(area.hi, truth[node] - slack) << i << ", node " << node;
      ASSERT_GE(area.estimate, area.lo - 1e-12) << i;
      ASSERT_LE(area.estimate, area.hi + 1e-12) << i;
      estimates += area.estimate;
      widths += area.hi - area.lo;
      ends += area.lo > 0 ? 1 : 0;
    }
    ASSERT_NEAR(estimates, rect.area(), 1e-9) << i;
    if (is_spread) continue;
    open += widths / rect.area();
    worst = std::max(worst, widths / rect.area());
    ++trees;
  }
  EXPECT_GT(ends, 300);
  EXPECT_LT(open / trees, 0.02);
  EXPECT_LT(worst, 0.3);
}

TEST(tree_area, bounds_close_as_the_tolerance_does) {
  Random random(2);
  double wide = 0, narrow = 0;
  for (int i = 0; i < 30; ++i) {
    const Rect rect = random_square(random);
    const RandomTree tree = random_tree(random, rect, 0);
    for (const EndArea& a : areas_of(tree.look, rect)) wide += (a.hi - a.lo) / rect.area();
    const AreaOptions closer{AreaOptions{}.tolerance / 16, AreaOptions{}.least_side / 16};
    for (const EndArea& a : areas_of(tree.look, rect, closer)) {
      narrow += (a.hi - a.lo) / rect.area();
    }
  }
  EXPECT_LT(narrow, wide / 3);
}

TEST(tree_area, samples_are_on_their_ends_side_of_all_signs) {
  Random random(3);
  int sure = 0, gridded = 0;
  for (int i = 0; i < 200; ++i) {
    const Rect rect = random_square(random);
    const RandomTree tree = random_tree(random, rect, 0);
    std::vector<int> on_grid(tree.look.nodes.size());
    const int side = std::clamp(int(std::ceil(rect.width() * kSampleGrid)), 1, kSampleGrid);
    for (int k = 0; k < side * side; ++k) {
      const double x = rect.x0 + rect.width() * (k % side + 0.5) / side;
      const double y = rect.y0 + rect.height() * (k / side + 0.5) / side;
      ++on_grid[end_at(tree, x, y)];
    }
    // Coarse pieces, too: of some only a little is certain.
    const AreaOptions coarse{1.0 / 32, 1.0 / 4};
    const std::vector<EndArea> areas =
        areas_of(tree.look, rect, i % 2 == 0 ? coarse : AreaOptions{});
    double weights = 0;
    for (const EndArea& area : areas) {
      ASSERT_TRUE(area.sample.x >= rect.x0 && area.sample.x <= rect.x1 &&
                  area.sample.y >= rect.y0 && area.sample.y <= rect.y1);
      if (area.lo > 0) {
        ASSERT_EQ(end_at(tree, area.sample.x, area.sample.y), area.node) << i;
        ++sure;
      }
      for (const AreaSample& s : area.samples) {
        ASSERT_EQ(end_at(tree, s.at.x, s.at.y), area.node) << i;
        weights += s.weight;
        ++gridded;
      }
      // All of the grid, where it is not one end's.
      ASSERT_TRUE(areas.size() == 1 || int(area.samples.size()) == on_grid[area.node]) << i;
    }
    // They stand for all of it.
    ASSERT_NEAR(weights, rect.area(), 1e-9 * rect.area()) << i;
  }
  EXPECT_GT(sure, 400);
  EXPECT_GT(gridded, 2000);
}

}  // namespace
}  // namespace arris::test
