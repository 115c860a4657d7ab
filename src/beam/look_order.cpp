#include "beam/look_order.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace arris {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// A depth at which a leaf in the window is entered or left.
struct Event {
  std::uint32_t index = 0;  // of the window's slots
  bool entering = true;
  Interval depth;
  std::optional<SpanEnd> end;  // which surface, once it is decided
};

class RayOrder {
 public:
  RayOrder(const BeamView& view, const LookWindow& window, const std::optional<LitPlane>& only,
           SignOracle& oracle)
      : view_(view), window_(window), only_(only), oracle_(oracle) {}

  // Goes along the ray from the window's near end. Nothing: a sign is open, or no sign helps.
  std::optional<LookNode> find_first() {
    std::vector<std::uint8_t> inside(window_.slots().size());
    std::vector<Event> events;  // the next of each leaf
    for (std::uint32_t i = 0; i < window_.slots().size(); ++i) {
      const SpanSlot& s = *window_.slots()[i];
      const Met met = decide_met(view_, *s.span, s.place, oracle_);
      if (met == Met::unknown) return std::nullopt;
      if (met == Met::no) continue;
      const bool starts = s.span->starts_inside || s.span->enter.hi < window_.near();
      inside[i] = starts ? 1 : 0;
      if (starts && s.span->leave.lo == kInfinity) continue;  // for good
      events.push_back({i, !starts, starts ? s.span->leave : s.span->enter, std::nullopt});
    }
    std::vector<bool> values = eval_parts(inside);
    while (!events.empty()) {
      const std::optional<std::vector<std::size_t>> first = find_first_events(events);
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
        return seen_at(event, values[window_.part_of(event.index)]);
      }
      advance(events, *first);
    }
    return LookNode{};  // nothing
  }

 private:
  [[nodiscard]] LookNode seen_at(const Event& event, bool enters_solid) const {
    const SpanSlot& s = *window_.slots()[event.index];
    LookNode node;
    node.kind = LookNode::Kind::surface;
    const BeamSurface& surface = event.end->surface;
    const bool counts = !only_ || (surface.is_plane() && surface.solid == only_->solid &&
                                   surface.index == only_->plane);
    if (counts) node.seen = {s.place.solid, s.place.leaf, event.end->face, surface, enters_solid};
    if (only_ && counts) node.seen = {surface.solid, 0, 0, surface, true};
    if (!counts) node.seen.surface.root = BeamSurface::Root::nearer;  // no plane
    return node;
  }

  void advance(std::vector<Event>& events, const std::vector<std::size_t>& done) {
    for (std::size_t k = done.size(); k-- > 0;) {
      const std::size_t at = done[k];
      Event& event = events[at];
      const Interval leave = window_.slots()[event.index]->span->leave;
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
    for (const BeamPart& part : window_.parts()) {
      values.push_back(
          part.expression.eval([&](std::uint32_t slot) { return inside[first + slot] != 0; }));
      first += part.expression.leaves().size();
    }
    return values;
  }

  bool decide_surface(Event& event) {
    if (event.end) return true;
    const LeafSpan& span = *window_.slots()[event.index]->span;
    event.end =
        decide_end(view_, event.entering ? span.entering : span.leaving, event.entering, oracle_);
    if (event.end) event.end->depth = intersection(event.end->depth, event.depth);
    return event.end.has_value();
  }

  // Those that are met first, at one depth; empty: none of them is ever met. Ascending.
  std::optional<std::vector<std::size_t>> find_first_events(std::vector<Event>& events) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < events.size(); ++i) {
      if (events[i].depth.lo < events[best].depth.lo) best = i;
    }
    std::vector<std::size_t> ties;
    if (!decide_surface(events[best])) return std::nullopt;
    ties.push_back(best);
    for (std::size_t i = 0; i < events.size(); ++i) {
      if (i == best || events[i].depth.lo > events[ties[0]].end->depth.hi) continue;
      if (!decide_surface(events[i])) return std::nullopt;
      const Order order = order_of(view_, *events[i].end, *events[ties[0]].end, oracle_);
      if (order == Order::unknown) return std::nullopt;
      if (order == Order::before) ties.clear();
      if (order != Order::after) ties.push_back(i);
    }
    const Met met = decide_end_met(view_, *events[ties[0]].end, oracle_);
    if (met == Met::unknown) return std::nullopt;
    if (met == Met::no) ties.clear();
    std::ranges::sort(ties);
    return ties;
  }

  const BeamView& view_;
  const LookWindow& window_;
  const std::optional<LitPlane>& only_;
  SignOracle& oracle_;
};

}  // namespace

std::optional<LookNode> find_first(const BeamView& view, const LookWindow& window,
                                   const std::optional<LitPlane>& only, SignOracle& oracle) {
  return RayOrder(view, window, only, oracle).find_first();
}

}  // namespace arris
