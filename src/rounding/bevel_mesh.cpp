#include "rounding/bevel_mesh.h"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <tuple>

#include "base/check.h"
#include "rounding/bevel_shell.h"

namespace arris {
namespace {

// On a source triangle; the weights may lie outside it: it is continued as a plane.
struct SourcePoint {
  std::uint32_t triangle = 0;
  Vec3d weights;
};

class BevelMaker {
 public:
  BevelMaker(const Mesh& mesh, const RoundingOptions& options, int subdivisions,
             const std::string& name)
      : source_(mesh),
        parts_(
            make_rounding_parts({mesh.positions, mesh.triangles, mesh.sharp_edges}, options, name)),
        subdivisions_(subdivisions) {}

  BevelMesh make() {
    ShellBevel bevel(parts_, subdivisions_, surface_);
    for (std::uint32_t s = 0; s < parts_.welded.shells.size(); ++s) {
      if (has_mixed_faces(s)) {
        bevel.keep(s);
        ++mixed_;
      } else if (!bevel.append(s)) {
        ++folded_;
      } else {
        ++out_.bevelled_solids;
        count(parts_.networks[s]);
      }
    }
    out_.mesh.name = source_.name;
    if (source_.uvs.empty() && source_.normals.empty()) {
      take_surface();
    } else {
      dress_surface();
    }
    append_kept();
    report();
    return std::move(out_);
  }

 private:
  void count(const ShellNetwork& network) {
    out_.rounded_edges += network.rounded_edges;
    out_.rounded_corners += network.rounded_corners;
  }

  // Pieces of triangles that were split at T-junctions follow the source's.
  [[nodiscard]] bool is_source(std::uint32_t triangle) const {
    return triangle < source_.triangles.size();
  }

  // A rounded face is cut anew, so it must be of one material.
  [[nodiscard]] bool has_mixed_faces(std::uint32_t shell) const {
    if (source_.triangle_materials.empty() || parts_.networks[shell].arcs.empty()) return false;
    const Shell& s = parts_.welded.shells[shell];
    const Solid& solid = parts_.data->solids[shell];
    std::vector<std::optional<MaterialId>> material(solid.face_count);
    for (std::uint32_t i = s.first_triangle; i < s.first_triangle + s.triangle_count; ++i) {
      const std::uint32_t t = parts_.welded.triangles_by_shell[i];
      if (!is_source(t) || parts_.regions.region[t] == kNone) continue;
      std::optional<MaterialId>& seen = material[parts_.regions.region[t] - solid.first_face];
      if (seen && *seen != source_.triangle_materials[t]) return true;
      seen = source_.triangle_materials[t];
    }
    return false;
  }

  void take_surface() {
    out_.mesh.positions = std::move(surface_.positions);
    out_.mesh.normals = std::move(surface_.normals);
    out_.mesh.triangles = std::move(surface_.triangles);
    if (source_.triangle_materials.empty()) return;
    sort_triangles_by_face();
    for (const std::uint32_t face : surface_.face) {
      out_.mesh.triangle_materials.push_back(source_.triangle_materials[first_triangle(face)]);
    }
  }

  // A face without any triangle of the source is a sliver of one that was split.
  [[nodiscard]] std::uint32_t first_triangle(std::uint32_t face) const {
    if (face_begin_[face] < face_begin_[face + 1]) return face_triangles_[face_begin_[face]];
    return face_triangles_[face_begin_[parts_.data->solids[parts_.regions.shell[face]].first_face]];
  }

  void sort_triangles_by_face() {
    const auto region = std::span(parts_.regions.region).first(source_.triangles.size());
    face_begin_.assign(parts_.regions.planes.size() + 2, 0);
    for (const std::uint32_t r : region) {
      if (r != kNone) ++face_begin_[r + 2];
    }
    for (std::size_t r = 2; r < face_begin_.size(); ++r) face_begin_[r] += face_begin_[r - 1];
    face_triangles_.resize(face_begin_.back());
    for (std::uint32_t t = 0; t < region.size(); ++t) {
      if (region[t] != kNone) face_triangles_[face_begin_[region[t] + 1]++] = t;
    }
  }

  // Vertices get uv and, on faces, normals of the source: one for each face that uses them.
  void dress_surface() {
    sort_triangles_by_face();
    std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>, std::uint32_t> dressed;
    for (std::size_t i = 0; i < surface_.triangles.size(); ++i) {
      const std::uint32_t face = surface_.face[i];
      const bool own_normals = !source_.normals.empty() && surface_.flat[i] != 0;
      Triangle triangle{};
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t v = surface_.triangles[i][k];
        const auto [at, is_new] = dressed.try_emplace({v, face, own_normals ? 1U : 0U},
                                                      std::uint32_t(out_.mesh.positions.size()));
        triangle[k] = at->second;
        if (is_new) dress_vertex(v, face, own_normals);
      }
      out_.mesh.triangles.push_back(triangle);
      if (!source_.triangle_materials.empty()) {
        out_.mesh.triangle_materials.push_back(source_.triangle_materials[first_triangle(face)]);
      }
    }
  }

