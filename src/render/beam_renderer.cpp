#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <mutex>

#include "base/check.h"
#include "base/flush_denormals.h"
#include "base/parallel_for.h"
#include "beam/beam_tracer.h"
#include "beam/corner_tracer.h"
#include "image/picture_sum.h"
#include "render/beam_shading.h"
#include "render/camera.h"

namespace arris {
namespace {

constexpr const char* kCoverageLo = "coverage_lo";
constexpr const char* kCoverageHi = "coverage_hi";
constexpr const char* kUncertified = "uncertified";
constexpr const char* kRegions = "regions";

// What all tiles share.
struct Job {
  const BeamScene& scene;
  const RenderOptions& options;
  PathSettings settings;
  std::vector<BeamLight> lights;
  bool knows_area_lights = false;  // they are among `lights`
  bool needs_paths = false;        // there is other light
};

EyeRays make_eye(const Scene& scene) {
  const CameraRays rays = make_camera_rays(*scene.camera, scene.image);
  return {Vec3d(rays.position), rays.corner, rays.step_x, rays.step_y};
}

// In the order of `lights`. None where translucent surfaces make shadows of more than two kinds.
std::vector<LightPlace> make_light_places(const SceneGeometry& geometry,
                                          const std::vector<BeamLight>& lights) {
  std::vector<LightPlace> places;
  if (geometry.any_translucent) return places;
  for (const BeamLight& light : lights) places.push_back(place_of(geometry.lights, light));
  return places;
}

// Anything that lights a surface besides the lights that are added up, or shows behind it.
bool needs_paths(const SceneGeometry& geometry, const PathSettings& settings,
                 bool knows_area_lights) {
  const LightSet& lights = geometry.lights;
  const bool other_lights = std::ranges::any_of(lights.emitters, [&](const Emitter& e) {
    if (e.kind != EmitterKind::rectangle) {
      return e.kind == EmitterKind::triangle || e.kind == EmitterKind::environment ||
             e.kind == EmitterKind::sun;
    }
    return !knows_area_lights || lights.rectangles[e.index].visible_to_camera;
  });
  const bool backdrop = lights.environment->kind != EnvironmentKind::constant ||
                        max_component(lights.environment->constant) > 0;
  const bool emits =
      std::ranges::any_of(geometry.materials, [](const PreparedMaterial& m) { return m.emissive; });
  return other_lights || backdrop || emits || geometry.any_translucent || settings.max_depth > 1;
}

// Samples of a surface that takes `share` of a pixel.
std::uint32_t sample_count(const Job& job, double share) {
  const std::uint32_t all = job.options.samples.last - job.options.samples.first;
  return std::max<std::uint32_t>(1, std::uint32_t(std::lround(all * share)));
}

// Direct light of a surface: of the point that stands for it, or of several where it is curved.
Rgb shade_directly(const Job& job, const PixelSurface& surface, const MirroredSight& first,
                   PathRays& rays) {
  if (int(surface.mirrors.size()) >= std::max(1, job.settings.max_depth)) return {};
  const auto shade_at = [&](const MirroredSight& at) {
    return at.throughput * direct_light(job.scene.scene(), job.lights, at.sight, surface, rays);
  };
  if (surface.samples.size() < 2) return shade_at(first);
  Rgb sum;
  double weight = 0;
  for (const AreaSample& sample : surface.samples) {
    sum += shade_at(make_sight(job.scene, surface, sample.at)) * float(sample.weight);
    weight += sample.weight;
  }
  return sum * float(1 / weight);
}

// Where a path of the surface starts: anywhere in the pixel that it fills, else at one of its samples.
Vec2d path_start(const BeamPixel& pixel, const PixelSurface& surface, std::uint32_t i,
                 Sampler& sampler) {
  const Vec2f u = sampler.next_2d();
  if (surface.lo > 1 - 1e-9) return {pixel.x + double(u.x), pixel.y + double(u.y)};
  if (surface.samples.empty()) return surface.sample;
  return surface.samples[i % surface.samples.size()].at;
}

Rgb shade(const Job& job, const BeamPixel& pixel, const PixelSurface& surface,
          std::uint32_t& sample, PathRays& rays) {
  const Rgb direct =
      shade_directly(job, surface, make_sight(job.scene, surface, surface.sample), rays);
  if (!job.needs_paths) return direct;
  Rgb other;
  const std::uint32_t count = sample_count(job, surface.estimate);
  for (std::uint32_t i = 0; i < count; ++i) {
    Sampler sampler(job.options.seed, std::uint32_t(pixel.x), std::uint32_t(pixel.y),
                    job.options.samples.first + sample++);
    const Vec2d at = path_start(pixel, surface, i, sampler);
    MirroredSight start = make_sight(job.scene, surface, at);
    start.sight.knows_area_lights = job.knows_area_lights;
    other +=
        start.throughput *
        trace_known_sight(job.scene.scene(), job.settings, start.sight, sampler, rays).radiance;
    for (const SideRay& side : start.side_rays) {
      other += side.throughput *
               trace_side_ray(job.scene.scene(), job.settings, side.ray, side.depth, sampler, rays);
    }
  }
  return direct + other * (1.0F / float(count));
}

// Blue for large regions, green for pixels, red for what was cut as far as it goes, white where that was not enough;
// darker where regions begin: the paper's Image 2.
Rgb region_color(const BeamPixel& pixel) {
  if (!pixel.certified) return Rgb(1.0F);
  constexpr double kLevels = 4;  // from a tile to a pixel
  const double level = std::log2(1 / pixel.region_side);
  const auto deep = float(std::clamp(level / 6, 0.0, 1.0));
  const auto wide = float(std::clamp(-level / kLevels, 0.0, 1.0));
  const Rgb color = level > 0 ? Rgb{deep, 1 - deep, 0} : Rgb{0, 1 - wide, wide};
  return color * (pixel.begins_region ? 0.4F : 0.8F);
}

// Where the pictures of the layers that were asked for are.
struct Layers {
  Picture picture;

