#include "rounding/creases.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace arris {
namespace {

// Pieces of curves shorter than this part of the radius are none.
constexpr double kShortest = 1e-7;

struct Face {
  std::vector<std::pair<Vec3d, Vec3d>> outline;
  Vec3d low{std::numeric_limits<double>::infinity()},
      high{-std::numeric_limits<double>::infinity()};
};

// Between two faces, with the directions in them that lead away from it.
struct ConcaveEdge {
  Vec3d p0, p1, direction;
  Vec3d inward0, inward1;
  std::uint32_t face0, face1, vertex0, vertex1;
};

struct Corner {
  Vec3d point;
  std::vector<Vec3d> directions;     // of its edges, outgoing
  std::vector<std::uint32_t> faces;  // around it
};

class CreaseFinder {
 public:
  CreaseFinder(const CreaseInput& input, std::uint32_t shell)
      : in_(input),
        shell_(shell),
        r_(input.radius),
        tolerance_(crease_tolerance(input.size, input.radius)) {
    collect();
  }

  std::optional<std::vector<CreaseCurve>> run() {
    for (const auto& [a, b] : convex_) {
      const std::size_t before = out_.size();
      add_face_face(a, b);
      if (out_.size() == before) return std::nullopt;
    }
    for (const auto& pair : pairs_of_faces()) {
      if (!convex_.contains(pair)) add_face_face(pair.first, pair.second);
    }
    for (const ConcaveEdge& edge : edges_) add_face_edges(edge);
    for (std::size_t i = 0; i < edges_.size(); ++i) add_edge_edges(i);
    for (const auto& [vertex, corner] : corners_) add_face_corners(corner);
    return std::move(out_);
  }

 private:
  struct Interval {
    double u0, u1;
  };
  struct Linear {
    Vec3d normal;
    double alpha;
  };

  [[nodiscard]] Vec3d local(std::uint32_t vertex) const {
    return Vec3d(in_.mesh.vertices[vertex]) - in_.center;
  }
  [[nodiscard]] const Plane& plane(std::uint32_t region) const {
    return in_.regions.planes[region];
  }

  void collect() {
    const Shell& shell = in_.mesh.shells[shell_];
    for (std::uint32_t i = 0; i < shell.triangle_count; ++i) {
      const std::uint32_t t = in_.mesh.triangles_by_shell[shell.first_triangle + i];
      const std::uint32_t region = in_.regions.region[t];
      if (region == kNone) continue;
      Face& face = faces_[region];
      for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
        const Vec3d p0 = local(in_.mesh.origin(h)), p1 = local(in_.mesh.target(h));
        face.low = min(face.low, p0);
        face.high = max(face.high, p0);
        const std::uint32_t twin = in_.mesh.twin[h];
        if (twin > kLastHalfEdge || in_.regions.region[twin / 3] == region) continue;
        face.outline.emplace_back(p0, p1);
        add_corner_edge(h, region);
        if (in_.kinds[h] == EdgeKind::concave && h < twin) add_edge(h, twin);
        if (in_.kinds[h] == EdgeKind::convex) {
          convex_.insert(std::minmax(region, in_.regions.region[twin / 3]));
        }
      }
    }
    // Only where a ball can touch the corner itself.
    std::erase_if(corners_, [&](const auto& entry) { return !concave_.contains(entry.first); });
  }

  void add_corner_edge(std::uint32_t h, std::uint32_t region) {
    const std::uint32_t from = in_.mesh.origin(h), to = in_.mesh.target(h);
    const Vec3d p = local(from), q = local(to);
    Corner& first = corners_[from];
    first.point = p;
    first.directions.push_back(normalize(q - p));
    first.faces.push_back(region);
    Corner& last = corners_[to];
    last.point = q;
    last.directions.push_back(normalize(p - q));
    last.faces.push_back(region);
  }

  void add_edge(std::uint32_t h, std::uint32_t twin) {
    ConcaveEdge edge;
    edge.vertex0 = in_.mesh.origin(h);
    edge.vertex1 = in_.mesh.target(h);
    edge.p0 = local(edge.vertex0);
    edge.p1 = local(edge.vertex1);
    edge.direction = normalize(edge.p1 - edge.p0);
    edge.face0 = in_.regions.region[h / 3];
    edge.face1 = in_.regions.region[twin / 3];
    // A face lies to the left of its half-edge.
    edge.inward0 = cross(plane(edge.face0).normal, edge.direction);
    edge.inward1 = cross(edge.direction, plane(edge.face1).normal);
    concave_.insert(edge.vertex0);
    concave_.insert(edge.vertex1);
    edges_.push_back(edge);
  }

