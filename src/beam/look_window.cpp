#include "beam/look_window.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <span>

#include "beam/cover_sweep.h"

namespace arris {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Cover cover_at(const SpanSlot& s, double depth) {
  if (!s.span) return Cover::out;
  const LeafSpan& span = *s.span;
  if (!span.starts_inside && depth < span.enter.lo) return Cover::out;
  if (depth > span.leave.hi) return Cover::out;
  const bool entered = span.starts_inside || depth > span.enter.hi;
  return span.certain && entered && depth < span.leave.lo ? Cover::in : Cover::on;
}

// Over the closed interval of depths.
Cover cover_over(const SpanSlot& s, Interval depths) {
  if (!s.span) return Cover::out;
  const LeafSpan& span = *s.span;
  if (!span.starts_inside && depths.hi < span.enter.lo) return Cover::out;
  if (depths.lo > span.leave.hi) return Cover::out;
  const bool entered = span.starts_inside || depths.lo > span.enter.hi;
  return span.certain && entered && depths.hi < span.leave.lo ? Cover::in : Cover::on;
}

Cover join_covers(CsgStep::Kind kind, std::span<const Cover> operands) {
  Cover value =
      kind == CsgStep::Kind::intersect || kind == CsgStep::Kind::even ? Cover::in : Cover::out;
  for (const Cover cover : operands) {
    switch (kind) {
      case CsgStep::Kind::unite:
        value = value | cover;
        break;
      case CsgStep::Kind::intersect:
        value = value & cover;
        break;
      default:  // parities
        if (cover == Cover::on) return Cover::on;
        if (cover == Cover::in) value = !value;
    }
  }
  return value;
}

template <class CoverOf>
Cover eval_covers(const CsgExpression& expression, const CoverOf& cover_of) {
  if (expression.is_decided()) return expression.value();
  thread_local std::vector<Cover> stack;
  stack.clear();
  for (const CsgStep& step : expression.steps()) {
    if (step.kind == CsgStep::Kind::leaf || step.kind == CsgStep::Kind::complement) {
      const Cover cover = cover_of(step.value);
      stack.push_back(step.kind == CsgStep::Kind::leaf ? cover : !cover);
      continue;
    }
    const std::size_t first = stack.size() - step.value;
    const Cover value = join_covers(step.kind, std::span(stack).subspan(first));
    stack.resize(first);
    stack.push_back(value);
  }
  return stack.back();
}

// A part of one leaf, of which only the span counts.
BeamPart make_goal(const LitPlane& plane) {
  static const CsgExpression kGoal = [] {
    CsgTree tree;
    tree.nodes.push_back({0, CsgOperation::unite, {}});
    tree.leaves.emplace_back();
    return CsgExpression(tree, {true});
  }();
  return {plane.solid, kGoal};
}

bool is_of_plane(const Assumption& a) {
  return a.key.of == SignKey::Of::height || a.key.of == SignKey::Of::slope;
}
bool is_of_one(const Assumption& a) {
  return a.key.of < SignKey::Of::plane_plane;
}

bool same_assumption(const Assumption& a, const Assumption& b) {
  return a.key == b.key && a.positive == b.positive;
}

}  // namespace

LookWindow::LookWindow(const BeamView& view, const BeamList& list, const Rect& rect,
                       double depth_end, const std::optional<LitPlane>& only)
    : view_(view), depth_end_(depth_end), parts_(list.parts) {
  std::optional<LeafSpan> goal;
  if (only) {
    parts_.push_back(make_goal(*only));
    goal = make_plane_span(view_, *only, rect);
  }
  for (std::uint32_t p = 0; p < parts_.size(); ++p) {
    first_of_part_.push_back(std::uint32_t(first_slots_.size()));
    const auto& leaves = parts_[p].expression.leaves();
    const bool is_goal = only && p + 1 == parts_.size();
    for (std::uint32_t slot = 0; slot < leaves.size(); ++slot) {
      first_slots_.push_back({p,
                              slot,
                              {parts_[p].solid, leaves[slot]},
                              is_goal ? goal : list.spans[first_slots_.size()],
                              is_goal});
    }
  }
}

