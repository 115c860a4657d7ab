// csg_evaluate_solid.cpp — the nodes that make solids
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "base/utf8_text.h"
#include "geometry/polygon.h"
#include "io/csg_evaluator.h"
#include "io/csg_extrude.h"
#include "io/csg_mesh.h"

namespace arris {
namespace {

constexpr int kMaxSlices = 10000;
constexpr double kSixDigits = 4e-6;

bool is_usable(double size) {
  return size > 0 && std::isfinite(size);
}

// The farthest that a shape reaches from the origin; what is taken away counts for nothing.
double farthest(const FlatShape& shape) {
  double most = 0;
  if (shape.leaf) {
    const auto* region = std::get_if<CsgRegion>(&*shape.leaf);
    const CsgRegion outlines =
        region != nullptr ? *region : facets_of(std::get<FlatDisc>(*shape.leaf));
    for (const Outline& outline : outlines.outlines) {
      for (const Vec2d& p : outline) most = std::max(most, std::hypot(p.x, p.y));
    }
  }
  for (std::size_t i = 0; i < shape.children.size(); ++i) {
    if (i > 0 && shape.operation == CsgOperation::subtract) break;
    const double reach = farthest(shape.children[i]);
    const bool least = i > 0 && shape.operation == CsgOperation::intersect;
    most = least ? std::min(most, reach) : std::max(most, reach);
  }
  return most;
}

double count_points(const FlatShape& shape) {
  double count = 0;
  if (shape.leaf) {
    const auto* region = std::get_if<CsgRegion>(&*shape.leaf);
    if (region == nullptr) return std::get<FlatDisc>(*shape.leaf).facets;
    for (const Outline& outline : region->outlines) count += double(outline.size());
  }
  for (const FlatShape& child : shape.children) count += count_points(child);
  return count;
}

// On which sides of x = 0 a shape has area: looked for on a grid where its bounds leave it open.
struct Sides {
  bool left = false, right = false;
};
Sides sides_of(const FlatShape& shape) {
  const Bounds2d b = bounds_of(shape);
  const double noise = kSixDigits * std::max(std::abs(b.low.x), std::abs(b.high.x));
  if (b.low.x >= -noise) return {false, true};
  if (b.high.x <= noise) return {true, false};
  constexpr int kSteps = 200;
  Sides sides;
  for (int i = 0; i < kSteps; ++i) {
    for (int k = 0; k < kSteps; ++k) {
      const double x = b.low.x + (b.high.x - b.low.x) * (i + 0.5) / kSteps;
      const double y = b.low.y + (b.high.y - b.low.y) * (k + 0.5) / kSteps;
      if (std::abs(x) <= noise || (x < 0 ? sides.left : sides.right)) continue;
      if (is_inside(shape, {x, y})) (x < 0 ? sides.left : sides.right) = true;
    }
  }
  return sides;
}

}  // namespace

CsgEvaluator::Solids CsgEvaluator::solids(const ScadNode& node, const CsgPlace& place) {
  Solids made;
  for (const ScadNode& child : node.children) {
    if (child.dimension == ScadDimension::flat) {
      note(child, "is left out: it is flat and stands among solids");
      continue;
    }
    made.push_back(solid(child, place));
  }
  return made;
}

SolidShape CsgEvaluator::solid(const ScadNode& node, const CsgPlace& place) {
  try {
    return make_solid(node, place);
  } catch (const ScadUnsupported& unsupported) {
    return by_openscad(node, maker(node, place), unsupported.why);
  }
}

SolidShape CsgEvaluator::make_solid(const ScadNode& node, const CsgPlace& place) {
  enum class Kind { unite, subtract, intersect, move, primitive, hull, minkowski, resize };
  static const std::unordered_map<std::string_view, Kind> kKinds{
      {"group", Kind::unite},         {"union", Kind::unite},
      {"root", Kind::unite},          {"render", Kind::unite},
      {"difference", Kind::subtract}, {"intersection", Kind::intersect},
      {"multmatrix", Kind::move},     {"color", Kind::move},
      {"hull", Kind::hull},           {"minkowski", Kind::minkowski},
      {"resize", Kind::resize}};
  static const std::unordered_map<std::string_view,
                                  SolidShape (CsgEvaluator::*)(const ScadNode&, const LeafMaker&)>
      kPrimitives{{"cube", &CsgEvaluator::cube},
                  {"sphere", &CsgEvaluator::sphere},
                  {"cylinder", &CsgEvaluator::cylinder},
                  {"polyhedron", &CsgEvaluator::polyhedron},
                  {"import", &CsgEvaluator::import},
                  {"linear_extrude", &CsgEvaluator::linear_extrude},
                  {"rotate_extrude", &CsgEvaluator::rotate_extrude}};
  if (const auto primitive = kPrimitives.find(node.name); primitive != kPrimitives.end()) {
    return (this->*primitive->second)(node, maker(node, place));
  }
  const auto kind = kKinds.find(node.name);
  if (kind == kKinds.end()) throw ScadUnsupported{"this node is not among those that are exact"};
  switch (kind->second) {
    case Kind::subtract: {
      Solids operands = solids(node, place);
      color_holes(operands);
      return combine(CsgOperation::subtract, std::move(operands));
    }
    case Kind::intersect:
      return combine(CsgOperation::intersect, solids(node, place));
    case Kind::hull:
      return hull(node, place);
    case Kind::minkowski:
      return minkowski(node, place);
    case Kind::resize:
      return resize(node, place);
    default:
      return combine(CsgOperation::unite, solids(node, within(node, place)));
  }
}

SolidShape CsgEvaluator::cube(const ScadNode& node, const LeafMaker& make_leaf) {
  const ScadArguments reader = arguments(node);
  const std::vector<double> size = reader.numbers("size", 3, 1);
  if (!std::all_of(size.begin(), size.end(), is_usable)) return {};
  const Vec3d extent(size[0], size[1], size[2]);
  const Vec3d low = reader.flag("center", false) ? extent * -0.5 : Vec3d(0.0);
  return make_leaf(CsgBox{low, low + extent});
}

SolidShape CsgEvaluator::sphere(const ScadNode& node, const LeafMaker& make_leaf) {
  const ScadArguments reader = arguments(node);
  const double r = reader.number("r", reader.number("d", 2) / 2);
  if (!is_usable(r)) return {};
  const FacetSettings settings = facets(reader);
  if (!keeps_facets(settings)) return make_leaf(CsgSphere{r});
  const int n = facet_count(settings, r);
  spend(node, double(n) * n / 2);
  std::optional<CsgPrimitive> hull = hull_of_points(sphere_points(r, n));
  return hull ? make_leaf(*std::move(hull)) : SolidShape{};
}

SolidShape CsgEvaluator::cylinder(const ScadNode& node, const LeafMaker& make_leaf) {
  const ScadArguments reader = arguments(node);
  const double h = reader.number("h", 1), r = reader.number("r", 1);
  const double low = reader.number("r1", r), high = reader.number("r2", r);
  if (!is_usable(h) || !(low >= 0) || !(high >= 0) || !is_usable(std::max(low, high)) ||
      !std::isfinite(low) || !std::isfinite(high)) {
    return {};
  }
  const double z = reader.flag("center", false) ? -h / 2 : 0;
  const CsgCone cone{z, z + h, low, high};
  const FacetSettings settings = facets(reader);
  if (!keeps_facets(settings)) return make_leaf(cone);
  const int n = facet_count(settings, std::max(low, high));
  spend(node, 2.0 * n);
  std::optional<CsgPrimitive> hull = hull_of_points(cone_points(cone, n));
  return hull ? make_leaf(*std::move(hull)) : SolidShape{};
}

SolidShape CsgEvaluator::polyhedron(const ScadNode& node, const LeafMaker& make_leaf) {
  const ScadArguments reader = arguments(node);
  const ScadValue* points_value = reader.find("points");
  const ScadValue* faces_value = reader.find("faces");
  if (faces_value == nullptr) faces_value = reader.find("triangles");
  if (points_value == nullptr || faces_value == nullptr)
    throw reader.error("points or faces are missing");
  std::vector<Vec3d> points;
  Vec3d middle;
  for (const ScadValue& value : reader.list_of(*points_value, "points")) {
    const std::vector<double> p = reader.numbers_of(value, "a point", 3, 3);
    points.emplace_back(p[0], p[1], p[2]);
    if (!is_finite(points.back())) {
      throw reader.error(fmt::format("point {} isn't finite", points.size() - 1));
    }
  }
  if (points.empty()) return {};
  for (const Vec3d& p : points) middle += p / double(points.size());
  std::vector<Triangle> triangles;
  PolygonTriangulator triangulator;
  std::size_t number = 0;
  for (const ScadValue& value : reader.list_of(*faces_value, "faces")) {
    std::vector<std::uint32_t> face;
    std::vector<Vec3f> corners;
    for (const double index :
         reader.numbers_of(value, "a face", 0, points.size() + kMaxScadBytes)) {
      if (!(index >= 0) || !(index < double(points.size()))) {
        throw reader.error(
            fmt::format("face {} names point {:g}; there are {}", number, index, points.size()));
      }
      face.push_back(std::uint32_t(index));
    }
    ++number;
    if (face.size() < 3) continue;
    std::ranges::reverse(face);  // clockwise seen from outside
    for (const std::uint32_t i : face) corners.emplace_back(points[i] - middle);
    const std::span<const Triangle> cut = triangulator.triangulate(corners);
    if (cut.empty()) throw reader.error(fmt::format("face {} has too many corners", number - 1));
    for (const Triangle& t : cut) triangles.push_back({face[t[0]], face[t[1]], face[t[2]]});
  }
  if (triangles.empty()) return {};
  std::variant<ClosedSolid, std::string> closed = close_solid(points, triangles);
  if (const auto* problem = std::get_if<std::string>(&closed)) {
    report(node, *problem);
    return {};
  }
  auto& made = std::get<ClosedSolid>(closed);
  if (made.turned) note(node, "has faces that run the wrong way round; they are turned");
  return make_leaf(std::move(made.primitive));
}

SolidShape CsgEvaluator::import(const ScadNode& node, const LeafMaker& make_leaf) {
  const std::filesystem::path path =
      std::filesystem::path(files_.folder) / arguments(node).text("file");
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](char c) { return c >= 'A' && c <= 'Z' ? char(c + ('a' - 'A')) : c; });
  if (!files_.load_model || (extension != ".stl" && extension != ".off" && extension != ".obj")) {
    throw ScadUnsupported{"files of this kind are not read"};
  }
  Scene model;
  try {
    model = files_.load_model(path);
  } catch (const Error& error) {
    report(node, error.what());
    return {};
  }
  std::vector<Vec3d> points;
  std::vector<Triangle> triangles;
  for (const Mesh& mesh : model.meshes) {
    const auto first = std::uint32_t(points.size());
    for (const Vec3f& p : mesh.positions) points.emplace_back(p);
    for (const Triangle& t : mesh.triangles)
      triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  std::variant<ClosedSolid, std::string> closed = close_solid(points, triangles);
  if (const auto* problem = std::get_if<std::string>(&closed)) {
    report(node, in_quotes(path.string()) + " can't be a solid: " + *problem);
    return {};
  }
  return make_leaf(std::move(std::get<ClosedSolid>(closed).primitive));
}

