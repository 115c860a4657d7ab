// ply.cpp — the Stanford polygon format: elements "vertex" and "face" of any properties, and "edge" with radii; others
//           are skipped
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "io/edge_radii.h"
#include "io/mesh_readers.h"
#include "io/mesh_scene.h"
#include "io/ply_header.h"
#include "io/ply_rows.h"
#include "io/polygon_mesh.h"

namespace arris {
namespace {

constexpr int kMissing = -1;

int find_property(const PlyElement& element, std::string_view name) {
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    const PlyProperty& property = element.properties[i];
    if (property.name == name && !property.count_type) return int(i);
  }
  return kMissing;
}

// The first of the names' pairs or triples of which all are there; else empty.
std::vector<int> find_properties(const PlyElement& element,
                                 const std::vector<std::vector<std::string_view>>& alternatives) {
  for (const std::vector<std::string_view>& names : alternatives) {
    std::vector<int> found;
    for (const std::string_view name : names) found.push_back(find_property(element, name));
    if (std::find(found.begin(), found.end(), kMissing) == found.end()) return found;
  }
  return {};
}

bool is_corner_list(const PlyProperty& property) {
  return property.count_type &&
         (property.name == "vertex_indices" || property.name == "vertex_index");
}

const PlyElement* find_element(const PlyHeader& header, std::string_view name) {
  for (const PlyElement& element : header.elements) {
    if (element.name == name) return &element;
  }
  return nullptr;
}

// Which properties of a vertex are read, by their number.
struct VertexLayout {
  std::vector<int> position, normal, uv;
  std::vector<int> radius;  // of the edges between vertices
};

// Of an edge with a radius: numbers of vertex1, vertex2 and radius; else empty.
std::vector<int> find_edge_properties(const PlyElement& element) {
  return find_properties(element, {{"vertex1", "vertex2", "radius"}});
}

std::string problem_with_edges(const PlyElement& edge, const PlyElement& vertex) {
  const std::vector<int> found = find_edge_properties(edge);
  if (found.empty()) return "";  // they are skipped
  if (&edge < &vertex)
    return "the element \"edge\" comes before \"vertex\"; export it the other way round";
  for (const int property : {found[0], found[1]}) {
    if (!is_integer(edge.properties[std::size_t(property)].type))
      return "the vertices of an edge have a type that is no integer";
  }
  return "";
}

// What can be said against the file before its data is read; empty if nothing.
std::string problem_with_header(const PlyHeader& header) {
  const PlyElement* const vertex = find_element(header, "vertex");
  const PlyElement* const face = find_element(header, "face");
  if (vertex == nullptr || find_properties(*vertex, {{"x", "y", "z"}}).empty()) {
    return "the header has no element \"vertex\" with the properties x, y and z";
  }
  if (face == nullptr || face->count == 0) {
    return find_element(header, "tristrips") != nullptr
               ? "triangle strips are not read; export plain faces"
               : "has no faces: it is a cloud of points; surfaces are needed";
  }
  if (face < vertex)
    return "the element \"face\" comes before \"vertex\"; export it the other way round";
  const auto corners =
      std::find_if(face->properties.begin(), face->properties.end(), is_corner_list);
  if (corners == face->properties.end()) {
    return "the element \"face\" has no list vertex_indices or vertex_index";
  }
  if (!is_integer(corners->type))
    return "the list of a face's vertices has a type that is no integer";
  if (vertex->count > kMaxCorners) {
    return "the header says " + std::to_string(vertex->count) + " vertices; at most " +
           std::to_string(kMaxCorners) + " are read: split the model";
  }
  const PlyElement* const edge = find_element(header, "edge");
  return edge == nullptr ? "" : problem_with_edges(*edge, *vertex);
}

template <class Rows>
class PlyBody {
 public:
  PlyBody(PlyHeader header, Rows rows, const std::string& file)
      : header_(std::move(header)),
        rows_(std::move(rows)),
        file_(file),
        scene_(make_mesh_scene(file)) {
    polygons_.mesh.name = name_from_file(file);
  }

  Scene read() {
    for (const PlyElement& element : header_.elements) {
      if (element.properties.empty()) continue;  // rows of no bytes
      check_count(element);
      if (element.name == "vertex") {
        read_vertices(element);
      } else if (element.name == "face") {
        read_faces(element);
      } else if (element.name == "edge" && !find_edge_properties(element).empty()) {
        read_edges(element);
      } else {
        skip_rows(element);
      }
    }
    rows_.end_file();
    polygons_.mesh.edge_radii = edge_radii_.take();
    normalize_normals(polygons_.mesh, scene_);
    add_object(scene_, std::move(polygons_.mesh));
    return std::move(scene_);
  }

