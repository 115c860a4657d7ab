#include "rounding/concave_features.h"

#include <algorithm>
#include <cmath>

namespace arris {
namespace {

CurveBound plane_through(Vec3d p, Vec3d normal) {
  return {normal, -dot(normal, p)};
}

std::vector<ConcaveEdge> find_edges(const ConcaveInput& in) {
  std::vector<ConcaveEdge> edges;
  for_outlines(in, [&](std::uint32_t h, std::uint32_t twin) {
    const bool is_smooth = in.kinds[h] == EdgeKind::smooth;
    const bool bends_in =
        in.kinds[h] == EdgeKind::concave || (is_smooth && turn_at(in.mesh, in.regions, h) < 0);
    if (h > twin || !bends_in) return;
    ConcaveEdge edge;
    edge.is_smooth = is_smooth;
    edge.vertex0 = in.mesh.origin(h);
    edge.vertex1 = in.mesh.target(h);
    edge.p0 = Vec3d(in.mesh.vertices[edge.vertex0]) - in.center;
    edge.p1 = Vec3d(in.mesh.vertices[edge.vertex1]) - in.center;
    edge.direction = normalize(edge.p1 - edge.p0);
    edge.face0 = in.regions.region[h / 3];
    edge.face1 = in.regions.region[twin / 3];
    // A face lies to the left of its half-edge.
    edge.normal0 = in.regions.planes[edge.face0].normal;
    edge.normal1 = in.regions.planes[edge.face1].normal;
    edge.inward0 = cross(edge.normal0, edge.direction);
    edge.inward1 = cross(edge.direction, edge.normal1);
    edges.push_back(edge);
  });
  return edges;
}

std::vector<ConcaveCorner> find_corners(const ConcaveInput& in,
                                        const std::vector<ConcaveEdge>& edges) {
  if (edges.empty()) return {};
  std::vector<std::uint32_t> vertices;
  for (const ConcaveEdge& e : edges) vertices.insert(vertices.end(), {e.vertex0, e.vertex1});
  std::ranges::sort(vertices);
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  std::vector<ConcaveCorner> corners(vertices.size());
  const auto corner_at = [&](std::uint32_t vertex) -> ConcaveCorner* {
    const auto found = std::ranges::lower_bound(vertices, vertex);
    if (found == vertices.end() || *found != vertex) return nullptr;
    return &corners[std::size_t(found - vertices.begin())];
  };
  const auto place = [&](std::uint32_t vertex) {
    return Vec3d(in.mesh.vertices[vertex]) - in.center;
  };
  for (std::size_t i = 0; i < vertices.size(); ++i) corners[i].point = place(vertices[i]);
  for (std::uint32_t i = 0; i < edges.size(); ++i) {
    for (const std::uint32_t vertex : {edges[i].vertex0, edges[i].vertex1}) {
      ConcaveCorner& corner = *corner_at(vertex);
      corner.edges.push_back(i);
      corner.is_smooth = corner.is_smooth && edges[i].is_smooth;
    }
  }
  for_outlines(in, [&](std::uint32_t h, std::uint32_t) {
    const std::uint32_t from = in.mesh.origin(h), to = in.mesh.target(h);
    const Vec3d direction = normalize(place(to) - place(from));
    if (ConcaveCorner* const corner = corner_at(from)) {
      corner->directions.push_back(direction);
      corner->faces.push_back(in.regions.region[h / 3]);
    }
    if (ConcaveCorner* const corner = corner_at(to)) {
      corner->directions.push_back(-direction);
      corner->faces.push_back(in.regions.region[h / 3]);
    }
  });
  return corners;
}

}  // namespace

bool ConcaveEdge::is_touched_from(Vec3d x, double tolerance) const {
  return dot(inward0, x - p0) <= tolerance && dot(inward1, x - p0) <= tolerance &&
         dot(direction, x - p0) >= -tolerance && dot(direction, x - p1) <= tolerance;
}

std::array<CurveBound, 4> ConcaveEdge::bounds() const {
  return {plane_through(p0, inward0), plane_through(p0, inward1), plane_through(p0, -direction),
          plane_through(p1, direction)};
}

// The arc about the edge lies within its ends and where the tangents at these meet.
std::array<Vec3d, 6> ConcaveEdge::hull(double r) const {
  const Vec3d down0 = normal0 * -r, down1 = normal1 * -r;
  const Vec3d beneath = (down0 + down1) / (1 + dot(normal0, normal1));
  return {p0 + down0, p0 + down1, p0 + beneath, p1 + down0, p1 + down1, p1 + beneath};
}

Box ConcaveEdge::box(double r) const {
  const Vec3d end0 = normal0 * -r, end1 = normal1 * -r;
  const double half_turn = 0.5 * std::acos(std::clamp(dot(normal0, normal1), -1.0, 1.0));
  const Vec3d bulge(r * (1 - std::cos(half_turn)));
  return {min(p0, p1) + max(min(end0, end1) - bulge, Vec3d(-r)),
          max(p0, p1) + min(max(end0, end1) + bulge, Vec3d(r)), 0};
}

bool ConcaveCorner::is_touched_from(Vec3d x, double tolerance) const {
  return std::ranges::all_of(directions, [&](Vec3d d) { return dot(d, x - point) <= tolerance; });
}

std::vector<CurveBound> ConcaveCorner::bounds() const {
  std::vector<CurveBound> cone;
  for (const Vec3d d : directions) cone.push_back(plane_through(point, d));
  return cone;
}

ConcaveFeatures find_concave_features(const ConcaveInput& input) {
  std::vector<ConcaveEdge> edges = find_edges(input);
  std::vector<ConcaveCorner> corners = find_corners(input, edges);
  return {std::move(edges), std::move(corners)};
}

}  // namespace arris