  void set(const BeamPixel& pixel, Rgb color) {
    for (int c = 0; c < 3; ++c) picture.color.at(pixel.x, pixel.y, c) = color[c];
    for (Layer& layer : picture.layers) {
      if (layer.name == kRegions) {
        const Rgb shown = region_color(pixel);
        for (int c = 0; c < 3; ++c) layer.image.at(pixel.x, pixel.y, c) = shown[c];
        continue;
      }
      const double value = layer.name == kCoverageLo   ? pixel.coverage_lo
                           : layer.name == kCoverageHi ? pixel.coverage_hi
                                                       : (pixel.certified ? 0 : 1);
      layer.image.at(pixel.x, pixel.y, 0) = float(value);
    }
  }
};

struct TileCounts {
  BeamStats beam;
  PathRays paths;
};

template <class Tracer>
TileCounts render_tile(const Job& job, const Tracer& tracer, const BeamTile& tile, Layers& layers) {
  TileCounts counts;
  counts.beam = tracer.trace_tile(tile, [&](const BeamPixel& pixel) {
    const FlushDenormals flush;
    Rgb color;
    std::uint32_t sample = 0;
    for (const PixelSurface& surface : pixel.surfaces) {
      if (!(surface.estimate > 0)) continue;
      color += shade(job, pixel, surface, sample, counts.paths) * float(surface.estimate);
    }
    ARRIS_CHECK(is_finite(color), double(pixel.x), double(pixel.y));
    layers.set(pixel, color);
  });
  return counts;
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

struct RenderedTiles {
  std::vector<TileCounts> counts;
  bool complete = false;  // the render was not stopped before the last of them was done
};

template <class Tracer>
RenderedTiles render_tiles(const Job& job, const Tracer& tracer, Layers& layers) {
  const auto start = std::chrono::steady_clock::now();
  const std::vector<BeamTile> tiles = tracer.make_tiles();
  RenderedTiles rendered{std::vector<TileCounts>(tiles.size()), false};
  const auto is_stopped = [&] { return job.options.stop != nullptr && job.options.stop->load(); };
  std::atomic<std::size_t> finished = 0;
  std::mutex reporting;
  parallel_for(tiles.size(), {.threads = job.options.threads}, [&](std::size_t i) {
    if (is_stopped()) return;
    rendered.counts[i] = render_tile(job, tracer, tiles[i], layers);
    if (is_stopped()) return;  // perhaps within the tile
    ++finished;
    if (!job.options.on_progress) return;
    const std::scoped_lock lock(reporting);
    job.options.on_progress({double(finished) / double(tiles.size()), seconds_since(start)});
  });
  rendered.complete = finished == tiles.size();
  return rendered;
}

class BeamRenderer final : public Renderer {
 public:
  explicit BeamRenderer(const BeamSettings& settings) : settings_(settings) {}

  [[nodiscard]] std::vector<std::string> aovs() const override {
    return {kCoverageLo, kCoverageHi, kUncertified, kRegions};
  }

  [[nodiscard]] RenderResult render(const PreparedScene& scene,
                                    const RenderOptions& options) const override {
    const auto start = std::chrono::steady_clock::now();
    const ImageSettings& image = scene.scene().image;
    const BeamScene beams(scene, make_eye(scene.scene()));
    Job job{
        beams, options, {.max_depth = image.max_depth, .only_glossy = settings_.only_glossy}, {}};
    job.lights = make_beam_lights(scene.geometry().lights, settings_.light_beams);
    job.knows_area_lights = settings_.light_beams > 0;
    job.needs_paths = needs_paths(scene.geometry(), job.settings, job.knows_area_lights);
    Layers layers;
    layers.picture.color = Image(image.width_px, image.height_px, 3);
    for (const std::string& name : options.aovs) {
      const int channels = name == kRegions ? 3 : 1;
      layers.picture.layers.push_back({name, Image(image.width_px, image.height_px, channels)});
    }
    // Four rays a region don't get better by smaller ones as bounds do.
    const double least = settings_.rule == BeamRule::corners ? 1.0 / 8 : BeamOptions{}.least_region;
    BeamOptions beam{.least_region = least, .threads = options.threads, .stop = options.stop};
    if (image.max_depth > 0) {
      beam.optics = [&](const SeenSurface& seen) { return optics_of(beams, seen); };
    }
    const std::vector<LightPlace> lights = make_light_places(scene.geometry(), job.lights);
    const auto render_with = [&](const auto& tracer) { return render_tiles(job, tracer, layers); };
    const RenderedTiles tiles =
        settings_.rule == BeamRule::corners
            ? render_with(CornerTracer(beams.solids(), beams.eye(), image.width_px, image.height_px,
                                       beam, lights))
            : render_with(BeamTracer(beams.solids(), beams.eye(), image.width_px, image.height_px,
                                     beam, lights));
    RenderResult result;
    result.samples = options.samples;
    if (!tiles.complete) result.samples.last = result.samples.first;
    sum_counts(tiles.counts, result);
    const std::uint32_t samples = result.samples.last - result.samples.first;
    // Of what was stopped there is none to add up.
    result.sum = std::make_shared<const PictureSum>(
        sum_of_mean(samples > 0 ? layers.picture : Picture(), samples));
    if (samples > 0) result.picture = std::move(layers.picture);
    result.seconds = seconds_since(start);
    return result;
  }

 private:
  static void sum_counts(const std::vector<TileCounts>& counts, RenderResult& result) {
    BeamStats sum;
    for (const TileCounts& c : counts) {
      sum.add(c.beam);
      result.rays.total += c.paths.total + c.beam.rays;
    }
    result.beam = BeamCounts{sum.regions, sum.rays,
                             sum.pixels > 0 ? sum.certified_area / double(sum.pixels) : 0,
                             sum.uncertified_pixels};
    result.rays.camera = sum.rays;
  }

  BeamSettings settings_;
};

}  // namespace

std::unique_ptr<Renderer> make_beam_renderer(const BeamSettings& settings) {
  return std::make_unique<BeamRenderer>(settings);
}

std::vector<std::string> beam_problems(const Scene& scene) {
  std::vector<std::string> problems;
  const RoundingSettings none;
  for (const Object& object : scene.objects) {
    if (object.csg) continue;  // never rounded
    const RoundingSettings& rounding = object.rounding  ? *object.rounding
                                       : scene.rounding ? *scene.rounding
                                                        : none;
    if (rounding.method != RoundMethod::exact && rounding.method != RoundMethod::shader) continue;
    problems.push_back(
        "object \"" + object.name +
        "\" is to have rounded edges, and beams see meshes as they are; use --round none, "
        "--round-method mesh:3 or --integrator path");
  }
  return problems;
}

}  // namespace arris
