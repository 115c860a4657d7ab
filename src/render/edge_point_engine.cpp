// edge_point_engine.cpp — EdgePointEngine: what is behind its public face
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "arris/edge_point.h"
#include "arris/error.h"
#include "base/parallel_for.h"
#include "edgepoint/frame_maker.h"
#include "edgepoint/sample_plan.h"
#include "render/edge_objects.h"
#include "render/scene_updater.h"
#include "render/shade_plan.h"
#include "render/shade_workers.h"
#include "render/shadow_finder.h"
#include "render/stale_points.h"
#include "render/still_film.h"
#include "render/still_tracer.h"
#include "render/texture_tints.h"
#include "render/trace_choice.h"
#include "scene/validate_placement.h"

namespace arris {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// Points are kept for what has left the picture, too.
constexpr double kCachePerPixel = 1.5;
// A point's paths and those of its neighbours stand for so many of the pixel's own, in a view that stands still.
constexpr float kNeighbors = 2;
// Workers are asked for this much more than they did last time.
constexpr double kMoreThanDone = 1.5;

PixelView make_pixel_view(const CameraRays& camera, const ImageSettings& image) {
  return {Vec3d(camera.position), inverse(Mat3d{camera.step_x, camera.step_y, camera.corner}),
          image.width_px, image.height_px};
}

bool is_same(const Camera& a, const Camera& b) {
  return a.position == b.position && a.target == b.target && a.up == b.up && a.fov_deg == b.fov_deg;
}

EdgePointSettings checked(const EdgePointSettings& settings) {
  const auto check = [](bool holds, const char* setting, double value, const char* range) {
    if (holds) return;
    throw Error(Error::Kind::input, setting, fmt::format("{:g} is not {}", value, range));
  };
  check(settings.density > 0 && settings.density <= 1, "density", settings.density,
        "above 0 and at most 1");
  check(settings.most_density >= 0 && settings.most_density <= 1, "most_density",
        settings.most_density, "within 0 and 1");
  check(settings.first_density >= 0 && settings.first_density <= 1, "first_density",
        settings.first_density, "within 0 and 1");
  check(settings.paths_per_point >= 0, "paths_per_point", settings.paths_per_point, "0 or more");
  check(settings.trace_below_ms >= 0, "trace_below_ms", settings.trace_below_ms, "0 or more");
  check(settings.trace_still_ms >= 0, "trace_still_ms", settings.trace_still_ms, "0 or more");
  return settings;
}

void check_view(const Scene& scene, const Camera& camera) {
  Scene seen;
  seen.image = scene.image;
  seen.camera = camera;
  const std::vector<std::string> problems = validate_placement(seen);
  if (!problems.empty()) {
    throw Error(Error::Kind::input, "", fmt::format("{}", fmt::join(problems, "\n  ")));
  }
}

}  // namespace

class EdgePointEngine::Impl {
 public:
  Impl(std::shared_ptr<const PreparedScene> scene, const EdgePointSettings& settings)
      : settings_(checked(settings)),
        shown_(first_shown(std::move(scene), settings)),
        shader_(make_point_shader(settings)),
        image_(shown_.scene->scene().image),
        camera_(*shown_.scene->scene().camera),
        updater_(shown_, {settings.synchronous ? UpdateMode::at_once : UpdateMode::beside,
                          settings.use_edges && settings.shadow_edges, settings.threads}),
        lights_(std::make_shared<const std::vector<ShadowLight>>(shadow_lights(*shown_.scene))),
        cache_(std::size_t(std::ceil(kCachePerPixel * pixel_count())),
               int(std::lround(image_.exposure)),
               settings.sharp_textures && has_tints(shown_.scene->scene())),
        maker_(image_.width_px, image_.height_px),
        picture_(image_.width_px, image_.height_px, 3),
        tints_(shown_.scene->scene(), settings.threads),
        film_(maker_.image().codes.size()),
        wanted_(film_size(), 255),
        choice_(settings.trace_below_ms,
                settings.synchronous ? CostMeasure::rays : CostMeasure::seconds) {
    if (!settings.synchronous) workers_ = std::make_unique<ShadeWorkers>(settings.threads);
  }

