// What is shown follows what is asked for: at once, or by a view that is built beside.
#include <fmt/format.h>
#include <malloc.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <string>
#include <utility>

#include "arris/error.h"
#include "base/utf8_text.h"
#include "render/prepared_scene.h"
#include "view/carry_over.h"
#include "view/view_loop.h"
#include "view/view_report.h"

namespace arris::view {
namespace {

// Overlaid pixels keep this much of the picture.
constexpr float kOverlayPicture = 0.35F;

bool has_places(const PreparedScene& prepared, const StagedView& staged, const ViewEdits& edits) {
  const std::vector<Object>& objects = scene_of(prepared).objects;
  for (std::size_t i = 0; i < edits.objects.size(); ++i) {
    const auto index = staged.index_of[i];
    if (index && objects[*index].world_from_object != edits.objects[i].world_from_object) {
      return false;
    }
  }
  return true;
}

void replace_all(std::string& text, const std::string& what, const std::string& by) {
  if (what.empty()) return;
  for (std::size_t at = text.find(what); at != std::string::npos;
       at = text.find(what, at + by.size())) {
    text.replace(at, what.size(), by);
  }
}

bool shows(const PreparedScene& prepared, const StagedView& staged, const ViewEdits& edits) {
  return default_rounding(prepared) == edits.rounding && has_places(prepared, staged, edits);
}

}  // namespace

void ViewRenderer::Loop::follow_edits() {
  if (build_.is_running()) {
    // The view before goes on: camera, split and overlay can follow at once.
    view_.edits.camera = desired_.camera;
    view_.edits.overlay = desired_.overlay;
    view_.edits.split = desired_.split;
    return;
  }
  // A file that has changed waits for an upload, after which it is shown no longer, if that can be shown.
  if (!next_open_ && std::exchange(reload_waits_, false) && !view_.model->file.empty()) {
    next_open_ = OpenRequest{view_.model->file, view_.model->name, true, nullptr};
  }
  if (next_open_) return start_open();
  switch (find_work(view_.edits, desired_)) {
    case ViewWork::none:
    case ViewWork::redraw:
    case ViewWork::camera:
      break;
    case ViewWork::change:
      tell_engines();
      break;
    case ViewWork::new_engine:
    case ViewWork::prepare:
      return start_build();
  }
  view_.edits = desired_;
  add_marks(shown_, std::exchange(unasked_, {}));
}

void ViewRenderer::Loop::tell_engines() {
  for (EdgePointEngine* engine : {view_.engine.get(), view_.compared.get()}) {
    if (engine == nullptr) continue;
    for (std::size_t i = 0; i < desired_.objects.size(); ++i) {
      const auto index = view_.staged.index_of[i];
      const Affine3d& place = desired_.objects[i].world_from_object;
      if (index && place != view_.edits.objects[i].world_from_object) {
        engine->move_object(*index, place);
      }
    }
    if (desired_.rounding == view_.edits.rounding) continue;
    RoundingSettings rounding = desired_.rounding;
    if (engine == view_.compared.get()) rounding.method = *desired_.compared;
    engine->set_rounding(rounding);
  }
  asked_.push_back({desired_, std::exchange(unasked_, {})});
  // Preparing takes what was asked last; older ones show with it.
  constexpr std::size_t kMostAsked = 16;
  while (asked_.size() > kMostAsked) {
    std::vector<InputMark> marks = std::move(asked_.front().marks);
    asked_.pop_front();
    add_marks(marks, asked_.front().marks);
    asked_.front().marks = std::move(marks);
  }
}

// After a frame: which of the changes does it show?
void ViewRenderer::Loop::note_shown_changes() {
  const PreparedScene& scene = *view_.engine->scene();
  for (std::size_t i = asked_.size(); i > 0; --i) {
    if (!shows(scene, view_.staged, asked_[i - 1].edits)) continue;
    for (std::size_t k = 0; k < i; ++k) {
      add_marks(shown_, asked_.front().marks);
      asked_.pop_front();
    }
    if (asked_.empty()) send_scene_soon();
    return;
  }
}

// A change that can't be prepared: the view is as it was.
void ViewRenderer::Loop::undo_asked(const std::string& error) {
  std::vector<InputMark> marks;
  for (const Asked& asked : asked_) add_marks(marks, asked.marks);
  asked_.clear();
  const PreparedScene& scene = *view_.engine->scene();
  const bool is_rounding = desired_.rounding != default_rounding(scene);
  for (ViewEdits* edits : {&view_.edits, &desired_}) {
    edits->rounding = default_rounding(scene);
    for (std::size_t i = 0; i < edits->objects.size(); ++i) {
      const auto index = view_.staged.index_of[i];
      if (!index) continue;
      edits->objects[i].world_from_object = scene_of(scene).objects[*index].world_from_object;
    }
  }
  // The other one may have taken what this one has not.
  if (view_.compared) {
    desired_.compared.reset();
  }
  add_marks(shown_, marks);
  send_errors(marks, error, is_rounding ? "rounding" : "object");
  send_scene_soon();
}

// Builds.

void ViewRenderer::Loop::start_build() {
  built_ = desired_;
  building_ = std::exchange(unasked_, {});
  // What engines were told is part of it.
  for (Asked& asked : asked_) add_marks(building_, asked.marks);
  asked_.clear();
  if (find_work(view_.edits, desired_) == ViewWork::prepare) set_busy("preparing the scene");
  build_.start(
      [model = view_.model, edits = built_, settings = build_settings(),
       before = usable_parts(view_)] { return build_view(model, edits, settings, before); },
      [this] { post([] {}); });
}

void ViewRenderer::Loop::start_open() {
  opening_ = std::exchange(next_open_, std::nullopt);
  built_ = desired_;
  building_ = std::exchange(unasked_, {});
  set_busy("opening " + opening_->name);
  const OpenRequest& request = *opening_;
  build_.start(
      [open = settings_.open, file = request.file, name = request.name,
       before = request.keeps_edits ? view_.model : nullptr, edits = desired_,
       settings = build_settings()] {
        ViewModel opened = open({file, name, before == nullptr, settings.stop.get()});
        if (!before) opened.file.clear();
        auto model = std::make_shared<const ViewModel>(std::move(opened));
        ViewEdits now = first_edits(*model);
        now.size = edits.size;
        if (before) {
          now = carry_over(first_edits(*before), edits, std::move(now),
                           match_objects(*before, *model));
        }
        fit_camera(*model, now);
        return build_view(model, now, settings);
      },
      [this] { post([] {}); });
}

void ViewRenderer::Loop::finish_build() {
  std::string error;
  try {
    std::optional<ShownView> view = build_.take();
    if (!view) return;
    if (*build_stop_) throw Error(Error::Kind::failed, "", "stopped");
    take_view(std::move(*view));
    // What was said of the model before, or of its file.
    if (opening_) send("error", no_error_message());
    if (!lost_.empty()) send_lost();
  } catch (const std::exception& problem) {
    error = problem.what();
    if (*build_stop_) return drop_build();
    if (opening_ && !opening_->keeps_edits) {
      // Where an upload lies is no business of its sender.
      replace_all(error, opening_->file.string(), opening_->name);
      replace_all(error, opening_->file.parent_path().string() + "/", "");
    }
    if (!opening_) {
      // The camera is not what could not be prepared.
      const ViewEdits asked = std::exchange(desired_, view_.edits);
      desired_.camera = asked.camera;
      desired_.framed = asked.framed;
      if (built_.size != asked.size) desired_.size = asked.size;
      fit_camera(*view_.model, desired_);
    }
    if (!opening_) send_errors(building_, error, find_change(view_.edits, built_));
    if (opening_ && !opening_->done) send_errors({}, error, kAboutFile);
  }
  add_marks(shown_, std::exchange(building_, {}));
  if (opening_ && opening_->done) opening_->done(error);
  opening_.reset();
  settled_ = false;
  pace_.note_change(Clock::now());
  pace_.hurry(Clock::now());
  set_busy("");
  send_scene_soon();
}

void ViewRenderer::Loop::send_lost() {
  constexpr std::size_t kMostNames = 4;
  const std::vector<std::string> lost = std::exchange(lost_, {});
  std::string names;
  for (std::size_t i = 0; i < std::min(lost.size(), kMostNames); ++i) {
    names += (i == 0 ? "" : ", ") + in_quotes(lost[i]);
  }
  if (lost.size() > kMostNames) names += fmt::format(" and {} others", lost.size() - kMostNames);
  const std::string text = "What was changed of " + names +
                           " is lost, because the file has no object of that name any more";
  send("error", error_message({}, text, kAboutFile));
}

// Another model is to be shown. What was asked of this one goes on with it, if it is the same one again.
void ViewRenderer::Loop::drop_build() {
  add_marks(unasked_, std::exchange(building_, {}));
  if (opening_ && opening_->keeps_edits) reload_waits_ = true;
  if (opening_ && opening_->done) opening_->done("another model was opened meanwhile");
  opening_.reset();
}

void ViewRenderer::Loop::take_view(ShownView view) {
  if (opening_ && opening_->keeps_edits) {
    const ObjectMatch match = match_objects(*view_.model, *view.model);
    lost_ = lost_objects(*view_.model, desired_, match);
    desired_ = carry_over(built_, desired_, view.edits, match);
    fit_camera(*view.model, desired_);
  } else if (opening_) {
    ++model_number_;
    // Nothing that was asked of the model before has a meaning for this one.
    const PictureSize size = desired_.size;
    desired_ = view.edits;
    apply_message(*view.model, SetSize{size}, desired_);
  }
  picture_ = nullptr;
  shooter_.reset();
  asked_.clear();
  const bool is_smaller = area_of(view.edits.size) < area_of(view_.edits.size);
  view_ = std::move(view);
  if (!is_smaller) return;
  composed_ = {};
  // What the engines of a large picture have freed lies in pieces between what is left.
  ::malloc_trim(0);
}

// Frames.

void ViewRenderer::Loop::make_pictures() {
  picture_ = nullptr;
  view_.engine->set_camera(view_.edits.camera);
  const Image& main = view_.engine->next_frame();
  const Image* right = nullptr;
  if (view_.compared) {
    view_.compared->set_camera(view_.edits.camera);
    right = &view_.compared->next_frame();
  }
  picture_ = &compose(main, right);
  ++picture_number_;
}

void ViewRenderer::Loop::make_frame() {
  const Clock::time_point begin = Clock::now();
  const bool moving = pace_.is_moving(begin);
  try {
    make_pictures();
  } catch (const std::exception& error) {
    undo_asked(error.what());
    pace_.note_frame(begin, Clock::now(), false);
    return;
  }
  const EdgePointStats& stats = view_.engine->stats();
  note_shown_changes();
  // What made a still view finer would have given way to a moving one.
  std::chrono::duration<double> finer(stats.traced_still ? stats.shading_seconds : 0);
  if (view_.compared && view_.compared->stats().traced_still) {
    finer += std::chrono::duration<double>(view_.compared->stats().shading_seconds);
  }
  pace_.note_frame(begin + std::chrono::duration_cast<Clock::duration>(finer), Clock::now(),
                   is_shader_idle());
  std::uint32_t samples = stats.still_paths;
  if (view_.compared) samples = std::min(samples, view_.compared->stats().still_paths);
  const auto wanted = std::uint32_t(view_.model->scene.image.samples_per_pixel);
  const bool converged = !moving && asked_.empty() && !build_.is_running() && samples >= wanted;
  settled_ = converged;
  publish(moving, converged);
  send_state(converged);
}

// Then the next frame brings more than a pause would. The engine asks for as much again as was done and half of it,
// within an eighth of its density and all of it.
bool ViewRenderer::Loop::is_shader_idle() {
  const EdgePointStats& stats = view_.engine->stats();
  const double most =
      EdgePointSettings{}.density * double(picture_->width_px) * double(picture_->height_px);
  const bool idle = double(stats.new_points) >= 0.9 * planned_points_;
  planned_points_ = std::clamp(1.5 * double(stats.new_points), most / 8, most);
  return idle || stats.traced || stats.traced_still;
}

void ViewRenderer::Loop::publish(bool moving, bool converged) {
  auto frame = std::make_shared<ViewFrame>();
  frame->number = ++frame_number_;
  frame->size = {picture_->width_px, picture_->height_px};
  frame->moving = moving;
  frame->converged = converged;
  frame->samples = view_.engine->stats().still_paths;
  frame->shown = shown_;
  make_codes(*picture_, view_.model->scene.image.exposure, settings_.threads, codes_);
  codes_ = encoder_->put(std::move(frame), std::move(codes_),
                         moving ? JpegSettings{quality_.moving, ChromaDetail::half}
                                : JpegSettings{quality_.still, ChromaDetail::full});
}

// Left of the split line the first picture, right of it the other one; classes of pixels over both.
const Image& ViewRenderer::Loop::compose(const Image& main, const Image* right) {
  if (right == nullptr && !view_.edits.overlay) return main;
  composed_ = main;
  const auto width = std::size_t(main.width_px);
  const auto split =
      right == nullptr ? width : std::size_t(std::lround(view_.edits.split * double(width)));
  const auto copy_right = [&](const Image& from, Image& to) {
    for (int y = 0; y < main.height_px; ++y) {
      const auto first = std::ptrdiff_t(main.offset(0, y) + split * 3);
      const auto last = std::ptrdiff_t(main.offset(0, y) + width * 3);
      std::copy(from.values.begin() + first, from.values.begin() + last, to.values.begin() + first);
    }
  };
  if (right != nullptr) copy_right(*right, composed_);
  if (!view_.edits.overlay) return composed_;
  Image classes = view_.engine->classes_picture();
  if (right != nullptr) copy_right(view_.compared->classes_picture(), classes);
  for (std::size_t i = 0; i < composed_.values.size(); ++i) {
    composed_.values[i] =
        composed_.values[i] * kOverlayPicture + classes.values[i] * (1 - kOverlayPicture);
  }
  return composed_;
}

}  // namespace arris::view
