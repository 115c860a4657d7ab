#include "render/void_neighbors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>
#include <tuple>
#include <utility>

#include "base/parallel_for.h"
#include "csg/csg_cells.h"

namespace arris {
namespace {

// Solids that touch don't reach into each other; relative to the smaller one's size.
constexpr double kTouching = 1e-4;
// Solids of more vertices are taken for their box.
constexpr std::size_t kMaxVertices = 128;
// Below this sine of half the dihedral angle, a void reaches so far that everything is taken to be in it.
constexpr double kThinEdge = 0.05;

// A shell of a rounded geometry, or all of another one; of a CSG solid its box.
struct Body {
  std::uint32_t geometry = 0;
  std::uint32_t solid = kNone;  // kNone: not rounded
  Vec3d low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};
  std::vector<Vec3d> points;  // whose hull holds it; in world space
  // For rounded ones: world units to one of the rounding's, and kVoidMargin of the size in world units.
  double scale = 1, margin = 0;

  void include(Vec3d p) {
    low = min(low, p);
    high = max(high, p);
  }
  [[nodiscard]] double size() const { return length(high - low); }
};

std::array<Vec3d, 8> corners_of(const Body& body) {
  std::array<Vec3d, 8> corners;
  for (std::size_t i = 0; i < 8; ++i) {
    corners[i] = {(i & 1U) != 0 ? body.high.x : body.low.x,
                  (i & 2U) != 0 ? body.high.y : body.low.y,
                  (i & 4U) != 0 ? body.high.z : body.low.z};
  }
  return corners;
}

// By how much all points lie beyond the plane.
double clearance(std::span<const Vec3d> points, Vec3d normal, double d) {
  double least = INFINITY;
  for (const Vec3d& p : points) least = std::min(least, dot(normal, p) - d);
  return least;
}

// How far something is from a void, at least: below 0 it may reach into it.
VoidNeighbors neighbors_at(double distance, double touching, double margin) {
  if (distance >= margin) return VoidNeighbors::none;
  return distance >= -touching ? VoidNeighbors::touching : VoidNeighbors::inside;
}

class NeighborFinder {
 public:
  NeighborFinder(const SceneGeometry& geometry, SceneRounding& rounding,
                 const SceneRounding* before)
      : geometry_(geometry), out_(rounding) {
    out_.neighbors.resize(out_.geometries.size());
    out_.points.resize(out_.geometries.size());
    out_.near.resize(out_.geometries.size());
    if (before != nullptr && !before->points.empty()) before_ = before;
  }

  void find(int threads) {
    for (std::uint32_t i = 0; i < out_.geometries.size(); ++i) collect_bodies(i);
    const std::vector<std::vector<std::uint32_t>> near = find_pairs();
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      for (const std::uint32_t j : near[i]) {
        out_.near[bodies_[i].geometry].push_back(bodies_[j].geometry);
      }
    }
    const std::vector<bool> stays = find_unchanged();
    for (const Body& body : bodies_) make_room(body);
    for (std::size_t i = 0; i < stays.size(); ++i) {
      if (stays[i]) out_.neighbors[i] = before_->neighbors[i];
    }
    parallel_for(bodies_.size(), {.grain = 16, .threads = threads}, [&](std::size_t i) {
      if (stays[bodies_[i].geometry]) return;
      for (const std::uint32_t j : near[i]) look(bodies_[i], bodies_[j]);
    });
    for (std::size_t i = 0; i < out_.geometries.size(); ++i) {
      const std::vector<VoidNeighbors>& marks = out_.neighbors[i];
      const auto is_marked = [](VoidNeighbors n) { return n != VoidNeighbors::none; };
      if (std::ranges::any_of(marks, is_marked)) out_.geometries[i].neighbors = marks.data();
    }
  }

 private:
  // Geometries that stay where they were with their roundings, and whose neighbours do.
  [[nodiscard]] std::vector<bool> find_unchanged() const {
    std::vector<bool> unchanged(out_.geometries.size(), false);
    if (before_ == nullptr) return unchanged;
    const auto stays = [&](std::uint32_t i) {
      return out_.sources[i].rounding == before_->sources[i].rounding &&
             out_.sources[i].place == before_->sources[i].place;
    };
    for (std::uint32_t i = 0; i < unchanged.size(); ++i) {
      unchanged[i] = stays(i) && std::ranges::all_of(out_.near[i], stays) &&
                     std::ranges::all_of(before_->near[i], stays);
    }
    return unchanged;
  }

