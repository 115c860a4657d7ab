// local_rounding_test.cpp — solids that aren't convex, at any radius: the rounded solid lies within the sharp one and
// lacks nothing of it but what lies along its convex edges
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "arris/rounding.h"
#include "edges/flat_regions.h"
#include "edges/welded_mesh.h"
#include "rounding/clearance.h"
#include "rounding/rounding_data.h"
#include "support/ball_oracle.h"
#include "support/nonconvex_solids.h"
#include "support/rounded_ray.h"

namespace arris::oracle {
namespace {

struct SharpEdge {
  Vec3d p0, p1;
  double setback;  // of where the cylinder touches the faces
  double mitre;    // how far beyond the edge's end two cylinders may meet at most
};

// From what the edge's rounding may take away. Beyond its ends that is at most a mitre.
double distance_to(const SharpEdge& edge, Vec3d x) {
  const Vec3d axis = normalize(edge.p1 - edge.p0);
  const double along = dot(x - edge.p0, axis);
  const double beyond = std::max(-along, along - length(edge.p1 - edge.p0));
  const double away = length(x - edge.p0 - axis * along);
  return std::max(away - edge.setback, beyond - edge.mitre);
}

// The convex edges that may be rounded.
std::vector<SharpEdge> find_edges(const TriangleSoup& mesh, double radius) {
  const WeldedMesh welded = make_welded_mesh(mesh.view(), mesh.name);
  const FlatRegions regions = make_flat_regions(welded);
  std::vector<SharpEdge> edges;
  for (std::uint32_t h = 0; h < welded.twin.size(); ++h) {
    if (welded.shell[h / 3] == kNone || welded.twin[h] > kLastHalfEdge || welded.twin[h] < h)
      continue;
    if (classify_edge(welded, regions, h, radians(30)) != EdgeKind::convex) continue;
    const double setback = radius * std::tan(0.5 * turn_at(welded, regions, h));
    edges.push_back({Vec3d(welded.vertices[welded.origin(h)]),
                     Vec3d(welded.vertices[welded.target(h)]), setback, 8 * radius + setback});
  }
  return edges;
}

struct Judgement {
  int rays = 0, hits = 0, rounded = 0;
  int outside = 0;  // hits that aren't in the sharp solid
  int missing = 0;  // rays that went through material far from any edge
  int normals = 0;
  std::vector<std::string> examples;

  [[nodiscard]] int wrong() const { return outside + missing + normals; }
  [[nodiscard]] std::string text() const {
    std::string s = fmt::format("{} rays, {} hits, {} rounded; {} outside, {} missing, {} normals",
                                rays, hits, rounded, outside, missing, normals);
    for (std::size_t i = 0; i < std::min<std::size_t>(examples.size(), 40); ++i)
      s += "\n  " + examples[i];
    return s;
  }
  void add(const Judgement& other) {
    rays += other.rays, hits += other.hits, rounded += other.rounded;
    outside += other.outside, missing += other.missing, normals += other.normals;
    for (const std::string& e : other.examples) examples.push_back(e);
  }
};

class Judge {
 public:
  Judge(const TriangleSoup& mesh, double radius)
      : mesh_(mesh), edges_(find_edges(mesh, radius)), size_(mesh.size()) {
    RoundingOptions options;
    options.radius = radius;
    options.too_large = TooLarge::leave_sharp;
    rounding_.emplace(make_rounding(mesh.view(), options, mesh.name));
    // Cylinders may touch a curved surface only nearly.
    if (rounding_->report().smooth_edges > 0) leeway_ = kSmoothDepthAtEnd * radius;
  }

  [[nodiscard]] const RoundingReport& report() const { return rounding_->report(); }

  // Where exactly rounded solids are thin, balls decide.
  [[nodiscard]] bool is_void_by_definition(Vec3d x) const {
    if (rounding_->data().creased.empty()) return false;
    const double radius = rounding_->data().radius;
    Random rng(1);
    return BallOracle(mesh_.view(), radius).margin(x, rng) < 0.003 * radius;
  }

