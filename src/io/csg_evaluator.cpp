#include "io/csg_evaluator.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "arris/error.h"
#include "base/utf8_text.h"
#include "image/srgb.h"
#include "io/mesh_readers.h"

namespace arris {
namespace {

constexpr std::size_t kMaxMaterials = 65536;
constexpr std::size_t kMaxProblemsShown = 8;

// Six digits leave a matrix this far from a rotation.
constexpr double kNearRotation = 4e-6;
// Turns about an axis are by whole or half degrees as a rule; six digits leave angles this open.
constexpr double kNearAngle = 1.5e-6;

// The angle that the digits mean.
double snapped(double angle) {
  const double half_degrees = std::round(degrees(angle) * 2);
  const double nice = radians(half_degrees / 2);
  return std::abs(angle - nice) <= kNearAngle ? nice : angle;
}

double exact_cos(double angle) {
  const double c = std::cos(angle);
  return std::abs(c) < 1e-15 ? 0 : c;
}

// Six digits of a rotation to the rotation: about an axis by its angle, else by Newton's iteration to the nearest.
Mat3d without_drift(const Mat3d& m) {
  const Mat3d square = transpose(m) * m;
  const Mat3d unit;
  double off = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto column = [&](const Mat3d& a) { return axis == 0 ? a.x : axis == 1 ? a.y : a.z; };
    const Vec3d d = column(square) - column(unit);
    off = std::max({off, std::abs(d.x), std::abs(d.y), std::abs(d.z)});
  }
  if (!(off <= kNearRotation) || off == 0) return m;
  const auto about = [&](double c, double s) {
    const double angle = snapped(std::atan2(s, c));
    return Vec2d{exact_cos(angle), exact_cos(angle - kPi / 2)};
  };
  if (determinant(m) > 0) {
    if (m.z == Vec3d(0, 0, 1) && m.x.z == 0) {
      const Vec2d r = about(m.x.x, m.x.y);
      return {{r.x, r.y, 0}, {-r.y, r.x, 0}, {0, 0, 1}};
    }
    if (m.x == Vec3d(1, 0, 0) && m.y.x == 0) {
      const Vec2d r = about(m.y.y, m.y.z);
      return {{1, 0, 0}, {0, r.x, r.y}, {0, -r.y, r.x}};
    }
    if (m.y == Vec3d(0, 1, 0) && m.z.y == 0) {
      const Vec2d r = about(m.z.z, m.z.x);
      return {{r.x, 0, -r.y}, {0, 1, 0}, {r.y, 0, r.x}};
    }
  }
  Mat3d r = m;
  for (int i = 0; i < 3; ++i) {
    const Mat3d t = transpose(inverse(r));
    r = {(r.x + t.x) * 0.5, (r.y + t.y) * 0.5, (r.z + t.z) * 0.5};
  }
  return r;
}

}  // namespace

ScadArguments CsgEvaluator::arguments(const ScadNode& node) const {
  static constexpr std::string_view kSize[] = {"size", "center"};
  static constexpr std::string_view kRadius[] = {"r"};
  static constexpr std::string_view kCylinder[] = {"h", "r1", "r2", "center"};
  static constexpr std::string_view kMatrix[] = {"m"};
  static constexpr std::string_view kColor[] = {"c", "alpha"};
  static constexpr std::string_view kPolygon[] = {"points", "paths"};
  static constexpr std::string_view kPolyhedron[] = {"points", "faces"};
  std::span<const std::string_view> names;
  if (node.name == "cube" || node.name == "square") names = kSize;
  if (node.name == "sphere" || node.name == "circle") names = kRadius;
  if (node.name == "cylinder") names = kCylinder;
  if (node.name == "multmatrix") names = kMatrix;
  if (node.name == "color") names = kColor;
  if (node.name == "polygon") names = kPolygon;
  if (node.name == "polyhedron") names = kPolyhedron;
  return {node, file_, names};
}

FacetSettings CsgEvaluator::facets(const ScadArguments& arguments) const {
  return {arguments.number("$fn", 0), arguments.number("$fa", 12), arguments.number("$fs", 2)};
}

bool CsgEvaluator::keeps_facets(const FacetSettings& facets) const {
  return options_.facets == LoadOptions::Facets::as_written || means_facets(facets);
}

int CsgEvaluator::facet_count(const FacetSettings& facets, double radius) {
  return int(std::min(fragments(facets, radius), double(kMaxFacets)));
}

LeafMaker CsgEvaluator::maker(const ScadNode& node, const CsgPlace& place) {
  if (!keeps_volume(place.solid.linear) || !is_finite(place.solid.translation)) {
    note(node, "is left out: its matrix flattens it or holds what isn't a number");
  }
  return {place.solid, material_of(place.color), place.color.has_value()};
}

