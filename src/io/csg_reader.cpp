#include "io/csg_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "arris/error.h"
#include "io/csg_openscad.h"
#include "io/mesh_scene.h"
#include "scene/limits.h"

namespace arris {
namespace {

constexpr std::size_t kMaxLeaves = 20'000'000;

// What has no colour: the yellow that OpenSCAD shows, as of a matt plastic.
Material default_material() {
  Material material;
  material.name = "openscad";
  material.base_color = {0.83F, 0.56F, 0.10F};
  material.roughness = 0.45F;
  return material;
}

// The node that says what a part is: groups of one tell nothing.
const ScadNode& telling_node(const ScadNode& node) {
  const ScadNode* at = &node;
  while (at->children.size() == 1 && at->dimension == at->children[0].dimension &&
         (at->name == "group" || at->name == "union" || at->name == "multmatrix" ||
          at->name == "color" || at->name == "render")) {
    at = &at->children[0];
  }
  return *at;
}

const CsgLeaf& first_leaf(const SolidShape& shape) {
  return shape.leaf ? *shape.leaf : first_leaf(shape.children[0]);
}

struct Part {
  const ScadNode* node;
  SolidShape shape;
};

void check_size(const Part& part, const std::string& file) {
  const Bounds3d b = bounds_of(part.shape);
  double most = 0;
  for (int axis = 0; axis < 3; ++axis) {
    // A NaN is not less.
    for (const double x : {b.low[axis], b.high[axis]}) {
      if (!(std::abs(x) <= most)) most = std::abs(x);
      if (std::isnan(x)) most = x;
    }
  }
  // Where an intersection leaves nothing its bounds are the wrong way round.
  if (most <= kMaxCoordinate) return;
  throw Error(Error::Kind::input, fmt::format("{}:{}", file, part.node->line),
              fmt::format("{}: reaches to {:g}; coordinates may be up to {:g}, scale the model",
                          part.node->name, most, kMaxCoordinate));
}

void add_object(Scene& scene, SolidShape shape, std::string name) {
  Object& object = scene.objects.emplace_back();
  object.name = name;
  object.csg = CsgId{std::uint32_t(scene.csg_trees.size())};
  object.material = first_leaf(shape).material;
  scene.csg_trees.push_back(make_tree(std::move(shape), std::move(name)));
}

void add_objects(Scene& scene, std::vector<Part> parts) {
  if (parts.size() == 1 || parts.size() > kMaxCsgObjects) {
    std::vector<SolidShape> shapes;
    for (Part& part : parts) shapes.push_back(std::move(part.shape));
    add_object(scene, combine(CsgOperation::unite, std::move(shapes)), scene.name);
    return;
  }
  for (Part& part : parts) {
    const ScadNode& telling = telling_node(*part.node);
    add_object(scene, std::move(part.shape),
               fmt::format("{} (line {})", telling.name, telling.line));
  }
}

}  // namespace

CsgFiles csg_files_beside(const std::filesystem::path& file, const std::atomic<bool>* stop) {
  CsgFiles files;
  files.folder = file.parent_path().string();
  files.load_model = [](const std::filesystem::path& path) { return load_scene(path); };
  if (const auto program = find_openscad()) {
    files.make_mesh = [program, stop](const std::string& csg) {
      return mesh_by_openscad(*program, csg, stop);
    };
  }
  return files;
}

CsgFiles no_csg_files() {
  CsgFiles files;
  files.make_mesh = [](const std::string&) {
    return "other files and programs may not be used here";
  };
  return files;
}

Scene read_csg(std::span<const std::uint8_t> bytes, const std::string& file, const CsgFiles& files,
               const LoadOptions& options) {
  const ScadNode root = parse_csg(bytes, file);
  Scene scene;
  scene.name = files.name.empty() ? name_from_file(file) : files.name;
  scene.materials.push_back(default_material());
  CsgEvaluator evaluator(file, options, files, scene);
  std::vector<Part> parts;
  std::size_t leaves = 0;
  for (const ScadNode& child : root.children) {
    if (child.dimension == ScadDimension::flat) {
      scene.notes.push_back(
          fmt::format("line {}: {} is left out: it is flat", child.line, child.name));
      continue;
    }
    Part part{&child, evaluator.solid(child, {})};
    if (part.shape.is_empty()) continue;
    leaves += count_leaves(part.shape);
    if (leaves > kMaxLeaves) {
      throw Error(Error::Kind::input, file,
                  fmt::format("has more than {} primitives; split the model", kMaxLeaves));
    }
    check_size(part, file);
    parts.push_back(std::move(part));
  }
  evaluator.finish();
  if (parts.empty()) {
    const bool is_flat = std::ranges::any_of(
        root.children, [](const ScadNode& n) { return n.dimension == ScadDimension::flat; });
    throw Error(Error::Kind::input, file,
                is_flat ? "holds flat shapes only; give them a height with linear_extrude"
                        : "holds no solid: nothing is there, or all of it is empty");
  }
  add_objects(scene, std::move(parts));
  return scene;
}

Scene read_scad(const std::filesystem::path& path, const LoadOptions& options) {
  const std::string file = path.string();
  const auto program = find_openscad();
  if (!program) {
    throw Error(Error::Kind::failed, file,
                "reading .scad files takes OpenSCAD: install it so that the program openscad is on "
                "the PATH, or export the model there as .csg");
  }
  const OpenScadOutput output = flatten_by_openscad(*program, path, options.stop);
  if (const auto* problem = std::get_if<std::string>(&output)) {
    throw Error(Error::Kind::input, file, *problem);
  }
  CsgFiles files = csg_files_beside(path, options.stop);
  files.name = name_from_file(file);
  return read_csg(std::get<std::vector<std::uint8_t>>(output), file + " as .csg", files, options);
}

}  // namespace arris
