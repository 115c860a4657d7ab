#include "edge_point/motion.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

namespace arris::bench {
namespace {

using Clock = std::chrono::steady_clock;

// Frames before those that are timed: of the first points, shadows and memory pages.
constexpr int kWarmUp = 30;
// Of paths of objects and lights: frames of a round, and its radius in distances of the camera.
constexpr double kRound = 120;
constexpr double kReach = 0.03;

double ms_between(Clock::time_point from, Clock::time_point to) {
  return std::chrono::duration<double, std::milli>(to - from).count();
}

double part_of(std::vector<double> values, double part) {
  std::ranges::sort(values);
  return values.empty() ? 0 : values[std::size_t(part * double(values.size() - 1))];
}

struct Moved {
  Vec3d by;

  Light operator()(PointLight light) const {
    light.position += by;
    return light;
  }
  Light operator()(SpotLight light) const {
    light.position += by;
    return light;
  }
  Light operator()(AreaLight light) const {
    light.corner += by;
    return light;
  }
  Light operator()(DirectionalLight light) const {
    light.direction = normalize(light.direction + by);
    return light;
  }
};

Affine3d moved(Affine3d world, Vec3d by) {
  world.translation += by;
  return world;
}

}  // namespace

MotionTimes measure_motion(const FlightScene& flight, const MotionOptions& options) {
  Scene described = flight.scene;
  described.image.width_px = options.flight.width_px;
  described.image.height_px = options.flight.height_px;
  const Affine3d start = described.objects[flight.mover].world_from_object;
  const Light light = described.lights[0];
  const double reach = kReach * length(described.camera->position - flight.pivot);
  EdgePointSettings settings;
  settings.shader = flight.shader;
  settings.density = options.flight.density;
  EdgePointEngine engine(prepare_scene(std::move(described), {.placement = Placement::movable}),
                         settings);

  MotionTimes out;
  std::vector<double> frames, edges, delays, points, shadows;
  std::vector<std::pair<Affine3d, Clock::time_point>> waiting;
  for (int i = 0; i < kWarmUp + options.flight.frames; ++i) {
    const double a = 2 * kPi * i / kRound;
    const Affine3d world = moved(start, Vec3d{std::cos(a) - 1, std::sin(a), 0} * reach);
    engine.set_camera(flight_camera(flight, i));
    engine.move_object(flight.mover, world);
    engine.set_light(0, std::visit(Moved{Vec3d{std::sin(a), std::cos(a) - 1, 0} * reach}, light));
    const Clock::time_point before = Clock::now();
    waiting.emplace_back(world, before);
    engine.next_frame();
    const Clock::time_point after = Clock::now();
    const Affine3d& shown = scene_of(*engine.scene()).objects[flight.mover].world_from_object;
    const auto it =
        std::ranges::find(waiting, shown, &std::pair<Affine3d, Clock::time_point>::first);
    if (i >= kWarmUp) {
      frames.push_back(ms_between(before, after));
      edges.push_back(engine.stats().stages.edges);
      points.push_back(double(engine.stats().new_points));
      shadows.push_back(double(engine.stats().edges.shadow));
      if (it != waiting.end()) delays.push_back(ms_between(it->second, after));
    }
    if (it != waiting.end()) waiting.erase(waiting.begin(), it + 1);
    std::this_thread::sleep_until(after +
                                  std::chrono::duration<double, std::milli>(options.pause_ms));
  }
  const auto longest = std::ranges::max_element(frames);
  out.median_ms = part_of(frames, 0.5);
  out.most_of_100_ms = part_of(frames, 0.99);
  out.longest_ms = *longest;
  out.longest_at = int(longest - frames.begin());
  out.edges_ms = part_of(edges, 0.5);
  out.longest_edges_ms = part_of(edges, 1);
  out.delay_ms = part_of(delays, 0.5);
  out.new_points = part_of(points, 0.5);
  out.shadow_edges = part_of(shadows, 0.5);
  return out;
}

}  // namespace arris::bench
