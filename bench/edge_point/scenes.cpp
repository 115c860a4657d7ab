#include "edge_point/scenes.h"

#include <cmath>
#include <functional>
#include <stdexcept>
#include <utility>

#include "arris/io.h"
#include "geometry/shapes.h"
#include "scene/scene_bounds.h"

namespace arris::bench {
namespace {

// A closed surface over two angles, smooth.
Mesh make_wrapped_mesh(int around, int along, const std::function<Vec3d(double, double)>& at) {
  Mesh mesh;
  std::vector<Vec3d> normals;
  for (int j = 0; j < along; ++j) {
    for (int i = 0; i < around; ++i) {
      const double u = 2 * kPi * i / around, v = 2 * kPi * j / along, step = 1e-4;
      mesh.positions.push_back(Vec3f(at(u, v)));
      normals.push_back(
          cross(at(u + step, v) - at(u - step, v), at(u, v + step) - at(u, v - step)));
    }
  }
  for (const Vec3d n : normals) mesh.normals.push_back(Vec3f(normalize(n)));
  const auto vertex = [&](int i, int j) { return std::uint32_t(j % along * around + i % around); };
  for (int j = 0; j < along; ++j) {
    for (int i = 0; i < around; ++i) {
      const std::uint32_t a = vertex(i, j), b = vertex(i + 1, j), c = vertex(i + 1, j + 1),
                          d = vertex(i, j + 1);
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  }
  return mesh;
}

Mesh make_torus_mesh(double ring, double tube, int around, int along) {
  return make_wrapped_mesh(around, along, [=](double u, double v) {
    return Vec3d{(ring + tube * std::cos(v)) * std::cos(u),
                 (ring + tube * std::cos(v)) * std::sin(u), tube * std::sin(v)};
  });
}

// A tube around a closed curve in the shape of a trefoil knot, with scales.
Mesh make_knot_mesh(int around, int along) {
  return make_wrapped_mesh(around, along, [](double v, double u) {
    const auto curve = [](double t) {
      return Vec3d{std::sin(t) + 2 * std::sin(2 * t), std::cos(t) - 2 * std::cos(2 * t),
                   -std::sin(3 * t)} *
             0.4;
    };
    const Vec3d tangent = normalize(curve(u + 1e-3) - curve(u - 1e-3));
    const Vec3d x = normalize(cross(tangent, {0.3, 0.2, 1})), y = cross(tangent, x);
    const double radius = 0.27 + 0.012 * std::sin(40 * u) * std::cos(9 * v) +
                          0.004 * std::sin(171 * u + 3 * v) * std::sin(31 * v);
    return curve(u) + (x * std::cos(v) + y * std::sin(v)) * radius;
  });
}

// A ball whose surface is moved in and out; normals are means of those of the faces around.
Mesh make_ball_mesh(int around, int rows, const std::function<Vec3d(Vec3d)>& at) {
  Mesh mesh;
  const auto add = [&](double theta, double phi) {
    mesh.positions.push_back(Vec3f(
        at({std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)})));
  };
  add(0, 0);
  for (int j = 1; j < rows; ++j) {
    for (int i = 0; i < around; ++i) add(kPi * j / rows, 2 * kPi * i / around);
  }
  add(kPi, 0);
  const auto last = std::uint32_t(mesh.positions.size() - 1);
  const auto vertex = [&](int i, int j) {
    return j == 0 ? 0 : j == rows ? last : std::uint32_t(1 + (j - 1) * around + i % around);
  };
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < around; ++i) {
      const std::uint32_t a = vertex(i, j), b = vertex(i + 1, j), c = vertex(i, j + 1),
                          d = vertex(i + 1, j + 1);
      // At the poles one of the two has no area.
      if (j + 1 < rows) mesh.triangles.push_back({a, c, d});
      if (j > 0) mesh.triangles.push_back({a, d, b});
    }
  }
  std::vector<Vec3d> normals(mesh.positions.size());
  for (const Triangle& t : mesh.triangles) {
    const Vec3d p(mesh.positions[t[0]]), q(mesh.positions[t[1]]), r(mesh.positions[t[2]]);
    for (const std::uint32_t v : t) normals[v] += cross(q - p, r - p);
  }
  for (const Vec3d n : normals) mesh.normals.push_back(Vec3f(normalize(n)));
  return mesh;
}

