// csg_evaluate_flat.cpp — the nodes that make plane shapes
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "io/csg_evaluator.h"

namespace arris {
namespace {

bool is_usable(double size) {
  return size > 0 && std::isfinite(size);
}

bool flattens(const Affine2d& m) {
  const double scale = std::hypot(m.x.x, m.x.y) + std::hypot(m.y.x, m.y.y);
  return !std::isfinite(scale) || !std::isfinite(m.t.x) || !std::isfinite(m.t.y) ||
         !(std::abs(cross(m.x, m.y)) > 1e-12 * scale * scale);
}

// The outlines of a mesh's faces at z = 0, which look down.
std::vector<Outline> bottom_outlines(const Mesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const Triangle& t : mesh.triangles) {
    if (std::any_of(t.begin(), t.end(),
                    [&](std::uint32_t v) { return mesh.positions[v].z > 0.5F; })) {
      continue;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      edges[std::minmax(a, b)] += a < b ? 1 : -1;
    }
  }
  std::map<std::uint32_t, std::vector<std::uint32_t>> leaving;
  for (const auto& [ends, balance] : edges) {
    if (balance > 0) leaving[ends.second].push_back(ends.first);
    if (balance < 0) leaving[ends.first].push_back(ends.second);
  }
  std::vector<Outline> outlines;
  for (auto& [start, next] : leaving) {
    while (!next.empty()) {
      Outline& outline = outlines.emplace_back();
      for (std::uint32_t at = start; !leaving[at].empty();) {
        outline.push_back({mesh.positions[at].x, mesh.positions[at].y});
        const std::uint32_t to = leaving[at].back();
        leaving[at].pop_back();
        at = to;
      }
    }
  }
  return outlines;
}

}  // namespace

CsgEvaluator::Flats CsgEvaluator::flats(const ScadNode& node, const Affine2d& m) {
  Flats made;
  for (const ScadNode& child : node.children) {
    if (child.dimension == ScadDimension::solid) {
      note(child, "is left out: it is a solid and stands among flat shapes");
      continue;
    }
    made.push_back(flat(child, m));
  }
  return made;
}

FlatShape CsgEvaluator::flat_union(const ScadNode& node) {
  return combine(CsgOperation::unite, flats(node, {}));
}

FlatShape CsgEvaluator::flat(const ScadNode& node, const Affine2d& m) {
  try {
    return make_flat_shape(node, m);
  } catch (const ScadUnsupported& unsupported) {
    return flat_by_openscad(node, m, unsupported.why);
  }
}

FlatShape CsgEvaluator::make_flat_shape(const ScadNode& node, const Affine2d& m) {
  const std::string& name = node.name;
  if (name == "circle") return circle(node, m);
  if (name == "square" || name == "polygon") return polygon(node, m);
  if (name == "hull") return flat_hull(node, m);
  if (name == "minkowski") return flat_minkowski(node, m);
  if (name == "offset") return offset(node, m);
  if (name == "resize") return flat_resize(node, m);
  if (name == "difference") return combine(CsgOperation::subtract, flats(node, m));
  if (name == "intersection") return combine(CsgOperation::intersect, flats(node, m));
  if (name == "multmatrix" || name == "color") {
    CsgPlace place;
    place.flat = m;
    return combine(CsgOperation::unite, flats(node, within(node, place).flat));
  }
  if (name == "group" || name == "union" || name == "render") {
    return combine(CsgOperation::unite, flats(node, m));
  }
  throw ScadUnsupported{"this node is not among those that are exact"};
}

FlatShape CsgEvaluator::circle(const ScadNode& node, const Affine2d& m) {
  const ScadArguments reader = arguments(node);
  const double r = reader.number("r", reader.number("d", 2) / 2);
  if (!is_usable(r)) return {};
  if (flattens(m)) {
    note(node, "is left out: its matrix flattens it or holds what isn't a number");
    return {};
  }
  const FacetSettings settings = facets(reader);
  const FlatDisc disc{m.t, m.vector({r, 0}), m.vector({0, r}), facet_count(settings, r)};
  if (!keeps_facets(settings)) return make_flat(disc);
  spend(node, disc.facets);
  return make_flat(facets_of(disc));
}

