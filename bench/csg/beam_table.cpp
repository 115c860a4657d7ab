#include "beam_table.h"

#include <fmt/format.h>

#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "arris/error.h"
#include "arris/io.h"
#include "arris/render.h"
#include "interleaved.h"
#include "io/child_process.h"
#include "pov_scene.h"
#include "povray.h"
#include "small_objects.h"

namespace arris::bench {
namespace {

namespace fs = std::filesystem;

constexpr int kSlowRounds = 1;  // of what takes longer than all the others

// POV-Ray's methods. Adaptive ones at usual and low thresholds; with a threshold of 0 every pixel that differs from its
// neighbours (AM1), or every pixel (AM2), is sampled as densely as +R says.
struct PovMethod {
  const char* name;
  std::vector<std::string> options;
  bool slow = false;
};
const std::vector<PovMethod>& pov_methods() {
  static const std::vector<PovMethod> kMethods{{"POV none", {"-A"}},
                                               {"POV AM1 A0.3", {"+AM1", "+A0.3", "+R3"}},
                                               {"POV AM2 A0.1 R3", {"+AM2", "+A0.1", "+R3"}},
                                               {"POV AM2 A.01 R5", {"+AM2", "+A0.01", "+R5"}},
                                               {"POV AM1 A0.0 R4", {"+AM1", "+A0.0", "+R4"}},
                                               {"POV AM2 A0.0 R4", {"+AM2", "+A0.0", "+R4"}},
                                               {"POV AM2 A0.0 R5", {"+AM2", "+A0.0", "+R5"}, true}};
  return kMethods;
}

struct Shot {
  Image picture;
  std::uint64_t rays = 0;
  double seconds = 0, cpu_seconds = 0;
};

struct Row {
  std::string name;
  std::function<Shot()> render;
  const Image* truth = nullptr;
  int rounds = 1;
  Shot first;
  std::vector<double> seconds, cpu_seconds;
};

Shot shoot(const Renderer& renderer, const PreparedScene& scene, const RenderOptions& options) {
  const std::clock_t start = std::clock();
  RenderResult result = renderer.render(scene, options);
  return {std::move(result.picture.color), result.rays.total, result.seconds,
          double(std::clock() - start) / CLOCKS_PER_SEC};
}

void add_own_rows(const BeamTableSettings& settings, const PreparedScene& scene, const Image& truth,
                  std::vector<Row>& rows) {
  const auto add = [&](std::string name, std::shared_ptr<const Renderer> renderer, int samples) {
    RenderOptions options;
    options.samples = {0, std::uint32_t(samples)};
    options.threads = settings.threads;
    rows.push_back({std::move(name),
                    [&scene, options, renderer = std::move(renderer)] {
                      return shoot(*renderer, scene, options);
                    },
                    &truth,
                    settings.rounds,
                    {},
                    {},
                    {}});
  };
  add("beam certified", make_beam_renderer(), 1);
  if (settings.corners) add("beam corners", make_beam_renderer({.rule = BeamRule::corners}), 1);
  for (const int samples : settings.path_samples) {
    add(fmt::format("path {}", samples), make_path_renderer(), samples);
  }
}

Shot shoot(const PovJob& job) {
  PovPicture result = run_povray(job);
  return {std::move(result.color), result.rays, result.seconds, result.cpu_seconds};
}

// The scene for POV-Ray, in the folder, and its dense picture.
Image make_pov_truth(PovJob job, const Scene& scene) {
  std::ofstream(job.folder / (job.scene + ".pov")) << pov_scene(scene);
  job.width_px = scene.image.width_px * kTruthGrid;
  job.height_px = scene.image.height_px * kTruthGrid;
  job.options = {"-A"};
  return shrink_to_truth(run_povray(job).color);
}

void add_pov_rows(const BeamTableSettings& settings, const PovJob& base, const Image& truth,
                  std::vector<Row>& rows) {
  for (const PovMethod& method : pov_methods()) {
    PovJob job = base;
    job.options = method.options;
    rows.push_back({method.name,
                    [job] { return shoot(job); },
                    &truth,
                    method.slow ? std::min(kSlowRounds, settings.rounds) : settings.rounds,
                    {},
                    {},
                    {}});
  }
}

void render_in_turn(std::vector<Row>& rows, int rounds) {
  for (int round = 0; round < rounds; ++round) {
    for (std::size_t k = 0; k < rows.size(); ++k) {
      Row& row = rows[round % 2 == 0 ? k : rows.size() - 1 - k];
      if (round >= row.rounds) continue;
      Shot shot = row.render();
      row.seconds.push_back(shot.seconds);
      row.cpu_seconds.push_back(shot.cpu_seconds);
      if (round == 0) row.first = std::move(shot);
    }
  }
}

void print_rows(const std::string& scene, const std::vector<Row>& rows,
                const std::vector<SmallObject>& objects) {
  const Row& beam = rows[0];
  for (const Row& row : rows) {
    const Missed missed = count_missed(row.first.picture, *row.truth, objects);
    fmt::print("{:<8} {:<15} {:>7} {:>8.5f} {:>11} {:>8.2f} {:>8.2f} {:>8.2f} {:>8.2f}\n", scene,
               row.name, fmt::format("{}/{}", missed.missed, missed.visible),
               rmse(row.first.picture, *row.truth), row.first.rays, median(row.seconds),
               median(row.cpu_seconds), 1 / median_ratio(row.seconds, beam.seconds),
               1 / median_ratio(row.cpu_seconds, beam.cpu_seconds));
  }
  std::fflush(stdout);
}

void run_scene(const BeamTableSettings& settings, const std::string& name,
               const std::optional<fs::path>& povray, const fs::path& folder) {
  const auto prepared = prepare_scene(load_scene(settings.folder + "/" + name + ".toml"),
                                      {.threads = settings.threads});
  const std::vector<SmallObject> objects = load_small_objects(settings.folder, name);
  const Image truth = make_truth(*prepared, objects, settings.threads);
  std::vector<Row> rows;
  add_own_rows(settings, *prepared, truth, rows);
  Image pov_truth;
  if (povray) {
    const PovJob job{
        .program = *povray, .folder = folder, .scene = name, .threads = settings.threads};
    pov_truth = make_pov_truth(job, scene_of(*prepared));
    add_pov_rows(settings, job, pov_truth, rows);
  }
  render_in_turn(rows, settings.rounds);
  print_rows(name, rows, objects);
  if (povray) {
    fmt::print("{:<8} {:<15} {:>7} {:>8.5f}\n", name, "POV truth, ours", "",
               rmse(pov_truth, truth));
  }
}

}  // namespace

void run_beam_table(const BeamTableSettings& settings) {
  std::optional<fs::path> povray;
  if (settings.pov) {
    povray = find_povray();
    if (!povray) fmt::print("no povray on the PATH: no rows of POV-Ray\n");
  }
  const ScratchFolder scratch("bench-csg");
  const fs::path folder = settings.keep.empty() ? scratch.path() : fs::absolute(settings.keep);
  fs::create_directories(folder);
  fmt::print("{:<8} {:<15} {:>7} {:>8} {:>11} {:>8} {:>8} {:>17}\n", "", "", "", "", "", "", "",
             "beam's time/its");
  fmt::print("{:<8} {:<15} {:>7} {:>8} {:>11} {:>8} {:>8} {:>8} {:>8}\n", "scene", "renderer",
             "missed", "RMSE", "rays", "seconds", "cpu s", "seconds", "cpu s");
  for (const std::string& scene : settings.scenes) {
    run_scene(settings, scene, povray, folder);
  }
}

}  // namespace arris::bench
