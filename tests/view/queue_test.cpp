#include <gtest/gtest.h>

#include <cstring>
#include <memory>
#include <string>

#include "view/client_queue.h"
#include "view/view_mailbox.h"

namespace arris::view {
namespace {

using Kinds = ClientQueue::Kinds;

std::shared_ptr<const ViewFrame> make_frame(std::uint32_t number) {
  auto frame = std::make_shared<ViewFrame>();
  frame->number = number;
  frame->size = {640, 360};
  return frame;
}

std::uint32_t number_of(const std::variant<ClientQueue::Text, ClientQueue::Frame>& what) {
  return std::get<ClientQueue::Frame>(what)->number;
}

TEST(ClientQueue, sends_one_frame_until_it_is_acknowledged_and_then_the_newest) {
  ClientQueue queue(1);
  const Clock::time_point now = Clock::now();
  queue.put(make_frame(1));
  EXPECT_EQ(number_of(*queue.take(Kinds::all, now)), 1U);
  for (std::uint32_t i = 2; i < 50; ++i) queue.put(make_frame(i));
  EXPECT_FALSE(queue.take(Kinds::all, now));
  queue.acknowledge(7, now);  // another one
  EXPECT_FALSE(queue.take(Kinds::all, now));
  queue.acknowledge(1, now);
  EXPECT_EQ(number_of(*queue.take(Kinds::all, now)), 49U);
  queue.acknowledge(49, now);
  EXPECT_FALSE(queue.take(Kinds::all, now));
}

TEST(ClientQueue, expects_acknowledgements_when_they_came_before) {
  ClientQueue queue(1);
  Clock::time_point now = Clock::now();
  constexpr auto kAnswer = std::chrono::milliseconds(80);
  EXPECT_EQ(queue.next_send(), Clock::time_point::min());
  for (std::uint32_t i = 1; i < 40; ++i) {
    queue.put(make_frame(i));
    EXPECT_FALSE(queue.next_send());
    queue.take(Kinds::all, now);
    if (i > 30) {
      EXPECT_LT(now + kAnswer - *queue.next_send(), std::chrono::milliseconds(1));
    }
    now += kAnswer;
    queue.acknowledge(i, now);
    EXPECT_EQ(queue.next_send(), Clock::time_point::min());
  }
}

TEST(ClientQueue, holds_few_texts_however_many_come) {
  ClientQueue queue(1);
  for (int i = 0; i < 1000; ++i) {
    queue.put(ViewText{"state", "state " + std::to_string(i), {}, {}});
    queue.put(ViewText{"error", "error " + std::to_string(i), {}, {}});
  }
  int texts = 0, states = 0;
  std::string last;
  while (auto text = queue.take(Kinds::all, Clock::now())) {
    last = std::get<std::string>(*text);
    ++texts;
    states += last.starts_with("state") ? 1 : 0;
  }
  EXPECT_LE(texts, 32 + 1);
  EXPECT_EQ(states, 1);
  EXPECT_EQ(last, "error 999");
}

TEST(ClientQueue, never_loses_how_things_are) {
  ClientQueue queue(1);
  const std::vector<std::string> kinds{"scene", "camera", "busy", "beam", "state"};
  for (const char* age : {"old ", "new "}) {
    for (const std::string& kind : kinds) queue.put(ViewText{kind, age + kind, {}, {}});
  }
  for (int i = 0; i < 1000; ++i) queue.put(ViewText{"error", "error", {}, {}});
  std::vector<std::string> texts;
  while (auto text = queue.take(Kinds::texts, Clock::now())) {
    texts.push_back(std::get<std::string>(*text));
  }
  ASSERT_GE(texts.size(), kinds.size());
  for (std::size_t i = 0; i < kinds.size(); ++i) EXPECT_EQ(texts[i], "new " + kinds[i]);
}

TEST(ClientQueue, takes_what_is_for_its_client) {
  ClientQueue queue(3);
  queue.put(ViewText{"picked", "mine", 3, {}});
  queue.put(ViewText{"picked", "another's", 4, {}});
  queue.put(ViewText{"scene", "all but me", {}, 3});
  EXPECT_EQ(std::get<std::string>(*queue.take(Kinds::texts, Clock::now())), "mine");
  EXPECT_FALSE(queue.take(Kinds::texts, Clock::now()));
}

TEST(ClientQueue, frame_headers_are_as_the_protocol_says) {
  ViewFrame frame = *make_frame(5);
  frame.converged = true;
  frame.samples = 64;
  const Clock::time_point now = Clock::now();
  frame.shown = {{1, 9, now}, {2, 77, now - std::chrono::milliseconds(250)}};
  const std::string header = frame_header(frame, 2, now);
  ASSERT_EQ(header.size(), kFrameHeaderBytes);
  EXPECT_EQ(header.substr(0, 4), "ARRF");
  const auto word = [&](std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, header.data() + at, 4);
    return value;
  };
  EXPECT_EQ(word(4), 5U);
  EXPECT_EQ(word(8), 77U);
  EXPECT_EQ(word(12), 640U | 360U << 16U);
  float latency = 0;
  std::memcpy(&latency, header.data() + 16, 4);
  EXPECT_NEAR(latency, 250, 1e-3);
  EXPECT_EQ(word(20), 2U);
  EXPECT_EQ(word(24), 64U);
  EXPECT_EQ(frame_header(frame, 8, now).substr(8, 4), std::string(4, '\0'));
}

Input make_input(ClientId client, std::uint32_t seq, MessageKind what) {
  return {client, std::move(what), {{client, seq, Clock::now()}}};
}

TEST(ViewMailbox, the_newest_of_a_kind_counts_and_answers_for_all) {
  ViewMailbox mailbox;
  for (std::uint32_t seq = 1; seq <= 1000; ++seq) {
    EXPECT_TRUE(mailbox.put(make_input(1, seq, SetGround{seq % 2 == 0})));
  }
  EXPECT_TRUE(mailbox.put(make_input(2, 5, SetGround{false})));
  const std::vector<Input> inputs = mailbox.take();
  ASSERT_EQ(inputs.size(), 1U);
  EXPECT_FALSE(std::get<SetGround>(inputs[0].what).on);
  ASSERT_EQ(inputs[0].marks.size(), 2U);
  EXPECT_EQ(inputs[0].marks[0].seq, 1000U);
  EXPECT_EQ(inputs[0].marks[1].seq, 5U);
  EXPECT_TRUE(mailbox.is_empty());
}

TEST(ViewMailbox, joins_what_messages_of_one_object_say) {
  ViewMailbox mailbox;
  SetObject hide, move, other;
  hide.visible = false;
  move.world_from_object = Affine3d{{}, {1, 2, 3}};
  other.id = 1;
  mailbox.put(make_input(1, 1, hide));
  mailbox.put(make_input(1, 2, other));
  mailbox.put(make_input(1, 3, move));
  const std::vector<Input> inputs = mailbox.take();
  ASSERT_EQ(inputs.size(), 2U);
  const auto& joined = std::get<SetObject>(inputs[1].what);
  EXPECT_EQ(joined.visible, false);
  EXPECT_EQ(joined.world_from_object->translation, Vec3d(1, 2, 3));
}

TEST(ViewMailbox, refuses_what_is_too_much) {
  ViewMailbox mailbox;
  std::size_t taken = 0;
  for (std::uint32_t id = 0; id < 1000; ++id) {
    SetObject object;
    object.id = id;
    taken += mailbox.put(make_input(1, id, object)) ? 1 : 0;
  }
  EXPECT_EQ(taken, kMostInputs);
  EXPECT_TRUE(mailbox.put(make_input(2, 1, SetCamera{}))) << "another one's flood is not its own";
}

}  // namespace
}  // namespace arris::view
