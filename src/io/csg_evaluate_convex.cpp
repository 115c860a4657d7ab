// csg_evaluate_convex.cpp — hull, minkowski and offset
// Round shapes stay exact where the result is made of primitives: balls of one radius; cylinders and prisms of one
// axis; plane shapes. Everything else that is round is cut into kHullFacets facets.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "io/csg_evaluator.h"
#include "io/csg_extrude.h"

namespace arris {
namespace {

constexpr int kHullFacets = 96;
constexpr double kSixDigits = 4e-6;
constexpr std::size_t kMaxPairs = 4096;  // of convex pieces that are added
constexpr std::size_t kMaxHullPoints = 1'000'000;
constexpr std::size_t kMaxOffsetEdges = 500;

// A convex or at least hulled part in three forms; `points` always.
struct Piece {
  bool is_convex = true;
  bool is_round = false;  // `points` only come near
  std::vector<Vec3d> points;
  std::optional<std::vector<Ball>> balls;  // whose hull it is
  // A prism about z over the hull of discs.
  struct Upright {
    std::vector<Disc2d> discs;
    double z_low = 0, z_high = 0;
  };
  std::optional<Upright> upright;
};

// How much the matrix scales all lengths alike.
std::optional<double> similarity(const Mat3d& m) {
  const double x = length_squared(m.x), y = length_squared(m.y), z = length_squared(m.z);
  const double slack = kSixDigits * x;
  const bool alike = std::abs(x - y) <= slack && std::abs(x - z) <= slack &&
                     std::abs(dot(m.x, m.y)) <= slack && std::abs(dot(m.y, m.z)) <= slack &&
                     std::abs(dot(m.z, m.x)) <= slack;
  return alike ? std::optional(std::sqrt((x + y + z) / 3)) : std::nullopt;
}

std::vector<Ball> as_balls(const std::vector<Vec3d>& points) {
  std::vector<Ball> balls;
  for (const Vec3d& p : points) balls.push_back({p, 0});
  return balls;
}

// Points on two levels, each below one of the other.
std::optional<Piece::Upright> find_upright(const std::vector<Vec3d>& points) {
  Vec3d low(1e300), high(-1e300);
  for (const Vec3d& p : points) {
    low = min(low, p);
    high = max(high, p);
  }
  const double slack = kSixDigits * max_component(high - low);
  std::vector<Vec2d> bottom, top;
  for (const Vec3d& p : points) {
    if (p.z <= low.z + slack) {
      bottom.push_back({p.x, p.y});
    } else if (p.z >= high.z - slack) {
      top.push_back({p.x, p.y});
    } else {
      return std::nullopt;
    }
  }
  const Outline below = hull_of_points(bottom), above = hull_of_points(top);
  const auto covers = [&](const Outline& all, const Outline& some) {
    return std::ranges::all_of(some, [&](Vec2d p) {
      return std::ranges::any_of(all, [&](Vec2d q) {
        return std::abs(p.x - q.x) <= slack && std::abs(p.y - q.y) <= slack;
      });
    });
  };
  if (below.size() < 3 || below.size() > 1000 || above.size() != below.size() ||
      !covers(above, below)) {
    return std::nullopt;
  }
  Piece::Upright upright{{}, low.z, high.z};
  for (const Vec2d& p : below) upright.discs.push_back({p, 0, 0});
  return upright;
}

class PieceMaker {
 public:
  explicit PieceMaker(const Affine3d& m) : m_(m) {}

