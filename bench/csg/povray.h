// povray.h — pictures and statistics of an installed POV-Ray 3.7
// Guarantee  no shell; pictures are half float in linear light (OpenEXR), so that nothing is clipped or rounded
// Errors     arris::Error, kind failed, with the end of what povray said
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "arris/image.h"

namespace arris::bench {

// On the PATH.
std::optional<std::filesystem::path> find_povray();

struct PovJob {
  std::filesystem::path program;
  std::filesystem::path folder;  // of the scene's file; the picture goes there, too
  std::string scene;             // file name without .pov
  int width_px = 640, height_px = 480;
  std::vector<std::string> options{};  // such as +AM2
  int threads = 0;                     // 0: all
};

struct PovPicture {
  Image color;
  std::uint64_t rays = 0;               // from the camera, and shadow rays
  double seconds = 0, cpu_seconds = 0;  // of tracing, without reading the scene
};

PovPicture run_povray(const PovJob& job);

}  // namespace arris::bench
