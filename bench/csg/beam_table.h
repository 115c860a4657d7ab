// beam_table.h — the scenes of examples/beam by every renderer, against dense sampling
#pragma once

#include <string>
#include <vector>

namespace arris::bench {

struct BeamTableSettings {
  std::string folder;                        // of the scenes; empty: no table
  std::vector<int> path_samples{4, 16, 64};  // of the path tracer
  bool corners = true;
  int threads = 0;
};

int run_beam_table(const BeamTableSettings& settings);

}  // namespace arris::bench
