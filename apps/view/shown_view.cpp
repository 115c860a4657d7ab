#include "view/shown_view.h"

#include <algorithm>
#include <chrono>
#include <thread>
#include <utility>

#include "render/prepared_scene.h"

namespace arris::view {
namespace {

// Points show a still view's light sooner than paths do; paths get it done.
constexpr double kTraceStillMs = 1000;

using ScenePtr = std::shared_ptr<const PreparedScene>;

// Moves of a single object change nothing but where the light comes from; several are worth a structure of their own.
Placement placement_of(const ViewModel& model) {
  return model.scene.objects.size() > 1 ? Placement::movable : Placement::baked;
}

PrepareOptions prepare_options(const ViewModel& model, const BuildSettings& settings) {
  return {
      .threads = settings.threads, .stop = settings.stop.get(), .placement = placement_of(model)};
}

// before: another view of the same model, or null.
ScenePtr prepare_anew(const ViewModel& model, const ViewEdits& edits,
                      std::optional<RoundMethod> method, const BuildSettings& settings,
                      const PreparedScene* before) {
  PrepareOptions options = prepare_options(model, settings);
  options.solids_of = before;
  return prepare_scene(stage_view(model, edits, method).scene, options);
}

RoundingSettings wanted_rounding(const ViewEdits& edits, std::optional<RoundMethod> method) {
  RoundingSettings rounding = edits.rounding;
  if (method) rounding.method = *method;
  return rounding;
}

// Picture, places and the default rounding of `edits`.
ScenePtr bring_up_to_date(ScenePtr prepared, const ViewModel& model, const ViewEdits& edits,
                          const StagedView& staged, std::optional<RoundMethod> method,
                          const BuildSettings& settings) {
  const PrepareOptions options = prepare_options(model, settings);
  Scene scene = scene_of(*prepared);
  scene.image.width_px = edits.size.width_px;
  scene.image.height_px = edits.size.height_px;
  scene.camera = edits.camera;
  for (std::size_t i = 0; i < edits.objects.size(); ++i) {
    if (!staged.index_of[i]) continue;
    scene.objects[*staged.index_of[i]].world_from_object = edits.objects[i].world_from_object;
  }
  prepared = prepare_moved(*prepared, std::move(scene), options);
  const RoundingSettings rounding = wanted_rounding(edits, method);
  if (default_rounding(*prepared) != rounding) {
    prepared = prepare_again(*prepared, rounding, options);
  }
  return prepared;
}

// The ground has, and is none.
bool has_own_roundings(const ViewEdits& edits) {
  return std::ranges::any_of(edits.objects,
                             [](const ObjectEdit& object) { return object.rounding.has_value(); });
}

ScenePtr make_scene(const ViewModel& model, const ViewEdits& edits, const StagedView& staged,
                    const BuildSettings& settings, const UsableView* before,
                    const PreparedScene* solids) {
  if (before == nullptr) return prepare_anew(model, edits, std::nullopt, settings, solids);
  return bring_up_to_date(before->scene, model, edits, staged, std::nullopt, settings);
}

ScenePtr make_compared(const ViewModel& model, const ViewEdits& edits, const StagedView& staged,
                       const ScenePtr& main, const BuildSettings& settings,
                       const UsableView* before) {
  if (!edits.compared) return nullptr;
  if (before != nullptr && before->compared && before->edits.compared == edits.compared) {
    return bring_up_to_date(before->compared, model, edits, staged, edits.compared, settings);
  }
  if (has_own_roundings(edits) || has_bevel_meshes(edits)) {
    return prepare_anew(model, edits, edits.compared, settings, main.get());
  }
  return prepare_again(*main, wanted_rounding(edits, edits.compared),
                       prepare_options(model, settings));
}

// What a frame lacks until its first points are there.
bool shows_enough(const EdgePointStats& stats) {
  const std::uint64_t pixels = stats.classes.empty + stats.classes.simple + stats.classes.complex;
  return stats.traced || stats.unresolved * 50 < pixels;
}

std::unique_ptr<EdgePointEngine> make_engine(const ViewModel& model, const ScenePtr& scene,
                                             const ViewEdits& edits,
                                             const BuildSettings& settings) {
  EdgePointSettings engine_settings;
  // The ground's fade is smooth enough without rays of its own in each pixel.
  engine_settings.sharp_textures = !model.scene.textures.empty();
  engine_settings.shader = edits.shader;
  engine_settings.threads = settings.threads;
  engine_settings.trace_below_ms = settings.trace_below_ms;
  engine_settings.stop = settings.stop.get();
  engine_settings.hurry = settings.hurry;
  engine_settings.trace_still_ms = kTraceStillMs;
  auto engine = std::make_unique<EdgePointEngine>(scene, engine_settings);
  engine->set_camera(edits.camera);
  constexpr int kMostFrames = 8;
  constexpr auto kShading = std::chrono::milliseconds(25);
  for (int frame = 0; frame < kMostFrames; ++frame) {
    engine->next_frame();
    if (shows_enough(engine->stats())) break;
    std::this_thread::sleep_for(kShading);
  }
  return engine;
}

}  // namespace

UsableView usable_parts(const ShownView& view) {
  return {view.model,   view.edits,           view.staged,
          view.inradii, view.engine->scene(), view.compared ? view.compared->scene() : nullptr};
}

ShownView build_view(std::shared_ptr<const ViewModel> model, const ViewEdits& edits,
                     const BuildSettings& settings, const std::optional<UsableView>& before) {
  const bool is_same_model = before && before->model == model;
  const bool is_usable = is_same_model && find_work(before->edits, edits) < ViewWork::prepare;
  const UsableView* use = is_usable ? &*before : nullptr;
  ShownView view;
  view.stop = settings.stop;
  view.edits = edits;
  view.staged = stage_view(*model, edits);
  const ScenePtr main = make_scene(*model, edits, view.staged, settings, use,
                                   is_same_model ? before->scene.get() : nullptr);
  const ScenePtr other = make_compared(*model, edits, view.staged, main, settings, use);
  // Its meshes are the prepared scene's, too; what else it holds is of no use any more.
  view.staged.scene = {};
  view.engine = make_engine(*model, main, edits, settings);
  if (other) view.compared = make_engine(*model, other, edits, settings);
  view.bounds = first_bounds(*model);
  view.inradii = is_same_model ? before->inradii : first_inradii(*model);
  view.model = std::move(model);
  return view;
}

RoundingSettings default_rounding(const PreparedScene& prepared) {
  return prepared.rounding().scene_default.value_or(RoundingSettings{});
}

}  // namespace arris::view
