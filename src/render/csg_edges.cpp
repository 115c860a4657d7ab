#include "render/csg_edges.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace arris {
namespace {

// The sine of half the turn of a crease's sides.
const double kSlack = std::sin(kSideTurn / 2);
// Of the solid's size.
constexpr double kTouchedPart = 1.0 / 32;
// Ends are looked at this part of a segment before them.
constexpr double kInset = 1e-3;
// What is nearer to a piece than so many CellProbe::reach() doesn't stand in its light: its own surface.
constexpr double kBeside = 100;

}  // namespace

CsgEdges::CsgEdges(std::shared_ptr<const CsgCells> cells, int threads,
                   const std::atomic<bool>* stop)
    : probe_(std::make_shared<const CellProbe>(std::move(cells))),
      patches_(std::make_shared<const SmoothPatches>(probe_->solid())),
      outline_(probe_, patches_),
      creases_(find_creases(*probe_, *patches_, threads, stop)) {}

CsgEdges::Found CsgEdges::find(Vec3d eye, int threads) const {
  Found found;
  for (const CreaseSegment& crease : creases_) {
    // Normals are those of the segment's middle.
    const Vec3d view = eye - (crease.a + crease.b) * 0.5;
    const double slack = kSlack * length(view);
    const double side0 = dot(crease.normal[0], view), side1 = dot(crease.normal[1], view);
    const bool any_front = std::max(side0, side1) > -slack;
    const bool any_back = std::min(side0, side1) < slack;
    if (crease.kind == CreaseSegment::Kind::soft) {
      if (any_front && any_back) found.silhouette.push_back({crease.a, crease.b});
    } else if (crease.kind == CreaseSegment::Kind::contact || any_front) {
      found.sharp.push_back({crease.a, crease.b});
    }
  }
  for (const OutlineSegment& o : outline_.find(eye, threads)) {
    found.silhouette.push_back({o.a, o.b});
  }
  return found;
}

// A ray that touches is outside the solid on both sides. Pieces that touch at an end only are taken whole, rather than
// none of them; long ones are cut, as rays may touch a part.
std::vector<CsgEdges::Segment> CsgEdges::find_touched(Vec3d eye, int threads) const {
  const auto touches = [&](std::uint32_t cell, Vec3d p) {
    const Vec3d step = normalize(p - eye) * probe_->reach();
    return !probe_->contains(cell, p - step) && !probe_->contains(cell, p + step);
  };
  const auto is_lit = [&](Vec3d p) {
    return !probe_->meets({p, eye - p}, kBeside * probe_->reach() / length(eye - p), 1);
  };
  std::vector<Segment> touched;
  const auto add = [&](Vec3d a, Vec3d b) {
    if (is_lit((a + b) * 0.5) || is_lit(a) || is_lit(b)) touched.push_back({a, b});
  };
  for (const CreaseSegment& crease : creases_) {
    const int parts = parts_of(crease.b - crease.a);
    const Vec3d d = (crease.b - crease.a) / parts;
    for (int i = 0; i < parts; ++i) {
      const Vec3d a = crease.a + d * i, b = crease.a + d * (i + 1);
      const Vec3d middle = parts == 1 ? crease.middle : (a + b) * 0.5;
      const bool any = touches(crease.cell, middle) || touches(crease.cell, a + d * kInset) ||
                       touches(crease.cell, b - d * kInset);
      if (any) add(a, b);
    }
  }
  for (const OutlineSegment& o : outline_.find(eye, threads)) {
    const int parts = parts_of(o.b - o.a);
    const Vec3d d = (o.b - o.a) / parts;
    for (int i = 0; i < parts; ++i) add(o.a + d * i, o.a + d * (i + 1));
  }
  return touched;
}

int CsgEdges::parts_of(Vec3d along) const {
  return std::max(1, int(std::ceil(length(along) / (kTouchedPart * probe_->size()))));
}

Box3d CsgEdges::bounds() const {
  return probe_->tree().is_empty() ? Box3d{} : probe_->tree().bounds();
}

std::shared_ptr<const CsgEdges> SharedCsgEdges::find(const std::shared_ptr<const CsgCells>& cells,
                                                     int threads, const std::atomic<bool>* stop) {
  const std::lock_guard lock(mutex_);
  if (!edges_) edges_ = std::make_shared<const CsgEdges>(cells, threads, stop);
  return edges_;
}

}  // namespace arris
