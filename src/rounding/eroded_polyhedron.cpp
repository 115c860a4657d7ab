#include "rounding/eroded_polyhedron.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <map>
#include <memory>
#include <numeric>

extern "C" {
#include <libqhull_r/qhull_ra.h>
}

#include "arris/error.h"
#include "rounding/corner.h"

namespace arris {
namespace {

// A vertex of E with the planes it lies on.
struct DualFacet {
  Vec3d vertex;
  std::array<std::uint32_t, 3> planes;
};

// Relative to the size: vertices of E nearer than this are one.
constexpr double kSameVertex = 1e-7;

class Qhull {
 public:
  Qhull() : sink_(std::fopen("/dev/null", "w"), &std::fclose) { qh_zero(&qh_, sink_.get()); }
  Qhull(const Qhull&) = delete;
  Qhull& operator=(const Qhull&) = delete;
  ~Qhull() {
    int remaining = 0, total = 0;
    qh_freeqhull(&qh_, !qh_ALL);
    qh_memfreeshort(&qh_, &remaining, &total);
  }

  // Facets of the hull of `points`, about the origin, as vertices of the primal polyhedron.
  std::vector<DualFacet> dual_facets(std::vector<Vec3d>& points) {
    char options[] = "qhull Qt Pp";
    qhT* const qh = &qh_;  // the name that the library's macros expect
    const int failed = qh_new_qhull(qh, 3, int(points.size()), &points[0].x, False, options,
                                    sink_.get(), sink_.get());
    std::vector<DualFacet> facets;
    if (failed != 0) return facets;
    facetT* facet = nullptr;
    FORALLfacets {
      vertexT* vertex = nullptr;
      vertexT** vertexp = nullptr;
      DualFacet dual{};
      std::size_t n = 0;
      FOREACHvertex_(facet->vertices) {
        if (n < 3) dual.planes[n] = std::uint32_t(qh_pointid(qh, vertex->point));
        ++n;
      }
      if (n != 3 || facet->offset >= 0) continue;
      const Vec3d normal(facet->normal[0], facet->normal[1], facet->normal[2]);
      dual.vertex = normal / -facet->offset;
      facets.push_back(dual);
    }
    return facets;
  }

 private:
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> sink_;
  qhT qh_;
};

// Facets at the same place become one node.
std::vector<std::uint32_t> merge_vertices(std::span<const DualFacet> facets, double tolerance,
                                          std::vector<Vec3d>& nodes) {
  std::vector<std::uint32_t> order(facets.size());
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) {
    const Vec3d& p = facets[a].vertex;
    const Vec3d& q = facets[b].vertex;
    return p.x != q.x ? p.x < q.x : a < b;
  });
  std::vector<std::uint32_t> node_of(facets.size(), kNone);
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (node_of[order[i]] != kNone) continue;
    const Vec3d p = facets[order[i]].vertex;
    const auto node = std::uint32_t(nodes.size());
    nodes.push_back(p);
    for (std::size_t j = i; j < order.size() && facets[order[j]].vertex.x - p.x <= tolerance; ++j) {
      if (node_of[order[j]] == kNone && length(facets[order[j]].vertex - p) <= tolerance) {
        node_of[order[j]] = node;
      }
    }
  }
  return node_of;
}

}  // namespace

ShellNetwork make_eroded_polyhedron(std::span<const Plane> planes,
                                    std::span<const std::uint32_t> smooth_group,
                                    std::uint32_t first_face, double radius, Vec3d interior,
                                    double size) {
  std::vector<Vec3d> points;
  points.reserve(planes.size());
  for (const Plane& p : planes) {
    points.push_back(p.normal / (p.d - radius - dot(p.normal, interior)));
  }
  std::vector<DualFacet> facets = Qhull().dual_facets(points);
  if (facets.empty()) {
    throw Error(Error::Kind::failed, "",
                "the half-space intersection failed on a solid of " +
                    std::to_string(planes.size()) + " faces; use a smaller radius");
  }
  for (DualFacet& f : facets) f.vertex += interior;
  std::vector<Vec3d> nodes;
  const std::vector<std::uint32_t> node_of = merge_vertices(facets, kSameVertex * size, nodes);
  std::map<std::array<std::uint32_t, 2>, std::vector<std::uint32_t>> nodes_of_edge;
  for (std::size_t f = 0; f < facets.size(); ++f) {
    for (std::size_t i = 0; i < 3; ++i) {
      const auto [a, b] = std::minmax(facets[f].planes[i], facets[f].planes[(i + 1) % 3]);
      nodes_of_edge[{a, b}].push_back(node_of[f]);
    }
  }
  ShellNetwork network;
  for (const Vec3d& p : nodes) network.nodes.push_back({p, Node::Kind::sphere, kNone});
  std::vector<std::uint32_t> rounded_at(nodes.size(), 0);
  for (const auto& [pair, ends] : nodes_of_edge) {
    if (ends.size() != 2 || ends[0] == ends[1]) continue;
    const Vec3d axis = cross(planes[pair[0]].normal, planes[pair[1]].normal);
    const bool forward = dot(axis, nodes[ends[1]] - nodes[ends[0]]) > 0;
    const std::uint32_t n0 = forward ? ends[0] : ends[1];
    const std::uint32_t n1 = forward ? ends[1] : ends[0];
    const Arc arc{
        make_arc_line(nodes[n0], nodes[n1], planes[pair[0]].normal, planes[pair[1]].normal),
        first_face + pair[0], first_face + pair[1], n0, n1};
    if (smooth_group[pair[0]] == smooth_group[pair[1]]) {
      // Stays sharp: marks its direction at both ends.
      Arc stub = arc;
      stub.node1 = kNone;
      network.arcs.push_back({stub, nodes[n0], nodes[n0], kNone, kNone});
      std::swap(stub.face_a, stub.face_b);
      stub.line = {Vec3f(nodes[n1]), -arc.line.axis, 0};
      stub.node0 = n1;
      network.arcs.push_back({stub, nodes[n1], nodes[n1], kNone, kNone});
      continue;
    }
    network.arcs.push_back({arc, nodes[n0], nodes[n1], kNone, kNone});
    ++network.rounded_edges;
    ++rounded_at[n0];
    ++rounded_at[n1];
  }
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    // An end of a chain between smooth faces: see NetworkBuilder::make_corner().
    if (rounded_at[n] == 1) network.nodes[n].kind = Node::Kind::cap;
    if (rounded_at[n] >= 3) ++network.rounded_corners;
  }
  network.inverted = false;
  return network;
}

}  // namespace arris
