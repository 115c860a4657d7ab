#include "arris/output_files.h"

#include <fmt/format.h>
#include <unistd.h>

#include <system_error>

#include "arris/error.h"
#include "io/file_bytes.h"

namespace arris::program {
namespace {

namespace fs = std::filesystem;

// Devices and pipes take any number of files.
bool is_stream(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

fs::path folder_of(const fs::path& path) {
  return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

void check_writable(const NamedFile& file) {
  const auto fail = [&](const std::string& what) {
    throw Error(Error::Kind::input, file.path.string(), "can't be written: " + what);
  };
  const fs::path target = link_target(file.path);
  const fs::path folder = folder_of(target);
  std::error_code error;
  if (!fs::is_directory(folder, error)) fail(fmt::format("there is no folder {}", folder.string()));
  if (fs::is_directory(target, error)) fail("it is a folder");
  if (is_stream(target)) {
    if (::access(target.c_str(), W_OK) != 0) fail("it is write-protected");
  } else if (::access(folder.c_str(), W_OK) != 0) {
    fail(fmt::format("the folder {} is write-protected", folder.string()));
  }
}

bool is_same_file(const fs::path& a, const fs::path& b) {
  if (is_stream(a) || is_stream(b)) return false;
  std::error_code error;
  if (fs::equivalent(a, b, error) && !error) return true;
  // Files that are not there yet: the same name in the same folder.
  const fs::path target_a = link_target(a), target_b = link_target(b);
  return target_a.filename() == target_b.filename() &&
         fs::equivalent(folder_of(target_a), folder_of(target_b), error) && !error;
}

}  // namespace

void check_outputs(std::span<const NamedFile> outputs, std::span<const NamedFile> inputs) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    check_writable(outputs[i]);
    const auto check_apart = [&](const NamedFile& other) {
      if (!is_same_file(outputs[i].path, other.path)) return;
      throw Error(Error::Kind::input, outputs[i].path.string(),
                  fmt::format("{} and {} are one file; name another", other.name, outputs[i].name));
    };
    for (const NamedFile& input : inputs) check_apart(input);
    for (std::size_t k = 0; k < i; ++k) check_apart(outputs[k]);
  }
}

}  // namespace arris::program
