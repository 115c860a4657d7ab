#include "arris/version.h"

namespace arris {

const char* version() {
  return "0.1.0";
}

}  // namespace arris
