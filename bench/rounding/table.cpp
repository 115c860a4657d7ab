#include "rounding/table.h"

#include <fmt/format.h>

#include <algorithm>

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

std::string text_of_radius(const Table& table) {
  double least = table.radius, most = table.radius;
  for (const TableRow& row : table.rows)
    for (const RoundingSummary& object : row.prepared.rounding) {
      if (!(object.radius > 0)) continue;
      least = least > 0 ? std::min(least, object.radius) : object.radius;
      most = std::max(most, object.radius);
    }
  return least == most ? fmt::format("radius {:.4g}", most)
                       : fmt::format("radii {:.4g} to {:.4g}", least, most);
}

}  // namespace

std::optional<double> bytes_per_edge(const PrepareStats& prepared) {
  if (prepared.rounded_edges == 0) return std::nullopt;
  return double(prepared.rounding_bytes) / double(prepared.rounded_edges);
}

std::vector<std::string> merged_notes(const PrepareStats& prepared) {
  std::vector<RoundingNote> merged;
  for (const RoundingSummary& object : prepared.rounding)
    for (const RoundingNote& note : object.notes) {
      const auto same = std::find_if(merged.begin(), merged.end(),
                                     [&](const RoundingNote& m) { return m.many == note.many; });
      if (same == merged.end())
        merged.push_back(note);
      else
        same->count += note.count;
    }
  std::vector<std::string> texts;
  for (const RoundingNote& note : merged) texts.push_back(note.text());
  return texts;
}

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
  std::string text = fmt::format("{} ({}), {}\n", table.title, table.name, text_of_radius(table));
  text += fmt::format(
      "  {:<16}{:>10}{:>9}{:>8}{:>8}{:>10}{:>10}{:>9}{:>9}{:>10}{:>10}{:>8}{:>9}{:>8}\n", "",
      "triangles", "time s", "ratio", "cpu", "MB", "rounding", "build s", "round s", "edges",
      "corners", "B/edge", "rays %", "Mray/s");
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
        "{:>10}{:>9.3f}{:>8.3f}{:>8.3f}{:>10.2f}{:>10.2f}{:>9.3f}{:>9.3f}{:>10}{:>10}{:>8.0f}{:>9."
        "2f}{:>8.2f}\n",
        p.triangles, row.seconds, row.ratio, row.cpu_ratio,
        megabytes(p.geometry_bytes + p.rounding_bytes), megabytes(p.rounding_bytes),
        p.build_seconds, p.round_seconds, p.rounded_edges, p.rounded_corners,
        bytes_per_edge(p).value_or(0), affected, double(row.rays.total) / row.seconds / 1e6);
    for (const std::string& note : merged_notes(p)) text += "    " + note + "\n";
  }
  return text;
}

}  // namespace arris::bench
