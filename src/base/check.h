// check.h — ARRIS_CHECK: an error of ours, found at run time
// What       ARRIS_CHECK(condition, values…) is on in every build. If the condition fails it prints
//            the condition, its place and the numbers, and aborts: name the pixel and the sample, so
//            that the run can be repeated.
// Limits     never for what a user's file may hold: that is arris::Error (error.h)
#pragma once

#include <initializer_list>

namespace arris {

[[noreturn]] void fail_check(const char* condition, const char* file, int line, const char* names,
                             std::initializer_list<double> values);

}  // namespace arris

#define ARRIS_CHECK(condition, ...)                                                     \
  do {                                                                                  \
    if (!(condition)) [[unlikely]] {                                                    \
      ::arris::fail_check(#condition, __FILE__, __LINE__, #__VA_ARGS__, {__VA_ARGS__}); \
    }                                                                                   \
  } while (false)
