// detection.h — the paper's kd-tree against the index by face, on the hits of real paths
// What       meets camera rays and one diffuse bounce with the scene's sharp mesh, keeps the hits on rounded objects,
//            and times the kernel alone on them in every mode
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "rounding/scenes.h"
#include "rounding/table.h"

namespace arris::bench {

struct DetectionResult {
  std::string name;
  double build_seconds = 0;  // one thread, all objects
  std::uint64_t bytes = 0;
  double ns_per_hit = 0;         // is_kept, and resolve where it is not; median over the rounds
  double ns_per_kept_hit = 0;    // is_kept alone, of the hits that are kept
  double moved = 0, passed = 0;  // shares of the hits
};

std::vector<DetectionResult> compare_detection(const BenchScene& bench,
                                               const TableOptions& options);
std::string text_of(const std::vector<DetectionResult>& results);

}  // namespace arris::bench
