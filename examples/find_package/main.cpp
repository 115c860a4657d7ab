// rounded_box — prints the version of the installed library
#include <cstdio>

#include "arris/version.h"

int main() {
  std::printf("arris %s\n", arris::version());
  return 0;
}
