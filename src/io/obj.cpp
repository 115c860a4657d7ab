// obj.cpp — Wavefront object files: polygons with materials; free-form geometry is refused
// Source     Alias Wavefront, "Object Files (.obj)", Advanced Visualizer manual, appendix B
#include <algorithm>
#include <charconv>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "base/nearest_name.h"
#include "base/utf8_text.h"
#include "io/mesh_readers.h"
#include "io/mesh_scene.h"
#include "io/mtl.h"
#include "io/obj_objects.h"
#include "io/text_scanner.h"

namespace arris {
namespace {

// Statements about how to show or group what is read anyway. Smoothing groups (s) are among them: without
// normals a mesh is flat.
constexpr std::string_view kUnneeded[] = {"s",        "mg",       "lod",        "bevel",
                                          "c_interp", "d_interp", "shadow_obj", "trace_obj",
                                          "usemap",   "maplib",   "vp"};
constexpr std::string_view kFreeForm[] = {
    "cstype", "deg",  "curv", "curv2", "surf", "parm", "trim", "hole", "scrv",  "sp",   "end",
    "con",    "bmat", "step", "bsp",   "bzp",  "cdc",  "cdp",  "res",  "ctech", "stech"};
// What some programs write for faces without a material.
constexpr std::string_view kNoMaterial[] = {"(null)", "None"};

constexpr std::size_t kMaxPool = std::size_t(std::numeric_limits<std::int32_t>::max());

template <class Range>
bool contains(const Range& range, std::string_view word) {
  return std::find(std::begin(range), std::end(range), word) != std::end(range);
}

class ObjReader {
 public:
  ObjReader(std::span<const std::uint8_t> bytes, const std::string& file, const ObjFiles& files)
      : text_(bytes, file),
        file_(file),
        files_(files),
        scene_(make_mesh_scene(file)),
        libraries_(files, scene_) {
    use_material("");
  }

  Scene read() {
    while (text_.next_line()) {
      const std::string_view keyword = next_word();
      if (!keyword.empty()) read_statement(keyword);
    }
    if (objects_.empty()) throw text_.error("has no faces; surfaces are needed");
    const std::vector<MaterialId> materials = resolve_materials();
    objects_.finish(pool_, materials, scene_);
    return std::move(scene_);
  }

 private:
  struct UsedMaterial {
    std::string name;
    std::size_t line = 0;
  };

  void read_statement(std::string_view keyword) {
    if (keyword == "v") {
      read_position();
    } else if (keyword == "f") {
      read_face();
    } else if (keyword == "vn") {
      read_normal();
    } else if (keyword == "vt") {
      read_uv();
    } else if (keyword == "g") {
      objects_.start_group(name_of_line());
    } else if (keyword == "o") {
      objects_.start_object(name_of_line());
    } else if (keyword == "usemtl") {
      use_material(name_of_line());
    } else if (keyword == "mtllib") {
      read_libraries();
    } else if (keyword == "l" || keyword == "p") {
      skip_with_note("lines and points are not read");
    } else {
      read_other(keyword);
    }
  }

  void read_other(std::string_view keyword) {
    if (contains(kUnneeded, keyword)) return skip_statement();
    if (contains(kFreeForm, keyword)) {
      throw text_.error(
          in_quotes(keyword) +
          " belongs to free-form curves and surfaces, which are not read; export polygons");
    }
    if (keyword == "call" || keyword == "csh") {
      throw text_.error(in_quotes(keyword) +
                        " runs another file, which is not done; join the files");
    }
    throw text_.error(
        "found " + in_quotes(keyword) +
        " where v, vt, vn, f, o, g, usemtl, mtllib or another statement of OBJ files should be");
  }

  // The statement's next word, over a backslash at a line's end and up to a comment.
  std::string_view next_word() {
    while (true) {
      std::string_view word = text_.word();
      if (word.empty()) return word;
      if (word[0] == '#') {
        text_.skip_line();
        return {};
      }
      if (word.back() != '\\' || !text_.rest_of_line().empty()) return word;
      word.remove_suffix(1);
      if (!text_.next_line() || !word.empty()) return word;
    }
  }

  void skip_statement() {
    while (!next_word().empty()) {
    }
  }

  void skip_with_note(const std::string& what) {
    skip_statement();
    if (noted_.insert(what).second) scene_.notes.push_back(what);
  }

