// texture_tints.h — the tints of a picture's pixels, from one ray each
// What       A ray through the primary region of every pixel within reach of a point on a textured object finds what
//            is seen there; its texture is averaged over the pixel's filter along the surface's plane.
// Guarantee  what is kept of the frames before is what would be found again
// Limits     only base colours: other textures, and base colours of surfaces that transmit, emit or let light through
//            in parts, are interpolated with the light
// Cost       a ray and 1 to 64 texture lookups a pixel, in a view that moves
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "edgepoint/edge_point_image.h"
#include "edgepoint/point_cache.h"
#include "edgepoint/tint_image.h"
#include "render/camera.h"
#include "render/pixel_filter.h"
#include "render/prepared_scene.h"
#include "render/texture_levels.h"

namespace arris {

// By object: whether a material of it has a texture that tints.
std::vector<bool> find_tinted_objects(const Scene& scene);
inline bool has_tints(const Scene& scene) {
  return !find_tinted_objects(scene).empty();
}

// How a place of the picture is looked at: what is seen there is averaged over the filter.
struct PixelLooks {
  PixelFilter filter;
  TextureLevels levels;

  // The levels of all textures that tint.
  PixelLooks(const Scene& scene, ImageSettings::Filter shape, int threads);
};

// The base colour with the texture, over that without it, of what a ray through a place of the picture sees; nothing
// if that has none.
std::optional<Rgb> find_tint(const PreparedScene& scene, const CameraRays& camera,
                             const PixelLooks& looks, Vec2f place);

// What it sees: which part of even light that reflects, with its texture averaged like that, and its shading normal. 1
// and 0 where the ray leaves the scene; 1 also where the surface emits, transmits or lets light through.
struct SeenSurface {
  Rgb albedo{1, 1, 1};
  Vec3f normal;
};
SeenSurface see_surface(const PreparedScene& scene, const CameraRays& camera,
                        const PixelLooks& looks, Vec2f place);

// A place in a pixel's primary region, from its upper left corner: the point's, else near the region's middle.
Vec2f primary_place_of(const EdgePointImage& image, int x, int y);

class TextureTints {
 public:
  explicit TextureTints(const Scene& scene, int threads);

  // Camera or scene have changed.
  void clear();
  // Null if no object can be tinted.
  const TintImage* update(const PreparedScene& scene, const CameraRays& camera,
                          const PointCache& cache, const EdgePointImage& image, int threads);

 private:
  void mark_points(const PointCache& cache, const EdgePointImage& image, int y);
  void tint_row(const PreparedScene& scene, const CameraRays& camera, const EdgePointImage& image,
                int y);

  PixelLooks looks_;
  std::vector<bool> objects_;  // empty: none is
  BitPlane marked_;            // pixels with a point on such an object
  TintImage tints_;
  // Where a pixel was looked at, as primary_place() says; kNotYet: nowhere.
  std::vector<std::uint8_t> looked_;
};

}  // namespace arris
