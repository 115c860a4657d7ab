// frame_pace.h — when the viewer's next frame is due
// What       moving views: as many frames as leave the shader a share of the time; still ones: fewer the longer they
//            stand, as each interrupts the shader for less and less news
#pragma once

#include <deque>

#include "view/view_mailbox.h"

namespace arris::view {

class FramePace {
 public:
  // Something moves; goes on for a moment, so that a slow hand does not flicker between the two.
  void note_move(Clock::time_point now);
  // The view changed otherwise: it stands still from now on.
  void note_change(Clock::time_point now) { still_since_ = now; }
  // idle: the shader has done all that it was asked for, or the frame itself was traced.
  void note_frame(Clock::time_point begin, Clock::time_point end, bool idle);

  [[nodiscard]] bool is_moving(Clock::time_point now) const { return now < moving_until_; }
  [[nodiscard]] Clock::time_point next_frame() const { return next_; }
  [[nodiscard]] Clock::time_point last_frame() const { return last_; }
  void hurry(Clock::time_point now);
  [[nodiscard]] double still_seconds(Clock::time_point now) const;
  [[nodiscard]] double fps(Clock::time_point now) const;
  [[nodiscard]] double frame_ms() const { return frame_ms_; }

 private:
  Clock::time_point moving_until_, still_since_, next_, earliest_, last_;
  std::deque<Clock::time_point> frames_;  // of the last second
  double frame_ms_ = 0;
};

}  // namespace arris::view