SolidShape CsgEvaluator::linear_extrude(const ScadNode& node, const LeafMaker& make_leaf) {
  const ScadArguments reader = arguments(node);
  if (!reader.text("file").empty()) throw ScadUnsupported{"files are not read here"};
  double height = reader.number("height", reader.number("h", 100));
  if (const ScadValue* v = reader.find("v")) {
    const std::vector<double> along = reader.numbers_of(*v, "v", 3, 3);
    if (along[0] != 0 || along[1] != 0) throw ScadUnsupported{"it goes aslant"};
    if (reader.find("height") == nullptr) height = along[2];
  }
  const std::vector<double> scale = reader.numbers("scale", 2, 1);
  LinearExtrusion extrusion;
  extrusion.scale = {std::max(scale[0], 0.0), std::max(scale[1], 0.0)};
  extrusion.twist = radians(reader.number("twist", 0));
  if (!is_usable(height) || !std::isfinite(scale[0]) || !std::isfinite(scale[1]) ||
      !std::isfinite(extrusion.twist)) {
    return {};
  }
  extrusion.z_low = reader.flag("center", false) ? -height / 2 : 0;
  extrusion.z_high = extrusion.z_low + height;
  const FlatShape shape = flat_union(node);
  if (extrusion.twist != 0) {
    const double own =
        twist_slices(facets(reader), farthest(shape), height, degrees(extrusion.twist));
    extrusion.slices = int(std::clamp(reader.number("slices", own), 1.0, double(kMaxSlices)));
    spend(node, count_points(shape) * (extrusion.slices + 3));
  }
  return extrude(shape, extrusion, make_leaf);
}