  void judge(const Ray& ray, Judgement& out, const std::string& label) const {
    const std::vector<MeshHit> sharp = intersect_mesh(ray, mesh_.view());
    if (!alternates(ray, sharp)) return;  // through an edge, or within a face
    ++out.rays;
    const auto got = trace(ray, {mesh_.view(), &*rounding_});
    const double end = got ? got->t : std::numeric_limits<double>::infinity();
    const double slack = std::max(1e-5 * size_, leeway_);
    bool inside = false;
    double far = 0;  // of material passed, from any edge that may be rounded
    for (std::size_t i = 0; i + 1 < sharp.size(); i += 2) {
      const double from = sharp[i].t, to = std::min(sharp[i + 1].t, end);
      // Across the surface, not along the ray.
      const double before = slack / cosine(ray, sharp[i]),
                   after = slack / cosine(ray, sharp[i + 1]);
      inside = inside || (end > from - before && end < sharp[i + 1].t + after);
      for (int k = 1; k < 16 && to > from; ++k) {
        const Vec3d x = ray.origin + ray.direction * (from + (to - from) * k / 16);
        const double beyond = beyond_edges(x);
        if (beyond > far && !is_void_by_definition(x)) far = beyond;
      }
    }
    const auto note = [&](const char* what, double by) {
      out.examples.push_back(
          fmt::format("{}: {} by {:.5f}: origin ({:.17g}, {:.17g}, {:.17g}) direction ({:.17g}, "
                      "{:.17g}, {:.17g}), sharp {:.17g}, got {:.17g} {}",
                      label, what, by, ray.origin.x, ray.origin.y, ray.origin.z, ray.direction.x,
                      ray.direction.y, ray.direction.z, sharp.empty() ? -1 : sharp[0].t,
                      got ? got->t : -1, got ? name_of(got->feature) : ""));
    };
    if (got) {
      ++out.hits;
      if (got->feature != Feature::face) ++out.rounded;
      if (!inside) {
        ++out.outside;
        note("outside", 0);
      }
      if (std::abs(length(got->normal) - 1) > 1e-5 || dot(got->normal, ray.direction) > 1e-6) {
        ++out.normals;
        note("normal", dot(got->normal, ray.direction));
      }
    }
    if (far > 1e-5 * size_) {
      ++out.missing;
      note("missing", far);
    }
  }

  Judgement judge_rays(int count, std::uint64_t seed, const std::string& label) const {
    Random rng(seed);
    Judgement out;
    for (int i = 0; i < count; ++i) {
      const Vec3d target = i % 3 == 0 ? random_point(rng) : edge_point(rng);
      const Vec3d direction = random_direction(rng);
      judge({target - direction * (2 * size_), direction}, out, label);
    }
    return out;
  }

 private:
  // In, out, in, out.
  [[nodiscard]] bool alternates(const Ray& ray, const std::vector<MeshHit>& hits) const {
    for (std::size_t i = 0; i < hits.size(); ++i) {
      const bool leaves = dot(rounding_->face_normal(hits[i].triangle), ray.direction) > 0;
      if (leaves != (i % 2 == 1)) return false;
      if (std::abs(dot(rounding_->face_normal(hits[i].triangle), ray.direction)) < 1e-6)
        return false;
    }
    return hits.size() % 2 == 0;
  }

  [[nodiscard]] double cosine(const Ray& ray, const MeshHit& hit) const {
    return std::abs(dot(rounding_->face_normal(hit.triangle), ray.direction));
  }

  // How much farther x is from every edge than its rounding could reach.
  [[nodiscard]] double beyond_edges(Vec3d x) const {
    double least = std::numeric_limits<double>::infinity();
    for (const SharpEdge& e : edges_) least = std::min(least, distance_to(e, x));
    for (const Solid& solid : rounding_->data().solids)
      least = std::min(least, beyond_network(solid, x - solid.center));
    return least;
  }

  // Where a corner of many faces is nearly flat, its cylinders and spheres lie far from any edge.
  [[nodiscard]] double beyond_network(const Solid& solid, Vec3d x) const {
    const Rounding::Data& data = rounding_->data();
    double least = std::numeric_limits<double>::infinity();
    for (std::uint32_t i = solid.first_arc; i < solid.first_arc + solid.arc_count; ++i) {
      const Arc& arc = data.arcs[i];
      if (arc.is_stub()) continue;
      const double along = std::clamp(dot(x - Vec3d(arc.line.p0), Vec3d(arc.line.axis)), 0.0,
                                      double(arc.line.length));
      const double cosine = dot(data.faces[arc.face_a].normal, data.faces[arc.face_b].normal);
      const double thickest = data.radius / std::sqrt(0.5 * (1 + cosine));
      least =
          std::min(least, length(x - Vec3d(arc.line.p0) - Vec3d(arc.line.axis) * along) - thickest);
    }
    for (std::uint32_t i = solid.first_node; i < solid.first_node + solid.node_count; ++i) {
      const Node& node = data.nodes[i];
      if (node.kind != Node::Kind::sphere) continue;
      double to_corner = std::numeric_limits<double>::infinity();
      for (Vec3f p : mesh_.positions)
        to_corner = std::min(to_corner, length(Vec3d(p) - solid.center - Vec3d(node.position)));
      least = std::min(least, length(x - Vec3d(node.position)) - to_corner);
    }
    return least;
  }

  Vec3d random_point(Random& rng) const {
    const Triangle& t =
        mesh_.triangles[std::size_t(uniform_int(rng, 0, int(mesh_.triangles.size()) - 1))];
    const double u = std::sqrt(uniform(rng, 0, 1)), v = uniform(rng, 0, 1);
    return Vec3d(mesh_.positions[t[0]]) * (1 - u) + Vec3d(mesh_.positions[t[1]]) * (u * (1 - v)) +
           Vec3d(mesh_.positions[t[2]]) * (u * v);
  }
  Vec3d edge_point(Random& rng) const {
    if (edges_.empty()) return random_point(rng);
    const SharpEdge& e = edges_[std::size_t(uniform_int(rng, 0, int(edges_.size()) - 1))];
    const double u = uniform(rng, 0, 1);
    const double reach = std::min(e.setback, 0.2 * size_);
    return e.p0 * (1 - u) + e.p1 * u + random_direction(rng) * uniform(rng, 0, 1.2 * reach);
  }

