#include "arris/render_request.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

#include "arris/error.h"
#include "arris/values.h"
#include "base/nearest_name.h"
#include "io/picture_file.h"
#include "scene/material_presets.h"

namespace arris::program {
namespace {

constexpr std::uint32_t kMostSamples = 1U << 24U;

// Late surprises after hours of rendering are the worst.
void check_writable(const std::filesystem::path& path) {
  const std::filesystem::path folder =
      path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  const auto fail = [&](const std::string& what) {
    throw Error(Error::Kind::failed, path.string(), what);
  };
  if (!std::filesystem::is_directory(folder)) {
    fail(fmt::format("can't be written: there is no folder {}", folder.string()));
  }
  if (std::filesystem::is_directory(path)) fail("can't be written: it is a folder");
  if (::access(folder.c_str(), W_OK) != 0) {
    fail(fmt::format("can't be written: the folder {} is write-protected", folder.string()));
  }
}

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
    camera.fov_deg = parse_real(*given, {0.01, 170});
  }
  return camera;
}

StageOptions make_stage_options(const Arguments& arguments, const std::filesystem::path& input) {
  StageOptions stage;
  stage.source =
      input.extension() == ".toml" ? StageOptions::Source::scene_file : StageOptions::Source::model;
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

void check_integrator(const Arguments& arguments) {
  const auto given = find_given(arguments, "--integrator");
  if (!given) return;
  if (given->text == "beam" || given->text == "edge-point") {
    throw Error(Error::Kind::input, "",
                fmt::format("integrator {} is not in this build; use path", given->text));
  }
  parse_choice(*given, {"path"});
}

std::vector<std::string> parse_aovs(const Arguments& arguments) {
  const auto given = find_given(arguments, "--aov");
  if (!given) return {};
  const std::vector<std::string> known = make_path_renderer()->aovs();
  std::vector<std::string> aovs;
  for (const std::string& name : parse_list(*given)) {
    if (name == "coverage_lo" || name == "coverage_hi" || name == "uncertified") {
      throw Error(Error::Kind::input, "--aov",
                  fmt::format("{} needs the integrator beam, which is not in this build", name));
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
  check_writable(*output);
  return *output;
}

}  // namespace

RenderRequest make_render_request(const Arguments& arguments) {
  RenderRequest request;
  request.input = arguments.positionals[0];
  request.load = load_options_of(arguments);
  request.output = parse_output(arguments);
  check_integrator(arguments);
  request.aovs = parse_aovs(arguments);
  request.stage = make_stage_options(arguments, request.input);
  request.samples = make_samples(arguments);
  request.threads = threads_of(arguments);
  if (const auto given = find_given(arguments, "--time")) {
    request.time_limit_seconds = parse_real(*given, {0.01, 1e8});
  }
  if (const auto given = find_given(arguments, "--seed")) {
    request.seed = std::uint32_t(parse_count(*given, 0, 0xFFFFFFFF));
  }
  if (const auto path = arguments.find("--stats")) {
    if (*path != "-") check_writable(*path);
    if (*path == "-" && request.output == "-") {
      throw Error(Error::Kind::input, "--stats", "and -o can't both be written to stdout");
    }
    request.stats = path;
  }
  if (const auto path = arguments.find("--checkpoint")) {
    if (picture_format(*path) != PictureFormat::exr) {
      throw Error(Error::Kind::input, "--checkpoint", "needs a file that ends in .exr");
    }
    check_writable(*path);
    request.checkpoint = *path;
  }
  // Checked here, applied later.
  with_rounding_options({}, arguments);
  ImageSettings unused;
  apply_image_options(unused, arguments);
  return request;
}

void apply_image_options(ImageSettings& image, const Arguments& arguments) {
  constexpr std::uint64_t kMostDepth = 1024;
  constexpr double kMostStops = 32;
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

StagingReport apply_request(Scene& scene, const RenderRequest& request,
                            const Arguments& arguments) {
  apply_image_options(scene.image, arguments);
  const StagingReport report = stage_model(scene, request.stage);
  apply_rounding_options(scene, arguments);
  // The ground that staging has added stays sharp.
  if (report.ground_triangles > 0) scene.objects.back().rounding = RoundingSettings{};
  return report;
}

}  // namespace arris::program
