#include "arris/values.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "arris/command_line.h"
#include "arris/error.h"
#include "arris/image.h"
#include "base/nearest_name.h"
#include "base/utf8_text.h"
#include "scene/limits.h"

namespace arris::program {
namespace {

constexpr double kLargestLength = 1e12;

[[noreturn]] void fail(const Given& given, const std::string& what) {
  throw Error(Error::Kind::input, given.option,
              fmt::format("{} is {}", in_quotes(given.text), what));
}

template <class Number>
std::optional<Number> to_number(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::vector<std::string> split(const std::string& text, std::string_view separator) {
  std::vector<std::string> parts;
  std::size_t first = 0;
  for (std::size_t at = text.find(separator); at != std::string::npos;
       at = text.find(separator, first)) {
    parts.push_back(text.substr(first, at - first));
    first = at + separator.size();
  }
  parts.push_back(text.substr(first));
  return parts;
}

Radius parse_radius(const Given& given) {
  if (given.text == "auto") return AutoRadius{};
  const bool percent = given.text.ends_with('%');
  const auto value = to_number<double>(
      std::string_view(given.text).substr(0, given.text.size() - (percent ? 1 : 0)));
  if (!value || !std::isfinite(*value)) {
    fail(given,
         "no radius; use auto, none, a length such as 0.5, or a share of the inradius such "
         "as 10%");
  }
  if (percent && !(*value > 0 && *value < 100)) {
    fail(given, "out of range; use more than 0% and less than 100% of the inradius");
  }
  if (!percent && !(*value > 0 && *value <= kLargestLength)) {
    fail(given,
         fmt::format("out of range; use a radius above 0, at most {:g}; none for sharp edges",
                     kLargestLength));
  }
  if (percent) return PercentOfInradius{*value};
  return *value;
}

void apply_method(RoundingSettings& settings, const Given& given) {
  constexpr std::uint64_t kMostSubdivisions = 64;
  if (given.text.starts_with("mesh:")) {
    settings.method = RoundMethod::mesh;
    settings.subdivisions =
        int(parse_count({given.option + " mesh:N", given.text.substr(5)}, 1, kMostSubdivisions));
    return;
  }
  constexpr RoundMethod kMethods[] = {RoundMethod::exact, RoundMethod::shader, RoundMethod::none};
  const std::vector<std::string> names{"exact", "shader", "none", "mesh:N"};
  if (given.text == "mesh") fail(given, "incomplete; say how many subdivisions, such as mesh:3");
  settings.method = kMethods[parse_choice(given, names)];  // never the last: mesh:… is done
}

}  // namespace

std::optional<Given> find_given(const Arguments& arguments, const std::string& option) {
  const auto text = arguments.find(option);
  if (!text) return std::nullopt;
  return Given{option, *text};
}

double parse_real(const Given& given, Limits limits) {
  const auto value = to_number<double>(given.text);
  if (!value) fail(given, "no number");
  if (!(*value >= limits.least && *value <= limits.most)) {
    fail(given, fmt::format("out of range; use {:g} to {:g}", limits.least, limits.most));
  }
  return *value;
}

std::uint64_t parse_count(const Given& given, std::uint64_t least, std::uint64_t most) {
  const auto value = to_number<std::uint64_t>(given.text);
  if (!value || *value < least || *value > most) {
    fail(given, fmt::format("no whole number from {} to {}", least, most));
  }
  return *value;
}

Vec3d parse_vector(const Given& given) {
  const std::vector<std::string> parts = split(given.text, ",");
  Vec3d vector;
  bool ok = parts.size() == 3;
  for (int i = 0; ok && i < 3; ++i) {
    const auto value = to_number<double>(parts[std::size_t(i)]);
    ok = value && std::abs(*value) <= kLargestLength;
    if (ok) vector[i] = *value;
  }
  if (!ok) {
    fail(given, fmt::format("no point; use three numbers of at most {:g}: X,Y,Z", kLargestLength));
  }
  return vector;
}

Size parse_size(const Given& given) {
  const std::vector<std::string> parts = split(given.text, "x");
  const auto width = to_number<int>(parts[0]);
  const auto height = parts.size() == 2 ? to_number<int>(parts[1]) : std::nullopt;
  if (!width || !height) fail(given, "no size; use WIDTHxHEIGHT, such as 1280x720");
  if (*width < 1 || *height < 1 || *width > kMaxPictureSide || *height > kMaxPictureSide) {
    fail(given, fmt::format("out of range; use 1 to {} pixels on a side", kMaxPictureSide));
  }
  if (std::int64_t(*width) * *height > kMaxPicturePixels) {
    fail(given, fmt::format("too large; use at most {} pixels in all", kMaxPicturePixels));
  }
  return {*width, *height};
}

SampleRange parse_samples(const Given& given) {
  const std::vector<std::string> parts = split(given.text, "..");
  const auto first = to_number<std::uint32_t>(parts[0]);
  const auto last = parts.size() == 2 ? to_number<std::uint32_t>(parts[1]) : std::nullopt;
  if (!first || !last || *first >= *last || *last > kMostSamples) {
    fail(given,
         fmt::format("no range of samples; use FIRST..END with FIRST below END and END at most "
                     "{}, such as 0..64",
                     kMostSamples));
  }
  return {*first, *last};
}

FrameRange parse_frames(const Given& given) {
  const std::vector<std::string> parts = split(given.text, "..");
  const auto first = to_number<int>(parts[0]);
  const auto last = parts.size() == 2 ? to_number<int>(parts[1]) : std::nullopt;
  constexpr int kMost = int(kMaxFrame);
  if (!first || !last || *first >= *last || *first < -kMost || *last > kMost + 1) {
    fail(given,
         fmt::format("no range of frames; use FIRST..END with FIRST below END, from {} to {}, such "
                     "as 0..48 for frames 0 to 47",
                     -kMost, kMost));
  }
  return {*first, *last};
}

std::vector<std::string> parse_list(const Given& given) {
  return split(given.text, ",");
}

std::size_t parse_choice(const Given& given, const std::vector<std::string>& names) {
  std::string list;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == given.text) return i;
    list += (i == 0 ? "" : ", ") + names[i];
  }
  fail(given, fmt::format("not known; use {}{}{}", names.size() > 1 ? "one of " : "", list,
                          did_you_mean(given.text, names)));
}

