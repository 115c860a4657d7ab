// camera_move.h — the paper's Fig. 11: share of rays affected and increase of time along a camera move
#pragma once

#include <string>
#include <vector>

#include "rounding/scenes.h"
#include "rounding/table.h"

namespace arris::bench {

struct MoveFrame {
  double affected = 0;  // share of all rays
  double none_seconds = 0, exact_seconds = 0;
  double ratio = 0;  // exact to none, of processor time, median over the rounds
};

std::vector<MoveFrame> measure_camera_move(const BenchScene& bench, int frames,
                                           const TableOptions& options);
std::string text_of(const std::vector<MoveFrame>& frames);

}  // namespace arris::bench
