// host_renderer — a small path tracer over Embree that hosts Arris's rounding
// What       makes a few solids, rounds them, and renders them under a sky. It knows nothing of Arris but
//            arris/rounding.h and arris/math.h; what a host has to do is in World::trace().
// Usage      host_renderer PICTURE.ppm [RADIUS [WIDTH [SAMPLES]]] [--edges convex|concave|both] [--vary]
//            host_renderer --furnace [RADIUS] [--edges …] [--vary]: all solids white under a white sky. Every path
//            must find its way out; exits 1 if the rounding lets one into a solid.
//            --vary: edges on the ground stay sharp, concave ones and those that lie high up have radii of their
//            own. What could not be rounded as asked is printed.
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

using arris::Feature;
using arris::RayStart;
using arris::Resolution;
using arris::RoundEdges;
using arris::Triangle;
using arris::Vec3d;
using arris::Vec3f;
using Outcome = arris::Resolution::Outcome;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// ---- Solids -----------------------------------------------------------------------------------

struct Mesh {
  std::vector<Vec3f> positions;
  std::vector<Triangle> triangles;
};

using Ring = std::vector<Vec3d>;  // counter-clockwise from above

// The solid whose walls join each ring with the next one above it, or within it at the same height. The first and the
// last must be seen as a whole from their first corner.
Mesh make_solid(const std::vector<Ring>& rings) {
  Mesh mesh;
  const auto n = std::uint32_t(rings[0].size());
  for (const Ring& ring : rings) {
    for (const Vec3d& corner : ring) {
      mesh.positions.emplace_back(corner);
    }
  }
  const auto top = std::uint32_t(n * (rings.size() - 1));
  for (std::uint32_t ring = 0; ring < top; ring += n) {
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t a = ring + i, b = ring + (i + 1) % n;
      mesh.triangles.push_back({a, b, n + b});
      mesh.triangles.push_back({a, n + b, n + a});
    }
  }
  for (std::uint32_t i = 1; i + 1 < n; ++i) {
    mesh.triangles.push_back({0, i + 1, i});
    mesh.triangles.push_back({top, top + i, top + i + 1});
  }
  return mesh;
}

Ring make_polygon(int sides, Vec3d center, double radius, double turn = 0) {
  Ring ring;
  for (int i = 0; i < sides; ++i) {
    const double angle = turn + 2 * arris::kPi * i / sides;
    ring.push_back(center + Vec3d(radius * std::cos(angle), radius * std::sin(angle), 0));
  }
  return ring;
}

Ring make_square(Vec3d center, double edge) {
  return make_polygon(4, center, edge / std::sqrt(2), arris::kPi / 4);
}

Mesh make_cube(Vec3d place, double edge) {
  return make_solid({make_square(place, edge), make_square(place + Vec3d(0, 0, edge), edge)});
}

// Two walls that meet at a right angle; their inner, concave edge ends at the rim of the faces above and below.
Mesh make_bracket(Vec3d place, double leg, double thickness, double height) {
  const double t = thickness;
  std::vector<Ring> rings;
  for (const double z : {0.0, height}) {
    Ring ring{{t, t, z}, {t, leg, z}, {0, leg, z}, {0, 0, z}, {leg, 0, z}, {leg, t, z}};
    for (Vec3d& corner : ring) {
      corner = place + Vec3d(-corner.y, -corner.x, corner.z);  // opens towards the camera
    }
    std::reverse(ring.begin() + 1, ring.end());
    rings.push_back(ring);
  }
  return make_solid(rings);
}

