#include <fmt/format.h>

#include <array>

#include "io/toml_scene_parts.h"
#include "scene/rounding_text.h"

namespace arris {
namespace {

constexpr std::array<TomlWord<RoundMethod>, 4> kMethods = {{{"none", RoundMethod::none},
                                                            {"exact", RoundMethod::exact},
                                                            {"shader", RoundMethod::shader},
                                                            {"mesh", RoundMethod::mesh}}};
constexpr std::array<TomlWord<RoundEdges>, 3> kEdges = {
    {{"convex", RoundEdges::convex}, {"concave", RoundEdges::concave}, {"both", RoundEdges::both}}};

// A number or a text; "none" and 0 give method none.
std::optional<RoundingSettings> parse_short_form(const TomlValue& value) {
  if (const auto* text = std::get_if<std::string>(&value.data)) return parse_rounding_text(*text);
  if (const auto* integer = std::get_if<std::int64_t>(&value.data)) {
    return make_rounding_settings(double(*integer));
  }
  if (const auto* number = std::get_if<double>(&value.data)) return make_rounding_settings(*number);
  return std::nullopt;
}

void parse_radius(TomlTableReader& reader, RoundingSettings& settings) {
  const TomlMember* member = reader.find("radius");
  if (member == nullptr) return;
  const std::optional<RoundingSettings> parsed = parse_short_form(member->value);
  if (!parsed || parsed->method == RoundMethod::none) {
    reader.report("radius",
                  "must be a number above 0, a percentage of the inradius like \"12%\", "
                  "or \"auto\"");
    return;
  }
  settings.radius = parsed->radius;
}

RoundingSettings parse_table(const TomlTable& table, const TomlMember& member,
                             RoundingSettings settings, TomlProblems& problems) {
  TomlTableReader reader(table, member.value.place, member.key, problems);
  settings.method = reader.word<RoundMethod>("method", kMethods).value_or(settings.method);
  settings.edges = reader.word<RoundEdges>("edges", kEdges).value_or(settings.edges);
  parse_radius(reader, settings);
  if (const auto angle = reader.number("min_angle", {0, 180})) {
    settings.min_angle = radians(*angle);
  }
  settings.subdivisions = reader.integer("subdivisions", 1, 64).value_or(settings.subdivisions);
  BevelShaderSettings& shader = settings.shader;
  if (const auto delta = reader.number("delta", kTomlNotNegative)) shader.delta = *delta;
  if (const auto perturb = reader.number("perturb", kTomlNotNegative)) shader.perturb = *perturb;
  shader.divisions = reader.integer("divisions", 1, 64).value_or(shader.divisions);
  reader.report_unknown();
  return settings;
}

}  // namespace

std::optional<RoundingSettings> parse_toml_rounding(const TomlMember& member,
                                                    const RoundingSettings& defaults,
                                                    TomlProblems& problems) {
  if (const auto* table = std::get_if<TomlTable>(&member.value.data)) {
    return parse_table(*table, member, defaults, problems);
  }
  const std::optional<RoundingSettings> parsed = parse_short_form(member.value);
  if (!parsed) {
    problems.add(member.value.place,
                 fmt::format("{}: not a rounding; {}, or a table like {{ radius = 0.5 }}",
                             member.key, kRoundingTextForms));
    return std::nullopt;
  }
  RoundingSettings settings = defaults;
  if (parsed->method == RoundMethod::none) settings.method = RoundMethod::none;
  settings.radius = parsed->radius;
  return settings;
}

}  // namespace arris