  // The points of a geometry's solids are the same wherever it is. Solids of many are taken for their box.
  [[nodiscard]] std::shared_ptr<const SolidPoints> find_points(std::uint32_t geometry) {
    const Rounding* rounding = out_.geometries[geometry].rounding;
    if (before_ != nullptr && before_->sources[geometry].rounding.get() == rounding) {
      return before_->points[geometry];
    }
    const GeometryRecord& record = geometry_.embree.records()[geometry];
    std::shared_ptr<const SolidPoints>& shared = shared_[{record.positions, rounding}];
    if (!shared) shared = make_points(record, rounding);
    return shared;
  }

  [[nodiscard]] std::shared_ptr<const SolidPoints> make_points(const GeometryRecord& record,
                                                               const Rounding* rounding) {
    SolidPoints points(rounding != nullptr ? rounding->data().solids.size() : 1);
    std::vector<Body> boxes(points.size());
    seen_.assign(geometry_.scene.meshes[record.mesh.index].positions.size(), kNone);
    for (std::uint32_t t = 0; t < record.triangle_count; ++t) {
      const std::uint32_t solid = rounding != nullptr ? rounding->solid_of(t) : 0;
      if (solid == kNone) continue;
      for (const std::uint32_t vertex : record.triangles[t]) {
        if (seen_[vertex] == solid) continue;
        seen_[vertex] = solid;
        const Vec3d p(record.positions[vertex]);
        boxes[solid].include(p);
        if (points[solid].size() <= kMaxVertices) points[solid].push_back(p);
      }
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (points[i].size() <= kMaxVertices) continue;
      const auto corners = corners_of(boxes[i]);
      points[i].assign(corners.begin(), corners.end());
    }
    return std::make_shared<const SolidPoints>(std::move(points));
  }

  void collect_bodies(std::uint32_t geometry) {
    const GeometryRecord& record = geometry_.embree.records()[geometry];
    if (record.triangles == nullptr) return collect_csg(geometry);
    const Rounding* rounding = out_.geometries[geometry].rounding;
    out_.points[geometry] = find_points(geometry);
    std::uint32_t solid = 0;
    for (const std::vector<Vec3d>& points : *out_.points[geometry]) {
      Body& body = bodies_.emplace_back();
      body.geometry = geometry;
      for (const Vec3d& p : points) {
        body.points.push_back(
            record.instanced
                ? Vec3d(Vec3f(transform_point(
                      geometry_.scene.objects[record.object.index].world_from_object, p)))
                : p);
        body.include(body.points.back());
      }
      if (rounding == nullptr) continue;
      const RoundingFrame* frame = out_.geometries[geometry].frame;
      if (frame != nullptr) body.scale = 1 / length(frame->rounding_from_world.linear.x);
      body.margin = kVoidMargin * rounding->data().solids[solid].size * body.scale;
      body.solid = solid++;
    }
  }

  // Its box in its own space, as the world holds it.
  void collect_csg(std::uint32_t geometry) {
    const CsgObject& csg = *geometry_.csg.by_record[geometry];
    const Box3d& box = csg.cells->solid().bounds();
    if (box.is_empty()) return;
    Body& body = bodies_.emplace_back();
    body.geometry = geometry;
    const Affine3d& place = geometry_.scene.objects[csg.object.index].world_from_object;
    for (const Vec3d& corner : corners_of(box)) {
      body.points.push_back(transform_point(place, corner));
      body.include(body.points.back());
    }
  }

