#include "render/shadow_finder.h"

#include <algorithm>
#include <optional>

#include "base/parallel_for.h"
#include "render/csg_shadows.h"
#include "render/rounded_edges.h"

namespace arris {
namespace {

// Where a rounded outline is looked at from for a light at infinity, in sizes of the scene.
constexpr double kFarAway = 1e5;

HomogeneousPoint from_object(const Affine3d& world, const HomogeneousPoint& light) {
  return transform(inverse(world), light);
}

Vec3d eye_of(const HomogeneousPoint& light, const Sphere& around) {
  if (light.w > 0) return light.xyz / light.w;
  return around.center + normalize(light.xyz) * (2 * around.radius * kFarAway);
}

// Events of edges of the mesh that the rounding has not taken, and those of its own outline.
std::vector<ShadowEvent> rounded_events(const EdgeObjects::Parts& blocker,
                                        std::span<const ShadowEvent> of_mesh,
                                        const HomogeneousPoint& light, const Sphere& around) {
  std::vector<ShadowEvent> events;
  for (const ShadowEvent& event : of_mesh) {
    if (!blocker.is_rounded_between(event.faces[0], event.faces[1])) events.push_back(event);
  }
  const Vec3d eye = eye_of(light, around);
  for (const RoundedTangent& tangent :
       find_rounded_tangents(*blocker.rounding, RoundedView{eye, {0, 0, 1}, 0})) {
    ShadowEvent event;
    event.origin = {Vec3d(tangent.edge.a), Vec3d(tangent.edge.b)};
    event.light = {light, light};
    event.void_depth = tangent.void_depth;
    events.push_back(event);
  }
  return events;
}

// Of a solid of solids: its edges and outlines that rays of the light touch.
std::vector<ShadowEvent> solid_events(const CsgEdges& solid, const Affine3d& world,
                                      const HomogeneousPoint& light, const Sphere& around) {
  std::vector<ShadowEvent> events;
  for (const CsgEdges::Segment& s :
       solid.find_touched(transform_point(inverse(world), eye_of(light, around)), 0)) {
    ShadowEvent event;
    event.origin = {transform_point(world, s.a), transform_point(world, s.b)};
    event.light = {light, light};
    events.push_back(event);
  }
  return events;
}

std::vector<ShadowEvent> mesh_events(const EdgeObjects::Parts& blocker, const ShadowLight& light,
                                     const Sphere& around) {
  if (const auto* area = std::get_if<ParallelogramLight>(&light)) {
    return transform(*blocker.world,
                     find_shadow_events(*blocker.tree, transform(inverse(*blocker.world), *area)));
  }
  const auto& point = std::get<HomogeneousPoint>(light);
  const std::vector<ShadowEvent> events = transform(
      *blocker.world, find_shadow_events(*blocker.tree, from_object(*blocker.world, point)));
  return blocker.rounding == nullptr ? events : rounded_events(blocker, events, point, around);
}

}  // namespace

std::vector<ShadowLight> shadow_lights(const PreparedScene& prepared) {
  std::vector<ShadowLight> lights;
  for (const Light& light : prepared.scene().lights) {
    if (const auto* point = std::get_if<PointLight>(&light)) {
      lights.emplace_back(HomogeneousPoint{point->position, 1});
    } else if (const auto* spot = std::get_if<SpotLight>(&light)) {
      lights.emplace_back(HomogeneousPoint{spot->position, 1});
    } else if (const auto* far = std::get_if<DirectionalLight>(&light)) {
      lights.emplace_back(HomogeneousPoint{-far->direction, 0});
    } else {
      const auto& area = std::get<AreaLight>(light);
      lights.emplace_back(ParallelogramLight{area.corner, area.edge_u, area.edge_v,
                                             cross(area.edge_u, area.edge_v)});
    }
  }
  for (const SunDisc& sun : prepared.geometry().lights.environment->suns) {
    lights.emplace_back(HomogeneousPoint{Vec3d(sun.direction), 0});
  }
  return lights;
}

namespace {

// Whether a light shines from elsewhere, and how much it differs in all, 0 to 1.
struct LightChange {
  bool moved = false;
  double amount = 0;
};
constexpr double kWholeMove = 0.25;  // of the scene's scale, or radians

LightChange change(double move, Rgb a, Rgb b, bool otherwise = false) {
  const Rgb more{std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
  const Rgb less{std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
  const double most = double(max_component(more));
  const double part = most > 0 ? double(max_component(more - less)) / most : 0;
  return {move > 0, otherwise ? 1 : std::min(1.0, std::max(part, move / kWholeMove))};
}
LightChange change_of(const PointLight& a, const PointLight& b, double scale) {
  return change(length(a.position - b.position) / scale, a.intensity, b.intensity);
}
LightChange change_of(const SpotLight& a, const SpotLight& b, double scale) {
  const bool aimed = a.direction != b.direction || a.inner_angle != b.inner_angle ||
                     a.outer_angle != b.outer_angle;
  return change(length(a.position - b.position) / scale, a.intensity, b.intensity, aimed);
}
LightChange change_of(const DirectionalLight& a, const DirectionalLight& b, double /*scale*/) {
  return change(length(a.direction - b.direction), a.irradiance, b.irradiance);
}
LightChange change_of(const AreaLight& a, const AreaLight& b, double scale) {
  const double move = std::max(
      {length(a.corner - b.corner), length(a.edge_u - b.edge_u), length(a.edge_v - b.edge_v)});
  return change(move / scale, a.radiance, b.radiance, a.visible_to_camera != b.visible_to_camera);
}
template <class A, class B>
LightChange change_of(const A& /*a*/, const B& /*b*/, double /*scale*/) {
  return {true, 1};
}

// What the camera looks at from how far away tells how large the scene is.
double scale_of(const Scene& scene) {
  return scene.camera ? length(scene.camera->position - scene.camera->target) : 1;
}

}  // namespace

LightChanges find_changed_lights(const Scene& before, const Scene& after) {
  LightChanges changes;
  changes.renumbered = before.lights.size() != after.lights.size();
  changes.amount = changes.renumbered ? 1 : 0;
  if (changes.renumbered) return changes;
  const double scale = scale_of(after);
  for (std::uint32_t i = 0; i < after.lights.size(); ++i) {
    const LightChange change =
        std::visit([&](const auto& a, const auto& b) { return change_of(a, b, scale); },
                   before.lights[i], after.lights[i]);
    if (change.moved) changes.moved.push_back(i);
    changes.amount = std::max(changes.amount, change.amount);
  }
  return changes;
}

void ShadowFinder::add(std::span<const ShadowTriple> triples) {
  for (const ShadowTriple& t : triples) {
    Pair& pair = pairs_[{t.light, t.blocker}];
    if (pair.receivers.insert(t.receiver).second) pair.added.insert(t.receiver);
  }
}

void ShadowFinder::object_moved(std::uint32_t object) {
  for (auto& [key, pair] : pairs_) {
    if (key.second == object) pair.events_known = false;
    if (pair.receivers.contains(object)) pair.receivers_known = false;
  }
}

void ShadowFinder::light_moved(std::uint32_t light) {
  for (auto& [key, pair] : pairs_) {
    if (key.first == light) pair.events_known = false;
  }
}

void ShadowFinder::all_changed() {
  pairs_.clear();
  edges_ = std::make_shared<const std::vector<SoftEdge>>();
}

bool ShadowFinder::find_events(const PreparedScene& scene, const EdgeObjects& objects,
                               const ShadowLight& light, std::uint32_t blocker, Pair& pair) {
  const std::optional<EdgeObjects::Parts> parts = objects.parts(scene, blocker);
  const CsgEdges* const solid = objects.solid(blocker);
  const auto* const point = std::get_if<HomogeneousPoint>(&light);
  if (!parts && (solid == nullptr || point == nullptr)) return false;
  const Sphere around = objects.bounding_sphere(scene, blocker);
  const Affine3d& world = scene.scene().objects[blocker].world_from_object;
  pair.traced = TracedEvents(parts ? mesh_events(*parts, light, around)
                                   : solid_events(*solid, world, *point, around));
  pair.events_known = true;
  pair.receivers_known = false;
  return true;
}

void ShadowFinder::find_edges(const PreparedScene& scene, const EdgeObjects& objects,
                              std::uint32_t blocker, Pair& pair) {
  if (!pair.receivers_known) {
    pair.traced.forget_receivers();
    pair.on_solids.clear();
    pair.added = pair.receivers;
  }
  std::vector<ShadowReceiver> receivers, added;
  for (const std::uint32_t receiver : pair.receivers) {
    const bool is_added = pair.added.contains(receiver);
    if (const std::optional<EdgeObjects::Parts> r = objects.parts(scene, receiver)) {
      receivers.push_back({receiver, r->faces, *r->world, receiver == blocker, r->voids});
      if (is_added) added.push_back(receivers.back());
    }
    if (const CsgEdges* const on = objects.solid(receiver); on != nullptr && is_added) {
      pair.on_solids[receiver] = find_edges_on_solid(
          pair.traced.events(), *on, scene.scene().objects[receiver].world_from_object);
    }
  }
  if (!added.empty()) pair.traced.add(receivers, added);
  pair.added.clear();
  pair.receivers_known = true;
}

bool ShadowFinder::update(const PreparedScene& scene, const EdgeObjects& objects,
                          std::size_t most_events) {
  bool complete = true;
  std::size_t planned = 0;
  std::optional<std::vector<ShadowLight>> lights;
  std::vector<std::pair<std::uint32_t, Pair*>> wanted;  // by blocker
  auto at = pairs_.lower_bound(next_);
  for (std::size_t i = 0; i < pairs_.size(); ++i, ++at) {
    if (at == pairs_.end()) at = pairs_.begin();
    auto& [key, pair] = *at;
    if (pair.is_known()) continue;
    if (planned > most_events) {
      complete = false;
      next_ = key;
      break;
    }
    if (!lights) lights = shadow_lights(scene);
    const auto& [light, blocker] = key;
    if (light >= lights->size()) continue;
    if (!pair.events_known && !find_events(scene, objects, (*lights)[light], blocker, pair)) {
      continue;
    }
    planned +=
        pair.traced.events().size() * (pair.receivers_known ? pair.added : pair.receivers).size();
    wanted.emplace_back(blocker, &pair);
  }
  // Of most pairs there is little to do.
  parallel_for(wanted.size(), {.grain = 1}, [&](std::size_t i) {
    find_edges(scene, objects, wanted[i].first, *wanted[i].second);
  });
  if (!wanted.empty()) gather_edges();
  return complete;
}

void ShadowFinder::gather_edges() {
  std::size_t count = 0;
  for (const auto& [key, pair] : pairs_) {
    count += pair.traced.edges().size();
    for (const auto& [receiver, found] : pair.on_solids) count += found.size();
  }
  auto edges = std::make_shared<std::vector<SoftEdge>>();
  edges->reserve(count);
  for (const auto& [key, pair] : pairs_) {
    for (const auto& [receiver, found] : pair.on_solids) {
      edges->insert(edges->end(), found.begin(), found.end());
    }
    for (const ShadowEdge& edge : pair.traced.edges()) {
      edges->push_back({{edge.a, edge.b}, edge.penumbra, edge.kind == ShadowKind::umbral});
    }
  }
  edges_ = std::move(edges);
}

}  // namespace arris
