// shown_view.h — a view that frames can be made of
// What       a model with edits, prepared, and the engines that make frames of it. build_view() makes one, in any
//            thread, from what the view before has if that serves; it ends when there is something to see.
// Errors     arris::Error: what prepare_scene() throws
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "arris/edge_point.h"
#include "arris/render.h"
#include "view/view_stage.h"

namespace arris::view {

// Ends what is prepared or made of a view: all of it throws Error{failed} then.
using StopFlag = std::shared_ptr<std::atomic<bool>>;

struct ShownView {
  StopFlag stop;  // first: the engines look at it
  std::shared_ptr<const ViewModel> model;
  ViewEdits edits;
  StagedView staged;
  std::vector<Bounds> bounds;                  // first_bounds()
  std::vector<std::optional<double>> inradii;  // first_inradii()
  std::unique_ptr<EdgePointEngine> engine;
  std::unique_ptr<EdgePointEngine> compared;  // null: nothing is compared
};

struct BuildSettings {
  int threads = 0;
  double trace_below_ms = 16;                // EdgePointSettings::trace_below_ms
  const std::atomic<bool>* hurry = nullptr;  // EdgePointSettings::hurry
  StopFlag stop = std::make_shared<std::atomic<bool>>(false);
};

// What of a view before can be used. Its scenes are const, its engine goes on.
struct UsableView {
  std::shared_ptr<const ViewModel> model;
  ViewEdits edits;
  StagedView staged;
  std::vector<std::optional<double>> inradii;
  std::shared_ptr<const PreparedScene> scene, compared;
};
UsableView usable_parts(const ShownView& view);

ShownView build_view(std::shared_ptr<const ViewModel> model, const ViewEdits& edits,
                     const BuildSettings& settings, const std::optional<UsableView>& before = {});

// The default rounding that a scene was prepared with.
RoundingSettings default_rounding(const PreparedScene& prepared);

}  // namespace arris::view
