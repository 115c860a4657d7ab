#include "view/view_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <variant>
#include <vector>

#include "render/prepared_scene.h"
#include "scene/material_presets.h"

namespace arris::view {
namespace {

using nlohmann::json;

std::string to_text(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

json to_json(Vec3d v) {
  return {v.x, v.y, v.z};
}

json to_json(const Camera& camera) {
  return {{"position", to_json(camera.position)},
          {"target", to_json(camera.target)},
          {"up", to_json(camera.up)},
          {"fov", camera.fov_deg}};
}

json to_json(const Affine3d& m) {
  const auto& [x, y, z] = m.linear;
  const Vec3d& t = m.translation;
  return {{x.x, y.x, z.x, t.x}, {x.y, y.y, z.y, t.y}, {x.z, y.z, z.z, t.z}, {0, 0, 0, 1}};
}

struct RadiusValue {
  json operator()(AutoRadius) const { return "auto"; }
  json operator()(double radius) const { return radius; }
  json operator()(PercentOfInradius radius) const { return fmt::format("{:g}%", radius.percent); }
};

json to_json(const RoundingSettings& rounding) {
  return {{"radius", std::visit(RadiusValue{}, rounding.radius)},
          {"edges", name_of(rounding.edges)},
          {"min_angle", degrees(rounding.min_angle)},
          {"method", name_of(rounding.method)}};
}

json to_json(const PictureSize& size) {
  return {size.width_px, size.height_px};
}

// By the prepared scene's objects; 0: not rounded.
std::vector<double> rounded_radii(const PreparedScene& prepared) {
  std::vector<double> radii(scene_of(prepared).objects.size());
  for (const RoundingSummary& summary : prepare_stats(prepared).rounding) {
    double& radius = radii[summary.object_index];
    if (radius == 0) radius = summary.radius;
  }
  return radii;
}

json object_json(const ViewModel& model, const ViewEdits& edits, std::size_t i,
                 const Bounds& bounds) {
  const Object& object = model.scene.objects[i];
  const ObjectEdit& edit = edits.objects[i];
  json out{{"id", i},
           {"name", object.name},
           {"triangles", object.csg ? 0 : model.scene.meshes[object.mesh.index].triangles.size()},
           {"csg", object.csg.has_value()},
           {"visible", edit.visible},
           {"radius", nullptr},
           {"matrix", to_json(edit.world_from_object)},
           {"file_matrix", to_json(object.world_from_object)}};
  if (edit.rounding) out["radius"] = std::visit(RadiusValue{}, edit.rounding->radius);
  const bool is_there = !bounds.is_empty();
  out["center"] = to_json(is_there ? bounds.center() : Vec3d());
  out["size"] = to_json(is_there ? bounds.upper - bounds.lower : Vec3d());
  return out;
}

// A still view goes over to paths of its own of each pixel, by which it also converges.
const char* integrator_of(const ViewState& state) {
  const EdgePointStats& stats = state.stats;
  const bool is_still = !state.moving && (stats.traced || stats.traced_still);
  if (state.converged || is_still) return "path";
  return stats.traced ? "traced" : "edge-point";
}

}  // namespace

std::string scene_message(const ShownView& view, const ViewEdits& edits, const ServerFacts& facts) {
  const ViewModel& model = *view.model;
  json objects = json::array(), lightings = json::array();
  for (const LightChoice choice : lightings_of(model)) lightings.push_back(name_of(choice));
  const std::vector<double> radii = rounded_radii(*view.engine->scene());
  Bounds all;
  for (std::size_t i = 0; i < edits.objects.size(); ++i) {
    const Bounds bounds = moved_bounds(view.bounds[i], model.scene.objects[i].world_from_object,
                                       edits.objects[i].world_from_object);
    all.add(bounds);
    objects.push_back(object_json(model, edits, i, bounds));
    const auto index = view.staged.index_of[i];
    objects.back()["rounded"] = index ? radii[*index] : 0;
  }
  json out{{"type", "scene"},
           {"name", model.name},
           {"model", facts.model},
           {"camera", to_json(edits.camera)},
           {"up", to_json(model.scene.up)},
           {"rounding", to_json(edits.rounding)},
           {"radius_limit", nullptr},
           {"lighting", name_of(edits.lighting)},
           {"lightings", std::move(lightings)},
           {"strength", edits.strength},
           {"rotation", edits.rotation_deg},
           {"rotates", can_rotate_light(model, edits)},
           {"material", nullptr},
           {"materials", material_preset_names()},
           {"ground", edits.ground},
           {"shader", name_of(edits.shader)},
           {"compare", nullptr},
           {"overlay", edits.overlay},
           {"upload", facts.upload},
           {"samples", model.scene.image.samples_per_pixel},
           {"objects", std::move(objects)},
           {"size", to_json(edits.size)}};
  if (const auto limit = radius_limit(model, edits, view.inradii)) out["radius_limit"] = *limit;
  if (edits.material) out["material"] = *edits.material;
  if (edits.compared) {
    out["compare"] = {{"method", name_of(*edits.compared)}, {"split", edits.split}};
  }
  const bool is_there = !all.is_empty();
  out["bounds"] = {{"lower", to_json(is_there ? all.lower : Vec3d())},
                   {"upper", to_json(is_there ? all.upper : Vec3d())}};
  return to_text(out);
}

std::string with_seq(const std::string& scene_message, std::uint32_t seq) {
  return fmt::format("{},\"seq\":{}}}", scene_message.substr(0, scene_message.size() - 1), seq);
}

std::string camera_message(const Camera& camera) {
  json out = to_json(camera);
  out["type"] = "camera";
  return to_text(out);
}

std::string state_message(const ViewState& state, const PreparedScene& prepared) {
  const EdgePointStats& stats = state.stats;
  const double pixels =
      std::max(1.0, double(stats.classes.empty + stats.classes.simple + stats.classes.complex));
  const PrepareStats& scene = prepare_stats(prepared);
  return to_text({{"type", "state"},
                  {"fps", state.fps},
                  {"frame_ms", state.frame_ms},
                  {"samples", stats.still_paths},
                  {"seconds", state.seconds},
                  {"new_samples", state.new_samples},
                  {"integrator", integrator_of(state)},
                  {"triangles", scene.triangles},
                  {"rounded_edges", scene.rounded_edges},
                  {"edges",
                   {{"silhouette", stats.edges.silhouette},
                    {"sharp", stats.edges.sharp},
                    {"shadow", stats.edges.shadow}}},
                  {"classes",
                   {{"empty", double(stats.classes.empty) / pixels},
                    {"simple", double(stats.classes.simple) / pixels},
                    {"complex", double(stats.classes.complex) / pixels}}},
                  {"converged", state.converged}});
}

std::string picked_message(std::optional<std::uint32_t> seq, const std::optional<Shot>& shot,
                           std::optional<std::uint32_t> object) {
  json out{{"type", "picked"},
           {"id", nullptr},
           {"position", nullptr},
           {"normal", nullptr},
           {"feature", nullptr}};
  if (seq) out["seq"] = *seq;
  if (object) out["id"] = *object;
  if (shot) {
    out["position"] = to_json(shot->position);
    out["normal"] = to_json(shot->normal);
    out["feature"] = name_of(shot->feature);
  }
  return to_text(out);
}

std::string beam_message(const BeamWorker::Status& status) {
  json out{{"type", "beam"}, {"done", status.done}, {"ready", status.ready}};
  if (status.stopped) out["stopped"] = true;
  if (!status.error.empty()) out["error"] = status.error;
  return to_text(out);
}

std::string busy_message(const std::string& what) {
  json out{{"type", "busy"}, {"what", nullptr}};
  if (!what.empty()) out["what"] = what;
  return to_text(out);
}

std::string error_message(std::optional<std::uint32_t> seq, const std::string& what,
                          const std::string& about) {
  const std::size_t end = what.find("; ");
  json out{{"type", "error"}, {"text", what.substr(0, end)}};
  if (end != std::string::npos) out["remedy"] = what.substr(end + 2);
  if (seq) out["seq"] = *seq;
  if (!about.empty()) out["about"] = about;
  return to_text(out);
}

std::string no_error_message(const std::string& about) {
  return error_message({}, "", about);
}

}  // namespace arris::view
