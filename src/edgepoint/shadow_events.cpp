#include "edgepoint/shadow_events.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace arris {
namespace {

using Corners = std::array<Vec3d, 4>;

constexpr std::size_t next(std::size_t i) {
  return (i + 1) % 4;
}
constexpr std::size_t previous(std::size_t i) {
  return (i + 3) % 4;
}

Vec3d position(const EdgeMesh& mesh, std::uint32_t v) {
  return Vec3d(mesh.vertices[v]);
}

std::uint32_t other_end(const MeshEdge& e, std::uint32_t v) {
  return e.v0 == v ? e.v1 : e.v0;
}

// Whether p may lie within the blocker's bounds, where concave edges may cast shadows.
bool is_within_bounds(const EdgeMesh& mesh, const HomogeneousPoint& p) {
  if (p.w == 0) return false;
  for (int k = 0; k < 3; ++k) {
    const double x = p.xyz[k];
    if (x < p.w * mesh.bounds_min[k] || x > p.w * mesh.bounds_max[k]) return false;
  }
  return true;
}

// Removes edges that no light outside can see as silhouette.
void drop_hidden(const EdgeMesh& mesh, std::vector<std::uint32_t>& edges) {
  std::erase_if(edges, [&](std::uint32_t e) { return mesh.is_concave(e); });
}

ShadowEvent ve_wedge(const EdgeMesh& mesh, std::uint32_t edge, const HomogeneousPoint& light,
                     ShadowKind kind) {
  const MeshEdge& e = mesh.edges[edge];
  return {kind,
          {position(mesh, e.v0), position(mesh, e.v1)},
          {light, light},
          {e.v0, e.v1},
          {e.face0, e.face1},
          {}};
}

// Positive where the light's corner j lies to the left of the plane through e and corner i; the other way round the
// same number with the other sign.
double turn(const EdgeMesh& mesh, const MeshEdge& e, Vec3d li, Vec3d lj) {
  const Vec3d p = position(mesh, e.v0);
  return dot(position(mesh, e.v1) - p, cross(li - p, lj - p));
}

// On which side of the plane through the edge and a viewpoint, as turn() has them, the blocker lies.
// Precondition: is_silhouette(). With E along the edge: det(E, V, C) = −(E × C) · V for the third corner C of face0.
double blocker_side(const EdgeMesh& mesh, const MeshEdge& e, const HomogeneousPoint& viewpoint) {
  return is_front(mesh, e.face0, viewpoint) ? -1 : 1;
}

double side_of(const EdgeMesh& mesh, std::uint32_t q, Vec3d normal, std::uint32_t p) {
  return dot(normal, position(mesh, p) - position(mesh, q));
}

// The plane through q and the light's edge from corner i, its normal on the light's side; none if the light lies in it.
std::optional<Vec3d> ev_plane(Vec3d q, const Corners& l, std::size_t i) {
  const Vec3d n = cross(l[i] - q, l[next(i)] - q);
  const double light = dot(n, l[next(next(i))] - q);
  if (light == 0) return std::nullopt;
  return light > 0 ? n : -n;
}

ShadowEvent ev_wedge(const EdgeMesh& mesh, std::uint32_t q, const Corners& l, std::size_t i,
                     ShadowKind kind) {
  const Vec3d p = position(mesh, q);
  return {kind,   {p, p},         {HomogeneousPoint{l[i]}, HomogeneousPoint{l[next(i)]}},
          {q, q}, {kNone, kNone}, l[previous(i)] - l[i]};
}

Vec3d across_of_ve(const EdgeMesh& mesh, const MeshEdge& e, const Corners& l, std::size_t i) {
  Vec3d farthest;
  double most = 0;
  for (const Vec3d& corner : l) {
    const double side = std::abs(turn(mesh, e, l[i], corner));
    if (side > most) farthest = corner - l[i];
    most = std::max(most, side);
  }
  return farthest;
}

// The side of its plane that a light emits to.
struct Emission {
  Vec3d normal, corner;
  double nearest = 0;  // distances below are not in front