  void set_camera(const Camera& camera) {
    if (is_same(camera, camera_)) return;
    camera_ = camera;
    camera_checked_ = false;
    view_changed();
  }

  // Instead of all changes so far.
  void set_scene(std::shared_ptr<const PreparedScene> scene) {
    updater_.drop();
    if (scene == shown_.scene) return;
    ShownScene next = shown_;
    next.scene = std::move(scene);
    if (auto objects = next.objects->with_roundings(*shown_.scene, *next.scene)) {
      next.objects = std::move(objects);
    }
    show(std::move(next));
  }
  [[nodiscard]] SceneChanges& changes() { return updater_.changes(); }
  [[nodiscard]] const std::shared_ptr<const PreparedScene>& scene() const { return shown_.scene; }

  const Image& next_frame() {
    if (workers_) workers_->set_paused(true);
    stats_ = {};
    ShownScene next = shown_;
    updater_.poll(next);
    show(std::move(next));
    if (!camera_checked_) check_view(shown_.scene->scene(), camera_);
    camera_checked_ = true;
    const CameraRays rays = make_camera_rays(camera_, image_);
    if (workers_) collect();
    if (!workers_ && frame_ == 0) shade_first(rays);
    const bool has_changed = !workers_ && still_frames_ == 0 && has_points_;
    stats_.traced = choice_.decide(pixel_count(), frame_ms_);
    if (stats_.traced) {
      trace_frame(rays);
    } else {
      if (!workers_ && !has_points_) shade_first(rays);
      if (must_trace_still()) trace_still(rays);
      make_frame(rays);
      // What has moved is shaded before it is shown: a frame of points of the scene before would be late.
      if (has_changed) {
        shade_now(*make_plan(rays, wanted_density()), false);
        make_frame(rays);
      }
      // Nothing to interpolate: from where the eye is no point can be projected.
      if (!workers_ && stats_.unresolved == film_size()) {
        stats_ = {};
        stats_.traced = true;
        trace_frame(rays);
      }
    }
    has_points_ = !stats_.traced;
    ++frame_;
    ++still_frames_;
    if (stats_.traced || stats_.traced_still) return picture_;
    if (workers_) {
      workers_->set_plan(make_plan(rays, planned_density()));
      workers_->set_paused(false);
    } else if (!has_changed) {
      shade_now(*make_plan(rays, wanted_density()), true);
    }
    return picture_;
  }

  [[nodiscard]] const EdgePointStats& stats() const { return stats_; }
  [[nodiscard]] Image classes_picture() const;

 private:
  [[nodiscard]] double pixel_count() const {
    return double(image_.width_px) * double(image_.height_px);
  }
  [[nodiscard]] std::size_t film_size() const { return maker_.image().codes.size(); }
  // The last frame showed the same.
  [[nodiscard]] bool is_still() const { return still_frames_ > 1; }
  // Whether a pixel is to have paths of its own instead of a point: also one that wants a point much, but whose points
  // are taken for hidden again and again.
  [[nodiscard]] bool takes_paths(std::uint8_t wanted) const {
    return is_still() && (wanted < kUrgent || still_frames_ > kUrgentFrames);
  }

  static ShownScene first_shown(std::shared_ptr<const PreparedScene> scene,
                                const EdgePointSettings& settings) {
    auto objects = std::make_shared<const EdgeObjects>(*scene, settings.threads, Creases::drawn,
                                                       settings.stop);
    return {std::move(scene), std::move(objects), std::make_shared<const std::vector<SoftEdge>>()};
  }
  void show(ShownScene next);

  void view_changed() {
    still_frames_ = 0;
    still_since_ = Clock::now();
    still_tracer_.restart();
    ++view_;
    film_.clear();
    tints_.clear();
  }

