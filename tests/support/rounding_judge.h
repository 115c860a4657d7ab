// rounding_judge.h — sends rays at a rounded solid and compares the kernel with the oracle
// What       rays of every difficult kind; a tally of those that went wrong
// Guarantee  "wrong" is the promise of rounding.h: t off by more than 1e-5 of the size, the normal by more
//            than 0.2 degrees, or hit against miss. A wrong ray is "explained" if moving the surface by the
//            rounding error of the float mesh could have caused it (tangents); none may be unexplained.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "support/convex_oracle.h"
#include "support/convex_solids.h"
#include "support/rounded_ray.h"

namespace arris::oracle {

enum class RayKind {
  outside,
  at_edge,
  at_corner,
  along_edge,
  grazing,
  inside,
  inside_at_edge,
  from_void
};

inline const char* name_of(RayKind kind) {
  constexpr const char* kNames[] = {"outside", "at edge", "at corner",      "along edge",
                                    "grazing", "inside",  "inside at edge", "from the void"};
  return kNames[std::size_t(kind)];
}

// Rays of one kind at one solid.
class RaySource {
 public:
  RaySource(const SolidMesh& mesh, const Opening& opening, std::uint64_t seed)
      : mesh_(mesh), opening_(opening), rng_(seed), size_(mesh.solid.size) {}

  Ray make(RayKind kind) {
    Ray ray = make_unit(kind);
    ray.direction *= std::pow(10, uniform(rng_, -2, 2));  // t must follow the direction's length
    return ray;
  }

 private:
  Ray make_unit(RayKind kind) {
    switch (kind) {
      case RayKind::outside:
        return towards(outside_point(),
                       mesh_.solid.center + random_direction(rng_) * uniform(rng_, 0, 0.7) * size_);
      case RayKind::at_edge:
        return towards(outside_point(), edge_point() + jitter(2));
      case RayKind::at_corner:
        return towards(outside_point(), corner() + jitter(2));
      case RayKind::along_edge:
        return along(uniform(rng_, 0.02, 0.3));
      case RayKind::grazing:
        return along(std::pow(10, uniform(rng_, -4, -1.5)));
      case RayKind::inside:
        return {inside_point(), random_direction(rng_)};
      case RayKind::inside_at_edge:
        return towards(inside_point(),
                       (uniform_int(rng_, 0, 1) != 0 ? edge_point() : corner()) + jitter(1));
      case RayKind::from_void:
        return {void_point(), random_direction(rng_)};
    }
    return {};
  }

  static Ray towards(Vec3d origin, Vec3d target) { return {origin, normalize(target - origin)}; }

  Vec3d outside_point() {
    return mesh_.solid.center + random_direction(rng_) * uniform(rng_, 1.5, 4) * size_;
  }
  Vec3d corner() {
    return mesh_.corners[std::size_t(uniform_int(rng_, 0, int(mesh_.corners.size()) - 1))];
  }
  const std::pair<Vec3d, Vec3d>& edge() {
    return mesh_.edges[std::size_t(uniform_int(rng_, 0, int(mesh_.edges.size()) - 1))];
  }
  Vec3d edge_point() {
    const auto& [a, b] = edge();
    const double u = uniform(rng_, 0, 1);
    return a * (1 - u) + b * u;
  }
  // Up to `radii` rounding radii away.
  Vec3d jitter(double radii) {
    return random_direction(rng_) * uniform(rng_, 0, radii) * opening_.radius();
  }
  Ray along(double angle) {
    const auto& [a, b] = edge();
    const Vec3d direction = normalize(normalize(b - a) + random_direction(rng_) * angle);
    const double u = uniform(rng_, 0, 1);
    const Vec3d through = a * (1 - u) + b * u + jitter(0.6);
    return {through - direction * (3 * size_), direction};
  }
  Vec3d inside_point() {
    for (;;) {
      const Vec3d x = mesh_.solid.center + random_direction(rng_) * uniform(rng_, 0, 0.7) * size_;
      if (opening_.distance(x) < -1e-3 * opening_.radius()) return x;
    }
  }
  Vec3d void_point() {
    for (int i = 0; i < 1000; ++i) {
      const Vec3d x = (uniform_int(rng_, 0, 1) != 0 ? edge_point() : corner()) + jitter(0.5);
      const bool in =
          !find_violated(mesh_.solid.planes, 1e-4 * opening_.radius(), x - mesh_.solid.center, 0);
      if (in && opening_.distance(x) > 1e-4 * opening_.radius()) return x;
    }
    return outside_point();
  }

  const SolidMesh& mesh_;
  const Opening& opening_;
  Random rng_;
  double size_;
};

struct Tally {
  std::uint64_t rays = 0, hits = 0, rounded = 0, wrong = 0, unexplained = 0;
  double worst_t = 0;       // of the rays that are right, in sizes
  double worst_normal = 0;  // of the rays that are right, degrees
  std::vector<std::string> unexplained_rays, wrong_rays;