 private:
  // Before memory is taken for them.
  void check_count(const PlyElement& element) {
    std::size_t bytes = 0;
    for (const PlyProperty& property : element.properties) {
      bytes += Rows::min_bytes(property.count_type.value_or(property.type));
      if (element.name == "face" && is_corner_list(property)) {
        bytes += 3 * Rows::min_bytes(property.type);
      }
    }
    if (element.count <= rows_.bytes_left() / bytes) return;
    throw Error(Error::Kind::input, file_,
                "the header says " + std::to_string(element.count) + " times \"" + element.name +
                    "\" of at least " + std::to_string(bytes) + " bytes, but only " +
                    std::to_string(rows_.bytes_left()) +
                    " bytes are left: it is cut off or damaged");
  }

  void skip_property(const PlyProperty& property) {
    std::uint64_t count = 1;
    if (property.count_type) count = list_length(*property.count_type);
    rows_.skip(property.type, count);
  }

  std::uint64_t list_length(PlyType type) {
    const double length = rows_.length(type);
    if (length >= 0 && length <= double(rows_.bytes_left())) return std::uint64_t(length);
    throw rows_.error("a list says " + std::to_string(std::int64_t(length)) + " items, but only " +
                      std::to_string(rows_.bytes_left()) +
                      " bytes are left: it is cut off or damaged");
  }

  void skip_rows(const PlyElement& element) {
    for (std::uint64_t row = 0; row < element.count; ++row) {
      rows_.begin_row({element.name, row});
      for (const PlyProperty& property : element.properties) skip_property(property);
      rows_.end_row();
    }
  }

  float to_float(double value, const std::string& name) const {
    if (std::abs(value) <= double(std::numeric_limits<float>::max())) return float(value);
    throw rows_.error(fmt::format("{} is {:g}", name, value) +
                      ", beyond the largest number that is read (3.4e38); scale the model down");
  }

  float read_radius(const PlyProperty& property) {
    const double radius = rows_.value_or_nan(property.type, property.name);
    return std::isnan(radius) ? EdgeRadii::kNone : to_float(radius, property.name);
  }

  Vec3f vector_of(const std::vector<int>& properties) const {
    return {values_[std::size_t(properties[0])], values_[std::size_t(properties[1])],
            values_[std::size_t(properties[2])]};
  }

  // For each property whether it is read.
  std::vector<bool> read_properties(const PlyElement& element, const VertexLayout& layout) const {
    std::vector<bool> read(element.properties.size());
    for (const auto& group : {layout.position, layout.normal, layout.uv, layout.radius}) {
      for (const int property : group) read[std::size_t(property)] = true;
    }
    return read;
  }

  void note_colors(const PlyElement& element) {
    if (find_property(element, "red") == kMissing) return;
    scene_.notes.emplace_back("vertex colours are not read from PLY files");
  }

  void read_vertices(const PlyElement& element) {
    const VertexLayout layout{
        find_properties(element, {{"x", "y", "z"}}), find_properties(element, {{"nx", "ny", "nz"}}),
        find_properties(element, {{"s", "t"}, {"u", "v"}, {"texture_u", "texture_v"}}),
        find_properties(element, {{"arris_radius"}})};
    const std::vector<bool> read = read_properties(element, layout);
    note_colors(element);
    values_.assign(element.properties.size(), 0.0F);
    Mesh& mesh = polygons_.mesh;
    mesh.positions.reserve(std::size_t(element.count));
    for (std::uint64_t row = 0; row < element.count; ++row) {
      rows_.begin_row({element.name, row});
      for (std::size_t i = 0; i < read.size(); ++i) {
        const PlyProperty& property = element.properties[i];
        if (!layout.radius.empty() && int(i) == layout.radius[0]) {
          vertex_radii_.push_back(read_radius(property));
        } else if (read[i]) {
          values_[i] = to_float(rows_.value(property.type, property.name), property.name);
        } else {
          skip_property(property);
        }
      }
      rows_.end_row();
      mesh.positions.push_back(vector_of(layout.position));
      if (!layout.normal.empty()) mesh.normals.push_back(vector_of(layout.normal));
      if (layout.uv.empty()) continue;
      mesh.uvs.push_back(
          {values_[std::size_t(layout.uv[0])], 1 - values_[std::size_t(layout.uv[1])]});
    }
  }