// Something of the size and irregularity of a scanned head: curls, brows, pores.
Mesh make_head_mesh(int around, int rows) {
  return make_ball_mesh(around, rows, [](Vec3d n) {
    double r = 1 + 0.12 * n.z - 0.1 * n.x * n.x;
    r += 0.16 * std::exp(-12 * ((n.x - 0.2) * (n.x - 0.2) + n.z * n.z)) *
         (n.y < 0 ? 1 - std::exp(20 * n.y) : 0);
    const double curls = n.z > 0.1 ? n.z - 0.1 : 0;
    r += 0.22 * curls * std::sin(9 * n.x + 5 * std::sin(7 * n.z)) * std::sin(13 * n.y + 3 * n.z);
    r += 0.01 * std::sin(37 * n.x + 5 * n.y) * std::sin(41 * n.y) * std::sin(43 * n.z);
    r += 0.002 * std::sin(211 * n.x + 17 * n.z) * std::sin(223 * n.y) * std::sin(199 * n.z);
    return n * r;
  });
}

class Builder {
 public:
  explicit Builder(std::string name) {
    scene.name = std::move(name);
    scene.environment = ConstantEnvironment{Rgb(0.05F)};
    scene.image.max_depth = 4;
  }

  Scene scene;

  MaterialId paint(Rgb color, float roughness = 0.6F, float metallic = 0) {
    Material m;
    m.base_color = color;
    m.roughness = roughness;
    m.metallic = metallic;
    scene.materials.push_back(m);
    return MaterialId{std::uint32_t(scene.materials.size() - 1)};
  }
  MeshId mesh(Mesh made) {
    scene.meshes.push_back(std::move(made));
    return MeshId{std::uint32_t(scene.meshes.size() - 1)};
  }
  void put(MeshId mesh, MaterialId material, const Affine3d& place) {
    Object object;
    object.name = "object" + std::to_string(scene.objects.size());
    object.mesh = mesh;
    object.material = material;
    object.world_from_object = place;
    scene.objects.push_back(object);
  }
  void box(Vec3d size, Vec3d center, MaterialId material) {
    put(mesh(make_box_mesh(size)), material, {{}, center});
  }
  void lamp(Vec3d position, float watts) {
    scene.lights.emplace_back(PointLight{position, Rgb(watts)});
  }
  // Faces down.
  void panel(Vec3d center, double size, float radiance) {
    AreaLight light;
    light.corner = center - Vec3d{size / 2, -size / 2, 0};
    light.edge_u = {size, 0, 0};
    light.edge_v = {0, -size, 0};
    light.radiance = Rgb(radiance);
    scene.lights.emplace_back(light);
  }
  void look(Vec3d from, Vec3d at, double fov_deg) {
    scene.camera = Camera{from, at, {0, 0, 1}, fov_deg};
  }
};

Affine3d turned(double angle, Vec3d axis, Vec3d to) {
  const double c = std::cos(angle), s = std::sin(angle);
  const Vec3d a = normalize(axis);
  const auto column = [&](Vec3d e) { return e * c + cross(a, e) * s + a * (dot(a, e) * (1 - c)); };
  return {{column({1, 0, 0}), column({0, 1, 0}), column({0, 0, 1})}, to};
}

void add_table(Builder& b, Vec3d at, MaterialId wood) {
  b.box({1.6, 0.8, 0.05}, at + Vec3d{0, 0, 0.72}, wood);
  for (const double x : {-0.72, 0.72}) {
    for (const double y : {-0.32, 0.32}) b.box({0.06, 0.06, 0.7}, at + Vec3d{x, y, 0.35}, wood);
  }
}

FlightScene make_rooms() {
  Builder b("rooms");
  const MaterialId wall = b.paint({0.75F, 0.72F, 0.65F}), floor = b.paint({0.45F, 0.3F, 0.2F});
  const MaterialId wood = b.paint({0.5F, 0.33F, 0.18F}), vase = b.paint({0.2F, 0.35F, 0.6F}, 0.2F);
  b.box({12, 4, 0.1}, {0, 0, -0.05}, floor);
  b.box({12, 4, 0.1}, {0, 0, 2.75}, wall);
  b.box({12, 0.1, 2.7}, {0, 2.05, 1.35}, wall);
  b.box({0.1, 4, 2.7}, {-6.05, 0, 1.35}, wall);
  b.box({0.1, 4, 2.7}, {6.05, 0, 1.35}, wall);
  for (const double x : {-2.0, 2.0}) {
    b.box({0.15, 1.4, 2.7}, {x, 1.3, 1.35}, wall);
    b.box({0.15, 1.4, 2.7}, {x, -1.3, 1.35}, wall);
    b.box({0.15, 1.2, 0.6}, {x, 0, 2.4}, wall);
  }
  const MeshId ball = b.mesh(make_sphere_mesh(0.18, 36)),
               ring = b.mesh(make_torus_mesh(0.2, 0.06, 24, 12));
  for (const double x : {-4.0, 0.0, 4.0}) {
    add_table(b, {x, 1.0, 0}, wood);
    b.put(ball, vase, {{}, {x - 0.4, 1.0, 0.93}});
    b.put(ball, vase, {{}, {x, 1.1, 0.93}});
    b.put(ring, wood, turned(0.2, {1, 0, 0}, {x + 0.4, 0.95, 0.81}));
    b.box({0.4, 0.3, 0.25}, {x + 0.5, -1.2, 0.125}, vase);
    b.panel({x - 1, 0, 2.69}, 0.5, 9);
    b.panel({x + 1, 0, 2.69}, 0.5, 9);
  }
  for (int i = 0; i < 5; ++i) b.put(ball, vase, {{}, {-4.6 + 0.45 * i, -0.9, 0.18}});
  b.look({-5.4, -1.6, 1.6}, {0.5, 0.5, 1.0}, 50);
  const auto last = std::uint32_t(b.scene.objects.size() - 1);
  return {"rooms", std::move(b.scene), EdgePointShader::gi, {-2, 0.2, 1}, 0.15, last};
}

