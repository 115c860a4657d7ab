// validate_scene.cpp — everything that is wrong with a scene, before anything is built from it
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "arris/render.h"
#include "scene/limits.h"
#include "scene/scene_bounds.h"
#include "scene/validate_animation.h"
#include "scene/validate_csg.h"
#include "scene/validate_placement.h"

namespace arris {
namespace {

constexpr std::uint64_t kMaxTriangles = 1ULL << 31;  // of one mesh

using Problems = std::vector<std::string>;

std::string list(Vec3d v) {
  return fmt::format("({:g}, {:g}, {:g})", v.x, v.y, v.z);
}

// One line for all elements that are wrong in one way: how many, and the first.
template <class Range, class IsWrong, class Describe>
void report_first(const Range& range, const IsWrong& is_wrong, Problems& problems,
                  const Describe& describe) {
  std::size_t count = 0, first = 0, index = 0;
  for (const auto& element : range) {
    if (is_wrong(element) && count++ == 0) {
      first = index;
    }
    ++index;
  }
  if (count > 0) {
    problems.push_back(describe(first) +
                       (count > 1 ? fmt::format(" ({} more like it)", count - 1) : std::string()));
  }
}

bool usable_coordinate(Vec3d p) {
  return is_finite(p) && std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) <= kMaxCoordinate;
}

// ---------------------------------------------------------------------------------------------- meshes

void check_mesh(const Scene& scene, std::size_t index, Problems& problems) {
  const Mesh& mesh = scene.meshes[index];
  const std::string where =
      mesh.name.empty() ? fmt::format("mesh {}", index) : fmt::format("mesh \"{}\"", mesh.name);
  const std::size_t vertices = mesh.positions.size();
  const auto check_length = [&](std::string_view what, std::size_t have, std::size_t want) {
    if (have != 0 && have != want) {
      problems.push_back(fmt::format("{}: {} {}, but {} are needed; give one each or none", where,
                                     have, what, want));
    }
  };
  check_length("vertex normals", mesh.normals.size(), vertices);
  check_length("texture coordinates", mesh.uvs.size(), vertices);
  check_length("triangle materials", mesh.triangle_materials.size(), mesh.triangles.size());
  if (mesh.triangles.size() > kMaxTriangles || vertices > kMaxTriangles) {
    problems.push_back(fmt::format("{}: {} triangles; at most {} fit in one mesh, split it", where,
                                   mesh.triangles.size(), kMaxTriangles));
  }
  report_first(
      mesh.positions, [](Vec3f p) { return !usable_coordinate(Vec3d(p)); }, problems,
      [&](std::size_t i) {
        return fmt::format("{}: vertex {} is at {}; coordinates must be numbers up to {:g}", where,
                           i, list(Vec3d(mesh.positions[i])), kMaxCoordinate);
      });
  report_first(
      mesh.triangles,
      [&](const Triangle& t) { return t[0] >= vertices || t[1] >= vertices || t[2] >= vertices; },
      problems,
      [&](std::size_t i) {
        const Triangle& t = mesh.triangles[i];
        return fmt::format("{}: triangle {} refers to vertex {}, but there are {}", where, i,
                           std::max({t[0], t[1], t[2]}), vertices);
      });
  if (mesh.sharp_edges) {
    report_first(
        *mesh.sharp_edges,
        [&](const VertexPair& edge) { return edge[0] >= vertices || edge[1] >= vertices; },
        problems,
        [&](std::size_t i) {
          const VertexPair& edge = (*mesh.sharp_edges)[i];
          return fmt::format("{}: the sharp edge {} refers to vertex {}, but there are {}", where,
                             i, std::max(edge[0], edge[1]), vertices);
        });
  }
  report_first(
      mesh.edge_radii,
      [&](const EdgeRadius& e) { return e.vertices[0] >= vertices || e.vertices[1] >= vertices; },
      problems,
      [&](std::size_t i) {
        const VertexPair& edge = mesh.edge_radii[i].vertices;
        return fmt::format("{}: the edge radius {} refers to vertex {}, but there are {}", where, i,
                           std::max(edge[0], edge[1]), vertices);
      });
  report_first(
      mesh.edge_radii,
      [](const EdgeRadius& e) { return !(e.radius >= 0 && std::isfinite(e.radius)); }, problems,
      [&](std::size_t i) {
        return fmt::format("{}: the edge radius {} is {:g}; it must be at least 0 and finite",
                           where, i, mesh.edge_radii[i].radius);
      });
  report_first(
      mesh.normals, [](Vec3f n) { return !is_finite(n); }, problems,
      [&](std::size_t i) {
        return fmt::format("{}: the normal of vertex {} is not a number", where, i);
      });
  report_first(
      mesh.uvs, [](Vec2f uv) { return !std::isfinite(uv.x) || !std::isfinite(uv.y); }, problems,
      [&](std::size_t i) {
        return fmt::format("{}: the texture coordinates of vertex {} are not numbers", where, i);
      });
  report_first(
      mesh.triangle_materials, [&](MaterialId id) { return id.index >= scene.materials.size(); },
      problems,
      [&](std::size_t i) {
        return fmt::format("{}: triangle {} has material {}, but there are {}", where, i,
                           mesh.triangle_materials[i].index, scene.materials.size());
      });
}

// ------------------------------------------------------------------------------- materials and textures

void check_range(const std::string& where, std::string_view name, double value, double low,
                 double high, Problems& problems) {
  if (!(value >= low && value <= high)) {
    problems.push_back(
        std::isinf(high)
            ? fmt::format("{}: {} is {:g}; it must be at least {:g}", where, name, value, low)
            : fmt::format("{}: {} is {:g}; it must be from {:g} to {:g}", where, name, value, low,
                          high));
  }
}

void check_color(const std::string& where, std::string_view name, Rgb color, double high,
                 Problems& problems) {
  for (int channel = 0; channel < 3; ++channel) {
    if (!(color[channel] >= 0) || !(color[channel] <= high) || std::isinf(color[channel])) {
      problems.push_back(fmt::format(
          "{}: {} is {}; each channel must be {}", where, name, list(Vec3d(color)),
          std::isinf(high) ? "at least 0 and finite" : fmt::format("from 0 to {:g}", high)));
      return;
    }
  }
}

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

void check_material(const Scene& scene, std::size_t index, Problems& problems) {
  const Material& m = scene.materials[index];
  const std::string where =
      m.name.empty() ? fmt::format("material {}", index) : fmt::format("material \"{}\"", m.name);
  check_color(where, "base_color", m.base_color, 1, problems);
  check_color(where, "specular_color", m.specular_color, kUnbounded, problems);
  check_color(where, "emission", m.emission, kUnbounded, problems);
  check_range(where, "metallic", m.metallic, 0, 1, problems);
  check_range(where, "roughness", m.roughness, 0, 1, problems);
  check_range(where, "ior", m.ior, 1, 100, problems);
  check_range(where, "specular", m.specular, 0, 1, problems);
  check_range(where, "transmission", m.transmission, 0, 1, problems);
  check_range(where, "clearcoat", m.clearcoat, 0, 1, problems);
  check_range(where, "clearcoat_roughness", m.clearcoat_roughness, 0, 1, problems);
  check_range(where, "opacity", m.opacity, 0, 1, problems);
  check_range(where, "normal_scale", m.normal_scale, -100, 100, problems);
  if (m.alpha_cutoff) {
    check_range(where, "alpha_cutoff", *m.alpha_cutoff, 0, kUnbounded, problems);
  }
  if (m.glossy_mix) {
    check_range(where, "glossy_mix", *m.glossy_mix, 0, 1, problems);
  }
  for (const auto& texture :
       {m.base_color_texture, m.metallic_roughness_texture, m.emission_texture, m.normal_texture,
        m.transmission_texture, m.clearcoat_texture, m.clearcoat_roughness_texture}) {
    if (texture && texture->index >= scene.textures.size()) {
      problems.push_back(fmt::format("{}: uses texture {}, but there are {}", where, texture->index,
                                     scene.textures.size()));
    }
  }
}

void check_texture(const Texture& texture, std::size_t index, Problems& problems) {
  const std::string where = texture.name.empty() ? fmt::format("texture {}", index)
                                                 : fmt::format("texture \"{}\"", texture.name);
  if (texture.width_px < 1 || texture.height_px < 1 || texture.width_px > kMaxPictureSide ||
      texture.height_px > kMaxPictureSide) {
    problems.push_back(fmt::format("{}: size {}x{}; sides must be from 1 to {} pixels", where,
                                   texture.width_px, texture.height_px, kMaxPictureSide));
  } else if (texture.texels.size() !=
             std::size_t(texture.width_px) * std::size_t(texture.height_px)) {
    problems.push_back(fmt::format("{}: {} texels for {}x{} pixels", where, texture.texels.size(),
                                   texture.width_px, texture.height_px));
  }
}

// ---------------------------------------------------------------------------------------------- objects

void check_rule(const std::string& where, const EdgeRule& rule, Problems& problems) {
  if (!(rule.radius >= 0 && std::isfinite(rule.radius))) {
    problems.push_back(
        fmt::format("{}: radius is {:g}; it must be at least 0 and finite", where, rule.radius));
  }
  if (rule.turn) {
    const auto [least, most] = *rule.turn;
    if (!(least >= 0 && least <= most && most <= kPi)) {
      problems.push_back(
          fmt::format("{}: turns from {:g} to {:g} degrees; needed: 0 <= least <= most <= 180",
                      where, degrees(least), degrees(most)));
    }
  }
  if (rule.box) {
    const auto& [low, high] = *rule.box;
    if (!usable_coordinate(low) || !usable_coordinate(high) ||
        !(low.x <= high.x && low.y <= high.y && low.z <= high.z)) {
      problems.push_back(fmt::format(
          "{}: box from {} to {}; corners must be numbers up to {:g}, the low one first", where,
          list(low), list(high), kMaxCoordinate));
    }
  }
  report_first(
      rule.segments,
      [](const std::array<Vec3d, 2>& s) {
        return !usable_coordinate(s[0]) || !usable_coordinate(s[1]) || s[0] == s[1];
      },
      problems,
      [&](std::size_t i) {
        const auto& [from, to] = rule.segments[i];
        return fmt::format(
            "{}: segment {} goes from {} to {}; give two different points of numbers up to {:g}",
            where, i, list(from), list(to), kMaxCoordinate);
      });
}

void check_rounding(const std::string& where, const RoundingSettings& rounding,
                    Problems& problems) {
  if (rounding.method == RoundMethod::none) {
    return;
  }
  if (const double* radius = std::get_if<double>(&rounding.radius)) {
    if (!(*radius > 0 && std::isfinite(*radius))) {
      problems.push_back(
          fmt::format("{}: rounding radius is {:g}; it must be more than 0", where, *radius));
    }
  } else if (const auto* part = std::get_if<PercentOfInradius>(&rounding.radius)) {
    if (!(part->percent > 0 && part->percent < 100)) {
      problems.push_back(fmt::format(
          "{}: rounding radius is {:g}% of the inradius; it must be more than 0 and less than 100",
          where, part->percent));
    }
  }
  if (!(rounding.min_angle >= 0 && rounding.min_angle <= kPi)) {
    problems.push_back(fmt::format("{}: min_angle is {:g} degrees; use 0 to 180", where,
                                   degrees(rounding.min_angle)));
  }
  check_range(where, "rounding subdivisions", rounding.subdivisions, 1, 64, problems);
  check_range(where, "bevel shader divisions", rounding.shader.divisions, 1, 64, problems);
  if (rounding.shader.delta) {
    check_range(where, "bevel shader delta", *rounding.shader.delta, 0, kUnbounded, problems);
  }
  if (rounding.shader.perturb) {
    check_range(where, "bevel shader perturb", *rounding.shader.perturb, 0, kUnbounded, problems);
  }
  for (std::size_t i = 0; i < rounding.rules.size(); ++i) {
    check_rule(fmt::format("{}: rounding rule {}", where, i), rounding.rules[i], problems);
  }
}

std::string name_of(const Object& object, std::size_t index) {
  return object.name.empty() ? fmt::format("object {}", index)
                             : fmt::format("object \"{}\"", object.name);
}

bool all_usable(const std::vector<Vec3f>& positions) {
  return std::ranges::all_of(positions, [](Vec3f p) { return usable_coordinate(Vec3d(p)); });
}

void check_reach(const Scene& scene, const Object& object, const std::string& where,
                 Problems& problems) {
  const Bounds bounds = world_bounds(scene, object);
  if (bounds.is_empty() || (usable_coordinate(bounds.lower) && usable_coordinate(bounds.upper))) {
    return;
  }
  if (!object.csg && !all_usable(scene.meshes[object.mesh.index].positions)) return;  // said of it
  problems.push_back(fmt::format(
      "{}: reaches from {} to {}; coordinates must be numbers up to {:g}, scale it down", where,
      list(bounds.lower), list(bounds.upper), kMaxCoordinate));
}

// Of a scene without other problems.
void check_size(const Scene& scene, Problems& problems) {
  std::uint64_t triangles = 0, drawn = 0;
  Bounds all;
  const Object* largest = nullptr;
  double size = -1;
  bool any_csg = false;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    if (object.csg) {
      any_csg = true;
      check_reach(scene, object, name_of(object, i), problems);
    } else {
      triangles += scene.meshes[object.mesh.index].triangles.size();
      drawn += count_drawn_triangles(scene, object);
    }
    const Bounds bounds = world_bounds(scene, object);
    all.add(bounds);
    if (bounds.diagonal() > size) {
      largest = &object;
      size = bounds.diagonal();
    }
  }
  if (triangles == 0 && !any_csg) return;
  if (all.diagonal() > 0 && all.diagonal() < kMinSize) {
    problems.push_back(fmt::format(
        "object \"{}\": is {:g} large; at least {:g} is needed, as areas of smaller triangles "
        "vanish in floats; scale it up",
        largest->name, all.diagonal(), kMinSize));
  } else if (drawn == 0 && triangles > 0 && !any_csg) {
    problems.push_back(fmt::format(
        "object \"{}\": nothing is left to draw: of {} triangles none has an area at coordinates "
        "near {}; move the model nearer to the origin, or check it",
        largest->name, triangles, list(all.center())));
  }
}

