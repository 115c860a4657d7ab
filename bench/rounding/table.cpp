#include "rounding/table.h"

#include <fmt/format.h>

#include "arris/error.h"
#include "arris/io.h"
#include "interleaved.h"

namespace arris::bench {
namespace {

// A method that this scene or this build cannot do becomes a row that says so.
std::shared_ptr<const PreparedScene> prepare_row(const Scene& scene, const TableOptions& options,
                                                 TableRow& row) {
  try {
    auto prepared = prepare_scene(with_method(scene, row.method), {.threads = options.threads});
    row.prepared = prepare_stats(*prepared);
    return prepared;
  } catch (const Error& e) {
    row.failure = e.what();
    return nullptr;
  }
}

std::string file_name(const std::string& scene, const std::string& method) {
  std::string name = scene + "-" + method + ".png";
  for (char& c : name)
    if (c == ':') c = '-';
  return name;
}

double megabytes(std::uint64_t bytes) {
  return double(bytes) / 1e6;
}

}  // namespace

Table measure_table(const BenchScene& bench, const TableOptions& options) {
  Scene scene = bench.scene;
  scene.image.width_px = options.width_px;
  scene.image.height_px = options.height_px;
  Table table{bench.name, bench.title, bench.radius, {}};
  std::vector<Variant> variants;
  std::vector<std::size_t> row_of;
  for (const Method& method : options.methods) {
    TableRow row;
    row.method = method;
    if (auto prepared = prepare_row(scene, options, row)) {
      row_of.push_back(table.rows.size());
      variants.push_back({method.name, std::move(prepared)});
    }
    table.rows.push_back(std::move(row));
  }
  InterleavedOptions interleaved;
  interleaved.rounds = options.rounds;
  interleaved.render.samples = {0, options.samples_per_pixel};
  interleaved.render.threads = options.threads;
  if (options.pictures) {
    interleaved.on_picture = [&](const Variant& variant, const RenderResult& result) {
      save_picture(result.picture, *options.pictures / file_name(bench.name, variant.name));
    };
  }
  const std::vector<Timing> timings = render_interleaved(variants, interleaved);
  for (std::size_t i = 0; i < timings.size(); ++i) {
    TableRow& row = table.rows[row_of[i]];
    row.seconds = median(timings[i].seconds);
    row.ratio = median_ratio(timings[i].seconds, timings[0].seconds);
    row.cpu_ratio = median_ratio(timings[i].cpu_seconds, timings[0].cpu_seconds);
    row.rays = timings[i].rays;
  }
  return table;
}

std::string text_of(const Table& table) {
  std::string text = fmt::format("{} ({}), radius {:g}\n", table.title, table.name, table.radius);
  text += fmt::format("  {:<16}{:>10}{:>9}{:>8}{:>8}{:>10}{:>10}{:>9}{:>9}{:>10}{:>10}{:>9}{:>8}\n",
                      "", "triangles", "time s", "ratio", "cpu", "MB", "rounding", "build s",
                      "round s", "edges", "corners", "rays %", "Mray/s");
  for (const TableRow& row : table.rows) {
    text += fmt::format("  {:<16}", row.method.title);
    if (!row.failure.empty()) {
      text += row.failure + "\n";
      continue;
    }
    const PrepareStats& p = row.prepared;
    const double affected =
        row.rays.total > 0 ? 100.0 * double(row.rays.rounded) / double(row.rays.total) : 0;
    text += fmt::format(
        "{:>10}{:>9.3f}{:>8.3f}{:>8.3f}{:>10.2f}{:>10.2f}{:>9.3f}{:>9.3f}{:>10}{:>10}{:>9.2f}{:>8."
        "2f}\n",
        p.triangles, row.seconds, row.ratio, row.cpu_ratio,
        megabytes(p.geometry_bytes + p.rounding_bytes), megabytes(p.rounding_bytes),
        p.build_seconds, p.round_seconds, p.rounded_edges, p.rounded_corners, affected,
        double(row.rays.total) / row.seconds / 1e6);
  }
  return text;
}

}  // namespace arris::bench
