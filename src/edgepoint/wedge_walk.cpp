#include "edgepoint/wedge_walk.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>
#include <utility>

namespace arris {
namespace {

double size_of(Vec3d v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

Vec3d place(const HomogeneousPoint& p) {
  return p.xyz / p.w;
}

// A wedge in the coordinates of one receiver: for triangles in double, for boxes in float.
struct LocalForms {
  std::array<LinearForm, 4> object;  // plane, a, b, u
  // The same in the unit frame, scaled so that no value there is above 1.
  std::array<std::array<float, 4>, 3> direction, size;  // size: absolute
  std::array<float, 4> offset;
  double u_scale;
};

LocalForms local_forms(const EventWedge& w, const ShadowReceiver& receiver) {
  LocalForms out;
  const Affine3d& m = receiver.world_from_object;
  const Mat3d turned = transpose(m.linear);
  const UnitFrame& frame = receiver.faces->frame();
  const std::array<const LinearForm*, 4> forms{&w.plane, &w.a, &w.b, &w.u};
  for (std::size_t i = 0; i < 4; ++i) {
    const LinearForm form{turned * forms[i]->direction, forms[i]->at(m.translation)};
    out.object[i] = form;
    const Vec3d d = form.direction * frame.half_size;
    const double at_center = form.at(frame.center);
    const double scale = 1 / (std::abs(d.x) + std::abs(d.y) + std::abs(d.z) + std::abs(at_center));
    for (std::size_t k = 0; k < 3; ++k) {
      out.direction[k][i] = float(d[int(k)] * scale);
      out.size[k][i] = std::abs(out.direction[k][i]);
    }
    out.offset[i] = float(at_center * scale);
    out.u_scale = scale;
  }
  return out;
}

constexpr float kBoxMargin = 16.0F / (1 << 24);

// Nearest u (scaled) of four boxes; infinite where one does not meet the wedge.
std::array<float, 4> nearest_u(const LocalForms& forms, const FaceNode& node) {
  std::array<std::array<float, 4>, 4> middle, reach;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t box = 0; box < 4; ++box) {
      middle[i][box] = forms.direction[0][i] * node.middle[0][box] +
                       forms.direction[1][i] * node.middle[1][box] +
                       forms.direction[2][i] * node.middle[2][box] + forms.offset[i];
      reach[i][box] = forms.size[0][i] * node.reach[0][box] +
                      forms.size[1][i] * node.reach[1][box] +
                      forms.size[2][i] * node.reach[2][box] + kBoxMargin;
    }
  }
  std::array<float, 4> u;
  for (std::size_t box = 0; box < 4; ++box) {
    // All four at least zero where the wedge may be met.
    const float inside =
        std::min(std::min(reach[0][box] - middle[0][box], reach[0][box] + middle[0][box]),
                 std::min(reach[1][box] + middle[1][box], reach[2][box] + middle[2][box]));
    u[box] = inside >= 0 ? middle[3][box] - reach[3][box] : std::numeric_limits<float>::infinity();
  }
  return u;
}

// Where the plane meets the side of a triangle, and there which of it.
struct WedgePoint {
  double a, b, u;
  Vec2d place{};  // barycentric weights of the triangle's second and third corner
};

// Part t of the way from p to q.
WedgePoint between(const WedgePoint& p, const WedgePoint& q, double t) {
  return {p.a + (q.a - p.a) * t,
          p.b + (q.b - p.b) * t,
          p.u + (q.u - p.u) * t,
          {p.place.x + (q.place.x - p.place.x) * t, p.place.y + (q.place.y - p.place.y) * t}};
}

// Moves `from` to where `coordinate` is zero between both.
void clip_to(WedgePoint& from, const WedgePoint& to, double WedgePoint::*coordinate) {
  const double t = from.*coordinate / (from.*coordinate - to.*coordinate);
  from = between(from, to, t);
  from.*coordinate = 0;
}

bool clip_to_wedge(WedgePoint& p, WedgePoint& q) {
  for (double WedgePoint::*coordinate : {&WedgePoint::a, &WedgePoint::b}) {
    if (p.*coordinate < 0 && q.*coordinate < 0) return false;
    if (p.*coordinate < 0) {
      clip_to(p, q, coordinate);
    } else if (q.*coordinate < 0) {
      clip_to(q, p, coordinate);
    }
  }
  return true;
}

// The walk of one wedge down one receiver.
class Meeting {
 public:
  Meeting(const EventWedge& wedge, const ShadowEvent& event, const ShadowReceiver& receiver)
      : wedge_(wedge),
        event_(event),
        receiver_(receiver),
        forms_(local_forms(wedge, receiver)),
        mesh_(receiver.faces->mesh()) {
    const Affine3d object_from_world = inverse(receiver.world_from_object);
    bool inside = false;
    for (std::size_t k = 0; k < 2; ++k) {
      light_[k] = transform(object_from_world, event.light[k]);
      inside = inside || is_within_bounds(light_[k]);
    }
    one_sided_ = mesh_.closed && !inside;
    // Far above the rounding of a side, far below what matters.
    constexpr double kRounding = 1e-12;
    const Vec3d d = forms_.object[0].direction;
    const double size = std::max(size_of(mesh_.bounds_min), size_of(mesh_.bounds_max));
    surely_ = kRounding * (size * (std::abs(d.x) + std::abs(d.y) + std::abs(d.z)) +
                           std::abs(forms_.object[0].offset));
  }

