// crease_outline_test.cpp — outlines of creased solids against rays and the balls that fit
#include "rounding/crease_outline.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "arris/rounding.h"
#include "rounding/rounding_data.h"
#include "support/ball_oracle.h"
#include "support/creased_solids.h"
#include "support/rounded_ray.h"

namespace arris::oracle {
namespace {

class Viewed {
 public:
  Viewed(const CreasedCase& c, std::uint64_t seed)
      : mesh_(c.mesh.view()), name_(c.mesh.name), r_(c.radius), size_(c.mesh.size()), rng_(seed) {
    RoundingOptions options;
    options.radius = r_;
    options.min_angle = radians(5);
    rounding_ = std::make_unique<const Rounding>(make_rounding(mesh_, options, name_));
  }

  [[nodiscard]] bool is_creased() const { return !rounding_->data().creased.empty(); }
  [[nodiscard]] const CreasedSolid& solid() const { return *rounding_->data().creased.front(); }
  [[nodiscard]] Vec3d center() const { return rounding_->data().solids.front().center; }
  [[nodiscard]] double radius() const { return r_; }
  Random& random() { return rng_; }

  Vec3d eye() {
    for (;;) {
      const Vec3d v{uniform(rng_, -1, 1), uniform(rng_, -1, 1), uniform(rng_, -1, 1)};
      const double l = length(v);
      if (l > 0.1 && l <= 1) return center() + v * (uniform(rng_, 0.7, 3) * size_ / l);
    }
  }

  // Of a place on the outline: what rays to either side of it meet, as far as they come that near.
  struct Sides {
    bool hidden = false;
    std::string problem;
  };
  [[nodiscard]] Sides look(Vec3d eye, const CreaseLine& line) const {
    const Vec3d x = center() + (line.a + line.b) * 0.5;
    const double away = length(x - eye);
    const Vec3d across = normalize(cross(line.b - line.a, x - eye)) * (0.01 * r_);
    double t[2];
    for (const int i : {0, 1}) {
      const Vec3d d = normalize(x + (i == 0 ? across : -across) - eye);
      const auto hit = trace({eye, d}, {mesh_, rounding_.get()});
      t[i] = hit ? hit->t - away : INFINITY;
    }
    const double near = std::min(t[0], t[1]), far = std::max(t[0], t[1]);
    Sides out;
    out.hidden = far < -0.1 * r_;
    if (out.hidden) return out;
    if (near > 0.1 * r_ || far - near < 0.1 * r_) {
      const Vec3d d = line.b - line.a;
      out.problem = fmt::format(
          "{}: at ({:.6g}, {:.6g}, {:.6g}) along ({:.3g}, {:.3g}, {:.3g}) from ({:.6g}, {:.6g}, "
          "{:.6g}): {:.3g} r and {:.3g} r",
          name_, x.x, x.y, x.z, d.x, d.y, d.z, eye.x, eye.y, eye.z, near / r_, far / r_);
    }
    return out;
  }

 private:
  MeshView mesh_;
  std::string name_;
  double r_, size_;
  Random rng_;
  std::unique_ptr<const Rounding> rounding_;
};

TEST(CreaseOutline, parts_what_is_seen_from_what_passes) {
  int looked = 0, hidden = 0;
  std::vector<std::string> problems;
  for (const CreasedCase& c : make_creased_cases()) {
    SCOPED_TRACE(c.mesh.name);
    Viewed viewed(c, 11);
    ASSERT_TRUE(viewed.is_creased());
    for (int i = 0; i < 12; ++i) {
      const Vec3d eye = viewed.eye();
      for (const CreaseLine& line :
           find_crease_outline(viewed.solid(), eye - viewed.center(), VoidDepths::none)) {
        if (length(line.b - line.a) < 1e-3 * c.radius) continue;
        const Viewed::Sides sides = viewed.look(eye, line);
        (sides.hidden ? hidden : looked) += 1;
        if (!sides.problem.empty()) problems.push_back(sides.problem);
      }
    }
  }
  EXPECT_GT(looked, 2000);
  EXPECT_EQ(problems.size(), 0U) << looked << " " << hidden << "\n"
                                 << fmt::format("{}", fmt::join(problems, "\n"));
}

TEST(CreaseOutline, lies_on_the_balls_that_fit) {
  std::vector<std::string> problems;
  int looked = 0;
  for (const CreasedCase& c : make_creased_cases()) {
    Viewed viewed(c, 12);
    const BallOracle oracle(c.mesh.view(), c.radius);
    const Vec3d eye = viewed.eye();
    std::vector<CreaseLine> lines =
        find_crease_outline(viewed.solid(), eye - viewed.center(), VoidDepths::none);
    std::ranges::shuffle(lines, viewed.random());
    lines.resize(std::min<std::size_t>(lines.size(), 12));
    for (const CreaseLine& line : lines) {
      if (length(line.b - line.a) < 1e-3 * c.radius) continue;
      const Vec3d x = viewed.center() + (line.a + line.b) * 0.5;
      const Vec3d across = normalize(cross(line.b - line.a, x - eye)) * (0.01 * c.radius);
      const double m0 = oracle.margin(x + across, viewed.random());
      const double m1 = oracle.margin(x - across, viewed.random());
      ++looked;
      if (std::min(m0, m1) < 0 && std::max(m0, m1) > -0.001 * c.radius) continue;
      problems.push_back(fmt::format("{}: at ({:.6g}, {:.6g}, {:.6g}): {:.3g} r, {:.3g} r",
                                     c.mesh.name, x.x, x.y, x.z, m0 / c.radius, m1 / c.radius));
    }
  }
  EXPECT_GT(looked, 100);
  EXPECT_EQ(problems.size(), 0U) << fmt::format("{}", fmt::join(problems, "\n"));
}

}  // namespace
}  // namespace arris::oracle
