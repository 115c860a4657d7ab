// view_report.h — what the server says to the page, as text (docs/view-protocol.md)
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "arris/edge_point.h"
#include "arris/render.h"
#include "render/shoot.h"
#include "view/beam_worker.h"
#include "view/shown_view.h"

namespace arris::view {

struct ServerFacts {
  bool upload = false;      // whether models may be dropped
  std::uint32_t model = 1;  // how many have been opened; the same one read again is none of them
};
// edits: what the view is to be, which may be ahead of what it shows.
std::string scene_message(const ShownView& view, const ViewEdits& edits, const ServerFacts& facts);
// The same for one client: the newest of its inputs that is in it, or 0.
std::string with_seq(const std::string& scene_message, std::uint32_t seq);
std::string camera_message(const Camera& camera);

struct ViewState {
  double fps = 0, frame_ms = 0, seconds = 0;
  double new_samples = 0;  // part of the pixels
  bool moving = false, converged = false;
  EdgePointStats stats;
};
std::string state_message(const ViewState& state, const PreparedScene& prepared);

std::string picked_message(std::optional<std::uint32_t> seq, const std::optional<Shot>& shot,
                           std::optional<std::uint32_t> object);
std::string beam_message(const BeamWorker::Status& status);
// Empty: the work has ended.
std::string busy_message(const std::string& what);
// What follows the first "; " is the remedy. about: the type of the message that caused it, kAboutFile, or nothing.
std::string error_message(std::optional<std::uint32_t> seq, const std::string& what,
                          const std::string& about = {});
inline constexpr const char* kAboutFile = "file";
// Errors of this kind hold no longer; empty: all.
std::string no_error_message(const std::string& about = {});

}  // namespace arris::view
