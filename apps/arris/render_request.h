// render_request.h — the options of `arris render`, checked before any work begins
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "arris/command_line.h"
#include "arris/edge_point.h"
#include "arris/io.h"
#include "arris/render.h"
#include "arris/scene.h"
#include "arris/values.h"
#include "render/staging.h"

namespace arris::program {

enum class Integrator { path, beam, edge_point };

struct RenderRequest {
  std::string input;  // "-": stdin
  LoadOptions load;
  std::string output;  // "-": PNG to stdout; of frames: a pattern
  std::optional<FrameRange> frames;
  std::optional<std::string> stats;
  std::optional<std::filesystem::path> checkpoint;
  Integrator integrator = Integrator::path;
  BeamSettings beam;
  EdgePointSettings edge_point;
  StageOptions stage;
  std::optional<SampleRange> samples;  // empty: from 0 to the scene's
  bool is_part = false;                // to be joined with others
  double time_limit_seconds = 0;
  std::uint32_t seed = 0;
  int threads = 0;
  bool denoise = false;
  // Of the scene, if pixels are denoised, which are squares until then.
  ImageSettings::Filter filter = ImageSettings::Filter::box;
  std::vector<std::string> aovs;
  std::vector<std::string> shown_layers;  // of them, those that are also PNGs beside the picture
};

// Not of edge_point, which is no Renderer: edge_point_job.h.
std::unique_ptr<Renderer> make_renderer(Integrator integrator, const BeamSettings& beam = {});
const char* name_of(Integrator integrator);

RenderRequest make_render_request(const Arguments& arguments);

// Parts of it that other commands have, too.
StageOptions make_stage_options(const Arguments& arguments);
// --material list, which needs no input.
bool asks_for_materials(const Arguments& arguments);
int print_materials();
EdgePointShader parse_shader(const Arguments& arguments);
// Of a frame that is traced instead: 60 a second.
inline constexpr double kTraceBelowMs = 16;

void apply_image_options(ImageSettings& image, const Arguments& arguments);

// Before the scene is prepared: takes the pixel filter out of it, which is applied to what is denoised.
void make_pixels_squares(Scene& scene, RenderRequest& request);

// Size, depth, exposure, rounding and staging as the options say.
StagingReport apply_request(Scene& scene, const RenderRequest& request, const Arguments& arguments);

}  // namespace arris::program