  void read_faces(const PlyElement& element) {
    polygons_.mesh.triangles.reserve(std::size_t(element.count));
    for (std::uint64_t row = 0; row < element.count; ++row) {
      rows_.begin_row({element.name, row});
      bool has_corners = false;
      for (const PlyProperty& property : element.properties) {
        if (!is_corner_list(property) || has_corners) {
          skip_property(property);
          continue;
        }
        read_corners(property);
        has_corners = true;
      }
      rows_.end_row();
      if (const std::string problem = polygons_.add(corners_); !problem.empty()) {
        throw rows_.error(problem);
      }
      if (!vertex_radii_.empty()) add_sides();
    }
  }

  // Of the last polygon: what cuts it into triangles is no edge.
  void add_sides() {
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      const std::int64_t next = corners_[(i + 1) % corners_.size()];
      edge_radii_.add_side(std::uint32_t(corners_[i]), std::uint32_t(next), vertex_radii_);
    }
  }

  void read_edges(const PlyElement& element) {
    const std::vector<int> found = find_edge_properties(element);
    for (std::uint64_t row = 0; row < element.count; ++row) {
      rows_.begin_row({element.name, row});
      VertexPair ends{};
      float radius = EdgeRadii::kNone;
      for (std::size_t i = 0; i < element.properties.size(); ++i) {
        const PlyProperty& property = element.properties[i];
        if (int(i) == found[0]) {
          ends[0] = read_vertex_number(property);
        } else if (int(i) == found[1]) {
          ends[1] = read_vertex_number(property);
        } else if (int(i) == found[2]) {
          radius = read_radius(property);
        } else {
          skip_property(property);
        }
      }
      rows_.end_row();
      if (ends[0] == ends[1]) {
        throw rows_.error("both ends of the edge are vertex " + std::to_string(ends[0]));
      }
      edge_radii_.add_edge(ends[0], ends[1], radius);
    }
  }

  std::uint32_t read_vertex_number(const PlyProperty& property) {
    const auto number = std::int64_t(rows_.value(property.type, property.name));
    const std::size_t count = polygons_.mesh.positions.size();
    if (const std::string problem = problem_with_vertex(number, count); !problem.empty()) {
      throw rows_.error(problem);
    }
    return std::uint32_t(number);
  }

  void read_corners(const PlyProperty& property) {
    const std::uint64_t length = list_length(*property.count_type);
    corners_.clear();
    for (std::uint64_t i = 0; i < length; ++i) {
      corners_.push_back(std::int64_t(rows_.value(property.type, "a vertex's number")));
    }
  }

  PlyHeader header_;
  Rows rows_;
  std::string file_;
  Scene scene_;
  PolygonMesh polygons_;
  EdgeRadii edge_radii_;
  std::vector<float> vertex_radii_;  // one per vertex, or empty
  std::vector<float> values_;        // of one vertex's properties
  std::vector<std::int64_t> corners_;
};

}  // namespace

bool looks_like_ply(std::span<const std::uint8_t> bytes) {
  const std::string_view magic = "ply";
  return bytes.size() > magic.size() && std::equal(magic.begin(), magic.end(), bytes.begin()) &&
         (bytes[magic.size()] == '\n' || bytes[magic.size()] == '\r');
}

Scene read_ply(std::span<const std::uint8_t> bytes, const std::string& file) {
  TextScanner text(bytes, file);
  PlyHeader header = read_ply_header(text);
  if (const std::string problem = problem_with_header(header); !problem.empty()) {
    throw Error(Error::Kind::input, file, problem);
  }
  const PlyEncoding encoding = header.encoding;
  if (encoding == PlyEncoding::ascii) {
    text.skip_line();
    return PlyBody(std::move(header), AsciiRows(text), file).read();
  }
  if (encoding == PlyEncoding::little_endian) {
    return PlyBody(std::move(header), BinaryRows<std::endian::little>(bytes, text.offset(), file),
                   file)
        .read();
  }
  return PlyBody(std::move(header), BinaryRows<std::endian::big>(bytes, text.offset(), file), file)
      .read();
}

}  // namespace arris
