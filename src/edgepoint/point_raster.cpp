#include "edgepoint/point_raster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "base/parallel_for.h"

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
  float longest;  // of what lies in the picture at depth 1: its distance
};

// The points of a block.
struct BlockPoints {
  const float *x, *y, *z;
  const PackedNormal* normals;
  std::uint32_t first;  // number
  std::uint32_t count;
  bool is_far;
};

// Those of them that fall into a band: where, and the halves of their keys. A vector more than there can be.
struct BlockPixels {
  static constexpr std::size_t kRoom = kPointBlock + 64;
  std::array<std::uint32_t, kRoom> pixel;
  std::array<std::uint32_t, kRoom> place;
  std::array<std::uint32_t, kRoom> depth_bits;
};

// Farther than everything else.
inline constexpr std::uint32_t kFarDepthBits = 0x7f000000;

}  // namespace arris
#endif

HWY_BEFORE_NAMESPACE();
namespace arris::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Points that the eye at the origin is behind; a point is at depth w.
template <class F, class V = hn::Vec<F>>
HWY_INLINE hn::Mask<F> find_turned_away(const PackedNormal* normals, V x, V y, V z, V w,
                                        float longest) {
  const F f;
  const hn::RebindToSigned<F> s;
  const hn::Rebind<PackedNormal, F> halves;
  // As in unpack_normal().
  const auto packed = hn::PromoteTo(s, hn::LoadU(halves, normals));
  const auto side = [&](auto v)
                        HWY_ATTR { return hn::Sub(hn::ConvertTo(f, v), hn::Set(f, 128.0F)); };
  const auto nx = side(hn::And(packed, hn::Set(s, 255))), ny = side(hn::ShiftRight<8>(packed));
  const auto nz = hn::Sub(hn::Sub(hn::Set(f, kNormalSteps), hn::Abs(nx)), hn::Abs(ny));
  const auto fold = hn::Max(hn::Neg(nz), hn::Zero(f));
  const auto along = hn::MulAdd(hn::Sub(nx, hn::CopySign(fold, nx)), x,
                                hn::MulAdd(hn::Sub(ny, hn::CopySign(fold, ny)), y, hn::Mul(nz, z)));
  const auto error = hn::Mul(hn::Set(f, kNormalError * kNormalSteps * longest), w);
  return hn::And(hn::Gt(along, error), hn::RebindMask(f, hn::Ne(packed, hn::Zero(s))));
}