// False if there is something wrong with it.
bool check_transform(const Object& object, const std::string& where, Problems& problems) {
  const Affine3d& m = object.world_from_object;
  if (!is_finite(m.linear.x) || !is_finite(m.linear.y) || !is_finite(m.linear.z) ||
      !usable_coordinate(m.translation)) {
    problems.push_back(
        fmt::format("{}: its transform holds what is not a number or is larger than {:g}", where,
                    kMaxCoordinate));
    return false;
  }
  if (is_invertible(m.linear)) return true;
  problems.push_back(
      fmt::format("{}: its transform flattens it (determinant {:g}); use a scale other than 0",
                  where, determinant(m.linear)));
  return false;
}

void check_object(const Scene& scene, std::size_t index, Problems& problems) {
  const Object& object = scene.objects[index];
  const std::string where = name_of(object, index);
  if (object.csg && object.csg->index >= scene.csg_trees.size()) {
    problems.push_back(fmt::format("{}: uses CSG tree {}, but there are {}", where,
                                   object.csg->index, scene.csg_trees.size()));
  }
  if (!object.csg && object.mesh.index >= scene.meshes.size()) {
    problems.push_back(fmt::format("{}: uses mesh {}, but there are {}", where, object.mesh.index,
                                   scene.meshes.size()));
  }
  if (object.material.index >= scene.materials.size()) {
    problems.push_back(fmt::format("{}: uses material {}, but there are {}", where,
                                   object.material.index, scene.materials.size()));
  }
  if (check_transform(object, where, problems) && !object.csg &&
      object.mesh.index < scene.meshes.size()) {
    check_reach(scene, object, where, problems);
  }
  if (object.auto_radius && !(*object.auto_radius > 0 && std::isfinite(*object.auto_radius))) {
    problems.push_back(fmt::format("{}: its automatic radius is {:g}; it must be more than 0",
                                   where, *object.auto_radius));
  }
  if (object.rounding) {
    check_rounding(where, *object.rounding, problems);
  }
}

