#include <algorithm>
#include <limits>
#include <span>

#include "arris/inspect.h"
#include "csg/csg_bounds.h"
#include "edges/flat_regions.h"
#include "edges/inscribed_ball.h"

namespace arris {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::uint64_t& count_of(EdgeCounts& counts, EdgeKind kind) {
  switch (kind) {
    case EdgeKind::flat:
      return counts.flat;
    case EdgeKind::smooth:
      return counts.smooth;
    case EdgeKind::convex:
      return counts.convex;
    case EdgeKind::concave:
      return counts.concave;
    case EdgeKind::boundary:
      return counts.boundary;
    case EdgeKind::nonmanifold:
      return counts.nonmanifold;
  }
  return counts.flat;
}

// Counts edges; per shell: does no edge bend inwards?
std::vector<bool> count_edges(const WeldedMesh& welded, const FlatRegions& regions,
                              double min_angle, EdgeCounts& counts) {
  std::vector<bool> convex(welded.shells.size(), true);
  for (std::uint32_t h = 0; h < welded.twin.size(); ++h) {
    if (welded.shell[h / 3] == kNone) continue;
    const std::uint32_t twin = welded.twin[h];
    if (twin <= kLastHalfEdge && twin < h) continue;
    const EdgeKind kind = classify_edge(welded, regions, h, min_angle);
    ++count_of(counts, kind);
    const bool bends_in =
        kind == EdgeKind::concave || (kind == EdgeKind::smooth && turn_at(welded, regions, h) < 0);
    if (bends_in) convex[welded.shell[h / 3]] = false;
  }
  return convex;
}

// The bounds are those of the tree's own box, turned.
ObjectReport inspect_csg(const Scene& scene, const Object& object) {
  const CsgTree& tree = scene.csg_trees[object.csg->index];
  const CsgCounts counts = count_csg(tree);
  ObjectReport report;
  report.name = object.name;
  report.csg = CsgReport{counts.primitives, counts.curved, counts.flat_faces, counts.operations,
                         counts.depth};
  report.closed = true;
  report.bounds_min = Vec3d(kInfinity);
  report.bounds_max = Vec3d(-kInfinity);
  const Box3d box = csg_bounds(tree);
  if (box.is_empty()) return report;
  for (const Vec3d& corner : corners_of(box)) {
    const Vec3d world = transform_point(object.world_from_object, corner);
    report.bounds_min = min(report.bounds_min, world);
    report.bounds_max = max(report.bounds_max, world);
  }
  return report;
}

ObjectReport inspect_object(const Scene& scene, const Object& object, double min_angle) {
  if (object.csg) return inspect_csg(scene, object);
  const Mesh& mesh = scene.meshes[object.mesh.index];
  std::vector<Vec3f> positions;
  positions.reserve(mesh.positions.size());
  ObjectReport report;
  report.name = object.name;
  report.bounds_min = Vec3d(kInfinity);
  report.bounds_max = Vec3d(-kInfinity);
  for (const Vec3f& p : mesh.positions) {
    const Vec3d world = transform_point(object.world_from_object, Vec3d(p));
    positions.push_back(Vec3f(world));
    report.bounds_min = min(report.bounds_min, world);
    report.bounds_max = max(report.bounds_max, world);
  }
  WeldedMesh welded = make_welded_mesh({positions, mesh.triangles, mesh.sharp_edges},
                                       "object \"" + object.name + "\"");
  FlatRegions regions = make_flat_regions(welded);
  if (!turn_inverted_shells(welded, regions, min_angle).empty()) {
    regions = make_flat_regions(welded);
  }
  report.triangles = mesh.triangles.size();
  report.vertices = welded.vertices.size();
  report.shells = welded.shells.size();
  report.degenerate_triangles = welded.degenerate_triangles;
  std::vector<bool> convex = count_edges(welded, regions, min_angle, report.edges);
  for (std::uint32_t s = 0; s < welded.shells.size(); ++s) {
    const std::uint32_t outer = shell_around(welded.shells, s);
    if (outer != kNone) convex[outer] = false;
  }
  report.closed = !welded.shells.empty();
  report.convex = report.closed;
  std::size_t first = 0;
  for (std::uint32_t s = 0; s < welded.shells.size(); ++s) {
    const Shell& shell = welded.shells[s];
    std::size_t last = first;
    while (last < regions.shell.size() && regions.shell[last] == s) ++last;
    report.closed = report.closed && shell.closed;
    const bool convex_solid = convex[s] && shell.closed && !is_cavity(shell);
    report.convex = report.convex && convex_solid;
    if (convex_solid) {
      const auto planes = std::span(regions.planes).subspan(first, last - first);
      const double inradius = largest_inscribed_ball(planes, shell.size()).radius;
      report.inradius = std::min(inradius, report.inradius.value_or(kInfinity));
    }
    first = last;
  }
  return report;
}

}  // namespace

SceneReport inspect_scene(const Scene& scene, double min_angle) {
  SceneReport report;
  report.bounds_min = Vec3d(kInfinity);
  report.bounds_max = Vec3d(-kInfinity);
  for (const Object& object : scene.objects) {
    const double own = object.rounding ? object.rounding->min_angle : min_angle;
    report.objects.push_back(inspect_object(scene, object, own));
    const ObjectReport& last = report.objects.back();
    report.triangles += last.triangles;
    report.bounds_min = min(report.bounds_min, last.bounds_min);
    report.bounds_max = max(report.bounds_max, last.bounds_max);
  }
  return report;
}

}  // namespace arris
