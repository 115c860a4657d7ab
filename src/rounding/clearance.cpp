#include "rounding/clearance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

namespace arris {
namespace {

// After so many cuts have been blocked, relative to those in the tree, it is built again.
constexpr std::size_t kBlockedShare = 2;

// The part of the segment within the cut's planes, each moved by inset(plane).
template <class Inset>
std::optional<Segment> clip(Segment s, std::span<const CutPlane> planes, Inset&& inset) {
  double from = 0;
  double to = 1;
  const Vec3d along = s.p1 - s.p0;
  for (const CutPlane& plane : planes) {
    const std::optional<double> by = inset(plane);
    if (!by) continue;
    const double inside = plane.d - *by - dot(plane.normal, s.p0);
    const double approach = dot(plane.normal, along);
    if (approach > 0) {
      to = std::min(to, inside / approach);
    } else if (approach < 0) {
      from = std::max(from, inside / approach);
    } else if (inside < 0) {
      return std::nullopt;
    }
    if (!(from < to)) return std::nullopt;
  }
  return Segment{s.p0 + along * from, s.p0 + along * to};
}

bool has_face(const Cut& cut, std::uint32_t face) {
  return face != kNone &&
         std::ranges::any_of(cut.planes, [&](const CutPlane& plane) { return plane.face == face; });
}

bool is_end(const Cut& cut, std::uint32_t vertex) {
  return vertex == cut.ends[0] || vertex == cut.ends[1];
}

Box box_of(const Cut& cut, std::uint32_t item) {
  Box box{Vec3d(std::numeric_limits<double>::infinity()),
          Vec3d(-std::numeric_limits<double>::infinity()), item};
  for (const Segment& s : cut.outline) {
    box.low = min(box.low, min(s.p0, s.p1));
    box.high = max(box.high, max(s.p0, s.p1));
  }
  return box;
}

std::uint64_t key_of(const Cut& cut) {
  return 2 * std::uint64_t(cut.half_edge) + (cut.is_corner ? 1 : 0);
}

double distance(const Segment& s, Vec3d x) {
  const Vec3d along = s.p1 - s.p0;
  const double squared = length_squared(along);
  const double t = squared > 0 ? std::clamp(dot(x - s.p0, along) / squared, 0.0, 1.0) : 0.0;
  return length(x - s.p0 - along * t);
}

}  // namespace

Clearance::Clearance(const WeldedMesh& mesh, const FlatRegions& regions, std::uint32_t shell,
                     double radius)
    : mesh_(mesh), regions_(regions), shell_(mesh.shells[shell]), radius_(radius) {
  // Triangles lie in their planes, and ends of edges on them, no better than this.
  const double extent = max_component(max(shell_.bounds_max, -shell_.bounds_min));
  tolerance_ = 2 * (kPlaneTolerance * shell_.size() + 4 * 6e-8 * extent);
}

std::vector<std::uint32_t> Clearance::find_in_surface(std::span<const Cut> cuts) {
  return find_blocked(cuts, known_free_, &Clearance::meet_surface);
}

std::vector<std::uint32_t> Clearance::find_overlapping(std::span<const Cut> cuts) {
  return find_blocked(cuts, known_apart_, &Clearance::meet_each_other);
}

std::vector<std::uint32_t> Clearance::find_blocked(std::span<const Cut> cuts, Known& known,
                                                   Meet meet) {
  blocked_.assign(cuts.size(), false);
  std::vector<std::uint32_t> changed = changed_since(cuts, known.free);
  (this->*meet)(cuts, changed);
  std::vector<std::uint32_t> out;
  for (std::uint32_t i = 0; i < blocked_.size(); ++i) {
    if (blocked_[i]) out.push_back(i);
  }
  std::erase_if(changed, [&](std::uint32_t i) { return blocked_[i]; });
  known.found = std::move(changed);
  return out;
}

void Clearance::remember(std::span<const Cut> cuts) {
  for (Known* const known : {&known_free_, &known_apart_}) {
    for (const std::uint32_t i : known->found) {
      known->free.insert_or_assign(key_of(cuts[i]), cuts[i].planes);
    }
    known->found.clear();
  }
}

// The cuts that are not known as they are.
std::vector<std::uint32_t> Clearance::changed_since(std::span<const Cut> cuts,
                                                    const PlanesOfCuts& known) {
  std::vector<std::uint32_t> changed;
  for (std::uint32_t i = 0; i < cuts.size(); ++i) {
    const auto found = known.find(key_of(cuts[i]));
    if (found == known.end() || found->second != cuts[i].planes) changed.push_back(i);
  }
  return changed;
}

// Of the items that are not blocked yet.
BoxTree Clearance::make_tree(std::span<const Cut> cuts,
                             std::span<const std::uint32_t> items) const {
  std::vector<Box> boxes;
  boxes.reserve(items.size());
  for (const std::uint32_t i : items) {
    if (!blocked_[i]) boxes.push_back(box_of(cuts[i], i));
  }
  return BoxTree(std::move(boxes));
}

void Clearance::meet_surface(std::span<const Cut> cuts, std::span<const std::uint32_t> changed) {
  BoxTree tree = make_tree(cuts, changed);
  std::size_t left = changed.size();
  std::size_t blocked = 0;
  const Vec3d center = shell_.center();
  for (std::uint32_t i = 0; i < shell_.triangle_count && left > 0; ++i) {
    TriangleView t{};
    t.index = mesh_.triangles_by_shell[shell_.first_triangle + i];
    t.region = regions_.region[t.index];
    if (t.region == kNone) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      t.corners[k] = Vec3d(mesh_.vertices[mesh_.triangles[t.index][k]]) - center;
    }
    tree.for_each_near(min(min(t.corners[0], t.corners[1]), t.corners[2]),
                       max(max(t.corners[0], t.corners[1]), t.corners[2]), [&](std::uint32_t c) {
                         if (blocked_[c] || !is_blocked_by(cuts[c], t)) return;
                         blocked_[c] = true;
                         ++blocked;
                       });
    if (blocked * kBlockedShare <= left) continue;
    left -= blocked;
    blocked = 0;
    tree = make_tree(cuts, changed);
  }
}

