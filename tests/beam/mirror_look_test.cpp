// What mirrors and glass show, in trees of signs against rays: at points that follow the signs to an end, a ray that is
// reflected and refracted as it goes finds what the end says.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "beam/beam_mirror.h"
#include "support/beam_truth.h"

namespace arris::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNear = 1e-6;  // of a pixel
const Optics kMirror{Optics::Kind::reflects, 1};

// How many mirrors and faces of glass the ray meets, and what it sees in the end.
using MirroredKey = std::pair<std::size_t, SeenKey>;

// In the solid's space.
Vec3d outward_normal(const BeamSolid& solid, const SeenSurface& seen, const Ray& own,
                     double depth) {
  if (const Facet* facet = solid.shape->facet(seen.leaf)) {
    const Vec3d n = solid.shape->planes()[facet->plane.plane].normal;
    return facet->plane.flipped ? -n : n;
  }
  return solid.shape->csg().outward_normal({depth, seen.leaf, seen.face, seen.entering}, own);
}

// `step`: how far behind a mirror it goes on.
MirroredKey follow(const BeamScene& scene, const OpticsOf& optics_of, Ray ray, double step) {
  std::vector<BeamPart> roots;
  for (std::uint32_t i = 0; i < scene.placed.size(); ++i) {
    if (!scene.placed[i].shape->root().is_decided()) {
      roots.push_back({i, scene.placed[i].shape->root()});
    }
  }
  for (std::size_t mirrors = 0;; ++mirrors) {
    const std::optional<RaySight> sight = see(scene.placed, roots, ray);
    if (!sight) return {mirrors, key_of(std::nullopt)};
    SeenSurface seen = sight->seen;
    const BeamSolid& solid = scene.placed[seen.solid];
    const Ray own{transform_point(solid.object_from_world, ray.origin),
                  transform_vector(solid.object_from_world, ray.direction)};
    Vec3d n = outward_normal(solid, seen, own, sight->depth);
    if (solid.shape->is_mesh()) seen.entering = dot(n, own.direction) < 0;
    const Optics optics = optics_of(seen);
    if (mirrors == kMostMirrors || optics.kind == Optics::Kind::scatters) {
      return {mirrors, key_of(sight->seen)};
    }
    n = normalize(transpose(solid.object_from_world.linear) * n);
    const Vec3d d = normalize(ray.direction);
    if (dot(n, d) > 0) n = -n;
    ray.origin = ray.origin + ray.direction * sight->depth;
    ray.direction = d - n * (2 * dot(n, d));
    const double eta = optics.relative_ior, cosine = -dot(n, d);
    const double passing = 1 - eta * eta * (1 - cosine * cosine);
    if (optics.kind == Optics::Kind::refracts && passing > 0) {
      ray.direction = d * eta + n * (eta * cosine - std::sqrt(passing));
    }
    ray.origin = ray.origin + ray.direction * step;
  }
}

// Nothing: near a zero of a sign.
const LookNode* end_at(const LookTree& tree, Vec2d at) {
  const Rect around{at.x - kNear, at.y - kNear, at.x + kNear, at.y + kNear};
  const LookNode* node = tree.nodes.data();
  while (node->kind == LookNode::Kind::sign) {
    const Sign sign = sign_of(range_over(node->polynomial, around));
    if (sign == Sign::unknown) return nullptr;
    node = &tree.nodes[sign == Sign::negative ? node->negative : node->positive];
  }
  return node;
}

struct Tally {
  int known = 0, open = 0;
  std::array<int, kMostMirrors + 1> by_depth{};  // of what is known

  [[nodiscard]] int mirrored() const { return known - by_depth[0]; }
};

// Random regions in regions of one picture, down to 1/64 of a pixel.
class Checker {
 public:
  Checker(const BeamScene& scene, OpticsOf optics, double step, CsgRandom& random, std::string name,
          Tally& tally)
      : scene_(scene),
        optics_(std::move(optics)),
        step_(step),
        random_(random),
        name_(std::move(name)),
        tally_(tally),
        view_(scene.placed, scene.eye),
        looker_(scene.placed, scene.eye, optics_),
        picture_{0, 0, double(scene.width), double(scene.height)},
        lists_(picture_) {}

