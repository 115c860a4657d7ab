#include "render/shade_plan.h"

#include <optional>

#include "base/sobol.h"
#include "render/shadow_probe.h"

namespace arris {
namespace {

constexpr std::uint32_t kProbeSeed = 0x5bd1e995;  // other numbers than the paths'

template <class T>
void append_to(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

std::optional<ShadowTriple> probe(const ShadePlan& plan, int x, int y) {
  Sampler sampler(plan.shader.seed ^ kProbeSeed, std::uint32_t(x), std::uint32_t(y), plan.frame);
  ShadowProbe probe;
  probe.camera_ray = camera_ray(plan.camera, x + 0.5, y + 0.5);
  probe.select = sampler.next_1d();
  probe.place = sampler.next_2d();
  return probe_shadow(*plan.scene, *plan.lights, probe);
}

}  // namespace

void ShadeResults::append(const ShadeResults& other) {
  append_to(points, other.points);
  append_to(pixels, other.pixels);
  append_to(triples, other.triples);
  items += other.items;
  rays.total += other.rays.total;
  rays.rounded += other.rays.rounded;
  thread_seconds += other.thread_seconds;
}

void shade_item(const ShadePlan& plan, const ShadePlan::Item& item, ShadeResults& results) {
  const int x = int(item.pixel % std::uint32_t(plan.width_px));
  const int y = int(item.pixel / std::uint32_t(plan.width_px));
  ++results.items;
  if (item.first_path != kNoPoint) {
    const auto count = std::uint32_t(plan.shader.paths);
    const Rgb sum = shade_pixel(*plan.scene, plan.camera, plan.filter, plan.shader,
                                {x, y, item.first_path, count}, results.rays);
    results.pixels.push_back({item.pixel, count, sum});
    return;
  }
  ShadedPoint point =
      shade_point(*plan.scene, plan.camera, plan.shader, {x, y, plan.frame}, results.rays);
  point.replaces = item.replaces;
  results.points.push_back(point);
  if (plan.lights == nullptr || point.object == kFarObject) return;
  if (const std::optional<ShadowTriple> triple = probe(plan, x, y))
    results.triples.push_back(*triple);
}

}  // namespace arris
