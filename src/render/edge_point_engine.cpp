// edge_point_engine.cpp — EdgePointEngine: what is behind its public face
#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "arris/edge_point.h"
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

namespace arris {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// Points are kept for what has left the picture, too.
constexpr double kCachePerPixel = 1.5;
// Of shadows, in one frame: about 50 ms.
constexpr std::size_t kShadowEvents = 20'000;
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

}  // namespace

class EdgePointEngine::Impl {
 public:
  Impl(std::shared_ptr<const PreparedScene> scene, const EdgePointSettings& settings)
      : scene_(std::move(scene)),
        settings_(settings),
        shader_(make_point_shader(settings)),
        image_(scene_->scene().image),
        camera_(*scene_->scene().camera),
        objects_(*scene_, settings.threads),
        updater_(settings.synchronous ? UpdateMode::at_once : UpdateMode::beside, settings.threads),
        lights_(std::make_shared<const std::vector<ShadowLight>>(shadow_lights(*scene_))),
        cache_(std::size_t(std::ceil(kCachePerPixel * pixel_count()))),
        maker_(image_.width_px, image_.height_px),
        picture_(image_.width_px, image_.height_px, 3),
        film_(maker_.image().codes.size()),
        wanted_(film_size(), 255) {
    if (!settings.synchronous) workers_ = std::make_unique<ShadeWorkers>(settings.threads);
  }

  void set_camera(const Camera& camera) {
    if (is_same(camera, camera_)) return;
    camera_ = camera;
    view_changed();
  }

  void set_scene(std::shared_ptr<const PreparedScene> scene);
  [[nodiscard]] SceneChanges& changes() { return updater_.changes(); }
  [[nodiscard]] const std::shared_ptr<const PreparedScene>& scene() const { return scene_; }

