#include "rounding/model_scene.h"

#include <stdexcept>

#include "arris/io.h"
#include "render/staging.h"
#include "scene/rounding_text.h"

namespace arris::bench {

BenchScene make_model_scene(const std::filesystem::path& file, const std::string& radius,
                            const std::string& edges) {
  BenchScene bench{file.stem().string(), file.filename().string(), load_scene(file), 0};
  if (!radius.empty()) {
    const auto settings = parse_rounding_text(radius);
    if (!settings)
      throw std::invalid_argument("--model-radius: " + std::string(kRoundingTextForms));
    bench.scene.rounding = settings;
    for (Object& object : bench.scene.objects) object.rounding.reset();
  }
  if (!edges.empty()) {
    const RoundEdges kind = edges == "both"      ? RoundEdges::both
                            : edges == "concave" ? RoundEdges::concave
                                                 : RoundEdges::convex;
    if (!bench.scene.rounding) bench.scene.rounding.emplace().method = RoundMethod::exact;
    bench.scene.rounding->edges = kind;
    for (Object& object : bench.scene.objects) {
      if (object.rounding) object.rounding->edges = kind;
    }
  }
  const StagingReport staged = stage_model(bench.scene, {});
  if (!staged.problem.empty()) throw std::invalid_argument(bench.title + " " + staged.problem);
  return bench;
}

}  // namespace arris::bench