// A plate with a block on it: around its foot runs a concave edge.
Mesh make_boss(Vec3d place) {
  const Vec3d foot = place + Vec3d(0, 0, 0.25);
  return make_solid({make_square(place, 1.1), make_square(foot, 1.1), make_square(foot, 0.5),
                     make_square(foot + Vec3d(0, 0, 0.4), 0.5)});
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

  // The nearest point of the rounded solids along a ray that starts outside of them all; `leaving` is
  // the object on whose surface it starts.
  std::optional<SurfacePoint> trace(const arris::Ray& ray, std::optional<unsigned> leaving) const;

  const Object& object(unsigned id) const { return objects_[id]; }

 private:
  std::optional<SurfacePoint> trace_meshes(const arris::Ray& ray,
                                           std::optional<unsigned> leaving) const;

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

constexpr unsigned kWhole = ~0U;

// What a query is not to see: a triangle of an object, or the object as a whole.
struct Ignored {
  unsigned object;
  unsigned triangle = kWhole;
};

struct FilteredQuery {
  RTCIntersectContext context;  // first: Embree hands back a pointer to it
  std::vector<Ignored> ignored;
};

void reject_ignored(const RTCFilterFunctionNArguments* arguments) {
  const auto* query = reinterpret_cast<const FilteredQuery*>(arguments->context);
  const unsigned object = RTCHitN_geomID(arguments->hit, arguments->N, 0);
  const unsigned triangle = RTCHitN_primID(arguments->hit, arguments->N, 0);
  for (const Ignored& each : query->ignored) {
    if (each.object == object && (each.triangle == kWhole || each.triangle == triangle)) {
      arguments->valid[0] = 0;
    }
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

// All rays of this host start outside. Of the solid that a ray leaves the kernel has to know it: the ray may start in
// the void between the sharp and the rounded edge, or on a fillet, and rounding errors may put it on either side.
RayStart start_of(unsigned object, std::optional<unsigned> leaving) {
  return object == leaving ? RayStart::outside : RayStart::unknown;
}

std::optional<SurfacePoint> World::trace_meshes(const arris::Ray& ray,
                                                std::optional<unsigned> leaving) const {
  FilteredQuery filter;
  rtcInitIntersectContext(&filter.context);
  filter.context.filter = reject_ignored;
  // A ray that leaves a convex solid never meets it again.
  if (leaving && objects_[*leaving].rounding->is_exact(0)) {
    filter.ignored.push_back({*leaving});
  }
  std::optional<SurfacePoint> nearest;
  std::optional<SurfacePoint> entry;  // where the ray has passed into a solid
  for (;;) {
    RTCRayHit query = make_query(ray, nearest ? nearest->t : kInfinity);
    rtcIntersect1(scene_.get(), &filter.context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) {
      return nearest;
    }
    const unsigned id = query.hit.geomID;
    const arris::Rounding& rounding = *objects_[id].rounding;
    const arris::MeshHit hit{query.hit.primID, query.hit.u, query.hit.v, query.ray.tfar};
    const SurfacePoint sharp{hit.t, rounding.face_normal(hit.triangle), id};
    const bool entering = arris::dot(sharp.normal, ray.direction) < 0;
    // 1. The hit is on the rounded solid: nothing else to do, as for most rays. (A ray that is met from
    //    inside may have started between the sharp and the rounded edge, so it is always resolved.)
    if (entering && rounding.is_kept(hit.triangle, hit.u, hit.v)) {
      return sharp;
    }
    const Resolution resolution = rounding.resolve(ray, hit, start_of(id, leaving));
    const bool moves = resolution.outcome == Outcome::moved;
    const SurfacePoint surface =
        moves ? SurfacePoint{resolution.hit.t, resolution.hit.normal, id} : sharp;
    // 2. Where rounding has no surface though the ray has crossed material, the sharp face stands instead of a hole.
    const bool passes = resolution.outcome == Outcome::passed;
    if (!entering && !passes && entry && entry->object == id) {
      return entry;
    }
    // 3. The hit stands after all; or the surface is on a fillet before the hit, or further in, on an edge's cylinder
    //    or a corner's sphere: another solid that reaches in there may still be nearer. The search starts again from
    //    the origin, so a neighbour that touches the solid is met at its surface. A surface that the ray leaves is the
    //    one where it starts, on the wrong side by rounding errors, as all rays come from outside.
    const bool leaves = arris::dot(surface.normal, ray.direction) > 0;
    if (!passes && !leaves) {
      if (!moves) {
        return sharp;
      }
      if (!nearest || surface.t < nearest->t) {
        nearest = surface;
      }
      filter.ignored.push_back({id});
      continue;
    }
    // 4. The ray misses the solid here. Of a convex one it has nothing more to find; one with concave edges it may meet
    //    again. A border between solid and fillet is crossed within material, and tells nothing of holes.
    const bool is_exact = rounding.is_exact(rounding.solid_of(hit.triangle));
    filter.ignored.push_back({id, is_exact ? kWhole : hit.triangle});
    if (entering && !is_exact && resolution.hit.feature != Feature::fillet) {
      entry = sharp;
    }
  }
}

bool meets_box(const arris::Ray& ray, const arris::Rounding::FilletBox& box, double t_max) {
  double near = 0, far = t_max;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (box.low[axis] - ray.origin[axis]) / ray.direction[axis];
    const double b = (box.high[axis] - ray.origin[axis]) / ray.direction[axis];
    near = std::max(near, std::min(a, b));
    far = std::min(far, std::max(a, b));
  }
  return near <= far;
}

std::optional<SurfacePoint> World::trace(const arris::Ray& ray,
                                         std::optional<unsigned> leaving) const {
  std::optional<SurfacePoint> nearest = trace_meshes(ray, leaving);
  // Where a fillet runs out at the rim of a face, a ray may meet it and miss the mesh. There are few boxes here; a host
  // of many has them in its tree, as user geometry.
  for (unsigned id = 0; id < objects_.size(); ++id) {
    const auto boxes = objects_[id].rounding->fillet_boxes();
    for (std::uint32_t box = 0; box < boxes.size(); ++box) {
      const double end = nearest ? nearest->t : kInfinity;
      if (!meets_box(ray, boxes[box], end)) {
        continue;
      }
      const auto met = objects_[id].rounding->meet_fillet(box, ray, 0, end, start_of(id, leaving));
      if (met) {
        nearest = SurfacePoint{met->t, met->normal, id};
      }
    }
  }
  return nearest;
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

struct Rounded {
  double radius = 0.08;
  RoundEdges edges = RoundEdges::convex;
  bool is_varied = false;
};

// The last rule that an edge matches gives its radius.
arris::RoundingOptions options_of(const Rounded& rounded) {
  arris::RoundingOptions options;
  options.radius = rounded.radius;
  options.edges = rounded.edges;
  if (!rounded.is_varied) {
    return options;
  }
  constexpr double kFar = 100;
  arris::EdgeRule ground, concave, high;
  ground.radius = 0;
  ground.kind = RoundEdges::convex;
  ground.box = {Vec3d(-kFar, -kFar, -1e-3), Vec3d(kFar, kFar, 1e-3)};
  concave.radius = 0.75 * rounded.radius;
  concave.kind = RoundEdges::concave;
  high.radius = 1.5 * rounded.radius;
  high.box = {Vec3d(-kFar, -kFar, 0.9), Vec3d(kFar, kFar, kFar)};
  options.rules = {ground, concave, high};
  // Edges without room get a smaller radius instead of staying sharp.
  options.on_overlap = arris::OnOverlap::clamp;
  return options;
}

void print_report(const arris::RoundingReport& report, const std::string& name) {
  for (const arris::RoundingNote& note : report.notes) {
    std::fprintf(stderr, "%s: %s\n", name.c_str(), note.text().c_str());
  }
  for (const arris::ClampedEdge& edge : report.clamped) {
    std::fprintf(stderr, "%s: %g,%g,%g to %g,%g,%g: radius %g\n", name.c_str(), edge.from.x,
                 edge.from.y, edge.from.z, edge.to.x, edge.to.y, edge.to.z, edge.radius);
  }
}

// A floor, two cubes side by side with a third on top, a hexagonal plate and a pyramid's stump, a bracket and a plate
// with a boss, apart by `gap`: at 0 they touch, and the two cubes share a face.
std::vector<Object> make_objects(const Rounded& rounded, double gap) {
  std::vector<Object> objects;
  const auto add = [&](const char* name, Mesh mesh, Vec3d albedo) {
    Object object{std::move(mesh), albedo, std::nullopt};
    object.rounding = arris::make_rounding({object.mesh.positions, object.mesh.triangles},
                                           options_of(rounded), name);
    print_report(object.rounding->report(), name);
    objects.push_back(std::move(object));
  };
  add("ground", make_cube({0, 0, -8 - gap}, 8), Vec3d(0.5));
  add("left cube", make_cube({-0.5, 0, 0}, 1), {0.7, 0.25, 0.15});
  add("right cube", make_cube({0.5 + gap, 0, 0}, 1), {0.75, 0.6, 0.2});
  add("upper cube", make_cube({0, 0, 1 + gap}, 0.7), {0.2, 0.35, 0.6});
  add("plate",
      make_solid(
          {make_polygon(6, {1.75, -0.35, 0}, 0.55), make_polygon(6, {1.75, -0.35, 0.5}, 0.55)}),
      {0.6, 0.6, 0.62});
  add("stump",
      make_solid(
          {make_polygon(5, {-1.8, -0.2, 0}, 0.65), make_polygon(5, {-1.8, -0.2, 1.2}, 0.26)}),
      {0.25, 0.5, 0.3});
  add("bracket", make_bracket({-0.35, -0.8, 0}, 0.9, 0.25, 0.45), {0.55, 0.45, 0.6});
  add("boss", make_boss({1.1, -1.55, 0}), {0.6, 0.5, 0.4});
  return objects;
}

int run_furnace(const Rounded& rounded) {
  const PictureSettings settings{320, 180, 8, Light::furnace};
  // Well apart: in a narrow gap a path may rightly take thousands of bounces.
  const Film film = render(World(make_objects(rounded, 0.2)), settings);
  const std::uint64_t paths = film.pixels.size() * std::uint64_t(settings.samples);
  std::printf("furnace: %llu of %llu paths lost\n",
              static_cast<unsigned long long>(film.lost_paths),
              static_cast<unsigned long long>(paths));
  return film.lost_paths == 0 ? 0 : 1;
}

RoundEdges parse_edges(const std::string& word) {
  if (word == "convex") return RoundEdges::convex;
  if (word == "concave") return RoundEdges::concave;
  if (word == "both") return RoundEdges::both;
  throw std::invalid_argument("--edges: \"" + word + "\" is neither convex, concave nor both");
}

int run(std::vector<std::string> arguments) {
  Rounded rounded;
  const auto option = std::find(arguments.begin(), arguments.end(), "--edges");
  if (arguments.end() - option >= 2) {
    rounded.edges = parse_edges(option[1]);
    arguments.erase(option, option + 2);
  }
  rounded.is_varied = std::erase(arguments, "--vary") > 0;
  const auto number = [&](std::size_t at, double otherwise) {
    if (at >= arguments.size()) {
      return otherwise;
    }
    char* end = nullptr;
    const double value = std::strtod(arguments[at].c_str(), &end);
    if (*end != '\0' || !(value > 0)) {
      throw std::invalid_argument('"' + arguments[at] + "\" is no positive number");
    }
    return value;
  };
  if (arguments.empty()) {
    std::fputs(
        "usage: host_renderer PICTURE.ppm|--furnace [RADIUS [WIDTH [SAMPLES]]] "
        "[--edges convex|concave|both] [--vary]\n",
        stderr);
    return 2;
  }
  rounded.radius = number(1, rounded.radius);
  if (arguments[0] == "--furnace") {
    return run_furnace(rounded);
  }
  PictureSettings settings;
  settings.width_px = int(number(2, 640));
  settings.height_px = settings.width_px * 9 / 16;
  settings.samples = int(number(3, 32));
  save_ppm(render(World(make_objects(rounded, 0)), settings), settings, arguments[0]);
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
