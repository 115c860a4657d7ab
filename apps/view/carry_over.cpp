#include "view/carry_over.h"

#include <algorithm>
#include <deque>
#include <map>
#include <utility>

namespace arris::view {

ObjectMatch match_objects(const ViewModel& before, const ViewModel& now) {
  std::map<std::string, std::deque<std::size_t>> by_name;
  for (std::size_t i = 0; i < before.scene.objects.size(); ++i) {
    by_name[before.scene.objects[i].name].push_back(i);
  }
  ObjectMatch match;
  for (const Object& object : now.scene.objects) {
    std::deque<std::size_t>& same = by_name[object.name];
    match.push_back(same.empty() ? std::nullopt : std::optional(same.front()));
    if (!same.empty()) same.pop_front();
  }
  return match;
}

ViewEdits carry_over(const ViewEdits& first_before, const ViewEdits& edits, ViewEdits first_now,
                     const ObjectMatch& match) {
  ViewEdits out = std::move(first_now);
  const auto carry = [](const auto& before, const auto& edited, auto& now) {
    if (!(edited == before)) now = edited;
  };
  if (!is_same(edits.camera, first_before.camera)) out.camera = edits.camera;
  out.framed = edits.framed;
  carry(first_before.rounding, edits.rounding, out.rounding);
  carry(first_before.lighting, edits.lighting, out.lighting);
  carry(first_before.strength, edits.strength, out.strength);
  carry(first_before.rotation_deg, edits.rotation_deg, out.rotation_deg);
  carry(first_before.material, edits.material, out.material);
  carry(first_before.ground, edits.ground, out.ground);
  carry(first_before.shader, edits.shader, out.shader);
  for (std::size_t i = 0; i < out.objects.size(); ++i) {
    if (!match[i]) continue;
    const ObjectEdit& before = first_before.objects[*match[i]];
    const ObjectEdit& edited = edits.objects[*match[i]];
    ObjectEdit& now = out.objects[i];
    carry(before.visible, edited.visible, now.visible);
    carry(before.world_from_object, edited.world_from_object, now.world_from_object);
    if (edited.rounding == before.rounding) continue;
    now.rounding = edited.rounding;
    now.has_edited_radius = edited.has_edited_radius;
  }
  out.size = edits.size;
  out.compared = edits.compared;
  out.split = edits.split;
  out.overlay = edits.overlay;
  return out;
}

std::vector<std::string> lost_objects(const ViewModel& before, const ViewEdits& edits,
                                      const ObjectMatch& match) {
  std::vector<std::string> lost;
  for (std::size_t i = 0; i < edits.objects.size(); ++i) {
    const Object& object = before.scene.objects[i];
    const ObjectEdit& edit = edits.objects[i];
    const bool is_edited = !edit.visible || edit.rounding != object.rounding ||
                           edit.world_from_object != object.world_from_object;
    const bool is_there = std::ranges::find(match, std::optional(i)) != match.end();
    if (is_edited && !is_there) lost.push_back(object.name);
  }
  return lost;
}

}  // namespace arris::view
