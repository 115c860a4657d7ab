#include "view/access.h"

#include <fmt/format.h>
#include <sys/random.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "arris/error.h"
#include "arris/io.h"
#include "io/file_kind.h"

namespace arris::view {
namespace {

constexpr std::size_t kMostTargetBytes = 2048;

std::optional<unsigned> digit_of(char c) {
  if (c >= '0' && c <= '9') return unsigned(c - '0');
  if (c >= 'a' && c <= 'f') return unsigned(c - 'a' + 10);
  if (c >= 'A' && c <= 'F') return unsigned(c - 'A' + 10);
  return std::nullopt;
}

// What is no escape stays as it is.
std::string decode_percent(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '%' && i + 2 < text.size()) {
      const auto high = digit_of(text[i + 1]), low = digit_of(text[i + 2]);
      if (high && low) {
        out += char(*high * 16 + *low);
        i += 2;
        continue;
      }
    }
    out += text[i];
  }
  return out;
}

std::string lower_case(std::string_view text) {
  std::string out(text);
  for (char& c : out) {
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
  }
  return out;
}

// Without port and brackets; empty for what is none.
std::string name_of_host(std::string_view host) {
  if (host.starts_with('[')) {
    const std::size_t end = host.find(']');
    if (end == std::string_view::npos) return "";
    return lower_case(host.substr(1, end - 1));
  }
  return lower_case(host.substr(0, host.find(':')));
}

bool is_number_address(std::string_view name) {
  if (name.empty()) return false;
  if (name.find(':') != std::string_view::npos) {
    return std::ranges::all_of(name, [](char c) { return digit_of(c) || c == ':' || c == '.'; });
  }
  return std::ranges::count(name, '.') == 3 &&
         std::ranges::all_of(name, [](char c) { return c == '.' || (c >= '0' && c <= '9'); });
}

bool is_loopback(std::string_view name) {
  return name == "localhost" || name == "127.0.0.1" || name == "::1";
}

}  // namespace

std::string make_token() {
  std::array<std::uint8_t, 16> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != ssize_t(bytes.size())) {
    throw Error(Error::Kind::failed, "token", "the system gives no random numbers");
  }
  std::string token;
  for (const std::uint8_t byte : bytes) token += fmt::format("{:02x}", byte);
  return token;
}

bool is_good_token(std::string_view token) {
  constexpr std::size_t kLeast = 16, kMost = 256;
  const auto is_plain = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-' ||
           c == '_';
  };
  return token.size() >= kLeast && token.size() <= kMost && std::ranges::all_of(token, is_plain);
}

bool is_same_secret(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference |= unsigned(static_cast<unsigned char>(a[i]) ^ static_cast<unsigned char>(b[i]));
  }
  return difference == 0;
}

std::optional<Target> parse_target(std::string_view target) {
  if (target.size() > kMostTargetBytes || !target.starts_with('/')) return std::nullopt;
  const std::size_t query = target.find('?');
  Target out;
  out.path = target.substr(0, query);
  if (query == std::string_view::npos) return out;
  std::string_view rest = target.substr(query + 1);
  while (!rest.empty()) {
    const std::string_view pair = rest.substr(0, rest.find('&'));
    rest.remove_prefix(std::min(rest.size(), pair.size() + 1));
    const std::size_t equals = pair.find('=');
    if (equals == std::string_view::npos) continue;
    const std::string_view key = pair.substr(0, equals);
    if (key == "t") out.token = decode_percent(pair.substr(equals + 1));
    if (key == "name") out.name = decode_percent(pair.substr(equals + 1));
  }
  return out;
}

bool is_own_host(std::string_view host, std::string_view listens_at) {
  const std::string name = name_of_host(host), own = lower_case(listens_at);
  if (is_loopback(name)) return true;
  if (is_loopback(own)) return false;
  return name == own || is_number_address(name);
}

bool is_own_origin(std::string_view origin, std::string_view host) {
  const std::string given = lower_case(origin), own = lower_case(host);
  return given == "http://" + own || given == "https://" + own;
}

std::string saved_scene_name(std::string_view name) {
  constexpr std::size_t kMost = 100;
  const auto is_word = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
  };
  const bool is_plain =
      name.size() <= kMost && name.ends_with(".toml") && is_word(name.front()) &&
      std::ranges::all_of(name, [&](char c) { return is_word(c) || c == '-' || c == '.'; });
  return is_plain ? std::string(name) : "scene.toml";
}

std::optional<std::string> upload_extension(std::string_view name) {
  std::string extension = extension_of(std::string(name.substr(0, 4096)));
  const std::vector<std::string> known = scene_extensions();
  if (extension == ".toml" || extension == ".scad" ||
      std::ranges::find(known, extension) == known.end()) {
    return std::nullopt;
  }
  return extension;
}

}  // namespace arris::view
