// toml_part.cpp — [[object.part]]: what is otherwise with some objects of a file
#include <fmt/format.h>

#include <map>
#include <vector>

#include "base/nearest_name.h"
#include "base/utf8_text.h"
#include "io/toml_scene_parts.h"

namespace arris {
namespace {

using Names = std::map<std::string, std::vector<std::size_t>, std::less<>>;

std::vector<std::size_t> find_parts(TomlTableReader& reader, const Names& names,
                                    std::size_t count) {
  if (reader.has("name") == reader.has("number")) {
    reader.report("name", "give either \"name\" or \"number\"");
    return {};
  }
  if (reader.has("number")) {
    const auto number = reader.integer("number", 1, int(count));
    return number ? std::vector{std::size_t(*number - 1)} : std::vector<std::size_t>{};
  }
  const auto name = reader.string("name");
  if (!name) return {};
  if (const auto found = names.find(*name); found != names.end()) return found->second;
  std::vector<std::string> known;
  for (const auto& [other, parts] : names) known.push_back(other);
  reader.report("name", fmt::format("the file has no part {}{}", in_quotes(*name),
                                    did_you_mean(*name, known)));
  return {};
}

}  // namespace

// A later table goes before an earlier one, key by key.
std::vector<TomlObjects::PartEdit> TomlObjects::parse_parts(TomlTableReader& owner,
                                                            const Model& model) {
  const TomlMember* member = owner.find("part");
  if (member == nullptr) return {};
  std::vector<PartEdit> edits(model.objects.size());
  Names names;
  for (std::size_t i = 0; i < edits.size(); ++i) names[model.objects[i].name].push_back(i);
  std::size_t number = 0;
  for (const TomlValue& value : toml_elements_of(*member, context_.problems)) {
    const std::string title = fmt::format("{} part {}", owner.title(), ++number);
    const auto* table = std::get_if<TomlTable>(&value.data);
    if (table == nullptr) {
      context_.problems.add(value.place, title + ": must be a table, written [[object.part]]");
      continue;
    }
    TomlTableReader reader(*table, value.place, title, context_.problems);
    const auto hidden = reader.boolean("hidden");
    const auto material = parse_material(reader);
    const auto rounding = parse_round(reader);
    const auto auto_radius = reader.number("auto_radius", kTomlPositive);
    std::optional<Affine3d> file_from_part;
    if (has_toml_transform(reader)) {
      ObjectKey own;
      file_from_part = parse_toml_transform(reader, own);
    }
    for (const std::size_t i : find_parts(reader, names, edits.size())) {
      PartEdit& edit = edits[i];
      edit.hidden = hidden.value_or(edit.hidden);
      if (material) edit.material = material;
      if (rounding) edit.rounding = rounding;
      if (auto_radius) edit.auto_radius = auto_radius;
      if (file_from_part) edit.file_from_part = file_from_part;
    }
    reader.report_unknown();
  }
  return edits;
}

}  // namespace arris
