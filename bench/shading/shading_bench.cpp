// What the parts of a path's vertex cost beside its rays, in nanoseconds of one core.
// Each line is the least of many short runs, so that other work on the machine counts little.
#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <string_view>
#include <vector>

#include "base/sobol.h"
#include "shading/bsdf.h"
#include "shading/lights.h"

namespace {

using namespace arris;  // NOLINT(google-build-using-namespace): a program's one file
using Clock = std::chrono::steady_clock;

constexpr std::uint32_t kRuns = 200;
constexpr std::uint32_t kCallsPerRun = 5000;

// Keeps results from being optimised away.
volatile float sink = 0;

// f(call number) → something of the result.
template <class Function>
double nanoseconds(const Function& f) {
  double least = 1e9;
  for (std::uint32_t run = 0; run < kRuns; ++run) {
    float sum = 0;
    const auto start = Clock::now();
    for (std::uint32_t i = 0; i < kCallsPerRun; ++i) {
      sum += f(run * kCallsPerRun + i);
    }
    const std::chrono::duration<double, std::nano> elapsed = Clock::now() - start;
    sink = sum;
    least = std::min(least, elapsed.count() / kCallsPerRun);
  }
  return least;
}

// Numbers drawn beforehand, so that lines without a sampler don't pay for one.
struct Numbers {
  float lobe;
  Vec2f u;
};
std::vector<Numbers> drawn_numbers() {
  std::vector<Numbers> numbers;
  for (std::uint32_t i = 0; i < 4096; ++i) {
    Sampler sampler(1, 2, i / 64, i % 64);
    const float lobe = sampler.next_1d();
    numbers.push_back({lobe, sampler.next_2d()});
  }
  return numbers;
}

void measure_sampler() {
  fmt::print("sampler: a number {:.1f} ns, a pair {:.1f} ns\n", nanoseconds([](std::uint32_t i) {
               Sampler sampler(1, i, 3, i % 64);
               return sampler.next_1d();
             }),
             nanoseconds([](std::uint32_t i) {
               Sampler sampler(1, i, 3, i % 64);
               const Vec2f u = sampler.next_2d();
               return u.x + u.y;
             }));
}

void measure_material(std::string_view name, const SurfaceMaterial& material) {
  static const std::vector<Numbers> kNumbers = drawn_numbers();
  const auto wo = [](std::uint32_t i) {
    const auto x = float(i % 16) * 0.05F;
    return normalize(Vec3f{x, 0.3F, 0.8F});
  };
  const Bsdf bsdf = make_bsdf(material, wo(3));
  const double make =
      nanoseconds([&](std::uint32_t i) { return make_bsdf(material, wo(i)).share_diffuse; });
  const double eval = nanoseconds([&](std::uint32_t i) {
    const BsdfValue f = eval_bsdf_with_pdf(bsdf, wo(i));
    return f.value.x + f.pdf;
  });
  const double sample = nanoseconds([&](std::uint32_t i) {
    const Numbers n = kNumbers[i % 4096];
    const auto s = sample_bsdf(bsdf, n.lobe, n.u);
    return s ? s->weight.x + s->wi.x : 0.0F;
  });
  fmt::print("{:<24} make {:5.1f}   eval and pdf {:5.1f}   sample {:5.1f}\n", name, make, eval,
             sample);
}

void measure_lights(std::string_view name, const std::vector<Light>& lights,
                    const Environment& environment) {
  static const std::vector<Numbers> kNumbers = drawn_numbers();
  const LightSet set = make_light_set(lights, environment, {}, {{0, 0, 0}, 2});
  const double sample = nanoseconds([&](std::uint32_t i) {
    const Numbers n = kNumbers[i % 4096];
    const auto s = sample_light(set, {n.u.x, 0, 0}, n.lobe, n.u);
    return s ? s->radiance.x + s->pdf : 0.0F;
  });
  const double miss = nanoseconds([&](std::uint32_t i) {
    const Numbers n = kNumbers[i % 4096];
    const EnvironmentValue v =
        eval_environment_with_pdf(set, normalize(Vec3f{n.lobe - 0.5F, n.u.x - 0.5F, n.u.y}));
    return v.radiance.x + v.pdf;
  });
  fmt::print("{:<24} sample {:5.1f}   environment with pdf {:5.1f}\n", name, sample, miss);
}

}  // namespace

int main() {
  measure_sampler();
  using M = SurfaceMaterial;
  measure_material("lambert", M{.is_mix = true});
  measure_material("glossy mix", M{.roughness = 0.2F, .glossy_share = 0.1F, .is_mix = true});
  measure_material("plastic", M{});
  measure_material("metal", M{.metallic = 1, .roughness = 0.3F});
  measure_material("clear glass", M{.roughness = 0, .transmission = 1});
  measure_material("rough glass", M{.roughness = 0.3F, .transmission = 1});
  measure_material("lacquer", M{.clearcoat = 1, .clearcoat_roughness = 0.1F});
  const AreaLight near{{-1, -1, 1}, {0, 2, 0}, {2, 0, 0}, {1, 1, 1}, true};
  const AreaLight far{{-1, -1, 9}, {0, 2, 0}, {2, 0, 0}, {1, 1, 1}, true};
  measure_lights("point", {PointLight{{0, 0, 2}, {1, 1, 1}}}, ConstantEnvironment{});
  measure_lights("near rectangle", {near}, ConstantEnvironment{});
  measure_lights("far rectangle", {far}, ConstantEnvironment{});
  measure_lights("three far rectangles", {far, far, far}, ConstantEnvironment{});
  measure_lights("studio", {}, StudioEnvironment{});
  measure_lights("sky", {}, SkyEnvironment{});
}
