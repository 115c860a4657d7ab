// render_part.h — which part of which render a picture file holds
// What       the attributes arris.… of an .exr file, and back. Parts can be joined if scene, seed and
//            integrator agree and no sample is in two of them.
// Errors     kind input: a file without these attributes, or with others than were written
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "arris/render.h"
#include "io/picture_file.h"

namespace arris {

struct RenderPart {
  std::vector<SampleRange> samples;  // ascending, disjoint, none empty, neighbours joined
  std::uint64_t scene = 0;           // scene_fingerprint()
  std::uint32_t seed = 0;
  std::string integrator = "path";
};

Attributes attributes_of(const RenderPart& part);
RenderPart render_part_of(const PictureFile& file, const std::string& name);

std::uint64_t sample_count(const RenderPart& part);
// "0..16,32..48"
std::string format_samples(const std::vector<SampleRange>& samples);

// Throws Error with both names if the parts can't be joined.
RenderPart join_parts(const RenderPart& a, const std::string& name_a, const RenderPart& b,
                      const std::string& name_b);

}  // namespace arris
