// file_bytes.h — whole files as bytes
// Guarantee  write_file_whole(): the file appears complete or not at all; it is written beside its
//            place and renamed, so that an old file stays until the new one is complete
// Errors     read: kind input (missing, a folder, unreadable, too large); write: kind failed
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace arris {

inline constexpr std::uint64_t kMaxFileBytes = std::uint64_t(16) << 30;

std::vector<std::uint8_t> read_file_bytes(const std::filesystem::path& path,
                                          std::uint64_t max_bytes = kMaxFileBytes);

void write_file_whole(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);

}  // namespace arris
