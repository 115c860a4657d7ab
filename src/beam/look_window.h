// look_window.h — the depths at which the rays through a part of the picture meet the first thing
// What       Spans of the leaves (leaf_span.h) under assumptions give the depths at which each is certainly inside or
//            outside. The parts' trees are evaluated in three-valued logic over the depths, from the front, until one
//            certainly has changed: the window ends there. It begins where none may have changed yet. The leaves that
//            are undecided in it, and the trees over them, are what is left to be put in order (look_order.h).
// Guarantee  along every ray through the rectangle for which the assumptions hold, what is seen first begins within
//            the window, and only the window's leaves make it (tests/beam/region_look_test.cpp)
// Cost       one span for each leaf, and under assumptions for those that they concern; the sweep sorts the spans' ends
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "beam/region_look.h"

namespace arris {

// A leaf of a part, as one rectangle sees it; nothing: it is not met.
struct SpanSlot {
  std::uint32_t part = 0, slot = 0;
  LeafPlace place;
  std::optional<LeafSpan> span;
  bool is_goal = false;
};

class LookWindow {
 public:
  // `only`: see LookOptions.
  LookWindow(const BeamView& view, const BeamList& list, const Rect& rect, double depth_end,
             const std::optional<LitPlane>& only);
  // It has pointers to its own leaves.
  LookWindow(const LookWindow&) = delete;
  LookWindow& operator=(const LookWindow&) = delete;

  // The window under the oracle's assumptions. False: nothing is seen. Without assumptions it comes first, as what
  // does not matter then doesn't under any.
  bool find(const SignOracle& oracle, const std::vector<Assumption>& assumptions);

  // Of the window found last.
  [[nodiscard]] double near() const { return window_.lo; }
  // Its leaves, all with a span, and of which of parts() each is. The leaves of parts()[0] come first, and so on.
  [[nodiscard]] const std::vector<SpanSlot*>& slots() const { return window_slots_; }
  [[nodiscard]] std::uint32_t part_of(std::uint32_t slot) const { return part_of_slot_[slot]; }
  [[nodiscard]] const std::vector<BeamPart>& parts() const { return pruned_; }

  // No ray sees farther, whatever the assumptions.
  [[nodiscard]] double farthest() const { return farthest_; }

 private:
  // A leaf's cover from a depth on.
  struct Change {
    double depth = 0;
    std::uint32_t part = 0, slot = 0;
    Cover cover = Cover::out;
  };

  [[nodiscard]] bool concerns(const Assumption& assumption, const LeafPlace& place) const;
  void make_spans(const SignOracle& oracle, const std::vector<Assumption>& of_one);
  [[nodiscard]] Cover value_at(std::uint32_t part, double depth) const;
  [[nodiscard]] std::vector<Change> make_changes() const;
  [[nodiscard]] Interval scan_depths() const;
  [[nodiscard]] bool are_unions() const;
  [[nodiscard]] Interval window_of_unions() const;
  void reduce();
  void widen();
  void prune();

  const BeamView& view_;
  double depth_end_;
  std::vector<BeamPart> parts_;
  std::vector<std::uint32_t> first_of_part_;   // of their slots
  std::vector<SpanSlot> first_slots_, slots_;  // without assumptions, and under those of the window
  std::vector<Assumption> window_assumptions_;  // that the window is made under
  bool has_window_ = false;
  Interval window_;
  double farthest_ = std::numeric_limits<double>::infinity();
  std::vector<Cover> start_;  // the parts' values where the window may begin
  double base_ = 0;           // that depth
  bool is_reduced_ = false;
  std::vector<BeamPart> pruned_;
  std::vector<std::uint32_t> origin_of_pruned_;  // their indices in parts_
  std::vector<SpanSlot*> window_slots_;
  std::vector<std::uint32_t> part_of_slot_;
};

}  // namespace arris