  void check(int dives) {
    std::vector<BeamPart> roots;
    for (std::uint32_t i = 0; i < scene_.placed.size(); ++i) {
      const CsgExpression& root = scene_.placed[i].shape->root();
      if (!root.is_decided()) roots.push_back({i, root});
    }
    for (int i = 0; i < dives; ++i) dive(picture_, roots);
  }

 private:
  void dive(const Rect& rect, const std::vector<BeamPart>& above) {
    const BeamList list = prune_parts(view_, above, rect, kInfinity);
    LookTree tree = look(view_, list, rect, kInfinity);
    if (tree.complete) {
      std::uint64_t regions = 0;
      looker_.add_mirrors(tree, rect, lists_, regions);
      for (int k = 0; k < 4; ++k) check_point(tree, rect);
    }
    if (rect.width() < 1.0 / 32) return;
    dive(quarters_of(rect)[random_() % 4], list.parts);
    if (random_() % 8 == 0) dive(quarters_of(rect)[random_() % 4], list.parts);
  }

  void check_point(const LookTree& tree, const Rect& rect) {
    const Vec2d at{uniform(random_, rect.x0, rect.x1), uniform(random_, rect.y0, rect.y1)};
    const LookNode* end = end_at(tree, at);
    if (end == nullptr) return;
    if (end->kind == LookNode::Kind::unknown || end->mirror_open) {
      ++tally_.open;
      return;
    }
    const std::size_t depth = end->mirrors == 0 ? 0 : lists_.chain(end->mirrors).size();
    ++tally_.known;
    ++tally_.by_depth[depth];
    const bool is_surface = end->kind == LookNode::Kind::surface;
    const MirroredKey said{depth, key_of(is_surface ? std::optional(end->seen) : std::nullopt)};
    const MirroredKey truth = follow_at(at, step_);
    if (said == truth || !is_steady(at, truth)) return;
    ADD_FAILURE() << name_ << " at " << at.x << ", " << at.y << " of a region of " << rect.width()
                  << ": after " << said.first << " mirrors solid " << std::get<0>(said.second)
                  << " leaf " << std::get<1>(said.second) << ", rays find " << truth.first
                  << " mirrors, solid " << std::get<0>(truth.second) << " leaf "
                  << std::get<1>(truth.second);
  }
  [[nodiscard]] MirroredKey follow_at(Vec2d at, double step) const {
    return follow(scene_, optics_, ray_through(scene_.eye, at), step);
  }
  // Do rays nearby, and such that begin elsewhere behind mirrors, find the same?
  [[nodiscard]] bool is_steady(Vec2d at, const MirroredKey& truth) const {
    constexpr double kAside = kNear / 2;
    return follow_at({at.x + kAside, at.y}, step_) == truth &&
           follow_at({at.x - kAside, at.y}, step_) == truth &&
           follow_at({at.x, at.y + kAside}, step_) == truth &&
           follow_at({at.x, at.y - kAside}, step_) == truth && follow_at(at, step_ / 10) == truth &&
           follow_at(at, step_ * 10) == truth;
  }

  const BeamScene& scene_;
  OpticsOf optics_;
  double step_;
  CsgRandom& random_;
  std::string name_;
  Tally& tally_;
  BeamView view_;
  MirrorLooker looker_;
  Rect picture_;
  MirrorLists lists_;
};

// Where a scene as described below is, and how large.
struct Frame {
  double scale = 1;
  Vec3d origin{};
};

class SceneMaker {
 public:
  static constexpr int kKinds = 15;

  SceneMaker(CsgRandom& random, const Frame& frame) : random_(random), frame_(frame) {}

