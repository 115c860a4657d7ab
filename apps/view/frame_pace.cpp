#include "view/frame_pace.h"

#include <algorithm>

namespace arris::view {
namespace {

using std::chrono::duration;
using std::chrono::milliseconds;

constexpr auto kMoveLasts = milliseconds(150);
// Of a moving view's time, at least this is the shader's.
constexpr double kShaderShare = 0.2;
constexpr auto kMovingInterval = milliseconds(25);
// Of a view that stands still: a part of the time for which it has, within these.
constexpr double kStillPart = 0.1;
constexpr duration<double> kLeastStill{0.08}, kMostStill{0.5};
constexpr auto kRateWindow = std::chrono::seconds(1);

Clock::duration to_clock(duration<double> time) {
  return std::chrono::duration_cast<Clock::duration>(time);
}

}  // namespace

void FramePace::note_move(Clock::time_point now) {
  moving_until_ = now + kMoveLasts;
  still_since_ = now;
  hurry(now);
}

// No earlier than a moving view's next frame would be.
void FramePace::hurry(Clock::time_point now) {
  next_ = std::min(next_, std::max(now, earliest_));
}

void FramePace::note_frame(Clock::time_point begin, Clock::time_point end, bool idle) {
  const duration<double> took = end - begin;
  frame_ms_ = took.count() * 1e3;
  last_ = end;
  frames_.push_back(end);
  while (frames_.front() <= end - kRateWindow) frames_.pop_front();
  earliest_ =
      std::max(begin + kMovingInterval, end + to_clock(took * (kShaderShare / (1 - kShaderShare))));
  next_ = earliest_;
  if (is_moving(end) || idle) return;
  const duration<double> pause =
      std::clamp(kStillPart * duration<double>(end - still_since_), kLeastStill, kMostStill);
  next_ = std::max(next_, end + to_clock(pause));
}

double FramePace::still_seconds(Clock::time_point now) const {
  return is_moving(now) ? 0 : duration<double>(now - still_since_).count();
}

double FramePace::fps(Clock::time_point now) const {
  const auto recent = std::ranges::count_if(
      frames_, [&](Clock::time_point frame) { return frame > now - kRateWindow; });
  return double(recent) / duration<double>(kRateWindow).count();
}

}  // namespace arris::view
