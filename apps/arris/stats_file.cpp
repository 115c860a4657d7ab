#include "arris/stats_file.h"

#include <sys/resource.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <nlohmann/json.hpp>
#include <vector>

namespace arris::program {

std::uint64_t peak_memory_bytes() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return std::uint64_t(usage.ru_maxrss) * 1024;
}

namespace {

template <class Value>
double median(const std::vector<EdgePointStats>& frames, const Value& value) {
  std::vector<double> values;
  for (const EdgePointStats& frame : frames) values.push_back(double(value(frame)));
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

// Traced frames have no stages.
std::vector<EdgePointStats> made_of_points(const std::vector<EdgePointStats>& frames) {
  std::vector<EdgePointStats> made;
  std::copy_if(frames.begin(), frames.end(), std::back_inserter(made),
               [](const EdgePointStats& s) { return !s.traced; });
  return made.empty() ? frames : made;
}

nlohmann::ordered_json edge_point_json(const std::vector<EdgePointStats>& all, double pixels) {
  const std::vector<EdgePointStats> frames = made_of_points(all);
  using Stages = EdgePointStats::Stages;
  const auto stage = [&](double Stages::*member) {
    return median(frames, [&](const EdgePointStats& s) { return s.stages.*member; });
  };
  const auto part = [&](std::uint64_t EdgePointStats::Classes::*member) {
    return median(frames, [&](const EdgePointStats& s) { return s.classes.*member; }) / pixels;
  };
  const auto edges = [&](std::uint64_t EdgePointStats::Edges::*member) {
    return std::uint64_t(median(frames, [&](const EdgePointStats& s) { return s.edges.*member; }));
  };
  const double total = stage(&Stages::total);
  const auto traced =
      std::count_if(all.begin(), all.end(), [](const EdgePointStats& s) { return s.traced; });
  nlohmann::ordered_json json;
  json["frames"] = all.size();
  json["traced"] = traced;
  json["fps"] = total > 0 ? 1000 / total : 0;
  json["stages_ms"] = {{"edges", stage(&Stages::edges)},
                       {"raster", stage(&Stages::raster)},
                       {"points", stage(&Stages::points)},
                       {"classify", stage(&Stages::classify)},
                       {"reachability", stage(&Stages::reachability)},
                       {"textures", stage(&Stages::textures)},
                       {"interpolation", stage(&Stages::interpolation)},
                       {"antialias", stage(&Stages::antialias)},
                       {"complex", stage(&Stages::complex)},
                       {"total", total}};
  json["classes"] = {{"empty", part(&EdgePointStats::Classes::empty)},
                     {"simple", part(&EdgePointStats::Classes::simple)},
                     {"complex", part(&EdgePointStats::Classes::complex)}};
  json["edges"] = {{"silhouette", edges(&EdgePointStats::Edges::silhouette)},
                   {"sharp", edges(&EdgePointStats::Edges::sharp)},
                   {"shadow", edges(&EdgePointStats::Edges::shadow)}};
  json["new_samples_fraction"] =
      median(frames, [](const EdgePointStats& s) { return s.new_points; }) / pixels;
  return json;
}

}  // namespace

std::string stats_json(const RenderStats& stats) {
  const PrepareStats& prepare = stats.prepare;
  nlohmann::ordered_json json;
  if (stats.frames > 0) json["frames"] = stats.frames;
  json["seconds"] = {{"load", stats.load_seconds},
                     {"build", prepare.build_seconds},
                     {"round", prepare.round_seconds},
                     {"render", stats.render_seconds},
                     {"write", stats.write_seconds}};
  const double total = double(stats.rays.total);
  json["rays"] = {{"camera", stats.rays.camera},
                  {"total", stats.rays.total},
                  {"rounded_fraction", total > 0 ? double(stats.rays.rounded) / total : 0}};
  json["memory"] = {{"geometry", prepare.geometry_bytes},
                    {"rounding", prepare.rounding_bytes},
                    {"peak_rss", peak_memory_bytes()}};
  json["triangles"] = prepare.triangles;
  json["rounded_edges"] = prepare.rounded_edges;
  json["rounded_corners"] = prepare.rounded_corners;
  if (stats.beam) {
    json["beam"] = {{"regions", stats.beam->regions},
                    {"rays", stats.beam->rays},
                    {"certified_fraction", stats.beam->certified_fraction},
                    {"uncertified_pixels", stats.beam->uncertified_pixels}};
  }
  if (!stats.edge_point.empty()) {
    json["edge_point"] = edge_point_json(stats.edge_point, stats.pixels);
  }
  return json.dump(2) + "\n";
}

}  // namespace arris::program