  const TriangleSoup& mesh_;
  std::vector<SharpEdge> edges_;
  double size_;
  double leeway_ = 0;  // by which the rounded surface may lie outside of the sharp one
  std::optional<Rounding> rounding_;
};

TriangleSoup make_l() {
  return prism_over("L", {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}, {});
}

TriangleSoup make_u(double wall) {
  const double w = wall;
  return prism_over("U", {{0, 0}, {1, 0}, {1, 1}, {1 - w, 1}, {1 - w, w}, {w, w}, {w, 1}, {0, 1}},
                    {});
}

TEST(LocalRounding, radius_larger_than_the_solid_leaves_it_as_it_is) {
  const TriangleSoup mesh = make_l();
  for (double radius : {2.5, 5.0, 50.0, 1e12}) {
    const Judge judge(mesh, radius);
    Judgement found = judge.judge_rays(500, 1, fmt::format("radius {}", radius));
    judge.judge({{1.01, 0.51, 5}, {0, 0, -1}}, found, "through the bottom");
    EXPECT_EQ(found.wrong(), 0) << found.text();
    EXPECT_EQ(judge.report().rounded_edges, 0U) << radius;
  }
}

TEST(LocalRounding, radius_that_fits_rounds_every_convex_edge) {
  EXPECT_EQ(Judge(make_l(), 0.45).report().rounded_edges, 17U);
  EXPECT_EQ(Judge(make_l(), 0.45).report().notes.size(), 1U);  // the concave edge
  EXPECT_EQ(Judge(make_u(0.05), 0.024).report().rounded_edges, 22U);
  EXPECT_EQ(Judge(make_u(0.05), 0.024).report().rounded_corners, 12U);
}

// The walls' tops are narrower than two radii; the long edges beside the broad faces are not in the way.
TEST(LocalRounding, walls_thinner_than_two_radii_keep_their_faces) {
  const TriangleSoup mesh = make_u(0.05);
  for (double radius : {0.03, 0.06, 0.15, 0.3}) {
    const Judge judge(mesh, radius);
    const Judgement found = judge.judge_rays(2000, 2, fmt::format("radius {}", radius));
    EXPECT_EQ(found.wrong(), 0) << found.text();
    const std::vector<RoundingNote>& notes = judge.report().notes;
    EXPECT_TRUE(std::ranges::any_of(notes, [](const RoundingNote& note) {
      return note.many.find("the radius is too large for the faces beside") != std::string::npos;
    })) << radius;
  }
}

// Where a corner can't be rounded, the roundings of its edges stop short of it: no sheet of a face stands free.
TEST(LocalRounding, corner_that_stays_sharp_is_a_block) {
  const TriangleSoup mesh = make_u(0.05);
  RoundingOptions options;
  options.radius = 0.15;
  const Rounding rounding = make_rounding(mesh.view(), options, mesh.name);
  const Vec3d inward = normalize(Vec3d(1, 1.2, 0));
  const auto depth_at = [&](double z) {
    const auto hit = trace({Vec3d(0.001, 0.0012, z) - inward, inward}, {mesh.view(), &rounding});
    return hit ? hit->t - 1 : -1;
  };
  EXPECT_GT(depth_at(0.5), 0.01);
  for (double z : {0.001, 0.01, 0.1, 0.9, 0.99, 0.999}) EXPECT_NEAR(depth_at(z), 0, 0.002) << z;
}

// One ray in fifty thousand may be wrong: hits at corners of edges that stay sharp.
TEST(LocalRounding, any_radius_on_any_solid_takes_away_nothing_but_edges) {
  Judgement all;
  std::uint64_t edges = 0, sharp = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    Random rng(seed);
    for (const TriangleSoup& mesh : make_nonconvex_solids(seed)) {
      const double large = std::pow(10, uniform(rng, -2.5, 1)) * mesh.size();
      const double small = std::pow(10, uniform(rng, -3, -1.3)) * mesh.size();
      for (double radius : {large, small}) {
        const Judge judge(mesh, radius);
        const std::string label = fmt::format("{} seed {} radius {:.5f}", mesh.name, seed, radius);
        all.add(judge.judge_rays(150, seed, label));
        edges += judge.report().rounded_edges;
        for (const RoundingNote& note : judge.report().notes)
          if (note.many.find("edges stay sharp: the radius") != std::string::npos)
            sharp += note.count;
      }
    }
  }
  EXPECT_LE(all.wrong() * 50000, all.rays) << all.text();
  EXPECT_GT(all.rounded * 10, all.hits) << all.text();
  EXPECT_GT(edges, sharp / 2);
}

}  // namespace
}  // namespace arris::oracle
