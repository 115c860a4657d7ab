// bands.h — where each arc's rounding takes a face away
// What       A hit I on face k is kept iff the ball that touches the face there fits in the solid: its centre
//            c = I − r·n_k satisfies n_j·c ≤ d_j − r for every face j that meets k in the erosion. Per triangle
//            and arc (k, j) that is one linear function of the barycentrics. It is the trace on the face of the
//            paper's detection cylinder (§3.1), which by Thales cuts the face in just this band; but a band does not
//            end at the edge's vertices (why: detection_tree.h).
// Guarantee  no void point of an exact solid lies outside the bands, but for a depth of 1e-7 of its size and a few
//            roundings of its coordinates (tests/rounding/bands_test.cpp)
// Limits     on other solids a band may reach past the end of its edge: resolve() checks
// Cost       a face's triangles are searched in a tree: about linear in the bands. A triangle of a face with many
//            holes has no more of them than one of a face with few (tests/rounding/bands_test.cpp).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "edges/flat_regions.h"
#include "edges/welded_mesh.h"
#include "rounding/crease_network.h"
#include "rounding/rounding_data.h"

namespace arris {

struct TriangleBand {
  std::uint32_t triangle;
  Band band;
};

struct BandInput {
  const MeshView& mesh;  // the caller's triangles: barycentrics refer to them
  const WeldedMesh& welded;
  const FlatRegions& regions;
  std::span<const std::uint32_t>
      triangle_begin;  // per region: first of its triangles in `triangles`, and one more
  std::span<const std::uint32_t> triangles;  // by region
  double radius;
};

// Appends the bands of one shell's arcs; arc indices count from first_arc.
void append_bands(const BandInput& input, const ShellNetwork& network, const Solid& solid,
                  std::uint32_t first_arc, std::vector<TriangleBand>& bands);

}  // namespace arris
