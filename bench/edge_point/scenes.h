// scenes.h — scenes of the kinds and sizes of the paper's Table 1
// What       rooms with six lights; chains of tessellated tori; a furnished room with fine wire; a head-like mesh,
//            as irregular as a scan; a fine mesh behind a grid. Each with a camera flight.
// Source     Bala, Walter, Greenberg (2003), §7.1, Table 1
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "arris/edge_point.h"
#include "arris/scene.h"

namespace arris::bench {

struct FlightScene {
  std::string name;
  Scene scene;
  EdgePointShader shader = EdgePointShader::direct;
  Vec3d pivot;              // the camera goes around it …
  double turn_deg = 0.4;    // … by so much a frame
  std::uint32_t mover = 0;  // the object that moves, where one does
};

std::vector<std::string> flight_scene_names();
// Errors: std::runtime_error naming the scenes there are.
FlightScene make_flight_scene(const std::string& name);
// A scan of the user's instead of the head.
FlightScene make_scan_scene(const std::string& file);

Camera flight_camera(const FlightScene& flight, int frame);

}  // namespace arris::bench