// Pixels are told apart by their number in the picture. Returns how many points there are.
std::size_t project_block(const FloatView& view, const BlockPoints& block, RowBand band,
                          BlockPixels& out) {
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
  const auto width = hn::Set(f, view.width);
  const auto top = hn::Set(f, float(band.first)), bottom = hn::Set(f, float(band.last));
  const auto three = hn::Set(s, 3), pixels = hn::Set(s, std::int32_t(view.width));
  const auto far = hn::Set(u, kFarDepthBits), all = hn::Set(u, block.count);
  std::size_t found = 0;
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
    const auto number = hn::Iota(u, std::uint32_t(i));
    const auto inside =
        hn::And(hn::And(hn::And(hn::Ge(px, zero), hn::Lt(px, width)),
                        hn::RebindMask(f, hn::Lt(number, all))),
                hn::And(hn::And(hn::Ge(py, top), hn::Lt(py, bottom)), hn::Gt(w, least)));
    if (hn::AllFalse(f, inside)) continue;
    const auto shown = hn::AndNot(
        find_turned_away<decltype(f)>(block.normals + i, x, y, z, w, view.longest), inside);
    // In quarters of pixels; what is outside is anything.
    const auto qx = hn::ConvertTo(s, hn::Mul(hn::Min(hn::Max(px, zero), width), four));
    const auto qy = hn::ConvertTo(s, hn::Mul(hn::Min(hn::Max(py, top), bottom), four));
    const auto pixel = hn::Add(hn::Mul(hn::ShiftRight<2>(qy), pixels), hn::ShiftRight<2>(qx));
    const auto cell = hn::Add(hn::ShiftLeft<2>(hn::And(qy, three)), hn::And(qx, three));
    const auto place =
        hn::Or(hn::ShiftLeft<4>(hn::Add(number, hn::Set(u, block.first))), hn::BitCast(u, cell));
    const auto depth = block.is_far ? far : hn::BitCast(u, w);
    // Compressed in a register: storing while compressing is slow on some processors.
    const auto in = hn::RebindMask(u, shown);
    hn::StoreU(hn::Compress(hn::BitCast(u, pixel), in), u, out.pixel.data() + found);
    hn::StoreU(hn::Compress(place, in), u, out.place.data() + found);
    hn::StoreU(hn::Compress(depth, in), u, out.depth_bits.data() + found);
    found += hn::CountTrue(f, shown);
  }
  return found;
}

}  // namespace
}  // namespace arris::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace arris {
namespace {

HWY_EXPORT(project_block);

FloatView make_float_view(const PixelView& view) {
  const Mat3d m = transpose(view.pixel_from_world);
  const auto floats = [](Vec3d v) {
    return std::array<float, 3>{float(v.x), float(v.y), float(v.z)};
  };
  const Mat3d rays = inverse(view.pixel_from_world);
  double longest = 0;
  for (const double x : {0, view.width_px}) {
    for (const double y : {0, view.height_px}) {
      longest = std::max(longest, length(rays * Vec3d{x, y, 1}));
    }
  }
  return {floats(m.x),          floats(m.y),           floats(m.z),   floats(view.eye),
          float(view.width_px), float(view.height_px), float(longest)};
}

RowBand rows_of(const PixelView& view, const PointBlock& block) {
  if (block.count == 0) return {};
  const Mat3d& m = view.pixel_from_world;
  const Vec3d eye = block.is_far ? Vec3d() : view.eye;
  const Vec3d lowest = m * (Vec3d(block.lower) - eye);
  const Vec3d size = Vec3d(block.upper) - Vec3d(block.lower);
  const Vec3d along[3] = {m.x * size.x, m.y * size.y, m.z * size.z};
  int above = 0, below = 0, left = 0, right = 0, behind = 0;
  double first = view.height_px, last = 0;
  for (unsigned corner = 0; corner < 8; ++corner) {
    Vec3d q = lowest;
    for (unsigned k = 0; k < 3; ++k) {
      if ((corner >> k & 1U) != 0) q += along[k];
    }
    // A pixel around covers the rounding of floats.
    above += q.y < -q.z ? 1 : 0;
    below += q.y > (view.height_px + 1) * q.z ? 1 : 0;
    left += q.x < -q.z ? 1 : 0;
    right += q.x > (view.width_px + 1) * q.z ? 1 : 0;
    behind += q.z <= 0 ? 1 : 0;
    if (q.z > 0) {
      first = std::min(first, q.y / q.z - 1);
      last = std::max(last, q.y / q.z + 1);
    }
  }
  if (above == 8 || below == 8 || left == 8 || right == 8 || behind == 8) return {};
  if (behind > 0) return {0, view.height_px};
  return {int(std::max(first, 0.0)), int(std::min(last, double(view.height_px))) + 1};
}

}  // namespace

std::vector<RowBand> find_block_rows(const PixelView& view, const PointCache& cache, int threads) {
  const std::span<const PointBlock> blocks = cache.blocks();
  std::vector<RowBand> rows(blocks.size());
  parallel_for(blocks.size(), {.grain = 512, .threads = threads},
               [&](std::size_t i) { rows[i] = rows_of(view, blocks[i]); });
  return rows;
}

void project_points(const PixelView& view, const PointCache& cache,
                    std::span<const RowBand> block_rows, RowBand band, std::span<PointKey> points,
                    std::span<std::uint32_t> seen) {
  const FloatView floats = make_float_view(view);
  std::fill(points.begin() + std::ptrdiff_t(band.first) * view.width_px,
            points.begin() + std::ptrdiff_t(band.last) * view.width_px, PointKey());
  BlockPixels found;
  for (std::uint32_t b = 0; b < block_rows.size(); ++b) {
    if (block_rows[b].first >= band.last || block_rows[b].last <= band.first) continue;
    const PointBlock& block = cache.blocks()[b];
    const std::uint32_t first = b * kPointBlock;
    const BlockPoints places{
        cache.x() + first, cache.y() + first, cache.z() + first, cache.normals() + first, first,
        block.count,       block.is_far};
    const std::size_t count = HWY_DYNAMIC_DISPATCH(project_block)(floats, places, band, found);
    for (std::size_t i = 0; i < count; ++i) {
      PointKey& nearest = points[found.pixel[i]];
      const PointKey key(found.depth_bits[i], found.place[i]), before = nearest;
      // Which is nearer can't be guessed, so there is no branch; the count past the last block's is of no block.
      const bool nearer = key < before;
      nearest = nearer ? key : before;
      seen[b] += nearer ? 1 : 0;
      const std::size_t loser = nearer ? before.point() / kPointBlock : block_rows.size();
      --seen[std::min(loser, block_rows.size())];
    }
  }
}

}  // namespace arris
#endif
