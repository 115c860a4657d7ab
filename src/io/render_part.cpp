#include "io/render_part.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>

#include "arris/error.h"
#include "arris/version.h"

namespace arris {
namespace {

constexpr const char* kSamples = "arris.samples";
constexpr const char* kScene = "arris.scene";
constexpr const char* kSeed = "arris.seed";
constexpr const char* kIntegrator = "arris.integrator";

template <class Number>
std::optional<Number> parse(std::string_view text, int base = 10) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

// Nothing if the text is not what format_samples() writes.
std::optional<std::vector<SampleRange>> parse_samples(std::string_view text) {
  std::vector<SampleRange> samples;
  while (!text.empty()) {
    const std::string_view range = text.substr(0, text.find(','));
    text.remove_prefix(std::min(range.size() + 1, text.size()));
    const std::size_t dots = range.find("..");
    if (dots == std::string_view::npos) return std::nullopt;
    const auto first = parse<std::uint32_t>(range.substr(0, dots));
    const auto last = parse<std::uint32_t>(range.substr(dots + 2));
    if (!first || !last || *first >= *last) return std::nullopt;
    if (!samples.empty() && *first <= samples.back().last) return std::nullopt;
    samples.push_back({*first, *last});
  }
  if (samples.empty()) return std::nullopt;
  return samples;
}

std::vector<SampleRange> joined_neighbours(std::vector<SampleRange> samples) {
  std::sort(samples.begin(), samples.end(),
            [](const SampleRange& a, const SampleRange& b) { return a.first < b.first; });
  std::vector<SampleRange> joined;
  for (const SampleRange& range : samples) {
    if (!joined.empty() && joined.back().last == range.first) {
      joined.back().last = range.last;
    } else {
      joined.push_back(range);
    }
  }
  return joined;
}

std::optional<SampleRange> find_overlap(const RenderPart& a, const RenderPart& b) {
  for (const SampleRange& i : a.samples) {
    for (const SampleRange& k : b.samples) {
      const SampleRange both{std::max(i.first, k.first), std::min(i.last, k.last)};
      if (both.first < both.last) return both;
    }
  }
  return std::nullopt;
}

}  // namespace

Attributes attributes_of(const RenderPart& part) {
  return {{kSamples, format_samples(part.samples)},
          {kScene, fmt::format("{:016x}", part.scene)},
          {kSeed, fmt::format("{}", part.seed)},
          {kIntegrator, part.integrator},
          {"arris.version", version()}};
}

RenderPart render_part_of(const PictureFile& file, const std::string& name) {
  const auto text = [&](const char* attribute) -> std::string {
    for (const auto& [key, value] : file.attributes) {
      if (key == attribute) return value;
    }
    throw Error(
        Error::Kind::input, name,
        fmt::format("is no part of a render: it lacks the attribute {}; use .exr files that "
                    "arris render wrote",
                    attribute));
  };
  const auto samples = parse_samples(text(kSamples));
  const auto scene = parse<std::uint64_t>(text(kScene), 16);
  const auto seed = parse<std::uint32_t>(text(kSeed));
  if (!samples || !scene || !seed) {
    throw Error(Error::Kind::input, name, "has attributes arris.… that arris render never writes");
  }
  return {*samples, *scene, *seed, text(kIntegrator)};
}

std::uint64_t sample_count(const RenderPart& part) {
  std::uint64_t count = 0;
  for (const SampleRange& range : part.samples) count += range.last - range.first;
  return count;
}

std::string format_samples(const std::vector<SampleRange>& samples) {
  std::string text;
  for (const SampleRange& range : samples) {
    text += fmt::format("{}{}..{}", text.empty() ? "" : ",", range.first, range.last);
  }
  return text;
}

RenderPart join_parts(const RenderPart& a, const std::string& name_a, const RenderPart& b,
                      const std::string& name_b) {
  const auto fail = [&](const std::string& what) {
    throw Error(Error::Kind::input, name_b, fmt::format("{} {}", what, name_a));
  };
  if (a.scene != b.scene) fail("shows another scene, camera or size than");
  if (a.seed != b.seed) fail(fmt::format("has seed {}, not {} as", b.seed, a.seed));
  if (a.integrator != b.integrator) {
    fail(fmt::format("was made by integrator {}, not {} as", b.integrator, a.integrator));
  }
  if (const auto overlap = find_overlap(a, b)) {
    fail(fmt::format("holds the samples {}..{} that are also in", overlap->first, overlap->last));
  }
  RenderPart joined = a;
  joined.samples.insert(joined.samples.end(), b.samples.begin(), b.samples.end());
  joined.samples = joined_neighbours(joined.samples);
  return joined;
}

}  // namespace arris
