// scene_updater.h — changes of a scene while frames of it are made
// What       collects moves of objects, lights and the default rounding, and prepares the scene anew with them: at
//            once, or in a thread of its own while frames go on with the scene before. Changes that come meanwhile
//            wait, the newest of each thing counts.
// Guarantee  poll() waits for nothing but when it works at once
// Limits     roundings and moved scenes are as quick as prepare_again() and prepare_moved() are: those want a scene
//            that was prepared with Placement::movable
#pragma once

#include <cstdint>
#include <future>
#include <map>
#include <memory>
#include <optional>

#include "arris/render.h"
#include "arris/scene.h"

namespace arris {

struct SceneChanges {
  std::map<std::uint32_t, Affine3d> objects;  // world_from_object, by index
  std::map<std::uint32_t, Light> lights;
  std::optional<RoundingSettings> rounding;

  [[nodiscard]] bool is_empty() const { return objects.empty() && lights.empty() && !rounding; }
};

// Throws Error{input} for an object or light that the scene lacks, and what prepare_moved() and prepare_again()
// throw.
std::shared_ptr<const PreparedScene> apply_changes(const PreparedScene& prepared,
                                                   const SceneChanges& changes, int threads);

enum class UpdateMode { at_once, beside };

class SceneUpdater {
 public:
  SceneUpdater(UpdateMode mode, int threads) : mode_(mode), threads_(threads) {}

  [[nodiscard]] SceneChanges& changes() { return changes_; }
  // The scene with changes that are ready, or null. Throws what preparing them has thrown; they are dropped then.
  std::shared_ptr<const PreparedScene> poll(const std::shared_ptr<const PreparedScene>& scene);

 private:
  UpdateMode mode_;
  int threads_;
  SceneChanges changes_;
  std::future<std::shared_ptr<const PreparedScene>> under_way_;
};

}  // namespace arris