MaterialId CsgEvaluator::material_of(const std::optional<std::array<float, 4>>& color) {
  if (!color) return MaterialId{0};
  const auto [entry, is_new] =
      materials_.try_emplace(*color, MaterialId{std::uint32_t(scene_.materials.size())});
  if (!is_new) return entry->second;
  if (scene_.materials.size() >= kMaxMaterials) {
    throw Error(Error::Kind::input, file_,
                fmt::format("has more than {} colours; use fewer", kMaxMaterials));
  }
  Material& material = scene_.materials.emplace_back(scene_.materials[0]);
  const auto byte = [&](std::size_t i) { return int(quantize8((*color)[i])); };
  material.name = fmt::format("#{:02x}{:02x}{:02x}", byte(0), byte(1), byte(2));
  if ((*color)[3] < 1) material.name += fmt::format("{:02x}", byte(3));
  material.base_color = {linear_from_srgb((*color)[0]), linear_from_srgb((*color)[1]),
                         linear_from_srgb((*color)[2])};
  material.opacity = (*color)[3];
  return entry->second;
}

// multmatrix and color change what is inside of them.
CsgPlace CsgEvaluator::within(const ScadNode& node, const CsgPlace& place) {
  CsgPlace inner = place;
  const ScadArguments reader = arguments(node);
  if (node.name == "multmatrix") {
    Affine3d m = reader.matrix();
    m.linear = without_drift(m.linear);
    inner.solid = place.solid * m;
    inner.flat = place.flat * Affine2d{{m.linear.x.x, m.linear.x.y},
                                       {m.linear.y.x, m.linear.y.y},
                                       {m.translation.x, m.translation.y}};
  }
  const ScadValue* color = node.name == "color" ? reader.find("c") : nullptr;
  if (color != nullptr && !place.color) {
    const std::vector<double> c = reader.numbers_of(*color, "the colour", 3, 4);
    std::array<float, 4> rgba{1, 1, 1, 1};
    bool is_set = true;
    for (std::size_t i = 0; i < c.size(); ++i) {
      is_set &= c[i] >= 0;
      rgba[i] = float(std::clamp(c[i], 0.0, 1.0));
    }
    if (is_set) inner.color = rgba;
  }
  return inner;
}

void CsgEvaluator::spend(const ScadNode& node, double vertices) {
  vertices_ += vertices;
  if (vertices_ <= double(kMaxCsgVertices)) return;
  throw arguments(node).error(
      fmt::format("the file's facets have more than {} vertices by now; use a smaller $fn or fewer "
                  "slices, or read it with exact facets",
                  kMaxCsgVertices));
}

void CsgEvaluator::note(const ScadNode& node, const std::string& what) {
  const auto [entry, is_new] = notes_.try_emplace(node.name + ' ' + what, Remark{node.line, "", 0});
  if (!is_new) ++entry->second.more;
}

void CsgEvaluator::report(const ScadNode& node, const std::string& what) {
  problems_.push_back({node.line, node.name + ": " + what, 0});
}

void CsgEvaluator::finish() {
  if (!problems_.empty()) {
    std::string text = problems_[0].text;
    for (std::size_t i = 1; i < std::min(problems_.size(), kMaxProblemsShown); ++i) {
      text += fmt::format("; line {}: {}", problems_[i].line, problems_[i].text);
    }
    if (problems_.size() > kMaxProblemsShown) {
      text += fmt::format("; and {} more", problems_.size() - kMaxProblemsShown);
    }
    throw Error(Error::Kind::input, fmt::format("{}:{}", file_, problems_[0].line), text);
  }
  for (const auto& [text, remark] : notes_) {
    scene_.notes.push_back(
        fmt::format("line {}: {}{}", remark.line, text,
                    remark.more > 0 ? fmt::format(" ({} more)", remark.more) : std::string()));
  }
}

std::optional<Mesh> CsgEvaluator::openscad_mesh(const ScadNode& node, const std::string& text,
                                                const std::string& why) {
  if (!files_.make_mesh) {
    report(node,
           why +
               "; only OpenSCAD can make it: install it so that the program openscad is on the "
               "PATH, or export the model as .stl or .off");
    return std::nullopt;
  }
  const auto [entry, is_new] = meshes_.try_emplace(text);
  if (!is_new && entry->second) return entry->second;
  const auto output = files_.make_mesh(text);
  if (const auto* problem = std::get_if<std::string>(&output)) {
    report(node, why + "; OpenSCAD can't make it either: " + *problem);
    return std::nullopt;
  }
  const auto& bytes = std::get<std::vector<std::uint8_t>>(output);
  Mesh mesh;
  if (!bytes.empty()) {
    try {
      Scene made = read_off(bytes, "openscad's mesh");
      mesh = std::move(made.meshes.at(0));
    } catch (const Error& error) {
      report(node, why + "; " + error.what());
      return std::nullopt;
    }
  }
  note(node, "is cut into triangles by OpenSCAD: " + why);
  entry->second = mesh;
  return mesh;
}

}  // namespace arris
