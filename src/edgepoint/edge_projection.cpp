#include "edgepoint/edge_projection.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

#undef HWY_TARGET_INCLUDE
// NOLINTNEXTLINE(readability-identifier-naming)
#define HWY_TARGET_INCLUDE "edgepoint/edge_projection.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each kind of processor

#include <hwy/highway.h>

#include "edgepoint/bit_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace arris::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Doubles = hn::ScalableTag<double>;
using D = hn::Vec<Doubles>;

HWY_INLINE D on_grid(D v) {
  const Doubles d;
  const D zero = hn::Zero(d), one = hn::Set(d, 1), half = hn::Set(d, 0.5);
  const D places = hn::Mul(v, hn::Set(d, kScreenGrid)), below = hn::Trunc(places);
  const D rest = hn::Sub(places, below);
  const D up = hn::IfThenElse(hn::Ge(rest, half), one, zero);
  const D down = hn::IfThenElse(hn::Le(rest, hn::Neg(half)), one, zero);
  return hn::Mul(hn::Sub(hn::Add(below, up), down), hn::Set(d, 1 / kScreenGrid));
}

// Ends of edges, one after the other: x, y, z in the world become x, y, 1 / w in the picture. Two lanes are the ends
// of one edge. Returns a bit for each edge that has to be clipped, of which the rest is anything.
std::uint64_t project_ends(const PixelView& view, const float* in, float* out) {
  const Doubles d;
  const hn::Rebind<float, Doubles> f;
  hn::Vec<decltype(f)> x, y, z;
  hn::LoadInterleaved3(f, in, x, y, z);
  const D px = hn::Sub(hn::PromoteTo(d, x), hn::Set(d, view.eye.x));
  const D py = hn::Sub(hn::PromoteTo(d, y), hn::Set(d, view.eye.y));
  const D pz = hn::Sub(hn::PromoteTo(d, z), hn::Set(d, view.eye.z));
  const Mat3d& m = view.pixel_from_world;
  // In the order of project(), so that the bits are the same.
  const auto row = [&](double mx, double my, double mz) HWY_ATTR {
    return hn::Add(hn::Add(hn::Mul(hn::Set(d, mx), px), hn::Mul(hn::Set(d, my), py)),
                   hn::Mul(hn::Set(d, mz), pz));
  };
  const D xw = row(m.x.x, m.y.x, m.z.x), yw = row(m.x.y, m.y.y, m.z.y),
          w = row(m.x.z, m.y.z, m.z.z);
  const D zero = hn::Zero(d), around = hn::Set(d, kAroundPicture);
  const D near = hn::Mul(hn::Set(d, kNearest), hn::Max(w, hn::Reverse2(d, w)));
  const D right = hn::Set(d, view.width_px + kAroundPicture);
  const D bottom = hn::Set(d, view.height_px + kAroundPicture);
  auto inside = hn::And(hn::Gt(near, zero), hn::Ge(hn::Sub(w, near), zero));
  inside = hn::And(inside, hn::Ge(hn::Add(xw, hn::Mul(around, w)), zero));
  inside = hn::And(inside, hn::Ge(hn::Add(yw, hn::Mul(around, w)), zero));
  inside = hn::And(inside, hn::Ge(hn::Sub(hn::Mul(right, w), xw), zero));
  inside = hn::And(inside, hn::Ge(hn::Sub(hn::Mul(bottom, w), yw), zero));
  hn::StoreInterleaved3(hn::DemoteTo(f, on_grid(hn::Div(xw, w))),
                        hn::DemoteTo(f, on_grid(hn::Div(yw, w))),
                        hn::DemoteTo(f, hn::Div(hn::Set(d, 1), w)), f, out);
  return ~bits_of(d, inside);
}

void project_all(const PixelView& view, std::span<const WorldEdge> edges, ScreenEdge* out) {
  static_assert(sizeof(WorldEdge) == 6 * sizeof(float) && sizeof(ScreenEdge) == 6 * sizeof(float));
  const std::size_t step = hn::Lanes(Doubles()) / 2;
  std::size_t i = 0;
  for (; i + step <= edges.size(); i += step) {
    const std::uint64_t clipped = project_ends(view, &edges[i].a.x, &out[i].x0);
    const std::uint64_t all = (std::uint64_t{1} << 2 * step) - 1;
    for (std::uint64_t rest = clipped & all; rest != 0;) {
      const auto of = std::size_t(std::countr_zero(rest)) / 2;
      out[i + of] = arris::project_edge(view, edges[i + of]);
      rest &= ~(std::uint64_t{3} << 2 * of);
    }
  }
  for (; i < edges.size(); ++i) out[i] = arris::project_edge(view, edges[i]);
}

}  // namespace
}  // namespace arris::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace arris {
namespace {

HWY_EXPORT(project_all);

void project_list(const PixelView& view, std::span<const WorldEdge> edges,
                  std::vector<ScreenEdge>& out) {
  out.resize(edges.size());
  HWY_DYNAMIC_DISPATCH(project_all)(view, edges, out.data());
}

// False if an edge crosses none of the lines, or is hidden wherever it does.
bool may_be_seen(const ScreenEdge& e, const DepthCells& depth) {
  const auto half = [](float v) { return std::floor(2 * v); };
  // Neither can be guessed: no branches.
  const unsigned crosses = unsigned(half(e.x0) != half(e.x1)) | unsigned(half(e.y0) != half(e.y1));
  // More than what is added by rounding, where inverse depths are interpolated.
  constexpr float kAbove = 1.00001F;
  const float nearest = std::max(e.inverse_depth0, e.inverse_depth1) * kAbove;
  const bool hidden = nearest * depth.limit_around({e.x0, e.y0}, {e.x1, e.y1}) < 1;
  return (crosses & unsigned(!hidden)) != 0;
}

// is_kept(i): whether the i-th is. That can't be guessed, so there is no branch: each is written where the last one was
// that wasn't kept.
template <class IsKept>
void keep(std::vector<ScreenEdge>& edges, const IsKept& is_kept) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const bool kept = is_kept(i);
    edges[count] = edges[i];
    count += kept ? 1 : 0;
  }
  edges.resize(count);
}

}  // namespace

void project_seen(const PixelView& view, std::span<const WorldEdge> edges, const DepthCells& depth,
                  std::vector<ScreenEdge>& seen) {
  project_list(view, edges, seen);
  keep(seen, [&](std::size_t i) { return may_be_seen(seen[i], depth); });
}

void project_seen(const PixelView& view, std::span<const SoftEdge> edges, const DepthCells& depth,
                  std::vector<ScreenEdge>& seen) {
  std::vector<WorldEdge> hard;
  hard.reserve(edges.size());
  for (const SoftEdge& edge : edges) hard.push_back(edge.edge);
  project_list(view, hard, seen);
  keep(seen, [&](std::size_t i) {
    return may_be_seen(seen[i], depth) && penumbra_matters(view, edges[i], seen[i]);
  });
}

}  // namespace arris
#endif
