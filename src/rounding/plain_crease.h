// plain_crease.h — stretches of creases beside which nothing else matters
// What       Between two faces and beside the pipe around their crease lies the void: a prism. A stretch is plain if no
//            other face reaches into its prism, nor any pipe of another crease that isn't within this one there. A ray
//            in it then meets the pipe's cylinder, or leaves by one of the two faces, or comes to the stretch's ends,
//            beyond which all must be asked.
// In / Out   coordinates relative to the solid's centre
// Guarantee  as CreasedSolid answers, which searches all (tests/rounding/plain_crease_test.cpp)
// Cost       to find them: the triangles and creases within reach of each
// Legend     r radius; n_a, n_b normals of the two faces; a place beside the crease is (a, b, s): its heights above the
//            crease along n_a and n_b, and along the axis
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "arris/math.h"
#include "arris/rounding.h"
#include "edges/flat_regions.h"
#include "rounding/creased_solid.h"

namespace arris {

struct PlainCrease {
  Vec3d p0, axis;  // axis: unit
  double length = 0;
  Vec3d normal_a, normal_b;  // away from the creased solid, which may be the space outside
  double cosine = 0;         // between these
  std::uint32_t face_a = 0, face_b = 0;
  std::uint32_t part = 0;  // CreasePipes'
  bool is_fillet = false;  // of the space outside
};

// Where a ray in the void beside a crease meets its pipe, or else leaves by a face.
struct PlainCrossing {
  double t = 0;
  std::optional<Vec3d> normal;  // of the pipe, if it is met
};

// From x on one of the two faces, into the void. Nothing: x isn't beside the stretch, where the face is taken away by
// more than the tolerance, or the ray comes to the stretch's ends. The direction may have any length.
std::optional<PlainCrossing> cross_plainly(const PlainCrease& crease, const CreasedSolid& solid,
                                           std::uint32_t face, const Ray& ray);

// All of one solid that are long enough to be of use. planes: of its faces, by region.
std::vector<PlainCrease> find_plain_creases(const CreasedSolid& solid,
                                            std::span<const Plane> planes);

// The longer of what [low, high] leaves of [s0, s1].
struct Stretch {
  double s0, s1;

  void cut(double low, double high) {
    if (high <= s0 || low >= s1) return;
    if (low - s0 > s1 - high) {
      s1 = low;
    } else {
      s0 = high;
    }
  }
};

}  // namespace arris