  explicit Emission(const ParallelogramLight& light)
      : normal(cross(light.u, light.v)), corner(light.corner) {
    if (dot(normal, light.toward) < 0) normal = -normal;
    // Where rays go along the light's plane there is neither light nor a wedge; relative to the light's size.
    constexpr double kGrazing = 1e-6;
    nearest = kGrazing * length(normal) * std::max(length(light.u), length(light.v));
  }
  [[nodiscard]] double height(Vec3d p) const { return dot(normal, p - corner) - nearest; }
};

// Keeps what lies in front of the light.
bool clip_to_front(ShadowEvent& event, const Emission& emission) {
  const double h0 = emission.height(event.origin[0]), h1 = emission.height(event.origin[1]);
  if (h0 <= 0 && h1 <= 0) return false;
  if (h0 > 0 && h1 > 0) return true;
  const std::size_t behind = h0 <= 0 ? 0 : 1;
  event.origin[behind] = event.origin[0] + (event.origin[1] - event.origin[0]) * (h0 / (h0 - h1));
  event.vertex[behind] = kNone;
  return true;
}

// Kind of the VE event of corner i and an edge, if it is one.
std::optional<ShadowKind> ve_event(const EdgeMesh& mesh, std::uint32_t edge, const Corners& corners,
                                   std::size_t i) {
  const HomogeneousPoint from{corners[i], 1};
  if (!is_silhouette(mesh, edge, from)) return std::nullopt;
  const MeshEdge& e = mesh.edges[edge];
  // One number for each edge of the light, so that the planes of both its corners agree on it.
  const double to_next = turn(mesh, e, corners[i], corners[next(i)]);
  const double to_previous = -turn(mesh, e, corners[previous(i)], corners[i]);
  const double low = std::min(to_next, to_previous), high = std::max(to_next, to_previous);
  if ((low < 0 && high > 0) || (low == 0 && high == 0)) return std::nullopt;
  const double light_side = high > 0 ? 1 : -1;
  return light_side == blocker_side(mesh, e, from) ? ShadowKind::umbral : ShadowKind::penumbral;
}

// Whether the light's edge from corner i to the next and vertex q are a penumbral EV event.
bool is_penumbral_ev_event(const EdgeMesh& mesh, std::uint32_t q, const Corners& corners,
                           std::size_t i) {
  const std::optional<Vec3d> n = ev_plane(position(mesh, q), corners, i);
  if (!n) return false;
  bool any = false;
  for (const std::uint32_t e : mesh.around(q)) {
    const double side = side_of(mesh, q, *n, other_end(mesh.edges[e], q));
    if (side > 0) return false;
    any = any || side < 0;
  }
  return any;
}

struct UmbralEdge {
  std::uint32_t vertex, edge;  // one of its ends
  std::size_t corner;
};

// Whether the two umbral edges at q and the light's edge from corner i are an EV event: seen from the light the blocker
// turns inward at q, around which the light's edge is led: both edges lie beyond its plane.
bool is_umbral_ev_event(const EdgeMesh& mesh, const UmbralEdge& a, const UmbralEdge& b,
                        const Corners& l, std::size_t i) {
  const std::uint32_t q = a.vertex;
  const std::optional<Vec3d> n = ev_plane(position(mesh, q), l, i);
  const std::uint32_t pa = other_end(mesh.edges[a.edge], q), pb = other_end(mesh.edges[b.edge], q);
  if (!n || side_of(mesh, q, *n, pa) > 0 || side_of(mesh, q, *n, pb) > 0) return false;
  const MeshEdge& e = mesh.edges[a.edge];
  const Vec3d from = l[a.corner];
  return turn(mesh, e, from, position(mesh, pb)) * blocker_side(mesh, e, {from, 1}) < 0;
}

void add_umbral_ev_events(const EdgeMesh& mesh, std::vector<UmbralEdge>& umbral, const Corners& l,
                          std::vector<ShadowEvent>& events) {
  std::ranges::stable_sort(umbral, {}, &UmbralEdge::vertex);
  for (std::size_t first = 0; first < umbral.size();) {
    std::size_t last = first;
    while (last < umbral.size() && umbral[last].vertex == umbral[first].vertex) ++last;
    for (std::size_t i = 0; i < 4; ++i) {
      bool found = false;
      for (std::size_t a = first; a < last && !found; ++a) {
        if (umbral[a].corner != i && umbral[a].corner != next(i)) continue;
        for (std::size_t b = first; b < last && !found; ++b) {
          found = umbral[a].edge != umbral[b].edge &&
                  is_umbral_ev_event(mesh, umbral[a], umbral[b], l, i);
        }
      }
      if (found) events.push_back(ev_wedge(mesh, umbral[first].vertex, l, i, ShadowKind::umbral));
    }
    first = last;
  }
}

}  // namespace