  void make_frame(const CameraRays& camera) {
    const PixelView view = make_pixel_view(camera, image_);
    const Clock::time_point start = Clock::now();
    if (settings_.use_edges) {
      shown_.objects->find_edges(*shown_.scene, view, settings_.threads, edges_);
    }
    const bool shadows = settings_.use_edges && settings_.shadow_edges;
    if (shadows && !workers_) updater_.find_shadows(shown_);
    EdgeTotals totals = edges_.totals();
    totals.shadow = shown_.shadow_edges->size();
    stats_.stages.edges = milliseconds_since(start);
    FrameSettings frame{.frame = frame_,
                        .complex_filter = settings_.complex_filter,
                        .threads = settings_.threads,
                        .find_tints = {},
                        .edges_are_missing = !settings_.use_edges,
                        .points_may_be_stale = frame_ - changed_ < kFramesOfStale,
                        .stop = settings_.stop};
    if (settings_.sharp_textures) {
      frame.find_tints = [&](const EdgePointImage& image) {
        return tints_.update(*shown_.scene, camera, cache_, image, settings_.threads);
      };
    }
    const FrameReport report =
        maker_.make(view, {edges_.lists(), *shown_.shadow_edges}, cache_, frame, picture_);
    // Points that nobody renews any more are worth less.
    const int paths = stats_.traced_still ? 1 : shader_.paths;
    film_.blend_into(picture_, kNeighbors * float(paths), settings_.threads);
    stats_.stages.total = frame_ms_ = milliseconds_since(start);
    keep_report(report, totals);
  }

  // Before a frame for which no points are known.
  void shade_first(const CameraRays& camera) {
    maker_.forget();
    shade_now(*make_plan(camera, first_density()), false);
    has_points_ = true;
  }

  [[nodiscard]] double first_density() const {
    return settings_.first_density > 0 ? settings_.first_density : settings_.density;
  }
  [[nodiscard]] bool must_end(bool has_picture) const {
    return !workers_ && settings_.must_end && settings_.must_end(has_picture);
  }
  [[nodiscard]] ParallelOptions parallel() const {
    return {.grain = 1, .threads = settings_.threads, .stop = settings_.stop};
  }
  static void throw_stopped() {
    throw Error(Error::Kind::failed, "", "stopped before the first sample");
  }

  [[nodiscard]] bool must_trace_still() const {
    return workers_ && settings_.trace_still_ms > 0 && is_still() &&
           milliseconds_since(still_since_) >= settings_.trace_still_ms;
  }

  // All threads at once get much more done than workers between frames.
  void trace_still(const CameraRays& camera) {
    constexpr double kPieceMs = 250;
    const Clock::time_point start = Clock::now();
    const PixelFilter filter(image_.filter);
    const PathRays rays = still_tracer_.trace(
        {*shown_.scene, camera, filter, shader_, image_.width_px, image_.height_px},
        {kPieceMs, settings_.hurry, settings_.stop, settings_.threads}, film_, stats_.new_points);
    stats_.traced_still = true;
    stats_.rays.total += rays.total;
    stats_.rays.rounded += rays.rounded;
    stats_.shading_seconds += milliseconds_since(start) / 1e3;
  }

  // Paths of the path tracer's sequence, which add up while the view stands still.
  void trace_frame(const CameraRays& camera) {
    const Clock::time_point start = Clock::now();
    const PixelFilter filter(image_.filter);
    const auto paths = std::uint32_t(shader_.paths);
    std::vector<PathRays> rays(std::size_t(image_.height_px));
    std::vector<Rgb> sums(film_size());
    const bool has_picture = film_.least_paths() > 0;
    std::atomic<bool> ended = false;
    parallel_for(rays.size(), parallel(), [&](std::size_t y) {
      if (!ended && must_end(has_picture)) ended = true;
      if (ended) return;
      for (int x = 0; x < image_.width_px; ++x) {
        const std::size_t at = maker_.image().offset(x, int(y));
        sums[at] = shade_pixel(*shown_.scene, camera, filter, shader_,
                               {x, int(y), film_.paths_of(at), paths}, rays[y]);
      }
    });
    if (ended && !has_picture) throw_stopped();
    // All pixels or none, so that the picture is as noisy everywhere.
    if (!ended) {
      for (std::size_t i = 0; i < sums.size(); ++i) film_.add(i, sums[i], paths);
    }
    film_.blend_into(picture_, 0, settings_.threads);
    for (const PathRays& row : rays) {
      stats_.rays.total += row.total;
      stats_.rays.rounded += row.rounded;
    }
    stats_.rays.camera += sums.size() * paths;
    stats_.stages.total = milliseconds_since(start);
    stats_.shading_seconds += stats_.stages.total / 1e3;
    stats_.still_paths = film_.least_paths();
    stats_.points = cache_.size();
    stats_.cache_bytes = cache_.bytes();
    stats_.image_bytes = maker_.image().bytes();
    // The frame itself was on all threads.
    choice_.add({sums.size(), stats_.rays.total, stats_.stages.total / 1e3}, 1);
  }

