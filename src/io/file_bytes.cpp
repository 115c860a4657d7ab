#include "io/file_bytes.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <system_error>
#include <utility>

#include "arris/error.h"
#include "io/file_reads.h"

namespace arris {
namespace {

namespace fs = std::filesystem;

struct FileCloser {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, FileCloser>;

std::string reason(int error_number) {
  return std::generic_category().message(error_number);
}

// Beside the target, so that the rename stays within one file system.
class TemporaryFile {
 public:
  explicit TemporaryFile(const fs::path& target)
      : name_(target.string() + ".partial-XXXXXX"), descriptor_(::mkstemp(name_.data())) {}
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    (void)close();
    if (!name_.empty()) ::unlink(name_.c_str());
  }

  [[nodiscard]] bool is_open() const { return descriptor_ >= 0; }

  [[nodiscard]] bool write(std::span<const std::uint8_t> bytes) const {
    while (!bytes.empty()) {
      const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
      if (written < 0 && errno == EINTR) continue;
      if (written < 0) return false;
      bytes = bytes.subspan(std::size_t(written));
    }
    return true;
  }

  // mkstemp makes files that only the owner may read: gives it the rights of a plain new file.
  void open_to_others() const {
    const mode_t mask = ::umask(0);
    ::umask(mask);
    ::fchmod(descriptor_, 0666 & ~mask);
  }

  [[nodiscard]] bool close() {
    const int descriptor = std::exchange(descriptor_, -1);
    return descriptor < 0 || ::close(descriptor) == 0;
  }

  [[nodiscard]] bool move_to(const fs::path& target) {
    if (std::rename(name_.c_str(), target.c_str()) != 0) return false;
    name_.clear();
    return true;
  }

 private:
  std::string name_;
  int descriptor_;
};

bool is_device(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  return fs::is_character_file(status) || fs::is_fifo(status);
}

void write_device(const fs::path& path, std::span<const std::uint8_t> bytes) {
  const File file(std::fopen(path.c_str(), "wb"));
  if (!file || std::fwrite(bytes.data(), 1, bytes.size(), file.get()) != bytes.size() ||
      std::fflush(file.get()) != 0) {
    throw Error(Error::Kind::failed, path.string(), "can't be written: " + reason(errno));
  }
}

}  // namespace

std::vector<std::uint8_t> read_file_bytes(const fs::path& path, std::uint64_t max_bytes) {
  FileReads::tell(path);
  const auto fail = [&](const std::string& what) {
    throw Error(Error::Kind::input, path.string(), what);
  };
  std::error_code error;
  if (fs::is_directory(path, error)) fail("is a folder, not a file");
  const fs::file_status status = fs::status(path, error);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    fail("is a pipe or device, not a file; copy what comes from it to a file");
  }
  const File file(std::fopen(path.c_str(), "rb"));
  if (!file) fail("can't be opened: " + reason(errno));

  std::vector<std::uint8_t> bytes;
  const std::uintmax_t size = fs::file_size(path, error);
  const auto check_size = [&](std::uintmax_t n) {
    if (n > max_bytes) fail("is larger than the limit of " + std::to_string(max_bytes) + " bytes");
  };
  if (!error) check_size(size);
  bytes.reserve(error ? 0 : std::size_t(size) + 1);
  bytes.resize(error ? 0 : std::size_t(size));
  // One byte more than expected, so that the end of file is seen; some files of the system say no size and
  // grow in steps.
  std::size_t used = 0;
  while (true) {
    if (used == bytes.size()) bytes.resize(used == size ? used + 1 : 2 * used + 65536);
    const std::size_t count = std::fread(bytes.data() + used, 1, bytes.size() - used, file.get());
    used += count;
    check_size(used);
    if (count == 0) break;
  }
  if (std::ferror(file.get()) != 0) fail("can't be read: " + reason(errno));
  bytes.resize(used);
  return bytes;
}

fs::path link_target(const fs::path& path) {
  constexpr int kMostLinks = 40;  // as the kernel
  fs::path target = path;
  std::error_code error;
  for (int i = 0; i < kMostLinks && fs::is_symlink(target, error); ++i) {
    target = target.parent_path() / fs::read_symlink(target, error);
    if (error) return path;
  }
  return target;
}

struct NewFiles::File {
  explicit File(const fs::path& to) : path(to), target(link_target(to)), temporary(target) {}

  fs::path path;
  fs::path target;  // a link stays a link: the file it points to is replaced
  TemporaryFile temporary;
};

NewFiles::NewFiles() = default;
NewFiles::~NewFiles() = default;

void NewFiles::add(const fs::path& path, std::span<const std::uint8_t> bytes) {
  const auto fail = [&](int error_number) {
    throw Error(Error::Kind::failed, path.string(), "can't be written: " + reason(error_number));
  };
  if (is_device(path)) return write_device(path, bytes);
  std::error_code error;
  if (fs::is_directory(path, error)) fail(EISDIR);
  auto file = std::make_unique<File>(path);
  if (!file->temporary.is_open()) fail(errno);
  file->temporary.open_to_others();
  if (!file->temporary.write(bytes)) fail(errno);
  if (!file->temporary.close()) fail(errno);
  files_.push_back(std::move(file));
}

void NewFiles::appear() {
  for (const std::unique_ptr<File>& file : files_) {
    if (!file->temporary.move_to(file->target)) {
      throw Error(Error::Kind::failed, file->path.string(), "can't be written: " + reason(errno));
    }
  }
  files_.clear();
}

void write_file_whole(const fs::path& path, std::span<const std::uint8_t> bytes) {
  NewFiles file;
  file.add(path, bytes);
  file.appear();
}

}  // namespace arris