  Piece operator()(const CsgSphere& sphere) const {
    Piece piece = round(sphere_points(sphere.radius, kHullFacets));
    if (const auto scale = similarity(m_.linear))
      piece.balls = {{m_.translation, sphere.radius * *scale}};
    return piece;
  }
  Piece operator()(const CsgBox& box) const {
    std::vector<Vec3d> corners;
    for (int i = 0; i < 8; ++i) {
      corners.emplace_back((i & 1) != 0 ? box.high.x : box.low.x,
                           (i & 2) != 0 ? box.high.y : box.low.y,
                           (i & 4) != 0 ? box.high.z : box.low.z);
    }
    return sharp(corners);
  }
  Piece operator()(const CsgCone& cone) const {
    Piece piece = round(cone_points(cone, kHullFacets));
    const Mat3d& l = m_.linear;
    const double size = std::max({length(l.x), length(l.y), length(l.z)}),
                 slack = kSixDigits * size;
    const bool is_upright = std::abs(l.x.z) <= slack && std::abs(l.y.z) <= slack &&
                            std::abs(l.z.x) <= slack && std::abs(l.z.y) <= slack;
    const FlatDisc disc{
        {m_.translation.x, m_.translation.y}, {l.x.x, l.x.y}, {l.y.x, l.y.y}, kHullFacets};
    const std::optional<double> scale = round_radius(disc);
    if (is_upright && scale && cone.radius_low == cone.radius_high) {
      const double a = m_.translation.z + l.z.z * cone.z_low,
                   b = m_.translation.z + l.z.z * cone.z_high;
      piece.upright = {
          {{disc.center, cone.radius_low * *scale, kHullFacets}}, std::min(a, b), std::max(a, b)};
    }
    return piece;
  }
  Piece operator()(const CsgTorus& torus) const {
    std::vector<Vec3d> points;
    for (int i = 0; i < kHullFacets; ++i) {
      const double tube = 2 * kPi * i / kHullFacets;
      const double r = std::max(torus.ring_radius + torus.tube_radius * std::cos(tube), 0.0);
      turn({r, torus.tube_radius * std::sin(tube)}, points);
    }
    return not_convex(round(points));
  }
  Piece operator()(const CsgHalfSpace& /*half_space*/) const {
    throw ScadUnsupported{"its content has no simple hull"};
  }
  Piece operator()(const CsgPolyhedron& polyhedron) const { return sharp(polyhedron.vertices); }
  Piece operator()(const CsgMesh& mesh) const { return not_convex(sharp(mesh.vertices)); }
  Piece operator()(const CsgPrism& prism) const {
    std::vector<Vec3d> points;
    for (const Outline& outline : prism.region.outlines) {
      for (const Vec2d& p : outline) {
        points.emplace_back(p.x, p.y, prism.z_low);
        points.emplace_back(p.x * prism.scale_high.x, p.y * prism.scale_high.y, prism.z_high);
      }
    }
    const bool convex = is_convex(prism.region) && prism.scale_high.x == prism.scale_high.y;
    return convex ? sharp(points) : not_convex(sharp(points));
  }
  Piece operator()(const CsgRevolution& revolution) const {
    std::vector<Vec3d> points;
    for (const Outline& outline : revolution.region.outlines) {
      for (const Vec2d& p : outline) turn(p, points);
    }
    return not_convex(round(points));
  }
  Piece operator()(const CsgRounded& rounded) const {
    const std::optional<double> scale = similarity(m_.linear);
    if (!scale) throw ScadUnsupported{"its content is stretched"};
    Piece piece;
    piece.is_round = true;
    piece.balls.emplace();
    for (const Vec3d& p : rounded.core.vertices) {
      piece.balls->push_back({transform_point(m_, p), rounded.radius * *scale});
      for (const Vec3d& q : sphere_points(rounded.radius, kHullFacets)) {
        piece.points.push_back(transform_point(m_, p + q));
      }
    }
    return piece;
  }

 private:
  static void turn(Vec2d p, std::vector<Vec3d>& points) {
    for (int k = 0; k < kHullFacets; ++k) {
      const double angle = 2 * kPi * k / kHullFacets;
      points.emplace_back(p.x * std::cos(angle), p.x * std::sin(angle), p.y);
    }
  }
  [[nodiscard]] Piece round(const std::vector<Vec3d>& points) const {
    Piece piece;
    piece.is_round = true;
    for (const Vec3d& p : points) piece.points.push_back(transform_point(m_, p));
    return piece;
  }
  [[nodiscard]] Piece sharp(const std::vector<Vec3d>& points) const {
    Piece piece = round(points);
    piece.is_round = false;
    piece.balls = as_balls(piece.points);
    piece.upright = find_upright(piece.points);
    return piece;
  }
  static Piece not_convex(Piece piece) {
    piece.is_convex = false;
    return piece;
  }

