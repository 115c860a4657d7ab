#include "rounding/export_scene.h"

#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace arris::bench {
namespace {

using nlohmann::json;

template <class T>
json array_of(Vec3<T> v) {
  return {v.x, v.y, v.z};
}

double radius_of(const Scene& scene, const Object& object) {
  const auto& settings = object.rounding ? object.rounding : scene.rounding;
  if (!settings || settings->method == RoundMethod::none) return 0;
  const double* radius = std::get_if<double>(&settings->radius);
  return radius != nullptr ? *radius : 0;
}

json lights_of(const Scene& scene) {
  json lights = json::array();
  for (const Light& light : scene.lights)
    if (const auto* area = std::get_if<AreaLight>(&light))
      lights.push_back({{"corner", array_of(area->corner)},
                        {"edge_u", array_of(area->edge_u)},
                        {"edge_v", array_of(area->edge_v)},
                        {"radiance", array_of(area->radiance)},
                        {"visible_to_camera", area->visible_to_camera}});
  return lights;
}

}  // namespace

void export_scene(const BenchScene& bench, const std::filesystem::path& folder) {
  const Scene& scene = bench.scene;
  json described;
  described["name"] = bench.name;
  described["image"] = {{"width", scene.image.width_px},
                        {"height", scene.image.height_px},
                        {"samples", scene.image.samples_per_pixel},
                        {"max_depth", scene.image.max_depth}};
  described["camera"] = {{"position", array_of(scene.camera->position)},
                         {"target", array_of(scene.camera->target)},
                         {"vertical_fov_deg", scene.camera->fov_deg}};
  described["lights"] = lights_of(scene);
  if (const auto* sky = std::get_if<ConstantEnvironment>(&*scene.environment))
    described["sky_radiance"] = array_of(sky->radiance);
  for (const Material& m : scene.materials)
    described["materials"].push_back({{"name", m.name},
                                      {"color", array_of(m.base_color)},
                                      {"roughness", m.roughness},
                                      {"glossy_mix", m.glossy_mix.value_or(0.0F)}});
  std::vector<Vec3f> positions;
  std::vector<Triangle> triangles;
  for (const Object& object : scene.objects) {
    const Mesh& mesh = scene.meshes[object.mesh.index];
    json entry{{"name", object.name},
               {"material", object.material.index},
               {"first_vertex", positions.size()},
               {"vertices", mesh.positions.size()},
               {"first_triangle", triangles.size()},
               {"triangles", mesh.triangles.size()},
               {"radius", radius_of(scene, object)}};
    for (MaterialId id : mesh.triangle_materials) entry["triangle_materials"].push_back(id.index);
    described["objects"].push_back(std::move(entry));
    for (Vec3f p : mesh.positions)
      positions.push_back(Vec3f(transform_point(object.world_from_object, Vec3d(p))));
    triangles.insert(triangles.end(), mesh.triangles.begin(), mesh.triangles.end());
  }
  described["vertices"] = positions.size();
  described["triangles"] = triangles.size();
  std::ofstream text(folder / (bench.name + ".json"));
  text << described.dump(1) << "\n";
  std::ofstream binary(folder / (bench.name + ".bin"), std::ios::binary);
  binary.write(reinterpret_cast<const char*>(positions.data()),
               std::streamsize(positions.size() * sizeof(Vec3f)));
  binary.write(reinterpret_cast<const char*>(triangles.data()),
               std::streamsize(triangles.size() * sizeof(Triangle)));
  if (!text.flush() || !binary.flush())
    throw std::runtime_error("cannot write to " + folder.string());
}

}  // namespace arris::bench
