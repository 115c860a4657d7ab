#include "scene/placement.h"

#include <cmath>
#include <variant>

namespace arris {
namespace {

Mat3d rotation_matrix(Vec3d deg) {
  const auto about = [](double angle_deg, auto make) {
    return make(std::cos(radians(angle_deg)), std::sin(radians(angle_deg)));
  };
  const Mat3d x = about(deg.x, [](double c, double s) {
    return Mat3d{{1, 0, 0}, {0, c, s}, {0, -s, c}};
  });
  const Mat3d y = about(deg.y, [](double c, double s) {
    return Mat3d{{c, 0, -s}, {0, 1, 0}, {s, 0, c}};
  });
  const Mat3d z = about(deg.z, [](double c, double s) {
    return Mat3d{{c, s, 0}, {-s, c, 0}, {0, 0, 1}};
  });
  return z * y * x;
}

// Centred at a point and facing a direction; without edges where that is 0, as between keys that lead a light through
// its target.
void place_rectangle(AreaLight& light, Vec3d position, Vec3d facing, Vec3d up, Vec2d size) {
  light.corner = position;
  light.edge_u = light.edge_v = {};
  if (!(length_squared(facing) > 0)) return;
  facing = normalize(facing);
  Vec3d across = cross(up, facing);
  if (length(across) < 1e-6 * length(up)) {  // up is along the view: any axis that is not will do
    across = cross(std::abs(facing.x) < 0.5 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0), facing);
  }
  const Vec3d u = normalize(across);
  const Vec3d v = cross(facing, u);
  light.edge_u = u * size.x;
  light.edge_v = v * size.y;
  light.corner = position - light.edge_u * 0.5 - light.edge_v * 0.5;
}

struct LightMover {
  const LightTrack& track;
  const LightKey& key;
  Rgb emission;

  [[nodiscard]] Vec3d direction() const {
    return track.aim == LightTrack::Aim::target ? key.aim - key.position : key.aim;
  }
  void operator()(PointLight& light) const {
    light.position = key.position;
    light.intensity = emission;
  }
  void operator()(SpotLight& light) const {
    light.position = key.position;
    light.direction = direction();
    light.intensity = emission;
  }
  void operator()(DirectionalLight& light) const {
    light.direction = direction();
    light.irradiance = emission;
  }
  void operator()(AreaLight& light) const {
    place_rectangle(light, key.position, direction(), track.up, key.size);
    light.radiance = emission;
  }
};

}  // namespace

Affine3d make_placement(Vec3d translate, Vec3d rotate_deg, Vec3d scale) {
  const Mat3d turn = rotation_matrix(rotate_deg);
  return {{turn.x * scale.x, turn.y * scale.y, turn.z * scale.z}, translate};
}

void move_light(Light& light, const LightTrack& track, const LightKey& key) {
  std::visit(LightMover{track, key, Rgb(key.color * key.strength)}, light);
}

}  // namespace arris
