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

// Scenes share it; the last one ends it.
class EmbreeScene::Device : public std::enable_shared_from_this<Device> {
 public:
  explicit Device(int threads) {
    const std::string config =
        threads > 0 ? "threads=" + std::to_string(usable_threads(threads)) : std::string();
    handle_ = rtcNewDevice(config.c_str());
    if (handle_ == nullptr) {
      throw Error(Error::Kind::failed, "",
                  "Embree cannot start (error " + std::to_string(int(rtcGetDeviceError(nullptr))) +
                      "): it needs an x86-64 processor with SSE2");
    }
    created_.release();
    rtcSetDeviceMemoryMonitorFunction(
        handle_,
        [](void* user, ssize_t change, bool) {
          auto* device = static_cast<Device*>(user);
          device->created_.acquire();
          device->bytes_ += change;
          device->counted_.release();
          return true;
        },
        this);
  }
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  ~Device() {
    rtcReleaseDevice(handle_);
    counted_.acquire();
  }

  [[nodiscard]] RTCDevice handle() const { return handle_; }
  [[nodiscard]] std::int64_t bytes() const { return bytes_; }

  // Memory is counted until the last of them has gone: they keep the device.
  SceneHandle make_scene() {
    RTCScene scene = rtcNewScene(handle_);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_MEDIUM);
    return {scene, [self = shared_from_this()](RTCScene s) { rtcReleaseScene(s); }};
  }

 private:
  RTCDevice handle_ = nullptr;
  std::atomic<std::int64_t> bytes_{0};
  HappensBefore created_, counted_;  // Embree's threads call back
};

// The callbacks of Embree's threads see what was written before the build.
struct EmbreeScene::Boxes : BoxGeometry {
  HappensBefore written;
  SceneHandle scene;  // null: in the top one
};

namespace {

// A point made from barycentric weights and float vertices is off the triangle's plane by a rounding of
// each coordinate; the ray kernel rounds differences and products of coordinates of that size a few times.
constexpr float kRoundings = 8;

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

template <class Boxes>
void box_bounds(const RTCBoundsFunctionArguments* args) {
  auto* user = static_cast<Boxes*>(static_cast<BoxGeometry*>(args->geometryUserPtr));
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

template <class Boxes>
unsigned attach_box_geometry(RTCDevice device, RTCScene scene, Boxes& boxes) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, unsigned(boxes.boxes.size()));
  rtcSetGeometryUserData(geometry, static_cast<BoxGeometry*>(&boxes));
  rtcSetGeometryBoundsFunction(geometry, box_bounds<Boxes>, nullptr);
  rtcSetGeometryIntersectFunction(geometry, boxes.intersect);
  rtcSetGeometryOccludedFunction(geometry, boxes.occluded);
  rtcCommitGeometry(geometry);
  const unsigned id = rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
  return id;
}

// Which meshes become instances: those whose copies cost most, until the rest fits the bound.
std::vector<bool> choose_instanced(const Scene& scene, const EmbreeSceneOptions& options) {
  if (options.placement == Placement::movable) return std::vector<bool>(scene.meshes.size(), true);
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
    instanced[mesh] = total > options.max_copied_triangles;
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

// Of the box from low to high where the transform takes it.
double largest_coordinate(Vec3d low, Vec3d high, const Affine3d& m) {
  const Vec3d center = transform_point(m, low * 0.5 + high * 0.5), half = (high - low) * 0.5;
  double largest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double reach = std::abs(m.linear.x[axis]) * half.x + std::abs(m.linear.y[axis]) * half.y +
                         std::abs(m.linear.z[axis]) * half.z;
    largest = std::max(largest, std::abs(center[axis]) + reach);
  }
  return largest;
}

