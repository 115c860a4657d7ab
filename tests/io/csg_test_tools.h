// csg_test_tools.h — .csg texts as trees, asked for points
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <random>
#include <string>

#include "arris/render.h"
#include "io/csg_reader.h"
#include "support/csg_membership.h"
#include "support/error_message.h"

namespace arris::test {

inline Scene read_csg_bytes(std::span<const std::uint8_t> bytes) {
  return read_csg(bytes, "part.csg", {});
}
inline Scene read_csg_text(const std::string& text, const LoadOptions& options = {}) {
  return read_csg(bytes_of(text), "part.csg", {}, options);
}
inline std::string csg_message(const std::string& text) {
  return error_message(read_csg_bytes, bytes_of(text));
}
inline const LoadOptions kAsWritten{LoadOptions::Facets::as_written};

// In any of the scene's solids.
inline bool is_inside(const Scene& scene, Vec3d p) {
  return std::any_of(scene.csg_trees.begin(), scene.csg_trees.end(),
                     [&](const CsgTree& tree) { return is_inside(tree, p); });
}

struct Box {
  Vec3d low, high;
};

// Random points of the box, except those for which near the surface `truth` changes within `margin`.
inline void expect_inside_where(const Scene& scene, const Box& box,
                                const std::function<bool(Vec3d)>& truth, double margin = 1e-6,
                                int count = 3000) {
  EXPECT_TRUE(validate_scene(scene).empty()) << validate_scene(scene)[0];
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit;
  int inside = 0;
  for (int i = 0; i < count; ++i) {
    const Vec3d share(unit(random), unit(random), unit(random));
    const Vec3d p = box.low + share * (box.high - box.low);
    const bool expected = truth(p);
    bool near = false;
    for (int axis = 0; axis < 3 && margin > 0; ++axis) {
      Vec3d d;
      d[axis] = margin;
      near |= truth(p + d) != expected || truth(p - d) != expected;
    }
    if (near) continue;
    inside += expected ? 1 : 0;
    ASSERT_EQ(is_inside(scene, p), expected) << p.x << ' ' << p.y << ' ' << p.z;
  }
  EXPECT_GT(inside, count / 100);
}

// The only primitive of a scene of one.
template <class Primitive>
Primitive only(const Scene& scene) {
  EXPECT_EQ(scene.csg_trees.size(), 1U);
  EXPECT_EQ(scene.csg_trees.at(0).leaves.size(), 1U);
  return std::get<Primitive>(scene.csg_trees.at(0).leaves.at(0).primitive);
}

}  // namespace arris::test
