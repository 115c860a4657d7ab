// stuck_places.h — remembers in which places of faces balls get stuck
// What       Each face has a grid of places. Between four of them that agree all is as they are, elsewhere the place
//            itself is asked. What has been found out is kept in a table, in which it may be overwritten: a search by
//            growing_ball.h costs as much as hundreds of rays.
// Threads    may be used by several; what is answered does not depend on their order
// Cost       that of an answer table, which is not among the solid's bytes()
// Limits     what is smaller than a cell, an eighth of the radius, may be missed
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "arris/math.h"
#include "rounding/answer_table.h"

namespace arris {

class StuckPlaces {
 public:
  // No balls.
  StuckPlaces() = default;
  explicit StuckPlaces(double radius);

  // is_stuck: whether balls get stuck at a place of the face near one of its plane.
  enum class Answer : std::uint8_t { no, yes, not_on_face };
  // Nothing: the places around x don't agree.
  template <class IsStuck>
  [[nodiscard]] std::optional<bool> at(Vec3d x, Vec3d normal, std::uint32_t face,
                                       const IsStuck& is_stuck) const {
    const Axes axes = axes_across(normal);
    const double along_u = dot(x, axes.u) / spacing_, along_v = dot(x, axes.v) / spacing_;
    const double u0 = std::floor(along_u), v0 = std::floor(along_v);
    const Answer first = at_vertex(x, axes, {u0, v0}, face, is_stuck);
    const auto agrees = [&](double du, double dv) {
      return at_vertex(x, axes, {u0 + du, v0 + dv}, face, is_stuck) == first;
    };
    if (first != Answer::not_on_face && agrees(1, 0) && agrees(0, 1) && agrees(1, 1)) {
      return first == Answer::yes;
    }
    return std::nullopt;
  }

 private:
  struct Axes {
    Vec3f about;  // the normal, nearly
    Vec3d u, v;   // of the grid
  };

  template <class IsStuck>
  [[nodiscard]] Answer at_vertex(Vec3d x, const Axes& axes, const std::array<double, 2>& cell,
                                 std::uint32_t face, const IsStuck& is_stuck) const {
    const std::uint64_t hash = hash_of(face, axes, cell);
    return Answer(table_.answer(hash, [&] {
      return unsigned(is_stuck(x + axes.u * (cell[0] * spacing_ - dot(x, axes.u)) +
                               axes.v * (cell[1] * spacing_ - dot(x, axes.v))));
    }));
  }

  [[nodiscard]] static Axes axes_across(Vec3d normal);
  [[nodiscard]] static std::uint64_t hash_of(std::uint32_t face, const Axes& axes,
                                             const std::array<double, 2>& cell);

  double spacing_ = 0;
  AnswerTable table_;
};

}  // namespace arris
