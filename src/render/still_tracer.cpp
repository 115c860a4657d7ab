#include "render/still_tracer.h"

#include <algorithm>
#include <chrono>
#include <numeric>
#include <thread>
#include <vector>

#include "base/parallel_for.h"

namespace arris {
namespace {

constexpr int kSide = 16;  // pixels of a square
// Of a pixel in one round. Few, so that all pixels soon have some.
constexpr int kMostPaths = 4;
// Squares that a thread gets between two looks at the clock.
constexpr std::size_t kSquaresPerThread = 4;

struct Square {
  int x = 0, y = 0, width = 0;
  int rows = 0;  // that are done
  std::vector<Rgb> sums;
  PathRays rays;
};

// A step that visits all of `count` squares before it comes back, in an order that fills the plane evenly.
std::size_t step_of(std::size_t count) {
  auto step = std::max<std::size_t>(1, std::size_t(double(count) * 0.6180339887498949));
  while (std::gcd(step, count) != 1) ++step;
  return step;
}

}  // namespace

PathRays StillTracer::trace(const Picture& picture, const Limits& limits, StillFilm& film,
                            std::uint64_t& pixels) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  const auto is_over = [&] {
    const std::chrono::duration<double, std::milli> taken = Clock::now() - start;
    return taken.count() >= limits.milliseconds || (limits.hurry != nullptr && *limits.hurry);
  };
  const int across = (picture.width_px + kSide - 1) / kSide;
  const int down = (picture.height_px + kSide - 1) / kSide;
  const std::size_t count = std::size_t(across) * std::size_t(down), step = step_of(count);
  const auto paths = std::uint32_t(std::min(picture.shader.paths, kMostPaths));
  const unsigned threads = limits.threads > 0 ? unsigned(usable_threads(limits.threads))
                                              : std::max(1U, std::thread::hardware_concurrency());
  const std::size_t at_once = std::min(count, kSquaresPerThread * threads);
  std::vector<Square> squares(at_once);
  PathRays rays;
  while (!is_over()) {
    parallel_for(
        at_once, {.grain = 1, .threads = limits.threads, .stop = limits.stop}, [&](std::size_t i) {
          const std::size_t index = std::size_t((next_ + i) % count) * step % count;
          Square& square = squares[i];
          square.x = int(index % std::size_t(across)) * kSide;
          square.y = int(index / std::size_t(across)) * kSide;
          square.width = std::min(kSide, picture.width_px - square.x);
          square.rows = 0;
          square.rays = {};
          square.sums.assign(kSide * kSide, {});
          const int height = std::min(kSide, picture.height_px - square.y);
          while (square.rows < height && !(limits.hurry != nullptr && *limits.hurry)) {
            const int y = square.y + square.rows;
            for (int k = 0; k < square.width; ++k) {
              const std::size_t pixel =
                  std::size_t(y) * std::size_t(picture.width_px) + std::size_t(square.x + k);
              square.sums[std::size_t(square.rows * kSide + k)] =
                  shade_pixel(picture.scene, picture.camera, picture.filter, picture.shader,
                              {square.x + k, y, film.paths_of(pixel), paths}, square.rays);
            }
            ++square.rows;
          }
        });
    for (const Square& square : squares) {
      for (int row = 0; row < square.rows; ++row) {
        for (int k = 0; k < square.width; ++k) {
          const std::size_t pixel = std::size_t(square.y + row) * std::size_t(picture.width_px) +
                                    std::size_t(square.x + k);
          film.add(pixel, square.sums[std::size_t(row * kSide + k)], paths);
        }
      }
      pixels += std::uint64_t(square.rows) * std::uint64_t(square.width);
      rays.total += square.rays.total;
      rays.rounded += square.rays.rounded;
    }
    next_ += at_once;
  }
  return rays;
}

}  // namespace arris