// ---------------------------------------------------------------------- lights, environment, camera, image

bool is_direction(Vec3d v) {
  return is_finite(v) && length_squared(v) > 0;
}

struct LightProblems {
  std::string where;
  Problems& problems;

  void check_position(Vec3d p) const {
    if (!usable_coordinate(p)) {
      problems.push_back(fmt::format("{}: position is {}; coordinates must be numbers up to {:g}",
                                     where, list(p), kMaxCoordinate));
    }
  }
  void check_direction(Vec3d d) const {
    if (!is_direction(d)) {
      problems.push_back(
          fmt::format("{}: direction is {}; give a vector other than 0", where, list(d)));
    }
  }
  void operator()(const PointLight& light) const {
    check_position(light.position);
    check_color(where, "intensity", light.intensity, kUnbounded, problems);
  }
  void operator()(const SpotLight& light) const {
    check_position(light.position);
    check_direction(light.direction);
    check_color(where, "intensity", light.intensity, kUnbounded, problems);
    if (!(light.inner_angle >= 0 && light.inner_angle <= light.outer_angle &&
          light.outer_angle <= kPi)) {
      problems.push_back(
          fmt::format("{}: angles are {:g} (inner) and {:g} (outer) degrees; needed: 0 <= inner <= "
                      "outer <= 180",
                      where, degrees(light.inner_angle), degrees(light.outer_angle)));
    }
  }
  void operator()(const DirectionalLight& light) const {
    check_direction(light.direction);
    check_color(where, "irradiance", light.irradiance, kUnbounded, problems);
  }
  void operator()(const AreaLight& light) const {
    check_position(light.corner);
    check_color(where, "radiance", light.radiance, kUnbounded, problems);
    if (light.edge_u == Vec3d{} && light.edge_v == Vec3d{}) {
      problems.push_back(where + ": has no size, or lies in its own target");
    } else if (!is_direction(cross(light.edge_u, light.edge_v))) {
      problems.push_back(fmt::format("{}: edges {} and {} span no area", where, list(light.edge_u),
                                     list(light.edge_v)));
    }
  }
};

