// csg_evaluator.h — nodes of a .csg file to exact shapes
// What       docs/openscad.md says what becomes of each node
// Errors     what is wrong in a node's arguments is thrown at once; what can't be made is collected, so that
//            one message names all of it
// Limits     kMaxCsgVertices vertices made of facets in one file, kMaxScadDepth nested nodes
#pragma once

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "arris/io.h"
#include "arris/scene.h"
#include "io/csg_arguments.h"
#include "io/csg_document.h"
#include "io/csg_facets.h"
#include "io/csg_hull.h"
#include "io/csg_shape.h"

namespace arris {

inline constexpr std::size_t kMaxCsgVertices = 8'000'000;

// How the evaluator reaches beyond the file.
struct CsgFiles {
  std::string name;    // of the model; empty: as the file's
  std::string folder;  // file names are relative to it
  // A model that import() names; throws Error.
  std::function<Scene(const std::filesystem::path& path)> load_model;
  // .csg text to an .off file; see csg_openscad.h. Null: there is no such program.
  std::function<std::variant<std::vector<std::uint8_t>, std::string>(const std::string& csg)>
      make_mesh;
};

struct CsgPlace {
  Affine3d solid;
  Affine2d flat;
  std::optional<std::array<float, 4>> color;  // sRGB and alpha
};

class CsgEvaluator {
 public:
  CsgEvaluator(const std::string& file, LoadOptions options, const CsgFiles& files, Scene& scene)
      : file_(file), options_(options), files_(files), scene_(scene) {}

  SolidShape solid(const ScadNode& node, const CsgPlace& place);
  // Throws Error if there were problems; adds notes to the scene.
  void finish();

 private:
  using Solids = std::vector<SolidShape>;
  using Flats = std::vector<FlatShape>;

  // csg_evaluate_solid.cpp
  SolidShape make_solid(const ScadNode& node, const CsgPlace& place);
  Solids solids(const ScadNode& node, const CsgPlace& place);
  SolidShape cube(const ScadNode& node, const LeafMaker& make_leaf);
  SolidShape sphere(const ScadNode& node, const LeafMaker& make_leaf);
  SolidShape cylinder(const ScadNode& node, const LeafMaker& make_leaf);
  SolidShape polyhedron(const ScadNode& node, const LeafMaker& make_leaf);
  SolidShape import(const ScadNode& node, const LeafMaker& make_leaf);
  SolidShape linear_extrude(const ScadNode& node, const LeafMaker& make_leaf);
  SolidShape rotate_extrude(const ScadNode& node, const LeafMaker& make_leaf);
  SolidShape resize(const ScadNode& node, const CsgPlace& place);
  SolidShape by_openscad(const ScadNode& node, const LeafMaker& make_leaf, const std::string& why);

  // csg_evaluate_flat.cpp
  FlatShape flat(const ScadNode& node, const Affine2d& m);
  FlatShape make_flat_shape(const ScadNode& node, const Affine2d& m);
  FlatShape flat_union(const ScadNode& node);
  Flats flats(const ScadNode& node, const Affine2d& m);
  FlatShape circle(const ScadNode& node, const Affine2d& m);
  FlatShape polygon(const ScadNode& node, const Affine2d& m);
  FlatShape flat_resize(const ScadNode& node, const Affine2d& m);
  FlatShape flat_by_openscad(const ScadNode& node, const Affine2d& m, const std::string& why);

  // csg_evaluate_convex.cpp
  SolidShape hull(const ScadNode& node, const CsgPlace& place);
  SolidShape minkowski(const ScadNode& node, const CsgPlace& place);
  FlatShape flat_hull(const ScadNode& node, const Affine2d& m);
  FlatShape flat_minkowski(const ScadNode& node, const Affine2d& m);
  FlatShape offset(const ScadNode& node, const Affine2d& m);

  [[nodiscard]] ScadArguments arguments(const ScadNode& node) const;
  [[nodiscard]] FacetSettings facets(const ScadArguments& arguments) const;
  [[nodiscard]] bool keeps_facets(const FacetSettings& facets) const;
  int facet_count(const FacetSettings& facets, double radius);
  LeafMaker maker(const ScadNode& node, const CsgPlace& place);
  MaterialId material_of(const std::optional<std::array<float, 4>>& color);
  CsgPlace within(const ScadNode& node, const CsgPlace& place);
  void spend(const ScadNode& node, double vertices);
  void note(const ScadNode& node, const std::string& what);
  void report(const ScadNode& node, const std::string& what);
  // The mesh that OpenSCAD makes of the text, or nothing and a problem; no triangles: it makes nothing.
  std::optional<Mesh> openscad_mesh(const ScadNode& node, const std::string& text,
                                    const std::string& why);

  struct Remark {
    std::uint32_t line = 0;
    std::string text;
    std::size_t more = 0;
  };
  const std::string& file_;
  LoadOptions options_;
  const CsgFiles& files_;
  Scene& scene_;
  std::map<std::array<float, 4>, MaterialId> materials_;
  std::map<std::string, std::optional<Mesh>> meshes_;  // by OpenSCAD, of equal texts
  std::vector<Remark> problems_;
  std::map<std::string, Remark> notes_;
  double vertices_ = 0;
};

}  // namespace arris
