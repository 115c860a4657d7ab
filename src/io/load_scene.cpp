// load_scene.cpp — the table of formats and the way from a path to a scene
#include <algorithm>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "arris/error.h"
#include "arris/io.h"
#include "base/nearest_name.h"
#include "base/utf8_text.h"
#include "io/csg_reader.h"
#include "io/file_bytes.h"
#include "io/file_kind.h"
#include "io/gltf_buffers.h"
#include "io/gltf_reader.h"
#include "io/mesh_readers.h"
#include "io/scene_bytes.h"
#include "io/toml_scene.h"

namespace arris {
namespace {

namespace fs = std::filesystem;

struct SceneFile {
  const fs::path& path;
  const LoadOptions& options;
  std::string name;  // the path as text, for errors
  std::span<const std::uint8_t> bytes;

  [[nodiscard]] bool is_alone() const {
    return options.other_files == LoadOptions::OtherFiles::none;
  }
};

std::optional<fs::path> folder_of(const SceneFile& file) {
  return file.is_alone() ? std::nullopt : std::optional(file.path.parent_path());
}

// Of formats that are nothing without other files.
void refuse_alone(const SceneFile& file) {
  if (!file.is_alone()) return;
  throw Error(Error::Kind::input, file.name, "needs other files, which may not be read here");
}

struct Format {
  std::string_view extension;
  std::string_view label;
  Scene (*read)(const SceneFile& file);
  // By content, for files with another format's extension; may be null.
  bool (*recognises)(std::span<const std::uint8_t> bytes);
};

// One row a format; the first that recognises a file's content names it.
constexpr Format kFormats[] = {
    {".stl", "STL", [](const SceneFile& f) { return read_stl(f.bytes, f.name); }, looks_like_stl},
    {".obj", "OBJ",
     [](const SceneFile& f) {
       return read_obj(f.bytes, f.name, f.is_alone() ? ObjFiles() : files_beside(f.path));
     },
     nullptr},
    {".ply", "PLY", [](const SceneFile& f) { return read_ply(f.bytes, f.name); }, looks_like_ply},
    {".off", "OFF", [](const SceneFile& f) { return read_off(f.bytes, f.name); }, looks_like_off},
    {".step", "STEP", [](const SceneFile& f) { return read_step(f.bytes, f.name, f.options.stop); },
     looks_like_step},
    {".stp", "STEP", [](const SceneFile& f) { return read_step(f.bytes, f.name, f.options.stop); },
     looks_like_step},
    {".glb", "GLB", [](const SceneFile& f) { return read_gltf(f.bytes, f.name, folder_of(f)); },
     is_glb},
    {".gltf", "glTF", [](const SceneFile& f) { return read_gltf(f.bytes, f.name, folder_of(f)); },
     nullptr},
    {".csg", "CSG",
     [](const SceneFile& f) {
       return read_csg(f.bytes, f.name,
                       f.is_alone() ? no_csg_files() : csg_files_beside(f.path, f.options.stop),
                       f.options);
     },
     nullptr},
    {".scad", "OpenSCAD",
     [](const SceneFile& f) {
       refuse_alone(f);
       return read_scad(f.path, f.options);
     },
     nullptr},
    {".toml", "TOML",
     [](const SceneFile& f) {
       refuse_alone(f);
       const std::string_view text(reinterpret_cast<const char*>(f.bytes.data()), f.bytes.size());
       return read_toml_scene(text, f.name, f.path.parent_path(),
                              [&](const fs::path& path) { return load_scene(path, f.options); });
     },
     nullptr},
};

std::string join(const std::vector<std::string>& words) {
  std::string joined;
  for (const std::string& word : words) joined += (joined.empty() ? "" : " ") + word;
  return joined;
}

// The first line that says something, without the blanks before it.
std::string_view first_line(std::string_view text) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
    std::string_view line = text.substr(0, end);
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    if (!line.empty() && line[0] != '#' && !line.starts_with("//")) return line;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return {};
}

// As "group() {" of an OpenSCAD tree.
bool starts_with_call(std::string_view line) {
  if (line.starts_with('%')) line.remove_prefix(1);
  const std::size_t end = std::min(
      line.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_"),
      line.size());
  line.remove_prefix(end);
  line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
  return end > 0 && line.starts_with('(');
}

std::string_view find_text_extension(std::string_view text) {
  const std::string_view line = first_line(text);
  if (line.starts_with('{')) return ".gltf";
  if (line.starts_with('[')) return ".toml";
  const std::string_view word = line.substr(0, line.find_first_of(" \t"));
  for (const std::string_view keyword : {"v", "vt", "vn", "f", "o", "g", "s", "usemtl", "mtllib"}) {
    if (word == keyword) return ".obj";  // none is a key of scene files
  }
  if (starts_with_call(line)) return ".csg";
  return line.find('=') == std::string_view::npos ? "" : ".toml";
}

const Format& format_of(const fs::path& path) {
  const std::string extension = extension_of(path);
  for (const Format& format : kFormats) {
    if (format.extension == extension) return format;
  }
  const std::vector<std::string> known = scene_extensions();
  const std::string read = "Arris reads " + join(known);
  if (extension.empty()) {
    throw Error(Error::Kind::input, path.string(),
                "has no extension that says its format; " + read);
  }
  throw Error(Error::Kind::input, path.string(),
              "the extension " + in_quotes(extension) + " is not known; " + read +
                  did_you_mean(extension, known));
}

// A reader's complaint about a file of another format would mislead.
void check_content(const Format& format, const SceneFile& file) {
  if (format.recognises != nullptr && format.recognises(file.bytes)) return;
  for (const Format& other : kFormats) {
    if (other.recognises == nullptr || !other.recognises(file.bytes)) continue;
    throw Error(Error::Kind::input, file.name,
                "holds " + std::string(other.label) + " data, not " + std::string(format.label) +
                    "; give it the extension " + std::string(other.extension));
  }
}

}  // namespace

std::vector<std::string> scene_extensions() {
  std::vector<std::string> extensions;
  for (const Format& format : kFormats) extensions.emplace_back(format.extension);
  return extensions;
}

Scene load_scene(const fs::path& path, const LoadOptions& options) {
  const Format& format = format_of(path);
  const std::vector<std::uint8_t> bytes = read_file_bytes(path);
  const SceneFile file{path, options, path.string(), bytes};
  if (bytes.empty()) throw Error(Error::Kind::input, file.name, "is empty; a model is needed");
  check_content(format, file);
  return format.read(file);
}

std::string find_scene_extension(std::span<const std::uint8_t> bytes, const std::string& name) {
  if (bytes.empty()) throw Error(Error::Kind::input, name, "is empty; a model is needed");
  for (const Format& format : kFormats) {
    if (format.recognises != nullptr && format.recognises(bytes)) {
      return std::string(format.extension);
    }
  }
  const std::string_view extension =
      find_text_extension({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  if (!extension.empty()) return std::string(extension);
  throw Error(
      Error::Kind::input, name,
      "holds no model that Arris knows by its content; give a file whose extension is one of " +
          join(scene_extensions()));
}

Scene read_scene(std::span<const std::uint8_t> bytes, const std::string& extension,
                 const std::string& name, const LoadOptions& options) {
  const fs::path path(name);
  return format_of(fs::path(name + extension)).read({path, options, name, bytes});
}

}  // namespace arris
