#include "render/scene_geometry.h"

#include <algorithm>
#include <iterator>

#include "scene/scene_bounds.h"

namespace arris {
namespace {

PreparedMaterial prepare_material(const Material& material) {
  PreparedMaterial prepared;
  prepared.factors = material_factors(material);
  prepared.textured = has_textures(material);
  prepared.emissive = max_component(material.emission) > 0;
  prepared.translucent = material.opacity < 1 || material.base_color_texture.has_value();
  return prepared;
}

Vec2f mix_uv(const GeometryRecord& record, const Triangle& t, Vec3f weights) {
  if (record.uvs == nullptr) {
    return {};
  }
  const Vec2f a = record.uvs[t[0]], b = record.uvs[t[1]], c = record.uvs[t[2]];
  return {weights.x * a.x + weights.y * b.x + weights.z * c.x,
          weights.x * a.y + weights.y * b.y + weights.z * c.y};
}

// Textured emission is averaged over four points: it decides how often the triangle is drawn.
Rgb mean_emission(const Scene& scene, const GeometryRecord& record, std::uint32_t triangle) {
  const Material& material = scene.materials[material_of(record, triangle).index];
  if (!material.emission_texture) {
    return material.emission;
  }
  constexpr float kThird = 1.0F / 3;
  const Vec3f points[] = {
      {kThird, kThird, kThird}, {0.6F, 0.2F, 0.2F}, {0.2F, 0.6F, 0.2F}, {0.2F, 0.2F, 0.6F}};
  Rgb sum;
  for (const Vec3f& weights : points) {
    sum += eval_emission(material, scene.textures,
                         mix_uv(record, record.triangles[triangle], weights));
  }
  return sum * 0.25F;
}

bool has_emissive(const std::vector<PreparedMaterial>& materials, const GeometryRecord& record) {
  if (record.triangle_materials == nullptr) {
    return record.triangles != nullptr && materials[record.material.index].emissive;
  }
  return std::any_of(record.triangle_materials, record.triangle_materials + record.triangle_count,
                     [&](MaterialId id) { return materials[id.index].emissive; });
}

// Numbers the emissive triangles. Solids and sheets alike emit from both sides.
std::vector<EmissiveTriangle> collect_emitters(const SceneGeometry& geometry, EmitterIndex& index) {
  std::vector<EmissiveTriangle> emitters;
  const std::vector<GeometryRecord>& records = geometry.embree.records();
  index.first.assign(records.size(), kNoEmitter);
  for (std::uint32_t g = 0; g < records.size(); ++g) {
    const GeometryRecord& record = records[g];
    if (!has_emissive(geometry.materials, record)) {
      continue;
    }
    index.first[g] = std::uint32_t(index.emitter_of_triangle.size());
    for (std::uint32_t t = 0; t < record.triangle_count; ++t) {
      const WorldTriangle w = world_triangle(geometry.scene, record, t);
      const bool emits = geometry.materials[material_of(record, t).index].emissive &&
                         length_squared(cross(w.p1 - w.p0, w.p2 - w.p0)) > 0;
      index.emitter_of_triangle.push_back(emits ? std::uint32_t(emitters.size()) : kNoEmitter);
      if (emits) {
        emitters.push_back({w.p0, w.p1, w.p2, mean_emission(geometry.scene, record, t), true});
        index.places.push_back({g, t});
      }
    }
  }
  return emitters;
}

SceneBounds light_bounds(const std::vector<Bounds>& objects) {
  Bounds bounds;
  for (const Bounds& object : objects) bounds.add(object);
  if (bounds.is_empty()) {
    return {};
  }
  const double radius = bounds.diagonal() / 2;
  return {Vec3f(bounds.center()), radius > 0 ? float(radius) : 1.0F};
}

}  // namespace

PlacedGeometry::PlacedGeometry(const Scene& scene, const EmbreeSceneOptions& options,
                               const CsgSource* solids)
    : csg(make_csg_objects(scene, options.threads, options.stop, solids)),
      embree(scene, options, make_csg_boxes(scene, csg)) {
  set_csg_records(csg, embree);
  for (const Object& object : scene.objects) bounds.push_back(world_bounds(scene, object));
}

PlacedGeometry::PlacedGeometry(const PlacedGeometry& before, const Scene& scene_before,
                               const Scene& moved)
    : csg(move_csg_objects(before.csg, scene_before, moved)),
      embree(before.embree, moved, make_moved_csg_boxes(moved, csg, before.csg)),
      bounds(before.bounds) {
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    const Object& object = moved.objects[i];
    if (object.world_from_object == scene_before.objects[i].world_from_object) continue;
    bounds[i] = world_bounds(moved, object);
  }
}

SceneGeometry::SceneGeometry(Scene described, const EmbreeSceneOptions& options,
                             const CsgSource* solids)
    : scene(std::move(described)),
      placed(std::make_shared<const PlacedGeometry>(scene, options, solids)),
      csg(placed->csg),
      embree(placed->embree) {
  std::transform(scene.materials.read().begin(), scene.materials.read().end(),
                 std::back_inserter(materials), prepare_material);
  any_translucent = std::any_of(materials.begin(), materials.end(),
                                [](const PreparedMaterial& m) { return m.translucent; });
  const std::vector<EmissiveTriangle> emitters = collect_emitters(*this, emitter_index);
  lights = make_light_set(scene.lights, *scene.environment, emitters, light_bounds(placed->bounds));
}

SceneGeometry::SceneGeometry(const SceneGeometry& before, Scene moved,
                             std::shared_ptr<const PlacedGeometry> moved_placed)
    : scene(std::move(moved)),
      placed(std::move(moved_placed)),
      csg(placed->csg),
      embree(placed->embree),
      materials(before.materials),
      any_translucent(before.any_translucent) {
  const std::vector<EmissiveTriangle> emitters = collect_emitters(*this, emitter_index);
  lights = make_light_set(scene.lights, before.lights.environment, emitters,
                          light_bounds(placed->bounds));
}

WorldTriangle instanced_triangle(const Scene& scene, const GeometryRecord& record,
                                 std::uint32_t triangle) {
  const Triangle& t = record.triangles[triangle];
  const Affine3d& m = scene.objects[record.object.index].world_from_object;
  const auto corner = [&](int i) {
    return Vec3f(transform_point(m, Vec3d(record.positions[t[std::size_t(i)]])));
  };
  return {corner(0), corner(1), corner(2)};
}

}  // namespace arris
