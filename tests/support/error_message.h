// error_message.h — what a reader says about a bad file
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "arris/error.h"
#include "support/cut_every_byte.h"

namespace arris::test {

// The message of the error that read(bytes) throws; "no error" if it throws none.
template <class Read, class Bytes>
std::string error_message(Read&& read, const Bytes& bytes) {
  try {
    read(bytes);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

// The same of something that a user has got wrong, and of nothing else.
template <class Read, class Bytes>
std::string refusal_of(Read&& read, const Bytes& bytes) {
  return error_message(
      [&](const Bytes& all) {
        try {
          read(all);
        } catch (const Error& error) {
          EXPECT_EQ(error.kind(), Error::Kind::input);
          throw;
        }
      },
      bytes);
}

}  // namespace arris::test
