// off.cpp — Geomview's object file format
// Legend     [ST][C][N]OFF, counts of vertices, faces and edges, then a line a vertex: x y z [normal]
//            [colour] [s t], then a line a face: n, n vertex numbers from 0, [colour]
#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/utf8_text.h"
#include "io/mesh_readers.h"
#include "io/mesh_scene.h"
#include "io/polygon_mesh.h"
#include "io/text_scanner.h"

namespace arris {
namespace {

// The shortest lines there are: "0 0 0" and "0", with their ends.
constexpr std::size_t kMinVertexBytes = 6;
constexpr std::size_t kMinFaceBytes = 2;
constexpr std::size_t kMaxColorNumbers = 4;

struct Layout {
  bool uvs = false;
  bool colors = false;
  bool normals = false;
};

// What the keyword says; empty if it is none. `rest`: what sticks to it, as in "OFF490 518 0".
struct Keyword {
  Layout layout;
  std::string_view rest;
};

std::optional<Keyword> parse_keyword(std::string_view word) {
  const auto take = [&](std::string_view prefix) {
    const bool found = word.starts_with(prefix);
    if (found) word.remove_prefix(prefix.size());
    return found;
  };
  Keyword keyword;
  keyword.layout.uvs = take("ST");
  keyword.layout.colors = take("C");
  keyword.layout.normals = take("N");
  if (!take("OFF")) return std::nullopt;
  if (!word.empty() && (word[0] < '0' || word[0] > '9')) return std::nullopt;
  keyword.rest = word;
  return keyword;
}

class OffReader {
 public:
  OffReader(std::span<const std::uint8_t> bytes, const std::string& file)
      : text_(bytes, file), scene_(make_mesh_scene(file)) {
    polygons_.mesh.name = name_from_file(file);
  }

  Scene read() {
    read_header();
    for (std::size_t i = 0; i < vertex_count_; ++i) read_vertex();
    for (std::size_t i = 0; i < face_count_; ++i) read_face();
    if (next_filled_line()) {
      throw text_.error("more lines follow the " + std::to_string(face_count_) +
                        " faces that the header says: its counts are wrong");
    }
    if (layout_.colors || face_colors_)
      scene_.notes.emplace_back("colours are not read from OFF files");
    normalize_normals(polygons_.mesh, scene_);
    add_object(scene_, std::move(polygons_.mesh));
    return std::move(scene_);
  }

 private:
  bool next_filled_line() {
    while (text_.next_line()) {
      text_.cut_line_at('#');
      if (!text_.rest_of_line().empty()) return true;
    }
    return false;
  }

  void need_line(const std::string& what) {
    if (next_filled_line()) return;
    throw text_.error("the file ends where " + what +
                      " should be: it is cut off or its counts are wrong");
  }

  void read_header() {
    if (!next_filled_line()) throw text_.error("holds no text; an OFF file is needed");
    const std::string_view word = text_.word();
    const std::optional<Keyword> keyword = parse_keyword(word);
    if (!keyword) {
      throw text_.error(
          "found " + in_quotes(word) +
          " where OFF, NOFF, COFF, STOFF or another of [ST][C][N]OFF should start the "
          "file; files of other dimensions (4OFF, nOFF) are not read");
    }
    layout_ = keyword->layout;
    std::string_view first = keyword->rest.empty() ? text_.word() : keyword->rest;
    if (first == "BINARY") throw text_.error("binary OFF files are not read; save it as ASCII");
    if (first.empty()) {
      need_line("the counts of vertices and faces");
      first = text_.word();
    }
    vertex_count_ = count(first, "the count of vertices");
    face_count_ = count(text_.word(), "the count of faces");
    // A count of edges may follow; it often is wrong, and nobody needs it.
    if (face_count_ == 0) throw text_.error("has no faces; surfaces are needed, not points");
    text_.skip_line();
    const std::size_t left = text_.bytes_left() + 1;  // the last line may have no end
    if (vertex_count_ > left / kMinVertexBytes ||
        face_count_ > (left - kMinVertexBytes * vertex_count_) / kMinFaceBytes) {
      throw text_.error("the header says " + std::to_string(vertex_count_) + " vertices and " +
                        std::to_string(face_count_) + " faces, but only " +
                        std::to_string(left - 1) + " bytes follow: it is cut off or damaged");
    }
    polygons_.mesh.positions.reserve(vertex_count_);
    polygons_.mesh.triangles.reserve(face_count_);
  }

