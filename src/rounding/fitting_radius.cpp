// fitting_radius.cpp — the largest radius that has room at every edge of a mesh
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "edges/flat_regions.h"
#include "rounding/solid_surface.h"

namespace arris {
namespace {

// Of the radius: what is no deeper than this in a ball may be a facet beside, and is of no account.
constexpr double kSlack = 0.01;
// Places along an edge, by fractions of it.
constexpr std::array<double, 5> kPlaces{0.5, 0.25, 0.75, 0.05, 0.95};
// A ball that does not fit shrinks at least by this; then its radius is found between.
constexpr double kSmaller = 0.97;
constexpr int kHalvings = 8;
// Of the radius that is asked: less is no room.
constexpr double kNoRoom = 1e-3;

// A piece of an edge between two faces; balls that touch both have their centres at p + r · way.
struct Piece {
  FacePair faces;
  Vec3d p0, p1, way;
  Vec3d normal0, normal1;  // of the faces, from the balls
};

// Of one solid: a shell and its hollows.
class FittingBalls {
 public:
  // no_room: the largest radius that is of no account.
  FittingBalls(SolidSurface surface, std::vector<Piece> pieces, double no_room)
      : surface_(std::move(surface)), pieces_(std::move(pieces)), no_room_(no_room) {
    std::ranges::stable_sort(pieces_, {}, &Piece::faces);
  }

  // Pieces between the same faces are one edge, which needs room somewhere. Most edges have it for what the ones before
  // have left.
  [[nodiscard]] double find(double most) const {
    double least = most;
    for (std::size_t i = 0, end = 0; i < pieces_.size(); i = end) {
      double largest = 0;
      for (; end < pieces_.size() && pieces_[end].faces == pieces_[i].faces; ++end) {
        for (const double u : kPlaces) {
          if (largest < least) largest = std::max(largest, fit_at(pieces_[end], u, least));
        }
      }
      least = std::min(least, largest);
    }
    return least;
  }

 private:
  // A ball shrinks until nothing lies within it and it touches both faces, not only their planes.
  [[nodiscard]] double fit_at(const Piece& piece, double u, double most) const {
    const Vec3d p = piece.p0 + (piece.p1 - piece.p0) * u;
    double r = most, too_large = most;
    for (double next = next_radius(piece, p, r); next != r; next = next_radius(piece, p, r)) {
      if (next < no_room_) return 0;
      too_large = std::exchange(r, next);
    }
    for (int i = 0; i < kHalvings && r < too_large; ++i) {
      const double middle = 0.5 * (r + too_large);
      (next_radius(piece, p, middle) == middle ? r : too_large) = middle;
    }
    return r;
  }

  // The same if it fits. From p + r · way a place q is r away where (way² − 1) r² − 2 r way·(q − p) + (q − p)² = 0.
  [[nodiscard]] double next_radius(const Piece& piece, Vec3d p, double r) const {
    const Vec3d c = p + piece.way * r;
    if (const auto near = surface_.nearest(c, (1 - kSlack) * r)) {
      const Vec3d to = near->place - p;
      const double a = length_squared(piece.way) - 1;
      const double b = dot(piece.way, to), squared = length_squared(to);
      return std::min(squared / (b + std::sqrt(std::max(b * b - a * squared, 0.0))), kSmaller * r);
    }
    const auto is_on_surface = [&](Vec3d x) { return surface_.nearest(x, kSlack * r).has_value(); };
    const bool touches =
        is_on_surface(c + piece.normal0 * r) && is_on_surface(c + piece.normal1 * r);
    return touches ? r : kSmaller * r;
  }

  SolidSurface surface_;
  std::vector<Piece> pieces_;  // by their faces
  double no_room_;
};

bool is_asked(EdgeKind kind, RoundEdges edges) {
  if (kind == EdgeKind::convex) return edges != RoundEdges::concave;
  return kind == EdgeKind::concave && edges != RoundEdges::convex;
}

}  // namespace

double find_fitting_radius(const MeshView& mesh, const RoundingOptions& options,
                           const std::string& name) {
  WeldedMesh welded = make_welded_mesh(mesh, name);
  FlatRegions regions = make_flat_regions(welded);
  if (!turn_inverted_shells(welded, regions, options.min_angle).empty()) {
    regions = make_flat_regions(welded);
  }
  struct SolidParts {
    std::vector<SurfaceTriangle> triangles;
    std::vector<Piece> pieces;
  };
  std::vector<SolidParts> solids(welded.shells.size());
  std::vector<std::uint32_t> solid_of;
  for (std::uint32_t s = 0; s < welded.shells.size(); ++s) {
    const std::uint32_t around = shell_around(welded.shells, s);
    solid_of.push_back(around == kNone ? s : around);
  }
  for (std::uint32_t t = 0; t < welded.triangles.size(); ++t) {
    if (welded.shell[t] == kNone || regions.region[t] == kNone) continue;
    const std::uint32_t solid = solid_of[welded.shell[t]];
    const Vec3d center = welded.shells[solid].center();
    const auto at = [&](std::uint32_t vertex) { return Vec3d(welded.vertices[vertex]) - center; };
    const Triangle& corners = welded.triangles[t];
    solids[solid].triangles.push_back(
        {at(corners[0]), at(corners[1]), at(corners[2]), regions.region[t], t});
    for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
      const std::uint32_t twin = welded.twin[h];
      if (twin > kLastHalfEdge || twin < h || regions.region[twin / 3] == kNone) continue;
      const EdgeKind kind = classify_edge(welded, regions, h, options.min_angle);
      if (!is_asked(kind, options.edges)) continue;
      const auto faces = std::minmax(regions.region[t], regions.region[twin / 3]);
      const Vec3d n0 = regions.planes[faces.first].normal;
      const Vec3d n1 = regions.planes[faces.second].normal;
      const double side = kind == EdgeKind::convex ? -1 : 1;
      solids[solid].pieces.push_back({faces, at(welded.origin(h)), at(welded.target(h)),
                                      (n0 + n1) * (side / (1 + dot(n0, n1))), n0 * -side,
                                      n1 * -side});
    }
  }
  double least = options.radius;
  for (SolidParts& solid : solids) {
    if (solid.pieces.empty()) continue;
    SolidSurface surface(solid.triangles, least);
    least = FittingBalls(std::move(surface), std::move(solid.pieces), kNoRoom * options.radius)
                .find(least);
  }
  return least;
}

}  // namespace arris
