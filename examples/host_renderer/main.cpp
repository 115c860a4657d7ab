// host_renderer — a small path tracer over Embree that hosts Arris's rounding
// What       makes a few convex solids, rounds them, and renders them under a sky. It knows nothing of
//            Arris but arris/rounding.h and arris/math.h; what a host has to do is in World::trace().
// Usage      host_renderer PICTURE.ppm [RADIUS [WIDTH [SAMPLES]]]
//            host_renderer --furnace [RADIUS]: all solids white under a white sky. Every path must find
//            its way out; exits 1 if the rounding lets one into a solid.
#include <embree3/rtcore.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "arris/math.h"
#include "arris/rounding.h"

namespace {

using arris::Triangle;
using arris::Vec3d;
using arris::Vec3f;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// ---- Solids -----------------------------------------------------------------------------------

struct Mesh {
  std::vector<Vec3f> positions;
  std::vector<Triangle> triangles;
};

// A prism over a regular polygon, standing on z = place.z and narrowed by `taper` at its top.
struct PrismShape {
  int sides = 4;
  Vec3d place;
  double radius = 1;  // of the polygon's corners
  double height = 1;
  double turn = 0;
  double taper = 1;
};

Mesh make_prism(const PrismShape& shape) {
  Mesh mesh;
  const auto n = std::uint32_t(shape.sides);
  for (const double level : {0.0, 1.0}) {
    const double radius = shape.radius * (level > 0 ? shape.taper : 1);
    for (std::uint32_t i = 0; i < n; ++i) {
      const double angle = shape.turn + 2 * arris::kPi * i / n;
      mesh.positions.emplace_back(shape.place + Vec3d(radius * std::cos(angle),
                                                      radius * std::sin(angle),
                                                      level * shape.height));
    }
  }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t next = (i + 1) % n;
    mesh.triangles.push_back({i, next, n + next});
    mesh.triangles.push_back({i, n + next, n + i});
  }
  for (std::uint32_t i = 1; i + 1 < n; ++i) {
    mesh.triangles.push_back({0, i + 1, i});
    mesh.triangles.push_back({n, n + i, n + i + 1});
  }
  return mesh;
}

Mesh make_cube(Vec3d place, double edge) {
  return make_prism({.sides = 4,
                     .place = place,
                     .radius = edge / std::sqrt(2),
                     .height = edge,
                     .turn = arris::kPi / 4});
}

// ---- World: Embree's scene, and the rounding beside it -------------------------------------------

struct Object {
  Mesh mesh;
  Vec3d albedo{0.8};
  std::optional<arris::Rounding> rounding;
};

struct SurfacePoint {
  double t = 0;
  Vec3d normal;
  unsigned object = 0;
};

class World {
 public:
  explicit World(std::vector<Object> objects);

  // The nearest point of the rounded solids along the ray. A ray that leaves a convex solid never
  // meets it again: `leaving` is that object.
  std::optional<SurfacePoint> trace(const arris::Ray& ray, std::optional<unsigned> leaving) const;

  const Object& object(unsigned id) const { return objects_[id]; }

 private:
  struct DeviceDeleter {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
  };
  struct SceneDeleter {
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
  };

  std::vector<Object> objects_;
  std::unique_ptr<RTCDeviceTy, DeviceDeleter> device_{rtcNewDevice(nullptr)};
  std::unique_ptr<RTCSceneTy, SceneDeleter> scene_{rtcNewScene(device_.get())};
};

World::World(std::vector<Object> objects) : objects_(std::move(objects)) {
  rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
  for (const Object& object : objects_) {
    RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    const Mesh& mesh = object.mesh;
    void* positions =
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                sizeof(Vec3f), mesh.positions.size());
    std::copy(mesh.positions.begin(), mesh.positions.end(), static_cast<Vec3f*>(positions));
    void* triangles = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                              sizeof(Triangle), mesh.triangles.size());
    std::copy(mesh.triangles.begin(), mesh.triangles.end(), static_cast<Triangle*>(triangles));
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_.get(), geometry);
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(scene_.get());
}