bool Clearance::is_blocked_by(const Cut& cut, const TriangleView& triangle) {
  return has_face(cut, triangle.region) ? leaves_face(cut, triangle) : reaches_void(cut, triangle);
}

// Does an edge of the face lie between the cut's edge and where its cylinder or sphere touches the face?
bool Clearance::leaves_face(const Cut& cut, const TriangleView& triangle) const {
  for (std::uint32_t k = 0; k < 3; ++k) {
    const std::uint32_t h = 3 * triangle.index + k;
    const std::uint32_t twin = mesh_.twin[h];
    // Between two faces of the cut there is no line but its own edges.
    if (twin <= kLastHalfEdge && has_face(cut, regions_.region[twin / 3])) continue;
    // The plane of a mitre need not hold the corner: beyond it the other edge's cut goes on.
    if (std::ranges::any_of(cut.mitred, [&](std::uint32_t m) { return m == h || m == twin; })) {
      continue;
    }
    const auto part = clip({triangle.corners[k], triangle.corners[(k + 1) % 3]}, cut.planes,
                           [&](const CutPlane& plane) -> std::optional<double> {
                             if (plane.face == triangle.region) return std::nullopt;
                             return tolerance_ + plane.leeway;
                           });
    if (!part) continue;
    if (twin > kLastHalfEdge || regions_.region[twin / 3] == kNone) return true;
    // On the face, from where the cylinder or sphere touches it.
    const double reach = std::max(distance_to_axes(cut, part->p0), distance_to_axes(cut, part->p1));
    const double missing = std::sqrt(std::max(0.0, reach * reach - radius_ * radius_));
    const double turn = std::abs(turn_at(mesh_, regions_, h));
    const bool at_end = is_end(cut, mesh_.origin(h)) || is_end(cut, mesh_.target(h));
    const double depth = radius_ * (at_end ? kSmoothDepthAtEnd : kSmoothDepth);
    if (missing * std::sin(turn) > depth * std::max(0.0, std::cos(turn))) {
      return true;
    }
  }
  return false;
}

