// file_reads.h — which files a piece of work reads
// What       while a FileReads lives, it hears of every file that read_file_bytes() is about to read in its thread,
//            also of those that can't be read
// Limits     one at a time in a thread; what other programs read is not heard of
#pragma once

#include <filesystem>
#include <functional>

namespace arris {

class FileReads {
 public:
  using Hear = std::function<void(const std::filesystem::path& file)>;
  explicit FileReads(Hear hear);
  FileReads(const FileReads&) = delete;
  FileReads& operator=(const FileReads&) = delete;
  ~FileReads();

  // Of read_file_bytes().
  static void tell(const std::filesystem::path& file);

 private:
  Hear hear_;
};

}  // namespace arris