  template <class Visit>
  void for_faces_near(Vec3d low, Vec3d high, const Visit& visit) const {
    std::set<std::uint32_t> near;
    const Vec3d reach(2 * (r_ + tolerance_));
    in_.surface.for_each_near(low - reach, high + reach,
                              [&](const SurfaceTriangle& t) { near.insert(t.region); });
    for (const std::uint32_t region : near) visit(region);
  }

  [[nodiscard]] std::set<std::pair<std::uint32_t, std::uint32_t>> pairs_of_faces() const {
    std::set<std::pair<std::uint32_t, std::uint32_t>> pairs;
    for (const SurfaceTriangle& t : in_.surface.triangles()) {
      for_faces_near(min(t.p0, min(t.p1, t.p2)), max(t.p0, max(t.p1, t.p2)),
                     [&](std::uint32_t other) {
                       if (t.region < other) pairs.emplace(t.region, other);
                     });
    }
    return pairs;
  }

  void add_face_face(std::uint32_t a, std::uint32_t b) {
    const Vec3d low = max(faces_.at(a).low, faces_.at(b).low) - Vec3d(2 * r_);
    const Vec3d high = min(faces_.at(a).high, faces_.at(b).high) + Vec3d(2 * r_);
    std::optional<CreaseCurve> line =
        face_face_crease(plane(a), plane(b), r_, (low + high) * 0.5, 2 * in_.size + 4 * r_);
    if (!line || !clip_to_box(*line, low, high)) return;
    std::vector<Linear> bounds;
    add_outline(a, bounds);
    add_outline(b, bounds);
    cut(*line, bounds, a, b);
  }

  void add_face_edges(const ConcaveEdge& edge) {
    for_faces_near(min(edge.p0, edge.p1), max(edge.p0, edge.p1), [&](std::uint32_t face) {
      if (face == edge.face0 || face == edge.face1) return;
      for (CreaseCurve& curve :
           face_edge_creases(plane(face), {edge.p0, edge.direction}, r_, 2 * in_.size + 4 * r_)) {
        std::vector<Linear> bounds;
        add_outline(face, bounds);
        add_edge_bounds(edge, bounds);
        cut(curve, bounds, face, kNone);
      }
    });
  }

  void add_edge_edges(std::size_t first) {
    const ConcaveEdge& e = edges_[first];
    for (std::size_t i = first + 1; i < edges_.size(); ++i) {
      const ConcaveEdge& f = edges_[i];
      const bool at0 = e.vertex0 == f.vertex0 || e.vertex0 == f.vertex1;
      const bool at1 = e.vertex1 == f.vertex0 || e.vertex1 == f.vertex1;
      if (!at0 && !at1) continue;
      for (CreaseCurve& curve :
           edge_edge_creases(at0 ? e.p0 : e.p1, e.direction, f.direction, r_)) {
        std::vector<Linear> bounds;
        add_edge_bounds(e, bounds);
        add_edge_bounds(f, bounds);
        cut(curve, bounds, kNone, kNone);
      }
    }
  }

  void add_face_corners(const Corner& corner) {
    for_faces_near(corner.point, corner.point, [&](std::uint32_t face) {
      if (std::ranges::count(corner.faces, face) > 0) return;
      std::optional<CreaseCurve> curve = face_corner_crease(plane(face), corner.point, r_);
      if (!curve) return;
      std::vector<Linear> bounds;
      add_outline(face, bounds);
      for (const Vec3d d : corner.directions) bounds.push_back({d, -dot(d, corner.point)});
      cut(*curve, bounds, face, kNone);
    });
  }

  // Where a point's foot on the face crosses the face's outline.
  void add_outline(std::uint32_t region, std::vector<Linear>& bounds) const {
    const Vec3d n = plane(region).normal;
    for (const auto& [p0, p1] : faces_.at(region).outline) {
      const Vec3d across = cross(n, p1 - p0);
      bounds.push_back({across, -dot(across, p0)});
    }
  }

  // Where a point's nearest point of the edge's line is no longer that of the surface.
  static void add_edge_bounds(const ConcaveEdge& edge, std::vector<Linear>& bounds) {
    bounds.push_back({edge.inward0, -dot(edge.inward0, edge.p0)});
    bounds.push_back({edge.inward1, -dot(edge.inward1, edge.p0)});
    bounds.push_back({edge.direction, -dot(edge.direction, edge.p0)});
    bounds.push_back({edge.direction, -dot(edge.direction, edge.p1)});
  }

