#include "io/scene_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "base/utf8_text.h"
#include "io/toml_writer.h"

namespace arris {
namespace {

// A float as the double of its shortest decimal digits, which is read back as the same float.
double shortest(float value) {
  const std::string digits = fmt::format("{}", value);
  double out = 0;
  std::from_chars(digits.data(), digits.data() + digits.size(), out);
  return out;
}
double shortest(double value) {
  return value;
}

TomlData text(std::string_view value) {
  return std::string(value);
}

template <class T>
TomlData vector(Vec3<T> v) {
  TomlArray array;
  for (const T x : {v.x, v.y, v.z}) array.push_back({{}, shortest(x)});
  return array;
}

TomlTable table(std::initializer_list<std::pair<const char*, TomlData>> members) {
  TomlTable out;
  for (const auto& [key, data] : members) set_toml(out, key, data);
  return out;
}

// What the reader turns into exactly the value, close to `near` and short if it can be. Values that no file has said
// may have none: then `near`.
template <class Read>
double find_exact(double value, double near, const Read& read) {
  const double rounded = std::round(near * 1e9) / 1e9;
  if (read(rounded) == value) return rounded;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const double away : {-kInfinity, kInfinity}) {
    double next = near;
    for (int i = 0; i < 4; ++i, next = std::nextafter(next, away)) {
      if (read(next) == value) return next;
    }
  }
  return near;
}

double exact_degrees(double angle) {
  return find_exact(angle, degrees(angle), radians);
}
double exact_percent(double part) {
  return find_exact(part, part * 100, [](double percent) { return percent / 100; });
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
const char* name_of(OnOverlap on_overlap) {
  switch (on_overlap) {
    case OnOverlap::report:
      return "report";
    case OnOverlap::clamp:
      return "clamp";
  }
  return "report";
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

struct RadiusData {
  TomlData operator()(AutoRadius) const { return text("auto"); }
  TomlData operator()(double radius) const { return radius; }
  TomlData operator()(PercentOfInradius radius) const { return fmt::format("{}%", radius.percent); }
};

TomlArray points(const std::array<Vec3d, 2>& ends) {
  return {{{}, vector(ends[0])}, {{}, vector(ends[1])}};
}

TomlTable make_rule_table(const EdgeRule& rule) {
  TomlTable out = table({{"radius", rule.radius}});
  if (rule.is_part) set_toml(out, "radius", fmt::format("{}%", exact_percent(rule.radius)));
  if (rule.turn) {
    const auto [least, most] = *rule.turn;
    set_toml(out, "angle", TomlArray{{{}, exact_degrees(least)}, {{}, exact_degrees(most)}});
  }
  if (rule.kind != RoundEdges::both) set_toml(out, "kind", text(name_of(rule.kind)));
  if (rule.box) set_toml(out, "box", points(*rule.box));
  TomlArray edges;
  for (const std::array<Vec3d, 2>& segment : rule.segments) edges.push_back({{}, points(segment)});
  if (!edges.empty()) set_toml(out, "edges", std::move(edges));
  return out;
}

// Scene files take one whole turn each way.
double rotation_degrees(double angle) {
  return exact_degrees(std::abs(angle) > 2 * kPi ? std::remainder(angle, 2 * kPi) : angle);
}

// Colours may be at most 1e9, strengths more: a power of two, so that nothing is rounded.
void set_emission(TomlTable& out, Rgb emission, const char* strength) {
  constexpr float kMostColor = 1e9F;
  constexpr double kMostStrength = 1e12;
  double scale = 1;
  while (std::max({emission.x, emission.y, emission.z}) > kMostColor && scale < kMostStrength / 2) {
    emission *= 0.5F;
    scale *= 2;
  }
  set_toml(out, "color", vector(emission));
  if (scale != 1) set_toml(out, strength, scale);
}

struct EnvironmentTable {
  TomlTable operator()(const ConstantEnvironment& e) const {
    TomlTable out = table({{"type", text("constant")}});
    set_emission(out, e.radiance, "strength");
    return out;
  }
  TomlTable operator()(const SkyEnvironment& e) const {
    return table({{"type", text("sky")},
                  {"sun_direction", vector(e.sun_direction)},
                  {"turbidity", e.turbidity},
                  {"strength", e.strength},
                  {"sun", e.sun}});
  }
  TomlTable operator()(const HdrEnvironment& e) const {
    return table({{"type", text("hdr")},
                  {"file", text(e.name)},
                  {"strength", e.strength},
                  {"rotation", rotation_degrees(e.rotation)}});
  }
  TomlTable operator()(const StudioEnvironment& e) const {
    return table({{"type", text("studio")},
                  {"strength", e.strength},
                  {"rotation", rotation_degrees(e.rotation)}});
  }
};

struct LightTable {
  TomlTable operator()(const PointLight& l) const {
    TomlTable out = table({{"type", text("point")}, {"position", vector(l.position)}});
    set_emission(out, l.intensity, "intensity");
    return out;
  }
  TomlTable operator()(const SpotLight& l) const {
    TomlTable out = table({{"type", text("spot")},
                           {"position", vector(l.position)},
                           {"direction", vector(l.direction)},
                           {"inner_angle", exact_degrees(l.inner_angle)},
                           {"outer_angle", exact_degrees(l.outer_angle)}});
    set_emission(out, l.intensity, "intensity");
    return out;
  }
  TomlTable operator()(const DirectionalLight& l) const {
    TomlTable out = table({{"type", text("directional")}, {"direction", vector(l.direction)}});
    set_emission(out, l.irradiance, "irradiance");
    return out;
  }
  TomlTable operator()(const AreaLight& l) const {
    TomlTable out = table({{"type", text("area")},
                           {"corner", vector(l.corner)},
                           {"edge_u", vector(l.edge_u)},
                           {"edge_v", vector(l.edge_v)},
                           {"visible", l.visible_to_camera}});
    set_emission(out, l.radiance, "radiance");
    return out;
  }
};

TomlTable make_image_table(const ImageSettings& image) {
  const TomlArray size{{{}, std::int64_t(image.width_px)}, {{}, std::int64_t(image.height_px)}};
  return table({{"size", size},
                {"samples", std::int64_t(image.samples_per_pixel)},
                {"max_depth", std::int64_t(image.max_depth)},
                {"exposure", image.exposure},
                {"filter", text(name_of(image.filter))}});
}

// Without what would end the line, or is not UTF-8.
std::string comment_line(std::string text) {
  const bool is_text = is_utf8(text);
  for (char& c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < ' ' || byte == 0x7f) c = ' ';
    if (byte > 0x7f && !is_text) c = '?';
  }
  return "# " + text + "\n";
}

}  // namespace

TomlTable make_rounding_table(const RoundingSettings& rounding) {
  TomlTable out = table({{"method", text(name_of(rounding.method))},
                         {"radius", std::visit(RadiusData{}, rounding.radius)},
                         {"edges", text(name_of(rounding.edges))},
                         {"min_angle", exact_degrees(rounding.min_angle)}});
  if (rounding.method == RoundMethod::mesh) {
    set_toml(out, "subdivisions", std::int64_t(rounding.subdivisions));
  }
  if (rounding.method == RoundMethod::shader) {
    const BevelShaderSettings& shader = rounding.shader;
    if (shader.delta) set_toml(out, "delta", *shader.delta);
    if (shader.perturb) set_toml(out, "perturb", *shader.perturb);
    set_toml(out, "divisions", std::int64_t(shader.divisions));
  }
  set_toml(out, "on_overlap", text(name_of(rounding.on_overlap)));
  // Also if there are none: those of [round] would count.
  TomlArray rules;
  for (const EdgeRule& rule : rounding.rules) rules.push_back({{}, make_rule_table(rule)});
  set_toml(out, "rules", std::move(rules));
  return out;
}

TomlTable make_material_table(const Material& m) {
  const Material plain;
  TomlTable out = table({{"base_color", vector(m.base_color)}});
  const auto add = [&](const char* key, float value, float usual) {
    if (value != usual) set_toml(out, key, shortest(value));
  };
  const auto add_color = [&](const char* key, Rgb value, Rgb usual) {
    if (!(value == usual)) set_toml(out, key, vector(value));
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
  if (m.alpha_cutoff) set_toml(out, "alpha_cutoff", shortest(*m.alpha_cutoff));
  if (m.glossy_mix) set_toml(out, "glossy_mix", shortest(*m.glossy_mix));
  return out;
}

TomlArray make_matrix_rows(const Affine3d& m) {
  const auto& [x, y, z] = m.linear;
  const Vec3d& t = m.translation;
  const auto row = [](double a, double b, double c, double d) {
    return TomlValue{{}, TomlArray{{{}, a}, {{}, b}, {{}, c}, {{}, d}}};
  };
  return {row(x.x, y.x, z.x, t.x), row(x.y, y.y, z.y, t.y), row(x.z, y.z, z.z, t.z),
          row(0, 0, 0, 1)};
}

TomlTable make_scene_table(const Scene& scene) {
  TomlTable out = table({{"up", vector(scene.up)}, {"image", make_image_table(scene.image)}});
  if (scene.camera) {
    set_toml(out, "camera",
             table({{"position", vector(scene.camera->position)},
                    {"target", vector(scene.camera->target)},
                    {"up", vector(scene.camera->up)},
                    {"fov", scene.camera->fov_deg}}));
  }
  if (scene.environment) {
    set_toml(out, "environment", std::visit(EnvironmentTable{}, *scene.environment));
  }
  TomlArray lights;
  for (const Light& light : scene.lights) lights.push_back({{}, std::visit(LightTable{}, light)});
  if (!lights.empty()) set_toml(out, "light", std::move(lights));
  if (scene.rounding) set_toml(out, "round", make_rounding_table(*scene.rounding));
  if (scene.ground) {
    set_toml(out, "ground",
             table({{"center", vector(scene.ground->center)}, {"radius", scene.ground->radius}}));
  }
  return out;
}

std::string write_scene_file(const TomlTable& scene, std::span<const std::string> comments) {
  std::string out;
  for (const std::string& comment : comments) out += comment_line(comment);
  return out + write_toml(scene);
}

}  // namespace arris
