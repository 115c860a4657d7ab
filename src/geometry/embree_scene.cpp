#include "geometry/embree_scene.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <limits>
#include <numeric>
#include <string>

#include "arris/error.h"
#include "base/happens_before.h"
#include "base/parallel_for.h"

namespace arris {

namespace {

// The callbacks of Embree's threads see what was written before the build.
struct BoxUser : BoxGeometry {
  HappensBefore written;
};

}  // namespace

struct EmbreeScene::Device {
  RTCDevice handle = nullptr;
  RTCScene top = nullptr;
  std::vector<RTCScene> mesh_scenes;  // per mesh; null where the mesh is not instanced
  std::vector<BoxUser> box_users;     // the addresses stay
  std::atomic<std::int64_t> bytes{0};
  HappensBefore created, counted;  // Embree's threads call back

  explicit Device(int threads) {
    const std::string config =
        threads > 0 ? "threads=" + std::to_string(usable_threads(threads)) : std::string();
    handle = rtcNewDevice(config.c_str());
    if (handle == nullptr) {
      throw Error(Error::Kind::failed, "",
                  "Embree cannot start (error " + std::to_string(int(rtcGetDeviceError(nullptr))) +
                      "): it needs an x86-64 processor with SSE2");
    }
    created.release();
    rtcSetDeviceMemoryMonitorFunction(
        handle,
        [](void* user, ssize_t change, bool) {
          auto* device = static_cast<Device*>(user);
          device->created.acquire();
          device->bytes += change;
          device->counted.release();
          return true;
        },
        this);
  }
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  ~Device() {
    if (top != nullptr) {
      rtcReleaseScene(top);
    }
    for (RTCScene scene : mesh_scenes) {
      if (scene != nullptr) {
        rtcReleaseScene(scene);
      }
    }
    rtcReleaseDevice(handle);
    counted.acquire();
  }
};

namespace {

// A point made from barycentric weights and float vertices is off the triangle's plane by a rounding of
// each coordinate; the ray kernel rounds differences and products of coordinates of that size a few times.
constexpr float kRoundings = 8;

RTCScene make_scene(RTCDevice device) {
  RTCScene scene = rtcNewScene(device);
  rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
  rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_MEDIUM);
  return scene;
}

void commit(RTCDevice device, RTCScene scene) {
  rtcCommitScene(scene);
  if (const RTCError error = rtcGetDeviceError(device); error != RTC_ERROR_NONE) {
    throw Error(
        Error::Kind::failed, "",
        error == RTC_ERROR_OUT_OF_MEMORY
            ? std::string("not enough memory for the acceleration structure; use fewer triangles")
            : "Embree reports error " + std::to_string(int(error)) + " while building");
  }
}

struct Attached {
  unsigned id = 0;
  const Vec3f* positions = nullptr;
};

// The vertices are copied into Embree's own, padded memory; the indices are shared with the mesh.
Attached attach_triangles(RTCDevice device, RTCScene scene, const Mesh& mesh,
                          const Affine3d& placed_from_object) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<Vec3f*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0,
                                                               RTC_FORMAT_FLOAT3, sizeof(Vec3f),
                                                               mesh.positions.size()));
  if (vertices == nullptr) {
    rtcReleaseGeometry(geometry);
    throw Error(Error::Kind::failed, "mesh \"" + mesh.name + "\"",
                "not enough memory for " + std::to_string(mesh.positions.size()) + " vertices");
  }
  if (placed_from_object == Affine3d{}) {
    std::copy(mesh.positions.begin(), mesh.positions.end(), vertices);
  } else {
    std::transform(mesh.positions.begin(), mesh.positions.end(), vertices,
                   [&](Vec3f p) { return Vec3f(transform_point(placed_from_object, Vec3d(p))); });
  }
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                             mesh.triangles.data(), 0, sizeof(Triangle), mesh.triangles.size());
  rtcCommitGeometry(geometry);
  const unsigned id = rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  return {id, vertices};
}

unsigned attach_instance(RTCDevice device, RTCScene scene, RTCScene instanced, const Affine3d& m) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
  rtcSetGeometryInstancedScene(geometry, instanced);
  const Vec3f x(m.linear.x), y(m.linear.y), z(m.linear.z), t(m.translation);
  const float columns[12] = {x.x, x.y, x.z, y.x, y.y, y.z, z.x, z.y, z.z, t.x, t.y, t.z};
  rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
  rtcCommitGeometry(geometry);
  const unsigned id = rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  return id;
}

void box_bounds(const RTCBoundsFunctionArguments* args) {
  auto* user = static_cast<BoxUser*>(static_cast<BoxGeometry*>(args->geometryUserPtr));
  user->written.acquire();
  const Box3f& box = user->boxes[args->primID];
  RTCBounds* bounds = args->bounds_o;
  bounds->lower_x = box.lower.x;
  bounds->lower_y = box.lower.y;
  bounds->lower_z = box.lower.z;
  bounds->upper_x = box.upper.x;
  bounds->upper_y = box.upper.y;
  bounds->upper_z = box.upper.z;
}

unsigned attach_boxes(RTCDevice device, RTCScene scene, BoxUser& boxes) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, unsigned(boxes.boxes.size()));
  rtcSetGeometryUserData(geometry, static_cast<BoxGeometry*>(&boxes));
  rtcSetGeometryBoundsFunction(geometry, box_bounds, nullptr);
  rtcSetGeometryIntersectFunction(geometry, boxes.intersect);
  rtcSetGeometryOccludedFunction(geometry, boxes.occluded);
  rtcCommitGeometry(geometry);
  const unsigned id = rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  return id;
}

