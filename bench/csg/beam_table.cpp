// beam_table.cpp — missed objects, error, rays and seconds
// What       Truth is 256 rays a pixel on a regular grid with every light's shadow ray, so it has no noise. It is made
//            for every sixteenth pixel, on which the error (RMSE of linear light) is taken, and round each small
//            object. An object counts as missed if what it adds to the 3 x 3 pixels round it, against the median of
//            those 3 pixels away, is less than a tenth of what it adds in truth, at all its places.
#include "beam_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "arris/io.h"
#include "arris/render.h"
#include "base/parallel_for.h"
#include "render/beam_shading.h"
#include "render/camera.h"
#include "render/surface_point.h"

namespace arris::bench {
namespace {

constexpr int kGrid = 16;  // rays of truth a pixel and side
constexpr int kReach = 3;  // pixels round an object
constexpr float kUnknown = -1;

struct Place {
  int x, y;
};
struct SmallObject {
  std::string kind;
  std::vector<Place> places;
};

std::vector<SmallObject> load_objects(const std::string& folder, const std::string& scene) {
  std::ifstream file(folder + "/objects.json");
  const nlohmann::json json = nlohmann::json::parse(file);
  std::vector<SmallObject> objects;
  for (const auto& entry : json.at(scene)) {
    SmallObject object{entry.at("kind"), {}};
    const auto add = [&](double x, double y) {
      if (x > kReach && y > kReach && x < 640 - kReach - 1 && y < 480 - kReach - 1) {
        object.places.push_back({int(x), int(y)});
      }
    };
    if (entry.contains("points")) {
      for (const auto& p : entry.at("points")) add(p[0], p[1]);
    } else {
      add(entry.at("x"), entry.at("y"));
    }
    if (!object.places.empty()) objects.push_back(std::move(object));
  }
  return objects;
}

float luminance(const Image& image, int x, int y) {
  return (image.at(x, y, 0) + image.at(x, y, 1) + image.at(x, y, 2)) / 3;
}

bool counts_for_error(int x, int y) {
  return (x + 5 * y) % 16 == 0;
}

Image make_truth(const PreparedScene& scene, const std::vector<SmallObject>& objects, int threads) {
  const ImageSettings& settings = scene.scene().image;
  Image truth(settings.width_px, settings.height_px, 3);
  std::ranges::fill(truth.values, kUnknown);
  std::vector<bool> wanted(std::size_t(settings.width_px) * std::size_t(settings.height_px));
  const auto want = [&](int x, int y) {
    wanted[std::size_t(y) * std::size_t(settings.width_px) + std::size_t(x)] = true;
  };
  for (int y = 0; y < settings.height_px; ++y) {
    for (int x = 0; x < settings.width_px; ++x) {
      if (counts_for_error(x, y)) want(x, y);
    }
  }
  for (const SmallObject& object : objects) {
    for (const Place& p : object.places) {
      for (int y = -kReach; y <= kReach; ++y) {
        for (int x = -kReach; x <= kReach; ++x) want(p.x + x, p.y + y);
      }
    }
  }
  const CameraRays camera = make_camera_rays(*scene.scene().camera, settings);
  const std::vector<BeamLight> lights = make_beam_lights(scene.geometry().lights, 0);
  parallel_for(wanted.size(), {.grain = 256, .threads = threads}, [&](std::size_t i) {
    if (!wanted[i]) return;
    const int x = int(i % std::size_t(settings.width_px)),
              y = int(i / std::size_t(settings.width_px));
    Rgb sum;
    PathRays rays;
    for (int k = 0; k < kGrid * kGrid; ++k) {
      const double px = x + (k % kGrid + 0.5) / kGrid, py = y + (k / kGrid + 0.5) / kGrid;
      KnownSight sight{camera_ray(camera, px, py), std::nullopt};
      sight.hit = scene.intersect(sight.ray);
      if (!sight.hit) continue;
      std::optional<SurfaceMaterial> storage;
      sum += material_at(scene, *sight.hit, storage).emission +
             direct_light(scene, lights, sight, {}, rays);
    }
    for (int c = 0; c < 3; ++c) truth.at(x, y, c) = sum[c] / (kGrid * kGrid);
  });
  return truth;
}

double rmse(const Image& image, const Image& truth) {
  double sum = 0;
  int count = 0;
  for (int y = 0; y < truth.height_px; ++y) {
    for (int x = 0; x < truth.width_px; ++x) {
      if (!counts_for_error(x, y)) continue;
      for (int c = 0; c < 3; ++c) {
        const double d = double(image.at(x, y, c)) - double(truth.at(x, y, c));
        sum += d * d;
        ++count;
      }
    }
  }
  return std::sqrt(sum / count);
}

// What stands out from the pixels round it.
double signal(const Image& image, Place p) {
  std::vector<float> rim;
  double sum = 0;
  for (int y = -kReach; y <= kReach; ++y) {
    for (int x = -kReach; x <= kReach; ++x) {
      const float value = luminance(image, p.x + x, p.y + y);
      if (std::max(std::abs(x), std::abs(y)) == kReach) rim.push_back(value);
      if (std::max(std::abs(x), std::abs(y)) <= 1) sum += double(value);
    }
  }
  std::ranges::nth_element(rim, rim.begin() + std::ptrdiff_t(rim.size() / 2));
  return sum - 9 * double(rim[rim.size() / 2]);
}

std::string count_missed(const Image& image, const Image& truth,
                         const std::vector<SmallObject>& objects) {
  int missed = 0, visible = 0;
  for (const SmallObject& object : objects) {
    int seen = 0, there = 0;
    for (const Place& p : object.places) {
      const double expected = signal(truth, p);
      if (std::abs(expected) < 2e-3) continue;
      ++there;
      seen += signal(image, p) / expected > 0.1 ? 1 : 0;
    }
    visible += there > 0 ? 1 : 0;
    missed += there > 0 && seen == 0 ? 1 : 0;
  }
  return fmt::format("{}/{}", missed, visible);
}

struct Row {
  std::string name;
  std::unique_ptr<Renderer> renderer;
  std::uint32_t samples;
};

void print_scene(const BeamTableSettings& settings, const std::string& name) {
  const auto prepared = prepare_scene(load_scene(settings.folder + "/" + name + ".toml"),
                                      {.threads = settings.threads});
  const std::vector<SmallObject> objects = load_objects(settings.folder, name);
  const Image truth = make_truth(*prepared, objects, settings.threads);
  std::vector<Row> rows;
  rows.push_back({"beam certified", make_beam_renderer(), 1});
  if (settings.corners) rows.push_back({"beam corners", make_beam_renderer({.rule = BeamRule::corners}), 1});
  for (const int samples : settings.path_samples) {
    rows.push_back({fmt::format("path {}", samples), make_path_renderer(), std::uint32_t(samples)});
  }
  for (const Row& row : rows) {
    RenderOptions options;
    options.samples = {0, row.samples};
    options.threads = settings.threads;
    const std::clock_t start = std::clock();
    const RenderResult result = row.renderer->render(*prepared, options);
    const double cpu = double(std::clock() - start) / CLOCKS_PER_SEC;
    fmt::print("{:<9} {:<15} {:>9} {:>9.5f} {:>11} {:>8.2f} {:>8.2f}\n", name, row.name,
               count_missed(result.picture.color, truth, objects),
               rmse(result.picture.color, truth), result.rays.total, result.seconds, cpu);
    std::fflush(stdout);
  }
}

}  // namespace

int run_beam_table(const BeamTableSettings& settings) {
  fmt::print("{:<9} {:<15} {:>9} {:>9} {:>11} {:>8} {:>8}\n", "scene", "renderer", "missed", "RMSE",
             "rays", "seconds", "cpu s");
  for (const char* scene : {"plate", "fence", "spheres"}) print_scene(settings, scene);
  return 0;
}

}  // namespace arris::bench
