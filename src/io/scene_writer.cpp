#include "io/scene_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace arris {
namespace {

std::string text(std::string_view value) {
  std::string out = "\"";
  for (const char c : value) {
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') {
      out += fmt::format("\\u{:04X}", unsigned(static_cast<unsigned char>(c)));
    } else {
      out += c;
    }
  }
  return out + "\"";
}

// The shortest that is read back as the same number.
template <class T>
std::string number(T value) {
  return fmt::format("{}", value == 0 ? T(0) : value);
}

template <class T>
std::string vector(Vec3<T> v) {
  return fmt::format("[{}, {}, {}]", number(v.x), number(v.y), number(v.z));
}

// Angles that were read as degrees are written as the same degrees.
std::string degrees_text(double angle) {
  const double deg = degrees(angle), rounded = std::round(deg * 1e9) / 1e9;
  return number(radians(rounded) == angle ? rounded : deg);
}

const char* name_of(RoundMethod method) {
  switch (method) {
    case RoundMethod::none:
      return "none";
    case RoundMethod::exact:
      return "exact";
    case RoundMethod::shader:
      return "shader";
    case RoundMethod::mesh:
      return "mesh";
  }
  return "exact";
}
const char* name_of(RoundEdges edges) {
  switch (edges) {
    case RoundEdges::convex:
      return "convex";
    case RoundEdges::concave:
      return "concave";
    case RoundEdges::both:
      return "both";
  }
  return "convex";
}
const char* name_of(ImageSettings::Filter filter) {
  switch (filter) {
    case ImageSettings::Filter::box:
      return "box";
    case ImageSettings::Filter::tent:
      return "tent";
    case ImageSettings::Filter::gaussian:
      return "gaussian";
    case ImageSettings::Filter::blackman_harris:
      return "blackman_harris";
  }
  return "blackman_harris";
}

struct RadiusText {
  std::string operator()(AutoRadius) const { return "\"auto\""; }
  std::string operator()(double radius) const { return number(radius); }
  std::string operator()(PercentOfInradius radius) const {
    return fmt::format("\"{}%\"", number(radius.percent));
  }
};

// key = value, one of a table each.
using Members = std::vector<std::pair<const char*, std::string>>;

Members rounding_members(const RoundingSettings& rounding) {
  Members members{{"method", text(name_of(rounding.method))},
                  {"radius", std::visit(RadiusText{}, rounding.radius)},
                  {"edges", text(name_of(rounding.edges))},
                  {"min_angle", degrees_text(rounding.min_angle)}};
  if (rounding.method == RoundMethod::mesh) {
    members.emplace_back("subdivisions", number(rounding.subdivisions));
  }
  if (rounding.method == RoundMethod::shader) {
    const BevelShaderSettings& shader = rounding.shader;
    if (shader.delta) members.emplace_back("delta", number(*shader.delta));
    if (shader.perturb) members.emplace_back("perturb", number(*shader.perturb));
    members.emplace_back("divisions", number(shader.divisions));
  }
  return members;
}

std::string inline_table(const Members& members) {
  std::string out = "{ ";
  for (const auto& [key, value] : members) {
    out += fmt::format("{}{} = {}", out.size() > 2 ? ", " : "", key, value);
  }
  return out + " }";
}

std::string table(const std::string& header, const Members& members) {
  std::string out = "\n" + header + "\n";
  for (const auto& [key, value] : members) out += fmt::format("{} = {}\n", key, value);
  return out;
}

struct EnvironmentMembers {
  Members operator()(const ConstantEnvironment& e) const {
    return {{"type", text("constant")}, {"color", vector(e.radiance)}};
  }
  Members operator()(const SkyEnvironment& e) const {
    return {{"type", text("sky")},
            {"sun_direction", vector(e.sun_direction)},
            {"turbidity", number(e.turbidity)},
            {"strength", number(e.strength)},
            {"sun", e.sun ? "true" : "false"}};
  }
  Members operator()(const HdrEnvironment& e) const {
    return {{"type", text("hdr")},
            {"file", text(e.name)},
            {"strength", number(e.strength)},
            {"rotation", degrees_text(std::remainder(e.rotation, 2 * kPi))}};
  }
  Members operator()(const StudioEnvironment& e) const {
    return {{"type", text("studio")},
            {"strength", number(e.strength)},
            {"rotation", degrees_text(std::remainder(e.rotation, 2 * kPi))}};
  }
};

