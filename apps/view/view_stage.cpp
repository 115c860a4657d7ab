#include "view/view_stage.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <span>
#include <utility>

#include "arris/error.h"
#include "arris/rounding.h"
#include "base/nearest_name.h"
#include "base/utf8_text.h"
#include "render/camera.h"
#include "render/ground_frame.h"
#include "render/scene_rounding.h"
#include "scene/material_presets.h"
#include "scene/validate_placement.h"

namespace arris::view {
namespace {

std::optional<Lighting> lighting_of(LightChoice choice) {
  switch (choice) {
    case LightChoice::studio:
      return Lighting::studio;
    case LightChoice::sky:
      return Lighting::sky;
    case LightChoice::white:
      return Lighting::white;
    case LightChoice::file:
      break;
  }
  return std::nullopt;
}

LightChoice choice_of(std::optional<Lighting> lighting) {
  if (!lighting) return LightChoice::file;
  switch (*lighting) {
    case Lighting::studio:
      return LightChoice::studio;
    case Lighting::sky:
      return LightChoice::sky;
    case Lighting::white:
      return LightChoice::white;
  }
  return LightChoice::file;
}

bool has_lights(const ViewModel& model) {
  return model.scene.environment || !model.scene.lights.empty();
}

StageOptions stage_options(const ViewModel& model, const ViewEdits& edits) {
  StageOptions stage = model.stage;
  stage.lighting = lighting_of(edits.lighting);
  stage.ground = edits.ground;
  stage.material.reset();
  if (edits.material) stage.material = find_material_preset(*edits.material);
  return stage;
}

Vec3d rotate_about(Vec3d v, Vec3d axis, double angle) {
  const Vec3d k = normalize(axis);
  return v * std::cos(angle) + cross(k, v) * std::sin(angle) +
         k * (dot(k, v) * (1 - std::cos(angle)));
}

// Counter-clockwise seen from above.
struct TurnedLight {
  double strength, angle;

  Environment operator()(ConstantEnvironment e) const {
    e.radiance *= float(strength);
    return e;
  }
  Environment operator()(SkyEnvironment e) const {
    e.strength *= strength;
    e.sun_direction = rotate_about(e.sun_direction, e.up, angle);
    return e;
  }
  Environment operator()(HdrEnvironment e) const {
    e.strength *= strength;
    e.rotation += angle;
    return e;
  }
  Environment operator()(StudioEnvironment e) const {
    e.strength *= strength;
    e.rotation += angle;
    return e;
  }
};

void scale_light(Light& light, float strength) {
  struct Scale {
    float by;
    void operator()(PointLight& l) const { l.intensity *= by; }
    void operator()(SpotLight& l) const { l.intensity *= by; }
    void operator()(DirectionalLight& l) const { l.irradiance *= by; }
    void operator()(AreaLight& l) const { l.radiance *= by; }
  };
  std::visit(Scale{strength}, light);
}

void apply_light_edits(Scene& scene, const ViewEdits& edits) {
  if (edits.strength == 1 && edits.rotation_deg == 0) return;
  scene.environment =
      std::visit(TurnedLight{edits.strength, radians(edits.rotation_deg)}, *scene.environment);
  for (Light& light : scene.lights) scale_light(light, float(edits.strength));
}

RoundingSettings with_method(RoundingSettings settings, std::optional<RoundMethod> method) {
  if (method) settings.method = *method;
  return settings;
}

// Empty: there is nothing to round, or no length that reads well (all of it lies at the camera).
std::optional<double> first_auto_radius(const Scene& staged, const Object& object) {
  if (object.csg || staged.meshes[object.mesh.index].positions.empty()) return std::nullopt;
  const double radius = most_auto_radius(staged, object);
  return radius > 0 && std::isfinite(radius) ? std::optional(radius) : std::nullopt;
}

void check_object(const ViewModel& model, std::uint32_t id) {
  if (id < model.scene.objects.size()) return;
  throw Error(
      Error::Kind::input, "",
      fmt::format("there is no object {}; the model has {}", id, model.scene.objects.size()));
}

std::vector<std::string> camera_problems(const ViewModel& model, const Camera& camera) {
  Scene seen;
  seen.image = model.scene.image;
  seen.camera = camera;
  return validate_placement(seen);
}

void check_camera(const ViewModel& model, const Camera& camera) {
  const std::vector<std::string> problems = camera_problems(model, camera);
  if (!problems.empty()) {
    throw Error(Error::Kind::input, "", fmt::format("{}", fmt::join(problems, "\n")));
  }
}

// Changes of one kind of message each.
struct Apply {
  const ViewModel& model;
  ViewEdits& edits;

