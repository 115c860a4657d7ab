// stats_file.h — the numbers of --stats
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "arris/edge_point.h"
#include "arris/render.h"

namespace arris::program {

// Of several frames: seconds, rays and what beams did are sums, the certified fraction is their mean.
struct RenderStats {
  std::uint64_t frames = 0;  // 0: a single picture
  double load_seconds = 0, render_seconds = 0, write_seconds = 0;
  PrepareStats prepare;
  RayCounts rays;
  std::optional<BeamCounts> beam;
  std::vector<EdgePointStats> edge_point;  // of each frame; empty: another integrator
  double pixels = 0;                       // of a frame
};

std::string stats_json(const RenderStats& stats);

// The most memory that this process has had, in bytes.
std::uint64_t peak_memory_bytes();

}  // namespace arris::program