  static bool clip_to_box(CreaseCurve& line, Vec3d low, Vec3d high) {
    for (int axis = 0; axis < 3; ++axis) {
      const double from = low[axis] - line.center[axis], to = high[axis] - line.center[axis];
      if (line.a[axis] == 0) {
        if (from > 0 || to < 0) return false;
        continue;
      }
      const double u0 = from / line.a[axis], u1 = to / line.a[axis];
      line.u0 = std::max(line.u0, std::min(u0, u1));
      line.u1 = std::min(line.u1, std::max(u0, u1));
    }
    return line.u0 < line.u1;
  }

  // Its pieces that lie on E become creases. bounds: where it may cease to belong to its features; face_a, face_b:
  // those of them that are faces.
  void cut(const CreaseCurve& curve, const std::vector<Linear>& bounds, std::uint32_t face_a,
           std::uint32_t face_b) {
    std::vector<double> at{curve.u0, curve.u1};
    for (const Linear& bound : bounds) add_crossings(curve, bound.normal, bound.alpha, at);
    std::ranges::sort(at);
    for (std::size_t i = 1; i < at.size(); ++i) {
      if (at[i] - at[i - 1] < shortest(curve)) continue;
      const Vec3d middle = curve.at(0.5 * (at[i - 1] + at[i]));
      if (!touches(middle, face_a) || !touches(middle, face_b)) continue;
      CreaseCurve piece = curve;
      piece.u0 = at[i - 1];
      piece.u1 = at[i];
      cut_reached(piece, face_a, face_b);
    }
  }

  // Whether the foot of a point on a face's offset lies on the face.
  [[nodiscard]] bool touches(Vec3d x, std::uint32_t region) const {
    if (region == kNone) return true;
    const double most = r_ + tolerance_;
    bool found = false;
    in_.surface.for_each_near(x - Vec3d(most), x + Vec3d(most), [&](const SurfaceTriangle& t) {
      if (found || t.region != region) return;
      found = length_squared(x - nearest_on_triangle(x, t)) <= most * most;
    });
    return found;
  }

  static double length_scale(const CreaseCurve& curve) {
    return curve.is_line ? 1 : std::max(length(curve.a), length(curve.b));
  }
  [[nodiscard]] double shortest(const CreaseCurve& curve) const {
    return kShortest * r_ / length_scale(curve);
  }

  // Without what lies nearer to any triangle than r.
  void cut_reached(const CreaseCurve& curve, std::uint32_t face_a, std::uint32_t face_b) {
    near_.clear();
    const auto [low, high] = box_of(curve);
    const Vec3d reach(r_ + tolerance_);
    in_.surface.for_each_near(low - reach, high + reach,
                              [&](const SurfaceTriangle& t) { near_.push_back(&t); });
    std::vector<double> at{curve.u0, curve.u1};
    for (const SurfaceTriangle* t : near_) {
      if (t->region != face_a && t->region != face_b) add_reaches(curve, *t, at);
    }
    std::ranges::sort(at);
    Interval open{0, 0};
    bool is_open = false;
    double from = at.front();
    for (std::size_t i = 1; i < at.size(); ++i) {
      if (at[i] - from < shortest(curve)) continue;
      const bool stays = is_on_erosion(curve.at(0.5 * (from + at[i])), face_a, face_b);
      if (stays && !is_open) open.u0 = from;
      if (stays) open.u1 = at[i];
      if (!stays && is_open) add(curve, open);
      is_open = stays;
      from = at[i];
    }
    if (is_open) add(curve, open);
  }

  void add(const CreaseCurve& curve, Interval part) {
    out_.push_back(curve);
    out_.back().u0 = part.u0;
    out_.back().u1 = part.u1;
  }

  [[nodiscard]] static std::pair<Vec3d, Vec3d> box_of(const CreaseCurve& curve) {
    if (curve.is_line) {
      const Vec3d p0 = curve.at(curve.u0), p1 = curve.at(curve.u1);
      return {min(p0, p1), max(p0, p1)};
    }
    // The points of an ellipse lie within this of a part's chord.
    const Vec3d p0 = curve.at(curve.u0), p1 = curve.at(curve.u1);
    const double angle = std::min(curve.u1 - curve.u0, 2 * kPi);
    const Vec3d bulge((1 - std::cos(0.5 * angle)) * std::hypot(length(curve.a), length(curve.b)));
    return {min(p0, p1) - bulge, max(p0, p1) + bulge};
  }