  void operator()(const Hello& m) const { set_size(m.size); }
  void operator()(const SetSize& m) const { set_size(m.size); }
  void operator()(const SetCamera& m) const {
    check_camera(model, m.camera);
    edits.camera = m.camera;
    edits.framed.reset();
  }
  void operator()(const FrameView& m) const {
    const Camera camera = frame_view(model, edits, m.from);
    check_camera(model, camera);
    edits.camera = camera;
    edits.framed = m.from;
  }
  void operator()(const SetRounding& m) const {
    RoundingSettings& rounding = edits.rounding;
    rounding.method = m.method.value_or(rounding.method);
    rounding.radius = m.radius.value_or(rounding.radius);
    rounding.edges = m.edges.value_or(rounding.edges);
    rounding.min_angle = m.min_angle.value_or(rounding.min_angle);
    for (std::size_t id = 0; id < edits.objects.size(); ++id) {
      const ObjectEdit& object = edits.objects[id];
      if (object.has_edited_radius) set_radius(id, object.rounding->radius);
    }
  }
  void operator()(const SetObject& m) const {
    check_object(model, m.id);
    ObjectEdit& object = edits.objects[m.id];
    object.visible = m.visible.value_or(object.visible);
    object.world_from_object = m.world_from_object.value_or(object.world_from_object);
    if (!m.radius) return;
    object.has_edited_radius = m.radius->has_value();
    object.rounding.reset();
    if (*m.radius) set_radius(m.id, **m.radius);
  }
  void operator()(const Isolate& m) const {
    if (m.id) check_object(model, *m.id);
    for (std::size_t i = 0; i < edits.objects.size(); ++i) {
      edits.objects[i].visible = !m.id || *m.id == i;
    }
  }
  void operator()(const SetLight& m) const {
    if (m.lighting == LightChoice::file && !has_lights(model)) {
      throw Error(Error::Kind::input, "",
                  "the model's file has no lights of its own; use studio, sky or white");
    }
    edits.lighting = m.lighting.value_or(edits.lighting);
    edits.strength = m.strength.value_or(edits.strength);
    edits.rotation_deg = m.rotation_deg.value_or(edits.rotation_deg);
  }
  void operator()(const SetMaterial& m) const {
    if (m.name && !find_material_preset(*m.name)) {
      throw Error(Error::Kind::input, "",
                  fmt::format("{} is no material{}", in_quotes(*m.name),
                              did_you_mean(*m.name, material_preset_names())));
    }
    edits.material = m.name;
  }
  void operator()(const SetGround& m) const { edits.ground = m.on; }
  void operator()(const SetShader& m) const { edits.shader = m.shader; }
  void operator()(const Compare& m) const {
    edits.compared = m.method;
    edits.split = m.split;
  }
  void operator()(const SetOverlay& m) const { edits.overlay = m.on; }
  void operator()(const Ack&) const {}
  void operator()(const Pick&) const {}
  void operator()(const MakeBeam&) const {}
  void operator()(const StopBeam&) const {}
  void operator()(const SetQuality&) const {}

