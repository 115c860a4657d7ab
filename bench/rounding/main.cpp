// bench_rounding — the paper's Table 1, Fig. 8 and Fig. 11 and its kd-tree against the index by face, in one command
#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "rounding/camera_move.h"
#include "rounding/detection.h"
#include "rounding/export_scene.h"
#include "rounding/model_scene.h"
#include "rounding/scenes.h"
#include "rounding/table.h"

namespace {

using nlohmann::json;
using namespace arris::bench;  // NOLINT(google-build-using-namespace): a program's one file

struct Arguments {
  std::vector<std::string> scenes = bench_scene_names();
  std::vector<std::string> models;
  std::string model_radius;
  std::string model_edges;
  std::string methods = "none,exact,mesh:1,mesh:3,mesh:5,mesh:10,shader";
  TableOptions table;
  int move_frames = 12;
  bool compare_detection = true;
  std::string pictures, json_file, export_folder;
};

json json_of(const Table& table) {
  json rows = json::array();
  for (const TableRow& row : table.rows) {
    json r{{"method", row.method.name}};
    if (!row.failure.empty()) {
      r["failure"] = row.failure;
    } else {
      const auto& p = row.prepared;
      r.update({{"triangles", p.triangles},
                {"seconds", row.seconds},
                {"ratio", row.ratio},
                {"cpu_ratio", row.cpu_ratio},
                {"geometry_bytes", p.geometry_bytes},
                {"rounding_bytes", p.rounding_bytes},
                {"build_seconds", p.build_seconds},
                {"round_seconds", p.round_seconds},
                {"rounded_edges", p.rounded_edges},
                {"rounded_corners", p.rounded_corners},
                {"notes", merged_notes(p)},
                {"rays", row.rays.total},
                {"rays_rounded", row.rays.rounded}});
      if (const auto bytes = bytes_per_edge(p)) r["bytes_per_edge"] = *bytes;
    }
    rows.push_back(std::move(r));
  }
  return {{"scene", table.name}, {"radius", table.radius}, {"rows", std::move(rows)}};
}

json json_of(const std::vector<MoveFrame>& frames) {
  json list = json::array();
  for (const MoveFrame& f : frames)
    list.push_back({{"rays_rounded", f.affected},
                    {"none_seconds", f.none_seconds},
                    {"exact_seconds", f.exact_seconds},
                    {"ratio", f.ratio}});
  return list;
}

json json_of(const std::vector<DetectionResult>& results) {
  json list = json::array();
  for (const DetectionResult& r : results)
    list.push_back({{"detection", r.name},
                    {"build_seconds", r.build_seconds},
                    {"bytes", r.bytes},
                    {"ns_per_hit", r.ns_per_hit},
                    {"ns_per_kept_hit", r.ns_per_kept_hit}});
  return list;
}

void show(const std::string& text) {
  std::fputs((text + "\n").c_str(), stdout);
  std::fflush(stdout);
}

void run(const Arguments& arguments) {
  json results;
  TableOptions options = arguments.table;
  if (!arguments.pictures.empty()) {
    std::filesystem::create_directories(arguments.pictures);
    options.pictures = arguments.pictures;
  }
  show(fmt::format("{}x{}, {} samples per pixel, {} interleaved rounds, medians", options.width_px,
                   options.height_px, options.samples_per_pixel, options.rounds));
  for (const std::string& name : arguments.scenes) {
    const BenchScene bench = make_bench_scene(name);
    const Table table = measure_table(bench, options);
    show(text_of(table));
    results["tables"].push_back(json_of(table));
    if (arguments.compare_detection) {
      const auto detection = compare_detection(bench, options);
      show(text_of(detection));
      results["detection"][name] = json_of(detection);
    }
  }
  for (const std::string& model : arguments.models) {
    const Table table = measure_table(
        make_model_scene(model, arguments.model_radius, arguments.model_edges), options);
    show(text_of(table));
    results["tables"].push_back(json_of(table));
  }
  if (arguments.move_frames > 0) {
    const auto frames =
        measure_camera_move(make_bench_scene("blocks"), arguments.move_frames, options);
    show(text_of(frames));
    results["camera_move"] = json_of(frames);
  }
  if (!arguments.json_file.empty()) {
    std::ofstream file(arguments.json_file);
    file << results.dump(1) << "\n";
    if (!file.flush()) throw std::runtime_error("cannot write " + arguments.json_file);
  }
}

void export_scenes(const Arguments& arguments) {
  std::filesystem::create_directories(arguments.export_folder);
  for (const std::string& name : arguments.scenes)
    export_scene(make_bench_scene(name), arguments.export_folder);
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App app(
      "Rounded edges: time, memory and rays affected for every method on the paper's scenes");
  app.add_option("--scenes", arguments.scenes,
                 "scene1 scene2 scene3 blocks cornell bracket boss pockets brackets")
      ->delimiter(',');
  app.add_option("--models", arguments.models,
                 "model files, instead of scenes that are not asked for; none and exact");
  app.add_option(
      "--model-radius", arguments.model_radius,
      "of models: auto, a length, or a percentage such as 8% (default: auto, or what the "
      "file says)");
  app.add_option("--model-edges", arguments.model_edges,
                 "of models: convex, concave or both (default: what the file says, or convex)")
      ->check(CLI::IsMember({"convex", "concave", "both"}));
  app.add_option("--methods", arguments.methods,
                 "none, exact, mesh:N, shader; ratios are to the first")
      ->capture_default_str();
  app.add_option("--width", arguments.table.width_px)->capture_default_str();
  app.add_option("--height", arguments.table.height_px)->capture_default_str();
  app.add_option("--spp", arguments.table.samples_per_pixel)->capture_default_str();
  app.add_option("--rounds", arguments.table.rounds, "repetitions of every render")
      ->capture_default_str();
  app.add_option("--threads", arguments.table.threads, "0: all")->capture_default_str();
  app.add_option("--camera-move", arguments.move_frames, "frames of the move over Blocks (0: none)")
      ->capture_default_str();
  app.add_flag("--detection,!--no-detection", arguments.compare_detection,
               "compare the index by face with the kd-tree (default)");
  app.add_option("--pictures", arguments.pictures, "save every picture in this folder");
  app.add_option("--json", arguments.json_file, "save the figures");
  app.add_option("--export", arguments.export_folder,
                 "only write the scenes for cycles.py to this folder");
  CLI11_PARSE(app, argc, argv);
  if (!arguments.models.empty()) {
    if (app.count("--scenes") == 0) arguments.scenes.clear();
    if (app.count("--methods") == 0) arguments.methods = "none,exact";
    if (app.count("--camera-move") == 0) arguments.move_frames = 0;
  }
  try {
    arguments.table.methods = parse_methods(arguments.methods);
    if (arguments.export_folder.empty()) {
      run(arguments);
    } else {
      export_scenes(arguments);
    }
  } catch (const std::exception& e) {
    std::fprintf(stderr, "bench_rounding: %s\n", e.what());
    return 1;
  }
  return 0;
}
