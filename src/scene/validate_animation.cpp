#include "scene/validate_animation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace arris {
namespace {

bool is_number(const Camera& camera) {
  return is_finite(camera.position) && is_finite(camera.target) && is_finite(camera.up) &&
         std::isfinite(camera.fov_deg);
}
bool is_number(const CameraKey& key) {
  return is_number(key.camera);
}
bool is_number(const ObjectKey& key) {
  return is_finite(key.translate) && is_finite(key.rotate_deg) && is_finite(key.scale);
}
bool is_number(const LightKey& key) {
  return is_finite(key.position) && is_finite(key.aim) && is_finite(key.color) &&
         std::isfinite(key.strength) && std::isfinite(key.size.x) && std::isfinite(key.size.y);
}

template <class Key>
void check_keys(const std::vector<Key>& keys, const std::string& where,
                std::vector<std::string>& problems) {
  if (keys.empty())
    problems.push_back(fmt::format("{}: has no key; add one or leave it out", where));
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const double frame = keys[i].frame;
    if (!(std::abs(frame) <= kMaxFrame)) {
      problems.push_back(fmt::format("{} key {}: frame is {:g}; it must be from {:g} to {:g}",
                                     where, i, frame, -kMaxFrame, kMaxFrame));
    } else if (i > 0 && !(frame - keys[i - 1].frame >= kLeastKeyDistance)) {
      problems.push_back(
          fmt::format("{} key {}: frame is {}, after {}; it must be at least {} more", where, i,
                      frame, keys[i - 1].frame, kLeastKeyDistance));
    }
    if (!is_number(keys[i])) {
      problems.push_back(fmt::format("{} key {}: holds what is not a number", where, i));
    }
  }
}

}  // namespace

void check_animation(const Scene& scene, std::vector<std::string>& problems) {
  const Animation& animation = scene.animation;
  if (!animation.camera.empty()) check_keys(animation.camera, "camera", problems);
  for (std::size_t i = 0; i < animation.objects.size(); ++i) {
    const ObjectTrack& track = animation.objects[i];
    check_keys(track.keys, fmt::format("object track {}", i), problems);
    for (const ObjectTrack::Part& part : track.parts) {
      if (part.object.index < scene.objects.size()) continue;
      problems.push_back(fmt::format("object track {}: moves object {}, but there are {}", i,
                                     part.object.index, scene.objects.size()));
    }
  }
  for (std::size_t i = 0; i < animation.lights.size(); ++i) {
    const LightTrack& track = animation.lights[i];
    check_keys(track.keys, fmt::format("light track {}", i), problems);
    if (track.light < scene.lights.size()) continue;
    problems.push_back(fmt::format("light track {}: moves light {}, but there are {}", i,
                                   track.light, scene.lights.size()));
  }
}

}  // namespace arris
