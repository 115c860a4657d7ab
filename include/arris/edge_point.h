// edge_point.h — a moving view of a scene under expensive light
// What       EdgePointEngine makes one frame after another from few shaded points and from edges found analytically:
//            a pixel takes its colour from points that no edge parts from it. Points are kept from frame to frame;
//            each frame asks for new ones where they are missed most.
// Guarantee  next_frame() never waits for shading, and its own work does not depend on what shading costs, but where
//            it traces every pixel because that is cheap (`trace_below_ms`). With
//            `synchronous` the same calls give the same frames, at any number of threads.
// Limits     one thread at a time may call an engine
// Source     K. Bala, B. Walter, D. P. Greenberg, "Combining Edges and Points for Interactive High-Quality
//            Rendering", SIGGRAPH 2003
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>

#include "arris/image.h"
#include "arris/render.h"
#include "arris/scene.h"

namespace arris {

// What a point's colour is made of.
enum class EdgePointShader {
  direct,  // emission, and light that comes straight from lights and environment
  glossy,  // and what glossy surfaces, mirrors and glass show
  gi,      // and all light between surfaces: path tracing
};

// The engine throws Error{input} for what is not so.
struct EdgePointSettings {
  EdgePointShader shader = EdgePointShader::gi;
  // New points a frame, in parts of the pixels: above 0, at most 1.
  double density = 0.02;
  // And up to so many where much is wrong or missing: after lights or objects have moved, or much has come into view.
  // 0: no more than `density`.
  double most_density = 0;
  int paths_per_point = 0;  // 0: as many as the shader needs for little noise
  // False: points are interpolated across everything, as in the Render Cache.
  bool use_edges = true;
  bool shadow_edges = true;  // of lights and the sun
  // Pixels with several edges are reconstructed at twice the resolution.
  bool complex_filter = true;
  // Points keep light, and pixels multiply it by their own textures; false: points keep colours, as in the paper.
  bool sharp_textures = true;
  bool synchronous = false;    // shading is done within next_frame()
  double first_density = 0.2;  // synchronous: of points before the first frame; 0: as `density`
  // A frame is made by tracing a point's paths through every pixel where that takes less: milliseconds, or, unless
  // `synchronous`, less than edges and points take themselves. If `synchronous`, by a ray's fixed cost. 0: never.
  double trace_below_ms = 0;
  // Not `synchronous`: a view that has stood still for so many milliseconds is traced within next_frame(), for a
  // quarter of a second each, instead of by points beside it. 0: never.
  double trace_still_ms = 0;
  std::uint32_t seed = 0;
  int threads = 0;  // 0: all
  // `synchronous`: asked while points are shaded, by any of the threads, whether the rest of them is left out.
  // has_picture: the frame has one already, and it is about the next one; else next_frame() throws Error{failed} for
  // yes. Empty: never.
  std::function<bool(bool has_picture)> must_end;
  // Set from any thread: what only makes a view that stands still finer ends soon.
  const std::atomic<bool>* hurry = nullptr;
  // Set from any thread: next_frame(), and what the constructor prepares, end with Error{failed}.
  const std::atomic<bool>* stop = nullptr;
};

struct EdgePointStats {
  // Milliseconds.
  struct Stages {
    double edges = 0, raster = 0, points = 0, classify = 0, reachability = 0, textures = 0,
           interpolation = 0, antialias = 0, complex = 0, total = 0;
  } stages;
  // Pixels.
  struct Classes {
    std::uint64_t empty = 0, simple = 0, complex = 0;
  } classes;
  struct Edges {
    std::uint64_t silhouette = 0, sharp = 0, shadow = 0;
  } edges;
  // Every pixel was traced, without edges and points: stages but `total`, which has the tracing in it, classes and
  // edges are 0.
  bool traced = false;
  // Paths of the view that stands still were traced within this frame (trace_still_ms).
  bool traced_still = false;
  // Shaded since the last frame: points, and pixels of a view that stands still. `synchronous`: for this frame where
  // something has changed, else for the next one.
  std::uint64_t new_points = 0;
  std::uint64_t points = 0;      // in the cache
  std::uint64_t hidden = 0;      // of them, seen through gaps and left out
  std::uint64_t unresolved = 0;  // pixels that no sample reaches
  // In a view that stands still: paths of its own of the pixel that has the fewest.
  std::uint32_t still_paths = 0;
  RayCounts rays;              // of shading since the last frame
  double shading_seconds = 0;  // synchronous: of the new points; of traced frames
  std::uint64_t cache_bytes = 0, image_bytes = 0;
};

class EdgePointEngine {
 public:
  explicit EdgePointEngine(std::shared_ptr<const PreparedScene> scene,
                           const EdgePointSettings& settings = {});
  EdgePointEngine(const EdgePointEngine&) = delete;
  EdgePointEngine& operator=(const EdgePointEngine&) = delete;
  ~EdgePointEngine();

  // next_frame() throws Error{input} for a camera that validate_scene() would refuse.
  void set_camera(const Camera& camera);
  // Changes show in the first frame for which they are prepared: the next one if `synchronous`, else as soon as a
  // thread of their own is done with them. Scenes that were prepared with Placement::movable are quick to change.
  // next_frame() throws Error{input} for an object or light that is not there, and what does not fit.
  void move_object(std::uint32_t object, const Affine3d& world_from_object);
  void set_light(std::uint32_t light, const Light& value);
  // Of all objects without settings of their own.
  void set_rounding(const RoundingSettings& settings);
  // The same objects, some of them elsewhere, with other lights or roundings: what prepare_moved() and
  // prepare_again() make of the scene before. What was set last counts: moves, lights and roundings that were set
  // before and do not show yet are dropped, those that are set after it change the new scene. The camera stays.
  void set_scene(std::shared_ptr<const PreparedScene> scene);

  // The scene of the last frame.
  [[nodiscard]] const std::shared_ptr<const PreparedScene>& scene() const;

  // The frame of the camera and scene as they are now; valid until the next call.
  const Image& next_frame();
  [[nodiscard]] const EdgePointStats& stats() const;
  // 3 channels, of the last frame: empty pixels black, simple ones blue, complex ones red; those with a point
  // brighter.
  [[nodiscard]] Image classes_picture() const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace arris