// Does the assumption change what is known of the leaf's span?
bool LookWindow::concerns(const Assumption& assumption, const LeafPlace& place) const {
  if (assumption.key.solid_a != place.solid) return false;
  if (place.leaf == kStartLeaf) return false;
  const BeamShape& shape = view_.shape(place.solid);
  if (const Facet* facet = shape.facet(place.leaf)) {
    return assumption.key.of == SignKey::Of::side &&
           std::ranges::find(facet->edges, assumption.key.index_a) != facet->edges.end();
  }
  if (shape.convex(place.leaf) == nullptr || assumption.key.of == SignKey::Of::side) return false;
  const ConvexLeaf& leaf = *shape.convex(place.leaf);
  if (is_of_plane(assumption)) {
    return std::ranges::any_of(leaf.planes,
                               [&](PlaneRef ref) { return ref.plane == assumption.key.index_a; });
  }
  return leaf.quadric && *leaf.quadric == assumption.key.index_a;
}

void LookWindow::make_spans(const SignOracle& oracle, const std::vector<Assumption>& of_one) {
  slots_ = first_slots_;
  for (SpanSlot& s : slots_) {
    if (s.is_goal ||
        std::ranges::none_of(of_one, [&](const Assumption& a) { return concerns(a, s.place); })) {
      continue;
    }
    s.span = make_span(view_, s.place, depth_end_, oracle);
  }
}

Cover LookWindow::value_at(std::uint32_t part, double depth) const {
  return eval_covers(parts_[part].expression, [&](std::uint32_t slot) {
    return cover_at(slots_[first_of_part_[part] + slot], depth);
  });
}

bool LookWindow::find(const SignOracle& oracle, const std::vector<Assumption>& assumptions) {
  std::vector<Assumption> of_one;
  std::ranges::copy_if(assumptions, std::back_inserter(of_one), is_of_one);
  if (has_window_ && std::ranges::equal(of_one, window_assumptions_, same_assumption)) {
    return window_.lo < kInfinity;
  }
  make_spans(oracle, of_one);
  window_assumptions_ = std::move(of_one);
  has_window_ = true;
  if (!is_reduced_) {
    start_.clear();
    for (std::uint32_t p = 0; p < parts_.size(); ++p) start_.push_back(value_at(p, 0));
  }
  window_ = are_unions() ? window_of_unions() : scan_depths();
  if (window_.lo == kInfinity) return false;
  widen();
  if (assumptions.empty()) {
    farthest_ = window_.hi;
    reduce();
  }
  return true;
}

std::vector<LookWindow::Change> LookWindow::make_changes() const {
  std::vector<Change> changes;
  for (const SpanSlot& s : slots_) {
    if (!s.span) continue;
    const auto add = [&](double depth, Cover cover) {
      if (depth < kInfinity) changes.push_back({std::max(depth, base_), s.part, s.slot, cover});
    };
    const LeafSpan& span = *s.span;
    if (!span.starts_inside) add(span.enter.lo, Cover::on);
    if (span.certain && span.starts_inside) add(base_, Cover::in);
    if (span.certain && !span.starts_inside) add(span.enter.hi, Cover::in);
    if (!span.certain && span.starts_inside) add(base_, Cover::on);
    add(span.leave.lo, Cover::on);
    add(span.leave.hi, Cover::out);
  }
  // Those of one leaf stay in their order.
  std::ranges::stable_sort(changes, {}, &Change::depth);
  return changes;
}

// Where the values differ from those at the start, and where they certainly do.
Interval LookWindow::scan_depths() const {
  const std::vector<Change> changes = make_changes();
  std::vector<CoverSweep> values;
  for (const BeamPart& part : parts_) values.emplace_back(part.expression);
  Interval window{kInfinity, kInfinity};
  for (std::size_t i = 0; i < changes.size();) {
    const double depth = changes[i].depth;
    for (; i < changes.size() && changes[i].depth == depth; ++i) {
      values[changes[i].part].set(changes[i].slot, changes[i].cover);
    }
    for (std::uint32_t p = 0; p < parts_.size(); ++p) {
      const Cover value = values[p].value();
      if (value == start_[p] && value != Cover::on) continue;
      window.lo = std::min(window.lo, depth);
      if (value == Cover::on || start_[p] == Cover::on) continue;
      const double next = i < changes.size() ? changes[i].depth : 2 * depth + 1;
      window.hi = depth / 2 + next / 2;
      return window;
    }
  }
  return window;
}