  // Mirrors or glass come first.
  std::uint32_t add_mirrors(int kind) {
    const Affine3d turned = random_placement(random_, 0.2);
    const CsgBox block{Vec3d(-1.3), Vec3d(1.3)};
    switch (kind) {
      case 0:
        add(one_leaf(CsgSphere{1.3}), unequal());
        return 1;
      case 1:
        add(one_leaf(CsgCone{-1.2, 1.2, 0.9, 0.9}), unequal());
        return 1;
      case 2:
        add(one_leaf(CsgCone{-1.2, 1.2, 0, 1.2}), unequal());
        return 1;
      case 3:
        add(double_cone(), unequal());
        return 1;
      case 4:  // a bore
        add(flat_tree(CsgOperation::subtract,
                      {{block, {}, {}}, {CsgCone{-2, 2, 0.8, 0.8}, turned, {}}}),
            random_placement(random_, 0));
        return 1;
      case 5:  // a funnel to both sides
        add(flat_tree(CsgOperation::subtract, {{block, {}, {}},
                                               {CsgCone{0, 2, 0, 1.2}, {}, {}},
                                               {CsgCone{-2, 0, 1.2, 0}, {}, {}}}),
            random_placement(random_, 0));
        return 1;
      case 6:
        add(triangles_of(random_mesh(random_)), unequal());
        return 1;
      case 7:  // a mesh in a tree
        add(flat_tree(CsgOperation::subtract,
                      {{random_mesh(random_), {}, {}},
                       {random_convex(random_), random_placement(random_, 0.6), {}}}),
            unequal());
        return 1;
      case 8:
        add(random_convex_tree(random_, 1), turned);
        return 1;
      case 9:  // one in the other, in part
        add(one_leaf(random_convex(random_)), random_placement(random_, 0.6));
        add(one_leaf(random_convex(random_)), random_placement(random_, 0.6));
        return 2;
      case 10:  // and as a whole
        add(one_leaf(CsgSphere{1.4}), {});
        add(one_leaf(CsgSphere{0.8}), {{}, {0.2, 0.1, 0}});
        return 2;
      case 11:  // hollow
        add(flat_tree(CsgOperation::subtract,
                      {{CsgSphere{1.4}, {}, {}}, {CsgSphere{1.1}, {{}, {0.1, 0, 0.1}}, {}}}),
            {});
        return 1;
      case 12:  // on the floor
        add(one_leaf(CsgBox{{-1, -1, -2.2}, {1, 1, -0.5}}), {});
        return 1;
      case 13:  // around the eye
        add(one_leaf(CsgSphere{9}), {});
        return 1;
      default: {  // sheets, and a ball between
        std::vector<MeshTriangle> sheets;
        for (std::uint32_t i = 0; i < 3; ++i) sheets.push_back({corners(), i});
        add(sheets, {});
        add(one_leaf(CsgSphere{0.9}), random_placement(random_, 0.5));
        return 2;
      }
    }
  }

  void add_others() {
    add(one_leaf(CsgBox{{-9, -9, -3}, {9, 9, -2.2}}), {});
    for (int i = 0; i < 4; ++i) {
      const Affine3d at{
          {{0.4, 0, 0}, {0, 0.4, 0}, {0, 0, 0.4}},
          {uniform(random_, -2.5, 2.5), uniform(random_, -4, 4), uniform(random_, -2, 2.5)}};
      switch (random_() % 5) {
        case 0:
          add(triangles_of(random_mesh(random_)), at);
          break;
        case 1:
          add(flat_tree(CsgOperation(random_() % 3),
                        {{random_mesh(random_), {}, {}},
                         {random_convex(random_), random_placement(random_, 0.5), {}}}),
              at);
          break;
        case 2:
          add(one_leaf(CsgTorus{0.7, 0.3}), at);
          break;
        case 3:
          add(double_cone(), at);
          break;
        default:
          add(random_convex_tree(random_, 1), at);
      }
    }
  }

  BeamScene finish() {
    const Vec3d from{uniform(random_, -1, 1), -6, uniform(random_, 0, 3)};
    scene_.width = scene_.height = 8;
    scene_.eye = look_at(frame_.origin + from * frame_.scale, frame_.origin, 25, 8, 8);
    return std::move(scene_);
  }

