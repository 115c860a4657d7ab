#include <fmt/format.h>

#include <array>
#include <cmath>

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
constexpr std::array<TomlWord<OnOverlap>, 2> kOnOverlap = {
    {{"report", OnOverlap::report}, {"clamp", OnOverlap::clamp}}};

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

// A length, or a percentage of the object's radius.
void parse_rule_radius(TomlTableReader& reader, EdgeRule& rule) {
  const TomlMember* member = reader.find("radius");
  if (member == nullptr) return reader.report_missing("radius");
  const auto* text = std::get_if<std::string>(&member->value.data);
  if (text == nullptr) {
    rule.radius = reader.number("radius", kTomlNotNegative).value_or(0);
    return;
  }
  const std::optional<double> percent = parse_percent(*text);
  if (!percent || !(*percent >= 0 && std::isfinite(*percent))) {
    return reader.report("radius",
                         "must be a number of 0 or more, or a percentage of the object's radius "
                         "like \"50%\"");
  }
  rule.radius = *percent / 100;
  rule.is_part = true;
}

std::optional<std::array<Vec3d, 2>> parse_points(TomlTableReader& reader, const TomlValue& value,
                                                 const char* name, TomlProblems& problems) {
  const auto* array = std::get_if<TomlArray>(&value.data);
  if (array == nullptr || array->size() != 2) {
    problems.add(value.place, fmt::format("{} {}: must be two points like [[0, 0, 0], [0, 0, 1]]",
                                          reader.title(), name));
    return std::nullopt;
  }
  std::array<Vec3d, 2> points;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto numbers = reader.numbers_of((*array)[i], name, 3, kTomlCoordinate);
    if (!numbers) return std::nullopt;
    points[i] = {(*numbers)[0], (*numbers)[1], (*numbers)[2]};
  }
  return points;
}

void parse_segments(TomlTableReader& reader, EdgeRule& rule, TomlProblems& problems) {
  const TomlMember* member = reader.find("edges");
  if (member == nullptr) return;
  const auto* array = std::get_if<TomlArray>(&member->value.data);
  if (array == nullptr || array->empty()) {
    return reader.report("edges",
                         "must be an array of segments like [[[0, 0, 0], [0, 0, 1]]]; leave it out "
                         "where the rule holds for edges anywhere");
  }
  for (const TomlValue& value : *array) {
    const auto segment = parse_points(reader, value, "edges", problems);
    if (!segment) continue;
    if ((*segment)[0] == (*segment)[1]) {
      problems.add(value.place, reader.title() +
                                    " edges: the segment's ends are one point; give "
                                    "two points of the edge");
    }
    rule.segments.push_back(*segment);
  }
}

EdgeRule parse_rule(const TomlTable& table, TomlPlace place, const std::string& title,
                    TomlProblems& problems) {
  TomlTableReader reader(table, place, title, problems);
  EdgeRule rule;
  parse_rule_radius(reader, rule);
  if (const auto angle = reader.vec2("angle", {0, 180})) {
    if (angle->x > angle->y) {
      reader.report("angle", fmt::format("is [{}, {}]; the least comes first", angle->x, angle->y));
    }
    rule.turn = {radians(angle->x), radians(angle->y)};
  }
  rule.kind = reader.word<RoundEdges>("kind", kEdges).value_or(rule.kind);
  if (const TomlMember* box = reader.find("box")) {
    if (const auto corners = parse_points(reader, box->value, "box", problems)) {
      const auto& [a, b] = *corners;
      rule.box = {min(a, b), max(a, b)};
    }
  }
  parse_segments(reader, rule, problems);
  reader.report_unknown();
  return rule;
}

std::vector<EdgeRule> parse_rules(const TomlMember& member, const std::string& owner,
                                  TomlProblems& problems) {
  std::vector<EdgeRule> rules;
  std::size_t number = 0;
  for (const TomlValue& value : toml_elements_of(member, problems)) {
    const std::string title = fmt::format("{} rule {}", owner, ++number);
    if (const auto* table = std::get_if<TomlTable>(&value.data)) {
      rules.push_back(parse_rule(*table, value.place, title, problems));
    } else {
      problems.add(value.place, title + ": must be a table with a radius");
    }
  }
  return rules;
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
  settings.on_overlap =
      reader.word<OnOverlap>("on_overlap", kOnOverlap).value_or(settings.on_overlap);
  if (const TomlMember* rules = reader.find("rules")) {
    settings.rules = parse_rules(*rules, reader.title(), problems);
  }
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