// An Embree query that does not see the objects it is told to ignore.
struct FilteredQuery {
  RTCIntersectContext context;  // first: Embree hands back a pointer to it
  std::vector<unsigned> ignored;
};

void reject_ignored(const RTCFilterFunctionNArguments* arguments) {
  const auto* query = reinterpret_cast<const FilteredQuery*>(arguments->context);
  const unsigned object = RTCHitN_geomID(arguments->hit, arguments->N, 0);
  if (std::find(query->ignored.begin(), query->ignored.end(), object) != query->ignored.end()) {
    arguments->valid[0] = 0;
  }
}

RTCRayHit make_query(const arris::Ray& ray, double t_far) {
  RTCRayHit query{};
  query.ray.org_x = float(ray.origin.x);
  query.ray.org_y = float(ray.origin.y);
  query.ray.org_z = float(ray.origin.z);
  query.ray.dir_x = float(ray.direction.x);
  query.ray.dir_y = float(ray.direction.y);
  query.ray.dir_z = float(ray.direction.z);
  query.ray.tfar = float(t_far);
  query.ray.mask = ~0U;
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  return query;
}

std::optional<SurfacePoint> World::trace(const arris::Ray& ray,
                                         std::optional<unsigned> leaving) const {
  FilteredQuery filter;
  rtcInitIntersectContext(&filter.context);
  filter.context.filter = reject_ignored;
  if (leaving) {
    filter.ignored.push_back(*leaving);
  }
  std::optional<SurfacePoint> nearest;
  for (;;) {
    RTCRayHit query = make_query(ray, nearest ? nearest->t : kInfinity);
    rtcIntersect1(scene_.get(), &filter.context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
      return nearest;
    }
    const unsigned id = query.hit.geomID;
    const arris::Rounding& rounding = *objects_[id].rounding;
    const arris::MeshHit hit{query.hit.primID, query.hit.u, query.hit.v, query.ray.tfar};
    const Vec3d face_normal = rounding.face_normal(hit.triangle);
    const bool entering = arris::dot(face_normal, ray.direction) < 0;
    // 1. The hit is on the rounded solid: nothing else to do, as for most rays. (A ray that is met from
    //    inside may have started between the sharp and the rounded edge, so it is always resolved.)
    if (entering && rounding.is_kept(hit.triangle, hit.u, hit.v)) {
      return SurfacePoint{hit.t, face_normal, id};
    }
    const arris::Resolution resolution = rounding.resolve(ray, hit);
    if (resolution.outcome == arris::Resolution::Outcome::kept) {
      return SurfacePoint{hit.t, face_normal, id};
    }
    // 2. The surface is further in, on an edge's cylinder or a corner's sphere: another solid that
    //    reaches in there may still be nearer.
    if (resolution.outcome == arris::Resolution::Outcome::moved &&
        (!nearest || resolution.hit.t < nearest->t)) {
      nearest = SurfacePoint{resolution.hit.t, resolution.hit.normal, id};
    }
    // 3. Whether it has missed the solid or met it, the ray has nothing more to find there. The search
    //    starts again from the origin, so a neighbour that touches the solid is met at its surface.
    filter.ignored.push_back(id);
  }
}

// ---- Light --------------------------------------------------------------------------------------

// PCG (O'Neill 2014), one stream for each pixel.
class Random {
 public:
  explicit Random(std::uint64_t stream) : increment_(2 * stream + 1) {
    next();
    state_ += 0x853c49e6748fea9bULL;
    next();
  }
  double uniform() { return next() * 0x1p-32; }

 private:
  std::uint32_t next() {
    const std::uint64_t old = state_;
    state_ = old * 6364136223846793005ULL + increment_;
    const auto shifted = std::uint32_t(((old >> 18U) ^ old) >> 27U);
    const auto turn = std::uint32_t(old >> 59U);
    return (shifted >> turn) | (shifted << ((32U - turn) & 31U));
  }

