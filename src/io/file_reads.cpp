#include "io/file_reads.h"

#include <utility>

namespace arris {
namespace {

thread_local const FileReads* listener = nullptr;

}  // namespace

FileReads::FileReads(Hear hear) : hear_(std::move(hear)) {
  listener = this;
}
FileReads::~FileReads() {
  listener = nullptr;
}

void FileReads::tell(const std::filesystem::path& file) {
  if (listener != nullptr) listener->hear_(file);
}

}  // namespace arris
