#include "step/step_mesh.h"

#include <BRepBndLib.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GeomLib.hxx>
#include <IMeshTools_Parameters.hxx>
#include <Poly_Triangulation.hxx>
#include <TopoDS_Face.hxx>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "arris/error.h"
#include "step/edge_marks.h"

namespace arris::step {
namespace {

Vec3d vec(const gp_XYZ& v) {
  return {v.X(), v.Y(), v.Z()};
}

// A face's triangles with its own vertices.
class FaceMesher {
 public:
  FaceMesher(const TopoDS_Face& face, Mesh& mesh) : face_(face), mesh_(mesh) {
    triangulation_ = BRep_Tool::Triangulation(face, location_);
    reversed_ = face.Orientation() == TopAbs_REVERSED;
  }

  // False if Open CASCADE has made no triangles.
  bool append() {
    if (triangulation_.IsNull() || triangulation_->NbTriangles() == 0) return false;
    first_ = std::uint32_t(mesh_.positions.size());
    const std::size_t first_triangle = mesh_.triangles.size();
    append_positions();
    append_triangles();
    append_normals(first_triangle);
    return true;
  }

 private:
  void append_positions() {
    const gp_Trsf placed = location_.Transformation();
    if (placed.IsNegative()) mirrored_ = true;
    for (int i = 1; i <= triangulation_->NbNodes(); ++i) {
      const Vec3f position(vec(triangulation_->Node(i).Transformed(placed).XYZ()));
      if (!is_finite(position)) {
        throw Error(Error::Kind::input, "",
                    "holds a point that is not finite, or beyond 3.4e38; export it again");
      }
      mesh_.positions.push_back(position);
    }
  }

  void append_triangles() {
    const auto position = [&](std::uint32_t vertex) { return mesh_.positions[vertex]; };
    for (int i = 1; i <= triangulation_->NbTriangles(); ++i) {
      int a = 0, b = 0, c = 0;
      triangulation_->Triangle(i).Get(a, b, c);
      if (reversed_ != mirrored_) std::swap(b, c);
      const auto number = [&](int node) { return first_ + std::uint32_t(node - 1); };
      const Triangle triangle{number(a), number(b), number(c)};
      // At the poles of spheres and cones.
      if (position(triangle[0]) == position(triangle[1]) ||
          position(triangle[1]) == position(triangle[2]) ||
          position(triangle[2]) == position(triangle[0])) {
        continue;
      }
      mesh_.triangles.push_back(triangle);
    }
  }

  // Where the surface has no normal, that of the triangles around, which have been made.
  void append_normals(std::size_t first_triangle) {
    std::vector<Vec3d> around(mesh_.positions.size() - first_, Vec3d(0));
    for (std::size_t t = first_triangle; t < mesh_.triangles.size(); ++t) {
      const Triangle& triangle = mesh_.triangles[t];
      const Vec3d a(mesh_.positions[triangle[0]]);
      const Vec3d normal =
          cross(Vec3d(mesh_.positions[triangle[1]]) - a, Vec3d(mesh_.positions[triangle[2]]) - a);
      for (const std::uint32_t vertex : triangle) around[vertex - first_] += normal;
    }
    const opencascade::handle<Geom_Surface> surface = BRep_Tool::Surface(face_);
    for (std::size_t i = 0; i < around.size(); ++i) {
      mesh_.normals.push_back(normal_at(surface, int(i) + 1, around[i]));
    }
  }

  [[nodiscard]] Vec3f normal_at(const opencascade::handle<Geom_Surface>& surface, int node,
                                Vec3d around) const {
    constexpr double kResolution = 1e-9;
    const double size = length(around);
    const Vec3d mean = size > 0 ? around / size : Vec3d(0, 0, 1);
    gp_Dir normal;
    // 0 and 1: a normal, by derivatives of the first or a higher order.
    if (surface.IsNull() || !triangulation_->HasUVNodes() ||
        GeomLib::NormEstim(surface, triangulation_->UVNode(node), kResolution, normal) > 1) {
      return Vec3f(mean);
    }
    const Vec3d smooth = vec(normal.XYZ()) * (reversed_ ? -1 : 1);
    // Tangents that turn around, near a pole.
    return Vec3f(dot(smooth, mean) >= 0 ? smooth : mean);
  }

  const TopoDS_Face& face_;
  Mesh& mesh_;
  TopLoc_Location location_;
  opencascade::handle<Poly_Triangulation> triangulation_;
  bool reversed_ = false, mirrored_ = false;
  std::uint32_t first_ = 0;
};

}  // namespace

void tessellate(const TopoDS_Shape& part) {
  Bnd_Box box;
  BRepBndLib::Add(part, box, false);
  if (box.IsVoid()) return;
  const double size = std::sqrt(box.SquareExtent());
  if (!(size > 0 && size < 1e12)) {
    throw Error(Error::Kind::input, "",
                "has a part without a size, or one that is endless; export solids");
  }
  IMeshTools_Parameters parameters;
  parameters.Deflection = kDeflection * size;
  parameters.DeflectionInterior = parameters.Deflection;
  parameters.Angle = kAngle;
  parameters.AngleInterior = kAngleInside;
  parameters.MinSize = 1e-3 * parameters.Deflection;
  const BRepMesh_IncrementalMesh mesher(part, parameters);
}

PartMesh make_mesh(const std::vector<TopoDS_Face>& faces, const MaterialOfFace& material_of) {
  PartMesh part;
  std::vector<std::optional<MaterialId>> materials;
  std::vector<PlacedFace> placed;
  for (const TopoDS_Face& face : faces) {
    placed.push_back({face, std::uint32_t(part.mesh.positions.size())});
    if (!FaceMesher(face, part.mesh).append()) ++part.missing_faces;
    materials.resize(part.mesh.triangles.size(), material_of(face));
  }
  part.mesh.sharp_edges = find_sharp_edges(placed, part.mesh);
  const auto differs = [&](const auto& material) { return material != materials[0]; };
  if (std::ranges::none_of(materials, differs)) {
    if (!materials.empty()) part.material = materials[0];
  } else {
    for (const auto& material : materials) {
      part.mesh.triangle_materials.push_back(material.value_or(MaterialId{0}));
    }
  }
  return part;
}

}  // namespace arris::step
