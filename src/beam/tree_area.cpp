#include "beam/tree_area.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/check.h"
#include "beam/beam_mirror.h"
#include "beam/beam_shadow.h"

namespace arris {
namespace {

// Of signs on the way from the root of a tree to an end: the eye's, and below a surface those of the lights that are
// looked at together, or below a mirror those of the mirrors that it shows one in another. No surface has both.
constexpr std::size_t kMostSigns =
    LookOptions{}.most_signs * (1 + std::max(ShadowLooker::kMostJointLights, kMostMirrors));

// A rectangle, clipped once for each sign. Convex, so that a clip adds at most one vertex; but for rounding, which may
// bend it where vertices coincide.
struct Polygon {
  static constexpr std::size_t kCorners = 4, kSlack = 8;
  static constexpr std::size_t kMost = kCorners + kMostSigns + kSlack;
  std::array<Vec2d, kMost> points;
  std::size_t count = 0;

  void add(Vec2d p) {
    ARRIS_CHECK(count < kMost, double(count));
    points[count++] = p;
  }
};

Polygon polygon_of(const Rect& r) {
  Polygon p;
  p.add({r.x0, r.y0});
  p.add({r.x1, r.y0});
  p.add({r.x1, r.y1});
  p.add({r.x0, r.y1});
  return p;
}

struct Moments {
  double area = 0;
  Vec2d centroid;
};

Moments moments_of(const Polygon& p) {
  Moments m;
  if (p.count < 3) return m;
  double x = 0, y = 0;
  const Vec2d o = p.points[0];
  for (std::size_t i = 2; i < p.count; ++i) {
    const Vec2d a{p.points[i - 1].x - o.x, p.points[i - 1].y - o.y};
    const Vec2d b{p.points[i].x - o.x, p.points[i].y - o.y};
    const double twice = a.x * b.y - a.y * b.x;
    m.area += twice / 2;
    x += twice * (a.x + b.x);
    y += twice * (a.y + b.y);
  }
  m.area = std::max(m.area, 0.0);
  if (m.area > 0) m.centroid = {o.x + x / (6 * m.area), o.y + y / (6 * m.area)};
  return m;
}

// A line over the picture: c + dx (x - at.x) + dy (y - at.y).
struct Line {
  double c, dx, dy;
  Vec2d at;
  [[nodiscard]] double operator()(Vec2d p) const {
    return c + dx * (p.x - at.x) + dy * (p.y - at.y);
  }
};

// Where sign · line ≥ 0.
Polygon clip(const Polygon& p, const Line& line, double sign) {
  Polygon out;
  for (std::size_t i = 0; i < p.count; ++i) {
    const Vec2d a = p.points[i], b = p.points[i + 1 < p.count ? i + 1 : 0];
    const double fa = sign * line(a), fb = sign * line(b);
    if (fa >= 0) out.add(a);
    if ((fa >= 0) != (fb >= 0)) {
      const double u = fa / (fa - fb);
      out.add({a.x + u * (b.x - a.x), a.y + u * (b.y - a.y)});
    }
  }
  return out;
}

class Integrator {
 public:
  Integrator(const LookTree& tree, const AreaOptions& options)
      : tree_(tree), options_(options), of_node_(tree.nodes.size()) {}

  std::vector<EndArea> run(const Rect& rect) {
    visit(rect, descend(0, rect));
    if (options_.with_samples) add_samples(rect);
    for (std::size_t i = 0; i < of_node_.size(); ++i) {
      of_node_[i].area.node = std::uint32_t(i);
      if (of_node_[i].area.hi > 0) ends_.push_back(of_node_[i].area);
    }
    return std::move(ends_);
  }

 private:
  struct NodeArea {
    EndArea area;
    double best = -1;  // the area of the piece that gave the sample
  };
  struct Piece {
    std::uint32_t node;
    Moments certain, possible;
  };

  [[nodiscard]] bool is_end(std::uint32_t node) const {
    return tree_.nodes[node].kind != LookNode::Kind::sign;
  }
  [[nodiscard]] std::uint32_t descend(std::uint32_t node, const Rect& rect) const {
    while (!is_end(node)) {
      const LookNode& n = tree_.nodes[node];
      const Sign sign = sign_of(range_over(n.polynomial, rect));
      if (sign == Sign::unknown) break;
      node = sign == Sign::negative ? n.negative : n.positive;
    }
    return node;
  }

