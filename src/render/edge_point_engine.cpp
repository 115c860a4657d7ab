// edge_point_engine.cpp — EdgePointEngine: what is behind its public face
#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "arris/edge_point.h"
#include "base/parallel_for.h"
#include "base/sobol.h"
#include "edgepoint/frame_maker.h"
#include "edgepoint/sample_plan.h"
#include "render/edge_objects.h"
#include "render/point_shader.h"
#include "render/shadow_finder.h"
#include "render/shadow_probe.h"

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
constexpr std::uint32_t kProbeSeed = 0x5bd1e995;

PixelView make_pixel_view(const CameraRays& camera, const ImageSettings& image) {
  return {Vec3d(camera.position), inverse(Mat3d{camera.step_x, camera.step_y, camera.corner}),
          image.width_px, image.height_px};
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
        lights_(shadow_lights(*scene_)),
        cache_(std::size_t(std::ceil(kCachePerPixel * pixel_count()))),
        maker_(image_.width_px, image_.height_px),
        picture_(image_.width_px, image_.height_px, 3) {}

  void set_camera(const Camera& camera) { camera_ = camera; }

  const Image& next_frame() {
    stats_ = {};
    const CameraRays rays = make_camera_rays(camera_, image_);
    if (frame_ == 0) shade(rays, std::max(settings_.first_density, settings_.density));
    const Clock::time_point start = Clock::now();
    const PixelView view = make_pixel_view(rays, image_);
    EdgeTotals totals;
    std::vector<WorldEdge> edges;
    if (settings_.use_edges) {
      edges = objects_.find_edges(*scene_, view, settings_.threads, totals);
    }
    if (settings_.use_edges && settings_.shadow_edges) {
      shadows_.update(*scene_, objects_, kShadowEvents);
      edges.insert(edges.end(), shadows_.edges().begin(), shadows_.edges().end());
      totals.shadow = shadows_.edges().size();
    }
    stats_.stages.edges = milliseconds_since(start);
    const FrameReport report = maker_.make(
        view, edges, cache_, {frame_, settings_.complex_filter, settings_.threads}, picture_);
    stats_.stages.total = milliseconds_since(start);
    keep_report(report, totals);
    shade(rays, settings_.density);
    ++frame_;
    return picture_;
  }

  [[nodiscard]] const EdgePointStats& stats() const { return stats_; }

  [[nodiscard]] Image classes_picture() const {
    Image out(image_.width_px, image_.height_px, 3);
    const EdgePointImage& image = maker_.image();
    for (std::size_t i = 0; i < image.codes.size(); ++i) {
      const PixelCode code = image.codes[i];
      const bool has_point = !image.points[i].is_none();
      const float bright = has_point ? 1.0F : 0.4F;
      out.values[3 * i] = code.is_complex() ? bright : has_point ? 0.15F : 0.0F;
      out.values[3 * i + 1] = has_point ? 0.15F : 0.0F;
      out.values[3 * i + 2] = code.is_simple() ? bright : has_point ? 0.15F : 0.0F;
    }
    return out;
  }

 private:
  [[nodiscard]] double pixel_count() const {
    return double(image_.width_px) * double(image_.height_px);
  }

  void shade(const CameraRays& camera, double density) {
    const Clock::time_point start = Clock::now();
    const std::vector<std::uint32_t> plan =
        plan_samples(maker_.wanted(), {image_.width_px, image_.height_px,
                                       std::size_t(std::lround(density * pixel_count())), frame_});
    constexpr std::size_t kChunk = 16;
    std::vector<ShadedPoint> points(plan.size());
    std::vector<std::optional<ShadowTriple>> triples(plan.size());
    std::vector<PathRays> rays((plan.size() + kChunk - 1) / kChunk);
    parallel_for(rays.size(), {.grain = 1, .threads = settings_.threads}, [&](std::size_t chunk) {
      const std::size_t last = std::min(plan.size(), (chunk + 1) * kChunk);
      for (std::size_t i = chunk * kChunk; i < last; ++i) {
        const int x = int(plan[i] % std::uint32_t(image_.width_px));
        const int y = int(plan[i] / std::uint32_t(image_.width_px));
        points[i] = shade_point(*scene_, camera, shader_, {x, y, frame_}, rays[chunk]);
        if (settings_.use_edges && points[i].object != kFarObject) {
          triples[i] = probe_shadow(*scene_, lights_, make_probe(camera, x, y));
        }
      }
    });
    cache_.add(points, frame_);
    for (const std::optional<ShadowTriple>& triple : triples) {
      if (triple) shadows_.add({&*triple, 1});
    }
    for (const PathRays& r : rays) {
      stats_.rays.total += r.total;
      stats_.rays.rounded += r.rounded;
    }
    stats_.rays.camera += plan.size() * std::size_t(shader_.paths);
    stats_.new_points += plan.size();
    stats_.shading_seconds += milliseconds_since(start) / 1e3;
  }

  [[nodiscard]] ShadowProbe make_probe(const CameraRays& camera, int x, int y) const {
    Sampler sampler(settings_.seed ^ kProbeSeed, std::uint32_t(x), std::uint32_t(y), frame_);
    ShadowProbe probe;
    probe.camera_ray = camera_ray(camera, x + 0.5, y + 0.5);
    probe.select = sampler.next_1d();
    probe.place = sampler.next_2d();
    return probe;
  }

  void keep_report(const FrameReport& report, const EdgeTotals& totals) {
    EdgePointStats::Stages& stages = stats_.stages;
    stages.points = report.times.points;
    stages.raster = report.times.raster;
    stages.reachability = report.times.reachability;
    stages.interpolation = report.times.interpolation;
    stages.antialias = report.times.antialias;
    stages.complex = report.times.complex;
    stats_.classes = {report.classes.empty, report.classes.simple, report.classes.complex};
    stats_.edges = {totals.silhouette, totals.sharp, totals.shadow};
    stats_.points = cache_.size();
    stats_.unresolved = report.unresolved;
    stats_.cache_bytes = cache_.bytes();
  }

  std::shared_ptr<const PreparedScene> scene_;
  EdgePointSettings settings_;
  PointShader shader_;
  ImageSettings image_;
  Camera camera_;
  EdgeObjects objects_;
  ShadowFinder shadows_;
  std::vector<ShadowLight> lights_;
  PointCache cache_;
  FrameMaker maker_;
  Image picture_;
  EdgePointStats stats_;
  std::uint32_t frame_ = 0;
};

EdgePointEngine::EdgePointEngine(std::shared_ptr<const PreparedScene> scene,
                                 const EdgePointSettings& settings)
    : impl_(std::make_unique<Impl>(std::move(scene), settings)) {}
EdgePointEngine::~EdgePointEngine() = default;

void EdgePointEngine::set_camera(const Camera& camera) {
  impl_->set_camera(camera);
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
