// shade_plan.h — what is to be shaded, and what comes of it
// What       A plan asks for points where the picture wants them, or, in a view that stands still, for more paths
//            through pixels. Shading an item gives a point or a sum of paths, and perhaps a triple for the shadows.
// Guarantee  an item's result depends on the plan alone
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "edgepoint/point_cache.h"
#include "render/point_shader.h"
#include "render/shadow_finder.h"

namespace arris {

// Paths of a pixel of a view that stands still.
struct PixelPaths {
  std::uint32_t pixel = 0, paths = 0;
  Rgb sum;
};

struct ShadeResults {
  std::vector<ShadedPoint> points;
  std::vector<PixelPaths> pixels;
  std::vector<ShadowTriple> triples;
  std::uint64_t items = 0;
  PathRays rays;
  double thread_seconds = 0;  // that these took

  void append(const ShadeResults& other);
};

struct ShadePlan {
  struct Item {
    std::uint32_t pixel = 0;          // by offset
    PointNumber replaces = kNoPoint;  // of a point: the one that is seen there, if any
    std::uint32_t first_path =
        kNoPoint;  // of paths: how many the pixel has; kNoPoint: a point is asked for
  };

  std::shared_ptr<const PreparedScene> scene;
  std::shared_ptr<const std::vector<ShadowLight>> lights;  // null: no triples are asked for
  CameraRays camera{};
  PixelFilter filter{ImageSettings::Filter::box};
  PointShader shader;
  int width_px = 0;
  std::uint32_t frame = 0;
  std::uint64_t view = 0;  // paths of other views are of no use
  std::vector<Item> items;
  // Items that someone has begun, in steps of kStep.
  static constexpr std::size_t kStep = 16;
  mutable std::atomic<std::size_t> begun{0};
};

void shade_item(const ShadePlan& plan, const ShadePlan::Item& item, ShadeResults& results);

}  // namespace arris