  void add(const Tally& other) {
    rays += other.rays;
    hits += other.hits;
    rounded += other.rounded;
    wrong += other.wrong;
    unexplained += other.unexplained;
    worst_t = std::max(worst_t, other.worst_t);
    worst_normal = std::max(worst_normal, other.worst_normal);
    for (const auto& line : other.unexplained_rays) unexplained_rays.push_back(line);
    for (const auto& line : other.wrong_rays) wrong_rays.push_back(line);
  }
  [[nodiscard]] std::string text() const {
    std::string s = fmt::format(
        "{} rays, {} hits, {} of them rounded; {} wrong, {} unexplained; worst of the others: t "
        "{:.2e} of the size, "
        "normal {:.4f} degrees\n",
        rays, hits, rounded, wrong, unexplained, worst_t, worst_normal);
    const auto& lines = unexplained > 0 ? unexplained_rays : wrong_rays;
    for (std::size_t i = 0; i < std::min<std::size_t>(lines.size(), 8); ++i)
      s += "  " + lines[i] + "\n";
    return s;
  }
};

inline double angle_deg(Vec3d a, Vec3d b) {
  return degrees(std::atan2(length(cross(a, b)), dot(a, b)));
}

// Judges one ray.
class Judge {
 public:
  Judge(const SolidMesh& mesh, const Opening& opening)
      : opening_(opening),
        size_(mesh.solid.size),
        t_tolerance_(1e-5 * size_ + 8 * mesh.quantum),
        normal_tolerance_deg_(0.2 + degrees(4 * mesh.quantum / opening.radius())),
        surface_tolerance_(1e-6 * size_ + 20 * mesh.quantum) {}

  // `label` says how to make the ray again.
  void judge(const Ray& ray, const std::optional<RoundedHit>& got, const std::string& label,
             Tally& tally) const {
    const auto reference = opening_.intersect(ray);
    ++tally.rays;
    if (reference) ++tally.hits;
    if (got && got->feature != Feature::face) ++tally.rounded;
    const double speed = length(ray.direction);
    if (!reference && !got) return;
    double t_error = kInfinity, normal_error = kInfinity;
    if (reference && got) {
      t_error = std::abs(got->t - reference->t) * speed;
      normal_error = angle_deg(got->normal, reference->normal);
      if (t_error <= t_tolerance_ && normal_error <= normal_tolerance_deg_) {
        tally.worst_t = std::max(tally.worst_t, t_error / size_);
        tally.worst_normal = std::max(tally.worst_normal, normal_error);
        return;
      }
    }
    ++tally.wrong;
    const std::string line = describe(ray, reference, got, label);
    tally.wrong_rays.push_back(line);
    if (is_explained(ray, reference, got)) return;
    ++tally.unexplained;
    tally.unexplained_rays.push_back(line);
  }

 private:
  [[nodiscard]] bool is_explained(const Ray& ray, const std::optional<OpeningHit>& reference,
                                  const std::optional<RoundedHit>& got) const {
    if (!reference || !got) return std::abs(opening_.least_distance(ray)) <= surface_tolerance_;
    const Vec3d x = ray.origin + ray.direction * got->t;
    if (std::abs(opening_.distance(x)) > surface_tolerance_) return false;
    // The far crossing is no answer for the near one unless the ray only skims the surface between them.
    const double middle =
        opening_.distance(ray.origin + ray.direction * (0.5 * (got->t + reference->t)));
    if (std::abs(middle) > surface_tolerance_) return false;
    return angle_deg(got->normal, opening_.from_erosion(x)) <= 2 * normal_tolerance_deg_;
  }

  [[nodiscard]] std::string describe(const Ray& ray, const std::optional<OpeningHit>& reference,
                                     const std::optional<RoundedHit>& got,
                                     const std::string& label) const {
    const auto vec = [](Vec3d v) { return fmt::format("({:.9g}, {:.9g}, {:.9g})", v.x, v.y, v.z); };
    std::string s = fmt::format("{}: r {:.9g} size {:.6g} origin {} direction {}: ", label,
                                opening_.radius(), size_, vec(ray.origin), vec(ray.direction));
    s += reference
             ? fmt::format("expected t {:.9g} normal {}", reference->t, vec(reference->normal))
             : "expected nothing";
    s += got ? fmt::format(", got t {:.9g} normal {} on {}", got->t, vec(got->normal),
                           arris::name_of(got->feature))
             : ", got nothing";
    s += fmt::format(", least distance {:.2e} of the size", opening_.least_distance(ray) / size_);
    if (got)
      s += fmt::format(", got point off by {:.2e}",
                       opening_.distance(ray.origin + ray.direction * got->t) / size_);
    return s;
  }

  const Opening& opening_;
  double size_, t_tolerance_, normal_tolerance_deg_, surface_tolerance_;
};

// Whether the host tells the kernel where its rays start.
enum class Start { unknown, told };

struct Volley {
  RayKind kind = RayKind::outside;
  int rays = 100;
  std::uint64_t seed = 1;
  std::string label;  // says how to make the solid again
  Start start = Start::unknown;
};

inline Tally judge_rays(const SolidMesh& mesh, const Opening& opening, const Rounding& rounding,
                        const Volley& volley) {
  RaySource source(mesh, opening, volley.seed);
  const Judge judge(mesh, opening);
  Tally tally;
  for (int i = 0; i < volley.rays; ++i) {
    const Ray ray = source.make(volley.kind);
    RayStart start = RayStart::unknown;
    if (volley.start == Start::told)
      start = opening.contains(ray.origin) ? RayStart::inside : RayStart::outside;
    judge.judge(
        ray, trace(ray, RoundedMesh{mesh.view(), &rounding}, start),
        fmt::format("{} {} seed {} ray {}", volley.label, name_of(volley.kind), volley.seed, i),
        tally);
  }
  return tally;
}

}  // namespace arris::oracle
