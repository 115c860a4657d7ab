#include "beam/corner_lights.h"

#include <algorithm>
#include <functional>
#include <utility>

namespace arris {
namespace {

constexpr std::size_t kMostLights = 32;
// Shadow rays begin so far, for how far all is from the world's origin, from the surface that they leave.
constexpr double kContact = 1e-9;

// The patch of a whole tile on a plane. Nothing: not all of the rays meet it.
std::optional<HitPatch> spread(const HitPatch& patch, const std::array<Ray, 4>& tile) {
  HitPatch wide = patch;
  const Vec3d n = patch.normals[0];
  for (std::size_t i = 0; i < 4; ++i) {
    const double t = dot(n, patch.corners[0] - tile[i].origin) / dot(n, tile[i].direction);
    if (!(t > 0)) return std::nullopt;
    wide.corners[i] = tile[i].origin + tile[i].direction * t;
  }
  return wide;
}

// From a surface towards the light.
struct ShadowRay {
  Ray ray;
  Reach reach;
};
ShadowRay make_shadow_ray(const LightPlace& light, Vec3d p, Vec3d eye) {
  const Vec3d way = to_light(light, p);
  const double far = length(p) + length(eye - p);
  ShadowRay shadow{{p, way}, {kContact * far / length(way)}};
  if (!light.is_directional) shadow.reach.to = 1;
  return shadow;
}

}  // namespace

CornerLights::CornerLights(std::span<const BeamSolid> solids, std::span<const LightPlace> lights,
                           const std::array<Ray, 4>& tile)
    : solids_(solids),
      lights_(lights.first(std::min(lights.size(), kMostLights))),
      tile_(tile),
      rule_(solids) {}

CornerLights::List CornerLights::make_list(std::uint32_t light, const HitPatch& patch) const {
  std::vector<BeamPart> parts;
  for (std::uint32_t i = 0; i < solids_.size(); ++i) {
    CsgExpression root = solids_[i].shape->root();
    if (i == patch.seen.solid) {
      std::vector<Cover> covers;
      for (const std::uint32_t leaf : root.leaves()) {
        covers.push_back(is_behind(solids_[i], leaf, patch) ? Cover::out : Cover::on);
      }
      root = root.prune(covers);
    }
    if (!root.is_decided()) parts.push_back({i, std::move(root)});
  }
  if (patch.form == PatchForm::flat) {
    const std::optional<HitPatch> wide = spread(patch, tile_);
    if (wide) {
      const auto beam = make_light_pyramid(solids_[patch.seen.solid], *wide, lights_[light]);
      if (beam) parts = parts_near(solids_, parts, *beam);
    }
  }
  return std::make_shared<const std::vector<BeamPart>>(std::move(parts));
}

RegionLights CornerLights::start(const HitPatch& patch) {
  RegionLights all;
  const SeenSurface& seen = patch.seen;
  for (std::uint32_t light = 0; light < lights_.size(); ++light) {
    List& list = lists_[{light, seen.solid, seen.leaf, seen.face}];
    if (!list) list = make_list(light, patch);
    all.open.push_back({light, list, {}});
  }
  return all;
}

RegionLights CornerLights::settle(const RegionLights& above, const HitPatch& patch) {
  RegionLights out{above.lit, above.known, {}};
  for (const RegionLights::Open& open : above.open) settle_light(open, patch, out);
  return out;
}

void CornerLights::settle_light(const RegionLights::Open& above, const HitPatch& patch,
                                RegionLights& out) {
  ++beams_;
  const LightPlace& light = lights_[above.light];
  std::array<bool, 4> is_front{};
  for (std::size_t i = 0; i < 4; ++i) {
    is_front[i] = dot(patch.normals[i], to_light(light, patch.corners[i])) > 0;
  }
  if (std::ranges::none_of(is_front, std::identity{})) return out.decide(above.light, true);
  RegionLights::Open open = above;
  const bool all_front = std::ranges::all_of(is_front, std::identity{});
  const auto beam = all_front ? make_light_pyramid(solids_[patch.seen.solid], patch, light)
                              : std::optional<Pyramid>{};
  if (beam) {
    open.list =
        std::make_shared<const std::vector<BeamPart>>(parts_near(solids_, *above.list, *beam));
    if (open.list->empty()) return out.decide(above.light, true);
  }
  open.reaches.emplace();
  std::array<Ray, 4> rays;
  std::array<std::optional<SeenSurface>, 4> met;
  Reach reach;
  for (std::size_t i = 0; i < 4; ++i) {
    const ShadowRay shadow = make_shadow_ray(light, patch.corners[i], tile_[0].origin);
    rays[i] = shadow.ray;
    reach = {std::max(reach.from, shadow.reach.from), shadow.reach.to};
    if (!is_front[i]) {
      (*open.reaches)[i] = true;
      continue;
    }
    ++rays_;
    const auto sight = see(solids_, *open.list, shadow.ray, shadow.reach.from);
    if (sight && sight->depth < shadow.reach.to) met[i] = sight->seen;
    (*open.reaches)[i] = !met[i];
  }
  const bool all_same = std::ranges::all_of(met, [&](const auto& m) { return m == met[0]; });
  if (beam && all_same && rule_.are_alike(*open.list, rays, reach)) {
    return out.decide(above.light, !met[0]);
  }
  out.open.push_back(std::move(open));
}

}  // namespace arris
