// beam_table.h — the scenes of examples/beam by every renderer, against dense sampling
// What       missed objects, RMSE against the renderer's own dense picture, rays, seconds and seconds of all threads:
//            of the beam renderer by both rules, the path tracer, and POV-Ray's antialiasing methods if a povray is on
//            the PATH. Every round renders with each in turn, the next one backwards; times are medians, ratios medians
//            of those in one round.
// Limits     POV-Ray's time is what it says of tracing, ours that of Renderer::render(): neither reads or prepares. Its
//            rays are those from the camera and to lights; ours, too, and those that stand for what stayed unknown.
#pragma once

#include <string>
#include <vector>

namespace arris::bench {

struct BeamTableSettings {
  std::string folder;  // of the scenes
  std::vector<std::string> scenes{"plate", "fence", "spheres"};
  std::vector<int> path_samples{4, 16, 64};  // of the path tracer
  bool corners = true;
  bool pov = true;
  std::string keep;  // a folder for POV-Ray's scenes and pictures; empty: they are removed
  int rounds = 3;
  int threads = 0;
};

void run_beam_table(const BeamTableSettings& settings);

}  // namespace arris::bench