// Which meshes become instances: those whose copies cost most, until the rest fits the bound.
std::vector<bool> choose_instanced(const Scene& scene, std::uint64_t max_copied_triangles) {
  std::vector<std::uint64_t> copied(scene.meshes.size());
  std::vector<bool> used(scene.meshes.size());
  for (const Object& object : scene.objects) {
    if (object.csg) continue;
    const std::uint32_t mesh = object.mesh.index;
    copied[mesh] += used[mesh] ? scene.meshes[mesh].triangles.size() : 0;
    used[mesh] = true;
  }
  std::vector<std::size_t> order(copied.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return copied[a] < copied[b]; });
  std::vector<bool> instanced(copied.size());
  std::uint64_t total = 0;
  for (const std::size_t mesh : order) {
    total += copied[mesh];
    instanced[mesh] = total > max_copied_triangles;
  }
  return instanced;
}

double largest_coordinate(const Mesh& mesh, const Affine3d& m) {
  double largest = 0;
  for (const Vec3f& p : mesh.positions) {
    const Vec3d q = transform_point(m, Vec3d(p));
    largest = std::max({largest, std::abs(q.x), std::abs(q.y), std::abs(q.z)});
  }
  return largest;
}

// An instance adds the rounding of the ray into object space, in object units, where the object-space ray
// origin is as far out as the world origin seen from there.
double instance_coordinate(const Mesh& mesh, const Affine3d& m) {
  const double object_size = largest_coordinate(mesh, {});
  const Vec3d from_origin = transform_point(inverse(m), Vec3d());
  const double stretch = std::sqrt(length_squared(m.linear.x) + length_squared(m.linear.y) +
                                   length_squared(m.linear.z));
  return largest_coordinate(mesh, m) + stretch * (object_size + length(from_origin));
}

GeometryRecord make_record(const Scene& scene, ObjectId id) {
  const Object& object = scene.objects[id.index];
  const Mesh& mesh = scene.meshes[object.mesh.index];
  GeometryRecord record;
  record.triangles = mesh.triangles.data();
  record.normals = mesh.normals.empty() ? nullptr : mesh.normals.data();
  record.uvs = mesh.uvs.empty() ? nullptr : mesh.uvs.data();
  record.triangle_materials =
      mesh.triangle_materials.empty() ? nullptr : mesh.triangle_materials.data();
  record.object = id;
  record.mesh = object.mesh;
  record.material = object.material;
  record.triangle_count = std::uint32_t(mesh.triangles.size());
  record.orientation = determinant(object.world_from_object.linear) < 0 ? -1.0F : 1.0F;
  const Mat3d normal = transpose(inverse(object.world_from_object.linear));
  record.normal_from_object = {Vec3f(normal.x), Vec3f(normal.y), Vec3f(normal.z)};
  return record;
}

GeometryRecord make_box_record(const Scene& scene, const BoxGeometry& boxes) {
  float coordinate = 0;
  for (const Box3f& box : boxes.boxes) {
    coordinate = std::max({coordinate, max_component(box.upper), max_component(-box.lower)});
  }
  GeometryRecord record;
  record.object = boxes.object;
  record.material = scene.objects[boxes.object.index].material;
  record.position_error = kRoundings * std::numeric_limits<float>::epsilon() / 2 * coordinate;
  return record;
}

}  // namespace

EmbreeScene::EmbreeScene(const Scene& scene, const EmbreeSceneOptions& options,
                         std::vector<BoxGeometry> boxes)
    : device_(std::make_unique<Device>(options.threads)) {
  const std::vector<bool> instanced = choose_instanced(scene, options.max_copied_triangles);
  device_->mesh_scenes.resize(scene.meshes.size());
  RTCScene top = make_scene(device_->handle);
  device_->top = top;
  handle_ = top;
  records_.reserve(scene.objects.size());
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    if (object.csg || scene.meshes[object.mesh.index].triangles.empty()) {
      continue;
    }
    const Mesh& mesh = scene.meshes[object.mesh.index];
    GeometryRecord record = make_record(scene, ObjectId{i});
    record.instanced = instanced[object.mesh.index];
    double coordinate = 0;
    unsigned id = 0;
    if (record.instanced) {
      RTCScene& mesh_scene = device_->mesh_scenes[object.mesh.index];
      if (mesh_scene == nullptr) {
        mesh_scene = make_scene(device_->handle);
        attach_triangles(device_->handle, mesh_scene, mesh, {});
        commit(device_->handle, mesh_scene);
      }
      id = attach_instance(device_->handle, top, mesh_scene, object.world_from_object);
      record.positions = mesh.positions.data();
      coordinate = instance_coordinate(mesh, object.world_from_object);
    } else {
      const Attached attached =
          attach_triangles(device_->handle, top, mesh, object.world_from_object);
      id = attached.id;
      record.positions = attached.positions;
      coordinate = largest_coordinate(mesh, object.world_from_object);
    }
    record.position_error =
        float(kRoundings * std::numeric_limits<float>::epsilon() / 2 * coordinate);
    records_.resize(std::max<std::size_t>(records_.size(), id + 1));
    records_[id] = record;
  }
  device_->box_users.resize(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    BoxUser& user = device_->box_users[i];
    static_cast<BoxGeometry&>(user) = std::move(boxes[i]);
    user.written.release();
    const unsigned id = attach_boxes(device_->handle, top, user);
    box_records_.push_back(id);
    records_.resize(std::max<std::size_t>(records_.size(), id + 1));
    records_[id] = make_box_record(scene, user);
  }
  commit(device_->handle, top);
}

EmbreeScene::~EmbreeScene() = default;

std::uint64_t EmbreeScene::bytes() const {
  const std::int64_t bytes = device_->bytes;
  return bytes > 0 ? std::uint64_t(bytes) : 0;
}

}  // namespace arris
