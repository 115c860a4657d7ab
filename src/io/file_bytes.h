// file_bytes.h — whole files as bytes
// Guarantee  write_file_whole(): the file appears complete or not at all; it is written beside its
//            place and renamed, so that an old file stays until the new one is complete
// Limits     only regular files are read: a pipe or device that a model names would never end
// Errors     read: kind input (missing, a folder, a pipe or device, unreadable, too large); write: kind failed
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <vector>

namespace arris {

inline constexpr std::uint64_t kMaxFileBytes = std::uint64_t(16) << 30;

std::vector<std::uint8_t> read_file_bytes(const std::filesystem::path& path,
                                          std::uint64_t max_bytes = kMaxFileBytes);

// Several files that appear together: none does if one of them can't be written.
class NewFiles {
 public:
  NewFiles();
  NewFiles(const NewFiles&) = delete;
  NewFiles& operator=(const NewFiles&) = delete;
  // Without appear() before it nothing is left.
  ~NewFiles();

  // Writes the file beside its place; a pipe or device gets the bytes at once.
  void add(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);
  void appear();

 private:
  struct File;
  std::vector<std::unique_ptr<File>> files_;
};

// What a link, or a chain of them, points to, whether that is there or not; other paths as they are.
std::filesystem::path link_target(const std::filesystem::path& path);

void write_file_whole(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);

}  // namespace arris
