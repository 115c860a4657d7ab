#include "io/uri_bytes.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "arris/error.h"
#include "base/utf8_text.h"
#include "io/file_bytes.h"

namespace arris {
namespace {

// The 6 bits of a digit, or −1.
int base64_value(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+' || c == '-') return 62;
  if (c == '/' || c == '_') return 63;
  return -1;
}

bool has_scheme(std::string_view uri) {
  const std::size_t colon = uri.find(':');
  return colon != std::string_view::npos && colon > 1 &&  // one letter: a Windows drive
         uri.find('/') > colon;
}

std::vector<std::uint8_t> decode_data_uri(std::string_view uri, const std::string& where) {
  const std::size_t comma = uri.find(',');
  if (comma == std::string_view::npos) {
    throw Error(Error::Kind::input, where, "the data: URI has no comma");
  }
  const std::string_view body = uri.substr(comma + 1);
  if (uri.substr(0, comma).ends_with(";base64")) return decode_base64(body, where);
  const std::string text = decode_percent(body);
  return {text.begin(), text.end()};
}

}  // namespace

std::vector<std::uint8_t> decode_base64(std::string_view text, const std::string& where) {
  while (text.ends_with('=')) text.remove_suffix(1);
  std::vector<std::uint8_t> bytes;
  bytes.reserve(text.size() / 4 * 3 + 3);
  std::uint32_t bits = 0;
  int bit_count = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const int value = base64_value(text[i]);
    if (value < 0) {
      throw Error(Error::Kind::input, where,
                  fmt::format("the data: URI is not base64 at its digit {}", i));
    }
    bits = (bits << 6) | std::uint32_t(value);
    bit_count += 6;
    if (bit_count >= 8) {
      bit_count -= 8;
      bytes.push_back(std::uint8_t(bits >> bit_count));
    }
  }
  return bytes;
}

std::string decode_percent(std::string_view text) {
  std::string decoded;
  decoded.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    std::uint8_t value = 0;
    if (text[i] == '%' && i + 2 < text.size()) {
      const char* digits = text.data() + i + 1;
      const auto [end, error] = std::from_chars(digits, digits + 2, value, 16);
      if (error == std::errc{} && end == digits + 2) {
        decoded.push_back(char(value));
        i += 2;
        continue;
      }
    }
    decoded.push_back(text[i]);
  }
  return decoded;
}

std::vector<std::uint8_t> load_uri(std::string_view uri,
                                   const std::optional<std::filesystem::path>& base_folder,
                                   const std::string& where) {
  if (uri.starts_with("data:")) return decode_data_uri(uri, where);
  if (!base_folder) {
    throw Error(Error::Kind::input, where,
                in_quotes(decode_percent(uri)) +
                    " is another file, which may not be read here; put all into one .glb");
  }
  if (has_scheme(uri)) {
    throw Error(Error::Kind::input, where,
                fmt::format("{} is not a file beside the model; put it there", in_quotes(uri)));
  }
  const std::string name = decode_percent(uri);
  const auto is_control = [](char c) { return std::uint8_t(c) < 0x20 || c == 0x7F; };
  if (name.empty() || !is_utf8(name) || std::ranges::any_of(name, is_control)) {
    throw Error(Error::Kind::input, where, in_quotes(name) + " is not a file name");
  }
  const std::filesystem::path file = std::filesystem::path(name).lexically_normal();
  if (file.is_absolute() || *file.begin() == "..") {
    throw Error(
        Error::Kind::input, where,
        fmt::format("{} is outside the model's folder; put the file in it", in_quotes(name)));
  }
  try {
    return read_file_bytes(*base_folder / file);
  } catch (const Error& error) {
    throw Error(error.kind(), where, error.what());
  }
}

}  // namespace arris
