#include "beam/region_look.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <span>

#include "beam/cover_sweep.h"

namespace arris {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A leaf of a part, as one rectangle sees it; nothing: it is not met.
struct SpanSlot {
  std::uint32_t part = 0, slot = 0;
  LeafPlace place;
  std::optional<LeafSpan> span;
  bool is_goal = false;
};

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

// A depth at which a leaf in the window is entered or left.
struct Event {
  std::uint32_t index = 0;  // of the window's slots
  bool entering = true;
  Interval depth;
  std::optional<SpanEnd> end;  // which surface, once it is decided
};

class Looker {
 public:
  Looker(const BeamView& view, const BeamList& list, const Rect& rect, double depth_end,
         const LookOptions& options)
      : view_(view), parts_(list.parts), rect_(rect), depth_end_(depth_end), options_(options) {
    if (options_.only) parts_.push_back(make_goal(*options_.only));
    set_first_spans(list.spans);
  }

  LookTree run() {
    follow();
    const auto unknown = std::ranges::count(tree_.nodes, LookNode::Kind::unknown, &LookNode::kind);
    tree_.complete = unknown == 0;
    tree_.hopeless =
        unknown > 0 && std::ranges::count(tree_.nodes, true, &LookNode::is_noise) == unknown;
    return std::move(tree_);
  }

 private:
  // Appends what is seen under the assumptions so far; returns the node.
  std::uint32_t follow() {
    const auto node = std::uint32_t(tree_.nodes.size());
    tree_.nodes.emplace_back();
    SignOracle oracle(rect_, assumptions_);
    if (!find_window(oracle)) return node;  // nothing
    if (window_slots_.size() > options_.most_leaves) {
      tree_.nodes[node] = give_up();
      return node;
    }
    const std::optional<LookNode> found = find_first(oracle);
    if (found) {
      tree_.nodes[node] = *found;
      return node;
    }
    if (!oracle.open() || assumptions_.size() >= options_.most_signs) {
      tree_.nodes[node] = give_up();
      return node;
    }
    const OpenSign open = *oracle.open();
    assumptions_.push_back({open.key, false});
    const std::uint32_t negative = follow();
    assumptions_.back().positive = true;
    const std::uint32_t positive = follow();
    assumptions_.pop_back();
    const bool joined = join(node, open, negative, positive);
    // Below a sign that is rounding, smaller rectangles won't tell more.
    const bool noise =
        open.polynomial && is_noise(*open.polynomial, rect_) &&
        std::ranges::any_of(tree_.nodes.begin() + node, tree_.nodes.end(),
                            [](const LookNode& n) { return n.kind == LookNode::Kind::unknown; });
    if (!joined || noise) {
      tree_.nodes.resize(node + 1);
      find_window(oracle);  // for its leaves
      tree_.nodes[node] = give_up();
      tree_.nodes[node].is_noise = noise;
    }
    return node;
  }

  // False: the ends differ, and nothing says where.
  bool join(std::uint32_t node, const OpenSign& open, std::uint32_t negative,
            std::uint32_t positive) {
    const LookNode& a = tree_.nodes[negative];
    const LookNode& b = tree_.nodes[positive];
    const bool ends = a.kind == b.kind && (a.kind == LookNode::Kind::nothing ||
                                           (a.kind == LookNode::Kind::surface && a.seen == b.seen));
    if (ends) {
      tree_.nodes[node] = a;
      tree_.nodes.resize(negative);
      return true;
    }
    if (!open.polynomial) return false;
    LookNode& joined = tree_.nodes[node];
    joined.kind = LookNode::Kind::sign;
    joined.polynomial = *open.polynomial;
    joined.negative = negative;
    joined.positive = positive;
    return true;
  }