// Does any of the triangle lie within the cut, and farther than the radius from its axes?
bool Clearance::reaches_void(const Cut& cut, const TriangleView& triangle) {
  for (const CutPlane& plane : cut.planes) {
    const auto is_beyond = [&](Vec3d p) { return dot(plane.normal, p) > plane.d - tolerance_; };
    if (std::ranges::all_of(triangle.corners, is_beyond)) return false;
  }
  polygon_.assign(triangle.corners.begin(), triangle.corners.end());
  const Vec3d normal = regions_.planes[triangle.region].normal;
  const auto continues = [&](const CutPlane& plane) {
    return plane.face != kNone && dot(plane.normal, normal) > kSmoothCosine;
  };
  const bool is_smooth = std::ranges::any_of(cut.planes, continues);
  for (const CutPlane& plane : cut.planes) {
    double inset = is_smooth ? plane.leeway : 0.0;
    if (continues(plane)) inset = smooth_depth(cut, triangle.index);
    const double d = plane.d - std::max(tolerance_, inset);
    clipped_.clear();
    for (std::size_t i = 0; i < polygon_.size(); ++i) {
      const Vec3d p = polygon_[i];
      const Vec3d q = polygon_[(i + 1) % polygon_.size()];
      const double inside_p = d - dot(plane.normal, p);
      const double inside_q = d - dot(plane.normal, q);
      if (inside_p >= 0) clipped_.push_back(p);
      if ((inside_p >= 0) != (inside_q >= 0)) {
        clipped_.push_back(p + (q - p) * (inside_p / (inside_p - inside_q)));
      }
    }
    std::swap(polygon_, clipped_);
    if (polygon_.empty()) return false;
  }
  // The distance to what is left of a corner is convex: it is largest at the polygon's corners.
  return std::ranges::any_of(
      polygon_, [&](Vec3d p) { return distance_to_axes(cut, p) > radius_ + tolerance_; });
}

double Clearance::smooth_depth(const Cut& cut, std::uint32_t triangle) const {
  const bool at_end = std::ranges::any_of(mesh_.triangles[triangle],
                                          [&](std::uint32_t v) { return is_end(cut, v); });
  return radius_ * (at_end ? kSmoothDepthAtEnd : kSmoothDepth);
}

double Clearance::distance_to_axes(const Cut& cut, Vec3d x) const {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Segment& axis : cut.axes) nearest = std::min(nearest, distance(axis, x));
  return nearest;
}

void Clearance::meet_each_other(std::span<const Cut> cuts, std::span<const std::uint32_t> changed) {
  std::vector<std::uint32_t> all(cuts.size());
  std::iota(all.begin(), all.end(), 0U);
  const BoxTree tree = make_tree(cuts, all);
  for (const std::uint32_t i : changed) {
    const Box box = box_of(cuts[i], i);
    tree.for_each_near(box.low, box.high, [&](std::uint32_t j) {
      const auto& [a, b] = cuts[i].ends;
      const auto& [c, d] = cuts[j].ends;
      if (a == c || a == d || b == c || b == d) return;
      if (blocked_[i] && blocked_[j]) return;
      if (overlaps(cuts[i], cuts[j]) || overlaps(cuts[j], cuts[i])) {
        blocked_[i] = blocked_[j] = true;
      }
    });
  }
}

// Does an edge of `other` lie within the cut? Both lie under the faces that they share.
bool Clearance::overlaps(const Cut& cut, const Cut& other) {
  planes_.clear();
  for (const CutPlane& plane : cut.planes) {
    if (has_face(other, plane.face)) continue;
    const auto is_beyond = [&](const Segment& s) {
      const double d = plane.d - tolerance_;
      return dot(plane.normal, s.p0) > d && dot(plane.normal, s.p1) > d;
    };
    if (std::ranges::all_of(other.outline, is_beyond)) return false;
    planes_.push_back(plane);
  }
  const auto inset = [&](const CutPlane&) { return std::optional(tolerance_); };
  return std::ranges::any_of(other.outline,
                             [&](const Segment& s) { return clip(s, planes_, inset).has_value(); });
}

}  // namespace arris
