#include "small_objects.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>

#include "base/parallel_for.h"
#include "render/beam_shading.h"
#include "render/camera.h"
#include "render/surface_point.h"

namespace arris::bench {
namespace {

constexpr int kReach = 3;  // pixels round an object
constexpr float kUnknown = -1;

float luminance(const Image& image, int x, int y) {
  return (image.at(x, y, 0) + image.at(x, y, 1) + image.at(x, y, 2)) / 3;
}

bool counts_for_error(int x, int y) {
  return (x + 5 * y) % 16 == 0;
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

}  // namespace

std::vector<SmallObject> load_small_objects(const std::string& folder, const std::string& scene) {
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
    for (int k = 0; k < kTruthGrid * kTruthGrid; ++k) {
      const double px = x + (k % kTruthGrid + 0.5) / kTruthGrid,
                   py = y + (k / kTruthGrid + 0.5) / kTruthGrid;
      KnownSight sight{camera_ray(camera, px, py), std::nullopt};
      sight.hit = scene.intersect(sight.ray);
      if (!sight.hit) continue;
      std::optional<SurfaceMaterial> storage;
      sum += material_at(scene, *sight.hit, storage).emission +
             direct_light(scene, lights, sight, {}, rays);
    }
    for (int c = 0; c < 3; ++c) truth.at(x, y, c) = sum[c] / (kTruthGrid * kTruthGrid);
  });
  return truth;
}

Image shrink_to_truth(const Image& dense) {
  Image truth(dense.width_px / kTruthGrid, dense.height_px / kTruthGrid, 3);
  for (int y = 0; y < truth.height_px; ++y) {
    for (int x = 0; x < truth.width_px; ++x) {
      for (int c = 0; c < 3; ++c) {
        double sum = 0;
        for (int k = 0; k < kTruthGrid * kTruthGrid; ++k) {
          sum +=
              double(dense.at(x * kTruthGrid + k % kTruthGrid, y * kTruthGrid + k / kTruthGrid, c));
        }
        truth.at(x, y, c) = float(sum / (kTruthGrid * kTruthGrid));
      }
    }
  }
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

Missed count_missed(const Image& image, const Image& truth,
                    const std::vector<SmallObject>& objects) {
  Missed count;
  for (const SmallObject& object : objects) {
    int seen = 0, there = 0;
    for (const Place& p : object.places) {
      const double expected = signal(truth, p);
      if (std::abs(expected) < 2e-3) continue;
      ++there;
      seen += signal(image, p) / expected > 0.1 ? 1 : 0;
    }
    count.visible += there > 0 ? 1 : 0;
    count.missed += there > 0 && seen == 0 ? 1 : 0;
  }
  return count;
}

}  // namespace arris::bench
