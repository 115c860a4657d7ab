// rounding.h — rounded edges beside a mesh, without touching it
// What       make_rounding() builds, from triangles and a radius, an immutable structure beside the
//            mesh. Given a ray and its hit on the mesh, resolve() says what the rounded solid does with
//            it: the hit stands, it moves onto an edge's cylinder or a corner's sphere, or the ray
//            passes between the sharp and the rounded edge and leaves the solid again.
// In / Out   the mesh's own space and units; rays in double precision, directions need not be unit
// Guarantee  a closed convex solid whose every edge turns by min_angle or more is rounded exactly: its
//            surface is that of the union of all balls of the radius that fit inside
//            (tests/rounding/oracle_test.cpp); so are the convex edges of closed solids that are not convex
//            (tests/rounding/creased_test.cpp), and their concave ones, where all balls fit that lie outside
//            (tests/rounding/fillets_test.cpp). Const after building, safe from any number of threads.
// Limits     solids that aren't exact are rounded locally along convex edges; only closed ones have fillets. A ray
//            that passes one of these and next leaves it by a kept face went through material: let the first hit
//            stand, unless what it passed is Feature::fillet.
// Cost       building is linear in the pairs of triangles within two radii; a kept hit costs a few multiplications.
//            Where the radius has eaten edges of a convex solid, a moved hit costs linear in those left.
// Source     Courtin, Horna, Ribardière, Poulin, Meneveaux, "Efficient Rendering of Rounded Corners and
//            Edges for Convex Objects"; where this differs is said in src/rounding/.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "arris/math.h"
#include "arris/scene.h"

namespace arris {

struct MeshView {
  std::span<const Vec3f> positions;
  std::span<const Triangle> triangles;
  // As in Mesh. Set: these edges are sharp and no others, and no minimum angle is asked.
  std::optional<std::span<const VertexPair>> sharp_edges{};
  std::span<const EdgeRadius> edge_radii{};  // as in Mesh; rules go before
  // Where the vertices lie in the space of EdgeRule's places; empty: at `positions`.
  std::span<const Vec3f> places{};
};

// How a hit finds the rounding near it (paper §3.2 against the index by face; bench/rounding compares). The tree
// answers in resolve() only: is_kept() is false for every hit, and each costs a search of the tree.
enum class Detection { face_index, kd_tree };

// What to do with a closed convex solid into which a ball of the radius does not fit.
enum class TooLarge { error, leave_sharp };

struct RoundingOptions {
  double radius = 0;  // > 0, in the mesh's units
  RoundEdges edges = RoundEdges::convex;
  double min_angle = radians(30);
  Detection detection = Detection::face_index;
  TooLarge too_large = TooLarge::error;
  OnOverlap on_overlap = OnOverlap::report;
  std::vector<EdgeRule> rules;  // radii in the mesh's units; of edges of closed solids only
};

// Position along a ray: origin + t * direction.
struct Ray {
  Vec3d origin;
  Vec3d direction;
};

// What a ray tracer reports: u and v are the barycentric weights of the triangle's second and third
// vertex.
struct MeshHit {
  std::uint32_t triangle = 0;
  double u = 0, v = 0;
  double t = 0;
};

enum class Feature : std::uint8_t { face, edge, corner, fillet, csg };
const char* name_of(Feature feature);

struct RoundedHit {
  double t = 0;
  Vec3d normal;  // unit, outward from the solid
  Feature feature = Feature::face;
  std::uint32_t arc = ~std::uint32_t{0};  // of an edge, for blend_of()
  // The arc between whose ends the ray crossed the void, or entered it to pass; ~0: it came by a corner.
  std::uint32_t crossed = ~std::uint32_t{0};
  // The solid of a hit on an edge or corner, where it has no arcs, for blend_of().
  std::uint32_t solid = ~std::uint32_t{0};
};

// How a point of an edge's cylinder lies between the two faces beside it: normal = Σ weight · face_normal. A host that
// shades faces by vertex normals puts those of the triangles at the points in the place of face_normal, and
// shading goes on smoothly where a rim follows a curved wall.
struct EdgeBlend {
  struct Side {
    std::uint32_t triangle = 0;
    Vec3d point;  // where the cylinder touches the face, in its plane; not always in the triangle
    Vec3d face_normal;
    double weight = 0;
  };
  Side a, b;
};

// What the host knows of where a ray starts, for hits from inside.
enum class RayStart : std::uint8_t {
  unknown,  // the kernel finds out
  outside,  // outside the rounded solid: in the open, or in the void between the sharp and the rounded edge
  inside,  // inside the rounded solid (glass, a room)
};

// What becomes of one hit on the mesh.
struct Resolution {
  enum class Outcome : std::uint8_t {
    kept,    // the hit stands
    moved,   // the surface is at `hit` instead
    passed,  // the ray misses the rounded solid here: ask for the next hit of the mesh
  };
  Outcome outcome = Outcome::kept;
  RoundedHit
      hit;  // passed with Feature::fillet: no surface is here, but the border between solid and fillet
};

// What could not be rounded, and why: "3 concave edges stay sharp".
struct RoundingNote {
  std::uint64_t count = 0;  // 0: nothing to count, `many` is the whole text
  std::string one, many;    // what follows a count of 1, and any other

