// values.h — option values from text
// Errors     arris::Error, kind input, where = the option: the value, what it should look like, its limits
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "arris/io.h"
#include "arris/math.h"
#include "arris/render.h"
#include "arris/scene.h"

namespace arris::program {

class Arguments;

// An option and the text it was given.
struct Given {
  std::string option;
  std::string text;
};
std::optional<Given> find_given(const Arguments& arguments, const std::string& option);

struct Limits {
  double least, most;
};

double parse_real(const Given& given, Limits limits);
std::uint64_t parse_count(const Given& given, std::uint64_t least, std::uint64_t most);
Vec3d parse_vector(const Given& given);  // "X,Y,Z"

struct Size {
  int width_px, height_px;
};
Size parse_size(const Given& given);            // "WxH"
SampleRange parse_samples(const Given& given);  // "A..B"
// Half-open, as samples are.
struct FrameRange {
  int first = 0, last = 0;
};
FrameRange parse_frames(const Given& given);  // "A..B"
std::vector<std::string> parse_list(const Given& given);

// The index in `names` of what was given.
std::size_t parse_choice(const Given& given, const std::vector<std::string>& names);

// Options that apply to render, info and shoot alike.
int threads_of(const Arguments& arguments);
LoadOptions load_options_of(const Arguments& arguments);

// What the --round options change in settings that a file or the command's default makes; nothing if
// none is given.
bool has_rounding_options(const Arguments& arguments);
RoundingSettings with_rounding_options(RoundingSettings settings, const Arguments& arguments);
void apply_rounding_options(Scene& scene, const Arguments& arguments);

}  // namespace arris::program
