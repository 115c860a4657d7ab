// csg_reader.h — OpenSCAD models to scenes
// What       docs/openscad.md says what is read, and how
// Guarantee  a scene of at least one sound CSG tree, or one Error that names all nodes which can't be made
//            (tests/io/csg_reader_test.cpp cuts every byte; tests/fuzz)
// Errors     kind input, where = "file:line"; kind failed where openscad is needed for a .scad file and missing
// Cost       linear in the file as a rule; a run of openscad for each node that only it can make
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "io/csg_evaluator.h"

namespace arris {

// More parts than this at the file's top level are one object.
inline constexpr std::size_t kMaxCsgObjects = 256;

// An installed openscad, and models in the folder of the file.
CsgFiles csg_files_beside(const std::filesystem::path& file,
                          const std::atomic<bool>* stop = nullptr);
// Neither.
CsgFiles no_csg_files();

Scene read_csg(std::span<const std::uint8_t> bytes, const std::string& file, const CsgFiles& files,
               const LoadOptions& options = {});

Scene read_scad(const std::filesystem::path& path, const LoadOptions& options = {});

}  // namespace arris
