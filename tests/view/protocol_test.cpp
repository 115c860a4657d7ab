#include "view/view_protocol.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "arris/error.h"

namespace arris::view {
namespace {

using testing::HasSubstr;

template <class T>
T parse(const std::string& text) {
  const ClientMessage message = parse_message(text);
  const T* what = std::get_if<T>(&message.what);
  if (what == nullptr) throw std::runtime_error("another kind of message");
  return *what;
}

std::string error_of(const std::string& text) {
  try {
    parse_message(text);
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), Error::Kind::input);
    return error.what();
  }
  return "";
}

TEST(ViewProtocol, reads_every_message) {
  EXPECT_EQ(parse<Hello>(R"({"type":"hello","size":[640,360]})").size, (PictureSize{640, 360}));
  EXPECT_EQ(parse<Ack>(R"({"type":"ack","frame":4294967295})").frame, 4294967295U);
  EXPECT_EQ(parse<SetSize>(R"({"type":"size","seq":1,"size":[3840,2160]})").size,
            (PictureSize{3840, 2160}));
  const auto camera = parse<SetCamera>(
      R"({"type":"camera","seq":2,"position":[1,2,3],"target":[0,0,1],"up":[0,1,0],"fov":35})");
  EXPECT_EQ(camera.camera.position, Vec3d(1, 2, 3));
  EXPECT_EQ(camera.camera.target, Vec3d(0, 0, 1));
  EXPECT_EQ(camera.camera.up, Vec3d(0, 1, 0));
  EXPECT_EQ(camera.camera.fov_deg, 35);
  EXPECT_EQ(parse<FrameView>(R"({"type":"frame_view","seq":3})").from, FrameView::From::here);
  EXPECT_EQ(parse<FrameView>(R"({"type":"frame_view","seq":3,"direction":"top"})").from,
            FrameView::From::top);
  const auto rounding = parse<SetRounding>(
      R"({"type":"rounding","seq":4,"radius":0.5,"edges":"both","min_angle":90,"method":"shader"})");
  EXPECT_EQ(rounding.radius, Radius(0.5));
  EXPECT_EQ(rounding.edges, RoundEdges::both);
  EXPECT_DOUBLE_EQ(*rounding.min_angle, kPi / 2);
  EXPECT_EQ(rounding.method, RoundMethod::shader);
  EXPECT_EQ(parse<SetRounding>(R"({"type":"rounding","radius":"auto"})").radius,
            Radius(AutoRadius{}));
  EXPECT_EQ(parse<SetRounding>(R"({"type":"rounding","radius":"12%"})").radius,
            Radius(PercentOfInradius{12}));
  EXPECT_EQ(parse<Isolate>(R"({"type":"isolate","seq":6,"id":3})").id, 3U);
  EXPECT_EQ(parse<Isolate>(R"({"type":"isolate","seq":6,"id":null})").id, std::nullopt);
  const auto light =
      parse<SetLight>(R"({"type":"light","lighting":"sky","strength":2,"rotation":450})");
  EXPECT_EQ(light.lighting, LightChoice::sky);
  EXPECT_EQ(light.strength, 2);
  EXPECT_EQ(light.rotation_deg, 90);
  EXPECT_EQ(parse<SetMaterial>(R"({"type":"material","name":"brass"})").name, "brass");
  EXPECT_EQ(parse<SetMaterial>(R"({"type":"material","name":null})").name, std::nullopt);
  EXPECT_FALSE(parse<SetGround>(R"({"type":"ground","on":false})").on);
  EXPECT_EQ(parse<SetShader>(R"({"type":"shader","name":"direct"})").shader,
            EdgePointShader::direct);
  const auto compare = parse<Compare>(R"({"type":"compare","method":"none","split":0.25})");
  EXPECT_EQ(compare.method, RoundMethod::none);
  EXPECT_EQ(compare.split, 0.25);
  EXPECT_EQ(parse<Compare>(R"({"type":"compare","method":null,"split":0.5})").method, std::nullopt);
  EXPECT_TRUE(parse<SetOverlay>(R"({"type":"overlay","on":true})").on);
  EXPECT_EQ(parse<Pick>(R"({"type":"pick","seq":9,"at":[10.5,20]})").x, 10.5);
  parse<MakeBeam>(R"({"type":"beam","seq":10})");
  EXPECT_EQ(parse<SetQuality>(R"({"type":"quality","moving":50,"still":95})").still, 95);
}

TEST(ViewProtocol, reads_what_an_object_message_says_and_leaves_the_rest) {
  const auto hidden = parse<SetObject>(R"({"type":"object","seq":5,"id":2,"visible":false})");
  EXPECT_EQ(hidden.id, 2U);
  EXPECT_EQ(hidden.visible, false);
  EXPECT_FALSE(hidden.radius);
  EXPECT_FALSE(hidden.world_from_object);
  const auto reset = parse<SetObject>(R"({"type":"object","id":2,"radius":null})");
  ASSERT_TRUE(reset.radius);
  EXPECT_FALSE(*reset.radius);
  const auto moved = parse<SetObject>(
      R"({"type":"object","id":0,"matrix":[[1,0,0,4],[0,2,0,5],[0,0,3,6],[0,0,0,1]]})");
  EXPECT_EQ(moved.world_from_object->translation, Vec3d(4, 5, 6));
  EXPECT_EQ(moved.world_from_object->linear.y, Vec3d(0, 2, 0));
}