  [[nodiscard]] std::uint32_t descend_at(Vec2d p) const {
    std::uint32_t node = 0;
    while (!is_end(node)) {
      const LookNode& n = tree_.nodes[node];
      const Sign sign = sign_of(value_at(n.polynomial, p.x, p.y));
      if (sign == Sign::unknown) break;
      node = sign == Sign::negative ? n.negative : n.positive;
    }
    return node;
  }

  // Is one of the signs that are open in the rectangle more than rounding?
  [[nodiscard]] bool helps_to_cut(const Rect& rect, std::uint32_t node) const {
    node = descend(node, rect);
    if (is_end(node)) return false;
    const LookNode& n = tree_.nodes[node];
    return !is_noise(n.polynomial, rect) || helps_to_cut(rect, n.negative) ||
           helps_to_cut(rect, n.positive);
  }

  void visit(const Rect& rect, std::uint32_t node) {
    if (is_end(node)) {
      const double area = rect.area();
      add(node, area, area, area, {rect.middle_x(), rect.middle_y()}, area);
      return;
    }
    pieces_.clear();
    const Polygon whole = polygon_of(rect);
    split(rect, node, whole, whole);
    double open = 0;
    for (const Piece& piece : pieces_) open += piece.possible.area - piece.certain.area;
    const double side = std::max(rect.width(), rect.height());
    // Each strip between two ends counts for both.
    if (open <= 2 * options_.tolerance * side || side <= options_.least_side ||
        !helps_to_cut(rect, node)) {
      accept(rect);
      return;
    }
    for (const Rect& part : quarters_of(rect)) visit(part, descend(node, part));
  }

  void split(const Rect& rect, std::uint32_t node, const Polygon& certain,
             const Polygon& possible) {
    node = descend(node, rect);
    if (possible.count < 3) return;
    if (is_end(node)) {
      pieces_.push_back({node, moments_of(certain), moments_of(possible)});
      return;
    }
    const LookNode& n = tree_.nodes[node];
    const Slab slab = slab_over(n.polynomial, rect);
    const Vec2d at{rect.middle_x(), rect.middle_y()};
    const Line low{slab.value.lo, slab.dx, slab.dy, at}, high{slab.value.hi, slab.dx, slab.dy, at};
    split(rect, n.negative, clip(certain, high, -1), clip(possible, low, -1));
    split(rect, n.positive, clip(certain, low, 1), clip(possible, high, 1));
  }

  // What is certain, and of the rest parts in proportion to what is open of each.
  void accept(const Rect& rect) {
    double certain = 0, open = 0;
    for (const Piece& piece : pieces_) {
      certain += piece.certain.area;
      open += std::max(0.0, piece.possible.area - piece.certain.area);
    }
    const double rest = std::max(0.0, rect.area() - certain);
    for (const Piece& piece : pieces_) {
      const double share =
          open > 0 ? rest * std::max(0.0, piece.possible.area - piece.certain.area) / open : 0;
      const bool sure = piece.certain.area > 0;
      const Moments& best = sure ? piece.certain : piece.possible;
      if (!(best.area > 0)) continue;
      // A certain piece, however small, gives a better sample than a possible one.
      add(piece.node, piece.certain.area, piece.possible.area, piece.certain.area + share,
          best.centroid, sure ? best.area : best.area * 1e-9);
    }
  }

  // Of a regular grid, those that are on an end's side of all signs; a coarser one where all is one end.
  void add_samples(const Rect& rect) {
    const bool is_one = is_end(descend(0, rect));
    const int most = is_one ? kSampleGrid / 2 : kSampleGrid;
    const int side = std::clamp(int(std::ceil(rect.width() * most)), 1, most);
    for (int k = 0; k < side * side; ++k) {
      const Vec2d at{rect.x0 + rect.width() * (k % side + 0.5) / side,
                     rect.y0 + rect.height() * (k / side + 0.5) / side};
      const std::uint32_t node = descend_at(at);
      if (is_end(node)) {
        of_node_[node].area.samples.push_back({at, rect.area() / (side * side)});
      }
    }
  }

  void add(std::uint32_t node, double lo, double hi, double estimate, Vec2d sample, double weight) {
    NodeArea& a = of_node_[node];
    a.area.lo += lo;
    a.area.hi += hi;
    a.area.estimate += estimate;
    if (weight <= a.best) return;
    a.best = weight;
    a.area.sample = sample;
  }

  const LookTree& tree_;
  AreaOptions options_;
  std::vector<NodeArea> of_node_;
  std::vector<EndArea> ends_;
  std::vector<Piece> pieces_;
};

}  // namespace

std::vector<EndArea> areas_of(const LookTree& tree, const Rect& rect, const AreaOptions& options) {
  return Integrator(tree, options).run(rect);
}

}  // namespace arris
