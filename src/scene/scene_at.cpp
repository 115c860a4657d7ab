// scene_at.cpp — what keys make of a scene at the time of a frame
// Source     Catmull, Rom, "A class of local interpolating splines" (1974), with the tangents for uneven distances of
//            Barry, Goldman, "A recursive evaluation algorithm for a class of Catmull-Rom splines" (1988): the slope of
//            the parabola through a key and its neighbours. At the ends it is that of the first and last piece.
// Legend     t_i frame of key i, p_i its value; D = t2 - t1 the piece that the frame is in, s in [0, 1] how far
#include <algorithm>
#include <array>
#include <cmath>

#include "arris/scene.h"
#include "scene/placement.h"

namespace arris {
namespace {

// A value at a frame is a weighted sum of those of the keys around it.
struct Blend {
  std::array<std::size_t, 4> key{};  // 1 and 2 are the ends of the piece, 0 and 3 their neighbours
  std::array<double, 4> weight{0, 1, 0, 0};
};

// The Hermite polynomials of a piece, with each tangent as the sum of values that it is.
std::array<double, 4> smooth_weights(std::array<double, 4> t, double s) {
  const double h1 = (1 + 2 * s) * (1 - s) * (1 - s), h2 = s * s * (3 - 2 * s);
  const double g1 = s * (1 - s) * (1 - s), g2 = s * s * (s - 1);  // of D times the tangents
  const double d = t[2] - t[1], d_before = t[1] - t[0], d_after = t[3] - t[2];
  // D m1 = own1 (p2 - p1) + other1 (p1 - p0), D m2 = own2 (p2 - p1) + other2 (p3 - p2)
  double own1 = 1, other1 = 0, own2 = 1, other2 = 0;
  if (d_before > 0) {
    own1 = d_before / (d_before + d);
    other1 = d / (d_before + d) * (d / d_before);
  }
  if (d_after > 0) {
    own2 = d_after / (d_after + d);
    other2 = d / (d_after + d) * (d / d_after);
  }
  return {-g1 * other1, h1 + g1 * (other1 - own1) - g2 * own2,
          h2 + g1 * own1 + g2 * (own2 - other2), g2 * other2};
}

template <class Key>
Blend blend_keys(const std::vector<Key>& keys, double frame, Interpolation interpolation) {
  Blend blend;
  const auto after = std::ranges::upper_bound(keys, frame, {}, &Key::frame);
  const auto next = std::size_t(after - keys.begin());
  if (next == 0 || next == keys.size()) {
    blend.key.fill(next == 0 ? 0 : keys.size() - 1);
    return blend;
  }
  blend.key = {next < 2 ? next - 1 : next - 2, next - 1, next, std::min(next + 1, keys.size() - 1)};
  std::array<double, 4> t{};
  for (std::size_t i = 0; i < 4; ++i) t[i] = keys[blend.key[i]].frame;
  const double s = (frame - t[1]) / (t[2] - t[1]);
  blend.weight = interpolation == Interpolation::smooth ? smooth_weights(t, s)
                                                        : std::array<double, 4>{0, 1 - s, s, 0};
  return blend;
}

// The values of one track at a frame.
template <class Key>
class Blended {
 public:
  Blended(const std::vector<Key>& keys, double frame, Interpolation interpolation)
      : keys_(keys), blend_(blend_keys(keys, frame, interpolation)) {}

  template <class Get>
  [[nodiscard]] auto operator()(const Get& get) const {
    auto sum = get(key(0)) * blend_.weight[0];
    for (std::size_t i = 1; i < 4; ++i) sum = sum + get(key(i)) * blend_.weight[i];
    return sum;
  }
  // Splines swing beyond their keys: sizes and strengths don't.
  template <class Get>
  [[nodiscard]] double within(const Get& get) const {
    const auto [low, high] = std::minmax({double(get(key(1))), double(get(key(2)))});
    return std::clamp((*this)(get), low, high);
  }
  template <class Get>
  [[nodiscard]] Vec3d each_within(const Get& get) const {
    Vec3d value;
    for (int axis = 0; axis < 3; ++axis) {
      value[axis] = within([&](const Key& k) { return get(k)[axis]; });
    }
    return value;
  }

 private:
  [[nodiscard]] const Key& key(std::size_t i) const { return keys_[blend_.key[i]]; }

  const std::vector<Key>& keys_;
  Blend blend_;
};

Camera camera_at(const Blended<CameraKey>& at) {
  Camera camera;
  camera.position = at([](const CameraKey& k) { return k.camera.position; });
  camera.target = at([](const CameraKey& k) { return k.camera.target; });
  camera.up = at([](const CameraKey& k) { return k.camera.up; });
  camera.fov_deg = at.within([](const CameraKey& k) { return k.camera.fov_deg; });
  return camera;
}

Affine3d placement_at(const Blended<ObjectKey>& at) {
  return make_placement(at([](const ObjectKey& k) { return k.translate; }),
                        at([](const ObjectKey& k) { return k.rotate_deg; }),
                        at.each_within([](const ObjectKey& k) { return k.scale; }));
}

LightKey light_at(const Blended<LightKey>& at) {
  LightKey key;
  key.position = at([](const LightKey& k) { return k.position; });
  key.aim = at([](const LightKey& k) { return k.aim; });
  key.color = at.each_within([](const LightKey& k) { return k.color; });
  key.strength = at.within([](const LightKey& k) { return k.strength; });
  key.size = {at.within([](const LightKey& k) { return k.size.x; }),
              at.within([](const LightKey& k) { return k.size.y; })};
  return key;
}

}  // namespace

Scene scene_at(const Scene& scene, double frame) {
  const Animation& animation = scene.animation;
  const Interpolation interpolation = animation.interpolation;
  Scene out = scene;
  if (!animation.camera.empty()) {
    out.camera = camera_at({animation.camera, frame, interpolation});
  }
  for (const ObjectTrack& track : animation.objects) {
    const Affine3d placement = placement_at({track.keys, frame, interpolation});
    for (const ObjectTrack::Part& part : track.parts) {
      out.objects[part.object.index].world_from_object = placement * part.placed_from_object;
    }
  }
  for (const LightTrack& track : animation.lights) {
    move_light(out.lights[track.light], track, light_at({track.keys, frame, interpolation}));
  }
  return out;
}

}  // namespace arris
