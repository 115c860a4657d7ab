// radius_limits.cpp — how large a radius fits a mesh
#include <algorithm>
#include <span>
#include <vector>

#include "edges/flat_regions.h"
#include "edges/inscribed_ball.h"

namespace arris {
namespace {

std::optional<double> median(std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  const auto middle = values.begin() + std::ptrdiff_t(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace

RadiusLimits find_radius_limits(const MeshView& mesh, double min_angle, const std::string& name) {
  WeldedMesh welded = make_welded_mesh(mesh, name);
  FlatRegions regions = make_flat_regions(welded);
  if (!turn_inverted_shells(welded, regions, min_angle).empty()) {
    regions = make_flat_regions(welded);
  }
  std::vector<bool> convex(welded.shells.size(), true);
  std::vector<double> half_edges;
  for (std::uint32_t h = 0; h < welded.twin.size(); ++h) {
    if (welded.shell[h / 3] == kNone || welded.twin[h] < h) continue;
    const EdgeKind kind = classify_edge(welded, regions, h, min_angle);
    const bool bends_in =
        kind == EdgeKind::concave || (kind == EdgeKind::smooth && turn_at(welded, regions, h) < 0);
    if (bends_in) convex[welded.shell[h / 3]] = false;
    if (kind == EdgeKind::convex) {
      half_edges.push_back(0.5 * length(Vec3d(welded.vertices[welded.target(h)]) -
                                        Vec3d(welded.vertices[welded.origin(h)])));
    }
  }
  RadiusLimits limits;
  std::vector<double> inradii;
  std::size_t first = 0;
  for (std::uint32_t s = 0; s < welded.shells.size(); ++s) {
    std::size_t last = first;
    while (last < regions.shell.size() && regions.shell[last] == s) ++last;
    if (convex[s] && welded.shells[s].closed && !is_cavity(welded.shells[s])) {
      const auto planes = std::span(regions.planes).subspan(first, last - first);
      inradii.push_back(largest_inscribed_ball(planes, welded.shells[s].size()).radius);
    }
    first = last;
  }
  if (!inradii.empty()) limits.smallest_inradius = *std::ranges::min_element(inradii);
  limits.typical_inradius = median(inradii);
  limits.typical_edge = median(half_edges);
  return limits;
}

}  // namespace arris