  // For every rounded body those whose boxes come near its own.
  [[nodiscard]] std::vector<std::vector<std::uint32_t>> find_pairs() {
    const int axis = longest_axis();
    std::ranges::sort(bodies_, [axis](const Body& a, const Body& b) {
      return std::tuple(a.low[axis], a.geometry, a.solid) <
             std::tuple(b.low[axis], b.geometry, b.solid);
    });
    double widest = 0;
    for (const Body& body : bodies_) widest = std::max(widest, body.margin);
    std::vector<std::vector<std::uint32_t>> near(bodies_.size());
    for (std::uint32_t i = 0; i < bodies_.size(); ++i) {
      const Body& a = bodies_[i];
      for (std::uint32_t j = i + 1; j < bodies_.size(); ++j) {
        const Body& b = bodies_[j];
        if (b.low[axis] > a.high[axis] + widest) break;
        if (a.solid != kNone && box_gap(a, b) < a.margin) near[i].push_back(j);
        if (b.solid != kNone && box_gap(b, a) < b.margin) near[j].push_back(i);
      }
    }
    return near;
  }

  // Along which the bodies spread most.
  [[nodiscard]] int longest_axis() const {
    Vec3d low(INFINITY), high(-INFINITY);
    for (const Body& body : bodies_) {
      low = min(low, body.low);
      high = max(high, body.low);
    }
    const Vec3d spread = high - low;
    if (spread.z > spread.x && spread.z > spread.y) return 2;
    return spread.y > spread.x ? 1 : 0;
  }

  void make_room(const Body& body) {
    if (body.solid == kNone) return;
    const Rounding::Data& data = out_.geometries[body.geometry].rounding->data();
    out_.neighbors[body.geometry].resize(data.arcs.size() + data.solids.size());
  }

  // By how much a plane across an axis parts the boxes; below 0 they overlap.
  template <class Box>
  [[nodiscard]] static double box_gap(const Box& a, const Body& b) {
    double gap = -INFINITY;
    for (int axis = 0; axis < 3; ++axis) {
      gap = std::max({gap, b.low[axis] - a.high[axis], a.low[axis] - b.high[axis]});
    }
    return gap;
  }

  [[nodiscard]] std::span<const Face> faces_of(const Body& body) const {
    if (body.solid == kNone || out_.geometries[body.geometry].frame != nullptr) return {};
    const Rounding::Data& data = out_.geometries[body.geometry].rounding->data();
    const Solid& solid = data.solids[body.solid];
    if (!solid.convex || !solid.closed) return {};
    return std::span(data.faces).subspan(solid.first_face, solid.face_count);
  }

  [[nodiscard]] Vec3d center_of(const Body& body) const {
    return out_.geometries[body.geometry].rounding->data().solids[body.solid].center;
  }

  // By how much a face of the convex body `by` parts all of the points from it; no more than `enough` is looked for.
  [[nodiscard]] double parted(const Body& by, std::span<const Vec3d> points, double enough) const {
    double most = -INFINITY;
    for (const Face& face : faces_of(by)) {
      const Vec3d n(face.normal);
      most = std::max(most, clearance(points, n, face.d + dot(n, center_of(by))));
      if (most >= enough) break;
    }
    return most;
  }

  // Marks the voids of a's solid that b comes near.
  void look(const Body& a, const Body& b) {
    const RoundedGeometry& g = out_.geometries[a.geometry];
    const Rounding::Data& data = g.rounding->data();
    const Solid& solid = data.solids[a.solid];
    if (parted(a, b.points, a.margin) >= a.margin || parted(b, a.points, a.margin) >= a.margin) {
      return;
    }
    std::vector<VoidNeighbors>& marks = out_.neighbors[a.geometry];
    VoidNeighbors& of_solid = marks[data.arcs.size() + a.solid];
    const std::vector<Vec3d> points = local_points(g, b, solid.center);
    const double touching = kTouching * std::min(a.size(), b.size());
    for (std::uint32_t i = solid.first_arc; i < solid.first_arc + solid.arc_count; ++i) {
      if (data.arcs[i].is_stub()) continue;
      const auto [beside, anywhere] = distances(g, data.arcs[i], b, points);
      marks[i] = std::max(marks[i], neighbors_at(beside * a.scale, touching, a.margin));
      of_solid = std::max(of_solid, neighbors_at(anywhere * a.scale, touching, a.margin));
    }
  }