  std::size_t count(std::string_view word, const std::string& what) {
    const std::optional<std::int64_t> value = parse_integer(word);
    if (!value || *value < 0 || std::size_t(*value) > kMaxCorners) {
      throw text_.error(what + " is " + in_quotes(word) + ", not a number from 0 to " +
                        std::to_string(kMaxCorners));
    }
    return std::size_t(*value);
  }

  void read_vertex() {
    need_line("a vertex");
    Vec3f position;
    position.x = text_.number("a vertex's x");
    position.y = text_.number("a vertex's y");
    position.z = text_.number("a vertex's z");
    polygons_.mesh.positions.push_back(position);
    if (layout_.normals) {
      Vec3f normal;
      normal.x = text_.number("a normal's x");
      normal.y = text_.number("a normal's y");
      normal.z = text_.number("a normal's z");
      polygons_.mesh.normals.push_back(normal);
    }
    read_color_and_uv();
  }

  // The colour has three or four numbers: the texture coordinates are the line's last two.
  void read_color_and_uv() {
    numbers_.clear();
    const std::size_t most = (layout_.colors ? kMaxColorNumbers : 0) + (layout_.uvs ? 2 : 0);
    for (std::string_view word = text_.word(); !word.empty(); word = text_.word()) {
      if (numbers_.size() == most) {
        throw text_.error("found " + in_quotes(word) +
                          " after a vertex; the file's first word says what a vertex has: "
                          "C for a colour, N for a normal, ST for texture coordinates");
      }
      numbers_.push_back(text_.to_number(word, "a vertex's colour or texture coordinate"));
    }
    if (!layout_.uvs) return;
    if (numbers_.size() < 2)
      throw text_.error("the vertex has no texture coordinates; STOFF needs two");
    const float s = numbers_[numbers_.size() - 2], t = numbers_.back();
    polygons_.mesh.uvs.push_back({s, 1 - t});
  }

  void read_face() {
    need_line("a face");
    const std::size_t corner_count = count(text_.word(), "a face's count of corners");
    corners_.clear();
    for (std::size_t i = 0; i < corner_count; ++i) {
      const std::string_view word = text_.word();
      if (word.empty()) {
        throw text_.error("the face has " + std::to_string(i) + " corners; its first number says " +
                          std::to_string(corner_count));
      }
      const std::optional<std::int64_t> corner = parse_integer(word);
      if (!corner)
        throw text_.error("found " + in_quotes(word) + " where a vertex's number should be");
      corners_.push_back(*corner);
    }
    if (!text_.word().empty()) face_colors_ = true;
    if (const std::string problem = polygons_.add(corners_); !problem.empty()) {
      throw text_.error(problem);
    }
  }

  TextScanner text_;
  Scene scene_;
  PolygonMesh polygons_;
  Layout layout_;
  std::size_t vertex_count_ = 0, face_count_ = 0;
  bool face_colors_ = false;
  std::vector<std::int64_t> corners_;
  std::vector<float> numbers_;
};

}  // namespace

bool looks_like_off(std::span<const std::uint8_t> bytes) {
  return parse_keyword(
             TextScanner(bytes.first(std::min<std::size_t>(bytes.size(), 16)), "").word_of_text())
      .has_value();
}

Scene read_off(std::span<const std::uint8_t> bytes, const std::string& file) {
  return OffReader(bytes, file).read();
}

}  // namespace arris