struct LightMembers {
  Members operator()(const PointLight& l) const {
    return {
        {"type", text("point")}, {"position", vector(l.position)}, {"color", vector(l.intensity)}};
  }
  Members operator()(const SpotLight& l) const {
    return {{"type", text("spot")},
            {"position", vector(l.position)},
            {"direction", vector(l.direction)},
            {"color", vector(l.intensity)},
            {"inner_angle", degrees_text(l.inner_angle)},
            {"outer_angle", degrees_text(l.outer_angle)}};
  }
  Members operator()(const DirectionalLight& l) const {
    return {{"type", text("directional")},
            {"direction", vector(l.direction)},
            {"color", vector(l.irradiance)}};
  }
  Members operator()(const AreaLight& l) const {
    return {{"type", text("area")},        {"corner", vector(l.corner)},
            {"edge_u", vector(l.edge_u)},  {"edge_v", vector(l.edge_v)},
            {"color", vector(l.radiance)}, {"visible", l.visible_to_camera ? "true" : "false"}};
  }
};

Members material_members(const Material& m) {
  const Material plain;
  Members members{{"base_color", vector(m.base_color)}};
  const auto add = [&](const char* key, float value, float usual) {
    if (value != usual) members.emplace_back(key, number(value));
  };
  const auto add_color = [&](const char* key, Rgb value, Rgb usual) {
    if (!(value == usual)) members.emplace_back(key, vector(value));
  };
  add("metallic", m.metallic, plain.metallic);
  add("roughness", m.roughness, plain.roughness);
  add("ior", m.ior, plain.ior);
  add("specular", m.specular, plain.specular);
  add_color("specular_color", m.specular_color, plain.specular_color);
  add("transmission", m.transmission, plain.transmission);
  add("clearcoat", m.clearcoat, plain.clearcoat);
  add("clearcoat_roughness", m.clearcoat_roughness, plain.clearcoat_roughness);
  add_color("emission", m.emission, plain.emission);
  add("opacity", m.opacity, plain.opacity);
  if (m.alpha_cutoff) members.emplace_back("alpha_cutoff", number(*m.alpha_cutoff));
  if (m.glossy_mix) members.emplace_back("glossy_mix", number(*m.glossy_mix));
  return members;
}

std::string material_name(const Material& material) {
  return material.name.empty() ? "material" : material.name;
}

Members object_members(const WrittenObject& object) {
  Members members{{"file", text(object.file)}};
  if (!object.name.empty()) members.emplace_back("name", text(object.name));
  if (object.material) members.emplace_back("material", text(material_name(*object.material)));
  if (object.rounding) {
    members.emplace_back("round", inline_table(rounding_members(*object.rounding)));
  }
  const Affine3d& m = object.world_from_file;
  if (!(m == Affine3d{})) {
    const auto& [x, y, z] = m.linear;
    const Vec3d& t = m.translation;
    const auto row = [](double a, double b, double c, double d) {
      return fmt::format("[{}, {}, {}, {}]", number(a), number(b), number(c), number(d));
    };
    members.emplace_back("matrix",
                         fmt::format("[{}, {}, {}, [0, 0, 0, 1]]", row(x.x, y.x, z.x, t.x),
                                     row(x.y, y.y, z.y, t.y), row(x.z, y.z, z.z, t.z)));
  }
  return members;
}

}  // namespace

std::string write_toml_scene(const Scene& scene, std::span<const WrittenObject> objects,
                             std::span<const std::string> comments) {
  std::string out;
  for (std::string comment : comments) {
    std::ranges::replace_if(
        comment, [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
    out += "# " + comment + "\n";
  }
  out += fmt::format("up = {}\n", vector(scene.up));
  const ImageSettings& image = scene.image;
  out += table("[image]", {{"size", fmt::format("[{}, {}]", image.width_px, image.height_px)},
                           {"samples", number(image.samples_per_pixel)},
                           {"max_depth", number(image.max_depth)},
                           {"exposure", number(image.exposure)},
                           {"filter", text(name_of(image.filter))}});
  if (scene.camera) {
    out += table("[camera]", {{"position", vector(scene.camera->position)},
                              {"target", vector(scene.camera->target)},
                              {"up", vector(scene.camera->up)},
                              {"fov", number(scene.camera->fov_deg)}});
  }
  if (scene.environment) {
    out += table("[environment]", std::visit(EnvironmentMembers{}, *scene.environment));
  }
  for (const Light& light : scene.lights) {
    out += table("[[light]]", std::visit(LightMembers{}, light));
  }
  if (scene.rounding) out += table("[round]", rounding_members(*scene.rounding));
  std::vector<std::string> written;
  for (const WrittenObject& object : objects) {
    if (!object.material) continue;
    const std::string name = material_name(*object.material);
    if (std::ranges::find(written, name) != written.end()) continue;
    written.push_back(name);
    out += table(fmt::format("[material.{}]", text(name)), material_members(*object.material));
  }
  for (const WrittenObject& object : objects) out += table("[[object]]", object_members(object));
  return out;
}

}  // namespace arris
