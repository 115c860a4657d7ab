#include "beam_growth.h"

#include <fmt/format.h>

#include <cstdio>
#include <ctime>
#include <memory>
#include <utility>
#include <vector>

#include "arris/io.h"
#include "arris/render.h"
#include "interleaved.h"
#include "random_solids.h"

namespace arris::bench {
namespace {

constexpr double kLeastSize = 0.3;  // of a heap's solids, to the largest

struct Timed {
  std::string name;
  std::shared_ptr<const Renderer> renderer;
  std::uint32_t samples = 1;
};

struct Case {
  std::string name;
  std::shared_ptr<const PreparedScene> prepared;
  struct Times {
    std::vector<double> seconds, cpu_seconds;
    RenderResult first;
  };
  std::vector<Times> times;  // one per renderer
};

// Matt grey under a sun and a lamp, on black.
Scene scene_of_tree(CsgTree tree, const Camera& camera, int width_px) {
  Scene scene;
  scene.meshes.emplace_back();
  Material grey;
  grey.base_color = {0.6F, 0.6F, 0.6F};
  grey.glossy_mix = 0.0F;
  scene.materials.push_back(grey);
  scene.csg_trees.push_back(std::move(tree));
  Object object;
  object.name = "solid";
  object.csg = CsgId{0};
  scene.objects.push_back(object);
  scene.lights.emplace_back(DirectionalLight{{-0.3, 0.5, -0.8}, Rgb(2)});
  scene.lights.emplace_back(PointLight{{-3, -2, 4}, Rgb(20)});
  scene.camera = camera;
  scene.environment = ConstantEnvironment{};
  scene.image.width_px = width_px;
  scene.image.height_px = width_px * 3 / 4;
  scene.image.max_depth = 1;
  scene.image.filter = ImageSettings::Filter::box;
  return scene;
}

Case make_case(std::string name, Scene scene, int threads) {
  Case made;
  made.name = std::move(name);
  made.prepared = prepare_scene(std::move(scene), {.threads = threads});
  return made;
}

void render_in_turn(std::vector<Case>& cases, const std::vector<Timed>& renderers,
                    const BeamGrowthSettings& settings) {
  for (Case& c : cases) c.times.resize(renderers.size());
  for (int round = 0; round < settings.rounds; ++round) {
    for (std::size_t k = 0; k < cases.size(); ++k) {
      Case& c = cases[round % 2 == 0 ? k : cases.size() - 1 - k];
      for (std::size_t r = 0; r < renderers.size(); ++r) {
        RenderOptions options;
        options.samples = {0, renderers[r].samples};
        options.threads = settings.threads;
        const std::clock_t start = std::clock();
        RenderResult result = renderers[r].renderer->render(*c.prepared, options);
        c.times[r].cpu_seconds.push_back(double(std::clock() - start) / CLOCKS_PER_SEC);
        c.times[r].seconds.push_back(result.seconds);
        if (round == 0) c.times[r].first = std::move(result);
      }
    }
  }
}

void print_cases(const std::string& title, const std::vector<Case>& cases, const Case& base,
                 const std::vector<Timed>& renderers) {
  fmt::print("{:<28} {:<15} {:>8} {:>8} {:>8} {:>7} {:>7} {:>11} {:>8}\n", title, "renderer",
             "build s", "seconds", "cpu s", "ratio", "cpu", "rays", "unsure");
  for (const Case& c : cases) {
    for (std::size_t r = 0; r < renderers.size(); ++r) {
      const Case::Times& times = c.times[r];
      fmt::print("{:<28} {:<15} {:>8.2f} {:>8.2f} {:>8.2f} {:>7.2f} {:>7.2f} {:>11} {:>8}\n",
                 c.name, renderers[r].name, prepare_stats(*c.prepared).build_seconds,
                 median(times.seconds), median(times.cpu_seconds),
                 median_ratio(times.seconds, base.times[r].seconds),
                 median_ratio(times.cpu_seconds, base.times[r].cpu_seconds), times.first.rays.total,
                 times.first.beam ? fmt::format("{}", times.first.beam->uncertified_pixels) : "");
    }
  }
  fmt::print("\n");
  std::fflush(stdout);
}

void measure(const std::string& title, std::vector<Case> cases, std::size_t base,
             const BeamGrowthSettings& settings) {
  const std::vector<Timed> renderers{{"beam certified", make_beam_renderer(), 1},
                                     {fmt::format("path {}", settings.path_samples),
                                      make_path_renderer(), std::uint32_t(settings.path_samples)}};
  render_in_turn(cases, renderers, settings);
  print_cases(title, cases, cases[base], renderers);
}

std::vector<Case> heaps(const BeamGrowthSettings& settings) {
  const Camera camera{.position = {2.1, -1.6, 1.9}, .target = Vec3d(0.5), .fov_deg = 32};
  std::vector<Case> cases;
  for (int n = 100; n <= settings.largest; n *= 10) {
    cases.push_back(make_case(fmt::format("heap of {}", n),
                              scene_of_tree(make_heap(n, kLeastSize), camera, settings.width_px),
                              settings.threads));
  }
  return cases;
}

std::vector<Case> sizes(const BeamGrowthSettings& settings) {
  std::vector<Case> cases;
  for (int width = settings.width_px / 2; width <= 2 * settings.width_px; width *= 2) {
    Scene scene = load_scene(settings.folder + "/plate.toml");
    scene.image.width_px = width;
    scene.image.height_px = width * 3 / 4;
    std::string name = fmt::format("plate, {}x{}", width, scene.image.height_px);
    cases.push_back(make_case(std::move(name), std::move(scene), settings.threads));
  }
  return cases;
}

std::vector<Case> plates(const BeamGrowthSettings& settings) {
  const Camera camera{.position = {1.3, -1.1, 1.2}, .target = {0.5, 0.5, 0}, .fov_deg = 35};
  std::vector<Case> cases;
  cases.push_back(make_case("400 tiles with a hole each",
                            scene_of_tree(make_plate(PlateForm::tiles), camera, settings.width_px),
                            settings.threads));
  cases.push_back(
      make_case("one difference of 400 holes",
                scene_of_tree(make_plate(PlateForm::one_difference), camera, settings.width_px),
                settings.threads));
  return cases;
}

}  // namespace

void run_beam_growth(const BeamGrowthSettings& settings) {
  std::vector<Case> growth = heaps(settings);
  const std::size_t thousand = growth.size() > 1 ? 1 : 0;
  measure("primitives", std::move(growth), thousand, settings);
  if (!settings.folder.empty()) measure("size", sizes(settings), 1, settings);
  measure("holes", plates(settings), 0, settings);
}

}  // namespace arris::bench