struct EnvironmentProblems {
  Problems& problems;

  void check_up(Vec3d up) const {
    if (!is_direction(up)) {
      problems.push_back(
          fmt::format("environment: up is {}; give a vector other than 0", list(up)));
    }
  }
  void operator()(const ConstantEnvironment& e) const {
    check_color("environment", "radiance", e.radiance, kUnbounded, problems);
  }
  void operator()(const SkyEnvironment& e) const {
    check_up(e.up);
    check_range("environment", "turbidity", e.turbidity, 1.7, 20, problems);
    check_range("environment", "strength", e.strength, 0, 1e12, problems);
    if (!is_direction(e.sun_direction)) {
      problems.push_back(fmt::format("environment: sun_direction is {}; give a vector other than 0",
                                     list(e.sun_direction)));
    }
  }
  void operator()(const HdrEnvironment& e) const {
    check_up(e.up);
    check_range("environment", "strength", e.strength, 0, 1e12, problems);
    if (e.width_px < 1 || e.height_px < 1 ||
        e.radiance.size() != std::size_t(e.width_px) * std::size_t(e.height_px)) {
      problems.push_back(fmt::format("environment \"{}\": {} values for {}x{} pixels", e.name,
                                     e.radiance.size(), e.width_px, e.height_px));
    }
    report_first(
        e.radiance, [](Rgb c) { return !is_finite(c) || c.x < 0 || c.y < 0 || c.z < 0; }, problems,
        [&](std::size_t i) {
          return fmt::format(
              "environment \"{}\": pixel {} holds {}; radiance must be at least 0 and finite",
              e.name, i, list(Vec3d(e.radiance[i])));
        });
  }
  void operator()(const StudioEnvironment& e) const {
    check_up(e.up);
    check_range("environment", "strength", e.strength, 0, 1e12, problems);
  }
};

