// resolve.cpp — what becomes of a hit on the mesh
// Source     Courtin et al. §4: a hit in the void is walked on to the rounded surface, or passes. A hit from inside,
//            which the paper only names (§3), is the mirror image: walked back from where the ray leaves P.
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "rounding/creased_hit.h"
#include "rounding/rounding_data.h"
#include "rounding/walk.h"

namespace arris {
namespace {

// Relative to the solid's size: a point of the void this near to the surface counts as on it.
constexpr double kOnSurface = 1e-7;
// Below this cosine between ray and face, the hit's own t is better than the intersection with the plane.
constexpr double kGrazing = 1e-3;
// How far above the faces of an arc other faces lie that go on smoothly from them, relative to the radius.
constexpr double kSmoothHeight = 0.3;

FaceHit locate(const Rounding::Data& data, const Ray& ray, const MeshHit& hit) {
  FaceHit at{};
  at.face = data.face[hit.triangle];
  const Face& face = data.faces[at.face];
  const Vec3d origin = ray.origin - data.solids[face.solid].center;
  at.scale = length(ray.direction);
  at.direction = ray.direction / at.scale;
  const double cosine = dot(Vec3d(face.normal), at.direction);
  at.t = hit.t;
  if (std::abs(cosine) > kGrazing) {
    at.t = (face.d - dot(Vec3d(face.normal), origin)) / (cosine * at.scale);
  }
  at.x = origin + ray.direction * at.t;
  return at;
}

// Is x in the exact solid P but not in opening(P)? Where the nearest point of E lies on a face of E, x is within r of
// it, being inside P; else it is the nearest arc or node that counts.
bool is_in_void(const Rounding::Data& data, const Solid& solid, Vec3d x) {
  if (!is_in_solid(data, solid, x)) return false;
  const auto faces = std::span(data.faces).subspan(solid.first_face, solid.face_count);
  bool in_erosion = true;
  for (const Face& near : faces) {
    const double above = dot(Vec3d(near.normal), x) - (near.d - data.radius);
    if (above <= 0) continue;
    in_erosion = false;
    const Vec3d foot = x - Vec3d(near.normal) * above;
    const auto is_beyond = [&](const Face& f) {
      return dot(Vec3d(f.normal), foot) > f.d - data.radius + kOnSurface * solid.size;
    };
    if (std::ranges::none_of(faces, is_beyond)) return false;
  }
  if (in_erosion) return false;
  const std::optional<Place> place = search_place(data, solid, x);
  return place && distance_to_place(data, *place, x) > data.radius;
}

// A ray that starts in the void: on to the rounded surface, or out.
Resolution walk_from_void(const Rounding::Data& data, const Solid& solid, Vec3d origin,
                          const FaceHit& exit) {
  Resolution out;
  out.hit = {exit.t, Vec3d(data.faces[exit.face].normal), Feature::face, kNone};
  out.outcome = Resolution::Outcome::passed;
  const std::optional<Place> place = search_place(data, solid, origin);
  if (!place) return out;
  const std::optional<WalkHit> met = walk(data, solid, *place, origin, exit.direction);
  if (!met) return out;
  out.outcome = Resolution::Outcome::moved;
  out.hit = {met->distance / exit.scale, met->normal, met->feature, met->arc};
  return out;
}

// A face that isn't convex may go on above another one of the corner.
bool is_under_corner(const Rounding::Data& data, const Node& node, Vec3d x, double slack) {
  for (std::uint32_t i = 0; i < node.link_count; ++i) {
    const Arc& arc = data.arcs[data.links[node.first_link + i]];
    for (const std::uint32_t f : {arc.face_a, arc.face_b}) {
      if (dot(Vec3d(data.faces[f].normal), x) - data.faces[f].d > 10 * slack) return false;
    }
  }
  return true;
}

// Solids that aren't exact: bands may reach beyond the void. x on `face` is in it if it lies under the faces of the
// arc or corner and farther than r from the place. A face that touches the arc in a corner only goes on smoothly from
// one of the arc's: where they make a hollow it lies above that.
bool is_under_place(const Rounding::Data& data, const Solid& solid, Place place, std::uint32_t face,
                    Vec3d x) {
  const double slack = kOnSurface * solid.size;
  if (distance_to_place(data, place, x) <= data.radius + slack) return false;
  if (place.is_node) return is_under_corner(data, data.nodes[place.index], x, slack);
  const Arc& arc = data.arcs[place.index];
  const bool is_arcs = face == arc.face_a || face == arc.face_b;
  // A touching line lies r (1 − n_a·n_b) under the other face.
  const double deepest = data.radius * (1 - dot(Vec3d(data.faces[arc.face_a].normal),
                                                Vec3d(data.faces[arc.face_b].normal)));
  for (const std::uint32_t f : {arc.face_a, arc.face_b}) {
    const double above = dot(Vec3d(data.faces[f].normal), x) - data.faces[f].d;
    if (above > (is_arcs ? 10 * slack : kSmoothHeight * data.radius)) return false;
    if (above < -deepest - slack) return false;
  }
  return true;
}

// The place from which the walk starts, or nothing if the hit is kept.
std::optional<Place> place_of(const Rounding::Data& data, const Solid& solid, std::uint32_t arc,
                              std::uint32_t face, Vec3d x) {
  if (solid.rewired) return search_place(data, solid, x);
  const std::optional<Place> place = find_place(data, solid, arc, x);
  if (place && !solid.exact && !is_under_place(data, solid, *place, face, x)) return std::nullopt;
  return place;
}

// The arc of the band that takes away most of the face at the hit; kNone: kept.
std::uint32_t deepest_band(const Rounding::Data& data, const MeshHit& hit) {
  const auto u = float(hit.u);
  const auto v = float(hit.v);
  const Band* const last = data.bands.data() + data.band_begin[hit.triangle + 1];
  std::uint32_t arc = kNone;
  float depth = 0;
  for (const Band* b = data.bands.data() + data.band_begin[hit.triangle]; b != last; ++b) {
    const float d = b->depth(u, v);
    if (d <= depth || b->arc == kNone) continue;
    depth = d;
    arc = b->arc;
  }
  return arc;
}

// A hit from outside, and the arc of its deepest band or kNone.
struct Entry {
  std::uint32_t arc;
  const Ray& ray;
  const MeshHit& hit;
};

// Most hits on exact solids end here: kept, or settled between the ends of one arc. False: `out` is as it was.
bool settle_shortly(const Rounding::Data& data, const Solid& solid, const Entry& entry,
                    Resolution& out) {
  const Face& face = data.faces[data.face[entry.hit.triangle]];
  const Vec3d normal(face.normal);
  const Vec3d direction = entry.ray.direction;
  const Vec3d origin = entry.ray.origin - solid.center;
  const double facing = dot(normal, direction);
  const bool grazes = facing * facing < kGrazing * kGrazing * length_squared(direction);
  const double t = grazes ? entry.hit.t : (face.d - dot(normal, origin)) / facing;
  if (entry.arc == kNone) {
    out.hit = {t, normal};
    return true;
  }
  const ShortWalk quick = walk_short(data, entry.arc, origin + direction * t, direction);
  if (!quick.certain) return false;
  out.outcome = Resolution::Outcome::passed;
  out.hit.crossed = entry.arc;
  if (quick.hit) {
    out.outcome = Resolution::Outcome::moved;
    out.hit = {t + quick.hit->distance, quick.hit->normal, Feature::edge, entry.arc, entry.arc};
  }
  return true;
}

// Solids that aren't exact: the first band that the point really lies in.
std::optional<Place> detect_by_bands(const Rounding::Data& data, const Solid& solid,
                                     const MeshHit& hit, Vec3d x) {
  const Band* const last = data.bands.data() + data.band_begin[hit.triangle + 1];
  for (const Band* b = data.bands.data() + data.band_begin[hit.triangle]; b != last; ++b) {
    if (b->arc == kNone || b->depth(float(hit.u), float(hit.v)) <= 0) continue;
    if (const std::optional<Place> place =
            place_of(data, solid, b->arc, data.face[hit.triangle], x))
      return place;
  }
  return std::nullopt;
}

// Paper §3.2: a kd-tree instead of the triangle's bands.
std::optional<Place> detect_by_tree(const Rounding::Data& data, const Solid& solid,
                                    std::uint32_t face_index, Vec3d x) {
  const Face& face = data.faces[face_index];
  const Vec3d ball = x - Vec3d(face.normal) * data.radius;
  const DetectionEntry* deepest = nullptr;
  double depth = kOnSurface * solid.size;
  for (const DetectionEntry& entry : data.tree->find(face.solid, Vec3f(x))) {
    if (entry.face != face_index) continue;
    const Arc& arc = data.arcs[entry.arc];
    const Face& other = data.faces[arc.face_a == face_index ? arc.face_b : arc.face_a];
    const double d =
        entry.whole_face ? solid.size : dot(Vec3d(other.normal), ball) - (other.d - data.radius);
    if (d <= kOnSurface * solid.size) continue;
    if (!solid.exact) {
      if (const std::optional<Place> place = place_of(data, solid, entry.arc, face_index, x))
        return place;
    } else if (d > depth) {
      depth = d;
      deepest = &entry;
    }
  }
  if (deepest == nullptr) return std::nullopt;
  return place_of(data, solid, deepest->arc, face_index, x);
}

std::optional<EdgeBlend> blend_of_creased(const Rounding::Data& data, const RoundedHit& hit,
                                          Vec3d position) {
  const Solid& solid = data.solids[hit.solid];
  std::optional<EdgeBlend> blend =
      data.creased[solid.creased]->blend_at(position - solid.center, hit.normal);
  if (!blend) return std::nullopt;
  for (EdgeBlend::Side* const side : {&blend->a, &blend->b}) {
    if (side->triangle >= data.face.size()) return std::nullopt;  // a piece of a split one
    side->point += solid.center;
  }
  return blend;
}

// Where the walk ended.
void finish(Resolution& out, const std::optional<WalkHit>& met, const FaceHit& at, bool entering) {
  if (!met) {
    out.outcome = Resolution::Outcome::passed;
    return;
  }
  out.outcome = Resolution::Outcome::moved;
  const double along = met->distance / at.scale;
  out.hit = {entering ? at.t + along : at.t - along, met->normal, met->feature, met->arc};
}

}  // namespace

const char* name_of(Feature feature) {
  switch (feature) {
    case Feature::face:
      return "face";
    case Feature::edge:
      return "edge";
    case Feature::corner:
      return "corner";
    case Feature::fillet:
      return "fillet";
    case Feature::csg:
      return "csg";
  }
  return "face";
}

Rounding::Rounding(std::unique_ptr<const Data> data) : data_(std::move(data)) {}
Rounding::Rounding(Rounding&&) noexcept = default;
Rounding& Rounding::operator=(Rounding&&) noexcept = default;
Rounding::~Rounding() = default;

bool Rounding::is_kept(std::uint32_t triangle, double u, double v) const {
  if (data_->tree) return false;
  return is_kept_by_bands(data_->band_begin.data(), data_->bands.data(), triangle, float(u),
                          float(v));
}

Resolution Rounding::resolve(const Ray& ray, const MeshHit& hit, RayStart start) const {
  Resolution out;
  out.hit.t = hit.t;
  const std::uint32_t face_index = data_->face[hit.triangle];
  if (face_index == kNone) return out;
  const Face& face = data_->faces[face_index];
  const Solid& solid = data_->solids[face.solid];
  const bool entering = dot(Vec3d(face.normal), ray.direction) < 0;
  std::uint32_t arc = kNone;
  if (solid.exact && !data_->tree) {
    arc = deepest_band(*data_, hit);
    if (entering && !solid.rewired && settle_shortly(*data_, solid, {arc, ray, hit}, out)) {
      return out;
    }
  }
  const FaceHit at = locate(*data_, ray, hit);
  if (solid.creased != kNone || solid.filled != kNone) {
    const auto found = resolve_creased(*data_, solid, {at, ray, hit, start});
    if (found) return *found;
  }
  out.hit = {at.t, Vec3d(face.normal)};
  if (!entering && solid.exact && start != RayStart::inside) {
    const Vec3d origin = ray.origin - solid.center;
    if (start == RayStart::outside || is_in_void(*data_, solid, origin)) {
      return walk_from_void(*data_, solid, origin, at);
    }
  }
  const Vec3d direction = entering ? at.direction : -at.direction;
  std::optional<Place> place;
  if (data_->tree) {
    place = detect_by_tree(*data_, solid, face_index, at.x);
  } else if (!solid.exact) {
    place = detect_by_bands(*data_, solid, hit, at.x);
  } else if (arc != kNone) {
    place = place_of(*data_, solid, arc, face_index, at.x);
  }
  if (!place) return out;
  finish(out, walk(*data_, solid, *place, at.x, direction), at, entering);
  return out;
}

Rounding::Exit Rounding::find_exit(std::uint32_t solid_index, const Ray& ray) const {
  const Solid& solid = data_->solids[solid_index];
  const Vec3d origin = ray.origin - solid.center;
  Exit exit{std::numeric_limits<double>::infinity(), 0};
  for (std::uint32_t f = solid.first_face; f < solid.first_face + solid.face_count; ++f) {
    const Face& face = data_->faces[f];
    const double approach = dot(Vec3d(face.normal), ray.direction);
    if (approach <= 0) continue;
    const double t = (face.d - dot(Vec3d(face.normal), origin)) / approach;
    if (t < exit.t) exit = {t, approach};
  }
  return exit;
}

std::optional<Rounding::Exit> Rounding::find_exit_beside(std::uint32_t arc_index, const Ray& ray,
                                                         double start) const {
  const Arc& arc = data_->arcs[arc_index];
  const Vec3d rel =
      ray.origin - data_->solids[data_->faces[arc.face_a].solid].center - Vec3d(arc.line.p0);
  Exit exit{std::numeric_limits<double>::infinity(), 0};
  for (const std::uint32_t f : {arc.face_a, arc.face_b}) {
    const Vec3d normal(data_->faces[f].normal);
    const double approach = dot(normal, ray.direction);
    if (approach <= 0) continue;
    const double t = (data_->radius - dot(normal, rel)) / approach;
    if (t < exit.t) exit = {t, approach};
  }
  const Vec3d axis(arc.line.axis);
  const double at = dot(axis, rel), speed = dot(axis, ray.direction);
  const double begin = at + speed * start, end = at + speed * exit.t;
  const double length = arc.line.length;
  if (!(begin >= 0 && begin <= length && end >= 0 && end <= length)) return std::nullopt;
  return exit;
}

bool Rounding::contains(std::uint32_t solid_index, Vec3d point) const {
  const Solid& solid = data_->solids[solid_index];
  const Vec3d x = point - solid.center;
  return is_in_solid(*data_, solid, x) && !is_in_void(*data_, solid, x);
}

std::span<const Rounding::FilletBox> Rounding::fillet_boxes() const {
  return data_->fillet_boxes;
}

std::optional<RoundedHit> Rounding::meet_fillet(std::uint32_t box, const Ray& ray, double t_min,
                                                double t_max, RayStart start) const {
  const Data::FilletPart& place = data_->fillet_parts[box];
  const Solid& solid = data_->solids[place.solid];
  const std::optional<FilletCrossing> met = data_->filled[solid.filled]->fillets.meet(
      place.part, ray.origin - solid.center, ray.direction,
      {t_min, t_max, start != RayStart::inside, start != RayStart::outside});
  if (!met) return std::nullopt;
  return RoundedHit{met->t, met->normal, Feature::fillet};
}

std::optional<EdgeBlend> Rounding::blend_of(const RoundedHit& hit, Vec3d position) const {
  if (hit.solid != kNone) return blend_of_creased(*data_, hit, position);
  if (hit.arc == kNone || data_->arcs[hit.arc].triangle_a == kNone) return std::nullopt;
  const Arc& arc = data_->arcs[hit.arc];
  const Vec3d na(data_->faces[arc.face_a].normal);
  const Vec3d nb(data_->faces[arc.face_b].normal);
  // hit.normal = α n_a + β n_b on the cylinder.
  const double c = dot(na, nb);
  const double s2 = length_squared(cross(na, nb));
  const double along_a = dot(hit.normal, na);
  const double along_b = dot(hit.normal, nb);
  const Vec3d on_axis = position - hit.normal * data_->radius;
  return EdgeBlend{
      {arc.triangle_a, on_axis + na * data_->radius, na, (along_a - c * along_b) / s2},
      {arc.triangle_b, on_axis + nb * data_->radius, nb, (along_b - c * along_a) / s2}};
}

std::uint32_t Rounding::solid_of(std::uint32_t triangle) const {
  const std::uint32_t face = data_->face[triangle];
  return face == kNone ? kNone : data_->faces[face].solid;
}

bool Rounding::is_exact(std::uint32_t solid) const {
  return solid != kNone && data_->solids[solid].exact;
}

Vec3d Rounding::face_normal(std::uint32_t triangle) const {
  const std::uint32_t face = data_->face[triangle];
  return face == kNone ? Vec3d(0, 0, 1) : Vec3d(data_->faces[face].normal);
}

const RoundingReport& Rounding::report() const {
  return data_->report;
}

}  // namespace arris
