// error_message.h — what a reader says about a bad file
#pragma once

#include <string>

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

}  // namespace arris::test