void check_camera(const Camera& camera, Problems& problems) {
  const Vec3d forward = camera.target - camera.position;
  if (!usable_coordinate(camera.position) || !usable_coordinate(camera.target)) {
    problems.push_back(fmt::format("camera: position {} or target {} is not a number up to {:g}",
                                   list(camera.position), list(camera.target), kMaxCoordinate));
  } else if (!(length(forward) > 0)) {
    problems.push_back(
        fmt::format("camera: position and target are both {}; move one", list(camera.position)));
  } else if (!is_direction(camera.up) ||
             !(length(cross(normalize(forward), normalize(camera.up))) > 1e-9)) {
    problems.push_back(
        fmt::format("camera: up is {}, along the view; choose an up that is not", list(camera.up)));
  }
  if (!(camera.fov_deg >= kMinFovDeg && camera.fov_deg <= kMaxFovDeg)) {
    problems.push_back(fmt::format("camera: fov is {:g} degrees; it must be from {:g} to {:g}",
                                   camera.fov_deg, kMinFovDeg, kMaxFovDeg));
  }
}

void check_lights(const Scene& scene, std::size_t first, Problems& problems) {
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    std::visit(LightProblems{fmt::format("light {}", first + i), problems}, scene.lights[i]);
  }
}

void check_image(const ImageSettings& image, Problems& problems) {
  if (image.width_px < 1 || image.height_px < 1 || image.width_px > kMaxPictureSide ||
      image.height_px > kMaxPictureSide) {
    problems.push_back(fmt::format("image: size {}x{}; sides must be from 1 to {} pixels",
                                   image.width_px, image.height_px, kMaxPictureSide));
  }
  check_range("image", "samples per pixel", image.samples_per_pixel, 1, kMostSamples, problems);
  check_range("image", "max_depth", image.max_depth, 0, 1024, problems);
  check_range("image", "exposure", image.exposure, -kMostStops, kMostStops, problems);
}

}  // namespace