// An instance adds the rounding of the ray into object space, in object units, where the object-space ray
// origin is as far out as the world origin seen from there.
double instance_coordinate(Vec3d low, Vec3d high, const Affine3d& m) {
  const double object_size = largest_coordinate(low, high, {});
  const Vec3d from_origin = transform_point(inverse(m), Vec3d());
  const double stretch = std::sqrt(length_squared(m.linear.x) + length_squared(m.linear.y) +
                                   length_squared(m.linear.z));
  return largest_coordinate(low, high, m) + stretch * (object_size + length(from_origin));
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
    : device_(std::make_shared<Device>(options.threads)),
      meshes_(scene.meshes),
      placement_(options.placement),
      instanced_(choose_instanced(scene, options)),
      mesh_scenes_(scene.meshes.size()),
      extents_(scene.meshes.size()),
      top_(device_->make_scene()) {
  attach_meshes(scene);
  for (BoxGeometry& geometry : boxes) {
    boxes_.push_back(std::make_shared<Boxes>(Boxes{std::move(geometry), {}, nullptr}));
  }
  attach_boxes(scene);
  commit(device_->handle(), top_.get());
}

EmbreeScene::EmbreeScene(const EmbreeScene& before, const Scene& moved,
                         std::vector<std::optional<BoxGeometry>> boxes)
    : device_(before.device_),
      meshes_(before.meshes_),
      placement_(before.placement_),
      instanced_(before.instanced_),
      mesh_scenes_(before.mesh_scenes_),
      extents_(before.extents_),
      boxes_(before.boxes_),
      top_(device_->make_scene()) {
  attach_meshes(moved);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (boxes[i]) boxes_[i] = std::make_shared<Boxes>(Boxes{std::move(*boxes[i]), {}, nullptr});
  }
  attach_boxes(moved);
  commit(device_->handle(), top_.get());
}

EmbreeScene::~EmbreeScene() = default;

// The structure of a mesh is made when the first object needs it.
void EmbreeScene::make_mesh_scene(const Scene& scene, std::uint32_t mesh) {
  SceneHandle& handle = mesh_scenes_[mesh];
  if (handle) return;
  handle = device_->make_scene();
  attach_triangles(device_->handle(), handle.get(), scene.meshes[mesh], {});
  commit(device_->handle(), handle.get());
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Extent& extent = extents_[mesh];
  extent = {Vec3d(kInfinity), Vec3d(-kInfinity)};
  for (const Vec3f& p : scene.meshes[mesh].positions) {
    extent.low = min(extent.low, Vec3d(p));
    extent.high = max(extent.high, Vec3d(p));
  }
}

void EmbreeScene::add_record(unsigned id, const GeometryRecord& record) {
  records_.resize(std::max<std::size_t>(records_.size(), id + 1));
  records_[id] = record;
}

void EmbreeScene::attach_meshes(const Scene& scene) {
  records_.reserve(scene.objects.size());
  for (std::uint32_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    if (object.csg || scene.meshes[object.mesh.index].triangles.empty()) {
      continue;
    }
    const Mesh& mesh = scene.meshes[object.mesh.index];
    GeometryRecord record = make_record(scene, ObjectId{i});
    record.instanced = instanced_[object.mesh.index];
    double coordinate = 0;
    unsigned id = 0;
    if (record.instanced) {
      make_mesh_scene(scene, object.mesh.index);
      id = attach_instance(device_->handle(), top_.get(), mesh_scenes_[object.mesh.index].get(),
                           object.world_from_object);
      record.positions = mesh.positions.data();
      const Extent& extent = extents_[object.mesh.index];
      coordinate = instance_coordinate(extent.low, extent.high, object.world_from_object);
    } else {
      const Attached attached =
          attach_triangles(device_->handle(), top_.get(), mesh, object.world_from_object);
      id = attached.id;
      record.positions = attached.positions;
      coordinate = largest_coordinate(mesh, object.world_from_object);
    }
    record.position_error =
        float(kRoundings * std::numeric_limits<float>::epsilon() / 2 * coordinate);
    add_record(id, record);
  }
}

// Instances of boxes don't move: rays in them are the world's to the bit.
void EmbreeScene::attach_boxes(const Scene& scene) {
  for (const std::shared_ptr<Boxes>& boxes : boxes_) {
    boxes->written.release();
    unsigned id = 0;
    if (placement_ == Placement::movable) {
      if (!boxes->scene) {
        boxes->scene = device_->make_scene();
        attach_box_geometry(device_->handle(), boxes->scene.get(), *boxes);
        commit(device_->handle(), boxes->scene.get());
      }
      id = attach_instance(device_->handle(), top_.get(), boxes->scene.get(), {});
    } else {
      id = attach_box_geometry(device_->handle(), top_.get(), *boxes);
    }
    box_records_.push_back(id);
    add_record(id, make_box_record(scene, *boxes));
  }
}

std::uint64_t EmbreeScene::bytes() const {
  const std::int64_t bytes = device_->bytes();
  return bytes > 0 ? std::uint64_t(bytes) : 0;
}

}  // namespace arris
