// picture_file.h — pictures with the text that files carry beside the pixels
// What       load_picture() and save_picture() of arris/io.h on bytes and with attributes
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "arris/image.h"
#include "arris/io.h"
#include "image/compare.h"

namespace arris {

using Attributes = std::vector<std::pair<std::string, std::string>>;

struct PictureFile {
  Picture picture;
  Attributes attributes;                           // string attributes of an EXR file; else empty
  ValueEncoding encoding = ValueEncoding::linear;  // of the file's values; the picture is linear
};

PictureFile load_picture_file(const std::filesystem::path& path);

// The format is what the first bytes say. name: for messages.
PictureFile decode_picture(std::span<const std::uint8_t> bytes, const std::string& name);

enum class PictureFormat { png, jpeg, exr, pfm };
// By extension; throws Error (kind input) for any other, naming those that are known.
PictureFormat picture_format(const std::filesystem::path& path);

// Where save_picture() puts a layer beside a picture whose format has none.
std::filesystem::path layer_file(const std::filesystem::path& path, const std::string& layer);
// And where SaveOptions::shown_layers.
std::filesystem::path shown_layer_file(const std::filesystem::path& path, const std::string& layer);

// Empty if the format takes pictures of this size; else what is wrong and what to do.
std::string problem_with_size(PictureFormat format, int width_px, int height_px);

// Layers are part of EXR only. Throws Error (kind input) for a size that the format does not take.
std::vector<std::uint8_t> encode_picture(const Picture& picture, PictureFormat format,
                                         const SaveOptions& options = {});

}  // namespace arris
