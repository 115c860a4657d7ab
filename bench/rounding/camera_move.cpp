#include "rounding/camera_move.h"

#include <fmt/format.h>

#include "arris/io.h"
#include "interleaved.h"

namespace arris::bench {

std::vector<MoveFrame> measure_camera_move(const BenchScene& bench, int frames,
                                           const TableOptions& options) {
  std::vector<MoveFrame> measured;
  Scene scene = bench.scene;
  scene.image.width_px = options.width_px;
  scene.image.height_px = options.height_px;
  for (const Camera& camera : make_camera_move(frames)) {
    scene.camera = camera;
    std::vector<Variant> variants;
    for (const Method& method : parse_methods("none,exact"))
      variants.push_back(
          {method.name, prepare_scene(with_method(scene, method), {.threads = options.threads})});
    InterleavedOptions interleaved;
    interleaved.rounds = options.rounds;
    interleaved.render.samples = {0, options.samples_per_pixel};
    interleaved.render.threads = options.threads;
    if (options.pictures) {
      interleaved.on_picture = [&](const Variant& variant, const RenderResult& result) {
        save_picture(
            result.picture,
            *options.pictures / fmt::format("move-{:03}-{}.png", measured.size(), variant.name));
      };
    }
    const std::vector<Timing> timings = render_interleaved(variants, interleaved);
    const RayCounts& rays = timings[1].rays;
    measured.push_back({rays.total > 0 ? double(rays.rounded) / double(rays.total) : 0,
                        median(timings[0].seconds), median(timings[1].seconds),
                        median_ratio(timings[1].cpu_seconds, timings[0].cpu_seconds)});
  }
  return measured;
}

std::string text_of(const std::vector<MoveFrame>& frames) {
  std::string text = fmt::format("Camera move in Blocks\n  {:>5}{:>9}{:>9}{:>9}{:>12}\n", "frame",
                                 "rays %", "none s", "exact s", "increase %");
  for (std::size_t i = 0; i < frames.size(); ++i)
    text +=
        fmt::format("  {:>5}{:>9.2f}{:>9.3f}{:>9.3f}{:>12.1f}\n", i, 100 * frames[i].affected,
                    frames[i].none_seconds, frames[i].exact_seconds, 100 * (frames[i].ratio - 1));
  return text;
}

}  // namespace arris::bench
