// client_queue.h — what is to be sent to one client
// What       of frames, and of texts that say how things are, only the newest waits; a frame is handed out when the one
//            before is acknowledged
// Guarantee  bounded, however slow the client is; the last frame is never lost, nor how things are
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "view/view_renderer.h"

namespace arris::view {

class ClientQueue {
 public:
  explicit ClientQueue(ClientId client) : client_(client) {}

  void put(const ViewText& text);
  void put(std::shared_ptr<const ViewFrame> frame) { frame_ = std::move(frame); }
  void acknowledge(std::uint32_t frame, Clock::time_point now);

  using Text = std::string;
  using Frame = std::shared_ptr<const ViewFrame>;
  // What is to be sent next, texts first.
  enum class Kinds { texts, all };
  std::optional<std::variant<Text, Frame>> take(Kinds kinds, Clock::time_point now);

  // When a new frame could be sent, as far as can be told from how long acknowledgements took; nothing while one
  // waits already.
  [[nodiscard]] std::optional<Clock::time_point> next_send() const;

 private:
  struct Waiting {
    std::string type, text;
  };
  ClientId client_;
  std::deque<Waiting> texts_;
  Frame frame_;                             // the newest that was not sent
  std::optional<std::uint32_t> in_flight_;  // sent and not acknowledged
  Clock::time_point sent_;
  Clock::duration answer_time_{};  // from sending to acknowledgement, of late
};

inline constexpr std::size_t kFrameHeaderBytes = 32;
// What goes before the JPEG (docs/view-protocol.md).
std::string frame_header(const ViewFrame& frame, ClientId client, Clock::time_point now);

}  // namespace arris::view