  [[nodiscard]] const LocalForms& forms() const { return forms_; }
  // Whether the plane passes a triangle by; most of those looked at.
  [[nodiscard]] bool misses(const std::array<Vec3f, 3>& corners) const {
    const LinearForm& plane = forms_.object[0];
    const double a = plane.at(Vec3d(corners[0])), b = plane.at(Vec3d(corners[1]));
    const double c = plane.at(Vec3d(corners[2]));
    return std::min(std::min(a, b), c) > surely_ || std::max(std::max(a, b), c) < -surely_;
  }
  // Appends where the wedge meets the face, and what of it roundings have taken.
  void collect_segments(std::uint32_t face, std::vector<EventSegment>& out,
                        std::vector<EventSegment>& taken) const {
    if (receiver_.is_blocker && (face == event_.faces[0] || face == event_.faces[1])) return;
    const Triangle& t = mesh_.triangles[face];
    std::array<double, 3> side;
    for (std::size_t k = 0; k < 3; ++k) side[k] = side_of(t[k]);
    const bool front0 = side[0] >= 0, front1 = side[1] >= 0, front2 = side[2] >= 0;
    if (front0 == front1 && front1 == front2) return;
    // The corner that is alone on its side.
    const std::size_t k = front1 == front2 ? 0 : front0 == front2 ? 1 : 2;
    const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
    WedgePoint p = crossing(t, k, i, side), q = crossing(t, k, j, side);
    if (!clip_to_wedge(p, q) || is_hidden(face)) return;
    if (receiver_.voids != nullptr && !receiver_.voids->of(face).empty()) {
      split_at_voids(face, p, q, out, taken);
    } else if (const std::optional<EventSegment> found = segment_between(face, p, q)) {
      out.push_back(*found);
    }
  }

 private:
  [[nodiscard]] bool is_within_bounds(const HomogeneousPoint& p) const {
    if (p.w == 0) return false;
    const Vec3d x = place(p);
    for (int k = 0; k < 3; ++k) {
      if (x[k] < mesh_.bounds_min[k] || x[k] > mesh_.bounds_max[k]) return false;
    }
    return true;
  }
  [[nodiscard]] bool is_hidden(std::uint32_t face) const {
    return one_sided_ && !is_front(mesh_, face, light_[0]) && !is_front(mesh_, face, light_[1]);
  }
  // The beginning's own vertices lie in the plane, whatever rounding says.
  [[nodiscard]] bool is_end(std::uint32_t v, std::size_t end) const {
    return receiver_.is_blocker && v == event_.vertex[end];
  }
  [[nodiscard]] double side_of(std::uint32_t v) const {
    if (is_end(v, 0) || is_end(v, 1)) return 0;
    return forms_.object[0].at(Vec3d(mesh_.vertices[v]));
  }
  [[nodiscard]] WedgePoint coordinates(const Triangle& triangle, std::size_t corner) const {
    const std::uint32_t v = triangle[corner];
    const Vec2d place{corner == 1 ? 1.0 : 0.0, corner == 2 ? 1.0 : 0.0};
    const bool first = is_end(v, 0), second = is_end(v, 1);
    if (first && second) return {0, 0, 0, place};
    const double u = wedge_.parallel ? 0 : 1;
    if (first) return {1, 0, u, place};
    if (second) return {0, 1, u, place};
    const Vec3d p(mesh_.vertices[v]);
    return {forms_.object[1].at(p), forms_.object[2].at(p), forms_.object[3].at(p), place};
  }
  // Same for both triangles at the side: in the order of the vertices.
  [[nodiscard]] WedgePoint crossing(const Triangle& triangle, std::size_t v, std::size_t w,
                                    const std::array<double, 3>& side) const {
    if (triangle[w] < triangle[v]) std::swap(v, w);
    const double t = side[v] / (side[v] - side[w]);
    return between(coordinates(triangle, v), coordinates(triangle, w), t);
  }
  // Bands and distances are linear on the way from p to q. What is taken near the beginning is left out.
  void split_at_voids(std::uint32_t face, const WedgePoint& p, const WedgePoint& q,
                      std::vector<EventSegment>& out, std::vector<EventSegment>& taken) const {
    const std::span<const FaceVoids::Band> bands = receiver_.voids->of(face);
    std::vector<double> cuts{0, 1};
    const auto cut_at_zero = [&](double at_p, double at_q) {
      if ((at_p > 0) != (at_q > 0)) cuts.push_back(at_p / (at_p - at_q));
    };
    const auto depth = [](const FaceVoids::Band& band, const WedgePoint& w) {
      return band.c0 + band.cu * w.place.x + band.cv * w.place.y;
    };
    for (const FaceVoids::Band& band : bands) cut_at_zero(depth(band, p), depth(band, q));
    // Of a perspective wedge u is 1 at the beginning, and lengths are those of its rays.
    const double begin = wedge_.parallel ? 0 : 1;
    const double unit = wedge_.parallel ? 1 : std::min(length(wedge_.r[0]), length(wedge_.r[1]));
    const double reach = event_.void_depth / unit;
    for (const double end : {begin - reach, begin + reach}) {
      cut_at_zero(height_over(p, end), height_over(q, end));
    }
    std::ranges::sort(cuts);
    for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
      const WedgePoint middle = between(p, q, (cuts[i] + cuts[i + 1]) / 2);
      const bool is_taken = std::ranges::any_of(
          bands, [&](const FaceVoids::Band& band) { return depth(band, middle) > 0; });
      const bool is_near =
          height_over(middle, begin - reach) > 0 && height_over(middle, begin + reach) < 0;
      if (is_taken && is_near) continue;
      const std::optional<EventSegment> found =
          segment_between(face, between(p, q, cuts[i]), between(p, q, cuts[i + 1]));
      if (found) (is_taken ? taken : out).push_back(*found);
    }
  }
  // Along the ray: farther than u.
  [[nodiscard]] double height_over(const WedgePoint& w, double u) const {
    return wedge_.parallel ? w.u - u : w.a + w.b - u;
  }
  [[nodiscard]] std::optional<EventSegment> segment_between(std::uint32_t face, const WedgePoint& p,
                                                            const WedgePoint& q) const {
    EventSegment met{0, 0, 0, 0, receiver_.number, face};
    if (wedge_.parallel) {
      std::tie(met.s0, met.s1, met.k0, met.k1) = std::tuple(p.b, q.b, -p.u, -q.u);
      if (p.a == 0) met.s0 = 1;
      if (q.a == 0) met.s1 = 1;
    } else {
      const double up = p.a + p.b, uq = q.a + q.b;
      if (!(up > 0) || !(uq > 0)) return std::nullopt;
      std::tie(met.s0, met.s1, met.k0, met.k1) = std::tuple(p.b / up, q.b / uq, 1 / up, 1 / uq);
    }
    if (met.s0 > met.s1) {
      std::swap(met.s0, met.s1);
      std::swap(met.k0, met.k1);
    }
    if (!(met.s1 - met.s0 > kShortestPiece)) return std::nullopt;
    return met;
  }

