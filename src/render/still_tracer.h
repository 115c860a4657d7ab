// still_tracer.h — a view that stands still, traced piece by piece
// What       Goes round the picture in squares, in an order that spreads them, and adds paths of each pixel to the film
//            until a time is over. The next call goes on where the last one ended.
// Limits     a square that is cut short waits for its other rows until the next round
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

#include "arris/render.h"
#include "render/path_integrator.h"
#include "render/point_shader.h"
#include "render/still_film.h"

namespace arris {

class StillTracer {
 public:
  struct Picture {
    const PreparedScene& scene;
    const CameraRays& camera;
    const PixelFilter& filter;
    const PointShader& shader;
    int width_px = 0, height_px = 0;
  };
  struct Limits {
    double milliseconds = 0;
    const std::atomic<bool>* hurry = nullptr;  // set: ends within some rows of a square
    const std::atomic<bool>* stop = nullptr;   // set: throws, as ParallelOptions::stop
    int threads = 0;
  };

  void restart() { next_ = 0; }
  // Rays that were traced. pixels: how many got paths.
  PathRays trace(const Picture& picture, const Limits& limits, StillFilm& film,
                 std::uint64_t& pixels);

 private:
  std::uint64_t next_ = 0;  // square, counted since restart()
};

}  // namespace arris
