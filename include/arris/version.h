// version.h — the library's version
#pragma once

namespace arris {

// "major.minor.patch"
const char* version();

}  // namespace arris