TEST(ViewProtocol, keeps_the_sequence_number) {
  EXPECT_EQ(parse_message(R"({"type":"beam","seq":7})").seq, 7U);
  EXPECT_EQ(parse_message(R"({"type":"beam"})").seq, std::nullopt);
}

TEST(ViewProtocol, tells_what_can_be_seen_of_a_message_that_is_wrong) {
  const MessageHead head = find_head(R"({"type":"rounding","seq":12,"radius":-1})");
  EXPECT_EQ(head.seq, 12U);
  EXPECT_EQ(head.type, "rounding");
  EXPECT_EQ(find_head(R"({"type":"nothing","seq":12})").seq, 12U);
  EXPECT_EQ(find_head(R"({"type":"nothing","seq":12})").type, "");
  EXPECT_EQ(find_head(R"({"type":"light","seq":-1})").type, "light");
  EXPECT_EQ(find_head("]").seq, std::nullopt);
}

TEST(ViewProtocol, knows_the_type_of_every_message) {
  for (const char* text : {
           R"({"type":"hello","size":[640,360]})",
           R"({"type":"ack","frame":1})",
           R"({"type":"size","size":[640,360]})",
           R"({"type":"camera","position":[1,2,3],"target":[0,0,1],"up":[0,1,0],"fov":35})",
           R"({"type":"frame_view","direction":"first"})",
           R"({"type":"rounding","radius":0.5})",
           R"({"type":"object","id":0})",
           R"({"type":"isolate","id":3})",
           R"({"type":"light","strength":2})",
           R"({"type":"material","name":null})",
           R"({"type":"ground","on":false})",
           R"({"type":"shader","name":"direct"})",
           R"({"type":"compare","method":null})",
           R"({"type":"overlay","on":true})",
           R"({"type":"pick","at":[10.5,20]})",
           R"({"type":"beam"})",
           R"({"type":"beam_stop"})",
           R"({"type":"quality","moving":50,"still":95})",
       }) {
    EXPECT_EQ(type_of(parse_message(text).what), find_head(text).type) << text;
  }
}

TEST(ViewProtocol, says_what_is_wrong_and_what_is_expected) {
  EXPECT_THAT(error_of(R"({"type":"camra"})"), HasSubstr("camera"));
  EXPECT_THAT(error_of(R"({"type":"shader","name":"glosy"})"), HasSubstr("glossy"));
  EXPECT_THAT(error_of(R"({"type":"hello"})"), HasSubstr("\"size\" is missing"));
  EXPECT_THAT(error_of(R"({"type":"rounding","radius":"none"})"), HasSubstr("radius"));
}

TEST(ViewProtocol, refuses_what_is_out_of_range) {
  for (const char* text : {
           R"({"type":"hello","size":[63,64]})",
           R"({"type":"hello","size":[64,2161]})",
           R"({"type":"hello","size":[64.5,64]})",
           R"({"type":"hello","size":[64,64,64]})",
           R"({"type":"hello","size":["64",64]})",
           R"({"type":"ack","frame":-1})",
           R"({"type":"ack","frame":1.5})",
           R"({"type":"ack","frame":4294967296})",
           R"({"type":"camera","position":[1e300,0,0],"target":[0,0,0],"up":[0,0,1],"fov":35})",
           R"({"type":"camera","position":[1,0,0],"target":[0,0,0],"up":[0,0,1],"fov":179})",
           R"({"type":"camera","position":[1,0,0],"target":[0,0,0],"up":[0,0],"fov":35})",
           R"({"type":"camera","position":[1e999,0,0],"target":[0,0,0],"up":[0,0,1],"fov":35})",
           R"({"type":"camera","position":[NaN,0,0],"target":[0,0,0],"up":[0,0,1],"fov":35})",
           R"({"type":"rounding","radius":0})",
           R"({"type":"rounding","radius":-1})",
           R"({"type":"rounding","method":"mesh:3"})",
           R"({"type":"rounding","min_angle":181})",
           R"({"type":"object","id":0,"matrix":[[1,0,0,0],[0,1,0,0],[0,0,0,0],[0,0,0,1]]})",
           R"({"type":"object","id":0,"matrix":[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,2]]})",
           R"({"type":"object","visible":true})",
           R"({"type":"object","id":0,"visible":1})",
           R"({"type":"isolate"})",
           R"({"type":"light","strength":-1})",
           R"({"type":"material","name":5})",
           R"({"type":"ground","on":"yes"})",
           R"({"type":"compare","method":"exact","split":1.5})",
           R"({"type":"pick","at":[1]})",
           R"({"type":"quality","moving":29,"still":90})",
           R"({"type":5})",
           R"({"seq":1})",
           R"({"type":"beam","seq":"1"})",
           R"(["beam"])",
           R"("beam")",
           "null",
           "",
           "{",
           R"({"type":"beam"} x)",
       }) {
    EXPECT_NE(error_of(text), "") << text;
  }
}

TEST(ViewProtocol, refuses_messages_that_are_too_long_or_too_deep) {
  const std::string deep(30000, '[');
  EXPECT_NE(error_of(deep), "");
  EXPECT_THAT(error_of(deep + std::string(30000, ']')), HasSubstr("nested"));
  EXPECT_NE(error_of(R"({"type":"hello","size":)" + deep), "");
  const std::string padded = R"({"type":"beam","x":")" + std::string(kMaxMessageBytes, 'a') + "\"}";
  EXPECT_THAT(error_of(padded), HasSubstr("longer"));
}

}  // namespace
}  // namespace arris::view
