#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "arris/command_line.h"
#include "arris/commands.h"
#include "arris/console.h"
#include "arris/edge_point_job.h"
#include "arris/error.h"
#include "arris/frame_files.h"
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
#include "render/edge_denoiser.h"
#include "render/film.h"
#include "scene/scene_fingerprint.h"
#include "scene/validate_placement.h"

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

void write_stdout(const std::vector<std::uint8_t>& bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), stdout) != bytes.size() ||
      std::fflush(stdout) != 0) {
    throw Error(Error::Kind::failed, "stdout", "can't be written");
  }
}

void write_picture(const RenderRequest& request, const std::string& output, const JobResult& result,
                   double exposure) {
  SaveOptions options;
  options.exposure = exposure;
  options.attributes = attributes_of(result.part);
  options.shown_layers = request.shown_layers;
  if (output == "-") {
    write_stdout(encode_picture(mean_picture(result.sum), PictureFormat::png, options));
    return;
  }
  const bool is_part = !request.denoise &&
                       (request.is_part || (!result.complete && request.time_limit_seconds == 0));
  const bool keep_sum = is_part && picture_format(output) == PictureFormat::exr;
  save_picture(keep_sum ? pack_sum(result.sum) : mean_picture(result.sum), output, options);
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
  if (request.denoise) job.options.aovs.emplace_back(kSquaresLayer);
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

// Takes the layer of squares out of the picture.
void denoise(const PreparedScene& scene, const RenderRequest& request, JobResult& result) {
  const Stopwatch watch;
  Picture picture = mean_picture(result.sum);
  const auto squares = std::ranges::find(picture.layers, kSquaresLayer, &Layer::name);
  const DenoiseSettings settings{result.sum.samples, request.filter, request.seed, request.threads};
  picture.color = denoise_within_edges(scene, picture.color, squares->image, settings);
  picture.layers.erase(squares);
  result.sum = sum_of_mean(picture, result.sum.samples);
  result.seconds += watch.seconds();
}

// What was done for each pixel; of beams, for all of them.
std::string format_work(const JobResult& result) {
  if (result.edge_point && result.edge_point->traced) {
    return "every pixel traced, as edges and points would cost more or show nothing";
  }
  if (result.edge_point && result.part.samples[0].last == 1) {
    return fmt::format("{} points shaded, {} known", result.edge_point->new_points,
                       result.edge_point->points);
  }
  if (!result.beam) return "samples " + format_samples(result.part.samples);
  const BeamCounts& beam = *result.beam;
  return fmt::format("{} regions, {} uncertified {}", beam.regions, beam.uncertified_pixels,
                     beam.uncertified_pixels == 1 ? "pixel" : "pixels");
}

void report_result(Console& console, const std::string& output, const JobResult& result,
                   const Scene& scene, const char* more) {
  const std::string target = output == "-" ? "stdout" : output;
  console.report(fmt::format("{}: {} x {} pixels, {}, {}", target, scene.image.width_px,
                             scene.image.height_px, format_work(result) + more,
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

// Keys that make no scene of some frame are found before the first is rendered.
void check_frames(const Scene& scene, FrameRange frames, const std::string& name) {
  if (!scene.animation.has_keys()) {
    throw Error(
        Error::Kind::input, name,
        "has no keys, so that all frames would be the same; leave out --frames, or add keys to a "
        "scene file: [[camera.key]] frame = 0 position = [3, -4, 2], and [[object.key]] and "
        "[[light.key]] likewise below their [[object]] and [[light]]");
  }
  for (int frame = frames.first; frame < frames.last; ++frame) {
    const std::vector<std::string> problems =
        validate_placement(scene_at(scene, frame), NumberedFrom::one);
    if (problems.empty()) continue;
    throw Error(Error::Kind::input, fmt::format("{}: frame {}", name, frame),
                fmt::format("{}; move the keys around it", fmt::join(problems, "\n  ")));
  }
}

void add_beam(std::optional<BeamCounts>& sum, const BeamCounts& frame, std::uint64_t frames) {
  BeamCounts& all = sum ? *sum : sum.emplace();
  all.regions += frame.regions;
  all.rays += frame.rays;
  all.uncertified_pixels += frame.uncertified_pixels;
  all.certified_fraction += (frame.certified_fraction - all.certified_fraction) / double(frames);
}

// The pictures of one run of the program: a single one, or one for each frame.
class PictureMaker {
 public:
  PictureMaker(const RenderRequest& request, Console& console, const std::atomic<bool>& stop)
      : request_(request),
        console_(console),
        stop_(stop),
        renderer_(make_renderer(request.integrator, request.beam)),
        edge_point_(request.edge_point) {}

  RenderStats stats;
  std::uint64_t ground_triangles = 0;  // of the scene: not the user's

  void render_single(Scene scene) {
    const auto prepared = prepare(std::move(scene), Placement::baked);
    const JobResult result = render(prepared);
    save(*prepared, request_.output, result);
    write_stats_if_asked();
    report_result(console_, request_.output, result, scene_of(*prepared), more_work());
    if (!stop_ || result.complete) return;
    const bool points_only = result.edge_point && result.edge_point->still_paths == 0;
    throw Error(
        Error::Kind::failed, "",
        points_only
            ? "stopped; the picture is interpolated from points, before each pixel had "
              "samples of its own"
            : fmt::format("stopped; the picture holds samples {} of {}..{}",
                          format_samples(result.part.samples), wanted_.first, wanted_.last));
  }

  // Frame 0 is prepared first, whichever are rendered: what depends on the view, such as automatic radii, is its.
  void render_frames(const Scene& scene, FrameRange frames) {
    count_ = double(frames.last) - frames.first;
    auto prepared =
        prepare(scene, scene.animation.objects.empty() ? Placement::baked : Placement::movable);
    for (int frame = frames.first; frame < frames.last; ++frame) {
      end_if_stopped(frames, frame);
      prepared = prepare_frame(*prepared, scene_at(scene, frame));
      const std::optional<JobResult> result = try_render(prepared);
      if (!result) end_if_stopped(frames, frame);
      const std::string output = frame_file(request_.output, frame);
      save(*prepared, output, *result);
      report_result(console_, output, *result, scene_of(*prepared), more_work());
      ++done_;
    }
    write_stats_if_asked();
  }

 private:
  std::shared_ptr<const PreparedScene> prepare(Scene scene, Placement placement) {
    auto prepared = prepare_scene(
        std::move(scene), {.threads = request_.threads, .stop = &stop_, .placement = placement});
    stats.prepare = prepare_stats(*prepared);
    stats.prepare.triangles -= ground_triangles;
    stats.prepare.objects -= ground_triangles > 0 ? 1 : 0;
    report_scene(console_, scene_of(*prepared), stats.prepare);
    report_beam_options(console_, request_.beam, scene_of(*prepared));
    return prepared;
  }

  std::shared_ptr<const PreparedScene> prepare_frame(const PreparedScene& before, Scene moved) {
    auto prepared = prepare_moved(before, std::move(moved),
                                  {.threads = request_.threads, .placement = Placement::movable});
    stats.prepare.build_seconds += prepare_stats(*prepared).build_seconds;
    stats.prepare.round_seconds += prepare_stats(*prepared).round_seconds;
    return prepared;
  }

  JobResult render(const std::shared_ptr<const PreparedScene>& prepared) {
    RenderJob job = make_job(request_, scene_of(*prepared));
    wanted_ = job.options.samples;
    job.options.stop = &stop_;
    job.options.on_progress = [&](const Progress& progress) {
      console_.show_progress({(double(done_) + progress.done) / count_, begin_.seconds()});
    };
    JobResult result = run(prepared, job);
    console_.end_progress();
    stats.rays.camera += result.rays.camera;
    stats.rays.total += result.rays.total;
    stats.rays.rounded += result.rays.rounded;
    if (result.beam) add_beam(stats.beam, *result.beam, done_ + 1);
    stats.render_seconds += result.seconds;
    stats.pixels = double(scene_of(*prepared).image.width_px) * scene_of(*prepared).image.height_px;
    return result;
  }

  JobResult run(const std::shared_ptr<const PreparedScene>& prepared, const RenderJob& job) {
    if (request_.integrator != Integrator::edge_point) {
      JobResult result = run_job(*renderer_, *prepared, job);
      if (request_.denoise) denoise(*prepared, request_, result);
      return result;
    }
    return request_.frames ? edge_point_.render_frame(prepared, job)
                           : edge_point_.render_still(prepared, job);
  }

  // Nothing if it was stopped: frames of fewer samples than their neighbours are of no use.
  std::optional<JobResult> try_render(const std::shared_ptr<const PreparedScene>& prepared) {
    try {
      JobResult result = render(prepared);
      if (stop_ && !result.complete) return std::nullopt;
      return result;
    } catch (const Error&) {
      if (!stop_) throw;
      return std::nullopt;
    }
  }

  void save(const PreparedScene& prepared, const std::string& output, const JobResult& result) {
    const Stopwatch write;
    write_picture(request_, output, result, scene_of(prepared).image.exposure);
    stats.write_seconds += write.seconds();
  }

  [[nodiscard]] const char* more_work() const { return request_.denoise ? ", denoised" : ""; }

  void write_stats_if_asked() {
    if (request_.frames) stats.frames = done_;
    stats.edge_point = edge_point_.frames();
    if (request_.stats) write_stats(*request_.stats, stats);
  }

  void end_if_stopped(FrameRange frames, int frame) {
    if (!stop_) return;
    console_.end_progress();
    throw Error(Error::Kind::failed, "",
                done_ == 0 ? "stopped before the first frame was finished"
                           : fmt::format("stopped; frames {}..{} are finished, go on with "
                                         "--frames {}..{}",
                                         frames.first, frame, frame, frames.last));
  }

  const RenderRequest& request_;
  Console& console_;
  const std::atomic<bool>& stop_;
  std::unique_ptr<Renderer> renderer_;
  EdgePointJob edge_point_;
  const Stopwatch begin_;
  SampleRange wanted_;
  double count_ = 1;  // of pictures
  std::uint64_t done_ = 0;
};

}  // namespace

int run_render(const Arguments& arguments) {
  if (asks_for_materials(arguments)) return print_materials();
  RenderRequest request = make_render_request(arguments);
  Console console(arguments);
  PictureMaker maker(request, console, catch_stop_signals());

  const Stopwatch load;
  Input loaded = load_input(request.input, request.load);
  check_scene(loaded.scene, loaded.name);  // before staging adds what is not the file's
  if (loaded.is_scene_file) request.stage.source = StageOptions::Source::scene_file;
  const StagingReport staging = apply_request(loaded.scene, request, arguments);
  if (!staging.problem.empty()) throw Error(Error::Kind::input, loaded.name, staging.problem);
  if (request.denoise) make_pixels_squares(loaded.scene, request);
  if (request.integrator == Integrator::beam) check_beam_scene(loaded.scene, loaded.name);
  if (request.frames) check_frames(loaded.scene, *request.frames, loaded.name);
  maker.ground_triangles = staging.ground_triangles;
  maker.stats.load_seconds = load.seconds();
  if (request.frames) {
    maker.render_frames(loaded.scene, *request.frames);
  } else {
    maker.render_single(std::move(loaded.scene));
  }
  return 0;
}

}  // namespace arris::program
