// clearance.h — may the rounding take away what it is about to?
// What       On solids that aren't exact an arc knows its own two faces only, a corner the faces around it. What either
//            takes away lies in a *cut*: of an arc the prism between its edge, the two lines where its cylinder
//            touches the faces, and its end planes; of a corner what lies beyond the end planes of all its edges. A
//            cut is free if no other surface of the shell reaches into its void, its faces go on as far as its
//            cylinder or sphere touches them, and it does not overlap the cut of another corner's edges.
// Guarantee  where all cuts are free, the rounded surface lies within the solid, no void connects two of its sides, and
//            every face keeps what lies beyond the touching lines (tests/rounding/local_rounding_test.cpp)
// Limits     where a face goes on smoothly (facets of a curved surface) cuts may reach past its end by as much as keeps
//            the cylinder within kSmoothDepth of the radius from the surface
// Cost       about n log n in the triangles and cuts
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "edges/flat_regions.h"
#include "edges/welded_mesh.h"
#include "rounding/box_tree.h"

namespace arris {

// Surface that continues a face of the cut may lie this deep in it, relative to the radius.
inline constexpr double kSmoothDepth = 0.1;
// The same for surface that touches an end of the cut's edge: there faces of curved surfaces meet in fans.
inline constexpr double kSmoothDepthAtEnd = 0.3;
// Cosine between normals from which on one face may continue another.
inline constexpr double kSmoothCosine = 0.8;

struct Segment {
  Vec3d p0, p1;
};

// Half-space normal·x ≤ d.
struct CutPlane {
  Vec3d normal;  // unit
  double d = 0;
  std::uint32_t face = kNone;  // region whose plane it is; kNone for the end of an arc, or below it
  double leeway = 0;           // by which edges in the faces may lie within it

  friend bool operator==(const CutPlane&, const CutPlane&) = default;
};

struct Cut {
  std::vector<CutPlane> planes;
  std::vector<Segment> axes;     // its void is farther than the radius from these
  std::vector<Segment> outline;  // edges of its boundary
  std::array<std::uint32_t, 2> ends{kNone, kNone};  // of the mesh; cuts that share one may overlap
  std::vector<std::uint32_t> mitred;  // half-edges of those with which it meets in a mitre
  std::uint32_t half_edge = kNone;    // the arc's first, or one that leaves the corner
  bool is_corner = false;
};

class Clearance {
 public:
  Clearance(const WeldedMesh& mesh, const FlatRegions& regions, std::uint32_t shell, double radius);

  // Indices of the cuts that other surface reaches into, or that leave their faces; and of those that overlap. What is
  // asked again about cuts that haven't changed since they were remembered is known.
  [[nodiscard]] std::vector<std::uint32_t> find_in_surface(std::span<const Cut> cuts);
  [[nodiscard]] std::vector<std::uint32_t> find_overlapping(std::span<const Cut> cuts);
  // The cuts that were asked about last.
  void remember(std::span<const Cut> cuts);

 private:
  struct TriangleView {
    std::uint32_t index;
    std::array<Vec3d, 3> corners;
    std::uint32_t region;
  };

  using PlanesOfCuts = std::unordered_map<std::uint64_t, std::vector<CutPlane>>;
  struct Known {
    PlanesOfCuts free;
    std::vector<std::uint32_t> found;  // free ones, to be remembered
  };

  void meet_surface(std::span<const Cut> cuts, std::span<const std::uint32_t> changed);
  void meet_each_other(std::span<const Cut> cuts, std::span<const std::uint32_t> changed);
  using Meet = void (Clearance::*)(std::span<const Cut>, std::span<const std::uint32_t> changed);
  std::vector<std::uint32_t> find_blocked(std::span<const Cut> cuts, Known& known, Meet meet);
  [[nodiscard]] static std::vector<std::uint32_t> changed_since(std::span<const Cut> cuts,
                                                                const PlanesOfCuts& known);
  [[nodiscard]] BoxTree make_tree(std::span<const Cut> cuts,
                                  std::span<const std::uint32_t> items) const;
  [[nodiscard]] bool is_blocked_by(const Cut& cut, const TriangleView& triangle);
  [[nodiscard]] bool leaves_face(const Cut& cut, const TriangleView& triangle) const;
  [[nodiscard]] bool reaches_void(const Cut& cut, const TriangleView& triangle);
  [[nodiscard]] bool overlaps(const Cut& cut, const Cut& other);
  [[nodiscard]] double smooth_depth(const Cut& cut, std::uint32_t triangle) const;
  [[nodiscard]] double distance_to_axes(const Cut& cut, Vec3d x) const;

  const WeldedMesh& mesh_;
  const FlatRegions& regions_;
  const Shell& shell_;
  double radius_;
  double tolerance_;
  Known known_free_, known_apart_;
  std::vector<bool> blocked_;
  std::vector<Vec3d> polygon_, clipped_;
  std::vector<CutPlane> planes_;
};

}  // namespace arris
