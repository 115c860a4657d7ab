#include "render/csg_edges.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace arris {
namespace {

// The sine of half the turn of a crease's sides.
const double kSlack = std::sin(kSideTurn / 2);

}  // namespace

CsgEdges::CsgEdges(std::shared_ptr<const CsgCells> cells, int threads)
    : probe_(std::make_shared<const CellProbe>(std::move(cells))),
      patches_(std::make_shared<const SmoothPatches>(probe_->solid())),
      outline_(probe_, patches_),
      creases_(find_creases(*probe_, *patches_, threads)) {}

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

std::vector<CsgEdges::Segment> CsgEdges::find_touched(Vec3d eye, int threads) const {
  std::vector<Segment> touched;
  for (const CreaseSegment& crease : creases_) {
    const Vec3d p = crease.middle, step = normalize(p - eye) * probe_->reach();
    if (probe_->contains(crease.cell, p - step) || probe_->contains(crease.cell, p + step))
      continue;
    touched.push_back({crease.a, crease.b});
  }
  for (const OutlineSegment& o : outline_.find(eye, threads)) touched.push_back({o.a, o.b});
  return touched;
}

Box3d CsgEdges::bounds() const {
  return probe_->tree().is_empty() ? Box3d{} : probe_->tree().bounds();
}

std::uint64_t CsgEdges::bytes() const {
  return creases_.size() * sizeof(CreaseSegment) +
         patches_->patches().size() * (sizeof(SmoothPatch) + sizeof(SmoothSurface));
}

}  // namespace arris
