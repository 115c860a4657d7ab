// mesh_readers.h — plain mesh files in memory to scenes
// What       one function per format; docs/formats.md says what each takes, maps and refuses
// In         the whole file; `file`: its name, for errors and for objects without a name
// Guarantee  a scene of at least one triangle with finite positions and indices in range, or one
//            Error; memory stays within a small multiple of the file's size whatever the counts in
//            it say (tests/io/*_reader_test.cpp cut every byte; tests/fuzz)
// Errors     kind input; where = "file:line" in text, "file" in binary with the element and byte
// Cost       linear in the file, except polygons: see polygon.h
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "arris/scene.h"

namespace arris {

Scene read_stl(std::span<const std::uint8_t> bytes, const std::string& file);
// Binary by its size, or ASCII by its first words.
bool looks_like_stl(std::span<const std::uint8_t> bytes);

Scene read_ply(std::span<const std::uint8_t> bytes, const std::string& file);
bool looks_like_ply(std::span<const std::uint8_t> bytes);

Scene read_off(std::span<const std::uint8_t> bytes, const std::string& file);
bool looks_like_off(std::span<const std::uint8_t> bytes);

// Needs arris-step; kind failed where that is not installed, or when `stop` is set.
Scene read_step(std::span<const std::uint8_t> bytes, const std::string& file,
                const std::atomic<bool>* stop = nullptr);
bool looks_like_step(std::span<const std::uint8_t> bytes);

// How the OBJ reader reaches the files that a model names, relative to the model; each returns nothing
// where there is no such file and throws Error where it can't be read. Both null: no other file may be read, and
// models have no materials but their names.
struct ObjFiles {
  std::function<std::optional<std::vector<std::uint8_t>>(const std::string& name)> find_library;
  std::function<std::optional<Texture>(const std::string& name)> find_texture;
};
// Those beside the model's own file.
ObjFiles files_beside(const std::filesystem::path& model);

Scene read_obj(std::span<const std::uint8_t> bytes, const std::string& file, const ObjFiles& files);

}  // namespace arris