  float number(std::string_view what) {
    const std::string_view word = next_word();
    if (word.empty()) throw text_.error("the line ends where " + std::string(what) + " should be");
    return text_.to_number(word, what);
  }

  template <class T>
  void check_room(const std::vector<T>& values) const {
    if (values.size() < kMaxPool) return;
    throw text_.error("more than " + std::to_string(kMaxPool) + " vertices; split the model");
  }

  // x y z, then a weight, which polygons do not use, or a colour.
  void read_position() {
    check_room(pool_.positions);
    Vec3f position;
    position.x = number("a vertex's x");
    position.y = number("a vertex's y");
    position.z = number("a vertex's z");
    pool_.positions.push_back(position);
    int more = 0;
    for (std::string_view word = next_word(); !word.empty(); word = next_word(), ++more) {
      text_.to_number(word, "a vertex's weight or colour");
    }
    if (more == 2 || more > 4) {
      throw text_.error("the vertex has " + std::to_string(more + 3) +
                        " numbers; write x y z, then a weight, or red green blue");
    }
    if (more > 2 && noted_.insert("colours").second) {
      scene_.notes.emplace_back("vertex colours are not read from OBJ files");
    }
  }

  void read_normal() {
    check_room(pool_.normals);
    Vec3f normal;
    normal.x = number("a normal's x");
    normal.y = number("a normal's y");
    normal.z = number("a normal's z");
    pool_.normals.push_back(normal);
    end_statement("a normal of three numbers");
  }

  // OBJ's v points up the picture.
  void read_uv() {
    check_room(pool_.uvs);
    const float u = number("a texture coordinate's u");
    std::string_view word = next_word();
    const float v = word.empty() ? 0.0F : text_.to_number(word, "a texture coordinate's v");
    pool_.uvs.push_back({u, 1 - v});
    if (!word.empty()) word = next_word();
    if (!word.empty()) text_.to_number(word, "a texture coordinate's w");
    if (!word.empty()) end_statement("a texture coordinate of at most three numbers");
  }

  void end_statement(std::string_view what) {
    const std::string_view word = next_word();
    if (!word.empty())
      throw text_.error("found " + in_quotes(word) + " after " + std::string(what));
  }

  void read_face() {
    corners_.clear();
    for (std::string_view word = next_word(); !word.empty(); word = next_word()) {
      corners_.push_back(corner(word));
    }
    if (corners_.size() < 3) {
      throw text_.error("the face has " + std::to_string(corners_.size()) +
                        " corners; at least 3 are needed");
    }
    if (!objects_.has_room()) {
      throw text_.error("more than " + std::to_string(kMaxObjects) +
                        " objects or groups; join some of them");
    }
    if (!objects_.add(corners_, current_material_, pool_)) {
      throw text_.error(
          "the faces up to this one of " + std::to_string(corners_.size()) +
          " corners are too intricate to cut into triangles; triangulate them on export");
    }
  }

  // "v", "v/vt", "v//vn" or "v/vt/vn".
  ObjCorner corner(std::string_view word) const {
    ObjCorner found;
    std::string_view rest = word;
    found.position = take_index(rest, word, "vertex", pool_.positions.size());
    if (take_slash(rest) && !rest.empty() && rest[0] != '/') {
      found.uv = take_index(rest, word, "texture coordinate", pool_.uvs.size());
    }
    if (take_slash(rest) && !rest.empty()) {
      found.normal = take_index(rest, word, "normal", pool_.normals.size());
    }
    if (!rest.empty()) fail_corner(word);
    return found;
  }

  static bool take_slash(std::string_view& rest) {
    if (rest.empty() || rest[0] != '/') return false;
    rest.remove_prefix(1);
    return true;
  }

  [[noreturn]] void fail_corner(std::string_view word) const {
    throw text_.error("found " + in_quotes(word) +
                      " where a corner should be: 1, 1/2, 1//3 or 1/2/3");
  }

