#include "rounding/creases.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

#include "base/parallel_collect.h"
#include "rounding/concave_features.h"
#include "rounding/crease_cutter.h"
#include "rounding/distant_creases.h"

namespace arris {
namespace {

// Relative to the solid's size: edges no longer than this may be pieces of a rim.
constexpr double kShortPiece = 0.05;
// Calls that one thread makes at a time.
constexpr std::size_t kTrianglesAtOnce = 512, kCurvesAtOnce = 64;

// A triangle moved inwards by r: where balls are that touch it.
struct Offset {
  std::array<Vec3d, 3> p;
  Vec3d normal;  // of its face
  Vec3d low, high;
  double beside;  // how far from it places may lie that count as over it
};

struct TrianglePair {
  FacePair faces;
  std::uint32_t a, b;  // triangles of these

  friend bool operator==(const TrianglePair&, const TrianglePair&) = default;
  friend bool operator<(const TrianglePair& p, const TrianglePair& q) {
    return std::tie(p.faces, p.a, p.b) < std::tie(q.faces, q.a, q.b);
  }
};

struct Interval {
  double u0, u1;
};

bool is_apart(Vec3d low_a, Vec3d high_a, Vec3d low_b, Vec3d high_b, double slack) {
  for (int axis = 0; axis < 3; ++axis) {
    if (low_a[axis] > high_b[axis] + slack || low_b[axis] > high_a[axis] + slack) return true;
  }
  return false;
}

ConcaveInput concave_input(const CreaseInput& in) {
  return {in.mesh, in.regions, in.kinds, in.shells, in.center};
}

class CreaseFinder {
 public:
  explicit CreaseFinder(const CreaseInput& input)
      : in_(input),
        r_(input.radius),
        tolerance_(crease_tolerance(input.size, input.radius)),
        slack_(1e-3 * tolerance_),
        offset_tree_(make_offsets()),
        features_(find_concave_features(concave_input(input))) {
    collect_convex();
  }

  FoundCreases run() {
    std::vector<TrianglePair> pairs = crossing_pairs();
    const auto within = std::stable_partition(
        pairs.begin(), pairs.end(),
        [&](const TrianglePair& p) { return !are_joined(p.faces.first, p.faces.second); });
    FoundCreases found{face_face_creases({pairs.begin(), within}), {}};
    std::vector<CreaseCurve>& out = found.curves;
    found.missing = pairs_without(out);
    collect_ended(out);
    pairs.erase(pairs.begin(), within);
    std::erase_if(pairs, [&](const TrianglePair& p) {
      return !is_ended(p.faces.first) && !is_ended(p.faces.second);
    });
    const auto append = [&](const std::vector<CreaseCurve>& more) {
      out.insert(out.end(), more.begin(), more.end());
    };
    append(face_face_creases(pairs));
    const DistantCreases distant(features_, in_.surface, r_, tolerance_, 2 * in_.size + 4 * r_,
                                 [&](std::span<const std::uint32_t> a,
                                     std::span<const std::uint32_t> b) { return are_inner(a, b); });
    append(parallel_collect<CreaseCurve>(features_.edges.size(), kCurvesAtOnce,
                                         [&](std::size_t i, auto& list) {
                                           add_face_edges(features_.edges[i], list);
                                           CreaseCutter cutter = make_cutter();
                                           distant.add_of_edge(std::uint32_t(i), cutter, list);
                                         }));
    append(parallel_collect<CreaseCurve>(features_.corners.size(), kCurvesAtOnce,
                                         [&](std::size_t i, auto& list) {
                                           add_edge_edges(features_.corners[i], list);
                                           add_face_corners(features_.corners[i], list);
                                           CreaseCutter cutter = make_cutter();
                                           distant.add_of_corner(std::uint32_t(i), cutter, list);
                                         }));
    for (CreaseCurve& curve : out) curve.r0 = curve.r1 = r_;
    return found;
  }

