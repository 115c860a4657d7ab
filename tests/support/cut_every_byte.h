// cut_every_byte.h — a reader against every prefix of a file and against changed bytes
// What       cut_every_byte(file, read) gives read() each prefix, change_every_byte(file, read) the file
//            with one byte set to each of a few values; the test fails on a problem of reading
// Legend     read: Scene(std::span<const std::uint8_t>)
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "support/reading_problem.h"

namespace arris::test {

inline std::vector<std::uint8_t> bytes_of(std::string_view text) {
  return {text.begin(), text.end()};
}

template <class Read>
void cut_every_byte(std::span<const std::uint8_t> file, Read&& read) {
  for (std::size_t size = 0; size <= file.size(); ++size) {
    ASSERT_EQ(problem_of_reading(file.first(size), read), "") << "cut after " << size << " bytes";
  }
}

template <class Read>
void change_every_byte(std::span<const std::uint8_t> file, Read&& read) {
  std::vector<std::uint8_t> changed(file.begin(), file.end());
  for (std::size_t i = 0; i < changed.size(); ++i) {
    const std::uint8_t old = changed[i];
    for (const int value : {0, 1, 0x7F, 0x80, 0xFF, old ^ 1, old ^ 0x80, int(' '), int('\n'),
                            int('-'), int('9'), int('"'), int('/')}) {
      changed[i] = std::uint8_t(value);
      ASSERT_EQ(problem_of_reading(changed, read), "") << "byte " << i << " set to " << value;
    }
    changed[i] = old;
  }
}

}  // namespace arris::test
