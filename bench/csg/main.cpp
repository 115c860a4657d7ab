// bench_csg — what CSG scenes cost: single rays, pictures by beams and by paths, and POV-Ray's
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <string>

#include "beam_growth.h"
#include "beam_table.h"
#include "ray_growth.h"

namespace {

using namespace arris::bench;  // NOLINT(google-build-using-namespace): a program's one file

struct Arguments {
  RayGrowthSettings rays;
  BeamTableSettings table;
  BeamGrowthSettings growth;
  bool pictures_grow = false;
  int rounds = 0;  // 0: each table's own
  int threads = 0;
};

void add_options(CLI::App& app, Arguments& a) {
  app.add_option("--beam", a.table.folder,
                 "the three scenes of this folder (examples/beam) by every renderer: missed "
                 "objects, error, rays, seconds");
  app.add_option("--scenes", a.table.scenes, "with --beam: which of them")->delimiter(',');
  app.add_option("--path", a.table.path_samples, "with --beam: samples of the path tracer")
      ->delimiter(',');
  app.add_option("--corners", a.table.corners, "with --beam: 0 leaves out the paper's own rule");
  app.add_option("--pov", a.table.pov,
                 "with --beam: 0 leaves out POV-Ray, of which a povray on the PATH makes rows");
  app.add_option("--keep", a.table.keep, "with --beam: a folder for POV-Ray's scenes and pictures");
  app.add_flag(
      "--growth", a.pictures_grow,
      "growth of a picture's time with primitives, with holes and, if --beam says where the "
      "plate is, with its size");
  app.add_option("--width", a.growth.width_px, "with --growth: pixels, of pictures of 4:3");
  app.add_option("--largest", a.rays.largest, "number of primitives at which growth ends");
  app.add_option("--rays", a.rays.rays, "of each table without --beam and --growth");
  app.add_option("--rounds", a.rounds, "of which times are medians (7 for rays, 3 for pictures)");
  app.add_option("--threads", a.threads, "of pictures; 0: all");
}

void run(Arguments& a) {
  if (a.rounds > 0) a.rays.rounds = a.table.rounds = a.growth.rounds = a.rounds;
  a.table.threads = a.growth.threads = a.threads;
  a.growth.folder = a.table.folder;
  a.growth.largest = a.rays.largest;
  if (a.pictures_grow) {
    run_beam_growth(a.growth);
  } else if (!a.table.folder.empty()) {
    run_beam_table(a.table);
  } else {
    run_ray_growth(a.rays);
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "What CSG scenes cost. Without --beam or --growth: nanoseconds of rays through random "
      "solids of 10² to 10⁵ primitives, and through a plate with 400 holes.");
  Arguments arguments;
  add_options(app, arguments);
  CLI11_PARSE(app, argc, argv);
  try {
    run(arguments);
  } catch (const std::exception& error) {
    fmt::print(stderr, "bench_csg: {}\n", error.what());
    return 1;
  }
  return 0;
}
