#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>
#include <variant>
#include <vector>

#include "arris/command_line.h"
#include "arris/commands.h"
#include "arris/console.h"
#include "arris/error.h"
#include "arris/input.h"
#include "arris/io.h"
#include "arris/render_job.h"
#include "arris/render_request.h"
#include "arris/rounding_report.h"
#include "arris/stats_file.h"
#include "arris/stop_signal.h"
#include "arris/values.h"
#include "io/file_bytes.h"
#include "io/picture_file.h"
#include "scene/material_presets.h"
#include "scene/scene_fingerprint.h"

namespace arris::program {
namespace {

class Stopwatch {
 public:
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

int print_materials() {
  for (const MaterialPreset& preset : material_presets()) {
    fmt::print("{:<16}{}\n", preset.name, preset.description);
  }
  return 0;
}

void write_stdout(const std::vector<std::uint8_t>& bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), stdout) != bytes.size() ||
      std::fflush(stdout) != 0) {
    throw Error(Error::Kind::failed, "stdout", "can't be written");
  }
}

void write_picture(const RenderRequest& request, const JobResult& result, double exposure) {
  SaveOptions options;
  options.exposure = exposure;
  options.attributes = attributes_of(result.part);
  options.shown_layers = request.shown_layers;
  if (request.output == "-") {
    write_stdout(encode_picture(mean_picture(result.sum), PictureFormat::png, options));
    return;
  }
  const bool is_part = request.is_part || (!result.complete && request.time_limit_seconds == 0);
  const bool keep_sum = is_part && picture_format(request.output) == PictureFormat::exr;
  save_picture(keep_sum ? pack_sum(result.sum) : mean_picture(result.sum), request.output, options);
}

void write_stats(const std::string& path, const RenderStats& stats) {
  const std::string text = stats_json(stats);
  const std::vector<std::uint8_t> bytes(text.begin(), text.end());
  if (path == "-") {
    write_stdout(bytes);
  } else {
    write_file_whole(path, bytes);
  }
}

RenderJob make_job(const RenderRequest& request, const Scene& scene) {
  RenderJob job;
  job.options.samples =
      request.samples.value_or(SampleRange{0, std::uint32_t(scene.image.samples_per_pixel)});
  job.options.time_limit_seconds = request.time_limit_seconds;
  job.options.seed = request.seed;
  job.options.threads = request.threads;
  job.options.aovs = request.aovs;
  job.part.scene = scene_fingerprint(scene);
  job.part.seed = request.seed;
  job.part.integrator = name_of(request.integrator);
  if (request.integrator == Integrator::beam) {
    job.chunk_samples = job.options.samples.last - job.options.samples.first;
  }
  job.checkpoint = request.checkpoint;
  return job;
}

void report_scene(Console& console, const Scene& scene, const PrepareStats& stats) {
  for (const std::string& note : scene.notes) console.report(note);
  report_rounding(console, scene, stats);
  const std::string triangles = stats.triangles == 0
                                    ? ""  // CSG solids only
                                    : fmt::format("{} {} in ", stats.triangles,
                                                  stats.triangles == 1 ? "triangle" : "triangles");
  console.detail(fmt::format("{}{} {}, prepared in {}", triangles, stats.objects,
                             stats.objects == 1 ? "object" : "objects",
                             format_duration(stats.build_seconds + stats.round_seconds)));
  const Camera& camera = *scene.camera;
  console.detail(
      fmt::format("camera: --camera-position {:.6g},{:.6g},{:.6g} --camera-target "
                  "{:.6g},{:.6g},{:.6g} --fov {:g}",
                  camera.position.x, camera.position.y, camera.position.z, camera.target.x,
                  camera.target.y, camera.target.z, camera.fov_deg));
}

// What was done for each pixel; of beams, for all of them.
std::string format_work(const JobResult& result) {
  if (!result.beam) return "samples " + format_samples(result.part.samples);
  const BeamCounts& beam = *result.beam;
  return fmt::format("{} regions, {} uncertified {}", beam.regions, beam.uncertified_pixels,
                     beam.uncertified_pixels == 1 ? "pixel" : "pixels");
}

void report_result(Console& console, const RenderRequest& request, const JobResult& result,
                   const Scene& scene) {
  const std::string target = request.output == "-" ? "stdout" : request.output;
  console.report(fmt::format("{}: {} x {} pixels, {}, {}", target, scene.image.width_px,
                             scene.image.height_px, format_work(result),
                             format_duration(result.seconds)));
  if (result.seconds > 0) {
    console.detail(fmt::format("{:.2f} million rays per second",
                               double(result.rays.total) / result.seconds / 1e6));
  }
}

void report_beam_options(Console& console, const BeamSettings& beam, const Scene& scene) {
  const bool any_area_light = std::ranges::any_of(
      scene.lights, [](const Light& light) { return std::holds_alternative<AreaLight>(light); });
  if (beam.light_beams > 0 && !any_area_light) {
    console.report("--light-beams changes nothing: there are no area lights");
  }
}

void check_beam_scene(const Scene& scene, const std::string& name) {
  const std::vector<std::string> problems = beam_problems(scene);
  if (!problems.empty()) {
    throw Error(Error::Kind::input, name, fmt::format("{}", fmt::join(problems, "\n  ")));
  }
}

}  // namespace

int run_render(const Arguments& arguments) {
  if (arguments.find("--material") == "list") return print_materials();
  RenderRequest request = make_render_request(arguments);
  Console console(arguments);
  const std::atomic<bool>& stop = catch_stop_signals();
  RenderStats stats;

  const Stopwatch load;
  Input loaded = load_input(request.input, request.load);
  check_scene(loaded.scene, loaded.name);  // before staging adds what is not the file's
  if (loaded.is_scene_file) request.stage.source = StageOptions::Source::scene_file;
  const StagingReport staging = apply_request(loaded.scene, request, arguments);
  if (!staging.problem.empty()) throw Error(Error::Kind::input, loaded.name, staging.problem);
  if (request.integrator == Integrator::beam) check_beam_scene(loaded.scene, loaded.name);
  stats.load_seconds = load.seconds();

  const auto prepared =
      prepare_scene(std::move(loaded.scene), {.threads = request.threads, .stop = &stop});
  const Scene& scene = scene_of(*prepared);
  stats.prepare = prepare_stats(*prepared);
  stats.prepare.triangles -= staging.ground_triangles;
  stats.prepare.objects -= staging.ground_triangles > 0 ? 1 : 0;
  report_scene(console, scene, stats.prepare);
  report_beam_options(console, request.beam, scene);

  RenderJob job = make_job(request, scene);
  job.options.stop = &stop;
  job.options.on_progress = [&](const Progress& progress) { console.show_progress(progress); };
  const JobResult result =
      run_job(*make_renderer(request.integrator, request.beam), *prepared, job);
  console.end_progress();
  stats.rays = result.rays;
  stats.beam = result.beam;
  stats.render_seconds = result.seconds;

  const Stopwatch write;
  write_picture(request, result, scene.image.exposure);
  stats.write_seconds = write.seconds();
  if (request.stats) write_stats(*request.stats, stats);
  report_result(console, request, result, scene);
  if (!stop || result.complete) return 0;
  throw Error(Error::Kind::failed, "",
              fmt::format("stopped; the picture holds samples {} of {}..{}",
                          format_samples(result.part.samples), job.options.samples.first,
                          job.options.samples.last));
}

}  // namespace arris::program
