#include "edge_point/flight.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <utility>

#include "base/parallel_for.h"
#include "image/compare.h"
#include "image/srgb.h"
#include "render/point_shader.h"

namespace arris::bench {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

std::shared_ptr<const PreparedScene> prepare(const FlightScene& flight,
                                             const FlightOptions& options) {
  Scene scene = flight.scene;
  scene.image.width_px = options.width_px;
  scene.image.height_px = options.height_px;
  scene.image.filter = ImageSettings::Filter::box;
  return prepare_scene(std::move(scene));
}

EdgePointSettings settings_for(const FlightScene& flight, const FlightOptions& options) {
  EdgePointSettings settings;
  settings.synchronous = true;
  settings.shader = flight.shader;
  settings.density = options.density;
  return settings;
}

// Of every pixel, from every 64th.
double full_shading_ms(const PreparedScene& scene, const PointShader& shader,
                       const Camera& camera) {
  constexpr int kStep = 8;
  const ImageSettings& image = scene.scene().image;
  const CameraRays rays = make_camera_rays(camera, image);
  const int columns = image.width_px / kStep, rows = image.height_px / kStep;
  std::vector<PathRays> counts(static_cast<std::size_t>(rows));
  const Clock::time_point start = Clock::now();
  parallel_for(counts.size(), {.grain = 1, .threads = 0}, [&](std::size_t row) {
    for (int i = 0; i < columns; ++i) {
      shade_point(scene, rays, shader, {i * kStep + kStep / 2, int(row) * kStep + kStep / 2, 0},
                  counts[row]);
    }
  });
  return milliseconds_since(start) * double(image.width_px) * image.height_px /
         (double(columns) * rows);
}

EdgePointStats median_of(const std::vector<EdgePointStats>& frames) {
  EdgePointStats out = frames.back();
  const auto of = [&](const auto& value) {
    std::vector<double> values;
    for (const EdgePointStats& frame : frames) values.push_back(double(value(frame)));
    return median(values);
  };
  using S = EdgePointStats;
  out.stages.edges = of([](const S& s) { return s.stages.edges; });
  out.stages.raster = of([](const S& s) { return s.stages.raster; });
  out.stages.points = of([](const S& s) { return s.stages.points; });
  out.stages.classify = of([](const S& s) { return s.stages.classify; });
  out.stages.reachability = of([](const S& s) { return s.stages.reachability; });
  out.stages.interpolation = of([](const S& s) { return s.stages.interpolation; });
  out.stages.antialias = of([](const S& s) { return s.stages.antialias; });
  out.stages.complex = of([](const S& s) { return s.stages.complex; });
  out.stages.total = of([](const S& s) { return s.stages.total; });
  out.new_points = std::uint64_t(of([](const S& s) { return s.new_points; }));
  return out;
}

// Two pictures with noise of their own.
struct Reference {
  std::array<Image, 2> halves;
  Image mean;
};

Image reference_half(const FlightScene& flight, const std::shared_ptr<const PreparedScene>& scene,
                     const Camera& camera, std::uint32_t paths, std::uint32_t seed) {
  const ImageSettings& image = scene->scene().image;
  const CameraRays rays = make_camera_rays(camera, image);
  const PixelFilter filter(image.filter);
  PointShader shader;
  shader.kind = flight.shader;
  shader.seed = seed;
  Image out(image.width_px, image.height_px, 3);
  parallel_for(
      static_cast<std::size_t>(image.height_px), {.grain = 1, .threads = 0}, [&](std::size_t y) {
        PathRays counts;
        for (int x = 0; x < image.width_px; ++x) {
          const Rgb sum = shade_pixel(*scene, rays, filter, shader, {x, int(y), 0, paths}, counts);
          const std::size_t at = out.offset(x, int(y));
          for (int c = 0; c < 3; ++c) out.values[at + std::size_t(c)] = sum[c] / float(paths);
        }
      });
  return out;
}

Reference reference_of(const FlightScene& flight, const std::shared_ptr<const PreparedScene>& scene,
                       const Camera& camera, std::uint32_t paths) {
  // Other paths than those that are judged.
  constexpr std::uint32_t kSeed = 77;
  Reference r{{reference_half(flight, scene, camera, paths, kSeed),
               reference_half(flight, scene, camera, paths, kSeed + 1)},
              {}};
  r.mean = r.halves[0];
  for (std::size_t i = 0; i < r.mean.values.size(); ++i) {
    r.mean.values[i] = (r.halves[0].values[i] + r.halves[1].values[i]) / 2;
  }
  return r;
}

// Of display values.
double rmse_against(const Image& picture, const Reference& reference) {
  const auto shown = [](float v) { return double(srgb_from_linear(std::clamp(v, 0.0F, 1.0F))); };
  double sum = 0;
  for (std::size_t i = 0; i < picture.values.size(); ++i) {
    const double p = shown(picture.values[i]);
    sum += (p - shown(reference.halves[0].values[i])) * (p - shown(reference.halves[1].values[i]));
  }
  return std::sqrt(std::max(0.0, sum / double(picture.values.size())));
}

// A picture of one path for each pixel of a grid so coarse that it costs as much as the points of a frame.
Image noisy_picture(const FlightScene& flight, const std::shared_ptr<const PreparedScene>& scene,
                    const Camera& camera, double paths_per_pixel) {
  const ImageSettings& image = scene->scene().image;
  const CameraRays rays = make_camera_rays(camera, image);
  const PixelFilter filter(image.filter);
  PointShader shader;
  shader.kind = flight.shader;
  const int step = std::max(1, int(std::lround(std::sqrt(1 / paths_per_pixel))));
  const auto count = std::uint32_t(std::max(1.0, paths_per_pixel));
  Image out(image.width_px, image.height_px, 3);
  PathRays counts;
  for (int y = 0; y < image.height_px; ++y) {
    for (int x = 0; x < image.width_px; ++x) {
      const std::size_t at = out.offset(x, y);
      const int from_x = x / step * step, from_y = y / step * step;
      if (from_x != x || from_y != y) {
        const std::size_t from = out.offset(from_x, from_y);
        for (std::size_t c = 0; c < 3; ++c) out.values[at + c] = out.values[from + c];
        continue;
      }
      const int in_x = std::min(x + step / 2, image.width_px - 1);
      const int in_y = std::min(y + step / 2, image.height_px - 1);
      const Rgb sum = shade_pixel(*scene, rays, filter, shader, {in_x, in_y, 0, count}, counts);
      for (int c = 0; c < 3; ++c) out.values[at + std::size_t(c)] = sum[c] / float(count);
    }
  }
  return out;
}

struct Errors {
  std::vector<double> rmse, flip;