  const Affine3d& m_;
};

void collect_leaves(const SolidShape& shape, std::vector<const CsgLeaf*>& leaves) {
  if (shape.leaf) {
    leaves.push_back(&*shape.leaf);
    return;
  }
  if (!shape.children.empty() && shape.operation != CsgOperation::unite) {
    throw ScadUnsupported{
        "a " +
        std::string(shape.operation == CsgOperation::subtract ? "difference" : "intersection") +
        " in it has no simple hull"};
  }
  for (const SolidShape& child : shape.children) collect_leaves(child, leaves);
}

// A frame whose z is the axis of the first cylinder: prisms of one axis then stand upright.
Mat3d common_frame(const std::vector<const CsgLeaf*>& leaves) {
  for (const CsgLeaf* leaf : leaves) {
    if (!std::holds_alternative<CsgCone>(leaf->primitive)) continue;
    const Vec3d z = normalize(leaf->object_from_primitive.linear.z);
    if (std::abs(z.z) > 1 - 1e-12) break;
    const Vec3d x = normalize(cross(std::abs(z.x) < 0.6 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0), z));
    return {x, cross(z, x), z};
  }
  return {};
}

std::vector<Piece> make_pieces(const std::vector<const CsgLeaf*>& leaves, const Mat3d& frame) {
  std::vector<Piece> pieces;
  std::size_t points = 0;
  for (const CsgLeaf* leaf : leaves) {
    const Affine3d m = Affine3d{transpose(frame), {}} * leaf->object_from_primitive;
    pieces.push_back(std::visit(PieceMaker(m), leaf->primitive));
    points += pieces.back().points.size();
    if (points > kMaxHullPoints) throw ScadUnsupported{"its hull has too many points"};
  }
  return pieces;
}

std::optional<SolidShape> hull_of_upright(const Piece::Upright& upright,
                                          const LeafMaker& make_leaf) {
  const std::optional<FlatShape> base = hull_of_discs(upright.discs);
  if (!base) return std::nullopt;
  LinearExtrusion extrusion;
  extrusion.z_low = upright.z_low;
  extrusion.z_high = upright.z_high;
  return extrude(*base, extrusion, make_leaf);
}

SolidShape hull_of_facets(const std::vector<Vec3d>& points, const LeafMaker& make_leaf) {
  std::optional<CsgPrimitive> hull = hull_of_points(points);
  return hull ? make_leaf(*std::move(hull)) : SolidShape{};
}

// All pieces stand on one level and reach to another.
std::optional<Piece::Upright> joint_upright(const std::vector<Piece>& pieces) {
  Piece::Upright joint;
  for (const Piece& piece : pieces) {
    if (!piece.upright) return std::nullopt;
    if (joint.discs.empty()) {
      joint.z_low = piece.upright->z_low;
      joint.z_high = piece.upright->z_high;
    }
    const double slack = kSixDigits * (joint.z_high - joint.z_low + std::abs(joint.z_low));
    if (std::abs(piece.upright->z_low - joint.z_low) > slack ||
        std::abs(piece.upright->z_high - joint.z_high) > slack) {
      return std::nullopt;
    }
    joint.discs.insert(joint.discs.end(), piece.upright->discs.begin(), piece.upright->discs.end());
  }
  return joint;
}

bool any_round(const std::vector<Piece>& pieces) {
  return std::any_of(pieces.begin(), pieces.end(), [](const Piece& p) { return p.is_round; });
}

// What both span when every point of one is added to every point of the other.
struct Sum {
  std::optional<std::vector<Ball>> balls;
  std::optional<Piece::Upright> upright;
};

Sum add(const Piece& a, const Piece& b) {
  Sum sum;
  const auto few = [](std::size_t m, std::size_t n) { return m * n <= kMaxHullPoints; };
  if (a.balls && b.balls && few(a.balls->size(), b.balls->size())) {
    sum.balls.emplace();
    for (const Ball& p : *a.balls) {
      for (const Ball& q : *b.balls)
        sum.balls->push_back({p.center + q.center, p.radius + q.radius});
    }
  }
  if (a.upright && b.upright && few(a.upright->discs.size(), b.upright->discs.size())) {
    sum.upright = Piece::Upright{
        {}, a.upright->z_low + b.upright->z_low, a.upright->z_high + b.upright->z_high};
    for (const Disc2d& p : a.upright->discs) {
      for (const Disc2d& q : b.upright->discs) {
        sum.upright->discs.push_back({p.center + q.center, p.radius + q.radius, kHullFacets});
      }
    }
  }
  return sum;
}

// The result is faceted if nothing else will do.
SolidShape hull_of_sum(const Piece& a, const Piece& b, const LeafMaker& make_leaf, bool& faceted) {
  const Sum sum = add(a, b);
  if (sum.balls) {
    if (std::optional<SolidShape> made = hull_of_balls(*sum.balls, make_leaf))
      return *std::move(made);
  }
  if (sum.upright) {
    if (std::optional<SolidShape> made = hull_of_upright(*sum.upright, make_leaf))
      return *std::move(made);
  }
  if (a.points.size() * b.points.size() > kMaxHullPoints) {
    throw ScadUnsupported{"its sum has too many points"};
  }
  std::vector<Vec3d> points;
  for (const Vec3d& p : a.points) {
    for (const Vec3d& q : b.points) points.push_back(p + q);
  }
  faceted = true;
  return hull_of_facets(points, make_leaf);
}

}  // namespace