// Meshes, and much else, are unions of leaves: the first one certainly entered ends the window.
bool LookWindow::are_unions() const {
  for (std::uint32_t p = 0; p < parts_.size(); ++p) {
    if (start_[p] != Cover::out) return false;
    const std::vector<CsgStep>& steps = parts_[p].expression.steps();
    const std::size_t leaves = steps.size() > 1 ? steps.size() - 1 : 1;
    if (steps.size() > 1 &&
        (steps.back().kind != CsgStep::Kind::unite || steps.back().value != leaves)) {
      return false;
    }
    for (std::size_t i = 0; i < leaves; ++i) {
      if (steps[i].kind != CsgStep::Kind::leaf) return false;
    }
  }
  return true;
}

Interval LookWindow::window_of_unions() const {
  Interval window{kInfinity, kInfinity};
  for (const SpanSlot& s : slots_) {
    if (!s.span) continue;
    window.lo = std::min(window.lo, s.span->enter.lo);
    if (s.span->certain) window.hi = std::min(window.hi, next_up(s.span->enter.hi));
  }
  return window;
}

// What does not matter in the window without assumptions doesn't under any.
void LookWindow::reduce() {
  if (is_reduced_ || std::ranges::find(start_, Cover::on) != start_.end()) return;
  is_reduced_ = true;
  base_ = window_.lo;
  std::vector<Cover> start;
  for (const std::uint32_t p : origin_of_pruned_) start.push_back(start_[p]);
  start_ = std::move(start);
  parts_ = pruned_;
  first_of_part_.clear();
  std::vector<SpanSlot> kept;
  for (std::uint32_t p = 0; p < parts_.size(); ++p) {
    first_of_part_.push_back(std::uint32_t(kept.size()));
    for (std::uint32_t slot = 0; slot < parts_[p].expression.leaves().size(); ++slot) {
      kept.push_back(*window_slots_[kept.size()]);
      kept.back().part = p;
      kept.back().slot = slot;
    }
  }
  first_slots_ = std::move(kept);
  slots_ = first_slots_;
  for (std::size_t i = 0; i < slots_.size(); ++i) window_slots_[i] = &slots_[i];
}

// To where no leaf that matters begins to be undecided before it.
void LookWindow::widen() {
  for (;;) {
    prune();
    double low = window_.lo;
    for (const SpanSlot* s : window_slots_) {
      const LeafSpan& span = *s->span;
      const bool enter_is_open = !span.starts_inside && window_.lo <= span.enter.hi;
      if (!span.certain || enter_is_open) {
        low = std::min(low, span.starts_inside ? 0 : span.enter.lo);
      } else {
        low = std::min(low, span.leave.lo);
      }
    }
    if (low >= window_.lo) return;
    window_.lo = low;
  }
}

void LookWindow::prune() {
  pruned_.clear();
  origin_of_pruned_.clear();
  window_slots_.clear();
  for (std::uint32_t p = 0; p < parts_.size(); ++p) {
    std::vector<Cover> covers;
    const CsgExpression& whole = parts_[p].expression;
    for (std::uint32_t slot = 0; slot < whole.leaves().size(); ++slot) {
      covers.push_back(cover_over(slots_[first_of_part_[p] + slot], window_));
    }
    BeamPart part{parts_[p].solid, whole.prune(covers)};
    if (part.expression.is_decided()) continue;
    for (const std::uint32_t leaf : part.expression.leaves()) {
      const auto at = std::ranges::lower_bound(whole.leaves(), leaf) - whole.leaves().begin();
      SpanSlot& s = slots_[first_of_part_[p] + std::size_t(at)];
      window_slots_.push_back(&s);
      part_of_slot_.resize(window_slots_.size());
      part_of_slot_[window_slots_.size() - 1] = std::uint32_t(pruned_.size());
    }
    pruned_.push_back(std::move(part));
    origin_of_pruned_.push_back(p);
  }
}

}  // namespace arris
