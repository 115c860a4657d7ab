// cover_sweep.h — an expression's value in three-valued logic while its leaves change one by one
// What       Each operation counts its operands by their cover, so that a change climbs only as far as it matters.
// Cost       the steps once; a change at most the depth of the expression
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "csg/csg_expression.h"

namespace arris {

class CoverSweep {
 public:
  // All leaves are out. Precondition: not decided.
  explicit CoverSweep(const CsgExpression& expression);

  // `slot`: an index of the expression's leaves().
  void set(std::uint32_t slot, Cover cover);
  [[nodiscard]] Cover value() const { return nodes_.back().value; }

 private:
  static constexpr std::uint32_t kRoot = ~std::uint32_t{0};
  struct Node {
    CsgStep::Kind kind = CsgStep::Kind::leaf;
    std::uint32_t parent = kRoot;
    std::array<std::uint32_t, 3> counts{};  // of operands, by Cover
    Cover value = Cover::out;
  };
  static Cover value_of(const Node& node);
  void climb(std::uint32_t node, Cover value);

  std::vector<Node> nodes_;                     // by step
  std::vector<std::vector<std::uint32_t>> at_;  // by slot: its steps
};

}  // namespace arris