  // What shows that is wrong or missing is shaded at once, as far as the settings allow.
  [[nodiscard]] double wanted_density() const {
    const double urgent = double(count_urgent(maker_.wanted(), settings_.threads)) / pixel_count();
    return std::max(settings_.density, std::min(urgent, settings_.most_density));
  }
  [[nodiscard]] double planned_density() const {
    const double done = double(last_items_) / pixel_count();
    return std::clamp(kMoreThanDone * done, settings_.density / 8, wanted_density());
  }

  [[nodiscard]] std::shared_ptr<const ShadePlan> make_plan(const CameraRays& camera,
                                                           double density) {
    auto plan = std::make_shared<ShadePlan>();
    plan->scene = shown_.scene;
    if (settings_.use_edges && settings_.shadow_edges) plan->lights = lights_;
    plan->camera = camera;
    plan->filter = PixelFilter(image_.filter);
    plan->shader = shader_;
    plan->width_px = image_.width_px;
    plan->frame = frame_;
    plan->view = view_;
    const auto count = std::size_t(std::lround(density * pixel_count()));
    std::copy(maker_.wanted().begin(), maker_.wanted().end(), wanted_.begin());
    if (is_still()) add_still_wishes();
    want_moved(make_pixel_view(camera, image_), moved_, wanted_);
    moved_.clear();
    for (const std::uint32_t pixel : plan_samples(
             wanted_, {image_.width_px, image_.height_px, count, frame_, settings_.threads})) {
      const PointKey seen = maker_.image().points[pixel];
      ShadePlan::Item item{pixel, seen.is_none() ? kNoPoint : seen.point(), kNoPoint};
      if (takes_paths(maker_.wanted()[pixel])) item.first_path = film_.paths_of(pixel);
      plan->items.push_back(item);
    }
    // Where the plan begins changes, as its end may not be reached.
    if (workers_ && !plan->items.empty()) {
      const std::size_t step = plan->items.size() * (frame_ * 5 % 8) / 8;
      std::rotate(plan->items.begin(), plan->items.begin() + std::ptrdiff_t(step),
                  plan->items.end());
    }
    return plan;
  }

  // Pixels that have what they need of points want paths.
  void add_still_wishes() {
    std::vector<std::uint8_t> wishes(film_size());
    film_.fill_wanted(wishes, settings_.threads);
    for (std::size_t i = 0; i < wanted_.size(); ++i) {
      if (takes_paths(wanted_[i])) wanted_[i] = wishes[i];
    }
  }

  void shade_now(const ShadePlan& plan, bool has_picture) {
    const Clock::time_point start = Clock::now();
    std::vector<ShadeResults> parts((plan.items.size() + ShadePlan::kStep - 1) / ShadePlan::kStep);
    std::atomic<bool> ended = false;
    parallel_for(parts.size(), parallel(), [&](std::size_t part) {
      if (!ended && must_end(has_picture)) ended = true;
      if (ended) return;
      const std::size_t first = part * ShadePlan::kStep;
      const std::size_t last = std::min(plan.items.size(), first + ShadePlan::kStep);
      for (std::size_t i = first; i < last; ++i) shade_item(plan, plan.items[i], parts[part]);
    });
    if (ended && !has_picture) throw_stopped();
    ShadingCost cost;
    for (const ShadeResults& part : parts) {
      take(plan, part);
      cost.items += part.items;
      cost.rays += part.rays.total;
    }
    choice_.add(cost, 1);
    stats_.shading_seconds += milliseconds_since(start) / 1e3;
  }

