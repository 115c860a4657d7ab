#include "edgepoint/face_tree.h"

#include "base/parallel_for.h"

namespace arris {
namespace {

BoundsRecord record_of(const EdgeMesh& mesh, std::uint32_t face, const UnitFrame& frame) {
  BoundsRecord r{FaceBounds::empty(), face};
  r.bounds.grow_normal(normalize(face_normal(mesh, face)));
  for (const std::uint32_t v : mesh.triangles[face]) {
    r.bounds.grow_position(frame.unit_from_object(Vec3d(mesh.vertices[v])));
  }
  return r;
}

// Children of a node of the binary tree, and theirs, up to four in all: the largest are opened.
std::array<std::uint32_t, 4> descendants(const std::vector<BoundsNode>& tree, std::uint32_t root,
                                         std::size_t& count) {
  const auto surface = [&](std::uint32_t i) {
    const FaceBounds& b = tree[i].bounds;
    return b.width(3) * b.width(4) + b.width(4) * b.width(5) + b.width(5) * b.width(3);
  };
  std::array<std::uint32_t, 4> out{root};
  count = 1;
  while (count < 4) {
    std::size_t largest = 4;
    for (std::size_t i = 0; i < count; ++i) {
      if (tree[out[i]].size == 1) continue;
      if (largest == 4 || surface(out[i]) > surface(out[largest])) largest = i;
    }
    if (largest == 4) break;
    const std::uint32_t left = out[largest] + 1;
    out[largest] = left;
    out[count++] = left + tree[left].size;
  }
  return out;
}

void set_box(FaceNode& node, std::size_t slot, const FaceBounds& box) {
  for (std::size_t k = 0; k < 3; ++k) {
    node.middle[k][slot] = box.twice_middle(k + 3) * 0.5F;
    node.reach[k][slot] = box.width(k + 3) * 0.5F;
  }
}

// Appends the node of four boxes for the subtree at `root`, depth first.
std::uint32_t add_node(const std::vector<BoundsNode>& tree, std::uint32_t root,
                       std::vector<FaceNode>& nodes) {
  const auto at = std::uint32_t(nodes.size());
  nodes.emplace_back();
  std::size_t count = 0;
  const std::array<std::uint32_t, 4> children = descendants(tree, root, count);
  for (std::size_t i = 0; i < 4; ++i) {
    constexpr float kMeetsNothing = -1e30F;
    for (std::size_t k = 0; k < 3; ++k) nodes[at].reach[k][i] = kMeetsNothing;
    if (i >= count) continue;
    const BoundsNode& child = tree[children[i]];
    set_box(nodes[at], i, child.bounds);
    const bool is_leaf = child.size == 1;
    const std::uint32_t first = is_leaf ? child.first : add_node(tree, children[i], nodes);
    nodes[at].first[i] = first;
    nodes[at].count[i] = is_leaf ? child.count : 0;
  }
  return at;
}

}  // namespace

FaceTree::FaceTree(const EdgeMesh& mesh) : mesh_(&mesh), frame_(unit_frame(mesh)) {
  std::vector<std::uint32_t> faces;
  faces.reserve(mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    if (length(face_normal(mesh, t)) > 0) faces.push_back(t);
  }
  constexpr std::size_t kGrain = 4096;
  std::vector<BoundsRecord> records(faces.size());
  parallel_for(faces.size(), {.grain = kGrain},
               [&](std::size_t i) { records[i] = record_of(mesh, faces[i], frame_); });
  const std::vector<BoundsNode> tree = build_bounds_tree(records, SplitBy::positions);
  nodes_.reserve(tree.size() / 2);
  if (!tree.empty()) add_node(tree, 0, nodes_);
  faces_.resize(records.size());
  corners_.resize(records.size());
  parallel_for(records.size(), {.grain = kGrain}, [&](std::size_t i) {
    faces_[i] = records[i].item;
    const Triangle& t = mesh.triangles[faces_[i]];
    corners_[i] = {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
  });
}

}  // namespace arris
