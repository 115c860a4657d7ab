#include "scene/validate_csg.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>
#include <utility>

#include "scene/limits.h"

namespace arris {
namespace {

constexpr double kUnit = 1e-6;  // how far a normal's length may be from 1

bool usable(double x) {
  return std::abs(x) <= kMaxCoordinate;
}
bool usable(Vec2d p) {
  return usable(p.x) && usable(p.y);
}
bool usable(Vec3d p) {
  return usable(p.x) && usable(p.y) && usable(p.z);
}
bool usable(const std::vector<Vec3d>& points) {
  return std::ranges::all_of(points, [](Vec3d p) { return usable(p); });
}
bool positive(double x) {
  return x > 0 && usable(x);
}

// Each says what is wrong with a primitive, or nothing.

std::string_view problem_of(const CsgSphere& s) {
  return positive(s.radius) ? "" : "a sphere's radius must be more than 0";
}
std::string_view problem_of(const CsgBox& b) {
  const bool sound = usable(b.low) && usable(b.high) && b.low.x < b.high.x && b.low.y < b.high.y &&
                     b.low.z < b.high.z;
  return sound ? "" : "a box's low corner must be below its high one";
}
std::string_view problem_of(const CsgCone& c) {
  if (!usable(c.z_low) || !usable(c.z_high) || !(c.z_low < c.z_high))
    return "a cone needs a height";
  const bool sound = c.radius_low >= 0 && c.radius_high >= 0 && usable(c.radius_low) &&
                     usable(c.radius_high) && std::max(c.radius_low, c.radius_high) > 0;
  return sound ? "" : "a cone's radii must be at least 0, one of them more";
}
std::string_view problem_of(const CsgTorus& t) {
  return positive(t.ring_radius) && positive(t.tube_radius) ? ""
                                                            : "a torus' radii must be more than 0";
}
std::string_view problem_of(const CsgHalfSpace& h) {
  const bool sound = usable(h.d) && std::abs(length(h.normal) - 1) <= kUnit;
  return sound ? "" : "a half-space's normal must have the length 1";
}
std::string_view problem_of(const CsgPolyhedron& p) {
  if (p.faces.size() < 4 || p.vertices.size() < 4)
    return "a polyhedron has at least 4 faces and vertices";
  for (const CsgHalfSpace& face : p.faces) {
    if (const std::string_view problem = problem_of(face); !problem.empty()) return problem;
  }
  return usable(p.vertices) ? "" : "a polyhedron's vertex is too far out";
}
// Every edge is walked as often in one direction as in the other.
bool is_closed(const CsgMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      balance[std::minmax(a, b)] += a < b ? 1 : -1;
    }
  }
  return std::ranges::all_of(balance, [](const auto& edge) { return edge.second == 0; });
}
std::string_view problem_of(const CsgMesh& m) {
  if (m.triangles.empty()) return "a mesh has no triangles";
  if (!usable(m.vertices)) return "a mesh's vertex is too far out";
  for (const Triangle& t : m.triangles) {
    if (std::max({t[0], t[1], t[2]}) >= m.vertices.size())
      return "a mesh's triangle names no vertex";
  }
  return is_closed(m) ? "" : "a mesh isn't closed";
}
std::string_view problem_of(const CsgRegion& r) {
  if (r.outlines.empty()) return "a region has no outline";
  for (const std::vector<Vec2d>& outline : r.outlines) {
    if (outline.size() < 3) return "an outline has fewer than 3 points";
    if (!std::ranges::all_of(outline, [](Vec2d p) { return usable(p); })) {
      return "an outline's point is too far out";
    }
  }
  return "";
}
std::string_view problem_of(const CsgPrism& p) {
  if (!usable(p.z_low) || !usable(p.z_high) || !(p.z_low < p.z_high))
    return "a prism needs a height";
  const bool scaled = p.scale_high.x >= 0 && p.scale_high.y >= 0 && usable(p.scale_high);
  return scaled ? problem_of(p.region) : "a prism's scale must be at least 0";
}
std::string_view problem_of(const CsgRevolution& r) {
  for (const std::vector<Vec2d>& outline : r.region.outlines) {
    if (std::ranges::any_of(outline, [](Vec2d p) { return p.x < 0; })) {
      return "a revolution's outline must lie at x of at least 0";
    }
  }
  return problem_of(r.region);
}
std::string_view problem_of(const CsgRounded& r) {
  return positive(r.radius) ? problem_of(r.core) : "a rounding radius must be more than 0";
}

std::string_view problem_of(const CsgLeaf& leaf, const Scene& scene) {
  const Mat3d& m = leaf.object_from_primitive.linear;
  const double scale = std::max({length(m.x), length(m.y), length(m.z)});
  if (!usable(leaf.object_from_primitive.translation) || !usable(scale)) {
    return "a primitive's transform is too large";
  }
  if (!(std::abs(determinant(m)) > 1e-15 * scale * scale * scale)) {
    return "a primitive's transform flattens it";
  }
  if (leaf.material.index >= scene.materials.size()) return "a primitive's material isn't there";
  return std::visit([](const auto& primitive) { return problem_of(primitive); }, leaf.primitive);
}

std::string_view problem_of(const CsgTree& tree, std::size_t index) {
  const CsgNode& node = tree.nodes[index];
  if (node.leaf != CsgNode::kInner && node.leaf >= tree.leaves.size())
    return "a node names no primitive";
  if (node.leaf != CsgNode::kInner && !node.children.empty()) return "a primitive has children";
  for (const std::uint32_t child : node.children) {
    if (child <= index || child >= tree.nodes.size()) return "a node's child must come after it";
  }
  return "";
}

}  // namespace

void check_csg_tree(const Scene& scene, std::size_t index, std::vector<std::string>& problems) {
  const CsgTree& tree = scene.csg_trees[index];
  const std::string where = tree.name.empty() ? fmt::format("CSG tree {}", index)
                                              : fmt::format("CSG tree \"{}\"", tree.name);
  if (tree.nodes.empty()) {
    problems.push_back(where + ": has no nodes; an empty solid is one node without children");
    return;
  }
  std::map<std::string_view, std::pair<std::string, std::size_t>> found;
  const auto add = [&](std::string_view problem, std::string_view what, std::size_t number) {
    if (problem.empty()) return;
    auto& [place, count] = found[problem];
    if (count++ == 0) place = fmt::format("{} {}", what, number);
  };
  for (std::size_t i = 0; i < tree.nodes.size(); ++i) add(problem_of(tree, i), "node", i);
  for (std::size_t i = 0; i < tree.leaves.size(); ++i)
    add(problem_of(tree.leaves[i], scene), "primitive", i);
  for (const auto& [problem, place] : found) {
    problems.push_back(fmt::format(
        "{}: {}: {}{}", where, place.first, problem,
        place.second > 1 ? fmt::format(" ({} more like it)", place.second - 1) : std::string()));
  }
}

}  // namespace arris