FlatShape CsgEvaluator::polygon(const ScadNode& node, const Affine2d& m) {
  const ScadArguments reader = arguments(node);
  std::vector<Outline> outlines;
  if (node.name == "square") {
    const std::vector<double> size = reader.numbers("size", 2, 1);
    if (!is_usable(size[0]) || !is_usable(size[1])) return {};
    const bool center = reader.flag("center", false);
    const Vec2d low = center ? Vec2d{-size[0] / 2, -size[1] / 2} : Vec2d{0, 0};
    const Vec2d high = low + Vec2d{size[0], size[1]};
    outlines = {{low, {high.x, low.y}, high, {low.x, high.y}}};
  } else {
    Outline points;
    const ScadValue* value = reader.find("points");
    if (value == nullptr) return {};
    for (const ScadValue& point : reader.list_of(*value, "points")) {
      const std::vector<double> p = reader.numbers_of(point, "a point", 2, 3);
      points.push_back({p[0], p[1]});
    }
    const ScadValue* paths = reader.find("paths");
    if (paths == nullptr) {
      outlines.push_back(points);
    } else {
      for (const ScadValue& path : reader.list_of(*paths, "paths")) {
        Outline& outline = outlines.emplace_back();
        for (const double index : reader.numbers_of(path, "a path", 0, kMaxScadBytes)) {
          if (!(index >= 0) || !(index < double(points.size()))) {
            throw reader.error(
                fmt::format("a path names point {:g}; there are {}", index, points.size()));
          }
          outline.push_back(points[std::size_t(index)]);
        }
      }
      // An empty list of paths is none.
      if (outlines.empty()) outlines.push_back(points);
    }
  }
  if (flattens(m)) {
    note(node, "is left out: its matrix flattens it or holds what isn't a number");
    return {};
  }
  for (Outline& outline : outlines) {
    for (Vec2d& p : outline) {
      p = m.point(p);
      if (!std::isfinite(p.x) || !std::isfinite(p.y)) throw reader.error("a point isn't finite");
    }
  }
  std::optional<CsgRegion> region = make_even_odd_region(outlines);
  if (!region) {
    report(node, "its edges cross too often; simplify it");
    return {};
  }
  return make_flat(*std::move(region));
}

FlatShape CsgEvaluator::flat_resize(const ScadNode& node, const Affine2d& m) {
  FlatShape shape = flat_union(node);
  if (shape.is_empty()) return {};
  if (!has_exact_bounds(shape)) throw ScadUnsupported{"the size of its content isn't known"};
  const ScadArguments reader = arguments(node);
  const Bounds2d bounds = bounds_of(shape);
  const Vec2d size = bounds.high - bounds.low;
  const std::vector<double> wanted = reader.numbers("newsize", 2, 0);
  bool automatic[2] = {false, false};
  if (const ScadValue* value = reader.find("auto")) {
    if (const auto* all = std::get_if<bool>(&value->data)) {
      automatic[0] = automatic[1] = *all;
    } else {
      const ScadList& list = reader.list_of(*value, "auto");
      for (std::size_t i = 0; i < std::min<std::size_t>(list.size(), 2); ++i) {
        const auto* flag = std::get_if<bool>(&list[i].data);
        const auto* number = std::get_if<double>(&list[i].data);
        automatic[i] = (flag != nullptr && *flag) || (number != nullptr && *number != 0);
      }
    }
  }
  const double by_x = wanted[0] > 0 ? wanted[0] / size.x : 1;
  const double by_y = wanted[1] > 0 ? wanted[1] / size.y : 1;
  const double largest = wanted[0] >= wanted[1] ? by_x : by_y;
  const Affine2d scale{{wanted[0] > 0 || !automatic[0] ? by_x : largest, 0},
                       {0, wanted[1] > 0 || !automatic[1] ? by_y : largest},
                       {}};
  const Affine2d place = m * scale;
  if (flattens(place)) return {};
  transform(shape, place);
  return shape;
}

FlatShape CsgEvaluator::flat_by_openscad(const ScadNode& node, const Affine2d& m,
                                         const std::string& why) {
  // Flat shapes can't be written as .off: a slice of height 1 can.
  const std::string text = "linear_extrude(height = 1) {\n" + csg_text(node, files_.folder) + "}\n";
  const std::optional<Mesh> mesh = openscad_mesh(node, text, why);
  if (!mesh || mesh->triangles.empty() || flattens(m)) return {};
  const std::optional<CsgRegion> region = make_even_odd_region(bottom_outlines(*mesh));
  if (!region) {
    report(node, "its edges cross too often; simplify it");
    return {};
  }
  FlatShape shape = make_flat(*region);
  transform(shape, m);
  return shape;
}

}  // namespace arris
