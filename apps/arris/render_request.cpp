#include "arris/render_request.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <iterator>
#include <string_view>

#include "arris/error.h"
#include "arris/frame_files.h"
#include "arris/output_files.h"
#include "arris/values.h"
#include "base/nearest_name.h"
#include "io/file_kind.h"
#include "io/picture_file.h"
#include "scene/limits.h"
#include "scene/material_presets.h"

namespace arris::program {
namespace {

Material parse_material(const Given& given) {
  const auto material = find_material_preset(given.text);
  if (material) return *material;
  throw Error(Error::Kind::input, given.option,
              fmt::format("\"{}\" is no material{}; --material list shows all", given.text,
                          did_you_mean(given.text, material_preset_names())));
}

CameraOptions make_camera_options(const Arguments& arguments) {
  CameraOptions camera;
  if (const auto given = find_given(arguments, "--camera-position")) {
    camera.position = parse_vector(*given);
  }
  if (const auto given = find_given(arguments, "--camera-target")) {
    camera.target = parse_vector(*given);
  }
  if (const auto given = find_given(arguments, "--camera-up")) {
    camera.up = parse_vector(*given);
    if (length(*camera.up) == 0) {
      throw Error(Error::Kind::input, "--camera-up", "0,0,0 is no direction; use 0,0,1 or 0,1,0");
    }
  }
  if (const auto given = find_given(arguments, "--fov")) {
    camera.fov_deg = parse_real(*given, {kMinFovDeg, kMaxFovDeg});
  }
  return camera;
}

std::optional<SampleRange> make_samples(const Arguments& arguments) {
  const auto samples = find_given(arguments, "--samples");
  const auto spp = find_given(arguments, "--spp");
  if (samples && spp) {
    throw Error(Error::Kind::input, "--samples",
                "can't be used together with --spp; its range says how many samples");
  }
  if (samples) return parse_samples(*samples);
  if (spp) return SampleRange{0, std::uint32_t(parse_count(*spp, 1, kMostSamples))};
  if (arguments.has("--time")) return SampleRange{0, kMostSamples};
  return std::nullopt;
}

constexpr Integrator kIntegrators[] = {Integrator::path, Integrator::beam, Integrator::edge_point};
// What the paper's scenes have, of pixels shaded a frame.
constexpr double kFrameDensity = 0.02;
constexpr double kMostDensity = 0.2;  // of frames before which much has changed
constexpr std::uint64_t kMostPointPaths = 65536;

Integrator parse_integrator(const Arguments& arguments) {
  const auto given = find_given(arguments, "--integrator");
  if (!given) return Integrator::path;
  return kIntegrators[parse_choice(*given, {"path", "beam", "edge-point"})];
}

EdgePointSettings parse_edge_point_settings(const Arguments& arguments, Integrator integrator) {
  for (const char* option :
       {"--shader", "--density", "--edges", "--point-paths", "--trace-below"}) {
    if (!arguments.has(option) || integrator == Integrator::edge_point) continue;
    throw Error(Error::Kind::input, option, "needs --integrator edge-point");
  }
  EdgePointSettings settings;
  settings.shader = parse_shader(arguments);
  // A view that stands still is worked on all over.
  settings.density = arguments.has("--frames") ? kFrameDensity : 1;
  if (const auto given = find_given(arguments, "--density")) {
    settings.density = parse_real(*given, {1e-4, 1});
  } else {
    settings.most_density = kMostDensity;
  }
  // Frames are as dense from the first on; a single picture is soon there.
  if (arguments.has("--frames")) {
    settings.first_density = std::max(settings.first_density, settings.density);
  }
  if (const auto given = find_given(arguments, "--edges")) {
    settings.use_edges = parse_choice(*given, {"off", "on"}) == 1;
  }
  if (const auto given = find_given(arguments, "--point-paths")) {
    settings.paths_per_point = int(parse_count(*given, 1, kMostPointPaths));
  }
  // A view that stands still goes over to paths by itself.
  settings.trace_below_ms = arguments.has("--frames") ? kTraceBelowMs : 0;
  if (const auto given = find_given(arguments, "--trace-below")) {
    if (!arguments.has("--frames")) {
      throw Error(Error::Kind::input, "--trace-below",
                  "needs --frames: a view that stands still goes over to paths by itself");
    }
    settings.trace_below_ms = parse_real(*given, {0, 1e9});
  }
  return settings;
}

// Its pictures are no sums of samples.
void check_edge_point_options(const Arguments& arguments) {
  for (const char* option : {"--checkpoint", "--samples"}) {
    if (!arguments.has(option)) continue;
    throw Error(Error::Kind::input, option,
                "can't be used with --integrator edge-point, whose pictures are not sums of "
                "samples; leave it out or use --integrator path");
  }
  for (const char* option : {"--time", "--spp"}) {
    if (!arguments.has(option) || !arguments.has("--frames")) continue;
    throw Error(Error::Kind::input, option,
                "can't be used with the frames of --integrator edge-point; --density says how "
                "much is shaded for each");
  }
}

BeamSettings parse_beam_settings(const Arguments& arguments, Integrator integrator) {
  for (const char* option : {"--beam-rule", "--light-beams"}) {
    if (!arguments.has(option) || integrator == Integrator::beam) continue;
    throw Error(Error::Kind::input, option, "needs --integrator beam");
  }
  BeamSettings settings;
  if (const auto given = find_given(arguments, "--beam-rule")) {
    constexpr BeamRule kRules[] = {BeamRule::certified, BeamRule::corners};
    settings.rule = kRules[parse_choice(*given, {"certified", "corners"})];
  }
  if (const auto given = find_given(arguments, "--light-beams")) {
    settings.light_beams = int(parse_count(*given, 0, kMostLightBeams));
  }
  return settings;
}

// The beam renderer goes through the picture once.
void check_beam_options(const Arguments& arguments) {
  for (const char* option : {"--time", "--checkpoint", "--samples"}) {
    if (!arguments.has(option)) continue;
    throw Error(Error::Kind::input, option,
                "can't be used with --integrator beam, which makes its picture in one pass; leave "
                "it out or use --integrator path");
  }
}

bool parse_denoise(const Arguments& arguments, Integrator integrator) {
  const auto given = find_given(arguments, "--denoise");
  if (!given || parse_choice(*given, {"none", "edges"}) == 0) return false;
  if (integrator != Integrator::path) {
    throw Error(Error::Kind::input, "--denoise",
                fmt::format("can't be used with --integrator {}, whose pictures have other noise",
                            name_of(integrator)));
  }
  if (arguments.has("--samples")) {
    throw Error(Error::Kind::input, "--denoise",
                "can't be used with --samples: what is denoised can't be joined with other parts");
  }
  return true;
}

std::vector<std::string> aovs_of(Integrator integrator) {
  if (integrator == Integrator::edge_point) return {"edges"};
  return make_renderer(integrator)->aovs();
}

std::vector<std::string> parse_aovs(const Arguments& arguments, Integrator integrator) {
  const auto given = find_given(arguments, "--aov");
  if (!given) return {};
  const std::vector<std::string> known = aovs_of(integrator);
  std::vector<std::string> aovs;
  for (const std::string& name : parse_list(*given)) {
    for (const Integrator other : kIntegrators) {
      const std::vector<std::string> names = aovs_of(other);
      const bool is_known = std::ranges::find(known, name) != known.end();
      if (is_known || std::ranges::find(names, name) == names.end()) continue;
      throw Error(Error::Kind::input, "--aov",
                  fmt::format("{} needs --integrator {}", name, name_of(other)));
    }
    parse_choice({"--aov", name}, known);
    if (std::find(aovs.begin(), aovs.end(), name) == aovs.end()) aovs.push_back(name);
  }
  return aovs;
}

std::string parse_output(const Arguments& arguments) {
  const auto output = arguments.find("--output");
  if (!output) {
    throw Error(Error::Kind::input, "", "arris render needs an output file: -o picture.png");
  }
  if (*output == "-") {
    if (arguments.has("--aov")) {
      throw Error(Error::Kind::input, "--aov", "needs an output file, not stdout");
    }
    if (::isatty(STDOUT_FILENO) == 1) {
      throw Error(Error::Kind::input, "-o -",
                  "would write a PNG to the terminal; use a pipe or file");
    }
    return *output;
  }
  picture_format(*output);
  return *output;
}

// Values of these go from 0 to 1; and few programs show what is not 8-bit.
std::vector<std::string> find_shown_layers(const RenderRequest& request) {
  constexpr std::string_view kWithin01[] = {"albedo",      "rounded",     "bevel_fac",
                                            "coverage_lo", "coverage_hi", "uncertified",
                                            "regions",     "edges"};
  if (request.output == "-") return {};
  const PictureFormat format = picture_format(request.output);
  if (format != PictureFormat::png && format != PictureFormat::jpeg) return {};
  std::vector<std::string> shown;
  std::ranges::copy_if(request.aovs, std::back_inserter(shown), [&](const std::string& aov) {
    return std::ranges::find(kWithin01, aov) != std::end(kWithin01);
  });
  return shown;
}

// Of one picture, whose name is `output`.
void check_files_of(const RenderRequest& request, const std::string& output) {
  std::vector<NamedFile> outputs;
  if (output != "-") {
    outputs.push_back({"-o", output});
    if (picture_format(output) != PictureFormat::exr) {
      for (const std::string& aov : request.aovs) {
        outputs.push_back({"--aov " + aov, layer_file(output, aov)});
      }
    }
  }
  for (const std::string& layer : request.shown_layers) {
    outputs.push_back({"--aov " + layer, shown_layer_file(output, layer)});
  }
  if (request.stats && *request.stats != "-") outputs.push_back({"--stats", *request.stats});
  if (request.checkpoint) outputs.push_back({"--checkpoint", *request.checkpoint});
  const NamedFile input{"INPUT", request.input};
  check_outputs(outputs, {&input, 1});
}

void check_files(const RenderRequest& request) {
  if (!request.frames) return check_files_of(request, request.output);
  for (int frame = request.frames->first; frame < request.frames->last; ++frame) {
    check_files_of(request, frame_file(request.output, frame));
  }
}

std::optional<FrameRange> make_frames(const Arguments& arguments, const std::string& output) {
  const auto given = find_given(arguments, "--frames");
  if (!given) return std::nullopt;
  const FrameRange frames = parse_frames(*given);
  if (output == "-") {
    throw Error(Error::Kind::input, "--frames",
                "needs output files, such as f_####.png, not stdout");
  }
  if (arguments.has("--checkpoint")) {
    throw Error(Error::Kind::input, "--checkpoint",
                "can't be used with --frames; each frame is a file that is kept when the render is "
                "stopped: go on with --frames from the first that is missing");
  }
  const std::string problem = problem_with_pattern(output);
  if (!problem.empty()) throw Error(Error::Kind::input, output, problem);
  return frames;
}

}  // namespace

std::unique_ptr<Renderer> make_renderer(Integrator integrator, const BeamSettings& beam) {
  return integrator == Integrator::beam ? make_beam_renderer(beam) : make_path_renderer();
}
const char* name_of(Integrator integrator) {
  switch (integrator) {
    case Integrator::beam:
      return "beam";
    case Integrator::edge_point:
      return "edge-point";
    case Integrator::path:
      break;
  }
  return "path";
}

StageOptions make_stage_options(const Arguments& arguments) {
  StageOptions stage;
  if (const auto given = find_given(arguments, "--lighting")) {
    constexpr Lighting kLightings[] = {Lighting::studio, Lighting::sky, Lighting::white};
    stage.lighting = kLightings[parse_choice(*given, {"studio", "sky", "white"})];
  }
  if (const auto given = find_given(arguments, "--ground")) {
    stage.ground = parse_choice(*given, {"off", "on"}) == 1;
  }
  if (const auto given = find_given(arguments, "--material"))
    stage.material = parse_material(*given);
  stage.camera = make_camera_options(arguments);
  return stage;
}

bool asks_for_materials(const Arguments& arguments) {
  return arguments.find("--material") == "list";
}

int print_materials() {
  for (const MaterialPreset& preset : material_presets()) {
    fmt::print("{:<16}{}\n", preset.name, preset.description);
  }
  return 0;
}

EdgePointShader parse_shader(const Arguments& arguments) {
  constexpr EdgePointShader kShaders[] = {EdgePointShader::direct, EdgePointShader::glossy,
                                          EdgePointShader::gi};
  const auto given = find_given(arguments, "--shader");
  return given ? kShaders[parse_choice(*given, {"direct", "glossy", "gi"})] : EdgePointShader::gi;
}

RenderRequest make_render_request(const Arguments& arguments) {
  RenderRequest request;
  request.input = arguments.positionals[0];
  request.load = load_options_of(arguments);
  request.output = parse_output(arguments);
  request.frames = make_frames(arguments, request.output);
  request.integrator = parse_integrator(arguments);
  request.beam = parse_beam_settings(arguments, request.integrator);
  request.edge_point = parse_edge_point_settings(arguments, request.integrator);
  if (request.integrator == Integrator::beam) check_beam_options(arguments);
  if (request.integrator == Integrator::edge_point) check_edge_point_options(arguments);
  request.denoise = parse_denoise(arguments, request.integrator);
  request.aovs = parse_aovs(arguments, request.integrator);
  request.shown_layers = find_shown_layers(request);
  request.stage = make_stage_options(arguments);
  request.stage.rounded = request.integrator != Integrator::beam;  // which sees meshes as they are
  request.samples = make_samples(arguments);
  request.is_part = arguments.has("--samples");
  request.threads = threads_of(arguments);
  if (const auto given = find_given(arguments, "--time")) {
    request.time_limit_seconds = parse_real(*given, {0.01, 1e8});
  }
  if (const auto given = find_given(arguments, "--seed")) {
    request.seed = std::uint32_t(parse_count(*given, 0, 0xFFFFFFFF));
  }
  if (const auto path = arguments.find("--stats")) {
    if (*path == "-" && request.output == "-") {
      throw Error(Error::Kind::input, "--stats", "and -o can't both be written to stdout");
    }
    request.stats = path;
  }
  if (const auto path = arguments.find("--checkpoint")) {
    if (picture_format(*path) != PictureFormat::exr) {
      throw Error(Error::Kind::input, "--checkpoint", "needs a file that ends in .exr");
    }
    request.checkpoint = *path;
  }
  check_files(request);
  // Checked here, applied later.
  with_rounding_options({}, arguments);
  ImageSettings unused;
  apply_image_options(unused, arguments);
  return request;
}

void apply_image_options(ImageSettings& image, const Arguments& arguments) {
  constexpr std::uint64_t kMostDepth = 1024;
  if (const auto given = find_given(arguments, "--size")) {
    const Size size = parse_size(*given);
    image.width_px = size.width_px;
    image.height_px = size.height_px;
  }
  if (const auto given = find_given(arguments, "--max-depth")) {
    image.max_depth = int(parse_count(*given, 0, kMostDepth));
  }
  if (const auto given = find_given(arguments, "--exposure")) {
    image.exposure = parse_real(*given, {-kMostStops, kMostStops});
  }
}

void make_pixels_squares(Scene& scene, RenderRequest& request) {
  request.filter = scene.image.filter;
  scene.image.filter = ImageSettings::Filter::box;
}

StagingReport apply_request(Scene& scene, const RenderRequest& request,
                            const Arguments& arguments) {
  apply_image_options(scene.image, arguments);
  const PictureFormat format =
      request.output == "-" ? PictureFormat::png : picture_format(request.output);
  const std::string problem =
      problem_with_size(format, scene.image.width_px, scene.image.height_px);
  if (!problem.empty()) throw Error(Error::Kind::input, request.output, problem);
  const StagingReport report = stage_model(scene, request.stage);
  apply_rounding_options(scene, arguments);
  // The ground that staging has added stays sharp.
  if (report.ground_triangles > 0) scene.objects.back().rounding = RoundingSettings{};
  return report;
}

}  // namespace arris::program
