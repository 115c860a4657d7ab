#include "pov_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <set>
#include <utility>
#include <variant>
#include <vector>

#include "arris/error.h"

namespace arris::bench {
namespace {

constexpr std::size_t kManyChildren = 32;  // from here on a difference is worth cutting
constexpr int kTiles = 20;                 // a side
// Small against every distance, so that 2 / (1 + (d / kFade)²) is 2 (kFade / d)² to seven digits.
constexpr double kFade = 0.01;
constexpr double kFarAway = 5000;  // of parallel lights

[[noreturn]] void refuse(const std::string& where, const std::string& what) {
  throw Error(Error::Kind::input, where, what + " can't be put into a POV-Ray scene here");
}

std::string vec(Vec3d v) {
  return fmt::format("<{:.12g},{:.12g},{:.12g}>", v.x, v.y, v.z);
}
std::string color(Rgb c, double scale = 1) {
  return fmt::format("rgb <{:.9g},{:.9g},{:.9g}>", double(c.x) * scale, double(c.y) * scale,
                     double(c.z) * scale);
}
std::string matrix(const Affine3d& m) {
  const auto row = [](Vec3d v) { return fmt::format("{:.12g},{:.12g},{:.12g}", v.x, v.y, v.z); };
  return fmt::format("matrix <{}, {}, {}, {}>", row(m.linear.x), row(m.linear.y), row(m.linear.z),
                     row(m.translation));
}

std::string camera_text(const Camera& camera, const ImageSettings& image) {
  const double aspect = double(image.width_px) / image.height_px;
  const double angle = degrees(2 * std::atan(std::tan(radians(camera.fov_deg) / 2) * aspect));
  // A negative right makes POV-Ray's space right-handed.
  return fmt::format(
      "camera {{ perspective location {} sky {} up y right -x*{:.12g} angle {:.12g} look_at {} "
      "}}\n",
      vec(camera.position), vec(camera.up), aspect, angle, vec(camera.target));
}

std::string light_text(const Light& light) {
  if (const auto* point = std::get_if<PointLight>(&light)) {
    return fmt::format("light_source {{ {} {} fade_distance {} fade_power 2 }}\n",
                       vec(point->position), color(point->intensity, 1 / (2 * kPi * kFade * kFade)),
                       kFade);
  }
  if (const auto* sun = std::get_if<DirectionalLight>(&light)) {
    return fmt::format("light_source {{ {} {} parallel point_at <0,0,0> }}\n",
                       vec(normalize(sun->direction) * -kFarAway), color(sun->irradiance, 1 / kPi));
  }
  refuse("", "a light with an extent or a cone");
}

std::string texture_text(const Material& material, std::size_t index) {
  const bool emits = max_component(material.emission) > 0;
  const bool reflects = max_component(material.base_color) > 0;
  if (material.glossy_mix != 0.0F || (emits && reflects)) {
    refuse(fmt::format("material \"{}\"", material.name), "more than diffuse or emitted light");
  }
  return fmt::format(
      "#declare T{} = texture {{ pigment {{ {} }} finish {{ ambient 0 diffuse {} emission {} }} "
      "}}\n",
      index, color(emits ? material.emission : material.base_color), emits ? 0 : 1, emits ? 1 : 0);
}

struct ShapeText {
  std::string operator()(const CsgSphere& s) const {
    return fmt::format("sphere {{ 0, {:.12g}", s.radius);
  }
  std::string operator()(const CsgBox& b) const {
    return fmt::format("box {{ {}, {}", vec(b.low), vec(b.high));
  }
  std::string operator()(const CsgCone& c) const {
    const std::string low = vec({0, 0, c.z_low}), high = vec({0, 0, c.z_high});
    if (c.radius_low == c.radius_high) {
      return fmt::format("cylinder {{ {}, {}, {:.12g}", low, high, c.radius_low);
    }
    return fmt::format("cone {{ {}, {:.12g}, {}, {:.12g}", low, c.radius_low, high, c.radius_high);
  }
  std::string operator()(const CsgPolyhedron& p) const {
    std::string text = "intersection {";
    for (const CsgHalfSpace& face : p.faces) {
      text += fmt::format(" plane {{ {}, {:.12g} }}", vec(face.normal), face.d);
    }
    return text;
  }
  template <class Other>
  std::string operator()(const Other&) const {
    refuse("", "a primitive other than sphere, box, cone and convex polyhedron");
  }
};

std::string leaf_text(const CsgLeaf& leaf, const Affine3d& world_from_object) {
  return fmt::format("{} texture {{ T{} }} {} }}\n", std::visit(ShapeText{}, leaf.primitive),
                     leaf.material.index, matrix(world_from_object * leaf.object_from_primitive));
}

struct Bounds {
  Vec3d low{std::numeric_limits<double>::infinity()};
  Vec3d high{-std::numeric_limits<double>::infinity()};
};

struct LocalBounds {
  Bounds operator()(const CsgSphere& s) const { return {Vec3d(-s.radius), Vec3d(s.radius)}; }
  Bounds operator()(const CsgBox& b) const { return {b.low, b.high}; }
  Bounds operator()(const CsgCone& c) const {
    const double r = std::max(c.radius_low, c.radius_high);
    return {{-r, -r, c.z_low}, {r, r, c.z_high}};
  }
  template <class Other>
  Bounds operator()(const Other&) const {
    return {Vec3d(-std::numeric_limits<double>::max()), Vec3d(std::numeric_limits<double>::max())};
  }
};

Bounds bounds_of(const CsgLeaf& leaf) {
  const Bounds local = std::visit(LocalBounds{}, leaf.primitive);
  Bounds bounds;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3d p = transform_point(leaf.object_from_primitive,
                                    {(corner & 1) != 0 ? local.high.x : local.low.x,
                                     (corner & 2) != 0 ? local.high.y : local.low.y,
                                     (corner & 4) != 0 ? local.high.z : local.low.z});
    bounds.low = min(bounds.low, p);
    bounds.high = max(bounds.high, p);
  }
  return bounds;
}

class ObjectText {
 public:
  ObjectText(const CsgTree& tree, const Affine3d& world_from_object, PovDifferences differences)
      : tree_(tree), world_(world_from_object), differences_(differences) {}