 private:
  [[nodiscard]] Vec3d local(std::uint32_t vertex) const {
    return Vec3d(in_.mesh.vertices[vertex]) - in_.center;
  }
  [[nodiscard]] Plane plane(std::uint32_t region) const {
    Plane plane = in_.regions.planes[region];
    const Vec3d center = in_.mesh.shells[in_.regions.shell[region]].center();
    plane.d += dot(plane.normal, center - in_.center);
    return plane;
  }
  [[nodiscard]] std::uint32_t region_of(std::uint32_t h) const { return in_.regions.region[h / 3]; }

  std::vector<Box> make_offsets() {
    std::vector<Box> boxes;
    offsets_.reserve(in_.surface.triangles().size());
    for (const SurfaceTriangle& t : in_.surface.triangles()) {
      const Vec3d normal = in_.regions.planes[t.region].normal;
      const Vec3d down = normal * r_;
      Offset o{{t.p0 - down, t.p1 - down, t.p2 - down}, normal, {}, {}, beside(t)};
      o.low = min(o.p[0], min(o.p[1], o.p[2]));
      o.high = max(o.p[0], max(o.p[1], o.p[2]));
      append_triangle_boxes(o.p, r_, std::uint32_t(offsets_.size()), boxes);
      offsets_.push_back(o);
    }
    return boxes;
  }

  // Over it is what is within the tolerance of all its sides' lines: at an acute corner that is farther from it.
  [[nodiscard]] double beside(const SurfaceTriangle& t) const {
    const double longest = std::max(
        {length_squared(t.p1 - t.p0), length_squared(t.p2 - t.p1), length_squared(t.p0 - t.p2)});
    const double area = 0.5 * length(cross(t.p1 - t.p0, t.p2 - t.p0));
    return tolerance_ * (3 + longest / area);
  }

  void collect_convex() {
    for_outlines(concave_input(in_), [&](std::uint32_t h, std::uint32_t twin) {
      if (h > twin || in_.kinds[h] != EdgeKind::convex) return;
      const double extent = length(local(in_.mesh.target(h)) - local(in_.mesh.origin(h)));
      convex_.push_back({std::minmax(region_of(h), region_of(twin)), extent});
    });
    std::ranges::sort(convex_);
  }

  // Faces whose convex edges have none, but for pieces of curved rims that are short enough to be rounded by their
  // neighbours.
  // creases: sorted by faces.
  [[nodiscard]] std::vector<FacePair> pairs_without(const std::vector<CreaseCurve>& creases) const {
    std::vector<FacePair> pairs;
    const double most = in_.surface.is_curved() ? std::min(r_, kShortPiece * in_.size) : 0;
    auto at = creases.begin();
    double missing = 0;
    for (std::size_t i = 0; i < convex_.size(); ++i) {
      const FacePair faces = convex_[i].first;
      if (i == 0 || faces != convex_[i - 1].first) missing = 0;
      while (at != creases.end() && FacePair(at->face_a, at->face_b) < faces) ++at;
      if (at != creases.end() && FacePair(at->face_a, at->face_b) == faces) continue;
      missing += convex_[i].second;
      if (missing > most && (pairs.empty() || pairs.back() != faces)) pairs.push_back(faces);
    }
    return pairs;
  }

  [[nodiscard]] CreaseCutter make_cutter() const { return {in_.surface, r_, tolerance_}; }

  // Two faces have a crease where the two are met by one ball: where triangles moved inwards cross.
  [[nodiscard]] std::vector<TrianglePair> crossing_pairs() const {
    std::vector<TrianglePair> pairs = parallel_collect<TrianglePair>(
        offsets_.size(), kTrianglesAtOnce,
        [&](std::size_t i, auto& list) { add_crossing(std::uint32_t(i), list); });
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    return pairs;
  }