  std::uint64_t state_ = 0;
  std::uint64_t increment_;
};

enum class Light { sky, furnace };

const Vec3d kSun = arris::normalize(Vec3d(-0.5, -0.35, 0.6));

Vec3d sky_radiance(Light light, Vec3d direction) {
  if (light == Light::furnace) {
    return Vec3d(1);
  }
  const double height = 0.5 + 0.5 * direction.z;
  return Vec3d(0.75, 0.8, 0.85) * (1 - height) + Vec3d(0.25, 0.4, 0.75) * height;
}

Vec3d sample_cosine(Vec3d normal, Random& random) {
  const double z = 1 - 2 * random.uniform();
  const double angle = 2 * arris::kPi * random.uniform();
  const double r = std::sqrt(std::max(0.0, 1 - z * z));
  const Vec3d sum = normal + Vec3d(r * std::cos(angle), r * std::sin(angle), z);
  return arris::length_squared(sum) > 1e-12 ? arris::normalize(sum) : normal;
}

struct Path {
  Vec3d radiance;
  bool escaped = false;
};

Path trace_path(const World& world, arris::Ray ray, Light light, Random& random) {
  constexpr int kMaxDepth = 1024;
  Path path;
  Vec3d throughput(1);
  std::optional<unsigned> leaving;
  for (int depth = 0; depth < kMaxDepth; ++depth) {
    const auto point = world.trace(ray, leaving);
    if (!point) {
      path.radiance += throughput * sky_radiance(light, ray.direction);
      path.escaped = true;
      return path;
    }
    const Vec3d position = ray.origin + ray.direction * point->t;
    leaving = point->object;
    throughput *= light == Light::furnace ? Vec3d(1) : world.object(point->object).albedo;
    const double cosine = arris::dot(point->normal, kSun);
    if (light == Light::sky && cosine > 0 && !world.trace({position, kSun}, leaving)) {
      path.radiance += throughput * Vec3d(1.7, 1.6, 1.4) * cosine;
    }
    ray = {position, sample_cosine(point->normal, random)};
  }
  return path;
}

// ---- Picture ------------------------------------------------------------------------------------

struct PictureSettings {
  int width_px = 640;
  int height_px = 360;
  int samples = 32;
  Light light = Light::sky;
};

struct Film {
  std::vector<Vec3d> pixels;
  std::uint64_t lost_paths = 0;
};

arris::Ray camera_ray(const PictureSettings& settings, double x_px, double y_px) {
  const Vec3d position(3.6, -6.4, 3.4), target(0.1, 0.1, 0.55);
  const Vec3d forward = arris::normalize(target - position);
  const Vec3d right = arris::normalize(arris::cross(forward, Vec3d(0, 0, 1)));
  const Vec3d up = arris::cross(right, forward);
  const double half_height = std::tan(arris::radians(17));
  const double pixel = 2 * half_height / settings.height_px;
  const Vec3d direction = forward + right * ((x_px - settings.width_px / 2.0) * pixel) -
                          up * ((y_px - settings.height_px / 2.0) * pixel);
  return {position, arris::normalize(direction)};
}

Film render(const World& world, const PictureSettings& settings) {
  Film film;
  film.pixels.resize(std::size_t(settings.width_px) * std::size_t(settings.height_px));
  std::atomic<int> next_row = 0;
  std::atomic<std::uint64_t> lost_paths = 0;
  const auto render_rows = [&] {
    for (int y = next_row++; y < settings.height_px; y = next_row++) {
      for (int x = 0; x < settings.width_px; ++x) {
        const std::size_t pixel = std::size_t(y) * std::size_t(settings.width_px) + std::size_t(x);
        Random random(pixel);
        for (int sample = 0; sample < settings.samples; ++sample) {
          const double x_px = x + random.uniform(), y_px = y + random.uniform();
          const Path path =
              trace_path(world, camera_ray(settings, x_px, y_px), settings.light, random);
          film.pixels[pixel] += path.radiance / double(settings.samples);
          lost_paths += path.escaped ? 0 : 1;
        }
      }
    }
  };
  std::vector<std::jthread> threads(std::max(1U, std::thread::hardware_concurrency()));
  for (std::jthread& thread : threads) {
    thread = std::jthread(render_rows);
  }
  threads.clear();
  film.lost_paths = lost_paths;
  return film;
}

