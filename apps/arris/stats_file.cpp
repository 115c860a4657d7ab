#include "arris/stats_file.h"

#include <sys/resource.h>

#include <nlohmann/json.hpp>

namespace arris::program {

std::uint64_t peak_memory_bytes() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return std::uint64_t(usage.ru_maxrss) * 1024;
}

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
  return json.dump(2) + "\n";
}

}  // namespace arris::program