  // pairs: sorted by faces.
  [[nodiscard]] std::vector<CreaseCurve> face_face_creases(
      std::span<const TrianglePair> pairs) const {
    if (pairs.empty()) return {};
    std::vector<std::size_t> begins;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      if (i == 0 || pairs[i].faces != pairs[i - 1].faces) begins.push_back(i);
    }
    begins.push_back(pairs.size());
    return parallel_collect<CreaseCurve>(
        begins.size() - 1, kCurvesAtOnce, [&](std::size_t k, auto& list) {
          add_face_face(pairs.subspan(begins[k], begins[k + 1] - begins[k]), list);
        });
  }

  // Whether they are one curved surface.
  [[nodiscard]] bool are_joined(std::uint32_t a, std::uint32_t b) const {
    return in_.surface.is_joined(a, b) || in_.surface.is_joined(b, a);
  }

  void collect_ended(const std::vector<CreaseCurve>& creases) {
    for (const CreaseCurve& c : creases) ended_.insert(ended_.end(), {c.face_a, c.face_b});
    std::ranges::sort(ended_);
    ended_.erase(std::unique(ended_.begin(), ended_.end()), ended_.end());
  }
  [[nodiscard]] bool is_ended(std::uint32_t face) const {
    return std::ranges::binary_search(ended_, face);
  }
  [[nodiscard]] bool is_any_ended(std::span<const std::uint32_t> faces) const {
    return std::ranges::any_of(faces, [&](std::uint32_t face) { return is_ended(face); });
  }
  // Whether features between these faces are of one curved surface, away from its ends.
  [[nodiscard]] bool are_inner(std::span<const std::uint32_t> a,
                               std::span<const std::uint32_t> b) const {
    if (is_any_ended(a) || is_any_ended(b)) return false;
    return std::ranges::any_of(a, [&](std::uint32_t face) {
      return std::ranges::any_of(
          b, [&](std::uint32_t other) { return face == other || are_joined(face, other); });
    });
  }
  // Creases between features of one curved surface matter only where its rounded edges are.
  [[nodiscard]] bool matters(std::uint32_t face, std::span<const std::uint32_t> others) const {
    return is_ended(face) ||
           std::ranges::none_of(others, [&](std::uint32_t o) { return are_joined(face, o); }) ||
           is_any_ended(others);
  }

  void add_crossing(std::uint32_t i, std::vector<TrianglePair>& pairs) const {
    const Offset& own = offsets_[i];
    const std::uint32_t face = in_.surface.triangles()[i].region;
    std::vector<Box> parts;
    append_triangle_boxes(own.p, r_, i, parts);
    for (const Box& part : parts) {
      const Vec3d low = part.low - Vec3d(slack_), high = part.high + Vec3d(slack_);
      offset_tree_.for_each_near(low, high, [&](std::uint32_t j) {
        const std::uint32_t other = in_.surface.triangles()[j].region;
        if (j <= i || other == face) return;
        const Offset& o = offsets_[j];
        if (is_apart(low, high, o.low, o.high, 0) || is_beside(own, o) || is_beside(o, own)) return;
        if (face < other) {
          pairs.push_back({{face, other}, i, j});
        } else {
          pairs.push_back({{other, face}, j, i});
        }
      });
    }
  }

  // Whether a triangle lies on one side of another's plane.
  [[nodiscard]] bool is_beside(const Offset& a, const Offset& b) const {
    const double h0 = dot(a.normal, b.p[0] - a.p[0]), h1 = dot(a.normal, b.p[1] - a.p[0]),
                 h2 = dot(a.normal, b.p[2] - a.p[0]);
    return std::min({h0, h1, h2}) > tolerance_ || std::max({h0, h1, h2}) < -tolerance_;
  }