void save_ppm(const Film& film, const PictureSettings& settings, const std::string& path) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "wb"),
                                                             &std::fclose);
  if (!file) {
    throw std::runtime_error(path + ": cannot be written");
  }
  std::fprintf(file.get(), "P6\n%d %d\n255\n", settings.width_px, settings.height_px);
  for (const Vec3d& pixel : film.pixels) {
    for (const double linear : {pixel.x, pixel.y, pixel.z}) {
      const double display = std::pow(std::min(linear, 1.0), 1 / 2.2);
      std::fputc(int(display * 255 + 0.5), file.get());
    }
  }
}

// A floor, two cubes side by side with a third on top, a hexagonal plate and a pyramid's stump, apart
// by `gap`: at 0 they touch, and the two cubes share a face.
std::vector<Object> make_objects(double radius, double gap) {
  std::vector<Object> objects;
  const auto add = [&](Mesh mesh, Vec3d albedo) {
    Object object{std::move(mesh), albedo, std::nullopt};
    object.rounding = arris::make_rounding({object.mesh.positions, object.mesh.triangles},
                                           {.radius = radius}, "solid");
    objects.push_back(std::move(object));
  };
  add(make_cube({0, 0, -8 - gap}, 8), Vec3d(0.5));
  add(make_cube({-0.5, 0, 0}, 1), {0.7, 0.25, 0.15});
  add(make_cube({0.5 + gap, 0, 0}, 1), {0.75, 0.6, 0.2});
  add(make_cube({0, 0, 1 + gap}, 0.7), {0.2, 0.35, 0.6});
  add(make_prism({.sides = 6, .place = {1.75, -0.35, 0}, .radius = 0.55, .height = 0.5}),
      {0.6, 0.6, 0.62});
  add(make_prism(
          {.sides = 5, .place = {-1.8, -0.2, 0}, .radius = 0.65, .height = 1.2, .taper = 0.4}),
      {0.25, 0.5, 0.3});
  return objects;
}

int run_furnace(double radius) {
  const PictureSettings settings{320, 180, 8, Light::furnace};
  // Well apart: in a narrow gap a path may rightly take thousands of bounces.
  const Film film = render(World(make_objects(radius, 0.2)), settings);
  const std::uint64_t paths = film.pixels.size() * std::uint64_t(settings.samples);
  std::printf("furnace: %llu of %llu paths lost\n",
              static_cast<unsigned long long>(film.lost_paths),
              static_cast<unsigned long long>(paths));
  return film.lost_paths == 0 ? 0 : 1;
}

int run(const std::vector<std::string>& arguments) {
  const auto number = [&](std::size_t at, double otherwise) {
    return at < arguments.size() ? std::stod(arguments[at]) : otherwise;
  };
  if (arguments.empty()) {
    std::fputs("usage: host_renderer PICTURE.ppm|--furnace [RADIUS [WIDTH [SAMPLES]]]\n", stderr);
    return 2;
  }
  const double radius = number(1, 0.08);
  if (arguments[0] == "--furnace") {
    return run_furnace(radius);
  }
  PictureSettings settings;
  settings.width_px = int(number(2, 640));
  settings.height_px = settings.width_px * 9 / 16;
  settings.samples = int(number(3, 32));
  save_ppm(render(World(make_objects(radius, 0)), settings), settings, arguments[0]);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    std::fprintf(stderr, "host_renderer: %s\n", error.what());
    return 1;
  }
}
