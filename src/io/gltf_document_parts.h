// gltf_document_parts.h — the pieces of parse_gltf_document(), one for each group of arrays
#pragma once

#include "io/gltf_document.h"
#include "io/gltf_json.h"

namespace arris {

// Length of a top-level array; 0 if it is missing.
std::size_t count_of(const JsonValue& root, const char* array);

// extras.arris_radius: a number, "12%", "auto" or "none".
std::optional<RoundingSettings> parse_rounding_extra(const JsonValue& owner);

GltfMaterial parse_gltf_material(const JsonValue& value, std::size_t texture_count,
                                 std::vector<std::string>& notes);

// Fills cameras, lights, nodes and roots.
void parse_gltf_scene(const JsonValue& root, GltfDocument& document);

}  // namespace arris
