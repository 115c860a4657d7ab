// view_mailbox.h — what clients have said and the renderer has not looked at yet
// What       of each kind of input the newest counts; what several of them change is joined, and all that they
//            answer is kept: the newest seq of each client
// Guarantee  at most kMostInputs of each client wait, each with a mark for each client
// Limits     one thread at a time
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "view/view_protocol.h"

namespace arris::view {

using Clock = std::chrono::steady_clock;
using ClientId = std::uint32_t;

struct InputMark {
  ClientId client = 0;
  std::uint32_t seq = 0;
  Clock::time_point arrival;
};

struct Input {
  ClientId client = 0;  // who sent it, or the newest of those that were joined
  MessageKind what;
  std::vector<InputMark> marks;  // one for each client at most
};

inline constexpr std::size_t kMostInputs = 64;

// The newer of two marks of one client counts.
void add_mark(std::vector<InputMark>& marks, const InputMark& mark);
void add_marks(std::vector<InputMark>& marks, const std::vector<InputMark>& more);

class ViewMailbox {
 public:
  // False: too many of this client wait, and the input is not taken.
  bool put(Input input);
  // All, in the order of the newest of each kind.
  std::vector<Input> take();
  [[nodiscard]] bool is_empty() const { return inputs_.empty(); }

 private:
  std::vector<Input> inputs_;
};

}  // namespace arris::view
