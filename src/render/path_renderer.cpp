#include "render/path_renderer.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "base/check.h"
#include "base/flush_denormals.h"
#include "base/parallel_for.h"
#include "render/camera.h"
#include "render/film.h"
#include "render/pixel_filter.h"
#include "render/sample_passes.h"

namespace arris {
namespace {

constexpr int kTileSide = 16;  // pixels; a power of two

struct Tile {
  int x, y;  // upper left pixel
};

std::vector<Tile> make_tiles(const ImageSettings& image) {
  std::vector<Tile> tiles;
  for (int y = 0; y < image.height_px; y += kTileSide) {
    for (int x = 0; x < image.width_px; x += kTileSide) {
      tiles.push_back({x, y});
    }
  }
  return tiles;
}

// Every second bit, packed: one coordinate of a Morton index. Neighbours in time are neighbours in space.
constexpr int even_bits(int index) {
  int bits = index & 0x5555;
  bits = (bits | (bits >> 1)) & 0x3333;
  bits = (bits | (bits >> 2)) & 0x0f0f;
  return (bits | (bits >> 4)) & 0x00ff;
}

// What all tiles of a render share.
struct Job {
  const PreparedScene& scene;
  const ImageSettings& image;
  CameraRays camera;
  PixelFilter filter;
  PathSettings settings;
  std::uint32_t seed;
};

PathSample render_sample(const Job& job, int x, int y, std::uint32_t sample, PathRays& rays) {
  Sampler sampler(job.seed, std::uint32_t(x), std::uint32_t(y), sample);
  const Vec2f u = sampler.next_2d();
  const double px = x + 0.5 + double(job.filter.sample_offset(u.x));
  const double py = y + 0.5 + double(job.filter.sample_offset(u.y));
  const PathSample result =
      trace_path(job.scene, job.settings, camera_ray(job.camera, px, py), sampler, rays);
  ARRIS_CHECK(is_finite(result.radiance), double(result.radiance.x), double(result.radiance.y),
              double(result.radiance.z), double(x), double(y), double(sample), double(job.seed));
  return result;
}

PathRays render_tile(const Job& job, Tile tile, SampleRange samples, Film& film) {
  const FlushDenormals flush;
  PathRays rays;
  for (int i = 0; i < kTileSide * kTileSide; ++i) {
    const int x = tile.x + even_bits(i), y = tile.y + even_bits(i >> 1);
    if (x >= job.image.width_px || y >= job.image.height_px) {
      continue;
    }
    const std::size_t pixel = std::size_t(y) * std::size_t(job.image.width_px) + std::size_t(x);
    for (std::uint32_t sample = samples.first; sample < samples.last; ++sample) {
      const PathSample result = render_sample(job, x, y, sample, rays);
      film.add(pixel, result.radiance, result.first);
    }
  }
  return rays;
}

// Nothing if the pass must be dropped; some tiles of the film hold it then.
std::optional<PathRays> render_pass(const Job& job, const std::vector<Tile>& tiles,
                                    SampleRange samples, int threads, Film& film,
                                    SamplePasses& passes) {
  std::vector<PathRays> rays(tiles.size());
  std::atomic<std::size_t> finished = 0;
  std::atomic<bool> dropped = false;
  parallel_for(tiles.size(), {.grain = 1, .threads = threads}, [&](std::size_t i) {
    if (dropped || passes.must_drop()) {
      dropped = true;
      return;
    }
    rays[i] = render_tile(job, tiles[i], samples, film);
    passes.report(double(++finished) / double(tiles.size()));
  });
  if (dropped) return std::nullopt;
  PathRays sum;
  for (const PathRays& tile : rays) {
    sum.total += tile.total;
    sum.rounded += tile.rounded;
  }
  return sum;
}

class PathRenderer final : public Renderer {
 public:
  explicit PathRenderer(Strategies strategies) : strategies_(strategies) {}

  [[nodiscard]] std::vector<std::string> aovs() const override { return film_layer_names(); }

  [[nodiscard]] RenderResult render(const PreparedScene& scene,
                                    const RenderOptions& options) const override {
    const ImageSettings& image = scene.scene().image;
    const Job job{scene,
                  image,
                  make_camera_rays(*scene.scene().camera, image),
                  PixelFilter(image.filter),
                  PathSettings{.max_depth = image.max_depth, .strategies = strategies_},
                  options.seed};
    const std::vector<Tile> tiles = make_tiles(image);
    Film film(image, options.aovs);
    SamplePasses passes(options);
    RenderResult result;
    for (SampleRange pass = passes.next(); pass.first < pass.last; pass = passes.next()) {
      std::optional<Film> before;  // what an empty film held need not be kept
      if (passes.is_droppable() && pass.first > options.samples.first) before = film;
      const auto rays = render_pass(job, tiles, pass, options.threads, film, passes);
      if (!rays) {
        passes.drop();
        if (before) film = *before;
        break;
      }
      result.rays.total += rays->total;
      result.rays.rounded += rays->rounded;
    }
    result.samples = passes.done();
    const std::uint32_t count = result.samples.last - result.samples.first;
    result.rays.camera =
        std::uint64_t(count) * std::uint64_t(image.width_px) * std::uint64_t(image.height_px);
    result.sum = std::make_shared<const PictureSum>(film.take_sum(count));
    if (count > 0) result.picture = mean_picture(*result.sum);
    result.seconds = passes.elapsed_seconds();
    return result;
  }

 private:
  Strategies strategies_;
};

}  // namespace

std::unique_ptr<Renderer> make_path_renderer(Strategies strategies) {
  return std::make_unique<PathRenderer>(strategies);
}

std::unique_ptr<Renderer> make_path_renderer() {
  return make_path_renderer(Strategies::both);
}

}  // namespace arris
