#include "base/nearest_name.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "base/utf8_text.h"

namespace arris {
namespace {

// Longer words are no mistyped names, and the distance costs the product of the lengths.
constexpr std::size_t kMaxWordBytes = 64;

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? char(c + ('a' - 'A')) : c;
}

// Optimal string alignment distance, row by row.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before_last(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const bool same = lower(a[i - 1]) == lower(b[j - 1]);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (same ? 0U : 1U)});
      const bool swapped = i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) &&
                           lower(a[i - 2]) == lower(b[j - 1]);
      if (swapped) row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
    before_last.swap(last);
    last.swap(row);
  }
  return last[b.size()];
}

}  // namespace

std::optional<std::string> find_nearest_name(std::string_view word,
                                             std::span<const std::string> known) {
  if (word.size() > kMaxWordBytes) return std::nullopt;
  std::size_t least = std::max<std::size_t>(2, word.size() / 3) + 1;
  const std::string* nearest = nullptr;
  for (const std::string& name : known) {
    if (name.size() > kMaxWordBytes) continue;
    const std::size_t distance = edit_distance(word, name);
    // A short name that would have to change wholly is not meant.
    if (distance >= least || distance >= std::max(word.size(), name.size())) continue;
    least = distance;
    nearest = &name;
  }
  return nearest == nullptr ? std::nullopt : std::optional<std::string>(*nearest);
}

std::string did_you_mean(std::string_view word, std::span<const std::string> known) {
  const std::optional<std::string> nearest = find_nearest_name(word, known);
  return nearest ? "; did you mean " + in_quotes(*nearest) + "?" : "";
}

}  // namespace arris
