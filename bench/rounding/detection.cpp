#include "rounding/detection.h"

#include <embree3/rtcore.h>
#include <fmt/format.h>
#include <chrono>
#include <cmath>
#include <memory>
#include <random>

#include "arris/rounding.h"
#include "interleaved.h"

namespace arris::bench {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

struct ObjectHit {
  std::uint32_t object = 0;
  Ray ray;
  MeshHit hit;
};

using DeviceHandle = std::unique_ptr<RTCDeviceTy, decltype(&rtcReleaseDevice)>;
using SceneHandle = std::unique_ptr<RTCSceneTy, decltype(&rtcReleaseScene)>;

// One geometry for each object. Precondition: objects are not transformed.
SceneHandle build_scene(RTCDevice device, const Scene& scene) {
  SceneHandle built(rtcNewScene(device), rtcReleaseScene);
  for (const Object& object : scene.objects) {
    const Mesh& mesh = scene.meshes[object.mesh.index];
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* positions = static_cast<Vec3f*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                sizeof(Vec3f), mesh.positions.size()));
    std::copy(mesh.positions.begin(), mesh.positions.end(), positions);
    auto* triangles = static_cast<Triangle*>(
        rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                sizeof(Triangle), mesh.triangles.size()));
    std::copy(mesh.triangles.begin(), mesh.triangles.end(), triangles);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(built.get(), geometry);
    rtcReleaseGeometry(geometry);
  }
  rtcCommitScene(built.get());
  return built;
}

std::optional<ObjectHit> intersect(RTCScene scene, Vec3d origin, Vec3d direction, Vec3d& normal) {
  RTCRayHit query{};
  const Vec3f o(origin), d(direction);
  query.ray = {o.x, o.y, o.z, 1e-4F, d.x, d.y, d.z, 0, std::numeric_limits<float>::infinity(),
               ~0U, 0,   0};
  query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &query);
  if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  normal = normalize(Vec3d(query.hit.Ng_x, query.hit.Ng_y, query.hit.Ng_z));
  return ObjectHit{query.hit.geomID,
                   {Vec3d(o), Vec3d(d)},
                   {query.hit.primID, query.hit.u, query.hit.v, query.ray.tfar}};
}

// One camera ray for each pixel and one diffuse bounce from its hit, in scanline order as a renderer meets them.
std::vector<ObjectHit> collect_hits(const Scene& scene, const TableOptions& options) {
  const DeviceHandle device(rtcNewDevice(nullptr), rtcReleaseDevice);
  const SceneHandle built = build_scene(device.get(), scene);
  const Camera& camera = *scene.camera;
  const Vec3d forward = normalize(camera.target - camera.position);
  const Vec3d right = normalize(cross(forward, camera.up)), up = cross(right, forward);
  const double half = std::tan(radians(camera.fov_deg) / 2);
  std::mt19937_64 engine(1);
  const auto uniform = [&] { return double(engine() >> 11) * 0x1p-53; };
  std::vector<ObjectHit> hits;
  for (int y = 0; y < options.height_px; ++y)
    for (int x = 0; x < options.width_px; ++x) {
      const double px = (2 * (x + uniform()) - options.width_px) / options.height_px * half;
      const double py = (1 - 2 * (y + uniform()) / options.height_px) * half;
      Vec3d normal;
      const auto first = intersect(built.get(), camera.position,
                                   normalize(forward + right * px + up * py), normal);
      if (!first) continue;
      hits.push_back(*first);
      const Vec3d at = first->ray.origin + first->ray.direction * first->hit.t;
      if (dot(normal, first->ray.direction) > 0) normal = -normal;
      const double z = 1 - 2 * uniform(), angle = 2 * kPi * uniform(), r = std::sqrt(1 - z * z);
      const Vec3d bounce =
          normalize(normal * (1 + 1e-6) + Vec3d(r * std::cos(angle), r * std::sin(angle), z));
      if (const auto second = intersect(built.get(), at + normal * 1e-4, bounce, normal))
        hits.push_back(*second);
    }
  return hits;
}

double radius_of(const Scene& scene, const Object& object) {
  const auto& settings = object.rounding ? object.rounding : scene.rounding;
  if (!settings || settings->method == RoundMethod::none) return 0;
  return std::get<double>(settings->radius);
}

