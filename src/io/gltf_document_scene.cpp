#include <fmt/format.h>

#include "base/utf8_text.h"
#include "io/gltf_document_parts.h"

namespace arris {
namespace {

// 16 numbers, column by column.
Affine3d parse_matrix(const JsonValue& value) {
  if (value.size() != 16) value.fail(fmt::format("must have 16 numbers, not {}", value.size()));
  std::array<double, 16> m{};
  for (std::size_t i = 0; i < 16; ++i) m[i] = value.at(i).as_number();
  if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1) {
    value.fail("the last row must be 0, 0, 0, 1: perspective has no place in a node");
  }
  return {{{m[0], m[1], m[2]}, {m[4], m[5], m[6]}, {m[8], m[9], m[10]}}, {m[12], m[13], m[14]}};
}

Mat3d parse_rotation(const JsonValue& value) {
  if (value.size() != 4) value.fail("must be a quaternion of 4 numbers");
  double x = value.at(0).as_number(), y = value.at(1).as_number();
  double z = value.at(2).as_number(), w = value.at(3).as_number();
  const double norm = std::hypot(std::hypot(x, y), std::hypot(z, w));
  if (!(norm > 0) || !std::isfinite(norm)) value.fail("the quaternion's length must not be 0");
  x /= norm, y /= norm, z /= norm, w /= norm;
  return {{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
          {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
          {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}};
}

Affine3d parse_transform(const JsonValue& node) {
  if (const auto matrix = node.find("matrix")) return parse_matrix(*matrix);
  Mat3d linear;
  if (const auto rotation = node.find("rotation")) linear = parse_rotation(*rotation);
  const Vec3d scale = node.vec3("scale", Vec3d(1.0));
  return {{linear.x * scale.x, linear.y * scale.y, linear.z * scale.z},
          node.vec3("translation", Vec3d(0.0))};
}

GltfCamera parse_camera(const JsonValue& value) {
  const std::string type = value.get("type").as_string();
  if (type == "orthographic") return {};
  if (type != "perspective") {
    value.get("type").fail(fmt::format("{}; use perspective or orthographic", in_quotes(type)));
  }
  const JsonValue yfov = value.get("perspective").get("yfov");
  const double fov = yfov.as_number();
  if (!(fov > 0 && fov < kPi)) yfov.fail(fmt::format("{} radians is outside 0 to pi", fov));
  return {fov};
}

GltfLight parse_light(const JsonValue& value) {
  GltfLight light;
  const std::string type = value.get("type").as_string();
  if (type == "spot") {
    light.kind = GltfLightKind::spot;
  } else if (type == "directional") {
    light.kind = GltfLightKind::directional;
  } else if (type != "point") {
    value.get("type").fail(fmt::format("{}; use point, spot or directional", in_quotes(type)));
  }
  const Vec3d color = value.vec3("color", Vec3d(1.0));
  if (!(color.x >= 0 && color.y >= 0 && color.z >= 0)) {
    value.get("color").fail("colours must not be negative");
  }
  light.intensity = color * value.number("intensity", 1, 0, 1e12);
  if (const auto spot = value.find("spot")) {
    light.outer_angle = spot->number("outerConeAngle", kPi / 4, 0, kPi / 2 + 1e-6);
    light.inner_angle = spot->number("innerConeAngle", 0, 0, light.outer_angle);
  }
  return light;
}

GltfNode parse_node(const JsonValue& value, const GltfDocument& document, std::size_t node_count) {
  GltfNode node;
  node.name = value.string("name", "");
  value.for_each("children", [&](const JsonValue& child) {
    node.children.push_back(child.as_index(node_count, "nodes"));
  });
  node.mesh = value.index("mesh", document.meshes.size(), "meshes");
  node.camera = value.index("camera", document.cameras.size(), "cameras");
  if (const auto punctual = value.extension("KHR_lights_punctual")) {
    node.light = punctual->get("light").as_index(document.lights.size(), "lights");
  }
  if (node.mesh && value.find("skin")) {
    value.fail("meshes bent by a skeleton can't be read; apply the pose before the export");
  }
  node.parent_from_node = parse_transform(value);
  node.rounding = parse_rounding_extra(value);
  return node;
}

// Sets parents[child]; an error if a node has two parents.
std::vector<bool> find_children(const JsonValue& nodes, const GltfDocument& document) {
  std::vector<bool> is_child(document.nodes.size());
  for (std::size_t i = 0; i < document.nodes.size(); ++i) {
    for (const std::uint32_t child : document.nodes[i].children) {
      if (is_child[child]) {
        nodes.at(i).fail(
            fmt::format("its child {} also is a child of another node; "
                        "nodes must form trees",
                        child));
      }
      is_child[child] = true;
    }
  }
  return is_child;
}

// With one parent each, the nodes that no parentless node leads to are in cycles.
void check_no_cycles(const JsonValue& nodes, const GltfDocument& document,
                     const std::vector<bool>& is_child) {
  std::vector<bool> reached(document.nodes.size());
  std::vector<std::uint32_t> stack;
  for (std::uint32_t i = 0; i < reached.size(); ++i) {
    if (!is_child[i]) stack.push_back(i);
  }
  while (!stack.empty()) {
    const std::uint32_t node = stack.back();
    stack.pop_back();
    reached[node] = true;
    const std::vector<std::uint32_t>& children = document.nodes[node].children;
    stack.insert(stack.end(), children.begin(), children.end());
  }
  for (std::size_t i = 0; i < reached.size(); ++i) {
    if (!reached[i]) nodes.at(i).fail("the node is its own ancestor; nodes must form trees");
  }
}

void parse_roots(const JsonValue& root, GltfDocument& document, const std::vector<bool>& is_child) {
  const std::size_t scene_count = count_of(root, "scenes");
  const std::uint32_t chosen = root.index("scene", scene_count, "scenes").value_or(0);
  if (scene_count == 0) {
    for (std::uint32_t i = 0; i < is_child.size(); ++i) {
      if (!is_child[i]) document.roots.push_back(i);
    }
    return;
  }
  const JsonValue scene = root.get("scenes").at(chosen);
  if (auto rounding = parse_rounding_extra(scene)) document.rounding = rounding;
  std::vector<bool> listed(document.nodes.size());
  scene.for_each("nodes", [&](const JsonValue& value) {
    const std::uint32_t node = value.as_index(document.nodes.size(), "nodes");
    if (is_child[node] || listed[node]) {
      value.fail(fmt::format("node {} is listed twice or is a child of another node", node));
    }
    listed[node] = true;
    document.roots.push_back(node);
  });
}

}  // namespace

void parse_gltf_scene(const JsonValue& root, GltfDocument& document) {
  root.for_each("cameras",
                [&](const JsonValue& value) { document.cameras.push_back(parse_camera(value)); });
  if (const auto punctual = root.extension("KHR_lights_punctual")) {
    punctual->for_each(
        "lights", [&](const JsonValue& value) { document.lights.push_back(parse_light(value)); });
  }
  document.rounding = parse_rounding_extra(root.get("asset"));
  const std::size_t node_count = count_of(root, "nodes");
  root.for_each("nodes", [&](const JsonValue& value) {
    document.nodes.push_back(parse_node(value, document, node_count));
  });
  std::vector<bool> is_child(node_count);
  if (const auto nodes = root.find("nodes")) {
    is_child = find_children(*nodes, document);
    check_no_cycles(*nodes, document, is_child);
  }
  parse_roots(root, document, is_child);
  if (root.find("animations")) document.notes.emplace_back("animations left out");
}

}  // namespace arris