  // r from its features, and from nothing less.
  [[nodiscard]] bool is_on_erosion(Vec3d x, std::uint32_t face_a, std::uint32_t face_b) const {
    const double least = r_ - tolerance_, most = r_ + tolerance_;
    bool on_a = face_a == kNone, on_b = face_b == kNone, touches = false;
    for (const SurfaceTriangle* t : near_) {
      const double distance = length(x - nearest_on_triangle(x, *t));
      if (distance < least) return false;
      if (distance > most) continue;
      touches = true;
      on_a = on_a || t->region == face_a;
      on_b = on_b || t->region == face_b;
    }
    return touches && on_a && on_b;
  }

  // Where the curve comes within r of a triangle, or leaves it.
  void add_reaches(const CreaseCurve& curve, const SurfaceTriangle& t,
                   std::vector<double>& at) const {
    const auto above = [&](double u) {
      const Vec3d x = curve.at(u);
      return length(x - nearest_on_triangle(x, t)) - r_;
    };
    // Along a line the distance is convex: one minimum. Along an ellipse minima are looked for between samples.
    const int samples =
        curve.is_line ? 2 : std::max(4, int(std::ceil((curve.u1 - curve.u0) / radians(8))));
    const double step = (curve.u1 - curve.u0) / samples;
    std::vector<double> us, values;
    for (int i = 0; i <= samples; ++i) {
      us.push_back(curve.u0 + step * i);
      values.push_back(above(us.back()));
    }
    for (std::size_t i = 0; i < us.size(); ++i) {
      const bool is_least = (i == 0 || values[i] <= values[i - 1]) &&
                            (i + 1 == us.size() || values[i] <= values[i + 1]);
      if (!is_least || values[i] <= 0) continue;
      const double low = us[i == 0 ? 0 : i - 1], high = us[std::min(i + 1, us.size() - 1)];
      const double u = minimum(above, length_scale(curve), low, high);
      if (above(u) >= 0) continue;
      at.push_back(root(above, u, low));
      at.push_back(root(above, u, high));
    }
    for (std::size_t i = 0; i + 1 < us.size(); ++i) {
      if ((values[i] < 0) == (values[i + 1] < 0)) continue;
      const bool first = values[i] < 0;
      at.push_back(root(above, us[first ? i : i + 1], us[first ? i + 1 : i]));
    }
  }

  // By golden sections, until it is below 0 or can't come to be. speed: by which f changes at most.
  template <class Function>
  static double minimum(const Function& f, double speed, double low, double high) {
    constexpr double kGolden = 0.6180339887498949;
    double u = high - kGolden * (high - low), v = low + kGolden * (high - low);
    double fu = f(u), fv = f(v);
    for (int i = 0; i < 60 && low < high; ++i) {
      const double least = std::min(fu, fv);
      if (least < 0 || least > speed * (high - low)) break;
      if (fu < fv) {
        high = v;
        v = u;
        fv = fu;
        u = high - kGolden * (high - low);
        fu = f(u);
      } else {
        low = u;
        u = v;
        fu = fv;
        v = low + kGolden * (high - low);
        fv = f(v);
      }
    }
    return fu < fv ? u : v;
  }

  // Between a place where f < 0 and one where it may not be; the latter if it is not.
  template <class Function>
  static double root(const Function& f, double below, double above) {
    if (f(above) < 0) return above;
    for (int i = 0; i < 48; ++i) {
      const double middle = 0.5 * (below + above);
      (f(middle) < 0 ? below : above) = middle;
    }
    return above;
  }

  const CreaseInput& in_;
  std::uint32_t shell_;
  double r_, tolerance_;
  std::map<std::uint32_t, Face> faces_;
  std::set<std::pair<std::uint32_t, std::uint32_t>> convex_;  // faces that meet in a convex edge
  std::vector<ConcaveEdge> edges_;
  std::map<std::uint32_t, Corner> corners_;
  std::set<std::uint32_t> concave_;  // vertices at which a concave edge ends
  std::vector<const SurfaceTriangle*> near_;
  std::vector<CreaseCurve> out_;
};

}  // namespace

std::optional<std::vector<CreaseCurve>> find_creases(const CreaseInput& input,
                                                     std::uint32_t shell) {
  return CreaseFinder(input, shell).run();
}

}  // namespace arris