  void add_face_face(std::span<const TrianglePair> pairs, std::vector<CreaseCurve>& out) const {
    const auto [a, b] = pairs.front().faces;
    const Offset& first = offsets_[pairs.front().a];
    const Offset& second = offsets_[pairs.front().b];
    const Vec3d near = (max(first.low, second.low) + min(first.high, second.high)) * 0.5;
    std::optional<CreaseCurve> line =
        face_face_crease(plane(a), plane(b), r_, near, 2 * in_.size + 4 * r_);
    if (!line) return;
    line->face_a = a;
    line->face_b = b;
    std::vector<Interval> parts;
    for (const TrianglePair& pair : pairs) {
      Interval part{line->u0, line->u1};
      clip(*line, offsets_[pair.a], part);
      clip(*line, offsets_[pair.b], part);
      if (part.u0 < part.u1) parts.push_back(part);
    }
    if (parts.empty()) return;
    std::ranges::sort(parts, {}, &Interval::u0);
    CreaseCutter cutter = make_cutter();
    Interval whole = parts.front();
    const auto take = [&] {
      CreaseCurve piece = *line;
      piece.u0 = whole.u0;
      piece.u1 = whole.u1;
      cutter.cut_reached(piece, out);
    };
    for (const Interval& part : parts) {
      if (part.u0 > whole.u1 + tolerance_) {
        take();
        whole = part;
      }
      whole.u1 = std::max(whole.u1, part.u1);
    }
    take();
  }

  // To where a line is over the triangle, or beside it by no more than the slack.
  void clip(const CreaseCurve& line, const Offset& triangle, Interval& part) const {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3d side = triangle.p[(k + 1) % 3] - triangle.p[k];
      const Vec3d across = cross(triangle.normal, side);
      const double at0 = dot(across, line.center - triangle.p[k]) + slack_ * length(side);
      const double speed = dot(across, line.a);
      if (speed > 0) {
        part.u0 = std::max(part.u0, -at0 / speed);
      } else if (speed < 0) {
        part.u1 = std::min(part.u1, -at0 / speed);
      } else if (at0 < 0) {
        part.u1 = part.u0;
      }
    }
  }

  // Visits the faces that have triangles whose offsets reach into a box, with these.
  template <class Visit>
  void for_faces_near(Vec3d low, Vec3d high, const Visit& visit) const {
    const Vec3d slack(slack_);
    std::vector<FacePair> near;  // a face, a triangle
    offset_tree_.for_each_near(low - slack, high + slack, [&](std::uint32_t i) {
      if (is_apart(low, high, offsets_[i].low, offsets_[i].high, slack_)) return;
      near.emplace_back(in_.surface.triangles()[i].region, i);
    });
    std::ranges::sort(near);
    near.erase(std::unique(near.begin(), near.end()), near.end());
    std::vector<std::uint32_t> triangles;
    for (std::size_t i = 0; i < near.size(); ++i) {
      triangles.push_back(near[i].second);
      if (i + 1 < near.size() && near[i + 1].first == near[i].first) continue;
      visit(near[i].first, triangles);
      triangles.clear();
    }
  }

  void add_face_edges(const ConcaveEdge& edge, std::vector<CreaseCurve>& out) const {
    CreaseCutter cutter = make_cutter();
    cutter.set_features({{{edge.p0, edge.p1}}}, {});
    const Box box = edge.box(r_);
    const std::array<CurveBound, 4> wedge = edge.bounds();
    for_faces_near(box.low, box.high, [&](std::uint32_t face, const auto& triangles) {
      if (face == edge.face0 || face == edge.face1 || !may_reach_into(wedge, triangles)) return;
      if (!matters(face, std::array{edge.face0, edge.face1})) return;
      for (CreaseCurve& curve :
           face_edge_creases(plane(face), {edge.p0, edge.direction}, r_, 2 * in_.size + 4 * r_)) {
        curve.face_a = face;
        std::vector<CurveBound> bounds(wedge.begin(), wedge.end());
        add_sides(triangles, bounds);
        cutter.cut(
            curve, bounds,
            [&](Vec3d x) {
              return edge.is_touched_from(x, tolerance_) && is_over_any(triangles, x);
            },
            out);
      }
    });
  }

