#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "arris/command_line.h"
#include "arris/commands.h"
#include "arris/console.h"
#include "arris/error.h"
#include "arris/io.h"
#include "arris/output_files.h"
#include "arris/values.h"
#include "image/picture_sum.h"
#include "io/picture_file.h"
#include "io/render_part.h"

namespace arris::program {
namespace {

struct Part {
  std::string name;
  RenderPart part;
};

// In the order of their samples. Pixels are read again when they are added: thousands of parts need not
// fit into memory at once.
std::vector<Part> load_parts(const std::vector<std::string>& names) {
  std::vector<Part> parts;
  for (const std::string& name : names) {
    parts.push_back({name, render_part_of(load_picture_file(name), name)});
  }
  std::sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) {
    return a.part.samples[0].first < b.part.samples[0].first;
  });
  return parts;
}

void add_part(PictureSum& sum, const Part& part, Console& console) {
  const Picture picture = load_picture_file(part.name).picture;
  const std::uint64_t samples = sample_count(part.part);
  if (holds_sum(picture)) {
    add_sum(sum, unpack_sum(picture, samples));
  } else {
    console.report(fmt::format(
        "{}: holds a mean only, as no part; joined to the rounding of its floats", part.name));
    add_sum(sum, sum_of_mean(picture, samples));
  }
}

}  // namespace

int run_merge(const Arguments& arguments) {
  const auto output = arguments.find("--output");
  if (!output)
    throw Error(Error::Kind::input, "", "arris merge needs an output file: -o whole.exr");
  picture_format(*output);
  const NamedFile target{"-o", *output};  // may be one of the parts: they are read first
  check_outputs({&target, 1}, {});
  SaveOptions options;
  if (const auto given = find_given(arguments, "--exposure")) {
    options.exposure = parse_real(*given, {-kMostStops, kMostStops});
  }
  const std::vector<Part> parts = load_parts(arguments.positionals);
  RenderPart whole = parts.front().part;
  for (std::size_t i = 1; i < parts.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      join_parts(parts[k].part, parts[k].name, parts[i].part, parts[i].name);
    }
    whole = join_parts(whole, parts.front().name, parts[i].part, parts[i].name);
  }
  Console console(arguments);
  PictureSum sum;
  for (const Part& part : parts) {
    try {
      add_part(sum, part, console);
    } catch (const Error& error) {
      if (!error.where().empty()) throw;
      throw Error(error.kind(), part.name, error.what());
    }
  }
  options.attributes = attributes_of(whole);
  const bool is_part =
      arguments.has("--part") || whole.samples.size() > 1 || whole.samples[0].first > 0;
  const bool keep_sum = is_part && picture_format(*output) == PictureFormat::exr;
  save_picture(keep_sum ? pack_sum(sum) : mean_picture(sum), *output, options);
  console.report(fmt::format("{}: samples {}", *output, format_samples(whole.samples)));
  return 0;
}

}  // namespace arris::program