  void add(const Image& picture, const Reference& reference) {
    rmse.push_back(rmse_against(picture, reference));
    flip.push_back(compare_images(picture, reference.mean, ValueEncoding::srgb).flip);
  }
  [[nodiscard]] static double mean(const std::vector<double>& values) {
    double sum = 0;
    for (const double v : values) sum += v;
    return values.empty() ? 0 : sum / double(values.size());
  }
};

}  // namespace

FrameCosts measure_frames(const FlightScene& flight, const FlightOptions& options) {
  FrameCosts costs;
  Clock::time_point start = Clock::now();
  const auto scene = prepare(flight, options);
  costs.prepare_ms = milliseconds_since(start);
  costs.triangles = prepare_stats(*scene).triangles;
  const EdgePointSettings settings = settings_for(flight, options);
  start = Clock::now();
  EdgePointEngine engine(scene, settings);
  costs.engine_ms = milliseconds_since(start);
  std::vector<EdgePointStats> frames;
  std::vector<double> shading;
  for (int i = 0; i <= options.frames; ++i) {
    engine.set_camera(flight_camera(flight, i));
    engine.next_frame();
    if (i == 0) continue;  // it has the first points
    frames.push_back(engine.stats());
    shading.push_back(1000 * engine.stats().shading_seconds);
    costs.longest_ms = std::max(costs.longest_ms, engine.stats().stages.total);
  }
  costs.median = median_of(frames);
  costs.shading_ms = median(shading);
  costs.full_ms =
      full_shading_ms(*scene, make_point_shader(settings), flight_camera(flight, options.frames));
  return costs;
}

FlightErrors measure_quality(const FlightScene& flight, const QualityOptions& options) {
  const auto scene = prepare(flight, options.flight);
  Errors with, without, noisy;
  for (const bool edges : {true, false}) {
    EdgePointSettings settings = settings_for(flight, options.flight);
    settings.use_edges = edges;
    EdgePointEngine engine(scene, settings);
    for (int i = 1; i <= options.flight.frames; ++i) {
      const Camera camera = flight_camera(flight, i);
      engine.set_camera(camera);
      const Image& picture = engine.next_frame();
      if (i % (options.flight.frames / options.pictures) != 0) continue;
      const Reference reference = reference_of(flight, scene, camera, options.reference_paths);
      (edges ? with : without).add(picture, reference);
      if (!edges) continue;
      const double paths = options.flight.density * make_point_shader(settings).paths;
      noisy.add(noisy_picture(flight, scene, camera, paths), reference);
    }
  }
  return {Errors::mean(with.rmse), Errors::mean(without.rmse), Errors::mean(noisy.rmse),
          Errors::mean(with.flip), Errors::mean(without.flip), Errors::mean(noisy.flip)};
}

FlightErrors measure_ablation(const FlightScene& flight, const QualityOptions& options) {
  const auto scene = prepare(flight, options.flight);
  const Camera camera = flight_camera(flight, 0);
  const Reference reference = reference_of(flight, scene, camera, options.reference_paths);
  Errors with, without;
  for (const bool edges : {true, false}) {
    EdgePointSettings settings = settings_for(flight, options.flight);
    settings.use_edges = edges;
    settings.first_density = 0.2;
    settings.density = 1e-3;
    settings.paths_per_point = options.point_paths;
    EdgePointEngine engine(scene, settings);
    // What casts shadows is known once the first points are there.
    engine.next_frame();
    (edges ? with : without).add(engine.next_frame(), reference);
  }
  return {with.rmse[0], without.rmse[0], 0, with.flip[0], without.flip[0], 0};
}

}  // namespace arris::bench