// Index by object; empty where an object is not rounded.
using Roundings = std::vector<std::unique_ptr<Rounding>>;

Roundings build_roundings(const Scene& scene, Detection detection, DetectionResult& result) {
  Roundings roundings(scene.objects.size());
  const auto start = Clock::now();
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    RoundingOptions options;
    options.radius = radius_of(scene, scene.objects[i]);
    options.detection = detection;
    if (options.radius == 0) continue;
    const Mesh& mesh = scene.meshes[scene.objects[i].mesh.index];
    roundings[i] = std::make_unique<Rounding>(
        make_rounding({mesh.positions, mesh.triangles}, options, scene.objects[i].name));
  }
  result.build_seconds = seconds_since(start);
  for (const auto& rounding : roundings)
    if (rounding) result.bytes += rounding->report().bytes;
  return roundings;
}

struct Outcomes {
  std::size_t kept = 0, moved = 0, passed = 0;
};

Outcomes resolve_all(const std::vector<ObjectHit>& hits, const Roundings& roundings) {
  Outcomes outcomes;
  for (const ObjectHit& h : hits) {
    const Rounding& rounding = *roundings[h.object];
    if (rounding.is_kept(h.hit.triangle, h.hit.u, h.hit.v)) {
      ++outcomes.kept;
      continue;
    }
    switch (rounding.resolve(h.ray, h.hit).outcome) {
      case Resolution::Outcome::kept:
        ++outcomes.kept;
        break;
      case Resolution::Outcome::moved:
        ++outcomes.moved;
        break;
      case Resolution::Outcome::passed:
        ++outcomes.passed;
        break;
    }
  }
  return outcomes;
}

}  // namespace

std::vector<DetectionResult> compare_detection(const BenchScene& bench,
                                               const TableOptions& options) {
  std::vector<DetectionResult> results{{.name = "index by face"}, {.name = "kd-tree"}};
  std::vector<Roundings> modes;
  modes.push_back(build_roundings(bench.scene, Detection::face_index, results[0]));
  modes.push_back(build_roundings(bench.scene, Detection::kd_tree, results[1]));
  std::vector<ObjectHit> hits = collect_hits(bench.scene, options);
  std::erase_if(hits, [&](const ObjectHit& h) { return !modes[0][h.object]; });
  std::vector<ObjectHit> kept = hits;
  std::erase_if(kept, [&](const ObjectHit& h) {
    return !modes[0][h.object]->is_kept(h.hit.triangle, h.hit.u, h.hit.v);
  });
  std::vector<std::vector<double>> all(modes.size()), kept_only(modes.size());
  for (int round = 0; round < options.rounds; ++round)
    for (std::size_t k = 0; k < modes.size(); ++k) {
      const std::size_t i = round % 2 == 0 ? k : modes.size() - 1 - k;
      auto start = Clock::now();
      const Outcomes outcomes = resolve_all(hits, modes[i]);
      all[i].push_back(seconds_since(start) / double(hits.size()) * 1e9);
      start = Clock::now();
      resolve_all(kept, modes[i]);
      kept_only[i].push_back(seconds_since(start) / double(kept.size()) * 1e9);
      results[i].moved = double(outcomes.moved) / double(hits.size());
      results[i].passed = double(outcomes.passed) / double(hits.size());
    }
  for (std::size_t i = 0; i < modes.size(); ++i) {
    results[i].ns_per_hit = median(all[i]);
    results[i].ns_per_kept_hit = median(kept_only[i]);
  }
  return results;
}

std::string text_of(const std::vector<DetectionResult>& results) {
  std::string text =
      fmt::format("  {:<16}{:>10}{:>12}{:>10}{:>14}{:>10}{:>10}\n", "detection", "build s",
                  "rounding MB", "ns/hit", "ns/kept hit", "moved %", "passed %");
  for (const DetectionResult& r : results)
    text += fmt::format("  {:<16}{:>10.3f}{:>12.2f}{:>10.1f}{:>14.1f}{:>10.2f}{:>10.2f}\n", r.name,
                        r.build_seconds, double(r.bytes) / 1e6, r.ns_per_hit, r.ns_per_kept_hit,
                        100 * r.moved, 100 * r.passed);
  return text;
}

}  // namespace arris::bench
