// stl.cpp — stereolithography files, ASCII and binary
// Legend     binary: 80 bytes of header, facet count n (32 bits), n facets of 50 bytes: normal and three
//            corners (12 floats), 2 bytes of attributes; all little-endian
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <utility>

#include "arris/error.h"
#include "base/utf8_text.h"
#include "io/key_index.h"
#include "io/mesh_readers.h"
#include "io/mesh_scene.h"
#include "io/text_scanner.h"

namespace arris {
namespace {

constexpr std::size_t kHeaderBytes = 84;
constexpr std::size_t kFacetBytes = 50;
constexpr std::size_t kNormalBytes = 12;
// Facets whose corners are sought in the cache ahead of their turn.
constexpr std::size_t kPrefetchFacets = 8;
// How much of a file is looked at to tell text from binary data.
constexpr std::size_t kSniffedBytes = 1024;

using PositionIndex = KeyIndex<Vec3f>;
// Added, it makes -0 the 0 that it equals.
constexpr Vec3f kPositiveZero(0.0F);

static_assert(std::endian::native == std::endian::little, "floats are copied as they are");

std::size_t facet_count(std::span<const std::uint8_t> bytes) {
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + kHeaderBytes - sizeof count, sizeof count);
  return count;
}

bool has_binary_size(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= kHeaderBytes &&
         bytes.size() == kHeaderBytes + kFacetBytes * facet_count(bytes);
}

// Starts with the word "solid" and has no control characters. Headers of binary files may start with it,
// too, but then the facet count follows, whose last byte is 0 in any file of less than 800 MB.
bool is_ascii(std::span<const std::uint8_t> bytes) {
  const auto first = bytes.first(std::min(bytes.size(), kSniffedBytes));
  const auto is_control = [](std::uint8_t c) { return c < 0x20 && (c < '\t' || c > '\r'); };
  if (std::any_of(first.begin(), first.end(), is_control)) return false;
  return equal_ignoring_case(TextScanner(first, "").word_of_text(), "solid");
}

// ---- binary ----

std::array<Vec3f, 3> facet_corners(const std::uint8_t* facet) {
  std::array<Vec3f, 3> corners;
  static_assert(sizeof corners == 36);
  std::memcpy(corners.data(), facet + kNormalBytes, sizeof corners);
  return corners;
}

// Up to one facet's worth of padding, or any number of zeros, may follow the facets.
bool is_padding(std::span<const std::uint8_t> tail) {
  return tail.size() < kFacetBytes ||
         std::all_of(tail.begin(), tail.end(), [](std::uint8_t c) { return c == 0; });
}

void check_size(std::span<const std::uint8_t> bytes, const std::string& file) {
  const auto fail = [&](const std::string& what) { throw Error(Error::Kind::input, file, what); };
  if (bytes.empty()) fail("is empty; a model is needed");
  if (bytes.size() < kHeaderBytes) {
    fail("is no STL file: it does not start with \"solid\" as an ASCII file, and its " +
         std::to_string(bytes.size()) + " bytes are fewer than the 84 of a binary file's header");
  }
  const std::size_t count = facet_count(bytes);
  const std::size_t held = (bytes.size() - kHeaderBytes) / kFacetBytes;
  const std::string claim = "the header says " + std::to_string(count) + " facets";
  if (count > held) {
    fail(claim + " (" + std::to_string(kHeaderBytes + kFacetBytes * count) +
         " bytes), but the file ends after facet " + std::to_string(held) + " (" +
         std::to_string(bytes.size()) + " bytes): it is cut off or no STL file; export it again");
  }
  if (!is_padding(bytes.subspan(kHeaderBytes + kFacetBytes * count))) {
    fail(claim + ", but the file has bytes for " + std::to_string(held) +
         ": the count is wrong; export it again");
  }
  if (count == 0) fail("has no facets; export it again with a solid in it");
  if (3 * count > kMaxCorners) {
    fail(claim + "; at most " + std::to_string(kMaxCorners / 3) + " are read: split the model");
  }
}

[[noreturn]] void fail_not_finite(const std::string& file, std::size_t facet) {
  throw Error(Error::Kind::input, file,
              "facet " + std::to_string(facet + 1) + " (byte " +
                  std::to_string(kHeaderBytes + kFacetBytes * facet) +
                  "): a corner's coordinate is not a finite number; export the model again");
}

Scene read_binary(std::span<const std::uint8_t> bytes, const std::string& file) {
  check_size(bytes, file);
  const std::size_t count = facet_count(bytes);
  const std::uint8_t* const facets = bytes.data() + kHeaderBytes;
  Mesh mesh;
  mesh.name = name_from_file(file);
  mesh.triangles.resize(count);
  PositionIndex index(count / 2);  // a closed mesh has half as many vertices as triangles
  for (std::size_t facet = 0; facet < count; ++facet) {
    if (facet + kPrefetchFacets < count) {
      for (const Vec3f& corner : facet_corners(facets + kFacetBytes * (facet + kPrefetchFacets))) {
        index.prefetch(corner + kPositiveZero);
      }
    }
    const std::array<Vec3f, 3> corners = facet_corners(facets + kFacetBytes * facet);
    for (std::size_t k = 0; k < 3; ++k) {
      if (!is_finite(corners[k])) fail_not_finite(file, facet);
      mesh.triangles[facet][k] = index.add(corners[k] + kPositiveZero);
    }
  }
  mesh.positions = index.take_keys();
  Scene scene = make_mesh_scene(file);
  add_object(scene, std::move(mesh));
  return scene;
}

// ---- ASCII ----

class AsciiReader {
 public:
  AsciiReader(std::span<const std::uint8_t> bytes, const std::string& file)
      : text_(bytes, file), scene_(make_mesh_scene(file)), default_name_(name_from_file(file)) {}