  const Image& next_frame() {
    if (workers_) workers_->set_paused(true);
    stats_ = {};
    if (std::shared_ptr<const PreparedScene> changed = updater_.poll(scene_)) {
      set_scene(std::move(changed));
    }
    const CameraRays rays = make_camera_rays(camera_, image_);
    if (workers_) {
      collect();
    } else if (frame_ == 0) {
      shade_now(*make_plan(rays, std::max(settings_.first_density, settings_.density)));
    }
    make_frame(make_pixel_view(rays, image_));
    ++frame_;
    ++still_frames_;
    if (workers_) {
      workers_->set_plan(make_plan(rays, planned_density()));
      workers_->set_paused(false);
    } else {
      shade_now(*make_plan(rays, settings_.density));
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

  void view_changed() {
    still_frames_ = 0;
    ++view_;
    film_.clear();
  }

  void make_frame(const PixelView& view) {
    const Clock::time_point start = Clock::now();
    EdgeTotals totals;
    std::vector<std::vector<WorldEdge>> found;
    if (settings_.use_edges) found = objects_.find_edges(*scene_, view, settings_.threads, totals);
    std::vector<std::span<const WorldEdge>> edges(found.begin(), found.end());
    if (settings_.use_edges && settings_.shadow_edges) {
      shadows_.update(*scene_, objects_, kShadowEvents);
      edges.emplace_back(shadows_.edges());
      totals.shadow = shadows_.edges().size();
    }
    stats_.stages.edges = milliseconds_since(start);
    const FrameReport report = maker_.make(
        view, edges, cache_, {frame_, settings_.complex_filter, settings_.threads}, picture_);
    film_.blend_into(picture_, kNeighbors * float(shader_.paths), settings_.threads);
    stats_.stages.total = milliseconds_since(start);
    keep_report(report, totals);
  }

  [[nodiscard]] double planned_density() const {
    const double done = double(last_items_) / pixel_count();
    return std::clamp(kMoreThanDone * done, settings_.density / 8, settings_.density);
  }

  [[nodiscard]] std::shared_ptr<const ShadePlan> make_plan(const CameraRays& camera,
                                                           double density) {
    auto plan = std::make_shared<ShadePlan>();
    plan->scene = scene_;
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
    for (const std::uint32_t pixel :
         plan_samples(wanted_, {image_.width_px, image_.height_px, count, frame_})) {
      const PointKey seen = maker_.image().points[pixel];
      ShadePlan::Item item{pixel, seen.is_none() ? kNoPoint : seen.point(), kNoPoint};
      if (is_still() && maker_.wanted()[pixel] < kUrgent) item.first_path = film_.paths_of(pixel);
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
      if (wanted_[i] < kUrgent) wanted_[i] = wishes[i];
    }
  }

  void shade_now(const ShadePlan& plan) {
    const Clock::time_point start = Clock::now();
    std::vector<ShadeResults> parts((plan.items.size() + ShadePlan::kStep - 1) / ShadePlan::kStep);
    parallel_for(parts.size(), {.grain = 1, .threads = settings_.threads}, [&](std::size_t part) {
      const std::size_t first = part * ShadePlan::kStep;
      const std::size_t last = std::min(plan.items.size(), first + ShadePlan::kStep);
      for (std::size_t i = first; i < last; ++i) shade_item(plan, plan.items[i], parts[part]);
    });
    for (const ShadeResults& part : parts) take(plan, part);
    stats_.shading_seconds += milliseconds_since(start) / 1e3;
  }

  void collect() {
    std::uint64_t items = 0;
    for (const ShadeWorkers::Batch& batch : workers_->collect()) {
      take(*batch.plan, batch.results);
      items += batch.results.items;
    }
    last_items_ = items;
  }

  void take(const ShadePlan& plan, const ShadeResults& results) {
    if (plan.scene == scene_) {
      cache_.add(results.points, frame_);
    } else {
      cache_.add(moved_points(*plan.scene, results.points), frame_);
    }
    shadows_.add(results.triples);
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
    const std::vector<Object>&then = before.scene().objects, &now = scene_->scene().objects;
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

  // Pixels that want a point so much get one, also in a view that stands still.
  static constexpr std::uint8_t kUrgent = 128;

  std::shared_ptr<const PreparedScene> scene_;
  EdgePointSettings settings_;
  PointShader shader_;
  ImageSettings image_;
  Camera camera_;
  EdgeObjects objects_;
  SceneUpdater updater_;
  ShadowFinder shadows_;
  std::shared_ptr<const std::vector<ShadowLight>> lights_;
  PointCache cache_;
  FrameMaker maker_;
  Image picture_;
  StillFilm film_;
  std::vector<std::uint8_t> wanted_;
  EdgePointStats stats_;
  std::uint32_t frame_ = 0;
  std::uint32_t still_frames_ = 0;
  std::uint64_t view_ = 0;
  std::uint64_t last_items_ = 0;
  std::unique_ptr<ShadeWorkers> workers_;  // null: synchronous
};

void EdgePointEngine::Impl::keep_report(const FrameReport& report, const EdgeTotals& totals) {
  EdgePointStats::Stages& stages = stats_.stages;
  stages.points = report.times.points;
  stages.raster = report.times.raster;
  stages.classify = report.times.classify;
  stages.reachability = report.times.reachability;
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

void EdgePointEngine::Impl::set_scene(std::shared_ptr<const PreparedScene> scene) {
  if (scene == scene_) return;
  const Scene &before = scene_->scene(), &after = scene->scene();
  std::vector<Sphere> moved;
  std::vector<std::optional<Affine3d>> to_from(after.objects.size());
  for (std::uint32_t i = 0; i < after.objects.size(); ++i) {
    const Affine3d &from = before.objects[i].world_from_object,
                   &to = after.objects[i].world_from_object;
    if (from == to) continue;
    to_from[i] = to * inverse(from);
    shadows_.object_moved(i);
    moved.push_back(objects_.bounding_sphere(*scene_, i));
    moved.push_back(objects_.bounding_sphere(*scene, i));
  }
  if (!moved.empty()) {
    cache_.move(to_from, frame_);
    make_shadowed_old(*lights_, moved, frame_, cache_);
  }
  const bool rounded_anew = objects_.update_roundings(*scene_, *scene);
  auto lights = std::make_shared<const std::vector<ShadowLight>>(shadow_lights(*scene));
  const bool lights_changed = find_changed_lights(before, after, shadows_);
  if (rounded_anew || lights_changed) {
    const auto all = [](auto...) { return true; };
    cache_.make_old(frame_, all, all);
  }
  if (rounded_anew) shadows_.all_changed();
  lights_ = std::move(lights);
  scene_ = std::move(scene);
  view_changed();
}

Image EdgePointEngine::Impl::classes_picture() const {
  Image out(image_.width_px, image_.height_px, 3);
  const EdgePointImage& image = maker_.image();
  for (std::size_t i = 0; i < image.codes.size(); ++i) {
    const PixelCode code = image.codes[i];
    const bool has_point = !image.points[i].is_none();
    const float bright = has_point ? 1.0F : 0.4F, dim = has_point ? 0.15F : 0.0F;
    out.values[3 * i] = code.is_complex() ? bright : dim;
    out.values[3 * i + 1] = dim;
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
