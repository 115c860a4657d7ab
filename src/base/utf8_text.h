// utf8_text.h — text from files, checked and shown
#pragma once

#include <string>
#include <string_view>

namespace arris {

// True for well-formed UTF-8: no overlong forms, surrogates or code points past U+10FFFF.
bool is_utf8(std::string_view text);

// In double quotes for a message: control characters and bytes that are not UTF-8 become U+FFFD,
// text longer than 60 bytes is cut and ends in "…".
std::string in_quotes(std::string_view text);

}  // namespace arris
