// render_job.h — a render in chunks, with a time limit and a checkpoint
// What       run_job() renders the samples in chunks and adds them up. A checkpoint holds the exact sum so far, so
//            that going on from it gives the same bits.
// Errors     kind input: a checkpoint of another render; kind failed: stopped before the first sample
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <optional>

#include "arris/edge_point.h"
#include "arris/render.h"
#include "image/picture_sum.h"
#include "io/render_part.h"

namespace arris::program {

inline constexpr std::uint32_t kChunkSamples = 4;
inline constexpr double kCheckpointSeconds = 30;

struct RenderJob {
  RenderOptions options;
  RenderPart part;  // scene, seed and integrator; its samples are filled in
  std::optional<std::filesystem::path> checkpoint;
  std::uint32_t chunk_samples = kChunkSamples;
};

struct JobResult {
  PictureSum sum;
  RenderPart part;
  RayCounts rays;  // of this run
  std::optional<BeamCounts> beam;
  std::optional<EdgePointStats> edge_point;
  double seconds = 0;         // of this run
  std::uint64_t resumed = 0;  // samples from the checkpoint
  bool complete = false;      // all samples that were asked for
};

JobResult run_job(const Renderer& renderer, const PreparedScene& scene, const RenderJob& job);

}  // namespace arris::program
