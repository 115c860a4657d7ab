#include "base/check.h"

#include <cstdio>
#include <cstdlib>

namespace arris {

void fail_check(const char* condition, const char* file, int line, const char* names,
                std::initializer_list<double> values) {
  std::fprintf(stderr, "%s:%d: check failed: %s", file, line, condition);
  if (values.size() > 0) {
    std::fprintf(stderr, " with (%s) =", names);
    for (const double value : values) {
      std::fprintf(stderr, " %.17g", value);
    }
  }
  std::fputs("\nThis is an error in Arris; please report it with the command that led here.\n",
             stderr);
  std::abort();
}

}  // namespace arris