  void add_edge_edges(const ConcaveCorner& corner, std::vector<CreaseCurve>& out) const {
    if (corner.is_smooth && !is_any_ended(corner.faces)) return;
    for (std::size_t i = 0; i < corner.edges.size(); ++i) {
      for (std::size_t k = i + 1; k < corner.edges.size(); ++k) {
        const ConcaveEdge& e = features_.edges[corner.edges[i]];
        const ConcaveEdge& f = features_.edges[corner.edges[k]];
        CreaseCutter cutter = make_cutter();
        cutter.set_features({{{e.p0, e.p1}, {f.p0, f.p1}}}, {});
        for (const CreaseCurve& curve :
             edge_edge_creases(corner.point, e.direction, f.direction, r_)) {
          cutter.cut(
              curve, bounds_of(e, f),
              [&](Vec3d x) {
                return e.is_touched_from(x, tolerance_) && f.is_touched_from(x, tolerance_);
              },
              out);
        }
      }
    }
  }

  void add_face_corners(const ConcaveCorner& corner, std::vector<CreaseCurve>& out) const {
    CreaseCutter cutter = make_cutter();
    const std::vector<CurveBound> cone = corner.bounds();
    for_faces_near(
        corner.point - Vec3d(r_), corner.point + Vec3d(r_),
        [&](std::uint32_t face, const auto& triangles) {
          if (!may_reach_into(cone, triangles)) return;
          if (std::ranges::count(corner.faces, face) > 0 || !matters(face, corner.faces)) return;
          std::optional<CreaseCurve> curve = face_corner_crease(plane(face), corner.point, r_);
          if (!curve) return;
          curve->face_a = face;
          std::vector<CurveBound> bounds = cone;
          add_sides(triangles, bounds);
          cutter.cut(
              *curve, bounds,
              [&](Vec3d x) {
                return corner.is_touched_from(x, tolerance_) && is_over_any(triangles, x);
              },
              out);
        });
  }

  // Whether a place over one of the triangles may lie beneath all of some planes.
  [[nodiscard]] bool may_reach_into(std::span<const CurveBound> planes,
                                    const std::vector<std::uint32_t>& triangles) const {
    return std::ranges::any_of(triangles, [&](std::uint32_t i) {
      const Offset& o = offsets_[i];
      const double least = o.beside + tolerance_;
      return std::none_of(planes.begin(), planes.end(), [&](const CurveBound& plane) {
        const auto height = [&](Vec3d p) { return plane.alpha + dot(plane.normal, p); };
        return std::min({height(o.p[0]), height(o.p[1]), height(o.p[2])}) > least;
      });
    });
  }

  // Where a point crosses the sides of a face's triangles.
  void add_sides(const std::vector<std::uint32_t>& triangles,
                 std::vector<CurveBound>& bounds) const {
    for (const std::uint32_t i : triangles) {
      const Offset& o = offsets_[i];
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3d across = cross(o.normal, o.p[(k + 1) % 3] - o.p[k]);
        bounds.push_back({across, -dot(across, o.p[k])});
      }
    }
  }

  [[nodiscard]] bool is_over_any(const std::vector<std::uint32_t>& triangles, Vec3d x) const {
    return std::ranges::any_of(triangles, [&](std::uint32_t i) {
      const Offset& o = offsets_[i];
      for (std::size_t k = 0; k < 3; ++k) {
        const Vec3d side = o.p[(k + 1) % 3] - o.p[k];
        if (dot(cross(o.normal, side), x - o.p[k]) < -tolerance_ * length(side)) return false;
      }
      return true;
    });
  }

  const CreaseInput& in_;
  double r_, tolerance_;
  double slack_;                 // by which what is computed may lie beside its features
  std::vector<Offset> offsets_;  // of the surface's triangles
  BoxTree offset_tree_;
  std::vector<std::pair<FacePair, double>> convex_;  // edges by their faces, with their lengths
  std::vector<std::uint32_t> ended_;  // faces with a crease that is not within one curved surface
  ConcaveFeatures features_;
};

}  // namespace

FoundCreases find_creases(const CreaseInput& input) {
  return CreaseFinder(input).run();
}

}  // namespace arris
