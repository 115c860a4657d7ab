// bench_peers — the two scenes on which Cycles was measured, at the same size, samples and depth
// In         scene1_none.glb and blocks_none.glb with a .json of camera, light and materials beside each, in the folder
//            of --data or $ARRIS_DATA_DIR/mesh
// Out        seconds, million paths per second and the ratio to Cycles' path tracing time
#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "arris/io.h"
#include "arris/render.h"
#include "interleaved.h"

namespace {

using namespace arris;         // NOLINT(google-build-using-namespace): a program's one file
using namespace arris::bench;  // NOLINT(google-build-using-namespace)
using nlohmann::json;

// Cycles 3.4.1 without rounding on two cores of an AMD EPYC: 960×540, 16 samples, path tracing time.
struct Peer {
  const char* file;
  double cycles_seconds;
};
constexpr Peer kPeers[] = {{"scene1_none", 8.8}, {"blocks_none", 8.7}};

struct Arguments {
  std::string data, pictures;
  std::uint32_t samples_per_pixel = 16;
  int rounds = 3, threads = 0;
};

Vec3d vec3_of(const json& list) {
  return {list.at(0), list.at(1), list.at(2)};
}
Rgb rgb_of(const json& list) {
  return Rgb(vec3_of(list));
}

void set_materials(Scene& scene, const json& described) {
  const json& model = described.at("materials");
  for (Material& m : scene.materials) {
    const bool is_ground = m.name == "ground";
    if (!is_ground && !model.at("colors_linear").contains(m.name))
      throw std::runtime_error("material \"" + m.name + "\" is not in the .json");
    m.base_color = rgb_of(is_ground ? model.at("ground") : model.at("colors_linear").at(m.name));
    m.roughness = model.at("blender_roughness");
    m.glossy_mix = model.at("w").get<float>();
  }
}

void set_view_and_light(Scene& scene, const json& described) {
  const json& view = described.at("y_up_as_in_glb_and_obj");
  const json& camera = view.at("camera");
  scene.camera = Camera{.position = vec3_of(camera.at("position")),
                        .target = vec3_of(camera.at("target")),
                        .up = vec3_of(camera.at("up")),
                        .fov_deg = camera.at("vertical_fov_deg")};
  const json& lamp = view.at("area_light");
  const Vec3d u = vec3_of(lamp.at("axis_u")) * lamp.at("size_u").get<double>();
  const Vec3d v = vec3_of(lamp.at("axis_v")) * lamp.at("size_v").get<double>();
  const Vec3d corner = vec3_of(lamp.at("center")) - (u + v) * 0.5;
  const bool faces_away = dot(cross(u, v), vec3_of(lamp.at("normal"))) < 0;
  scene.lights = {AreaLight{.corner = corner,
                            .edge_u = faces_away ? v : u,
                            .edge_v = faces_away ? u : v,
                            .radiance = Rgb(lamp.at("radiance").get<float>()),
                            .visible_to_camera = false}};
  scene.environment = ConstantEnvironment{rgb_of(described.at("sky").at("radiance"))};
  scene.image = {.width_px = camera.at("width"),
                 .height_px = camera.at("height"),
                 .samples_per_pixel = described.at("integrator").at("spp"),
                 .max_depth = described.at("integrator").at("max_bounces")};
  scene.image.filter = ImageSettings::Filter::box;
}

Scene load_peer(const std::filesystem::path& folder, const std::string& name, double& radius) {
  Scene scene = load_scene(folder / (name + ".glb"));
  std::ifstream file(folder / (name + ".json"));
  const json described = json::parse(file);
  set_materials(scene, described);
  set_view_and_light(scene, described);
  radius = described.at("bevel_radius");
  return scene;
}

Scene rounded(Scene scene, double radius) {
  RoundingSettings settings;
  settings.method = RoundMethod::exact;
  settings.radius = radius;
  scene.rounding = settings;
  for (Object& object : scene.objects)
    if (object.name == "ground") object.rounding = RoundingSettings{};
  return scene;
}

void measure(const Arguments& arguments, const Peer& peer) {
  double radius = 0;
  const Scene scene = load_peer(arguments.data, peer.file, radius);
  std::vector<Variant> variants{{"none", prepare_scene(scene)},
                                {"exact", prepare_scene(rounded(scene, radius))}};
  InterleavedOptions options;
  options.rounds = arguments.rounds;
  options.render.samples = {0, arguments.samples_per_pixel};
  options.render.threads = arguments.threads;
  if (!arguments.pictures.empty()) {
    std::filesystem::create_directories(arguments.pictures);
    options.on_picture = [&](const Variant& v, const RenderResult& result) {
      for (const char* extension : {".png", ".exr"})
        save_picture(result.picture, std::filesystem::path(arguments.pictures) /
                                         (std::string(peer.file) + "-" + v.name + extension));
    };
  }
  const std::vector<Timing> timings = render_interleaved(variants, options);
  const PrepareStats& stats = prepare_stats(*variants[1].prepared);
  std::printf(
      "%s: %llu triangles, radius %g, %llu edges and %llu corners rounded in %.3f s, %.2f MB\n",
      peer.file, static_cast<unsigned long long>(stats.triangles), radius,
      static_cast<unsigned long long>(stats.rounded_edges),
      static_cast<unsigned long long>(stats.rounded_corners), stats.round_seconds,
      double(stats.rounding_bytes) / 1e6);
  const double cycles = peer.cycles_seconds * arguments.samples_per_pixel / 16;
  for (std::size_t i = 0; i < variants.size(); ++i) {
    const double seconds = median(timings[i].seconds);
    std::printf(
        "  %-6s %7.3f s  %6.3f Mpaths/s  %6.2f Mrays/s  %5.3f of none (processor time)  %5.3f of "
        "Cycles without "
        "rounding (%.2f s)  %.2f%% of rays rounded\n",
        variants[i].name.c_str(), seconds, double(timings[i].rays.camera) / seconds / 1e6,
        double(timings[i].rays.total) / seconds / 1e6,
        median_ratio(timings[i].cpu_seconds, timings[0].cpu_seconds), seconds / cycles, cycles,
        100.0 * double(timings[i].rays.rounded) / double(timings[i].rays.total));
  }
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  if (const char* data = std::getenv("ARRIS_DATA_DIR"))
    arguments.data = std::string(data) + "/mesh";
  CLI::App app("The scenes on which Cycles was measured");
  app.add_option("--data", arguments.data,
                 "folder of scene1_none.glb, blocks_none.glb and their .json");
  app.add_option("--spp", arguments.samples_per_pixel)->capture_default_str();
  app.add_option("--rounds", arguments.rounds)->capture_default_str();
  app.add_option("--threads", arguments.threads, "0: all")->capture_default_str();
  app.add_option("--pictures", arguments.pictures, "save the pictures in this folder");
  CLI11_PARSE(app, argc, argv);
  try {
    for (const Peer& peer : kPeers) {
      if (!std::filesystem::exists(std::filesystem::path(arguments.data) /
                                   (std::string(peer.file) + ".glb"))) {
        std::printf("%s: skipped, no such file in \"%s\"; give the folder with --data\n", peer.file,
                    arguments.data.c_str());
        continue;
      }
      measure(arguments, peer);
    }
  } catch (const std::exception& e) {
    std::fprintf(stderr, "bench_peers: %s\n", e.what());
    return 1;
  }
  return 0;
}
