// io.h — files in, files out
// Errors     arris::Error: kind input for what is wrong in a file, kind failed for what the machine
//            can't do (disk full, permission)
// Guarantee  a saved file appears whole or not at all: it is written beside its place and renamed
#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "arris/image.h"
#include "arris/scene.h"

namespace arris {

struct LoadOptions {
  // Round things of OpenSCAD files. exact: true spheres, cylinders and circles, but for those with a small
  // explicit $fn, such as a hexagon; as_written: with OpenSCAD's facets.
  enum class Facets { exact, as_written } facets = Facets::exact;
  // What OBJ, glTF and OpenSCAD files name: material libraries, pictures, buffers, models. beside: found from where the
  // file is, and OpenSCAD may be run; none: nothing else is read or run, for files of strangers. glTF never leaves its
  // folder.
  enum class OtherFiles { beside, none } other_files = OtherFiles::beside;
  // Set from any thread: a program that is run for the file is ended, and so is loading, with Error{failed}.
  const std::atomic<bool>* stop = nullptr;
};

// By extension: .stl .obj .ply .off .step .stp .gltf .glb .csg .scad .toml. Throws Error.
Scene load_scene(const std::filesystem::path& path, const LoadOptions& options = {});

// The extensions that load_scene() takes, with the dot.
std::vector<std::string> scene_extensions();

// .png .jpg .jpeg .exr .pfm .hdr; 8-bit files are decoded to linear. An EXR's extra channels become layers.
Picture load_picture(const std::filesystem::path& path);

struct SaveOptions {
  double exposure = 0;   // stops; 8-bit formats only
  bool tone_map = true;  // false: clip (8-bit formats only)
  int jpeg_quality = 92;
  // String attributes of an EXR file: what part of which render it holds.
  std::vector<std::pair<std::string, std::string>> attributes;
  // Layers with values from 0 to 1 that are to be looked at: beside other formats than EXR also out.albedo.png.
  std::vector<std::string> shown_layers;
};

// .png .jpg .exr .pfm by extension. Layers go into EXR files as channels "name.R", … and beside other formats as
// files of their own, always .pfm: out.png → out.albedo.pfm.
void save_picture(const Picture& picture, const std::filesystem::path& path,
                  const SaveOptions& options = {});

// The scene-referred to display curve of 8-bit output: linear RGB in, sRGB-encoded 0..1 out.
Rgb tone_map(Rgb linear, double exposure);

}  // namespace arris