FlightScene make_chains() {
  Builder b("chains");
  const MaterialId steel = b.paint({0.7F, 0.7F, 0.72F}, 0.5F),
                   ground = b.paint({0.6F, 0.55F, 0.5F});
  b.put(b.mesh(make_plane_mesh({12, 12})), ground, {});
  const MeshId link = b.mesh(make_torus_mesh(0.32, 0.09, 64, 32));
  for (int chain = 0; chain < 2; ++chain) {
    for (int i = 0; i < 9; ++i) {
      const double t = i - 4.0;
      const Vec3d at{t * 0.42, chain * 0.9 - 0.5 + 0.08 * std::sin(2.0 * i), 0.5 + 0.02 * t * t};
      b.put(link, steel, turned(i % 2 == 0 ? 0.15 : kPi / 2 + 0.1, {1, 0, 0}, at));
    }
  }
  b.lamp({2.5, -3, 4}, 60);
  b.lamp({-3, -1.5, 3}, 25);
  b.look({1.5, -3.4, 2.6}, {0, 0, 0.4}, 42);
  const auto last = std::uint32_t(b.scene.objects.size() - 1);
  return {"chains", std::move(b.scene), EdgePointShader::direct, {0, 0, 0.4}, 0.4, last};
}

FlightScene make_furnished_room() {
  Builder b("furnished");
  const MaterialId wall = b.paint({0.7F, 0.7F, 0.66F}), floor = b.paint({0.4F, 0.32F, 0.26F});
  const MaterialId wood = b.paint({0.5F, 0.35F, 0.2F}), wire = b.paint({0.25F, 0.25F, 0.28F}, 0.3F);
  const MaterialId cup = b.paint({0.85F, 0.85F, 0.8F}, 0.2F), cloth = b.paint({0.5F, 0.15F, 0.12F});
  b.box({6, 5, 0.1}, {0, 0, -0.05}, floor);
  b.box({6, 0.1, 2.8}, {0, 2.55, 1.4}, wall);
  b.box({0.1, 5, 2.8}, {-3.05, 0, 1.4}, wall);
  b.box({6, 5, 0.1}, {0, 0, 2.85}, wall);
  add_table(b, {0, 0.8, 0}, wood);
  add_table(b, {-1.9, -0.4, 0}, wood);
  b.box({1.2, 0.6, 0.45}, {1.9, 0.9, 0.23}, cloth);
  b.box({1.2, 0.15, 0.6}, {1.9, 1.25, 0.6}, cloth);
  // A stand of wire with cups.
  const MeshId hoop = b.mesh(make_torus_mesh(0.22, 0.006, 96, 12));
  const MeshId small = b.mesh(make_torus_mesh(0.07, 0.008, 64, 12));
  const MeshId rod = b.mesh(make_cone_mesh({0.006, 0.006, 0.5, 24}));
  const MeshId bowl = b.mesh(make_sphere_mesh(0.06, 58));
  for (int i = 0; i < 5; ++i) b.put(hoop, wire, {{}, {0, 0.8, 0.76 + 0.11 * i}});
  for (int i = 0; i < 18; ++i) {
    const double a = 2 * kPi * i / 18;
    b.put(rod, wire, {{}, {0.22 * std::cos(a), 0.8 + 0.22 * std::sin(a), 1.0}});
  }
  for (int level = 0; level < 3; ++level) {
    for (int i = 0; i < 6; ++i) {
      const double a = 2 * kPi * (i + 0.5 * level) / 6;
      const Vec3d at{0.14 * std::cos(a), 0.8 + 0.14 * std::sin(a), 0.83 + 0.16 * level};
      b.put(bowl, cup, {{}, at});
      b.put(small, cup, turned(kPi / 2, {1, 0, 0}, at + Vec3d{0.06, 0, 0}));
    }
  }
  for (int i = 0; i < 40; ++i) {
    b.box({0.035, 0.16, 0.2 + 0.01 * (i % 5)}, {-2.5 + 0.04 * i, -0.3, 0.86},
          i % 3 == 0 ? cloth : cup);
  }
  b.panel({-1.2, 0.5, 2.79}, 0.6, 10);
  b.panel({1.4, 0.2, 2.79}, 0.6, 8);
  b.lamp({1.2, -1.2, 2.2}, 6);
  b.look({2.2, -2.2, 1.7}, {-0.2, 0.7, 0.8}, 48);
  const auto last = std::uint32_t(b.scene.objects.size() - 1);
  return {"furnished", std::move(b.scene), EdgePointShader::gi, {-0.2, 0.7, 0.8}, 0.25, last};
}

