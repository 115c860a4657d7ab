// scene_updater.h — changes of a scene while frames of it are made
// What       collects moves of objects, lights and the default rounding, prepares the scene anew with them, and finds
//            its shadow edges: when asked, or in a thread of its own while frames go on with the scene before. Changes
//            that come meanwhile wait, the newest of each thing counts. That thread also frees scenes that are no
//            longer shown.
// Guarantee  beside frames, no call waits for such work
// Limits     roundings and moved scenes are as quick as prepare_again() and prepare_moved() are: those want a scene
//            that was prepared with Placement::movable. Shadow edges of one preparation are bounded in number: what is
//            beyond comes with the next.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <exception>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "arris/render.h"
#include "arris/scene.h"
#include "render/edge_objects.h"
#include "render/shadow_finder.h"

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
                                                   const SceneChanges& changes, int threads,
                                                   const std::atomic<bool>* stop = nullptr);

// What a frame shows, besides points.
struct ShownScene {
  std::shared_ptr<const PreparedScene> scene;
  std::shared_ptr<const EdgeObjects> objects;
  std::shared_ptr<const std::vector<SoftEdge>> shadow_edges;
};

enum class UpdateMode { at_once, beside };

class SceneUpdater {
 public:
  using ScenePtr = std::shared_ptr<const PreparedScene>;
  struct Settings {
    UpdateMode mode = UpdateMode::beside;
    bool shadow_edges = true;
    int threads = 0;
  };

  SceneUpdater(const ShownScene& first, const Settings& settings);
  SceneUpdater(const SceneUpdater&) = delete;
  SceneUpdater& operator=(const SceneUpdater&) = delete;
  ~SceneUpdater();

  [[nodiscard]] SceneChanges& changes() { return changes_; }
  // Forgets all changes so far, also those that are being prepared.
  void drop();
  // What the shader has met: shadow edges are looked for there.
  void add(const std::vector<ShadowTriple>& triples);
  // Brings what is shown up to what is ready. Throws what preparing it has thrown; those changes are dropped then.
  void poll(ShownScene& shown);
  // Of UpdateMode::at_once: the shadow edges of what is shown, as far as they are known.
  void find_shadows(ShownScene& shown);
  // Takes a scene that is shown no more, to free it where no frame waits for that.
  void retire(ScenePtr scene);

 private:
  void run();
  void free_retired();
  void prepare(ShownScene& shown, const SceneChanges& changes) const;
  void update_shadows(ShownScene& shown, const std::vector<ShadowTriple>& triples);

  Settings settings_;
  SceneChanges changes_;
  std::vector<ShadowTriple> triples_;
  std::vector<ScenePtr> retired_;  // of which others may still hold some

  // Of the thread, or of UpdateMode::at_once.
  ShadowFinder finder_;
  ScenePtr found_in_;  // the scene of the finder's last update

  // What both threads look at.
  std::mutex mutex_;
  std::condition_variable wake_;
  enum class Stage { idle, asked, done } stage_ = Stage::idle;
  ShownScene shown_;  // asked: before the changes; done: with them
  SceneChanges asked_;
  std::vector<ShadowTriple> asked_triples_;
  std::exception_ptr error_;
  std::vector<ScenePtr> garbage_;
  bool complete_ = true;               // no shadow edges are left to be found
  bool dropped_ = false;               // nobody wants what is being prepared
  std::atomic<bool> stopped_ = false;  // changes under the mutex
  std::thread thread_;                 // UpdateMode::beside
};

}  // namespace arris
