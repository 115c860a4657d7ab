// What the renderer does of itself: files that are read again, and models that come meanwhile.
#include "view/view_renderer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "arris/error.h"
#include "geometry/shapes.h"

namespace arris::view {
namespace {

using testing::HasSubstr;

ViewModel make_boxes(std::vector<std::string> names) {
  ViewModel model;
  model.name = "boxes.obj";
  model.file = "boxes.obj";
  model.scene.meshes.push_back(make_box_mesh({1, 1, 1}));
  model.scene.materials.resize(1);
  for (std::size_t i = 0; i < names.size(); ++i) {
    Object object;
    object.name = std::move(names[i]);
    object.world_from_object.translation = {2.0 * double(i), 0, 0};
    model.scene.objects.push_back(object);
  }
  model.scene.image.width_px = model.scene.image.height_px = 64;
  return model;
}

class ViewRendererTest : public testing::Test {
 protected:
  // open: what is read when a file is opened, again or by a client.
  void start(OpenModel open) {
    ViewRendererSettings settings;
    settings.threads = 1;
    settings.open = std::move(open);
    renderer_ = std::make_unique<ViewRenderer>(make_boxes({"left", "right"}), settings);
    renderer_->start({[](const auto&) {},
                      [this](ViewText text) {
                        const std::lock_guard lock(mutex_);
                        texts_.push_back(std::move(text));
                        wake_.notify_all();
                      }});
    renderer_->join(1);
  }
  std::future<std::string> open(const std::string& name) {
    auto result = std::make_shared<std::promise<std::string>>();
    renderer_->open("/scratch/" + name, name,
                    [result](const std::string& error) { result->set_value(error); });
    return result->get_future();
  }
  // Until a text of this type says this.
  std::string wait_for(const std::string& type, const std::string& part) {
    std::string found;
    std::unique_lock lock(mutex_);
    wake_.wait(lock, [&] {
      for (const ViewText& text : texts_) {
        if (text.type == type && text.text.find(part) != std::string::npos) found = text.text;
      }
      return !found.empty();
    });
    return found;
  }

  std::mutex mutex_;
  std::condition_variable wake_;
  std::vector<ViewText> texts_;
  std::unique_ptr<ViewRenderer> renderer_;  // the last: the rest is there while it runs
};

TEST_F(ViewRendererTest, a_changed_file_is_read_again_when_an_upload_that_was_first_has_failed) {
  std::atomic<bool> began = false, may_end = false;
  start([&](const ModelFile& what) {
    if (!what.is_foreign) return make_boxes({"read again"});
    began = true;
    while (!may_end) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    throw Error(Error::Kind::input, what.file.string(), "is cut short");
  });
  auto error = open("bad.stl");
  while (!began) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  renderer_->reload();
  may_end = true;
  EXPECT_THAT(error.get(),
              testing::AllOf(HasSubstr("bad.stl"), testing::Not(HasSubstr("/scratch"))));
  wait_for("scene", "read again");
}

TEST_F(ViewRendererTest, a_file_that_is_read_again_gives_way_to_an_upload_and_comes_after_it) {
  std::atomic<int> reads = 0;
  std::atomic<bool> may_end = false;
  start([&](const ModelFile& what) {
    if (what.is_foreign) throw Error(Error::Kind::input, what.name, "is cut short");
    if (++reads == 1) {
      while (!may_end) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      return make_boxes({"too early"});
    }
    return make_boxes({"read again"});
  });
  renderer_->reload();
  while (reads == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  auto error = open("bad.stl");
  renderer_->repeat_scene();
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  may_end = true;
  EXPECT_THAT(error.get(), HasSubstr("is cut short"));
  wait_for("scene", "read again");
}

TEST_F(ViewRendererTest, says_which_changes_find_no_object_in_a_file_that_was_read_again) {
  start([](const ModelFile&) { return make_boxes({"left", "new"}); });
  SetObject hide;
  hide.id = 1;
  hide.visible = false;
  renderer_->put(1, {1, hide});
  wait_for("scene", "\"visible\":false");
  renderer_->reload();
  EXPECT_THAT(wait_for("error", "is lost"), HasSubstr("\\\"right\\\""));
  const std::string scene = wait_for("scene", "\"name\":\"new\"");
  EXPECT_EQ(scene.find("\"visible\":false"), std::string::npos);
}

}  // namespace
}  // namespace arris::view