  // Children of a union stand by themselves: POV-Ray then bounds each.
  [[nodiscard]] std::string root() const {
    if (tree_.nodes.empty()) return "";
    const CsgNode& root = tree_.nodes[0];
    if (root.leaf != CsgNode::kInner || root.operation != CsgOperation::unite) return node(root);
    std::string text;
    for (const std::uint32_t child : root.children) text += node(tree_.nodes[child]);
    return text;
  }

 private:
  [[nodiscard]] std::string node(const CsgNode& n) const {
    if (n.leaf != CsgNode::kInner) return leaf_text(tree_.leaves[n.leaf], world_);
    if (n.children.empty()) return "";
    if (n.children.size() == 1) return node(tree_.nodes[n.children[0]]);
    if (differences_ == PovDifferences::cut && is_drilled_box(n)) return tiles(n);
    constexpr std::array<const char*, 3> kWords{"union", "intersection", "difference"};
    std::string text = fmt::format("{} {{\n", kWords[std::size_t(n.operation)]);
    for (const std::uint32_t child : n.children) text += node(tree_.nodes[child]);
    return text + "}\n";
  }

  // An upright box without some leaves.
  [[nodiscard]] bool is_drilled_box(const CsgNode& n) const {
    if (n.operation != CsgOperation::subtract || n.children.size() < kManyChildren) return false;
    for (const std::uint32_t child : n.children) {
      if (tree_.nodes[child].leaf == CsgNode::kInner) return false;
    }
    const CsgLeaf& box = tree_.leaves[tree_.nodes[n.children[0]].leaf];
    return std::holds_alternative<CsgBox>(box.primitive) &&
           box.object_from_primitive.linear == Mat3d{};
  }

  // Cut along x and y.
  [[nodiscard]] std::string tiles(const CsgNode& n) const {
    const CsgLeaf& box = tree_.leaves[tree_.nodes[n.children[0]].leaf];
    const Bounds whole = bounds_of(box);
    std::vector<Bounds> bounds;
    for (const std::uint32_t child : n.children) {
      bounds.push_back(bounds_of(tree_.leaves[tree_.nodes[child].leaf]));
    }
    const Vec3d step = (whole.high - whole.low) * (1.0 / kTiles);
    std::string text;
    for (int i = 0; i < kTiles * kTiles; ++i) {
      const double x = whole.low.x + (i % kTiles) * step.x;
      const double y = whole.low.y + (i / kTiles) * step.y;
      CsgLeaf tile = box;
      tile.object_from_primitive = {};
      tile.primitive = CsgBox{{x, y, whole.low.z}, {x + step.x, y + step.y, whole.high.z}};
      std::string holes;
      for (std::size_t k = 1; k < n.children.size(); ++k) {
        if (bounds[k].low.x < x + step.x && bounds[k].high.x > x && bounds[k].low.y < y + step.y &&
            bounds[k].high.y > y) {
          holes += leaf_text(tree_.leaves[tree_.nodes[n.children[k]].leaf], world_);
        }
      }
      const std::string solid = leaf_text(tile, world_);
      text += holes.empty() ? solid : "difference {\n" + solid + holes + "}\n";
    }
    return text;
  }

  const CsgTree& tree_;
  const Affine3d& world_;
  PovDifferences differences_;
};

std::string lights_text(const Scene& scene) {
  const auto* room = std::get_if<ConstantEnvironment>(&scene.environment.value());
  if (room == nullptr || max_component(room->radiance) > 0) {
    refuse(scene.name, "light from the environment");
  }
  std::string text;
  for (const Light& light : scene.lights) text += light_text(light);
  return text;
}

// Of the materials that the objects' leaves have.
std::string textures_text(const Scene& scene) {
  std::set<std::uint32_t> used;
  for (const Object& object : scene.objects) {
    if (!object.csg) refuse(fmt::format("object \"{}\"", object.name), "a mesh");
    for (const CsgLeaf& leaf : scene.csg_trees[object.csg->index].leaves) {
      used.insert(leaf.material.index);
    }
  }
  std::string text;
  for (const std::uint32_t index : used) text += texture_text(scene.materials[index], index);
  return text;
}

}  // namespace

std::string pov_scene(const Scene& scene, PovDifferences differences) {
  std::string text = "#version 3.7;\nglobal_settings { assumed_gamma 1.0 max_trace_level 5 }\n" +
                     camera_text(scene.camera.value(), scene.image) + lights_text(scene) +
                     textures_text(scene);
  for (const Object& object : scene.objects) {
    text += ObjectText(scene.csg_trees[object.csg->index], object.world_from_object, differences)
                .root();
  }
  return text;
}

}  // namespace arris::bench