std::vector<std::string> validate_placement(const Scene& scene, NumberedFrom numbered) {
  const std::size_t first = numbered == NumberedFrom::one ? 1 : 0;
  Problems problems;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    check_transform(scene.objects[i], name_of(scene.objects[i], first + i), problems);
  }
  check_lights(scene, first, problems);
  if (scene.camera) check_camera(*scene.camera, problems);
  return problems;
}

std::vector<std::string> validate_scene(const Scene& scene) {
  Problems problems;
  check_image(scene.image, problems);
  if (!is_direction(scene.up)) {
    problems.push_back(fmt::format("scene: up is {}; give a vector other than 0", list(scene.up)));
  }
  for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
    check_mesh(scene, i, problems);
  }
  for (std::size_t i = 0; i < scene.csg_trees.size(); ++i) {
    check_csg_tree(scene, i, problems);
  }
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    check_material(scene, i, problems);
  }
  for (std::size_t i = 0; i < scene.textures.size(); ++i) {
    check_texture(scene.textures[i], i, problems);
  }
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    check_object(scene, i, problems);
  }
  check_lights(scene, 0, problems);
  if (scene.environment) {
    std::visit(EnvironmentProblems{problems}, *scene.environment);
  }
  if (scene.camera) {
    check_camera(*scene.camera, problems);
  }
  check_animation(scene, problems);
  if (scene.rounding) {
    check_rounding("scene", *scene.rounding, problems);
  }
  if (problems.empty()) {
    check_size(scene, problems);
  }
  return problems;
}

}  // namespace arris
