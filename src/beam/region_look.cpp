#include "beam/region_look.h"

#include <algorithm>
#include <optional>

#include "beam/look_order.h"
#include "beam/look_window.h"

namespace arris {
namespace {

class Looker {
 public:
  Looker(const BeamView& view, const BeamList& list, const Rect& rect, double depth_end,
         const LookOptions& options)
      : view_(view),
        rect_(rect),
        options_(options),
        window_(view, list, rect, depth_end, options.only) {}

  LookTree run() {
    follow();
    tree_.depth_end = window_.farthest();
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
    if (!window_.find(oracle, assumptions_)) return node;  // nothing
    if (window_.slots().size() > options_.most_leaves) {
      tree_.nodes[node] = give_up();
      return node;
    }
    const std::optional<LookNode> found = find_first(view_, window_, options_.only, oracle);
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
    const bool noise = joined && is_rounding(node, open);
    if (!joined || noise) {
      tree_.nodes.resize(node + 1);
      window_.find(oracle, assumptions_);  // for its leaves
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

  // Is the sign at the node rounding, and something below it unknown? Smaller rectangles won't tell more. Nor do they
  // where it is a sign of one surface: the eye lies in it, or in a cone's apex. Where two surfaces coincide, though,
  // it is known that one of them is seen.
  [[nodiscard]] bool is_rounding(std::uint32_t node, const OpenSign& open) const {
    if (tree_.nodes[node].kind != LookNode::Kind::sign || !is_noise(*open.polynomial, rect_)) {
      return false;
    }
    return open.key.of < SignKey::Of::plane_plane ||
           std::ranges::any_of(tree_.nodes.begin() + node, tree_.nodes.end(),
                               [](const LookNode& n) { return n.kind == LookNode::Kind::unknown; });
  }

  LookNode give_up() {
    LookNode node;
    node.kind = LookNode::Kind::unknown;
    node.first = std::uint32_t(tree_.candidates.size());
    for (const SpanSlot* s : window_.slots()) {
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

  const BeamView& view_;
  Rect rect_;
  LookOptions options_;
  LookWindow window_;
  LookTree tree_;
  std::vector<Assumption> assumptions_;
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
          (span->leave.lo > depth_end ||
           span->leave.lo == std::numeric_limits<double>::infinity())) {
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