 private:
  void set_size(PictureSize size) const {
    if (edits.size == size) return;
    edits.size = size;
    fit_camera(model, edits);
  }
  // Rules that the file gives the object alone stay with it.
  void set_radius(std::size_t id, Radius radius) const {
    RoundingSettings rounding = edits.rounding;
    rounding.radius = radius;
    if (const auto& own = model.scene.objects[id].rounding) rounding.rules = own->rules;
    edits.objects[id].rounding = rounding;
  }
};

}  // namespace

bool is_same(const Camera& a, const Camera& b) {
  return a.position == b.position && a.target == b.target && a.up == b.up && a.fov_deg == b.fov_deg;
}

std::vector<LightChoice> lightings_of(const ViewModel& model) {
  std::vector<LightChoice> out{LightChoice::studio, LightChoice::sky, LightChoice::white};
  if (has_lights(model)) out.push_back(LightChoice::file);
  return out;
}

bool can_rotate_light(const ViewModel& model, const ViewEdits& edits) {
  if (edits.lighting == LightChoice::white) return false;
  const std::optional<Environment>& own = model.scene.environment;
  return edits.lighting != LightChoice::file ||
         (own && !std::holds_alternative<ConstantEnvironment>(*own));
}

ViewEdits first_edits(const ViewModel& model) {
  ViewEdits edits;
  Scene staged = model.scene;
  const StagingReport report = stage_model(staged, model.stage);
  if (!report.problem.empty()) throw Error(Error::Kind::input, model.name, report.problem);
  edits.size = {std::clamp(model.scene.image.width_px, kLeastSize.width_px, kMostSize.width_px),
                std::clamp(model.scene.image.height_px, kLeastSize.height_px, kMostSize.height_px)};
  edits.camera = *staged.camera;
  edits.rounding = model.scene.rounding.value_or(RoundingSettings{});
  edits.lighting = choice_of(model.stage.lighting);
  if (edits.lighting == LightChoice::file && !has_lights(model)) {
    edits.lighting = LightChoice::studio;
  }
  if (model.stage.material) edits.material = model.stage.material->name;
  edits.ground = report.ground_triangles > 0;
  edits.shader = model.shader;
  for (std::size_t i = 0; i < model.scene.objects.size(); ++i) {
    const Object& object = model.scene.objects[i];
    edits.objects.push_back({true, object.rounding, false, object.world_from_object,
                             first_auto_radius(staged, staged.objects[i])});
  }
  return edits;
}

void apply_message(const ViewModel& model, const MessageKind& message, ViewEdits& edits) {
  std::visit(Apply{model, edits}, message);
}

Camera frame_view(const ViewModel& model, const ViewEdits& edits, FrameView::From from) {
  Scene visible = model.scene;
  visible.image.width_px = edits.size.width_px;
  visible.image.height_px = edits.size.height_px;
  if (from == FrameView::From::first) {
    stage_model(visible, model.stage);
    return *visible.camera;
  }
  visible.objects.clear();
  for (std::size_t i = 0; i < edits.objects.size(); ++i) {
    if (!edits.objects[i].visible) continue;
    visible.objects.push_back(model.scene.objects[i]);
    visible.objects.back().world_from_object = edits.objects[i].world_from_object;
  }
  if (visible.objects.empty()) return edits.camera;
  const double fov = edits.camera.fov_deg;
  const GroundFrame frame = make_ground_frame(model.scene.up);
  switch (from) {
    case FrameView::From::here:
      return frame_scene_from(visible, edits.camera.position - edits.camera.target, edits.camera.up,
                              fov);
    case FrameView::From::front:
      return frame_scene_from(visible, -frame.north, frame.up, fov);
    case FrameView::From::right:
      return frame_scene_from(visible, frame.east, frame.up, fov);
    case FrameView::From::top:
      return frame_scene_from(visible, frame.up, frame.north, fov);
    case FrameView::From::iso:  // all three axes alike
      return frame_scene_from(visible, frame.east - frame.north + frame.up, frame.up, fov);
    case FrameView::From::first:
      break;
  }
  return frame_scene(visible, fov);
}

void fit_camera(const ViewModel& model, ViewEdits& edits) {
  if (!edits.framed) return;
  const Camera camera = frame_view(model, edits, *edits.framed);
  if (camera_problems(model, camera).empty()) edits.camera = camera;
}

StagedView stage_view(const ViewModel& model, const ViewEdits& edits,
                      std::optional<RoundMethod> method) {
  StagedView out;
  Scene& scene = out.scene;
  scene = model.scene;
  // All frames are of now.
  scene.animation = {};
  stage_model(scene, stage_options(model, edits));
  apply_light_edits(scene, edits);
  scene.image.width_px = edits.size.width_px;
  scene.image.height_px = edits.size.height_px;
  scene.camera = edits.camera;
  scene.rounding = with_method(edits.rounding, method);
  std::vector<Object> staged = std::exchange(scene.objects, {});
  for (std::size_t i = 0; i < staged.size(); ++i) {
    const bool is_own = i < edits.objects.size();  // else the ground
    if (is_own) {
      const ObjectEdit& edit = edits.objects[i];
      out.index_of.emplace_back();
      if (!edit.visible) continue;
      out.index_of.back() = std::uint32_t(scene.objects.size());
      staged[i].world_from_object = edit.world_from_object;
      staged[i].auto_radius = edit.auto_radius;
      staged[i].rounding = edit.rounding;
      if (edit.rounding) staged[i].rounding = with_method(*edit.rounding, method);
    }
    scene.objects.push_back(std::move(staged[i]));
  }
  return out;
}

int path_depth(const ImageSettings& image, EdgePointShader shader) {
  return shader == EdgePointShader::direct ? std::min(image.max_depth, 1) : image.max_depth;
}

StagedBeams stage_beams(const ViewModel& model, const ViewEdits& edits) {
  ViewEdits sharp = edits;
  sharp.rounding.method = RoundMethod::none;
  StagedBeams out{stage_view(model, sharp, RoundMethod::none).scene, {}};
  out.scene.image.max_depth = path_depth(out.scene.image, edits.shader);
  out.settings.only_glossy = edits.shader == EdgePointShader::glossy;
  return out;
}

ViewWork find_work(const ViewEdits& from, const ViewEdits& to) {
  const auto is_prepared_alike = [](const ObjectEdit& a, const ObjectEdit& b) {
    return a.visible == b.visible && a.rounding == b.rounding;
  };
  if (from.lighting != to.lighting || from.strength != to.strength ||
      from.rotation_deg != to.rotation_deg || from.material != to.material ||
      from.ground != to.ground ||
      !std::ranges::equal(from.objects, to.objects, is_prepared_alike)) {
    return ViewWork::prepare;
  }
  const bool is_new_engine =
      from.size != to.size || from.shader != to.shader || from.compared != to.compared;
  const bool is_change = from.rounding != to.rounding || from.objects != to.objects;
  if ((is_new_engine || is_change) && (has_bevel_meshes(from) || has_bevel_meshes(to))) {
    return ViewWork::prepare;
  }
  if (is_new_engine) return ViewWork::new_engine;
  if (is_change) return ViewWork::change;
  if (!is_same(from.camera, to.camera)) return ViewWork::camera;
  return from.split != to.split || from.overlay != to.overlay ? ViewWork::redraw : ViewWork::none;
}

bool has_bevel_meshes(const ViewEdits& edits) {
  const auto is_meshed = [](const ObjectEdit& object) {
    return object.rounding && object.rounding->method == RoundMethod::mesh;
  };
  return edits.rounding.method == RoundMethod::mesh || edits.compared == RoundMethod::mesh ||
         std::ranges::any_of(edits.objects, is_meshed);
}

const char* find_change(const ViewEdits& from, const ViewEdits& to) {
  if (from.rounding != to.rounding) return "rounding";
  if (from.objects != to.objects) return "object";
  if (from.compared != to.compared) return "compare";
  if (from.size != to.size) return "size";
  if (from.ground != to.ground) return "ground";
  if (from.material != to.material) return "material";
  if (from.shader != to.shader) return "shader";
  if (from.lighting != to.lighting || from.strength != to.strength ||
      from.rotation_deg != to.rotation_deg) {
    return "light";
  }
  return "";
}

std::vector<Bounds> first_bounds(const ViewModel& model) {
  std::vector<Bounds> bounds;
  for (const Object& object : model.scene.objects) {
    bounds.push_back(world_bounds(model.scene, object));
  }
  return bounds;
}

std::vector<std::optional<double>> first_inradii(const ViewModel& model) {
  // Half a second's work. Larger ones are scans and the like, seldom convex.
  constexpr std::size_t kMostTriangles = 200'000;
  const Scene& scene = model.scene;
  const double min_angle = scene.rounding.value_or(RoundingSettings{}).min_angle;
  std::map<std::uint32_t, std::optional<double>> of_meshes;  // in their own space
  std::size_t triangles = 0;
  const auto inradius_of = [&](const Mesh& mesh, std::span<const Vec3f> positions) {
    triangles += mesh.triangles.size();
    if (triangles > kMostTriangles) return std::optional<double>();
    try {
      return find_radius_limits({positions, mesh.triangles, mesh.sharp_edges}, min_angle)
          .smallest_inradius;
    } catch (const Error&) {  // preparing says so, if it matters
      return std::optional<double>();
    }
  };
  std::vector<std::optional<double>> out;
  for (const Object& object : scene.objects) {
    std::optional<double>& inradius = out.emplace_back();
    if (object.csg) continue;
    const Mesh& mesh = scene.meshes[object.mesh.index];
    const auto scale = similarity_scale(object.world_from_object.linear);
    if (!scale) {
      std::vector<Vec3f> positions;
      for (const Vec3f& p : mesh.positions) {
        positions.emplace_back(transform_point(object.world_from_object, Vec3d(p)));
      }
      inradius = inradius_of(mesh, positions);
      continue;
    }
    const auto [known, is_new] = of_meshes.try_emplace(object.mesh.index);
    if (is_new) known->second = inradius_of(mesh, mesh.positions);
    if (known->second) inradius = *known->second * *scale;
  }
  return out;
}

std::optional<double> radius_limit(const ViewModel& model, const ViewEdits& edits,
                                   const std::vector<std::optional<double>>& first_inradii) {
  std::optional<double> limit;
  for (std::size_t i = 0; i < edits.objects.size(); ++i) {
    const ObjectEdit& edit = edits.objects[i];
    if (!edit.visible || edit.rounding || !first_inradii[i]) continue;
    double inradius = *first_inradii[i];
    const Mat3d& before = model.scene.objects[i].world_from_object.linear;
    const Mat3d& now = edit.world_from_object.linear;
    if (before != now) {
      const auto scale_before = similarity_scale(before), scale_now = similarity_scale(now);
      if (!scale_before || !scale_now) continue;
      inradius *= *scale_now / *scale_before;
    }
    limit = std::min(inradius, limit.value_or(inradius));
  }
  return limit;
}

Bounds moved_bounds(const Bounds& bounds, const Affine3d& before, const Affine3d& now) {
  if (bounds.is_empty() || before == now) return bounds;
  const Affine3d move = now * inverse(before);
  Bounds moved;
  for (int corner = 0; corner < 8; ++corner) {
    moved.add(transform_point(move, {(corner & 1) != 0 ? bounds.upper.x : bounds.lower.x,
                                     (corner & 2) != 0 ? bounds.upper.y : bounds.lower.y,
                                     (corner & 4) != 0 ? bounds.upper.z : bounds.lower.z}));
  }
  return moved;
}

}  // namespace arris::view
