// The server with a small model, over its sockets.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <future>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "io/picture_png.h"
#include "view/server_fixture.h"

namespace arris::view {
namespace {

using nlohmann::json;
using test::Frame;
using test::Request;
using test::WebSocket;
using testing::HasSubstr;

TEST_F(ViewServerTest, says_what_it_shows_and_sends_frames_until_the_view_has_converged) {
  start();
  auto socket = look();
  const json scene = socket->read_text("scene");
  EXPECT_EQ(scene["name"], "boxes.obj");
  EXPECT_EQ(scene["objects"].size(), 2U);
  EXPECT_EQ(scene["objects"][1]["name"], "right");
  EXPECT_EQ(scene["rounding"]["radius"], 0.1);
  const Frame frame = read_until_converged(*socket);
  EXPECT_EQ(frame.width, 160);
  EXPECT_EQ(frame.height, 90);
  EXPECT_GE(frame.samples, 4U);
  const Rgba8Image picture = decode(frame);
  EXPECT_EQ(picture.width_px, 160);
  EXPECT_EQ(picture.height_px, 90);
  std::uint8_t darkest = 255, brightest = 0;
  for (const auto& texel : picture.texels) {
    darkest = std::min(darkest, texel[1]);
    brightest = std::max(brightest, texel[1]);
  }
  EXPECT_GT(brightest - darkest, 30);
}

TEST_F(ViewServerTest, frames_bring_back_the_newest_input_and_rapid_ones_build_no_queue) {
  start();
  auto socket = look();
  read_until_converged(*socket);
  constexpr std::uint32_t kInputs = 200;
  for (std::uint32_t seq = 1; seq <= kInputs; ++seq) socket->send(camera(seq, 0.01 * seq));
  int frames = 0;
  std::uint32_t last = 0;
  while (last < kInputs) {
    const Frame frame = socket->read_and_acknowledge();
    EXPECT_GE(frame.seq, last);
    last = frame.seq;
    ++frames;
  }
  EXPECT_EQ(last, kInputs);
  EXPECT_LT(frames, int(kInputs) / 2);
}

TEST_F(ViewServerTest, a_camera_changes_the_picture) {
  start();
  auto socket = look();
  const Rgba8Image before = decode(read_until_converged(*socket));
  socket->send(camera(1, 4));
  read_until_seq(*socket, 1);
  const Rgba8Image after = decode(read_until_converged(*socket));
  EXPECT_NE(before.texels, after.texels);
}

TEST_F(ViewServerTest, a_client_that_acknowledges_nothing_gets_one_frame_and_disturbs_nobody) {
  start();
  auto silent = look();
  silent->read_frame();
  auto socket = look();
  read_until_converged(*socket);
  for (std::uint32_t seq = 1; seq <= 5; ++seq) {
    socket->send(camera(seq, seq));
    read_until_seq(*socket, seq);
  }
  // All that had come for it before this answer is read; there is no frame among it.
  silent->send({{"type", "pick"}, {"seq", 1}, {"at", {1, 1}}});
  for (;;) {
    const auto message = silent->read();
    ASSERT_TRUE(message);
    ASSERT_FALSE(message->is_binary);
    if (json::parse(message->payload)["type"] == "picked") break;
  }
}

TEST_F(ViewServerTest, clients_are_bounded_in_number) {
  start();
  std::vector<std::unique_ptr<WebSocket>> sockets;
  for (int i = 0; i < 8; ++i) {
    sockets.push_back(look());
    sockets.back()->read_text("scene");
  }
  EXPECT_EQ(WebSocket(port_, token_).status(), 503);
  // A page can't see that, and asks for the reason.
  const auto reason = test::fetch(port_, Request(with_token("/ws")));
  EXPECT_EQ(reason.status, 503);
  EXPECT_THAT(reason.body, HasSubstr("8 pages look already; close one"));
  // Who says goodbye makes room, also if the connection is not closed.
  sockets[0]->send_frame(0x88, "\x03\xe8");
  int status = 0;
  for (int i = 0; status != 101 && i < 100; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    status = WebSocket(port_, token_).status();
  }
  EXPECT_EQ(status, 101);
}

TEST_F(ViewServerTest, answers_what_it_does_not_understand_and_goes_on) {
  start();
  auto socket = look();
  socket->send_text("{");
  EXPECT_THAT(socket->read_text("error")["text"].get<std::string>(), HasSubstr("JSON"));
  socket->send({{"type", "object"}, {"seq", 7}, {"id", 5}, {"visible", false}});
  const json error = socket->read_text("error");
  EXPECT_EQ(error["seq"], 7);
  EXPECT_THAT(error["text"].get<std::string>(), HasSubstr("no object 5"));
  socket->send_frame(0x82, "binary");
  socket->read_text("error");
  read_until_converged(*socket);
}

TEST_F(ViewServerTest, a_message_that_is_too_long_ends_the_session) {
  start();
  auto socket = look();
  socket->send_text(std::string(70000, ' '));
  while (socket->read()) {
  }
  read_until_converged(*look());
}

TEST_F(ViewServerTest, changes_of_the_scene_show_and_are_said) {
  start();
  auto socket = look();
  const json first = socket->read_text("scene");
  read_until_converged(*socket);
  socket->send({{"type", "object"}, {"seq", 1}, {"id", 1}, {"visible", false}});
  read_until_seq(*socket, 1);
  socket->send({{"type", "light"}, {"seq", 2}, {"lighting", "sky"}});
  socket->send({{"type", "material"}, {"seq", 3}, {"name", "brass"}});
  read_until_seq(*socket, 3);
  socket->send({{"type", "rounding"}, {"seq", 4}, {"radius", 0.2}});
  read_until_seq(*socket, 4);
  socket->send({{"type", "object"},
                {"seq", 5},
                {"id", 0},
                {"matrix", {{1, 0, 0, 0.5}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}}});
  read_until_seq(*socket, 5);
  socket->send({{"type", "size"}, {"seq", 6}, {"size", {200, 100}}});
  EXPECT_EQ(read_until_seq(*socket, 6).width, 200);
  read_until_converged(*socket);
  auto other = look();
  other->send({{"type", "size"}, {"size", {200, 100}}});
  const json scene = other->read_text("scene");
  EXPECT_EQ(scene["objects"][1]["visible"], false);
  EXPECT_EQ(scene["objects"][0]["matrix"][0][3], 0.5);
  EXPECT_EQ(scene["lighting"], "sky");
  EXPECT_EQ(scene["material"], "brass");
  EXPECT_EQ(scene["rounding"]["radius"], 0.2);
  EXPECT_EQ(scene["rounding"]["method"], "exact");
}

TEST_F(ViewServerTest, cameras_of_others_come_alone) {
  start();
  auto mover = look(), watcher = look();
  // What the watcher hears of a move. Of the first ones it may be a scene, which has changed otherwise, too.
  const auto move_to = [&](std::uint32_t seq) {
    mover->send(camera(seq, seq));
    for (;;) {
      const auto message = watcher->read();
      if (!message) throw std::runtime_error("closed");
      if (message->is_binary) {
        watcher->send({{"type", "ack"}, {"frame", WebSocket::parse(message->payload).number}});
        continue;
      }
      json text = json::parse(message->payload);
      const json& said = text["type"] == "scene" ? text["camera"] : text;
      if (said.contains("position") && said["position"] == json({seq, -5, 3})) return text;
    }
  };
  std::uint32_t seq = 1;
  while (seq < 20 && move_to(seq)["type"] != "camera") ++seq;
  const json text = move_to(++seq);
  EXPECT_EQ(text["type"], "camera");
  EXPECT_EQ(text["target"], json({1, 0, 0}));
  EXPECT_EQ(text["up"], json({0, 0, 1}));
  EXPECT_EQ(text["fov"], 35);
  // The mover hears of it only in a scene that has changed otherwise.
  read_until_seq(*mover, seq);
  for (const json& heard : mover->texts()) EXPECT_NE(heard["type"], "camera");
}

TEST_F(ViewServerTest, says_where_the_file_has_an_object_whoever_has_moved_it) {
  start();
  auto socket = look();
  socket->send({{"type", "object"},
                {"seq", 1},
                {"id", 1},
                {"matrix", {{1, 0, 0, 7}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}}});
  read_until_seq(*socket, 1);
  const json scene = look()->read_text("scene");
  EXPECT_EQ(scene["objects"][1]["matrix"][0][3], 7);
  EXPECT_EQ(scene["objects"][1]["file_matrix"][0][3], 2);
  EXPECT_EQ(scene["model"], 1);
}

TEST_F(ViewServerTest, says_that_a_still_view_is_path_traced) {
  start();
  auto socket = look();
  json state;
  do state = socket->read_text("state");
  while (!state["converged"].get<bool>());
  EXPECT_EQ(state["integrator"], "path");
}

TEST_F(ViewServerTest, scenes_say_what_of_a_client_is_in_them) {
  start();
  auto socket = look(), other = look();
  EXPECT_EQ(socket->read_text("scene")["seq"], 0);
  other->read_text("scene");
  socket->send({{"type", "object"}, {"seq", 41}, {"id", 1}, {"visible", false}});
  json scene;
  do scene = socket->read_text("scene");
  while (scene["objects"][1]["visible"].get<bool>());
  EXPECT_EQ(scene["seq"], 41);
  do scene = other->read_text("scene");
  while (scene["objects"][1]["visible"].get<bool>());
  EXPECT_EQ(scene["seq"], 0);
  EXPECT_EQ(scene["lightings"], json({"studio", "sky", "white"}));
  EXPECT_EQ(scene["objects"][0]["rounded"], 0.1);
}

TEST_F(ViewServerTest, a_change_that_cannot_be_made_is_an_error_and_changes_nothing) {
  start();
  auto socket = look();
  read_until_converged(*socket);
  socket->send({{"type", "rounding"}, {"seq", 1}, {"radius", 0.7}});
  const json error = socket->read_text("error");
  EXPECT_EQ(error["seq"], 1);
  EXPECT_THAT(error["text"].get<std::string>(), HasSubstr("0.7"));
  EXPECT_EQ(socket->read_text("scene")["rounding"]["radius"], 0.1);
  socket->send(camera(2, 3));
  read_until_seq(*socket, 2);
  read_until_converged(*socket);
}

TEST_F(ViewServerTest, errors_say_what_they_are_about) {
  start();
  auto socket = look();
  EXPECT_EQ(socket->read_text("scene")["radius_limit"], 0.5);
  read_until_converged(*socket);
  const auto about = [&](const json& message) {
    socket->send(message);
    return socket->read_text("error")["about"];
  };
  EXPECT_EQ(about({{"type", "rounding"}, {"seq", 1}, {"radius", 0.7}}), "rounding");
  EXPECT_EQ(about({{"type", "rounding"}, {"seq", 2}, {"radius", -1}}), "rounding");
  EXPECT_EQ(socket->read_text("scene")["rounding"]["radius"], 0.1);
  EXPECT_EQ(about({{"type", "object"}, {"seq", 3}, {"id", 0}, {"radius", 0.8}}), "object");
  EXPECT_EQ(about({{"type", "material"}, {"seq", 4}, {"name", "cheese"}}), "material");
  EXPECT_TRUE(about({{"type", "cheese"}}).is_null());
}

TEST_F(ViewServerTest, frames_the_whole_model_for_the_size_of_the_page) {
  start();
  auto socket = look();
  const json wide = socket->read_text("scene")["camera"];
  socket->send({{"type", "size"}, {"seq", 1}, {"size", {100, 300}}});
  json scene;
  do scene = socket->read_text("scene");
  while (scene["seq"] != 1);
  const auto distance = [](const json& camera) {
    const auto at = [&](const char* key, int axis) { return camera[key][axis].get<double>(); };
    return std::hypot(at("position", 0) - at("target", 0), at("position", 1) - at("target", 1));
  };
  EXPECT_GT(distance(scene["camera"]), 1.5 * distance(wide));
  socket->send({{"type", "frame_view"}, {"seq", 2}, {"direction", "top"}});
  EXPECT_TRUE(read_until_seq(*socket, 2).flags & 1U);
}

TEST_F(ViewServerTest, the_size_goes_to_who_is_left) {
  start();
  auto first = look(), second = look();
  first->send({{"type", "size"}, {"seq", 1}, {"size", {200, 100}}});
  second->send({{"type", "size"}, {"seq", 1}, {"size", {120, 80}}});
  {
    auto last = look();
    last->send({{"type", "size"}, {"seq", 1}, {"size", {320, 200}}});
    while (first->read_and_acknowledge().width != 320) {
    }
    first->send({{"type", "overlay"}, {"seq", 2}, {"on", true}});
    read_until_seq(*first, 2);
  }
  while (first->read_and_acknowledge().width != 200) {
  }
}

TEST_F(ViewServerTest, compares_roundings_along_a_line) {
  start();
  auto socket = look();
  const Rgba8Image before = decode(read_until_converged(*socket));
  socket->send({{"type", "compare"}, {"seq", 1}, {"method", "none"}, {"split", 0.5}});
  read_until_seq(*socket, 1);
  const Rgba8Image after = decode(read_until_converged(*socket));
  // The same paths on the left, but for JPEG's blocks; sharp edges on the right.
  const auto difference = [&](int first, int last) {
    double sum = 0;
    for (int y = 0; y < 90; ++y) {
      for (int x = first; x < last; ++x) {
        const std::size_t at = std::size_t(y) * 160 + std::size_t(x);
        sum += std::abs(int(before.texels[at][1]) - int(after.texels[at][1]));
      }
    }
    return sum / (90 * (last - first));
  };
  EXPECT_GT(difference(88, 160), 0.2);
}

TEST_F(ViewServerTest, says_what_is_under_the_mouse) {
  start();
  auto socket = look();
  socket->send({{"type", "camera"},
                {"seq", 1},
                {"position", {2, -5, 0}},
                {"target", {2, 0, 0}},
                {"up", {0, 0, 1}},
                {"fov", 35}});
  read_until_seq(*socket, 1);
  socket->send({{"type", "pick"}, {"seq", 2}, {"at", {80, 45}}});
  const json hit = socket->read_text("picked");
  EXPECT_EQ(hit["seq"], 2);
  EXPECT_EQ(hit["id"], 1);
  EXPECT_EQ(hit["feature"], "face");
  EXPECT_NEAR(hit["position"][1].get<double>(), -0.5, 1e-6);
  socket->send({{"type", "pick"}, {"seq", 3}, {"at", {0, 0}}});
  EXPECT_TRUE(socket->read_text("picked")["id"].is_null());
}

TEST_F(ViewServerTest, saves_the_picture_and_the_scene) {
  start();
  auto socket = look();
  read_until_converged(*socket);
  const auto picture = test::fetch(port_, Request(with_token("/picture.png")));
  EXPECT_EQ(picture.status, 200);
  EXPECT_THAT(picture.head, HasSubstr("image/png"));
  const Rgba8Image png = decode_png(
      {reinterpret_cast<const std::uint8_t*>(picture.body.data()), picture.body.size()}, "png");
  EXPECT_EQ(png.width_px, 160);
  const auto scene = test::fetch(port_, Request(with_token("/scene.toml")));
  EXPECT_EQ(scene.status, 200);
  EXPECT_THAT(scene.body, HasSubstr("file = \"boxes.obj\""));
  EXPECT_THAT(scene.body, HasSubstr("arris render scene.toml"));
  const auto named = test::fetch(port_, Request(with_token("/scene.toml?name=boxes.toml")));
  EXPECT_THAT(named.body, HasSubstr("arris render boxes.toml"));
  EXPECT_THAT(named.head, HasSubstr("filename=\"boxes.toml\""));
  EXPECT_EQ(test::fetch(port_, Request(with_token("/beam.png"))).status, 404);
}

TEST_F(ViewServerTest, many_ask_for_the_picture_at_once_and_get_the_same) {
  start();
  read_until_converged(*look());
  std::vector<std::future<test::Response>> answers;
  for (int i = 0; i < 16; ++i) {
    answers.push_back(std::async(std::launch::async, [this] {
      return test::fetch(port_, Request(with_token("/picture.png")));
    }));
  }
  const std::string first = answers[0].get().body;
  EXPECT_FALSE(first.empty());
  for (std::size_t i = 1; i < answers.size(); ++i) EXPECT_EQ(answers[i].get().body, first);
}

TEST_F(ViewServerTest, says_why_there_is_no_scene_to_save) {
  start();
  auto socket = look();
  for (const int id : {0, 1}) {
    socket->send({{"type", "object"}, {"seq", id + 1}, {"id", id}, {"visible", false}});
  }
  read_until_seq(*socket, 2);
  const auto scene = test::fetch(port_, Request(with_token("/scene.toml")));
  EXPECT_EQ(scene.status, 409);
  EXPECT_THAT(scene.body, HasSubstr("all objects are hidden"));
}

TEST_F(ViewServerTest, pictures_that_nobody_looks_at_become_small_again) {
  rest_after_ = std::chrono::milliseconds(100);
  start();
  {
    auto socket = look();
    socket->send({{"type", "size"}, {"seq", 1}, {"size", {400, 300}}});
    EXPECT_EQ(read_until_seq(*socket, 1).width, 400);
  }
  const auto saved_width = [&] {
    const std::string png = test::fetch(port_, Request(with_token("/picture.png"))).body;
    return decode_png({reinterpret_cast<const std::uint8_t*>(png.data()), png.size()}, "png")
        .width_px;
  };
  int looks = 0;
  while (saved_width() != 160 && ++looks < 1000) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  EXPECT_EQ(saved_width(), 160);
}

TEST_F(ViewServerTest, makes_beam_pictures) {
  start();
  auto socket = look();
  socket->send({{"type", "beam"}, {"seq", 1}});
  for (;;) {
    const json beam = socket->read_text("beam");
    ASSERT_FALSE(beam.contains("error")) << beam;
    if (beam["ready"].get<bool>()) break;
  }
  EXPECT_EQ(test::fetch(port_, Request(with_token("/beam.png"))).status, 200);
}

TEST_F(ViewServerTest, stops_beam_pictures) {
  start();
  auto socket = look();
  socket->send({{"type", "beam_stop"}, {"seq", 1}});
  const json none = socket->read_text("beam");
  EXPECT_EQ(none["stopped"], true);
  EXPECT_EQ(none["ready"], false);
  socket->send({{"type", "size"}, {"seq", 2}, {"size", {1280, 720}}});
  read_until_seq(*socket, 2);
  // It may be done before it hears of its end.
  bool stopped = false;
  for (std::uint32_t attempt = 0; attempt < 20 && !stopped; ++attempt) {
    socket->send({{"type", "beam"}, {"seq", 3 + 2 * attempt}});
    EXPECT_EQ(socket->read_text("beam")["ready"], false);
    socket->send({{"type", "beam_stop"}, {"seq", 4 + 2 * attempt}});
    json beam;
    do beam = socket->read_text("beam");
    while (!beam["ready"].get<bool>() && !beam.contains("stopped"));
    stopped = beam.contains("stopped");
  }
  EXPECT_TRUE(stopped);
  EXPECT_EQ(test::fetch(port_, Request(with_token("/beam.png"))).status, 404);
}

TEST_F(ViewServerTest, takes_models_only_where_that_is_allowed) {
  start();
  EXPECT_EQ(test::fetch(port_, Request(with_token("/model?name=a.stl")).post("solid")).status, 403);
}

TEST_F(ViewServerTest, shows_models_that_are_dropped) {
  ServerSettings settings;
  settings.allow_upload = true;
  start(settings);
  auto socket = look();
  EXPECT_EQ(socket->read_text("scene")["upload"], true);
  const auto post = [&](const std::string& name) {
    return test::fetch(port_, Request(with_token("/model?name=" + name)).post("solid"));
  };
  EXPECT_EQ(post("a.toml").status, 415);
  EXPECT_EQ(post("").status, 415);
  EXPECT_EQ(test::fetch(port_, Request("/model?name=a.stl").post("s")).status, 403);
  const auto bad = post("bad.stl");
  EXPECT_EQ(bad.status, 422);
  EXPECT_THAT(bad.body, HasSubstr("holds nothing"));
  EXPECT_EQ(post("path.stl").body.find("/tmp"), std::string::npos);
  // The same one again is another model, too.
  for (const int number : {2, 3}) {
    EXPECT_EQ(post("..%2Fnew.stl").status, 204);
    json scene;
    do scene = socket->read_text("scene");
    while (scene["model"] != number);
    EXPECT_EQ(scene["name"], "new.stl");
    EXPECT_EQ(scene["objects"].size(), 1U);
  }
}

TEST_F(ViewServerTest, a_model_that_comes_while_another_is_prepared_takes_its_place) {
  ServerSettings settings;
  settings.allow_upload = true;
  start(settings);
  const auto post = [&](const char* name) {
    return std::async(std::launch::async, [this, name] {
      return test::fetch(port_,
                         Request(with_token(std::string("/model?name=") + name)).post("solid"));
    });
  };
  auto slow = post("slow.stl");
  while (!slow_began_) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  auto next = post("next.stl");
  // Until the renderer has heard of it: an answer to what came later comes later.
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(test::fetch(port_, Request(with_token("/scene.toml"))).status, 200);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  slow_may_end_ = true;
  const test::Response replaced = slow.get();
  EXPECT_EQ(replaced.status, 422);
  EXPECT_THAT(replaced.body, HasSubstr("another model was opened meanwhile"));
  EXPECT_EQ(next.get().status, 204);
}

TEST_F(ViewServerTest, ends_when_the_last_client_has_left) {
  ServerSettings settings;
  settings.once = true;
  start(settings);
  {
    auto one = look();
    one->read_frame();
    auto two = look();
    two->read_frame();
  }
  thread_.join();
}

TEST_F(ViewServerTest, stops_while_clients_look) {
  start();
  auto socket = look();
  socket->read_frame();
  stop();
  while (socket->read()) {
  }
}

}  // namespace
}  // namespace arris::view
