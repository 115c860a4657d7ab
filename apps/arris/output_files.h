// output_files.h — the files that a command writes, checked before any work begins
// What       late surprises after hours of rendering are the worst
// Errors     arris::Error, kind input: a folder that is missing or write-protected, a folder in the file's
//            place, two of the files being one, also through links
#pragma once

#include <filesystem>
#include <span>
#include <string>

namespace arris::program {

struct NamedFile {
  std::string name;  // of the option or argument, for messages: "-o"
  std::filesystem::path path;
};

// The inputs may be missing: reading them says so.
void check_outputs(std::span<const NamedFile> outputs, std::span<const NamedFile> inputs);

}  // namespace arris::program
