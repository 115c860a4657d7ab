// csg_openscad.h — what an installed openscad program does for us
// What       flattens .scad files to .csg text, and makes meshes of what csg_evaluator.h can't
// Guarantee  no shell; a program that takes longer than kOpenScadSeconds is ended; files of its own are in a
//            folder that is removed; so is one that runs when `stop` is set
// Errors     kind failed where processes or temporary files can't be made, or `stop` is set; what the program itself
//            complains about is returned
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace arris {

inline constexpr int kOpenScadSeconds = 300;

// On the PATH.
std::optional<std::filesystem::path> find_openscad();

// The file's bytes, or why there are none.
using OpenScadOutput = std::variant<std::vector<std::uint8_t>, std::string>;

// .scad to .csg
OpenScadOutput flatten_by_openscad(const std::filesystem::path& program,
                                   const std::filesystem::path& scad,
                                   const std::atomic<bool>* stop = nullptr);
// .csg text to .off; no bytes if it makes nothing.
OpenScadOutput mesh_by_openscad(const std::filesystem::path& program, const std::string& csg,
                                const std::atomic<bool>* stop = nullptr);

}  // namespace arris
