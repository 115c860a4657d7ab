// bevel_faces.cpp — the mesh's faces within their new outlines
#include "rounding/bevel_shell.h"

namespace arris {

// Faces that no rounding touches keep their triangles.
bool ShellBevel::make_faces(std::uint32_t shell) {
  const Shell& s = mesh_.shells[shell];
  const Solid& solid = parts_.data->solids[shell];
  const auto first = mesh_.triangles_by_shell.begin() + s.first_triangle;
  const auto last = first + s.triangle_count;
  borders_.resize(std::max<std::size_t>(borders_.size(), solid.face_count));
  std::vector<std::uint8_t> touched(solid.face_count, 0);
  for (std::uint32_t f = 0; f < solid.face_count; ++f) borders_[f].clear();
  for (auto t = first; t != last; ++t) {
    const std::uint32_t region = parts_.regions.region[*t];
    if (region == kNone) continue;
    const std::uint32_t f = region - solid.first_face;
    for (std::uint32_t h = 3 * *t; h < 3 * *t + 3; ++h) {
      if (parts_.kinds[h] == EdgeKind::flat) continue;
      visited_[h] = 0;
      borders_[f].push_back(h);
      if (in_chain_[h] != 0 || path_of_[h].count > 0) touched[f] = 1;
    }
  }
  for (auto t = first; t != last; ++t) {
    const std::uint32_t region = parts_.regions.region[*t];
    if (region != kNone && touched[region - solid.first_face] == 0) out_.kept.push_back(*t);
  }
  for (std::uint32_t f = 0; f < solid.face_count; ++f) {
    if (touched[f] != 0 && !make_face(solid.first_face + f)) return false;
  }
  return true;
}

bool ShellBevel::make_face(std::uint32_t face) {
  loop_count_ = 0;
  face_vertices_.clear();
  const Solid& solid = parts_.data->solids[parts_.regions.shell[face]];
  for (const std::uint32_t h : borders_[face - solid.first_face]) {
    if (visited_[h] == 0) trace_loop(h, face);
  }
  face_points_.clear();
  for (const std::uint32_t v : face_vertices_) face_points_.push_back(out_.positions[v]);
  const auto triangles =
      triangulator_.triangulate(face_points_, std::span(loops_).first(loop_count_), normal(face));
  if (!triangles) return false;
  for (const Triangle& t : *triangles) {
    add_triangle(face_vertices_[t[0]], face_vertices_[t[1]], face_vertices_[t[2]], face, true);
  }
  return true;
}

// One outline of a face, its corners replaced by their paths.
void ShellBevel::trace_loop(std::uint32_t half_edge, std::uint32_t face) {
  if (loop_count_ == loops_.size()) loops_.emplace_back();
  std::vector<std::uint32_t>& loop = loops_[loop_count_++];
  loop.clear();
  const auto add = [&](std::uint32_t vertex) {
    loop.push_back(std::uint32_t(face_vertices_.size()));
    face_vertices_.push_back(vertex);
  };
  std::uint32_t h = half_edge;
  do {
    visited_[h] = 1;
    std::uint32_t next = WeldedMesh::next(h);
    while (parts_.kinds[next] == EdgeKind::flat) next = WeldedMesh::next(mesh_.twin[next]);
    const Path& path = path_of_[next];
    if (path.count > 0) {
      for (std::uint32_t i = 0; i < path.count; ++i) add(path_vertices_[path.first + i]);
    } else if (in_chain_[h] == 0 || in_chain_[next] == 0) {
      add(add_source_vertex(mesh_.origin(next), face));
    }
    h = next;
  } while (h != half_edge && visited_[h] == 0);
}

}  // namespace arris