  Scene read() {
    while (true) {
      const std::string_view word = text_.word_of_text();
      if (word.empty()) break;
      if (!equal_ignoring_case(word, "solid")) {
        throw text_.error("found " + in_quotes(word) +
                          " where \"solid\" should start the next solid");
      }
      read_solid();
    }
    if (scene_.objects.empty()) {
      throw text_.error("no solid has a facet; export the model again with a solid in it");
    }
    return std::move(scene_);
  }

 private:
  void read_solid() {
    Mesh mesh;
    mesh.name = text_.rest_of_line();
    text_.skip_line();
    if (const std::string problem = problem_with_name(mesh.name); !problem.empty()) {
      throw text_.error(problem);
    }
    if (mesh.name.empty()) mesh.name = default_name_;
    PositionIndex index;
    while (true) {
      const std::string_view word = text_.word_of_text();
      if (equal_ignoring_case(word, "endsolid")) break;
      check(word, "facet", "\"facet\" or \"endsolid\"");
      mesh.triangles.push_back(read_facet(index));
    }
    text_.skip_line();  // the name once more
    if (mesh.triangles.empty()) return;
    if (scene_.objects.size() == kMaxObjects) {
      throw text_.error("more than " + std::to_string(kMaxObjects) + " solids; join or split them");
    }
    mesh.positions = index.take_keys();
    add_object(scene_, std::move(mesh));
  }

  Triangle read_facet(PositionIndex& index) {
    expect("normal");
    // The normal is not needed; degenerate facets often have NaN here.
    for (int i = 0; i < 3; ++i) text_.word_of_text();
    expect("outer");
    expect("loop");
    Triangle triangle;
    for (std::uint32_t& vertex : triangle) {
      expect("vertex");
      Vec3f position;
      position.x = coordinate("a vertex's x");
      position.y = coordinate("a vertex's y");
      position.z = coordinate("a vertex's z");
      vertex = index.add(position + kPositiveZero);
      if (vertex == kMaxCorners) throw text_.error("the solid has too many vertices; split it");
    }
    expect("endloop");
    expect("endfacet");
    return triangle;
  }

  float coordinate(std::string_view what) {
    const std::string_view word = text_.word_of_text();
    if (word.empty()) fail_end(what);
    return text_.to_number(word, what);
  }

  void expect(std::string_view keyword) {
    check(text_.word_of_text(), keyword, in_quotes(keyword));
  }

  void check(std::string_view word, std::string_view keyword, const std::string& expected) {
    if (word == keyword || equal_ignoring_case(word, keyword)) return;
    if (word.empty()) fail_end(expected);
    throw text_.error("found " + in_quotes(word) + " where " + expected + " should be");
  }

  [[noreturn]] void fail_end(std::string_view expected) {
    throw text_.error("the file ends where " + std::string(expected) +
                      " should be: it is cut off; export it again");
  }

  TextScanner text_;
  Scene scene_;
  std::string default_name_;
};

}  // namespace

bool looks_like_stl(std::span<const std::uint8_t> bytes) {
  return has_binary_size(bytes) || is_ascii(bytes);
}

Scene read_stl(std::span<const std::uint8_t> bytes, const std::string& file) {
  if (!has_binary_size(bytes) && is_ascii(bytes)) return AsciiReader(bytes, file).read();
  return read_binary(bytes, file);
}

}  // namespace arris