LoadOptions load_options_of(const Arguments& arguments) {
  LoadOptions options;
  if (const auto given = find_given(arguments, "--facets")) {
    options.facets = parse_choice(*given, {"exact", "as-written"}) == 0
                         ? LoadOptions::Facets::exact
                         : LoadOptions::Facets::as_written;
  }
  return options;
}

int threads_of(const Arguments& arguments) {
  constexpr std::uint64_t kMostThreads = 1024;
  const auto given = find_given(arguments, "--threads");
  return given ? int(parse_count(*given, 1, kMostThreads)) : 0;
}

bool has_rounding_options(const Arguments& arguments) {
  for (const char* option :
       {"--round", "--round-edges", "--round-on-overlap", "--round-min-angle", "--round-method"}) {
    if (arguments.has(option)) return true;
  }
  return false;
}

namespace {

void check_round_method(const Arguments& arguments) {
  const auto radius = arguments.find("--round"), method = arguments.find("--round-method");
  if (!radius || !method || (*radius == "none") == (*method == "none")) return;
  throw Error(
      Error::Kind::input, "--round-method",
      fmt::format("{} contradicts --round {}; leave one of them out", in_quotes(*method), *radius));
}

}  // namespace

RoundingSettings with_rounding_options(RoundingSettings settings, const Arguments& arguments) {
  if (const auto given = find_given(arguments, "--round")) {
    if (given->text == "none") {
      settings.method = RoundMethod::none;
    } else {
      settings.radius = parse_radius(*given);
      if (settings.method == RoundMethod::none) settings.method = RoundMethod::exact;
    }
  }
  if (const auto given = find_given(arguments, "--round-edges")) {
    constexpr RoundEdges kEdges[] = {RoundEdges::convex, RoundEdges::concave, RoundEdges::both};
    settings.edges = kEdges[parse_choice(*given, {"convex", "concave", "both"})];
  }
  if (const auto given = find_given(arguments, "--round-on-overlap")) {
    constexpr OnOverlap kOnOverlap[] = {OnOverlap::report, OnOverlap::clamp};
    settings.on_overlap = kOnOverlap[parse_choice(*given, {"report", "clamp"})];
  }
  if (const auto given = find_given(arguments, "--round-min-angle")) {
    settings.min_angle = radians(parse_real(*given, {0, 180}));
  }
  if (const auto given = find_given(arguments, "--round-method")) {
    apply_method(settings, *given);
  }
  check_round_method(arguments);
  return settings;
}

void apply_rounding_options(Scene& scene, const Arguments& arguments) {
  if (!has_rounding_options(arguments)) return;
  const RoundingSettings none;
  scene.rounding = with_rounding_options(scene.rounding.value_or(none), arguments);
  for (Object& object : scene.objects) {
    if (object.rounding) object.rounding = with_rounding_options(*object.rounding, arguments);
  }
}

}  // namespace arris::program