SolidShape CsgEvaluator::rotate_extrude(const ScadNode& node, const LeafMaker& make_leaf) {
  const ScadArguments reader = arguments(node);
  if (!reader.text("file").empty()) throw ScadUnsupported{"files are not read here"};
  double angle = reader.number("angle", 360);
  if (!(std::abs(angle) <= 360)) angle = 360;
  FlatShape shape = flat_union(node);
  if (angle == 0 || shape.is_empty()) return {};
  const Sides sides = sides_of(shape);
  if (sides.left && sides.right) {
    report(node, "its outline lies on both sides of the y axis; OpenSCAD turns it only on one");
    return {};
  }
  const bool is_full = std::abs(angle) == 360;
  RotaryExtrusion extrusion{radians(reader.number("start", is_full ? 180 : 0)), radians(angle), 0};
  if (!std::isfinite(extrusion.start)) return {};
  if (sides.left) {
    transform(shape, {{-1, 0}, {0, 1}, {0, 0}});
    if (!is_full) extrusion.start += kPi;
  }
  const FacetSettings settings = facets(reader);
  if (keeps_facets(settings)) {
    const double full = facet_count(settings, bounds_of(shape).high.x);
    extrusion.steps = int(std::max(std::floor(full * std::abs(angle) / 360), 1.0));
    if (is_full) extrusion.steps = std::max(extrusion.steps, 3);
    spend(node, count_points(shape) * (extrusion.steps + 3));
  }
  return revolve(shape, extrusion, make_leaf);
}