  void dress_vertex(std::uint32_t v, std::uint32_t face, bool own_normals) {
    const SourcePoint at = nearest_on_face(Vec3d(surface_.positions[v]), face);
    const Triangle& t = source_.triangles[at.triangle];
    out_.mesh.positions.push_back(surface_.positions[v]);
    Vec3f normal = surface_.normals[v];
    // A wall stands on no face of the source: its normal is its own.
    const bool on_face = dot(Vec3d(normal), parts_.regions.planes[face].normal) > 1 - 1e-6;
    if (own_normals && on_face) {
      const Vec3d mixed = Vec3d(source_.normals[t[0]]) * at.weights.x +
                          Vec3d(source_.normals[t[1]]) * at.weights.y +
                          Vec3d(source_.normals[t[2]]) * at.weights.z;
      const double turned = is_turned(at.triangle) ? -1 : 1;
      if (dot(mixed, Vec3d(normal)) * turned > 0) normal = Vec3f(normalize(mixed * turned));
    }
    out_.mesh.normals.push_back(normal);
    if (source_.uvs.empty()) return;
    const Vec2f a = source_.uvs[t[0]], b = source_.uvs[t[1]], c = source_.uvs[t[2]];
    const Vec3f w(at.weights);
    out_.mesh.uvs.push_back({a.x * w.x + b.x * w.y + c.x * w.z, a.y * w.x + b.y * w.y + c.y * w.z});
  }

  [[nodiscard]] bool is_turned(std::uint32_t triangle) const {
    const std::uint32_t shell = parts_.welded.shell[triangle];
    return shell != kNone && parts_.welded.shells[shell].turned;
  }

  // The face's triangle that the point is in or least outside of.
  [[nodiscard]] SourcePoint nearest_on_face(Vec3d p, std::uint32_t face) const {
    SourcePoint best{first_triangle(face), Vec3d(1.0 / 3)};
    double deepest = -std::numeric_limits<double>::infinity();
    for (std::uint32_t i = face_begin_[face]; i < face_begin_[face + 1]; ++i) {
      const std::uint32_t t = face_triangles_[i];
      const Triangle& v = source_.triangles[t];
      const Vec3d a(source_.positions[v[0]]), b(source_.positions[v[1]]),
          c(source_.positions[v[2]]);
      const Vec3d n = cross(b - a, c - a);
      const double squared = length_squared(n);
      if (!(squared > 0)) continue;
      const Vec3d w{dot(n, cross(c - b, p - b)) / squared, dot(n, cross(a - c, p - c)) / squared,
                    dot(n, cross(b - a, p - a)) / squared};
      const double depth = std::min({w.x, w.y, w.z});
      if (depth <= deepest) continue;
      deepest = depth;
      best = {t, w};
    }
    return best;
  }

  // Triangles that stay as they are, in their shell's orientation; flat unless the source has normals.
  void append_kept() {
    Mesh& mesh = out_.mesh;
    std::vector<std::uint32_t> stamp(source_.positions.size(), kNone), vertex(stamp);
    for (const std::uint32_t t : surface_.kept) {
      const std::uint32_t face = parts_.regions.region[t];
      if (face == kNone || !is_source(t)) continue;
      Triangle corners = source_.triangles[t];
      const bool turned = is_turned(t);
      if (turned) std::swap(corners[1], corners[2]);
      const std::uint32_t sharing = source_.normals.empty() ? face : turned ? 1U : 0U;
      for (std::uint32_t& v : corners) {
        if (stamp[v] != sharing) {
          stamp[v] = sharing;
          vertex[v] = std::uint32_t(mesh.positions.size());
          mesh.positions.push_back(source_.positions[v]);
          const Vec3f flat(parts_.regions.planes[face].normal);
          mesh.normals.push_back(source_.normals.empty() ? flat
                                 : turned                ? -source_.normals[v]
                                                         : source_.normals[v]);
          if (!source_.uvs.empty()) mesh.uvs.push_back(source_.uvs[v]);
        }
        v = vertex[v];
      }
      mesh.triangles.push_back(corners);
      if (!source_.triangle_materials.empty()) {
        mesh.triangle_materials.push_back(source_.triangle_materials[t]);
      }
    }
  }

  void report() {
    out_.kept_solids = folded_ + mixed_;
    out_.notes = parts_.data->report.notes;
    const auto note = [&](std::uint64_t count, const char* one, const char* many) {
      if (count > 0) out_.notes.push_back({count, one, many});
    };
    note(folded_, "solid keeps its sharp triangles: a meshed bevel of this radius would fold over",
         "solids keep their sharp triangles: a meshed bevel of this radius would fold over");
    note(mixed_, "solid keeps its sharp triangles: faces of several materials are not meshed",
         "solids keep their sharp triangles: faces of several materials are not meshed");
  }

  const Mesh& source_;
  RoundingParts parts_;
  int subdivisions_;
  BevelSurface surface_;
  BevelMesh out_;
  std::uint64_t folded_ = 0, mixed_ = 0;
  std::vector<std::uint32_t> face_begin_, face_triangles_;
};

}  // namespace

BevelMesh make_bevel_mesh(const Mesh& mesh, const RoundingOptions& options, int subdivisions,
                          const std::string& name) {
  ARRIS_CHECK(subdivisions >= 1, double(subdivisions));
  return BevelMaker(mesh, options, subdivisions, name).make();
}

}  // namespace arris
