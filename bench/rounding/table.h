// table.h — the paper's Table 1 and Fig. 8 for one scene
// Source     Courtin et al., Table 1: triangles, time and memory for no rounding, the method, bevel meshes with 1 to
//            10 subdivisions and the bevel shader; Fig. 8: rounded edges and corners, share of rays affected,
//            build times. Bytes of rounding for each rounded edge, and what the rounding has to say of what it left
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "arris/render.h"
#include "rounding/methods.h"
#include "rounding/scenes.h"

namespace arris::bench {

struct TableOptions {
  std::vector<Method> methods;
  int width_px = 960, height_px = 540;
  std::uint32_t samples_per_pixel = 16;
  int rounds = 3;
  int threads = 0;
  std::optional<std::filesystem::path> pictures;  // a folder
};

struct TableRow {
  Method method;
  std::string failure;  // why this method could not be prepared; the rest is empty then
  PrepareStats prepared;
  double seconds = 0;    // median
  double ratio = 0;      // to the first row, median over the rounds
  double cpu_ratio = 0;  // the same of processor time
  RayCounts rays;
};

struct Table {
  std::string name, title;
  double radius = 0;
  std::vector<TableRow> rows;
};

// Empty where no edge is rounded.
std::optional<double> bytes_per_edge(const PrepareStats& prepared);
// The same note of several objects once, with the sum of their counts.
std::vector<std::string> merged_notes(const PrepareStats& prepared);

Table measure_table(const BenchScene& bench, const TableOptions& options);
std::string text_of(const Table& table);

}  // namespace arris::bench
