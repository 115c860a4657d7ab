#include "base/utf8_text.h"

#include <cstddef>
#include <cstdint>

namespace arris {
namespace {

constexpr std::size_t kMaxShownBytes = 60;

// Bytes of the well-formed sequence at the start of text (Unicode 15, table 3-7); 0 if there is
// none.
std::size_t sequence_length(std::string_view text) {
  const auto byte = [&](std::size_t i) {
    return i < text.size() ? std::uint8_t(text[i]) : std::uint8_t(0);
  };
  const auto in = [&](std::size_t i, int low, int high) {
    return byte(i) >= low && byte(i) <= high;
  };
  const int lead = byte(0);
  if (lead < 0x80) return 1;
  if (lead >= 0xC2 && lead <= 0xDF) return in(1, 0x80, 0xBF) ? 2 : 0;
  if (lead >= 0xE0 && lead <= 0xEF) {
    const int low = lead == 0xE0 ? 0xA0 : 0x80;
    const int high = lead == 0xED ? 0x9F : 0xBF;
    return in(1, low, high) && in(2, 0x80, 0xBF) ? 3 : 0;
  }
  if (lead >= 0xF0 && lead <= 0xF4) {
    const int low = lead == 0xF0 ? 0x90 : 0x80;
    const int high = lead == 0xF4 ? 0x8F : 0xBF;
    return in(1, low, high) && in(2, 0x80, 0xBF) && in(3, 0x80, 0xBF) ? 4 : 0;
  }
  return 0;
}

}  // namespace

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const std::size_t length = sequence_length(text);
    if (length == 0) return false;
    text.remove_prefix(length);
  }
  return true;
}

std::string in_quotes(std::string_view text) {
  std::string shown = "\"";
  while (!text.empty()) {
    const std::size_t length = sequence_length(text);
    if (shown.size() + length > kMaxShownBytes) {
      shown += "…";
      break;
    }
    const bool control = length == 1 && (std::uint8_t(text[0]) < 0x20 || text[0] == 0x7F);
    if (length == 0 || control) {
      shown += "\uFFFD";
    } else {
      shown += text.substr(0, length);
    }
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return shown + "\"";
}

}  // namespace arris