  LookNode give_up() {
    LookNode node;
    node.kind = LookNode::Kind::unknown;
    node.first = std::uint32_t(tree_.candidates.size());
    for (const SpanSlot* s : window_slots_) {
      for (const bool entering : {true, false}) {
        const auto& ends = entering ? s->span->entering : s->span->leaving;
        for (const SpanEnd& end : ends) {
          for (const bool enters_solid : {true, false}) {
            tree_.candidates.push_back(
                {s->place.solid, s->place.leaf, end.face, end.surface, enters_solid});
          }
        }
      }
    }
    node.count = std::uint32_t(tree_.candidates.size()) - node.first;
    return node;
  }

  // The spans without assumptions.
  void set_first_spans(const std::vector<LeafSpan>& spans) {
    for (std::uint32_t p = 0; p < parts_.size(); ++p) {
      first_of_part_.push_back(std::uint32_t(first_slots_.size()));
      const auto& leaves = parts_[p].expression.leaves();
      const bool is_goal = options_.only && p + 1 == parts_.size();
      for (std::uint32_t slot = 0; slot < leaves.size(); ++slot) {
        const LeafPlace place{parts_[p].solid, leaves[slot]};
        first_slots_.push_back(
            {p, slot, place,
             is_goal ? make_plane_span(view_, *options_.only, rect_) : spans[first_slots_.size()],
             is_goal});
      }
    }
  }
  // A part of one leaf, of which only the span counts.
  static BeamPart make_goal(const LitPlane& plane) {
    static const CsgExpression kGoal = [] {
      CsgTree tree;
      tree.nodes.push_back({0, CsgOperation::unite, {}});
      tree.leaves.emplace_back();
      return CsgExpression(tree, {true});
    }();
    return {plane.solid, kGoal};
  }
  // Does the assumption change what is known of the leaf's span?
  [[nodiscard]] bool concerns(const Assumption& assumption, const LeafPlace& place) const {
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
  static bool is_of_plane(const Assumption& a) {
    return a.key.of == SignKey::Of::height || a.key.of == SignKey::Of::slope;
  }
  static bool is_of_one(const Assumption& a) { return a.key.of < SignKey::Of::plane_plane; }

  void make_spans(const SignOracle& oracle, const std::vector<Assumption>& of_one) {
    slots_ = first_slots_;
    for (SpanSlot& s : slots_) {
      if (s.is_goal ||
          std::ranges::none_of(of_one, [&](const Assumption& a) { return concerns(a, s.place); })) {
        continue;
      }
      s.span = make_span(view_, s.place, depth_end_, oracle);
    }
  }

  [[nodiscard]] Cover value_at(std::uint32_t part, double depth) const {
    return eval_covers(parts_[part].expression, [&](std::uint32_t slot) {
      return cover_at(slots_[first_of_part_[part] + slot], depth);
    });
  }

  // The depths between which something certainly becomes visible, and the leaves that matter there. False: nothing.
  bool find_window(const SignOracle& oracle) {
    std::vector<Assumption> of_one;
    std::ranges::copy_if(assumptions_, std::back_inserter(of_one), is_of_one);
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
    widen_window();
    if (assumptions_.empty()) {
      tree_.depth_end = window_.hi;
      reduce();
    }
    return true;
  }

  // A leaf's cover from a depth on.
  struct Change {
    double depth = 0;
    std::uint32_t part = 0, slot = 0;
    Cover cover = Cover::out;
  };
  [[nodiscard]] std::vector<Change> make_changes() const {
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
  [[nodiscard]] Interval scan_depths() const {
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
  [[nodiscard]] bool are_unions() const {
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
  [[nodiscard]] Interval window_of_unions() const {
    Interval window{kInfinity, kInfinity};
    for (const SpanSlot& s : slots_) {
      if (!s.span) continue;
      window.lo = std::min(window.lo, s.span->enter.lo);
      if (s.span->certain) window.hi = std::min(window.hi, next_up(s.span->enter.hi));
    }
    return window;
  }

  // What does not matter in the window without assumptions doesn't under any.
  void reduce() {
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

  static bool same_assumption(const Assumption& a, const Assumption& b) {
    return a.key == b.key && a.positive == b.positive;
  }

  // To where no leaf that matters begins to be undecided before it.
  void widen_window() {
    for (;;) {
      prune_to_window();
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

  void prune_to_window() {
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

  // Goes along the ray from the window's near end. Nothing: a sign is open, or no sign helps.
  std::optional<LookNode> find_first(SignOracle& oracle) {
    std::vector<std::uint8_t> inside(window_slots_.size());
    std::vector<Event> events;  // the next of each leaf
    for (std::uint32_t i = 0; i < window_slots_.size(); ++i) {
      const SpanSlot& s = *window_slots_[i];
      const Met met = decide_met(view_, *s.span, s.place, oracle);
      if (met == Met::unknown) return std::nullopt;
      if (met == Met::no) continue;
      const bool starts = s.span->starts_inside || s.span->enter.hi < window_.lo;
      inside[i] = starts ? 1 : 0;
      if (starts && s.span->leave.lo == kInfinity) continue;  // for good
      events.push_back({i, !starts, starts ? s.span->leave : s.span->enter, std::nullopt});
    }
    std::vector<bool> values = eval_parts(inside);
    while (!events.empty()) {
      const std::optional<std::vector<std::size_t>> first = find_first_events(events, oracle);
      if (!first) return std::nullopt;
      if (first->empty()) break;
      std::optional<std::uint32_t> decider;
      const std::vector<bool> before = values;
      for (const std::size_t e : *first) {
        inside[events[e].index] ^= 1U;
        std::vector<bool> next = eval_parts(inside);
        if (next != values) decider = std::uint32_t(e);
        values = std::move(next);
      }
      if (values != before) {
        const Event& event = events[*decider];
        return seen_at(event, values[part_of_slot_[event.index]]);
      }
      advance(events, *first);
    }
    return LookNode{};  // nothing
  }

  [[nodiscard]] LookNode seen_at(const Event& event, bool enters_solid) const {
    const SpanSlot& s = *window_slots_[event.index];
    LookNode node;
    node.kind = LookNode::Kind::surface;
    const BeamSurface& surface = event.end->surface;
    const bool counts =
        !options_.only || (surface.is_plane() && surface.solid == options_.only->solid &&
                           surface.index == options_.only->plane);
    if (counts) node.seen = {s.place.solid, s.place.leaf, event.end->face, surface, enters_solid};
    if (options_.only && counts) node.seen = {surface.solid, 0, 0, surface, true};
    if (!counts) node.seen.surface.root = BeamSurface::Root::nearer;  // no plane
    return node;
  }

  void advance(std::vector<Event>& events, const std::vector<std::size_t>& done) {
    for (std::size_t k = done.size(); k-- > 0;) {
      const std::size_t at = done[k];
      Event& event = events[at];
      const Interval leave = window_slots_[event.index]->span->leave;
      if (event.entering && leave.lo < kInfinity) {
        event = {event.index, false, leave, std::nullopt};
      } else {
        events.erase(events.begin() + std::ptrdiff_t(at));
      }
    }
  }

  [[nodiscard]] std::vector<bool> eval_parts(const std::vector<std::uint8_t>& inside) const {
    std::vector<bool> values;
    std::size_t first = 0;
    for (const BeamPart& part : pruned_) {
      values.push_back(
          part.expression.eval([&](std::uint32_t slot) { return inside[first + slot] != 0; }));
      first += part.expression.leaves().size();
    }
    return values;
  }

  bool decide_surface(Event& event, SignOracle& oracle) {
    if (event.end) return true;
    const LeafSpan& span = *window_slots_[event.index]->span;
    event.end =
        decide_end(view_, event.entering ? span.entering : span.leaving, event.entering, oracle);
    if (event.end) event.end->depth = intersection(event.end->depth, event.depth);
    return event.end.has_value();
  }

  // Those that are met first, at one depth; empty: none of them is ever met. Ascending.
  std::optional<std::vector<std::size_t>> find_first_events(std::vector<Event>& events,
                                                            SignOracle& oracle) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < events.size(); ++i) {
      if (events[i].depth.lo < events[best].depth.lo) best = i;
    }
    std::vector<std::size_t> ties;
    if (!decide_surface(events[best], oracle)) return std::nullopt;
    ties.push_back(best);
    for (std::size_t i = 0; i < events.size(); ++i) {
      if (i == best || events[i].depth.lo > events[ties[0]].end->depth.hi) continue;
      if (!decide_surface(events[i], oracle)) return std::nullopt;
      const Order order = order_of(view_, *events[i].end, *events[ties[0]].end, oracle);
      if (order == Order::unknown) return std::nullopt;
      if (order == Order::before) ties.clear();
      if (order != Order::after) ties.push_back(i);
    }
    const Met met = decide_end_met(view_, *events[ties[0]].end, oracle);
    if (met == Met::unknown) return std::nullopt;
    if (met == Met::no) ties.clear();
    std::ranges::sort(ties);
    return ties;
  }

  const BeamView& view_;
  std::vector<BeamPart> parts_;
  Rect rect_;
  double depth_end_;
  LookOptions options_;
  LookTree tree_;
  std::vector<Assumption> assumptions_;
  std::vector<SpanSlot> first_slots_, slots_;
  std::vector<Assumption> window_assumptions_;  // that the window is made under
  bool has_window_ = false;
  std::vector<std::uint32_t> first_of_part_;
  Interval window_;
  std::vector<Cover> start_;  // the parts' values where the window may begin
  double base_ = 0;           // that depth
  bool is_reduced_ = false;
  std::vector<BeamPart> pruned_;
  std::vector<std::uint32_t> origin_of_pruned_;  // their indices in parts_
  std::vector<SpanSlot*> window_slots_;
  std::vector<std::uint32_t> part_of_slot_;
};

}  // namespace

BeamList prune_parts(const BeamView& view, const std::vector<BeamPart>& parts, const Rect& rect,
                     double depth_end) {
  const std::vector<Assumption> none;
  const SignOracle oracle(rect, none);
  BeamList list;
  std::vector<Cover> covers;
  std::vector<std::optional<LeafSpan>> spans;
  for (const BeamPart& part : parts) {
    covers.clear();
    spans.clear();
    bool any = false;
    const std::vector<std::uint32_t>& leaves = part.expression.leaves();
    for (const std::uint32_t leaf : leaves) {
      const bool is_near = view.window(part.solid, leaf).meets(rect);
      spans.push_back(is_near ? make_span(view, {part.solid, leaf}, depth_end, oracle)
                              : std::nullopt);
      const std::optional<LeafSpan>& span = spans.back();
      Cover cover = Cover::on;
      if (!span) cover = Cover::out;
      if (span && span->starts_inside && span->certain &&
          (span->leave.lo > depth_end || span->leave.lo == kInfinity)) {
        cover = Cover::in;
      }
      any = any || cover != Cover::on;
      covers.push_back(cover);
    }
    BeamPart kept{part.solid, any ? part.expression.prune(covers) : part.expression};
    if (kept.expression.is_decided()) continue;
    std::size_t at = 0;
    for (const std::uint32_t leaf : kept.expression.leaves()) {
      while (leaves[at] != leaf) ++at;
      list.spans.push_back(std::move(*spans[at]));
    }
    list.parts.push_back(std::move(kept));
  }
  return list;
}

namespace {

// Of so many leaves for each that is put in order it is asked whether they matter at the depths in question. Of more,
// parts of the rectangle will see fewer.
constexpr std::uint32_t kWindowLeaves = 16;

}  // namespace

LookTree look(const BeamView& view, const BeamList& list, const Rect& rect, double depth_end,
              const LookOptions& options) {
  if (list.spans.size() <= options.most_leaves * kWindowLeaves) {
    return Looker(view, list, rect, depth_end, options).run();
  }
  LookTree tree;
  tree.complete = false;
  tree.nodes.emplace_back();
  tree.nodes[0].kind = LookNode::Kind::unknown;
  return tree;
}

}  // namespace arris