  void collect() {
    ShadingCost cost;
    std::uint64_t items = 0;
    for (const ShadeWorkers::Batch& batch : workers_->collect()) {
      take(*batch.plan, batch.results);
      items += batch.results.items;
      cost.rays += batch.results.rays.total;
      cost.thread_seconds += batch.results.thread_seconds;
    }
    cost.items = last_items_ = items;
    choice_.add(cost, workers_->thread_count());
  }

  void take(const ShadePlan& plan, const ShadeResults& results) {
    if (plan.scene == shown_.scene) {
      cache_.add(results.points, frame_);
    } else {
      cache_.add(moved_points(*plan.scene, results.points), frame_);
    }
    updater_.add(results.triples);
    if (plan.view == view_) {
      for (const PixelPaths& p : results.pixels) film_.add(p.pixel, p.sum, p.paths);
    }
    stats_.rays.total += results.rays.total;
    stats_.rays.rounded += results.rays.rounded;
    stats_.rays.camera += results.items * std::uint64_t(shader_.paths);
    stats_.new_points += results.items;
  }

  // Points that were shaded in a scene before, where their objects are now. Their light is that of then.
  [[nodiscard]] std::vector<ShadedPoint> moved_points(const PreparedScene& before,
                                                      std::vector<ShadedPoint> points) const {
    const std::vector<Object>&then = before.scene().objects, &now = shown_.scene->scene().objects;
    for (ShadedPoint& point : points) {
      if (point.object >= now.size()) continue;
      const Affine3d &from = then[point.object].world_from_object,
                     &to = now[point.object].world_from_object;
      if (from == to) continue;
      point.position = Vec3f(transform_point(to * inverse(from), Vec3d(point.position)));
    }
    return points;
  }

  void keep_report(const FrameReport& report, const EdgeTotals& totals);

  // Until all that is seen has been shaded anew.
  static constexpr std::uint32_t kFramesOfStale = 256;
  // Pixels that want a point so much get one, also in a view that stands still.
  static constexpr std::uint8_t kUrgent = 128;
  // But only for so many frames.
  static constexpr std::uint32_t kUrgentFrames = 32;

  EdgePointSettings settings_;
  ShownScene shown_;
  PointShader shader_;
  ImageSettings image_;
  Camera camera_;
  SceneUpdater updater_;
  std::shared_ptr<const std::vector<ShadowLight>> lights_;
  PointCache cache_;
  FrameMaker maker_;
  FoundEdges edges_;
  Image picture_;
  TextureTints tints_;
  StillFilm film_;
  StillTracer still_tracer_;
  Clock::time_point still_since_ = Clock::now();
  std::vector<std::uint8_t> wanted_;
  std::vector<Sphere> moved_;  // where objects were and are that have moved since the last plan
  TraceChoice choice_;
  EdgePointStats stats_;
  std::uint32_t frame_ = 0;
  std::uint32_t changed_ = ~kFramesOfStale;  // the frame before which the scene has changed last
  std::uint32_t still_frames_ = 0;
  std::uint64_t view_ = 0;
  std::uint64_t last_items_ = 0;
  double frame_ms_ = 0;      // of the last one of edges and points
  bool has_points_ = false;  // of the last frame
  bool camera_checked_ = true;
  std::unique_ptr<ShadeWorkers> workers_;  // null: synchronous
};

