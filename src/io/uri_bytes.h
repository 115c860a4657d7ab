// uri_bytes.h — what a URI inside a model file stands for: data: URIs and relative file names
// Limits     files in the model's folder and below: a model from elsewhere reads nothing else of this machine
//            (links in the folder are followed, they are the user's)
// Errors     kind input: bad base64, missing file, a scheme that would need the network
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace arris {

// `where` is named in errors. Without a folder only data: URIs are read.
std::vector<std::uint8_t> load_uri(std::string_view uri,
                                   const std::optional<std::filesystem::path>& base_folder,
                                   const std::string& where);

// RFC 4648; padding may be missing. Throws Error.
std::vector<std::uint8_t> decode_base64(std::string_view text, const std::string& where);

// "a%20b" → "a b"; a % that no two hex digits follow stands for itself.
std::string decode_percent(std::string_view text);

}  // namespace arris
