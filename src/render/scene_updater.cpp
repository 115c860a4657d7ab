#include "render/scene_updater.h"

#include <fmt/format.h>

#include <chrono>
#include <string_view>
#include <utility>

#include "arris/error.h"

namespace arris {
namespace {

void check_index(std::string_view kind, std::size_t index, std::size_t count) {
  if (index < count) return;
  throw Error(Error::Kind::input, "",
              fmt::format("there is no {} {}; the scene has {}", kind, index, count));
}

}  // namespace

std::shared_ptr<const PreparedScene> apply_changes(const PreparedScene& prepared,
                                                   const SceneChanges& changes, int threads) {
  Scene scene = scene_of(prepared);
  for (const auto& [index, world_from_object] : changes.objects) {
    check_index("object", index, scene.objects.size());
    scene.objects[index].world_from_object = world_from_object;
  }
  for (const auto& [index, light] : changes.lights) {
    check_index("light", index, scene.lights.size());
    scene.lights[index] = light;
  }
  const PrepareOptions options{.threads = threads, .placement = Placement::movable};
  std::shared_ptr<const PreparedScene> out;
  if (!changes.objects.empty() || !changes.lights.empty()) {
    out = prepare_moved(prepared, std::move(scene), options);
  }
  if (changes.rounding) out = prepare_again(out ? *out : prepared, *changes.rounding, options);
  return out;
}

std::shared_ptr<const PreparedScene> SceneUpdater::poll(
    const std::shared_ptr<const PreparedScene>& scene) {
  std::shared_ptr<const PreparedScene> ready;
  if (under_way_.valid()) {
    if (under_way_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return nullptr;
    ready = under_way_.get();
  }
  if (changes_.is_empty()) return ready;
  const std::shared_ptr<const PreparedScene> before = ready ? ready : scene;
  SceneChanges changes = std::exchange(changes_, {});
  if (mode_ == UpdateMode::at_once) return apply_changes(*before, changes, threads_);
  under_way_ =
      std::async(std::launch::async, [before, changes = std::move(changes), threads = threads_] {
        return apply_changes(*before, changes, threads);
      });
  return ready;
}

}  // namespace arris