void EdgePointEngine::Impl::keep_report(const FrameReport& report, const EdgeTotals& totals) {
  EdgePointStats::Stages& stages = stats_.stages;
  stages.points = report.times.points;
  stages.raster = report.times.raster;
  stages.classify = report.times.classify;
  stages.reachability = report.times.reachability;
  stages.textures = report.times.textures;
  stages.interpolation = report.times.interpolation;
  stages.antialias = report.times.antialias;
  stages.complex = report.times.complex;
  stats_.classes = {report.classes.empty, report.classes.simple, report.classes.complex};
  stats_.edges = {totals.silhouette, totals.sharp, totals.shadow};
  stats_.points = cache_.size();
  stats_.hidden = report.hidden;
  stats_.unresolved = report.unresolved;
  stats_.still_paths = film_.least_paths();
  stats_.cache_bytes = cache_.bytes();
  stats_.image_bytes = maker_.image().bytes();
}

void EdgePointEngine::Impl::show(ShownScene next) {
  std::swap(shown_, next);
  if (next.scene == shown_.scene) return;
  const Scene &before = next.scene->scene(), &after = shown_.scene->scene();
  const std::size_t moved_before = moved_.size();
  std::vector<std::optional<Affine3d>> to_from(after.objects.size());
  for (std::uint32_t i = 0; i < after.objects.size(); ++i) {
    const Affine3d &from = before.objects[i].world_from_object,
                   &to = after.objects[i].world_from_object;
    if (from == to) continue;
    to_from[i] = to * inverse(from);
    moved_.push_back(shown_.objects->bounding_sphere(*next.scene, i));
    moved_.push_back(shown_.objects->bounding_sphere(*shown_.scene, i));
  }
  if (const std::span moved = std::span(moved_).subspan(moved_before); !moved.empty()) {
    cache_.move(to_from);
    make_shadowed_stale(*lights_, moved, cache_);
  }
  if (shown_.objects->is_rounded_anew(*next.scene, *shown_.scene)) cache_.make_stale(kMovedStale);
  const LightChanges changes = find_changed_lights(before, after);
  if (changes.amount > 0) cache_.make_stale(stale_by_light(changes.amount));
  lights_ = std::make_shared<const std::vector<ShadowLight>>(shadow_lights(*shown_.scene));
  changed_ = frame_;
  updater_.retire(std::move(next.scene));
  view_changed();
}

Image EdgePointEngine::Impl::classes_picture() const {
  Image out(image_.width_px, image_.height_px, 3);
  if (stats_.traced) return out;
  const EdgePointImage& image = maker_.image();
  for (std::size_t i = 0; i < image.codes.size(); ++i) {
    const PixelCode code = image.codes[i];
    const bool has_point = !image.points[i].is_none();
    const float bright = has_point ? 1.0F : 0.4F, dim = has_point ? 0.15F : 0.0F;
    out.values[3 * i] = code.is_complex() ? bright : dim;
    // Blue alone is dark: with some green it is seen on dark parts, too.
    out.values[3 * i + 1] = code.is_simple() ? 0.45F * bright : dim;
    out.values[3 * i + 2] = code.is_simple() ? bright : dim;
  }
  return out;
}

EdgePointEngine::EdgePointEngine(std::shared_ptr<const PreparedScene> scene,
                                 const EdgePointSettings& settings)
    : impl_(std::make_unique<Impl>(std::move(scene), settings)) {}
EdgePointEngine::~EdgePointEngine() = default;

void EdgePointEngine::set_camera(const Camera& camera) {
  impl_->set_camera(camera);
}
void EdgePointEngine::move_object(std::uint32_t object, const Affine3d& world_from_object) {
  impl_->changes().objects[object] = world_from_object;
}
void EdgePointEngine::set_light(std::uint32_t light, const Light& value) {
  impl_->changes().lights[light] = value;
}
void EdgePointEngine::set_rounding(const RoundingSettings& settings) {
  impl_->changes().rounding = settings;
}
const std::shared_ptr<const PreparedScene>& EdgePointEngine::scene() const {
  return impl_->scene();
}
void EdgePointEngine::set_scene(std::shared_ptr<const PreparedScene> scene) {
  impl_->set_scene(std::move(scene));
}
const Image& EdgePointEngine::next_frame() {
  return impl_->next_frame();
}
const EdgePointStats& EdgePointEngine::stats() const {
  return impl_->stats();
}
Image EdgePointEngine::classes_picture() const {
  return impl_->classes_picture();
}

}  // namespace arris
