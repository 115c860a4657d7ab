#include "render/surface_point.h"

#include <cmath>

namespace arris {
namespace {

// The direction in which u grows, from the triangle's corners; an arbitrary one where uv is constant.
Vec3f uv_tangent(const SceneGeometry& geometry, const SurfaceHit& hit, Vec3f normal) {
  const GeometryRecord& record = geometry.embree.records()[hit.geometry];
  if (record.uvs == nullptr) {
    return make_frame(normal).tangent;
  }
  const Triangle& t = record.triangles[hit.triangle];
  const WorldTriangle w = world_triangle(geometry.scene, record, hit.triangle);
  const Vec2f a = record.uvs[t[0]], b = record.uvs[t[1]], c = record.uvs[t[2]];
  const float du1 = b.x - a.x, dv1 = b.y - a.y, du2 = c.x - a.x, dv2 = c.y - a.y;
  const Vec3f tangent =
      ((w.p1 - w.p0) * dv2 - (w.p2 - w.p0) * dv1) * (du1 * dv2 - du2 * dv1 < 0 ? -1.0F : 1.0F);
  const Vec3f across = tangent - normal * dot(normal, tangent);
  return length_squared(across) > 1e-12F * length_squared(tangent) ? tangent
                                                                   : make_frame(normal).tangent;
}

// glTF: the bitangent is along growing v, so mirrored texture coordinates turn it round.
bool mirrored_uv(const SceneGeometry& geometry, const SurfaceHit& hit) {
  const GeometryRecord& record = geometry.embree.records()[hit.geometry];
  if (record.uvs == nullptr) {
    return false;
  }
  const Triangle& t = record.triangles[hit.triangle];
  const Vec2f a = record.uvs[t[0]], b = record.uvs[t[1]], c = record.uvs[t[2]];
  return (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y) > 0;
}

Frame bent_frame(const SceneGeometry& geometry, const SurfaceHit& hit, Vec3f bent_normal) {
  const Frame base = make_frame(hit.shading_normal, uv_tangent(geometry, hit, hit.shading_normal));
  // Row 0 of a texture is the top, so v grows downwards and the picture's up is against it.
  const Vec3f up = mirrored_uv(geometry, hit) ? -base.bitangent : base.bitangent;
  const Vec3f normal =
      base.tangent * bent_normal.x + up * bent_normal.y + base.normal * bent_normal.z;
  return make_frame(normalize(normal));
}

}  // namespace

Frame shading_frame(const PreparedScene& scene, const SurfaceHit& hit,
                    const SurfaceMaterial& material) {
  const bool bent = material.normal.x != 0 || material.normal.y != 0;
  Frame frame =
      bent ? bent_frame(scene.geometry(), hit, material.normal) : make_frame(hit.shading_normal);
  if (hit.side == Side::inside) {
    frame = make_frame(-frame.normal);
  }
  return frame;
}

Rgb sampled_emission(const SceneGeometry& geometry, const LightSample& light) {
  const EmitterIndex::Place place = geometry.emitter_index.places[light.index];
  const GeometryRecord& record = geometry.embree.records()[place.geometry];
  const MaterialId id = record.triangle_materials == nullptr
                            ? record.material
                            : record.triangle_materials[place.triangle];
  const Material& material = geometry.scene.materials[id.index];
  if (!material.emission_texture || record.uvs == nullptr) {
    return light.radiance;
  }
  const Triangle& t = record.triangles[place.triangle];
  const Vec2f a = record.uvs[t[0]], b = record.uvs[t[1]], c = record.uvs[t[2]];
  const float v = light.barycentric.x, w = light.barycentric.y, u = 1 - v - w;
  return eval_emission(material, geometry.scene.textures,
                       {u * a.x + v * b.x + w * c.x, u * a.y + v * b.y + w * c.y});
}

}  // namespace arris