 private:
  template <class Described>
  void add(const Described& described, Affine3d at) {
    const double s = frame_.scale;
    at.linear = {at.linear.x * s, at.linear.y * s, at.linear.z * s};
    at.translation = frame_.origin + at.translation * s;
    scene_.add(described, at);
  }
  Affine3d unequal() {
    Affine3d m = random_placement(random_, 0.3);
    m.linear.x = m.linear.x * uniform(random_, 0.4, 1.6);
    m.linear.y = m.linear.y * uniform(random_, 0.4, 1.6);
    m.linear.z = m.linear.z * uniform(random_, 0.4, 1.6);
    return m;
  }
  std::array<Vec3d, 3> corners() {
    return {random_vector(random_, 1.5), random_vector(random_, 1.5), random_vector(random_, 1.5)};
  }
  static CsgTree double_cone() {
    return flat_tree(CsgOperation::unite,
                     {{CsgCone{0, 1, 0, 0.9}, {}, {}}, {CsgCone{-1, 0, 0.9, 0}, {}, {}}});
  }
  static std::vector<MeshTriangle> triangles_of(const CsgMesh& mesh) {
    std::vector<MeshTriangle> triangles;
    for (const auto& [a, b, c] : mesh.triangles) {
      triangles.push_back({{mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]},
                           std::uint32_t(triangles.size())});
    }
    return triangles;
  }

  CsgRandom& random_;
  Frame frame_;
  BeamScene scene_;
};

Tally check_scenes(bool is_glass, const Frame& frame, std::uint64_t seed, int scenes_of_a_kind) {
  CsgRandom random(seed);
  Tally tally;
  // Beyond the rounding of places.
  const double step = 1e-7 * frame.scale + 1e-11 * length(frame.origin);
  for (int i = 0; i < SceneMaker::kKinds * scenes_of_a_kind; ++i) {
    SceneMaker maker(random, frame);
    const std::uint32_t mirrors = maker.add_mirrors(i % SceneMaker::kKinds);
    maker.add_others();
    const BeamScene scene = maker.finish();
    const double ior = uniform(random, 1.05, 2);
    const bool floor_too = random() % 3 == 0, one_is_metal = random() % 3 == 0;
    const OpticsOf optics = [=](const SeenSurface& seen) {
      if (seen.solid >= mirrors) return floor_too && seen.solid == mirrors ? kMirror : Optics{};
      if (!is_glass || (one_is_metal && seen.solid == 1)) return kMirror;
      return Optics{Optics::Kind::refracts, seen.entering ? 1 / ior : ior};
    };
    const std::string name = std::to_string(i % SceneMaker::kKinds) + " of " + std::to_string(i);
    Checker(scene, optics, step, random, name, tally).check(10);
  }
  return tally;
}

TEST(mirror_look, mirrors_of_all_shapes_show_what_rays_find) {
  const Tally tally = check_scenes(false, {}, 1, 6);
  EXPECT_GT(tally.mirrored(), 10000);
  EXPECT_GT(tally.by_depth[2], 500);
  EXPECT_GT(tally.known, 8 * tally.open);
}

TEST(mirror_look, glass_of_all_shapes_shows_what_rays_find) {
  const Tally tally = check_scenes(true, {}, 2, 6);
  EXPECT_GT(tally.mirrored(), 8000);
  for (std::size_t depth = 1; depth <= 5; ++depth) EXPECT_GT(tally.by_depth[depth], 100);
  EXPECT_GT(tally.known, 4 * tally.open);
}

// Small, large, and far from the origin, where places are rounded.
TEST(mirror_look, scale_and_place_do_not_matter) {
  const Frame frames[] = {{1e-3, {}}, {1e6, {}}, {1, {1e4, -3e4, 2e4}}, {1, {1e6, 0, 0}}};
  for (const Frame& frame : frames) {
    const Tally tally = check_scenes(true, frame, 3, 1);
    EXPECT_GT(tally.mirrored(), 1000) << frame.scale << ", " << frame.origin.x;
  }
}

}  // namespace
}  // namespace arris::test