ParallelogramLight transform(const Affine3d& m, const ParallelogramLight& light) {
  return {transform_point(m, light.corner), transform_vector(m, light.u),
          transform_vector(m, light.v), transform_vector(m, light.toward)};
}

ShadowEvent transform(const Affine3d& m, const ShadowEvent& event) {
  ShadowEvent out = event;
  for (std::size_t k = 0; k < 2; ++k) {
    out.origin[k] = transform_point(m, event.origin[k]);
    out.light[k] = transform(m, event.light[k]);
  }
  out.across = transform_vector(m, event.across);
  return out;
}

std::vector<ShadowEvent> find_shadow_events(const EdgeTree& blocker,
                                            const HomogeneousPoint& light) {
  const EdgeMesh& mesh = blocker.mesh();
  std::vector<std::uint32_t> edges = blocker.find_silhouettes(light);
  if (mesh.closed && !is_within_bounds(mesh, light)) drop_hidden(mesh, edges);
  std::vector<ShadowEvent> events;
  events.reserve(edges.size());
  for (const std::uint32_t e : edges) {
    events.push_back(ve_wedge(mesh, e, light, ShadowKind::hard));
  }
  return events;
}

std::vector<ShadowEvent> find_shadow_events(const EdgeTree& blocker,
                                            const ParallelogramLight& light) {
  const EdgeMesh& mesh = blocker.mesh();
  const Corners l = light.corners();
  std::array<HomogeneousPoint, 4> from;
  std::ranges::transform(l, from.begin(), [](Vec3d p) { return HomogeneousPoint{p, 1}; });
  std::vector<std::uint32_t> edges = blocker.find_possible_silhouettes(from);
  const bool within =
      std::ranges::any_of(from, [&](const auto& p) { return is_within_bounds(mesh, p); });
  if (mesh.closed && !within) drop_hidden(mesh, edges);

  const Emission emission(light);
  std::vector<ShadowEvent> events;
  std::vector<UmbralEdge> umbral;
  std::vector<std::uint32_t> vertices;
  for (const std::uint32_t e : edges) {
    vertices.insert(vertices.end(), {mesh.edges[e].v0, mesh.edges[e].v1});
    for (std::size_t i = 0; i < 4; ++i) {
      const std::optional<ShadowKind> kind = ve_event(mesh, e, l, i);
      if (!kind) continue;
      ShadowEvent event = ve_wedge(mesh, e, from[i], *kind);
      event.across = across_of_ve(mesh, mesh.edges[e], l, i);
      if (!clip_to_front(event, emission)) continue;
      for (const std::uint32_t v : event.vertex) {
        if (*kind == ShadowKind::umbral && v != kNone) umbral.push_back({v, e, i});
      }
      events.push_back(event);
    }
  }
  std::ranges::sort(vertices);
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  for (const std::uint32_t q : vertices) {
    if (emission.height(position(mesh, q)) <= 0) continue;
    for (std::size_t i = 0; i < 4; ++i) {
      if (is_penumbral_ev_event(mesh, q, l, i)) {
        events.push_back(ev_wedge(mesh, q, l, i, ShadowKind::penumbral));
      }
    }
  }
  add_umbral_ev_events(mesh, umbral, l, events);
  return events;
}

}  // namespace arris