FlightScene around_model(std::string name, Mesh mesh) {
  Builder b(name);
  const MaterialId stone = b.paint({0.75F, 0.7F, 0.62F}, 0.35F),
                   ground = b.paint({0.5F, 0.5F, 0.5F}, 0.3F);
  b.put(b.mesh(std::move(mesh)), stone, {});
  const Bounds bounds = world_bounds(b.scene);
  const Vec3d center = bounds.center();
  const double size = bounds.diagonal();
  b.put(b.mesh(make_plane_mesh({size * 4, size * 4})), ground,
        {{}, {center.x, center.y, bounds.lower.z}});
  b.lamp(center + Vec3d{0.9, -1.1, 1.2} * size, float(2 * size * size));
  b.look(center + Vec3d{0.25, -1.15, 0.3} * size, center, 42);
  return {std::move(name), std::move(b.scene), EdgePointShader::glossy, center, 0.4};
}

FlightScene make_grid() {
  Builder b("grid");
  const MaterialId jade = b.paint({0.35F, 0.6F, 0.4F}, 0.4F), bar = b.paint({0.5F, 0.4F, 0.3F});
  const MaterialId ground = b.paint({0.6F, 0.6F, 0.62F});
  b.put(b.mesh(make_knot_mesh(330, 1320)), jade, {{}, {0, 0, 0.8}});
  b.put(b.mesh(make_plane_mesh({12, 12})), ground, {});
  const MeshId upright = b.mesh(make_box_mesh({0.03, 0.03, 2.4})),
               across = b.mesh(make_box_mesh({3, 0.03, 0.03}));
  for (int i = 0; i < 13; ++i) b.put(upright, bar, {{}, {-1.44 + 0.24 * i, -1.9, 1.2}});
  for (int i = 0; i < 10; ++i) b.put(across, bar, {{}, {0, -1.9, 0.1 + 0.24 * i}});
  b.lamp({0.6, -5, 3}, 90);
  b.look({2.6, -3.6, 2.2}, {0, -0.3, 0.8}, 42);
  return {"grid", std::move(b.scene), EdgePointShader::direct, {0, -0.3, 0.8}, 0.4};
}

}  // namespace

std::vector<std::string> flight_scene_names() {
  return {"rooms", "chains", "furnished", "head", "grid"};
}

FlightScene make_flight_scene(const std::string& name) {
  if (name == "rooms") return make_rooms();
  if (name == "chains") return make_chains();
  if (name == "furnished") return make_furnished_room();
  if (name == "head") return around_model("head", make_head_mesh(354, 354));
  if (name == "grid") return make_grid();
  throw std::runtime_error("there is no scene " + name +
                           "; there are rooms, chains, furnished, head, grid");
}

FlightScene make_scan_scene(const std::string& file) {
  Scene scan = load_scene(file, {});
  Mesh all;
  for (const Object& object : scan.objects) {
    if (object.csg) continue;
    const Mesh& mesh = std::as_const(scan).meshes[object.mesh.index];
    const auto first = std::uint32_t(all.positions.size());
    for (const Vec3f p : mesh.positions) {
      all.positions.push_back(Vec3f(transform_point(object.world_from_object, Vec3d(p))));
    }
    for (const Triangle& t : mesh.triangles) {
      all.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    }
  }
  return around_model("scan", std::move(all));
}

Camera flight_camera(const FlightScene& flight, int frame) {
  Camera camera = *flight.scene.camera;
  const Vec3d d = camera.position - flight.pivot;
  const double a = radians(flight.turn_deg) * frame;
  camera.position = flight.pivot + Vec3d{d.x * std::cos(a) - d.y * std::sin(a),
                                         d.x * std::sin(a) + d.y * std::cos(a), d.z};
  return camera;
}

}  // namespace arris::bench
