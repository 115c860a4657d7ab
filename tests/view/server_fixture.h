// server_fixture.h — a server that shows two boxes, and who looks at it
#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <string>
#include <thread>

#include "arris/error.h"
#include "geometry/shapes.h"
#include "io/decode_image.h"
#include "io/picture_jpeg.h"
#include "support/web_client.h"
#include "view/view_server.h"

namespace arris::view {

inline ViewModel make_boxes() {
  ViewModel model;
  model.name = "boxes.obj";
  model.scene.meshes.push_back(make_box_mesh({1, 1, 1}));
  model.scene.materials.resize(1);
  for (int i = 0; i < 2; ++i) {
    Object object;
    object.name = i == 0 ? "left" : "right";
    object.world_from_object.translation = {2.0 * i, 0, 0};
    model.scene.objects.push_back(object);
  }
  RoundingSettings rounding;
  rounding.method = RoundMethod::exact;
  rounding.radius = 0.1;
  model.scene.rounding = rounding;
  model.scene.image.width_px = 160;
  model.scene.image.height_px = 90;
  model.scene.image.samples_per_pixel = 4;
  return model;
}

class ViewServerTest : public testing::Test {
 protected:
  void start(ServerSettings settings = {}) {
    ViewRendererSettings renderer;
    renderer.threads = 1;
    renderer.rest_after = rest_after_;
    renderer.upload = settings.allow_upload;
    renderer.open = [this](const ModelFile& what) {
      const auto& [file, name, is_foreign, stop] = what;
      EXPECT_TRUE(is_foreign);
      if (name == "path.stl") throw Error(Error::Kind::input, file.string(), "is cut short");
      if (name == "slow.stl") {
        slow_began_ = true;
        while (!slow_may_end_) std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
      if (name == "bad.stl") throw Error(Error::Kind::input, name, "holds nothing; draw something");
      ViewModel model = make_boxes();
      model.name = name;
      model.file = file;
      model.scene.objects.resize(1);
      return model;
    };
    server_ = std::make_unique<ViewServer>(make_boxes(), renderer, settings);
    const std::string address = server_->address();  // http://127.0.0.1:PORT/?t=TOKEN
    port_ = std::uint16_t(std::stoi(address.substr(17)));
    token_ = address.substr(address.find("t=") + 2);
    thread_ = std::thread([this] { server_->run(); });
  }
  ~ViewServerTest() override { stop(); }
  void stop() {
    if (!thread_.joinable()) return;
    server_->stop();
    thread_.join();
  }

  [[nodiscard]] std::string with_token(const std::string& target) const {
    return target + (target.find('?') == std::string::npos ? "?t=" : "&t=") + token_;
  }
  [[nodiscard]] std::unique_ptr<test::WebSocket> look() const {
    auto socket = std::make_unique<test::WebSocket>(port_, token_);
    EXPECT_EQ(socket->status(), 101);
    socket->send({{"type", "hello"}, {"size", {160, 90}}});
    return socket;
  }
  static nlohmann::json camera(std::uint32_t seq, double x) {
    return {{"type", "camera"},    {"seq", seq},      {"position", {x, -5, 3}},
            {"target", {1, 0, 0}}, {"up", {0, 0, 1}}, {"fov", 35}};
  }
  static test::Frame read_until_seq(test::WebSocket& socket, std::uint32_t seq) {
    for (;;) {
      test::Frame frame = socket.read_and_acknowledge();
      if (frame.seq == seq) return frame;
    }
  }
  static test::Frame read_until_converged(test::WebSocket& socket) {
    for (;;) {
      test::Frame frame = socket.read_and_acknowledge();
      if (frame.is_converged()) return frame;
    }
  }
  static Rgba8Image decode(const test::Frame& frame) {
    return decode_jpeg(
        {reinterpret_cast<const std::uint8_t*>(frame.jpeg.data()), frame.jpeg.size()}, "frame");
  }

  std::atomic<bool> slow_began_ = false, slow_may_end_ = false;
  std::chrono::milliseconds rest_after_{30'000};
  std::unique_ptr<ViewServer> server_;
  std::thread thread_;
  std::uint16_t port_ = 0;
  std::string token_;
};

}  // namespace arris::view
