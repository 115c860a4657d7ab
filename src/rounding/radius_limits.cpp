// radius_limits.cpp — how large a radius fits a mesh
#include <algorithm>
#include <cmath>
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

// What a shell's edges and triangles say about it.
struct ShellSize {
  double area = 0;
  double volume = 0;
  double outline =
      0;  // of its faces: edges between two of them count twice, smooth ones don't count
  bool convex = true;
  bool has_edges = false;  // to be rounded
};

double area_of(const WeldedMesh& mesh, const Triangle& t) {
  const Vec3d a(mesh.vertices[t[0]]);
  return 0.5 * length(cross(Vec3d(mesh.vertices[t[1]]) - a, Vec3d(mesh.vertices[t[2]]) - a));
}

std::vector<ShellSize> measure_shells(const WeldedMesh& mesh, const FlatRegions& regions,
                                      double min_angle) {
  std::vector<ShellSize> sizes(mesh.shells.size());
  for (std::uint32_t s = 0; s < sizes.size(); ++s)
    sizes[s].volume = std::abs(mesh.shells[s].volume);
  for (std::uint32_t h = 0; h < mesh.twin.size(); ++h) {
    if (mesh.shell[h / 3] == kNone) continue;
    ShellSize& size = sizes[mesh.shell[h / 3]];
    if (h % 3 == 0) size.area += area_of(mesh, mesh.triangles[h / 3]);
    const EdgeKind kind = classify_edge(mesh, regions, h, min_angle);
    if (kind == EdgeKind::flat) continue;
    if (kind == EdgeKind::smooth) {
      if (turn_at(mesh, regions, h) < 0) size.convex = false;
      continue;
    }
    if (kind == EdgeKind::concave) size.convex = false;
    if (kind == EdgeKind::convex) size.has_edges = true;
    size.outline +=
        length(Vec3d(mesh.vertices[mesh.target(h)]) - Vec3d(mesh.vertices[mesh.origin(h)]));
  }
  return sizes;
}

double half_width(const Shell& shell, const ShellSize& size) {
  const double face = size.area / size.outline;
  return shell.closed ? std::min(face, size.volume / size.area) : face;
}

// Their walls are thinner.
void add_hollows(const WeldedMesh& mesh, std::vector<ShellSize>& sizes) {
  for (std::uint32_t s = 0; s < mesh.shells.size(); ++s) {
    const std::uint32_t outer = shell_around(mesh.shells, s);
    if (outer == kNone) continue;
    ShellSize& size = sizes[outer];
    size.area += sizes[s].area;
    size.outline += sizes[s].outline;
    size.volume += mesh.shells[s].volume;
    size.convex = false;
  }
}

}  // namespace

RadiusLimits find_radius_limits(const MeshView& mesh, double min_angle, const std::string& name) {
  WeldedMesh welded = make_welded_mesh(mesh, name);
  FlatRegions regions = make_flat_regions(welded);
  if (!turn_inverted_shells(welded, regions, min_angle).empty()) {
    regions = make_flat_regions(welded);
  }
  std::vector<ShellSize> sizes = measure_shells(welded, regions, min_angle);
  add_hollows(welded, sizes);
  RadiusLimits limits;
  std::vector<double> half_widths;
  std::size_t first = 0;
  for (std::uint32_t s = 0; s < welded.shells.size(); ++s) {
    const Shell& shell = welded.shells[s];
    std::size_t last = first;
    while (last < regions.shell.size() && regions.shell[last] == s) ++last;
    const auto planes = std::span(regions.planes).subspan(first, last - first);
    first = last;
    if (is_cavity(shell)) continue;
    if (sizes[s].convex && shell.closed) {
      const double inradius = largest_inscribed_ball(planes, shell.size()).radius;
      limits.smallest_inradius = std::min(inradius, limits.smallest_inradius.value_or(inradius));
      half_widths.push_back(inradius);
    } else if (sizes[s].has_edges) {
      half_widths.push_back(half_width(shell, sizes[s]));
    }
  }
  limits.typical_half_width = median(half_widths);
  return limits;
}

}  // namespace arris
