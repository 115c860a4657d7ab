#include "render/scene_updater.h"

#include <fmt/format.h>

#include <string_view>
#include <utility>

#include "arris/error.h"
#include "base/flush_denormals.h"

namespace arris {
namespace {

// Of shadows, in one preparation: about 50 ms.
constexpr std::size_t kShadowEvents = 20'000;

void check_index(std::string_view kind, std::size_t index, std::size_t count) {
  if (index < count) return;
  throw Error(Error::Kind::input, "",
              fmt::format("there is no {} {}; the scene has {}", kind, index, count));
}

}  // namespace

std::shared_ptr<const PreparedScene> apply_changes(const PreparedScene& prepared,
                                                   const SceneChanges& changes, int threads,
                                                   const std::atomic<bool>* stop) {
  Scene scene = scene_of(prepared);
  for (const auto& [index, world_from_object] : changes.objects) {
    check_index("object", index, scene.objects.size());
    scene.objects[index].world_from_object = world_from_object;
  }
  for (const auto& [index, light] : changes.lights) {
    check_index("light", index, scene.lights.size());
    scene.lights[index] = light;
  }
  const PrepareOptions options{.threads = threads, .stop = stop, .placement = Placement::movable};
  std::shared_ptr<const PreparedScene> out;
  if (!changes.objects.empty() || !changes.lights.empty()) {
    out = prepare_moved(prepared, std::move(scene), options);
  }
  if (changes.rounding) out = prepare_again(out ? *out : prepared, *changes.rounding, options);
  return out;
}

SceneUpdater::SceneUpdater(const ShownScene& first, const Settings& settings)
    : settings_(settings), found_in_(first.scene) {
  if (settings.mode == UpdateMode::beside) thread_ = std::thread([this] { run(); });
}

SceneUpdater::~SceneUpdater() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

void SceneUpdater::drop() {
  changes_ = {};
  const std::lock_guard lock(mutex_);
  dropped_ = stage_ != Stage::idle;
}

void SceneUpdater::add(const std::vector<ShadowTriple>& triples) {
  triples_.insert(triples_.end(), triples.begin(), triples.end());
}

void SceneUpdater::poll(ShownScene& shown) {
  if (settings_.mode == UpdateMode::at_once) {
    if (!changes_.is_empty()) prepare(shown, std::exchange(changes_, {}));
    return;
  }
  free_retired();
  const std::lock_guard lock(mutex_);
  if (stage_ == Stage::asked) return;
  if (stage_ == Stage::done) {
    stage_ = Stage::idle;
    ShownScene ready = std::exchange(shown_, {});
    const std::exception_ptr error = std::exchange(error_, nullptr);
    if (std::exchange(dropped_, false)) {
      garbage_.push_back(std::move(ready.scene));
    } else if (error) {
      std::rethrow_exception(error);
    } else {
      shown = std::move(ready);
    }
  }
  const bool is_found = shown.scene == found_in_ && complete_ && triples_.empty();
  if (changes_.is_empty() && (is_found || !settings_.shadow_edges)) return;
  shown_ = shown;
  asked_ = std::exchange(changes_, {});
  asked_triples_ = std::exchange(triples_, {});
  stage_ = Stage::asked;
  wake_.notify_all();
}

void SceneUpdater::find_shadows(ShownScene& shown) {
  update_shadows(shown, std::exchange(triples_, {}));
}

void SceneUpdater::retire(ScenePtr scene) {
  if (settings_.mode == UpdateMode::beside) retired_.push_back(std::move(scene));
}

// Whoever holds a scene last frees it, so the thread gets those that nobody else holds any more.
void SceneUpdater::free_retired() {
  std::vector<ScenePtr> unused;
  std::erase_if(retired_, [&](ScenePtr& scene) {
    if (scene.use_count() > 1) return false;
    unused.push_back(std::move(scene));
    return true;
  });
  if (unused.empty()) return;
  {
    const std::lock_guard lock(mutex_);
    for (ScenePtr& scene : unused) garbage_.push_back(std::move(scene));
  }
  wake_.notify_all();
}

void SceneUpdater::prepare(ShownScene& shown, const SceneChanges& changes) const {
  ScenePtr after = apply_changes(*shown.scene, changes, settings_.threads, &stopped_);
  if (auto objects = shown.objects->with_roundings(*shown.scene, *after)) {
    shown.objects = std::move(objects);
  }
  shown.scene = std::move(after);
}

void SceneUpdater::update_shadows(ShownScene& shown, const std::vector<ShadowTriple>& triples) {
  finder_.add(triples);
  if (shown.scene != found_in_) {
    const Scene &before = found_in_->scene(), &after = shown.scene->scene();
    for (std::uint32_t i = 0; i < after.objects.size(); ++i) {
      if (before.objects[i].world_from_object != after.objects[i].world_from_object) {
        finder_.object_moved(i);
      }
    }
    const LightChanges lights = find_changed_lights(before, after);
    for (const std::uint32_t light : lights.moved) finder_.light_moved(light);
    if (lights.renumbered || shown.objects->is_rounded_anew(*found_in_, *shown.scene)) {
      finder_.all_changed();
    }
  }
  const bool complete = finder_.update(*shown.scene, *shown.objects, kShadowEvents);
  shown.shadow_edges = finder_.edges();
  ScenePtr before = shown.scene;
  const std::lock_guard lock(mutex_);
  complete_ = complete;
  std::swap(found_in_, before);
  if (settings_.mode == UpdateMode::beside) garbage_.push_back(std::move(before));
}

void SceneUpdater::run() {
  const FlushDenormals flush;
  std::unique_lock lock(mutex_);
  for (;;) {
    wake_.wait(lock, [&] { return stopped_ || stage_ == Stage::asked || !garbage_.empty(); });
    if (stopped_) return;
    if (stage_ == Stage::asked) {
      ShownScene shown = std::exchange(shown_, {});
      const SceneChanges changes = std::exchange(asked_, {});
      const std::vector<ShadowTriple> triples = std::exchange(asked_triples_, {});
      lock.unlock();
      std::exception_ptr error;
      ScenePtr before = shown.scene;
      try {
        if (!changes.is_empty()) prepare(shown, changes);
        if (settings_.shadow_edges) update_shadows(shown, triples);
      } catch (...) {
        error = std::current_exception();
      }
      lock.lock();
      shown_ = std::move(shown);
      error_ = error;
      stage_ = Stage::done;
      garbage_.push_back(std::move(before));
      continue;
    }
    std::vector<ScenePtr> garbage = std::exchange(garbage_, {});
    lock.unlock();
    garbage.clear();
    lock.lock();
  }
}

}  // namespace arris
