#include "render/texture_tints.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>

#include "base/parallel_for.h"
#include "edgepoint/shifted_word.h"
#include "render/surface_point.h"

namespace arris {
namespace {

constexpr int kSampleReach = 2;  // pixels, of samples
constexpr int kMostTaps = 8;
constexpr float kOpaque = 0.999F;
constexpr int kMostSheets = 64;  // cut out surfaces one behind another
constexpr std::uint8_t kMiddle = 16, kNotYet = 255;

// How a texture moves past, a pixel to the right and one down.
struct UvSteps {
  Vec2f right, down;
};

UvSteps find_uv_steps(const SceneGeometry& geometry, const CameraRays& camera, Vec2f place,
                      const SurfaceHit& hit) {
  const GeometryRecord& record = geometry.embree.records()[hit.geometry];
  if (record.uvs == nullptr) return {};
  const WorldTriangle w = world_triangle(geometry.scene, record, hit.triangle);
  const Vec3d e1(w.p1 - w.p0), e2(w.p2 - w.p0);
  const double a11 = dot(e1, e1), a12 = dot(e1, e2), a22 = dot(e2, e2);
  const double det = a11 * a22 - a12 * a12;
  const Vec3d n(hit.geometric_normal);
  const Vec3d d = camera.corner + camera.step_x * double(place.x) + camera.step_y * double(place.y);
  const double facing = dot(d, n);
  if (!(det > 0) || facing == 0) return {};
  const double t = dot(Vec3d(hit.position - camera.position), n) / facing;
  const Triangle& index = record.triangles[hit.triangle];
  const Vec2f a = record.uvs[index[0]], b = record.uvs[index[1]], c = record.uvs[index[2]];
  const auto step = [&](Vec3d s) {
    const Vec3d along = (s - d * (dot(s, n) / facing)) * t;
    const double r1 = dot(along, e1), r2 = dot(along, e2);
    const auto beta = float((r1 * a22 - r2 * a12) / det);
    const auto gamma = float((r2 * a11 - r1 * a12) / det);
    return Vec2f{beta * (b.x - a.x) + gamma * (c.x - a.x),
                 beta * (b.y - a.y) + gamma * (c.y - a.y)};
  };
  return {step(camera.step_x), step(camera.step_y)};
}

// Texels of a step.
float texels_of(Vec2f step, const Texture& texture) {
  return std::max(std::fabs(step.x) * float(texture.width_px),
                  std::fabs(step.y) * float(texture.height_px));
}

int taps_of(Vec2f step, const Texture& texture) {
  const float texels = texels_of(step, texture);
  return int(std::clamp(std::ceil(1 + 2 * texels), 1.0F, float(kMostTaps)));
}

// The mean over the pixel filter, as if the surface went on in its plane.
Rgb filter_base_color(const SceneGeometry& geometry, const Material& material,
                      const PixelLooks& looks, Vec2f uv, UvSteps steps) {
  const std::span<const Texture> textures = geometry.scene.textures;
  const TextureId id = *material.base_color_texture;
  const Texture& finest = textures[id.index];
  // Texels no larger than the shorter side of the pixel: along the longer one there are more taps.
  const Texture& texture = looks.levels.find(
      textures, id, std::min(texels_of(steps.right, finest), texels_of(steps.down, finest)));
  const int nx = taps_of(steps.right, texture), ny = taps_of(steps.down, texture);
  std::array<float, kMostTaps> across{};
  for (int i = 0; i < nx; ++i) {
    across[std::size_t(i)] = looks.filter.sample_offset((float(i) + 0.5F) / float(nx));
  }
  Rgb sum;
  for (int j = 0; j < ny; ++j) {
    const float y = looks.filter.sample_offset((float(j) + 0.5F) / float(ny));
    const Vec2f row{uv.x + steps.down.x * y, uv.y + steps.down.y * y};
    for (int i = 0; i < nx; ++i) {
      const float x = across[std::size_t(i)];
      sum += eval_base_color(material, texture,
                             {row.x + steps.right.x * x, row.y + steps.right.y * x});
    }
  }
  return sum * (1 / float(nx * ny));
}

float ratio(float tinted, float plain) {
  return plain > 0 ? tinted / plain : 1.0F;
}

// A cell of the pixel in its primary region, or kMiddle: the point's, else the one nearest to the region's middle.
std::uint8_t primary_place(PixelCode code, PointKey point) {
  if (code.is_complex()) return point.is_none() ? kMiddle : std::uint8_t(point.cell());
  if (!code.is_simple()) return kMiddle;
  const RegionOf primary = code.primary_is_a() ? RegionOf::a : RegionOf::b;
  float x = 0, y = 0;
  int count = 0;
  std::array<bool, 16> within{};
  for (std::uint32_t cell = 0; cell < 16; ++cell) {
    within[cell] = edge_tables().region_of(code.edge(), cell) == primary;
    if (!within[cell]) continue;
    x += float(cell % 4);
    y += float(cell / 4);
    ++count;
  }
  if (count == 0) return kMiddle;
  x /= float(count);
  y /= float(count);
  std::uint8_t best = kMiddle;
  float least = 100;
  for (std::uint8_t cell = 0; cell < 16; ++cell) {
    const float dx = float(cell % 4) - x, dy = float(cell / 4) - y;
    if (!within[cell] || dx * dx + dy * dy >= least) continue;
    least = dx * dx + dy * dy;
    best = cell;
  }
  return best;
}

Vec2f place_in(std::uint8_t place) {
  if (place == kMiddle) return {0.5F, 0.5F};
  return {(float(place % 4) + 0.5F) / 4, (float(place / 4) + 0.5F) / 4};
}

}  // namespace

std::vector<bool> find_tinted_objects(const Scene& scene) {
  const auto tints = [&](MaterialId id) { return can_be_tinted(scene.materials[id.index]); };
  std::vector<bool> tinted;
  for (const Object& object : scene.objects) {
    bool any = false;
    if (!object.csg) {
      const std::vector<MaterialId>& own = scene.meshes[object.mesh.index].triangle_materials;
      any = tints(object.material) || std::any_of(own.begin(), own.end(), tints);
    }
    tinted.push_back(any);
  }
  if (std::find(tinted.begin(), tinted.end(), true) == tinted.end()) tinted.clear();
  return tinted;
}

namespace {

// What a ray sees behind what is cut out, and its material there.
struct Sight {
  TraceRay ray;
  SurfaceHit hit;
  SurfaceMaterial shown;
};

std::optional<Sight> look_through(const PreparedScene& scene, TraceRay ray) {
  for (int sheet = 0; sheet < kMostSheets; ++sheet) {
    const std::optional<SurfaceHit> hit = scene.intersect(ray);
    if (!hit) return std::nullopt;
    std::optional<SurfaceMaterial> storage;
    const SurfaceMaterial& shown = material_at(scene, *hit, storage);
    if (shown.opacity > 0) return Sight{ray, *hit, shown};
    ray = leave_surface(*hit, ray.direction);
  }
  return std::nullopt;
}

Rgb albedo_of(const PreparedScene& scene, const Sight& sight, const SurfaceMaterial& material) {
  const Frame frame = shading_frame(scene, sight.hit, material);
  const Vec3f wo = local_from_world(frame, -sight.ray.direction);
  const bool inside = sight.hit.side == Side::inside;
  return directional_albedo(
      material, make_bsdf(material, wo, inside ? MediumSide::inside : MediumSide::outside));
}

}  // namespace

SeenSurface see_surface(const PreparedScene& scene, const CameraRays& camera,
                        const PixelLooks& looks, Vec2f place) {
  const SceneGeometry& geometry = scene.geometry();
  std::optional<Sight> sight =
      look_through(scene, camera_ray(camera, double(place.x), double(place.y)));
  if (!sight) return {};
  const Material& material = geometry.scene.materials[sight->hit.material.index];
  const bool reflects = sight->shown.opacity > kOpaque && sight->shown.transmission == 0 &&
                        !(max_component(sight->shown.emission) > 0);
  SeenSurface seen;
  seen.normal = shading_frame(scene, sight->hit, sight->shown).normal;
  if (!reflects) return seen;
  if (is_tinted(material, sight->shown)) {
    const UvSteps steps = find_uv_steps(geometry, camera, place, sight->hit);
    sight->shown.base_color = filter_base_color(geometry, material, looks, sight->hit.uv, steps);
  }
  seen.albedo = albedo_of(scene, *sight, sight->shown);
  return seen;
}

std::optional<Rgb> find_tint(const PreparedScene& scene, const CameraRays& camera,
                             const PixelLooks& looks, Vec2f place) {
  const SceneGeometry& geometry = scene.geometry();
  std::optional<Sight> sight =
      look_through(scene, camera_ray(camera, double(place.x), double(place.y)));
  if (!sight) return std::nullopt;
  const Material& material = geometry.scene.materials[sight->hit.material.index];
  if (!is_tinted(material, sight->shown)) return std::nullopt;
  const UvSteps steps = find_uv_steps(geometry, camera, place, sight->hit);
  const Rgb seen = filter_base_color(geometry, material, looks, sight->hit.uv, steps);
  const Rgb white = material.base_color;
  return Rgb{ratio(seen.x, white.x), ratio(seen.y, white.y), ratio(seen.z, white.z)};
}

Vec2f primary_place_of(const EdgePointImage& image, int x, int y) {
  const std::size_t at = image.offset(x, y);
  return place_in(primary_place(image.codes[at], image.points[at]));
}

PixelLooks::PixelLooks(const Scene& scene, ImageSettings::Filter shape, int threads)
    : filter(shape) {
  std::vector<bool> wanted(scene.textures.size());
  for (const Material& material : scene.materials) {
    if (can_be_tinted(material)) wanted[material.base_color_texture->index] = true;
  }
  levels = TextureLevels(scene.textures, wanted, threads);
}

TextureTints::TextureTints(const Scene& scene, int threads)
    : looks_(scene, scene.image.filter, threads), objects_(find_tinted_objects(scene)) {
  if (objects_.empty()) return;
  const int width = scene.image.width_px, height = scene.image.height_px;
  marked_ = BitPlane(width, height);
  tints_ = TintImage(width, height);
  looked_.assign(tints_.values.size(), kNotYet);
}

void TextureTints::clear() {
  std::fill(looked_.begin(), looked_.end(), kNotYet);
}

const TintImage* TextureTints::update(const PreparedScene& scene, const CameraRays& camera,
                                      const PointCache& cache, const EdgePointImage& image,
                                      int threads) {
  if (objects_.empty()) return nullptr;
  const auto rows = std::size_t(image.height_px);
  parallel_for(rows, {.grain = 16, .threads = threads},
               [&](std::size_t y) { mark_points(cache, image, int(y)); });
  parallel_for(rows, {.grain = 4, .threads = threads},
               [&](std::size_t y) { tint_row(scene, camera, image, int(y)); });
  return &tints_;
}

void TextureTints::mark_points(const PointCache& cache, const EdgePointImage& image, int y) {
  std::uint64_t* const row = marked_.row(y);
  const PointKey* const points = image.points.data() + image.offset(0, y);
  std::fill(row, row + marked_.words(), 0);
  for (int x = 0; x < image.width_px; ++x) {
    if (points[x].is_none()) continue;
    const std::uint32_t object = cache.objects()[points[x].point()];
    if (object >= objects_.size() || !objects_[object]) continue;
    row[x >> 6] |= std::uint64_t{1} << unsigned(x & 63);
  }
}

void TextureTints::tint_row(const PreparedScene& scene, const CameraRays& camera,
                            const EdgePointImage& image, int y) {
  std::uint64_t* const tinted = tints_.is_tinted.row(y);
  for (int word = 0; word < marked_.words(); ++word) {
    std::uint64_t near = 0;
    for (int dy = -kSampleReach; dy <= kSampleReach; ++dy) {
      for (int dx = -kSampleReach; dx <= kSampleReach; ++dx)
        near |= shifted_word(marked_.row(y + dy), word, dx);
    }
    for (std::uint64_t lost = tinted[word] & ~near; lost != 0; lost &= lost - 1) {
      looked_[image.offset(64 * word + std::countr_zero(lost), y)] = kNotYet;
    }
    tinted[word] &= near;
    const int count = std::min(64, image.width_px - 64 * word);
    for (int i = 0; i < count; ++i) {
      if ((near >> unsigned(i) & 1U) == 0) continue;
      const int x = 64 * word + i;
      const std::size_t at = image.offset(x, y);
      const std::uint8_t place = primary_place(image.codes[at], image.points[at]);
      if (looked_[at] == place) continue;
      looked_[at] = place;
      const Vec2f in = place_in(place);
      const std::uint64_t bit = std::uint64_t{1} << unsigned(i);
      tinted[word] &= ~bit;
      if (const std::optional<Rgb> tint =
              find_tint(scene, camera, looks_, {float(x) + in.x, float(y) + in.y})) {
        tints_.values[at] = *tint;
        tinted[word] |= bit;
      }
    }
  }
}

}  // namespace arris