  const EventWedge& wedge_;
  const ShadowEvent& event_;
  const ShadowReceiver& receiver_;
  LocalForms forms_;
  const EdgeMesh& mesh_;
  std::array<HomogeneousPoint, 2> light_;
  bool one_sided_ = false;
  double surely_ = 0;
};

// Farthest u that may still show, scaled as nearest_u() is.
float farthest_u(const EventWedge& wedge, const NearestPieces& pieces, double scale) {
  const double least = pieces.least_nearness();
  double u = wedge.last_u;
  if (wedge.parallel) {
    u = std::min(u, -least);
  } else if (least > 0) {
    u = std::min(u, 1 / least);
  }
  return float(u * scale) + kBoxMargin;
}

}  // namespace

bool WedgeWalk::insert(const EventWedge& wedge, const ShadowEvent& event,
                       const ShadowReceiver& receiver, NearestPieces& pieces,
                       std::vector<EventSegment>& taken) {
  const std::vector<FaceNode>& nodes = receiver.faces->nodes();
  if (nodes.empty()) return false;
  const Meeting meeting(wedge, event, receiver);
  const double scale = meeting.forms().u_scale;
  float farthest = farthest_u(wedge, pieces, scale);
  const std::size_t taken_before = taken.size();
  bool any_shows = false;
  stack_.assign(1, {0, 0, -std::numeric_limits<float>::infinity()});
  while (!stack_.empty()) {
    const Waiting next = stack_.back();
    stack_.pop_back();
    if (next.nearest_u > farthest) continue;
    for (std::uint32_t i = 0; i < next.faces; ++i) {
      if (meeting.misses(receiver.faces->corners()[next.first + i])) continue;
      met_.clear();
      meeting.collect_segments(receiver.faces->faces()[next.first + i], met_, taken);
      for (const EventSegment& segment : met_) any_shows |= pieces.insert(segment);
      if (!met_.empty()) farthest = farthest_u(wedge, pieces, scale);
    }
    if (next.faces == 0)
      push_boxes(nodes[next.first], nearest_u(meeting.forms(), nodes[next.first]), farthest);
  }
  return any_shows || taken.size() > taken_before;
}

// The nearest on top.
void WedgeWalk::push_boxes(const FaceNode& node, const std::array<float, 4>& u, float farthest) {
  const std::size_t before = stack_.size();
  for (std::size_t box = 0; box < 4; ++box) {
    if (!(u[box] <= farthest) || u[box] == std::numeric_limits<float>::infinity()) continue;
    stack_.push_back({node.first[box], node.count[box], u[box]});
    for (std::size_t at = stack_.size() - 1; at > before; --at) {
      if (stack_[at].nearest_u <= stack_[at - 1].nearest_u) break;
      std::swap(stack_[at], stack_[at - 1]);
    }
  }
}

}  // namespace arris
