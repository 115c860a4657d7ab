#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <optional>

#include "arris/command_line.h"
#include "arris/commands.h"
#include "arris/console.h"
#include "arris/error.h"
#include "arris/input.h"
#include "arris/render.h"
#include "arris/values.h"
#include "base/utf8_text.h"
#include "render/shoot.h"

namespace arris::program {
namespace {

constexpr double kLargest = 1e30;

// Six numbers; nothing for a blank line or a comment.
std::optional<Ray> parse_ray(std::string_view line, const std::string& where) {
  const auto fail = [&](const std::string& what) {
    throw Error(
        Error::Kind::input, where,
        fmt::format("{} {}; a ray is six numbers: ox oy oz dx dy dz", in_quotes(line), what));
  };
  double values[6] = {};
  std::size_t count = 0, position = 0;
  while (true) {
    position = line.find_first_not_of(" \t\r,", position);
    if (position == std::string_view::npos) break;
    if (count == 0 && line[position] == '#') return std::nullopt;
    const std::size_t end = std::min(line.find_first_of(" \t\r,", position), line.size());
    std::string_view word = line.substr(position, end - position);
    if (word.starts_with('+')) word.remove_prefix(1);
    if (count == 6) fail("holds more than six numbers");
    const auto [last, error] =
        std::from_chars(word.data(), word.data() + word.size(), values[count]);
    if (error != std::errc() || last != word.data() + word.size() ||
        !(std::abs(values[count]) <= kLargest)) {
      fail(fmt::format("holds {}, which is no number up to {:g}", in_quotes(word), kLargest));
    }
    ++count;
    position = end;
  }
  if (count == 0) return std::nullopt;
  if (count < 6) fail(fmt::format("holds {} numbers only", count));
  const Ray ray{{values[0], values[1], values[2]}, {values[3], values[4], values[5]}};
  if (!(length(ray.direction) > 0)) fail("has no direction");
  return ray;
}

// Seventeen digits: every bit of a double.
std::string number(double value) {
  return fmt::format("{:.17g}", value == 0 ? 0.0 : value);
}
std::string vector(Vec3d v) {
  return fmt::format("[{}, {}, {}]", number(v.x), number(v.y), number(v.z));
}

std::string to_json_line(const std::optional<Shot>& shot, const Scene& scene) {
  if (!shot) {
    return R"({"t": null, "position": null, "normal": null, "object": null, "feature": null, "inside": false})";
  }
  const auto replace = nlohmann::json::error_handler_t::replace;
  const std::string name =
      nlohmann::json(scene.objects[shot->object.index].name).dump(-1, ' ', false, replace);
  return fmt::format(
      R"({{"t": {}, "position": {}, "normal": {}, "object": {}, "feature": "{}", "inside": {}}})",
      number(shot->t), vector(shot->position), vector(shot->normal), name, name_of(shot->feature),
      shot->inside);
}

void shoot_lines(std::istream& lines, const std::string& name, const PreparedScene& prepared) {
  const Shooter shooter(prepared);
  std::string line;
  for (std::size_t number = 1; std::getline(lines, line); ++number) {
    const auto ray = parse_ray(line, fmt::format("{}:{}", name, number));
    if (ray) fmt::print("{}\n", to_json_line(shooter.shoot(*ray), scene_of(prepared)));
  }
  if (lines.bad()) throw Error(Error::Kind::failed, name, "can't be read to its end");
}

}  // namespace

int run_shoot(const Arguments& arguments) {
  const auto rays = arguments.find("--rays");
  if (!rays) {
    throw Error(Error::Kind::input, "",
                "arris shoot needs rays: --rays FILE, or --rays - for stdin");
  }
  const int threads = threads_of(arguments);
  with_rounding_options({}, arguments);
  const LoadOptions load_options = load_options_of(arguments);
  std::ifstream file;
  if (*rays != "-") {
    file.open(*rays);
    if (!file || std::filesystem::is_directory(*rays)) {
      throw Error(Error::Kind::input, *rays, "can't be opened; --rays needs a file of rays or -");
    }
  }
  const std::string& input = arguments.positionals[0];
  if (input == "-" && *rays == "-") {
    throw Error(Error::Kind::input, "--rays",
                "and INPUT can't both be read from stdin; name a file for one of them");
  }
  Input loaded = load_input(input, load_options);
  check_scene(loaded.scene, loaded.name);
  apply_rounding_options(loaded.scene, arguments);
  const auto prepared = prepare_scene(std::move(loaded.scene), {.threads = threads});
  Console console(arguments);
  for (const std::string& note : scene_of(*prepared).notes) console.report(note);
  if (*rays == "-") {
    shoot_lines(std::cin, "stdin", *prepared);
  } else {
    shoot_lines(file, *rays, *prepared);
  }
  return 0;
}

}  // namespace arris::program
