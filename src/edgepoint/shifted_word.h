// shifted_word.h — bits of a row of a BitPlane as they are for pixels beside
#pragma once

#include <cstdint>

namespace arris {

// Bit i: that of the pixel dx to the right of pixel 64 word + i of the row; |dx| < 64.
inline std::uint64_t shifted_word(const std::uint64_t* row, int word, int dx) {
  if (dx == 0) return row[word];
  return dx > 0 ? row[word] >> unsigned(dx) | row[word + 1] << unsigned(64 - dx)
                : row[word] << unsigned(-dx) | row[word - 1] >> unsigned(64 + dx);
}

}  // namespace arris
