// csg_edges.h — what of a solid of solids is drawn as an edge
// What       CsgEdges finds the edges of a solid once, where its surfaces meet, and its outlines from any eye
// In / Out   the tree's space; eyes at infinity are taken far away
// Guarantee  those of crease_finder.h and csg_outline.h
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "csg/crease_finder.h"
#include "csg/csg_outline.h"

namespace arris {

class CsgEdges {
 public:
  CsgEdges(std::shared_ptr<const CsgCells> cells, int threads,
           const std::atomic<bool>* stop = nullptr);

  struct Segment {
    Vec3d a, b;
  };
  struct Found {
    std::vector<Segment> sharp, silhouette;
  };
  [[nodiscard]] Found find(Vec3d eye, int threads) const;
  // Where rays from the eye touch the solid first and go on beside it: where its shadow may begin.
  [[nodiscard]] std::vector<Segment> find_touched(Vec3d eye, int threads) const;

  [[nodiscard]] const CellProbe& probe() const { return *probe_; }
  // Bounds of the solid's surface.
  [[nodiscard]] Box3d bounds() const;

 private:
  [[nodiscard]] int parts_of(Vec3d along) const;

  std::shared_ptr<const CellProbe> probe_;
  std::shared_ptr<const SmoothPatches> patches_;
  CsgOutline outline_;
  std::vector<CreaseSegment> creases_;
};

// Those of one solid, found when they are first asked for. Any thread may ask; who comes meanwhile waits.
class SharedCsgEdges {
 public:
  // Precondition: always the same cells. Throws Error{failed} once `stop` is set, and finds them when asked again.
  std::shared_ptr<const CsgEdges> find(const std::shared_ptr<const CsgCells>& cells, int threads,
                                       const std::atomic<bool>* stop);

 private:
  std::mutex mutex_;
  std::shared_ptr<const CsgEdges> edges_;
};

}  // namespace arris
