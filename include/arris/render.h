// render.h — from a scene to a picture
// What       prepare_scene() builds everything that depends on geometry, once; renderers share the
//            result and only read it. A renderer turns it into pictures.
// Guarantee  same scene, options and sample range: same bytes, at any number of threads
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "arris/image.h"
#include "arris/rounding.h"
#include "arris/scene.h"

namespace arris {

// Everything that is wrong with a scene, one line each; empty if nothing is.
std::vector<std::string> validate_scene(const Scene& scene);

// Throws them all as one Error of that place.
void check_scene(const Scene& scene, const std::string& where);

// How objects lie in the acceleration structure.
enum class Placement {
  baked,    // in the world, as far as memory allows: the fastest to trace
  movable,  // each in its own space, so that prepare_moved() need not build it again
};

class PreparedScene;

struct PrepareOptions {
  int threads = 0;  // 0: all
  Detection detection = Detection::face_index;
  // Set from any thread; looked at between the steps, which ends with an Error of kind failed.
  const std::atomic<bool>* stop = nullptr;
  Placement placement = Placement::baked;
  // Of prepare_scene(): one that was prepared from a copy of the same Scene before it was changed. CSG solids that both
  // have are taken from it. It need not outlive the call.
  const PreparedScene* solids_of = nullptr;
};

// Throws Error with every problem of validate_scene(), or the first one of the rounding.
std::shared_ptr<const PreparedScene> prepare_scene(Scene scene, const PrepareOptions& options = {});
// The same scene with another default rounding: only the rounding is built, meshes and their acceleration structure
// are shared (but with bevel meshes, before or after). Objects with settings of their own keep them.
std::shared_ptr<const PreparedScene> prepare_again(const PreparedScene& prepared,
                                                   const RoundingSettings& scene_default,
                                                   const PrepareOptions& options = {});

// The scene that was prepared, or a copy of scene_of() it, with other camera, transforms and lights: what is in the
// objects' own spaces is shared, where the placement is movable, and otherwise if no object has moved. `prepared` stays
// as it is and may be in use. Automatic radii stay those that were prepared, so that edges don't swell while the
// camera comes near.
// Precondition: meshes, CSG trees, materials and textures are the same, not copies (SharedVector::is_same_as()); the
// objects' parts, materials and roundings are equal, and so is the environment. Throws Error{input} otherwise, and for
// what validate_scene() says of cameras, transforms and lights.
// Cost: a few microseconds for each object, besides the points of those that move; bevel meshes are made anew.
std::shared_ptr<const PreparedScene> prepare_moved(const PreparedScene& prepared, Scene moved,
                                                   const PrepareOptions& options = {});

// What rounding did to one object.
struct RoundingSummary {
  std::string object;  // its name, and its place in Scene::objects
  std::uint32_t object_index = 0;
  double radius = 0;  // world units; 0: not rounded
  std::uint64_t edges = 0, corners = 0;
  std::vector<RoundingNote> notes;   // docs/rounding.md lists them
  std::vector<ClampedEdge> clamped;  // in world space
};

struct PrepareStats {
  double build_seconds = 0, round_seconds = 0;
  std::uint64_t triangles = 0, objects = 0;
  std::uint64_t rounded_edges = 0, rounded_corners = 0;
  std::uint64_t geometry_bytes = 0, rounding_bytes = 0;
  std::vector<RoundingSummary> rounding;
};
const PrepareStats& prepare_stats(const PreparedScene& prepared);
const Scene& scene_of(const PreparedScene& prepared);  // with camera and environment filled in

// Half-open range of the sample sequence. Two parts A..B and B..C, averaged with their counts as weights, are the
// render A..C to the rounding of their floats; their sums (RenderResult::sum) are it to the bit.
struct SampleRange {
  std::uint32_t first = 0, last = 64;
};

struct Progress {
  double done = 0;  // 0..1
  double elapsed_seconds = 0;
};

struct RenderOptions {
  SampleRange samples;
  double time_limit_seconds = 0;    // 0: none
  std::uint32_t least_samples = 1;  // made even if the time is over
  std::uint32_t seed = 0;
  int threads = 0;                // 0: all
  std::vector<std::string> aovs;  // of Renderer::aovs()
  // Set from any thread; the render ends within a second, perhaps without any sample.
  const std::atomic<bool>* stop = nullptr;
  std::function<void(const Progress&)> on_progress;  // from one thread at a time
};

struct RayCounts {
  std::uint64_t camera = 0, total = 0;
  // Rays whose hit was on, or that passed through, a rounded edge or corner.
  std::uint64_t rounded = 0;
};

// What the beam renderer found.
struct BeamCounts {
  std::uint64_t regions = 0;      // beams that were looked at
  std::uint64_t rays = 0;         // that stand for what stayed unknown
  double certified_fraction = 0;  // of the picture's area
  std::uint64_t uncertified_pixels =
      0;  // with a surface whose coverage is known to less than 1/512
};

struct PictureSum;  // the program's (src/image/picture_sum.h)

struct RenderResult {
  Picture picture;                        // 0 x 0 pixels without samples
  std::shared_ptr<const PictureSum> sum;  // of which `picture` is the mean
  SampleRange samples;                    // what was rendered: shorter than asked for if stopped
  RayCounts rays;
  std::optional<BeamCounts> beam;
  double seconds = 0;
};

class Renderer {
 public:
  virtual ~Renderer() = default;
  // AOV names it can fill.
  [[nodiscard]] virtual std::vector<std::string> aovs() const = 0;
  [[nodiscard]] virtual RenderResult render(const PreparedScene& scene,
                                            const RenderOptions& options) const = 0;
};

std::unique_ptr<Renderer> make_path_renderer();

// certified: bounds decide; corners: four rays decide, as in the paper, for comparison.
enum class BeamRule { certified, corners };
struct BeamSettings {
  BeamRule rule = BeamRule::certified;
  // Each area light is so many point lights a side, with shadows as sharp as those of point lights; 0: it is sampled.
  int light_beams = 0;
  // Light between surfaces is followed by glossy ones, mirrors and glass alone, as by EdgePointShader::glossy.
  bool only_glossy = false;
};
inline constexpr int kMostLightBeams = 16;
// The coverage of every surface in every pixel between certain bounds (docs/beam.md). Every pixel is its square,
// whatever the image's filter. Precondition: beam_problems() is empty.
std::unique_ptr<Renderer> make_beam_renderer(const BeamSettings& settings = {});
// What of a scene the beam renderer can't take, one line each with a remedy.
std::vector<std::string> beam_problems(const Scene& scene);

}  // namespace arris
