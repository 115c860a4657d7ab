#include "edgepoint/point_raster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#undef HWY_TARGET_INCLUDE
// NOLINTNEXTLINE(readability-identifier-naming)
#define HWY_TARGET_INCLUDE "edgepoint/point_raster.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each kind of processor

#include <hwy/highway.h>

#ifndef ARRIS_EDGEPOINT_POINT_RASTER_ONCE
#define ARRIS_EDGEPOINT_POINT_RASTER_ONCE
namespace arris {

// PixelView in float, for points relative to the eye.
struct FloatView {
  std::array<float, 3> x, y, w;  // rows of pixel_from_world
  std::array<float, 3> eye;
  float width, height;
};

// The points of a block.
struct BlockPoints {
  const float *x, *y, *z;
  std::uint32_t count;
  bool is_far;
};

// What becomes of them.
struct BlockPixels {
  alignas(64) std::array<std::int32_t, kPointBlock> pixel;  // negative: in none
  alignas(64) std::array<std::uint32_t, kPointBlock> cell;
  alignas(64) std::array<std::uint32_t, kPointBlock> depth_bits;
};

}  // namespace arris
#endif

HWY_BEFORE_NAMESPACE();
namespace arris::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// All places of the block, also those beyond its count.
void project_block(const FloatView& view, const BlockPoints& block, BlockPixels& out) {
  const hn::ScalableTag<float> f;
  const hn::RebindToSigned<decltype(f)> s;
  const hn::RebindToUnsigned<decltype(f)> u;
  const float near = block.is_far ? 0.0F : 1.0F;
  const auto eye_x = hn::Set(f, view.eye[0] * near), eye_y = hn::Set(f, view.eye[1] * near),
             eye_z = hn::Set(f, view.eye[2] * near);
  const auto row = [&](const std::array<float, 3>& m, auto x, auto y, auto z) HWY_ATTR {
    return hn::MulAdd(hn::Set(f, m[0]), x,
                      hn::MulAdd(hn::Set(f, m[1]), y, hn::Mul(hn::Set(f, m[2]), z)));
  };
  const auto one = hn::Set(f, 1.0F), four = hn::Set(f, 4.0F), zero = hn::Zero(f);
  const auto width = hn::Set(f, view.width), height = hn::Set(f, view.height);
  // Behind the eye, or so near to it that the division overflows.
  const auto least = hn::Set(f, 1e-30F);
  for (std::size_t i = 0; i < block.count; i += hn::Lanes(f)) {
    const auto x = hn::Sub(hn::LoadU(f, block.x + i), eye_x);
    const auto y = hn::Sub(hn::LoadU(f, block.y + i), eye_y);
    const auto z = hn::Sub(hn::LoadU(f, block.z + i), eye_z);
    const auto w = row(view.w, x, y, z);
    const auto inverse = hn::Div(one, hn::Max(w, least));
    const auto px = hn::Mul(row(view.x, x, y, z), inverse);
    const auto py = hn::Mul(row(view.y, x, y, z), inverse);
    const auto inside =
        hn::And(hn::And(hn::Ge(px, zero), hn::Lt(px, width)),
                hn::And(hn::And(hn::Ge(py, zero), hn::Lt(py, height)), hn::Gt(w, least)));
    // In quarters of pixels; what is outside is anything.
    const auto qx = hn::ConvertTo(s, hn::Mul(hn::Min(hn::Max(px, zero), width), four));
    const auto qy = hn::ConvertTo(s, hn::Mul(hn::Min(hn::Max(py, zero), height), four));
    const auto pixel = hn::Add(hn::Mul(hn::ShiftRight<2>(qy), hn::Set(s, std::int32_t(view.width))),
                               hn::ShiftRight<2>(qx));
    const auto three = hn::Set(s, 3);
    const auto cell = hn::Add(hn::ShiftLeft<2>(hn::And(qy, three)), hn::And(qx, three));
    hn::Store(hn::IfThenElse(hn::RebindMask(s, inside), pixel, hn::Set(s, -1)), s,
              out.pixel.data() + i);
    hn::Store(hn::BitCast(u, cell), u, out.cell.data() + i);
    hn::Store(hn::BitCast(u, w), u, out.depth_bits.data() + i);
  }
}

}  // namespace
}  // namespace arris::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace arris {
namespace {

HWY_EXPORT(project_block);

// Farther than everything else.
constexpr std::uint32_t kFarDepthBits = 0x7f000000;

FloatView make_float_view(const PixelView& view) {
  const Mat3d m = transpose(view.pixel_from_world);
  const auto floats = [](Vec3d v) {
    return std::array<float, 3>{float(v.x), float(v.y), float(v.z)};
  };
  return {floats(m.x),      floats(m.y),          floats(m.z),
          floats(view.eye), float(view.width_px), float(view.height_px)};
}

// Whether any of the block's points may fall into the band.
bool may_touch(const PixelView& view, const PointBlock& block, RowBand band) {
  const Vec3d eye = block.is_far ? Vec3d() : view.eye;
  int above = 0, below = 0, left = 0, right = 0, behind = 0;
  for (unsigned corner = 0; corner < 8; ++corner) {
    const Vec3d p{(corner & 1U) != 0 ? block.upper.x : block.lower.x,
                  (corner & 2U) != 0 ? block.upper.y : block.lower.y,
                  (corner & 4U) != 0 ? block.upper.z : block.lower.z};
    const Vec3d q = view.pixel_from_world * (p - eye);
    // A pixel around covers the rounding of floats.
    above += q.y < (band.first - 1) * q.z ? 1 : 0;
    below += q.y > (band.last + 1) * q.z ? 1 : 0;
    left += q.x < -q.z ? 1 : 0;
    right += q.x > (view.width_px + 1) * q.z ? 1 : 0;
    behind += q.z < 0 ? 1 : 0;
  }
  return above < 8 && below < 8 && left < 8 && right < 8 && behind < 8;
}

}  // namespace

void project_points(const PixelView& view, const PointCache& cache, RowBand band,
                    std::span<PointKey> points) {
  const FloatView floats = make_float_view(view);
  const auto first = std::int32_t(band.first * view.width_px);
  const auto last = std::int32_t(band.last * view.width_px);
  std::fill(points.begin() + first, points.begin() + last, PointKey());
  BlockPixels pixels;
  std::uint32_t number = 0;
  for (const PointBlock& block : cache.blocks()) {
    if (block.count > 0 && may_touch(view, block, band)) {
      const BlockPoints places{cache.x() + number, cache.y() + number, cache.z() + number,
                               block.count, block.is_far};
      HWY_DYNAMIC_DISPATCH(project_block)(floats, places, pixels);
      for (std::uint32_t i = 0; i < block.count; ++i) {
        const std::int32_t pixel = pixels.pixel[i];
        if (pixel < first || pixel >= last) continue;
        const std::uint32_t depth = block.is_far ? kFarDepthBits : pixels.depth_bits[i];
        const PointKey key(depth, number + i, pixels.cell[i]);
        PointKey& nearest = points[std::size_t(pixel)];
        if (key < nearest) nearest = key;
      }
    }
    number += kPointBlock;
  }
}

}  // namespace arris
#endif
