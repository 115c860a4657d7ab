#include "view/client_queue.h"

#include <algorithm>
#include <array>
#include <bit>
#include <utility>

namespace arris::view {
namespace {

// Of texts that each count: errors, and what was picked.
constexpr std::size_t kMostTexts = 32;

constexpr std::uint32_t kMagic = 0x46525241;  // "ARRF"
constexpr std::uint32_t kMoving = 1, kConverged = 2;

void add_little_endian(std::string& out, std::uint32_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) out += char(value >> (8 * i) & 0xFF);
}

bool is_of_now(const std::string& type) {
  return type == "scene" || type == "camera" || type == "state" || type == "busy" || type == "beam";
}

}  // namespace

void ClientQueue::put(const ViewText& text) {
  if ((text.to && *text.to != client_) || (text.but_not && *text.but_not == client_)) return;
  if (is_of_now(text.type)) {
    std::erase_if(texts_, [&](const Waiting& waiting) { return waiting.type == text.type; });
  } else {
    const auto counts = [](const Waiting& waiting) { return !is_of_now(waiting.type); };
    if (std::size_t(std::ranges::count_if(texts_, counts)) >= kMostTexts) {
      texts_.erase(std::ranges::find_if(texts_, counts));
    }
  }
  texts_.push_back({text.type, text.text});
}

void ClientQueue::acknowledge(std::uint32_t frame, Clock::time_point now) {
  if (in_flight_ != frame) return;
  in_flight_.reset();
  answer_time_ = (3 * answer_time_ + (now - sent_)) / 4;
}

std::optional<Clock::time_point> ClientQueue::next_send() const {
  if (frame_) return std::nullopt;
  return in_flight_ ? sent_ + answer_time_ : Clock::time_point::min();
}

std::optional<std::variant<ClientQueue::Text, ClientQueue::Frame>> ClientQueue::take(
    Kinds kinds, Clock::time_point now) {
  if (!texts_.empty()) {
    std::string text = std::move(texts_.front().text);
    texts_.pop_front();
    return text;
  }
  if (kinds == Kinds::texts || !frame_ || in_flight_) return std::nullopt;
  in_flight_ = frame_->number;
  sent_ = now;
  return std::exchange(frame_, nullptr);
}

std::string frame_header(const ViewFrame& frame, ClientId client, Clock::time_point now) {
  const auto mark = std::ranges::find(frame.shown, client, &InputMark::client);
  const bool has_mark = mark != frame.shown.end();
  const float latency_ms =
      has_mark ? std::chrono::duration<float, std::milli>(now - mark->arrival).count() : 0.0F;
  std::string out;
  add_little_endian(out, kMagic, 4);
  add_little_endian(out, frame.number, 4);
  add_little_endian(out, has_mark ? mark->seq : 0, 4);
  add_little_endian(out, std::uint32_t(frame.size.width_px), 2);
  add_little_endian(out, std::uint32_t(frame.size.height_px), 2);
  add_little_endian(out, std::bit_cast<std::uint32_t>(latency_ms), 4);
  add_little_endian(out, (frame.moving ? kMoving : 0) | (frame.converged ? kConverged : 0), 4);
  add_little_endian(out, frame.samples, 4);
  add_little_endian(out, 0, 4);
  return out;
}

}  // namespace arris::view