  // Relative to the centre of a solid of g.
  [[nodiscard]] static std::vector<Vec3d> local_points(const RoundedGeometry& g, const Body& body,
                                                       Vec3d center) {
    std::vector<Vec3d> points;
    points.reserve(body.points.size());
    for (const Vec3d& p : body.points) {
      points.push_back((g.frame == nullptr ? p : transform_point(g.frame->rounding_from_world, p)) -
                       center);
    }
    return points;
  }

  struct Distances {
    double beside = -INFINITY;    // from the void between the arc's ends
    double anywhere = -INFINITY;  // from that and the corners
  };

  // Lower bounds on the distances of b, given by points, from an arc's void, in the rounding's units.
  // The void lies under the arc's two faces, beyond the plane through the touching lines, less than
  // r / sin α from the axis, and between the arc's ends, where corners reach no farther than that
  // either.
  [[nodiscard]] Distances distances(const RoundedGeometry& g, const Arc& arc, const Body& b,
                                    std::span<const Vec3d> points) const {
    const Rounding::Data& data = g.rounding->data();
    const double enough = kVoidMargin * data.solids[data.faces[arc.face_a].solid].size;
    const Vec3d na(data.faces[arc.face_a].normal), nb(data.faces[arc.face_b].normal);
    const double r = data.solids[data.faces[arc.face_a].solid].radius;
    const double length_of_arc = arc.line.length;
    const double sin_alpha = length(na + nb) / 2;
    if (sin_alpha < kThinEdge) return {-INFINITY, -INFINITY};
    const double reach = r / sin_alpha;
    const Vec3d p0(arc.line.p0), axis(arc.line.axis);
    const Vec3d sum = (na + nb) / (2 * sin_alpha);
    const Vec3d center = data.solids[data.faces[arc.face_a].solid].center;
    const Profile profile{na * r, nb * r, sum * reach};
    Distances out;
    if (g.frame == nullptr) {
      out.anywhere = part_void(
          b,
          prism(profile, center + p0 - axis * reach, center + p0 + axis * (length_of_arc + reach)),
          enough);
      if (out.anywhere >= enough) return {out.anywhere, out.anywhere};
      out.beside =
          part_void(b, prism(profile, center + p0, center + p0 + axis * length_of_arc), enough);
    }
    const double across =
        std::max({clearance(points, na, dot(na, p0) + r), clearance(points, nb, dot(nb, p0) + r),
                  clearance(points, -sum, -dot(sum, p0 + na * r))});
    const double at = dot(axis, p0);
    const double behind = clearance(points, -axis, -at);
    const double ahead = clearance(points, axis, at + length_of_arc);
    return {std::max({out.beside, across, behind, ahead}),
            std::max({out.anywhere, across, behind - reach, ahead - reach})};
  }

  using Profile = std::array<Vec3d, 3>;  // touching lines and sharp edge, about the axis

  [[nodiscard]] static std::array<Vec3d, 6> prism(const Profile& profile, Vec3d end0, Vec3d end1) {
    return {end0 + profile[0], end0 + profile[1], end0 + profile[2],
            end1 + profile[0], end1 + profile[1], end1 + profile[2]};
  }

  // By how much a face of b, or of its box, parts the points from it; no more than `enough` is looked for.
  [[nodiscard]] double part_void(const Body& b, std::span<const Vec3d> points,
                                 double enough) const {
    struct {
      Vec3d low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};
    } box;
    for (const Vec3d& p : points) {
      box.low = min(box.low, p);
      box.high = max(box.high, p);
    }
    const double gap = box_gap(box, b);
    return gap >= enough ? gap : std::max(gap, parted(b, points, enough));
  }

  const SceneGeometry& geometry_;
  SceneRounding& out_;
  const SceneRounding* before_ = nullptr;
  std::vector<Body> bodies_;
  std::map<std::pair<const Vec3f*, const Rounding*>, std::shared_ptr<const SolidPoints>> shared_;
  std::vector<std::uint32_t>
      seen_;  // per vertex of one mesh: the last solid that it was counted for
};

}  // namespace

void find_void_neighbors(const SceneGeometry& geometry, SceneRounding& rounding, int threads,
                         const SceneRounding* before) {
  NeighborFinder(geometry, rounding, before).find(threads);
}

}  // namespace arris
