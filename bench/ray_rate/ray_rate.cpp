// ray_rate — how fast the path tracer traces, against Embree alone on the same rays
//   bench_ray_rate [--scene FILE] [--spp N] [--runs N] [--threads N] [-o PICTURE]
// Records the rays of a render, then times, in turn, full renders of the same samples and a bare loop
// over the recorded rays in the same order, and prints the medians and their ratio.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <string>
#include <vector>

#include "arris/io.h"
#include "arris/render.h"
#include "base/flush_denormals.h"
#include "base/parallel_for.h"
#include "ray_rate/embree_tap.h"
#include "ray_rate/ray_rate_scene.h"

namespace arris::bench {
namespace {

struct Settings {
  std::string scene, output;
  std::uint32_t spp = 2;
  int runs = 5;
  int threads = 0;
};

// Wall time, and processor time of all threads, which other programs disturb less.
struct Seconds {
  double wall = 0, cpu = 0;
};

Seconds now() {
  timespec cpu{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &cpu);
  const auto wall = std::chrono::steady_clock::now().time_since_epoch();
  return {std::chrono::duration<double>(wall).count(),
          double(cpu.tv_sec) + 1e-9 * double(cpu.tv_nsec)};
}

Seconds since(Seconds start) {
  const Seconds end = now();
  return {end.wall - start.wall, end.cpu - start.cpu};
}

// The bare loop: nothing but Embree.
Seconds time_bare_loop(const Recording& recording, int threads) {
  constexpr std::size_t kChunk = 4096;
  const std::size_t chunks = (recording.rays.size() + kChunk - 1) / kChunk;
  const EmbreeCalls& embree = embree_calls();
  const Seconds start = now();
  parallel_for(chunks, {.grain = 1, .threads = threads}, [&](std::size_t chunk) {
    const FlushDenormals flush;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    const std::size_t last = std::min((chunk + 1) * kChunk, recording.rays.size());
    for (std::size_t i = chunk * kChunk; i < last; ++i) {
      if (recording.rays[i].shadow) {
        RTCRay ray = recording.rays[i].ray;
        embree.occluded(recording.scene, &context, &ray);
      } else {
        RTCRayHit query;
        query.ray = recording.rays[i].ray;
        query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        embree.intersect(recording.scene, &context, &query);
      }
    }
  });
  return since(start);
}

Seconds median(const std::vector<Seconds>& times) {
  std::vector<double> wall, cpu;
  for (const Seconds& time : times) {
    wall.push_back(time.wall);
    cpu.push_back(time.cpu);
  }
  std::sort(wall.begin(), wall.end());
  std::sort(cpu.begin(), cpu.end());
  return {wall[wall.size() / 2], cpu[cpu.size() / 2]};
}

Recording record_rays(const PreparedScene& scene, RenderOptions options) {
  options.threads = 1;
  start_recording();
  static_cast<void>(make_path_renderer()->render(scene, options));
  return stop_recording();
}

void report(double rays, double paths, Seconds rendered, Seconds bare) {
  fmt::print(
      "renderer      wall {:8.3f} s  {:7.2f} M rays/s  {:6.3f} M paths/s   processor {:8.3f} s\n",
      rendered.wall, rays * 1e-6 / rendered.wall, paths * 1e-6 / rendered.wall, rendered.cpu);
  fmt::print(
      "Embree alone  wall {:8.3f} s  {:7.2f} M rays/s                     processor {:8.3f} s\n",
      bare.wall, rays * 1e-6 / bare.wall, bare.cpu);
  fmt::print(
      "ratio         wall {:8.3f}                                        processor {:8.3f}\n",
      bare.wall / rendered.wall, bare.cpu / rendered.cpu);
}

void measure(const Settings& settings) {
  const auto scene = prepare_scene(settings.scene.empty() ? make_blocks_scene()
                                                          : load_measured_scene(settings.scene));
  RenderOptions options;
  options.samples = {0, settings.spp};
  options.threads = settings.threads;
  const Recording recording = record_rays(*scene, options);
  const auto shadows = std::count_if(recording.rays.begin(), recording.rays.end(),
                                     [](const TappedRay& ray) { return ray.shadow; });
  const auto renderer = make_path_renderer();
  std::vector<Seconds> rendered, bare;
  RenderResult result;
  for (int run = 0; run < settings.runs; ++run) {
    const Seconds start = now();
    result = renderer->render(*scene, options);
    rendered.push_back(since(start));
    bare.push_back(time_bare_loop(recording, settings.threads));
  }
  if (!settings.output.empty()) {
    save_picture(result.picture, settings.output);
  }
  const PrepareStats& stats = prepare_stats(*scene);
  fmt::print("{} triangles in {} objects, built in {:.3f} s, {:.1f} MB\n", stats.triangles,
             stats.objects, stats.build_seconds, double(stats.geometry_bytes) * 1e-6);
  fmt::print("{} paths, {} rays ({:.1f}% shadow rays)\n", result.rays.camera, recording.rays.size(),
             100 * double(shadows) / double(recording.rays.size()));
  report(double(recording.rays.size()), double(result.rays.camera), median(rendered), median(bare));
}

int run(int argc, char** argv) {
  Settings settings;
  for (int i = 1; i < argc; i += 2) {
    const char* value = i + 1 < argc ? argv[i + 1] : nullptr;
    if (value != nullptr && std::strcmp(argv[i], "--scene") == 0) {
      settings.scene = value;
    } else if (value != nullptr && std::strcmp(argv[i], "--spp") == 0) {
      settings.spp = std::uint32_t(std::max(1, std::atoi(value)));
    } else if (value != nullptr && std::strcmp(argv[i], "--runs") == 0) {
      settings.runs = std::max(1, std::atoi(value));
    } else if (value != nullptr && std::strcmp(argv[i], "--threads") == 0) {
      settings.threads = std::atoi(value);
    } else if (value != nullptr && std::strcmp(argv[i], "-o") == 0) {
      settings.output = value;
    } else {
      fmt::print(
          stderr,
          "usage: bench_ray_rate [--scene FILE] [--spp N] [--runs N] [--threads N] [-o PICTURE]\n");
      return 2;
    }
  }
  try {
    measure(settings);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}

}  // namespace
}  // namespace arris::bench

int main(int argc, char** argv) {
  return arris::bench::run(argc, argv);
}
