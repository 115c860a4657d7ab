// nearest_name.h — "did you mean": the known name that a mistyped word is closest to
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace arris {

// By edit distance (insert, delete, replace, swap neighbours), ignoring the case of ASCII letters; nothing
// if more than a third of the word, or two letters of a short one, would have to change. The first of
// equally near ones.
std::optional<std::string> find_nearest_name(std::string_view word,
                                             std::span<const std::string> known);

// `; did you mean "…"?` or empty: the end of a message about an unknown name.
std::string did_you_mean(std::string_view word, std::span<const std::string> known);

}  // namespace arris