  // Numbers count from 1, negative ones from the last line before this one.
  std::int32_t take_index(std::string_view& rest, std::string_view word, const std::string& what,
                          std::size_t count) const {
    std::int64_t index = 0;
    const char* const end = rest.data() + rest.size();
    const auto [stop, problem] = std::from_chars(rest.data(), end, index);
    if (problem == std::errc::invalid_argument) fail_corner(word);
    rest.remove_prefix(std::size_t(stop - rest.data()));
    const std::int64_t number = index < 0 ? index + std::int64_t(count) + 1 : index;
    if (problem == std::errc() && number >= 1 && number <= std::int64_t(count)) {
      return std::int32_t(number - 1);
    }
    throw text_.error("the face's corner " + in_quotes(word) + " names a " + what +
                      " that is not there: " + std::to_string(count) +
                      " are above this line, numbered from 1");
  }

  // Names may hold blanks.
  std::string_view name_of_line() {
    const std::string_view name = text_.rest_of_line();
    text_.skip_line();
    if (const std::string problem = problem_with_name(name); !problem.empty()) {
      throw text_.error(problem);
    }
    return name;
  }

  void use_material(std::string_view name) {
    const auto known = material_numbers_.find(name);
    if (known != material_numbers_.end()) {
      current_material_ = known->second;
      return;
    }
    if (used_materials_.size() == kMaxMaterials) {
      throw text_.error("more than " + std::to_string(kMaxMaterials) +
                        " materials; leave some out");
    }
    current_material_ = std::uint32_t(used_materials_.size());
    used_materials_.push_back({std::string(name), text_.line_number()});
    material_numbers_.emplace(std::string(name), current_material_);
  }

  // One name with blanks, or several names between blanks: the whole line first.
  void read_libraries() {
    const std::string line(text_.rest_of_line());
    text_.skip_line();
    if (line.empty()) throw text_.error("\"mtllib\" names no file");
    if (!files_.find_library) {
      scene_.notes.push_back("the material library " + in_quotes(line) +
                             " is left out: other files may not be read here");
      return;
    }
    has_library_ = true;
    if (read_library(line)) return;
    TextScanner names({reinterpret_cast<const std::uint8_t*>(line.data()), line.size()}, file_);
    for (std::string_view name = names.word_of_text(); !name.empty(); name = names.word_of_text()) {
      if (read_library(std::string(name))) continue;
      throw text_.error("the material library " + in_quotes(name) +
                        " is not there; put it beside the model, or delete this line for a model "
                        "without materials");
    }
  }

  // False if there is no such file.
  bool read_library(std::string name) {
    std::replace(name.begin(), name.end(), '\\', '/');
    if (libraries_read_.contains(name)) return true;
    const std::optional<std::vector<std::uint8_t>> bytes = files_.find_library(name);
    if (!bytes) return false;
    libraries_read_.insert(name);
    const std::string shown = in_quotes(name);
    libraries_.read(*bytes, name, shown.substr(1, shown.size() - 2));
    return true;
  }

  // Names mean nothing where no library is named: materials of the default look, for a scene file to
  // replace by their name.
  std::vector<MaterialId> resolve_materials() {
    std::vector<MaterialId> materials;
    std::vector<std::string> known;
    for (const auto& [name, id] : libraries_.names()) known.push_back(name);
    for (const UsedMaterial& used : used_materials_) {
      const auto found = libraries_.names().find(used.name);
      if (found != libraries_.names().end()) {
        materials.push_back(found->second);
      } else if (used.name.empty() || contains(kNoMaterial, used.name)) {
        materials.push_back(MaterialId{0});
      } else if (!has_library_) {
        materials.push_back(MaterialId{std::uint32_t(scene_.materials.size())});
        scene_.materials.emplace_back().name = used.name;
      } else {
        throw Error(Error::Kind::input, file_ + ":" + std::to_string(used.line),
                    "the material " + in_quotes(used.name) + " is in none of the libraries" +
                        did_you_mean(used.name, known));
      }
    }
    return materials;
  }

  TextScanner text_;
  std::string file_;
  const ObjFiles& files_;
  Scene scene_;
  MtlReader libraries_;
  std::set<std::string> libraries_read_;
  bool has_library_ = false;
  ObjPool pool_;
  ObjObjects objects_;
  std::vector<ObjCorner> corners_;  // of one face
  std::vector<UsedMaterial> used_materials_;
  std::map<std::string, std::uint32_t, std::less<>> material_numbers_;
  std::uint32_t current_material_ = 0;
  std::set<std::string> noted_;
};

}  // namespace

Scene read_obj(std::span<const std::uint8_t> bytes, const std::string& file,
               const ObjFiles& files) {
  return ObjReader(bytes, file, files).read();
}

}  // namespace arris