  [[nodiscard]] std::string text() const {
    if (count == 0) return many;
    return std::to_string(count) + " " + (count == 1 ? one : many);
  }
};

// An edge, or part of one, convex or concave, that has a smaller radius or stays sharp because there is no room.
struct ClampedEdge {
  Vec3d from, to;     // in the mesh's space
  double radius = 0;  // 0: it stays sharp
};

struct RoundingReport {
  std::uint64_t solids = 0, convex_solids = 0, exact_solids = 0, open_solids = 0;
  std::uint64_t rounded_edges = 0, rounded_corners = 0;
  std::uint64_t concave_edges = 0, smooth_edges = 0, boundary_edges = 0, nonmanifold_edges = 0;
  // Edges that stay sharp because the radius has no room anywhere along them, concave ones that were asked for and have
  // no fillets, and solids in which no ball fits.
  std::uint64_t narrow_edges = 0;
  std::uint64_t bytes = 0;
  std::vector<RoundingNote> notes;
  std::vector<ClampedEdge> clamped;
  std::vector<std::uint64_t>
      rule_edges;  // how many pieces of edges each rule of the options matches
};

class Rounding {
 public:
  Rounding(Rounding&&) noexcept;
  Rounding& operator=(Rounding&&) noexcept;
  ~Rounding();

  // True if the hit is on the rounded solid itself; with Detection::kd_tree always false, so that resolve()
  // decides. u, v as in MeshHit.
  [[nodiscard]] bool is_kept(std::uint32_t triangle, double u, double v) const;

  // For a hit that need not be kept. A hit from inside (direction along the outward normal) is where the ray
  // leaves the sharp solid: the moved hit has a smaller t. A ray that starts in the void of an exact solid and
  // leaves by this hit is resolved from its start: give RayStart::unknown and call this for kept hits from
  // inside, too.
  [[nodiscard]] Resolution resolve(const Ray& ray, const MeshHit& hit,
                                   RayStart start = RayStart::unknown) const;

  // Where a ray leaves the sharp mesh of an exact solid: the paper's I″. From a place beside an arc
  // (RoundedHit::crossed) at a t of the ray: nothing if the way out leads past the arc's ends. Cost: linear in
  // the solid's faces, constant with an arc.
  struct Exit {
    double t = 0;
    double cosine = 0;  // between the ray and the outward normal there; > 0
  };
  [[nodiscard]] Exit find_exit(std::uint32_t solid, const Ray& ray) const;
  [[nodiscard]] std::optional<Exit> find_exit_beside(std::uint32_t arc, const Ray& ray,
                                                     double start) const;

  // Whether a point, in the mesh's space, lies in the rounded solid. Exact solids only (see is_exact).
  // Cost: linear in the solid's faces.
  [[nodiscard]] bool contains(std::uint32_t solid, Vec3d point) const;

  // Fillets of concave edges lie before the mesh. resolve() moves hits of the mesh onto them; but at their ends a ray
  // may enter one and leave it again without meeting the mesh: hosts look whether it meets one of these boxes, in the
  // mesh's space, and ask meet_fillet() of each that it meets.
  struct FilletBox {
    Vec3d low, high;
    std::uint32_t triangle;  // beside the fillet, whose material is its own
  };
  [[nodiscard]] std::span<const FilletBox> fillet_boxes() const;
  // The first crossing of the fillet's surface within ]t_min, t_max[ that is made by the part in one box; it enters if
  // the normal is against the ray. Starts inside the rounded solid enter none first, starts outside leave none.
  [[nodiscard]] std::optional<RoundedHit> meet_fillet(std::uint32_t box, const Ray& ray,
                                                      double t_min, double t_max,
                                                      RayStart start = RayStart::unknown) const;

  // Of a hit on an edge; nothing for other hits, and where faces meet without smooth edges. position: of the hit.
  [[nodiscard]] std::optional<EdgeBlend> blend_of(const RoundedHit& hit, Vec3d position) const;

  // The solid (connected component) of a triangle, and whether it is closed, convex and rounded exactly: once a ray has
  // passed such a solid it never meets it again. False for solids with concave edges, however exact.
  [[nodiscard]] std::uint32_t solid_of(std::uint32_t triangle) const;
  [[nodiscard]] bool is_exact(std::uint32_t solid) const;

  // Outward unit normal of a triangle's flat region.
  [[nodiscard]] Vec3d face_normal(std::uint32_t triangle) const;

  // The reference lives as long as the rounding.
  [[nodiscard]] const RoundingReport& report() const;

  struct Data;
  explicit Rounding(std::unique_ptr<const Data> data);
  [[nodiscard]] const Data& data() const { return *data_; }

 private:
  std::unique_ptr<const Data> data_;
};

// How large a radius fits.
struct RadiusLimits {
  std::optional<double> smallest_inradius;  // of the closed convex solids
  // The median over closed convex solids and others with an edge to round. Half the width of a closed convex
  // solid is its inradius, that of others the smaller of volume / area (half a wall) and area / outline (half
  // a face): however finely curved edges are cut into facets, it stays the same.
  std::optional<double> typical_half_width;
};
RadiusLimits find_radius_limits(const MeshView& mesh, double min_angle,
                                const std::string& name = "");

// A radius smaller than that of the options with which no edge stays sharp for want of room, to within some 5 per cent
// of one with which some do, on meshes of more than 2,000 triangles half of one; nothing: none of a thousandth of that,
// or of the mesh's size, is found. Radii of single edges are of no account.
// Cost: up to 14 roundings.
std::optional<double> find_fitting_radius(const MeshView& mesh, const RoundingOptions& options,
                                          const std::string& name = "");

// Throws Error (kind input, where = `name`) if the radius is not positive or, with TooLarge::error, not smaller
// than the inradius of a closed convex solid; the message says one that works.
Rounding make_rounding(const MeshView& mesh, const RoundingOptions& options,
                       const std::string& name = "");

}  // namespace arris