SolidShape CsgEvaluator::resize(const ScadNode& node, const CsgPlace& place) {
  CsgPlace inner = place;
  inner.solid = {};
  SolidShape shape = combine(CsgOperation::unite, solids(node, inner));
  if (shape.is_empty() || !keeps_volume(maker(node, place).place.linear)) return {};
  if (!has_exact_bounds(shape)) throw ScadUnsupported{"the size of its content isn't known"};
  const Bounds3d bounds = bounds_of(shape);
  const ScadArguments reader = arguments(node);
  const std::vector<double> wanted = reader.numbers("newsize", 3, 0);
  std::vector<double> automatic(3, 0);
  if (const ScadValue* value = reader.find("auto")) {
    if (const auto* all = std::get_if<bool>(&value->data)) {
      automatic.assign(3, *all ? 1 : 0);
    } else {
      const ScadList& list = reader.list_of(*value, "auto");
      for (std::size_t i = 0; i < std::min<std::size_t>(list.size(), 3); ++i) {
        const auto* flag = std::get_if<bool>(&list[i].data);
        const auto* number = std::get_if<double>(&list[i].data);
        automatic[i] = (flag != nullptr && *flag) || (number != nullptr && *number != 0) ? 1 : 0;
      }
    }
  }
  const auto largest = int(std::ranges::max_element(wanted) - wanted.begin());
  const auto size = [&](int axis) { return bounds.high[axis] - bounds.low[axis]; };
  Vec3d scale(1.0);
  for (int axis = 0; axis < 3; ++axis) {
    const auto at = std::size_t(axis);
    if (wanted[at] > 0) {
      scale[axis] = wanted[at] / size(axis);
    } else if (automatic[at] != 0 && wanted[std::size_t(largest)] > 0) {
      scale[axis] = wanted[std::size_t(largest)] / size(largest);
    }
  }
  transform(shape, place.solid * Affine3d{{{scale.x, 0, 0}, {0, scale.y, 0}, {0, 0, scale.z}}, {}});
  return shape;
}

SolidShape CsgEvaluator::by_openscad(const ScadNode& node, const LeafMaker& make_leaf,
                                     const std::string& why) {
  const std::optional<Mesh> mesh = openscad_mesh(node, csg_text(node, files_.folder), why);
  if (!mesh || mesh->triangles.empty()) return {};
  std::vector<Vec3d> points;
  for (const Vec3f& p : mesh->positions) points.emplace_back(p);
  std::variant<ClosedSolid, std::string> closed = close_solid(points, mesh->triangles);
  if (const auto* problem = std::get_if<std::string>(&closed)) {
    report(node, why + "; OpenSCAD's mesh is no solid: " + *problem);
    return {};
  }
  return make_leaf(std::move(std::get<ClosedSolid>(closed).primitive));
}

}  // namespace arris