SolidShape CsgEvaluator::hull(const ScadNode& node, const CsgPlace& place) {
  CsgPlace local = place;
  local.solid = {};
  const SolidShape content = combine(CsgOperation::unite, solids(node, local));
  std::vector<const CsgLeaf*> leaves;
  collect_leaves(content, leaves);
  if (leaves.empty()) return {};
  LeafMaker make_leaf = maker(node, place);
  const Mat3d frame = common_frame(leaves);
  make_leaf.place.linear = make_leaf.place.linear * frame;
  const std::vector<Piece> pieces = make_pieces(leaves, frame);
  if (any_round(pieces)) {
    if (const auto upright = joint_upright(pieces)) {
      if (auto made = hull_of_upright(*upright, make_leaf)) return *std::move(made);
    }
    std::vector<Ball> balls;
    bool all_balls = true;
    for (const Piece& piece : pieces) {
      all_balls &= piece.balls.has_value();
      if (all_balls) balls.insert(balls.end(), piece.balls->begin(), piece.balls->end());
    }
    if (all_balls) {
      if (auto made = hull_of_balls(std::move(balls), make_leaf)) return *std::move(made);
    }
    note(node,
         fmt::format("of unlike round things is cut into facets, {} to a circle", kHullFacets));
  }
  std::vector<Vec3d> points;
  for (const Piece& piece : pieces)
    points.insert(points.end(), piece.points.begin(), piece.points.end());
  return hull_of_facets(points, make_leaf);
}

SolidShape CsgEvaluator::minkowski(const ScadNode& node, const CsgPlace& place) {
  CsgPlace local = place;
  local.solid = {};
  Solids operands = solids(node, local);
  std::erase_if(operands, [](const SolidShape& shape) { return shape.is_empty(); });
  if (operands.empty()) return {};
  const LeafMaker outer = maker(node, place);
  if (!keeps_volume(outer.place.linear)) return {};
  SolidShape total = std::move(operands[0]);
  for (std::size_t i = 1; i < operands.size(); ++i) {
    std::vector<const CsgLeaf*> left, right;
    collect_leaves(total, left);
    collect_leaves(operands[i], right);
    std::vector<const CsgLeaf*> all = left;
    all.insert(all.end(), right.begin(), right.end());
    const Mat3d frame = common_frame(all);
    const std::vector<Piece> a = make_pieces(left, frame), b = make_pieces(right, frame);
    if (a.size() * b.size() > kMaxPairs) throw ScadUnsupported{"it adds too many parts"};
    const LeafMaker make_leaf{{frame, {}}, outer.material, outer.has_color};
    Solids sums;
    bool faceted = false;
    for (const Piece& p : a) {
      for (const Piece& q : b) {
        if (!p.is_convex || !q.is_convex) throw ScadUnsupported{"it adds to what isn't convex"};
        sums.push_back(hull_of_sum(p, q, make_leaf, faceted));
      }
    }
    if (faceted) {
      note(node,
           fmt::format("of unlike round things is cut into facets, {} to a circle", kHullFacets));
    }
    total = combine(CsgOperation::unite, std::move(sums));
  }
  transform(total, place.solid);
  return total;
}

// ------------------------------------------------------------------------------------------------ in the plane

namespace {

// Convex parts as hulls of discs; an outline that isn't convex has a hull all the same.
struct FlatPiece {
  bool is_convex = true;
  std::vector<Disc2d> discs;
};

void collect_pieces(const FlatShape& shape, std::vector<FlatPiece>& pieces) {
  if (!shape.leaf) {
    if (!shape.children.empty() && shape.operation != CsgOperation::unite) {
      throw ScadUnsupported{"a difference or intersection in it has no simple outline"};
    }
    for (const FlatShape& child : shape.children) collect_pieces(child, pieces);
    return;
  }
  FlatPiece& piece = pieces.emplace_back();
  CsgRegion region;
  if (const auto* disc = std::get_if<FlatDisc>(&*shape.leaf)) {
    if (const auto radius = round_radius(*disc)) {
      piece.discs.push_back({disc->center, *radius, disc->facets});
      return;
    }
    FlatDisc fine = *disc;
    fine.facets = kHullFacets;
    region = facets_of(fine);
  } else {
    region = std::get<CsgRegion>(*shape.leaf);
  }
  piece.is_convex = is_convex(region);
  for (const Outline& outline : region.outlines) {
    for (const Vec2d& p : outline) piece.discs.push_back({p, 0, 0});
  }
}

FlatShape hull_or_throw(std::vector<Disc2d> discs) {
  std::optional<FlatShape> hull = hull_of_discs(std::move(discs));
  if (!hull) throw ScadUnsupported{"it has too many circles"};
  return *std::move(hull);
}

// The outline itself, a strip along each edge and a disc about each corner.
FlatShape grown(const CsgRegion& region, double radius, int facets) {
  std::vector<FlatShape> parts{make_flat(region)};
  std::size_t edges = 0;
  for (const Outline& outline : region.outlines) edges += outline.size();
  if (edges > kMaxOffsetEdges) throw ScadUnsupported{"its outline has many edges"};
  for (const Outline& outline : region.outlines) {
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const Vec2d a = outline[i], b = outline[(i + 1) % outline.size()];
      parts.push_back(hull_or_throw({{a, radius, facets}, {b, radius, facets}}));
    }
  }
  return combine(CsgOperation::unite, std::move(parts));
}

}  // namespace

