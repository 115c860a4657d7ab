// step_syntax.h — whether bytes are a whole STEP file, before Open CASCADE sees them
// What       statements, strings, comments and parentheses of ISO 10303-21, and its first and last line; not what
//            the statements mean
// Errors     kind input, where = "file:line"; among them every file that was cut off
// Cost       one pass, no memory; find_missing_entity(): as much memory as the file
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace arris {

// Deeper ones are nobody's, and what reads them calls itself once a level.
inline constexpr int kMaxStepDepth = 200;

void check_step_syntax(std::span<const std::uint8_t> bytes, const std::string& file);

// The first name of an entity that no entity has, in words; Open CASCADE forgives some. Precondition: the file has
// passed check_step_syntax().
std::optional<std::string> find_missing_entity(std::span<const std::uint8_t> bytes,
                                               const std::string& file);

}  // namespace arris
