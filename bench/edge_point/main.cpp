// bench_edge_point — the paper's Tables 1, 2 and 3, its comparison with and without edges, and how evenly frames come
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

#include "edge_point/edge_finder.h"
#include "edge_point/flight.h"
#include "edge_point/motion.h"

namespace {

using namespace arris::bench;  // NOLINT(google-build-using-namespace): a program's one file

struct Arguments {
  std::vector<std::string> scenes = flight_scene_names();
  std::vector<std::string> sizes{"512x512", "1920x1080"};
  std::vector<std::string> tables{"frames", "quality", "ablation", "finder"};
  std::string mesh;
  FlightOptions flight;
  QualityOptions quality;
  MotionOptions motion;
};

void say(const std::string& line) {
  std::fputs((line + "\n").c_str(), stdout);
  std::fflush(stdout);
}

const char* name_of(arris::EdgePointShader shader) {
  switch (shader) {
    case arris::EdgePointShader::direct:
      return "direct";
    case arris::EdgePointShader::glossy:
      return "glossy";
    case arris::EdgePointShader::gi:
      break;
  }
  return "gi";
}

std::vector<FlightScene> make_scenes(const Arguments& arguments) {
  std::vector<FlightScene> scenes;
  for (const std::string& name : arguments.scenes) scenes.push_back(make_flight_scene(name));
  if (!arguments.mesh.empty()) scenes.push_back(make_scan_scene(arguments.mesh));
  return scenes;
}

void set_size(const std::string& size, FlightOptions& options) {
  if (std::sscanf(size.c_str(), "%dx%d", &options.width_px, &options.height_px) == 2) return;
  throw std::runtime_error("--sizes: " + size + " is no size, such as 512x512");
}

void print_frames(const Arguments& arguments) {
  for (const std::string& size : arguments.sizes) {
    FlightOptions options = arguments.flight;
    set_size(size, options);
    say(fmt::format(
        "\n{} x {} pixels, milliseconds, medians of {} frames, {:.1f}% of pixels shaded a frame",
        options.width_px, options.height_px, options.frames, 100 * options.density));
    say("scene     triangles shader  edges raster points class reach interp  anti complex  total "
        "longest "
        "|"
        " new/px full ms speed-up | silh. sharp shadow | empty simple complex | bytes/px  cache | "
        "scene, trees");
    for (const FlightScene& scene : make_scenes(arguments)) {
      const FrameCosts c = measure_frames(scene, options);
      const auto& s = c.median.stages;
      const double pixels = double(options.width_px) * options.height_px;
      say(fmt::format(
          "{:10}{:9} {:6} {:6.2f} {:6.2f} {:6.2f} {:5.2f} {:5.2f} {:6.2f} {:5.2f} {:7.2f} {:6.2f} "
          "{:7.2f} "
          "| "
          "1/{:<4.0f} {:7.0f} {:8.1f} | {:5} {:5} {:6} | {:4.1f}% {:5.1f}% {:6.2f}% | {:8.1f} "
          "{:4.0f} MB | {:.0f}, {:.0f} ms",
          scene.name, c.triangles, name_of(scene.shader), s.edges, s.raster, s.points, s.classify,
          s.reachability, s.interpolation, s.antialias, s.complex, s.total, c.longest_ms,
          pixels / double(c.median.new_points), c.full_ms, c.full_ms / (s.total + c.shading_ms),
          c.median.edges.silhouette, c.median.edges.sharp, c.median.edges.shadow,
          100 * double(c.median.classes.empty) / pixels,
          100 * double(c.median.classes.simple) / pixels,
          100 * double(c.median.classes.complex) / pixels, double(c.median.image_bytes) / pixels,
          double(c.median.cache_bytes) / 1e6, c.prepare_ms, c.engine_ms));
    }
  }
}

void print_motion(const Arguments& arguments) {
  for (const std::string& size : arguments.sizes) {
    MotionOptions options = arguments.motion;
    options.flight = arguments.flight;
    set_size(size, options.flight);
    say(fmt::format(
        "\n{} x {} pixels, camera, an object and a light move in each of {} frames, {:g} ms "
        "between them; milliseconds",
        options.flight.width_px, options.flight.height_px, options.flight.frames,
        options.pause_ms));
    say("scene      median 99 of 100 longest (at) longest / median | edges longest | delay of a "
        "change | new points, shadow edges of a frame");
    for (const FlightScene& scene : make_scenes(arguments)) {
      const MotionTimes t = measure_motion(scene, options);
      say(
          fmt::format("{:10}{:7.2f} {:9.2f} {:7.2f} ({:3}) {:16.2f} | {:5.2f} {:7.2f} | {:17.1f} "
                      "| {:.0f}, {:.0f}",
                      scene.name, t.median_ms, t.most_of_100_ms, t.longest_ms, t.longest_at,
                      t.longest_ms / t.median_ms, t.edges_ms, t.longest_edges_ms, t.delay_ms,
                      t.new_points, t.shadow_edges));
    }
  }
}

void print_errors(const char* title, const Arguments& arguments,
                  FlightErrors (*measure)(const FlightScene&, const QualityOptions&)) {
  const QualityOptions& q = arguments.quality;
  say(fmt::format("\n{}, {} x {}: RMSE (FLIP) of display values", title, q.flight.width_px,
                  q.flight.height_px));
  say("scene      with edges        without edges     not interpolated  with / without");
  for (const FlightScene& scene : make_scenes(arguments)) {
    const FlightErrors e = measure(scene, q);
    const std::string noisy =
        e.noisy > 0 ? fmt::format("{:.4f} ({:.4f})", e.noisy, e.flip_noisy) : "-";
    say(fmt::format("{:10} {:.4f} ({:.4f})   {:.4f} ({:.4f})   {:17} {:.2f}", scene.name,
                    e.with_edges, e.flip_with, e.without_edges, e.flip_without, noisy,
                    e.with_edges / e.without_edges));
  }
}

void print_finder() {
  say("\nFinding edges");
  for (const EdgeFinderRow& r : measure_edge_finder()) {
    say(fmt::format(
        "{:18} {:7} triangles {:8} edges | mesh {:.0f} ms, edge tree {:.0f} ms, face tree {:.0f} "
        "ms "
        "| {} silhouettes {:.2f} ms (all edges {:.1f} ms) | point light: {} events, {} edges "
        "{:.1f} ms | area light: {} events, {} edges {:.1f} ms",
        r.name, r.triangles, r.edges, r.edge_mesh_ms, r.edge_tree_ms, r.face_tree_ms, r.silhouettes,
        r.silhouettes_ms, r.brute_force_ms, r.shadow_events, r.shadow_edges, r.shadow_ms,
        r.area_events, r.area_edges, r.area_ms));
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"What moving views cost and how good they are: tables of the edge-and-point paper"};
  Arguments arguments;
  app.add_option("--scenes", arguments.scenes, "rooms, chains, furnished, head, grid")
      ->delimiter(',');
  app.add_option("--mesh", arguments.mesh, "a scan of your own besides");
  app.add_option("--tables", arguments.tables, "frames, motion, quality, ablation, finder")
      ->delimiter(',');
  app.add_option("--sizes", arguments.sizes, "of frames")->delimiter(',');
  app.add_option("--frames", arguments.flight.frames, "of each flight");
  app.add_option("--pause-ms", arguments.motion.pause_ms, "motion: between frames");
  app.add_option("--density", arguments.flight.density, "parts of the pixels shaded a frame");
  app.add_option("--reference-paths", arguments.quality.reference_paths, "of each pixel, twice");
  app.add_option("--point-paths", arguments.quality.point_paths, "of each point of the ablation");
  int quality_size = 512;
  app.add_option("--quality-size", quality_size, "pixels a side of pictures that are judged");
  CLI11_PARSE(app, argc, argv);
  arguments.quality.flight = arguments.flight;
  arguments.quality.flight.width_px = arguments.quality.flight.height_px = quality_size;
  try {
    for (const std::string& table : arguments.tables) {
      if (table == "frames") {
        print_frames(arguments);
      } else if (table == "motion") {
        print_motion(arguments);
      } else if (table == "quality") {
        print_errors("Along the flight", arguments, measure_quality);
      } else if (table == "ablation") {
        print_errors("From the same samples of a fifth of the pixels", arguments, measure_ablation);
      } else if (table == "finder") {
        print_finder();
      } else {
        throw std::runtime_error("there is no table " + table +
                                 "; there are frames, motion, quality, ablation, finder");
      }
    }
  } catch (const std::exception& error) {
    std::fputs(fmt::format("bench_edge_point: {}\n", error.what()).c_str(), stderr);
    return 1;
  }
  return 0;
}