FlatShape CsgEvaluator::flat_hull(const ScadNode& node, const Affine2d& m) {
  std::vector<FlatPiece> pieces;
  collect_pieces(flat_union(node), pieces);
  std::vector<Disc2d> discs;
  for (const FlatPiece& piece : pieces)
    discs.insert(discs.end(), piece.discs.begin(), piece.discs.end());
  if (discs.empty()) return {};
  FlatShape shape = hull_or_throw(std::move(discs));
  transform(shape, m);
  return shape;
}

FlatShape CsgEvaluator::flat_minkowski(const ScadNode& node, const Affine2d& m) {
  Flats operands = flats(node, {});
  std::erase_if(operands, [](const FlatShape& shape) { return shape.is_empty(); });
  if (operands.empty()) return {};
  FlatShape total = std::move(operands[0]);
  for (std::size_t i = 1; i < operands.size(); ++i) {
    std::vector<FlatPiece> a, b;
    collect_pieces(total, a);
    collect_pieces(operands[i], b);
    if (a.size() * b.size() > kMaxPairs) throw ScadUnsupported{"it adds too many parts"};
    Flats sums;
    for (const FlatPiece& p : a) {
      for (const FlatPiece& q : b) {
        if (!p.is_convex || !q.is_convex) throw ScadUnsupported{"it adds to what isn't convex"};
        if (p.discs.size() * q.discs.size() > kMaxHullPoints) {
          throw ScadUnsupported{"its sum has too many points"};
        }
        std::vector<Disc2d> sum;
        for (const Disc2d& s : p.discs) {
          for (const Disc2d& t : q.discs) {
            sum.push_back({s.center + t.center, s.radius + t.radius, std::max(s.facets, t.facets)});
          }
        }
        sums.push_back(hull_or_throw(std::move(sum)));
      }
    }
    total = combine(CsgOperation::unite, std::move(sums));
  }
  transform(total, m);
  return total;
}

// Growing by a radius is the sum with a disc, of each part for itself. All else takes more than this.
FlatShape CsgEvaluator::offset(const ScadNode& node, const Affine2d& m) {
  const ScadArguments reader = arguments(node);
  const double radius = reader.number("r", 0);
  if (reader.find("delta") != nullptr || !(radius >= 0) || !std::isfinite(radius)) {
    throw ScadUnsupported{"only growing by r is exact"};
  }
  FlatShape content = flat_union(node);
  const FacetSettings settings = facets(reader);
  if (keeps_facets(settings)) throw ScadUnsupported{"it has facets"};
  const int facets = facet_count(settings, radius);
  if (radius > 0) {
    Flats parts;
    const auto grow = [&](const FlatShape& leaf) {
      std::vector<FlatPiece> pieces;
      collect_pieces(leaf, pieces);
      const auto* region = std::get_if<CsgRegion>(&*leaf.leaf);
      if (region != nullptr && !pieces[0].is_convex) {
        parts.push_back(grown(*region, radius, facets));
        return;
      }
      for (Disc2d& disc : pieces[0].discs) disc.radius += radius, disc.facets = facets;
      parts.push_back(hull_or_throw(std::move(pieces[0].discs)));
    };
    std::vector<FlatPiece> known;
    collect_pieces(content, known);  // refuses differences
    const auto walk = [&](const auto& self, const FlatShape& shape) -> void {
      if (shape.leaf) grow(shape);
      for (const FlatShape& child : shape.children) self(self, child);
    };
    walk(walk, content);
    content = combine(CsgOperation::unite, std::move(parts));
  }
  transform(content, m);
  return content;
}

}  // namespace arris
