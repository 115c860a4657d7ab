// beam_view.h — planes and quadrics as all rays of a picture see them
// What       A ray is origin + depth · direction, where the picture's x and y move the one or the other:
//            from_point (an eye, or a point light): direction is linear in x and y, depth is along the view.
//            parallel (a directional light): origin / weight moves over the plane that is lit, and depth is in
//            units of 1 / weight.
//            bundle (what a curved mirror makes of a beam): both move, see ray_bundle.h.
//            Along each ray a plane's height is height + depth · slope, a quadric's value is
//            value + 2 depth · half_slope + depth² · curvature, with polynomials of x and y that this file makes.
// Guarantee  every polynomial holds that of real arithmetic on the doubles that describe camera and solids, for kind
//            eye and either kind of light view but for the rounding of the lit plane (tests/beam/beam_view_test.cpp)
// Frames     depths are the same in the world and in each solid
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "beam/beam_shape.h"
#include "beam/polynomial.h"
#include "beam/ray_bundle.h"

namespace arris {

using LinearVec = Vec3<Linear>;

inline Ray ray_through(const EyeRays& eye, Vec2d at) {
  return {eye.position, eye.corner + eye.step_x * at.x + eye.step_y * at.y};
}

// Which of origin and direction is one for all rays.
enum class BeamKind : std::uint8_t { from_point, parallel, bundle };

// Rays in the space of one solid. Not of a bundle.
struct ViewFrame {
  LinearVec origin, direction;
  Linear weight{1, 0, 0};
  BeamKind kind = BeamKind::from_point;
};

struct PlaneForm {
  Linear height, slope;
};
struct QuadricForm {
  Quadratic value, curvature;
  Linear half_slope;
  Quadratic discriminant;  // half_slope² - value · curvature: negative where the ray misses
  // Of a cylinder seen from outside: the planes through the origin, or along the direction, that touch it. Rays that
  // may meet it are on the positive side of both.
  bool has_tangents = false;
  Linear tangents[2];
  Linear along;  // the origin's z in the quadric's own frame: which half of a double cone it is in
};

PlaneForm make_form(const ViewFrame& frame, const CsgPlane& plane);
// On which side rays pass the line from a to b: positive where direction · ((a - origin) × (b - origin)) is.
Linear make_side(const ViewFrame& frame, const BeamShape::Edge& edge);
QuadricForm make_form(const ViewFrame& frame, const CsgQuadric& quadric);

ViewFrame make_eye_frame(const EyeRays& eye, const BeamSolid& solid);

// Signs of these say how two depths along a ray compare; see beam_view.cpp for the derivations.
// Depth at a minus depth at b, times the slopes of both.
Quadratic plane_before_plane(const PlaneForm& a, const PlaneForm& b, BeamKind kind);
// The quadric's value where the ray meets the plane, times slope².
Quadratic quadric_at_plane(const QuadricForm& q, const PlaneForm& p, BeamKind kind);
// Depth at the plane minus that of the middle between the roots, times slope · curvature.
Quadratic plane_beyond_middle(const QuadricForm& q, const PlaneForm& p, BeamKind kind);

// The rays from a light to a plane that the eye sees: picture points are those of the eye's picture.
struct LitPlane {
  std::uint32_t solid = 0, plane = 0;
};
struct LightPlace {
  Vec3d position;   // of a point light
  Vec3d direction;  // in which a directional light travels, any length
  bool is_directional = false;
};

// Where a leaf may be in the picture, by its box: much cheaper than its surfaces. For kind light, its shadow on the
// lit plane.
struct LeafWindow {
  double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
  // Depths between which it lies; only the eye's view knows.
  double near = 0, far = std::numeric_limits<double>::infinity();

  [[nodiscard]] bool meets(const Rect& r) const {
    return x0 <= r.x1 && x1 >= r.x0 && y0 <= r.y1 && y1 >= r.y0;
  }
};

// The surfaces of some solids in one view.
class BeamView {
 public:
  // The eye's: all surfaces are made at once. `solids` must outlive the view.
  BeamView(std::span<const BeamSolid> solids, const EyeRays& eye);
  // A light's: surfaces are made whenever they are asked for. `reach`: no solid is farther from another.
  // Precondition: over the part of the picture that is asked about, the eye's rays meet the plane.
  BeamView(std::span<const BeamSolid> solids, const EyeRays& eye, LitPlane lit,
           const LightPlace& light, double reach);

  // A mirrored eye's: surfaces are made whenever they are asked for. Rays begin at the mirror.
  BeamView(std::span<const BeamSolid> solids, const EyeRays& eye, LitPlane mirror);

  // A bundle's, in the world: the picture is kUnitSquare. Surfaces are made whenever they are asked for.
  BeamView(std::span<const BeamSolid> solids, const RayBundle& bundle);

  // Where rays begin: kStartLeaf. Precondition: the view is a mirrored eye's.
  [[nodiscard]] const LitPlane& mirror() const { return *mirror_; }
  [[nodiscard]] bool is_mirrored() const { return mirror_.has_value(); }
  [[nodiscard]] const BeamShape& shape(std::uint32_t solid) const { return *solids_[solid].shape; }
  // Do all rays begin on this plane or quadric?
  [[nodiscard]] bool starts_on(const BeamSurface& surface) const {
    return bundle_ && bundle_->start && bundle_->start->lies_on(surface);
  }
  // Are the origins of all rays inside the volume? A directional light is outside of all.
  [[nodiscard]] Cover start_in_volume(std::uint32_t solid, std::uint32_t leaf) const;
  // 1: the rays see the facet's corners turn counter-clockwise; -1: clockwise; 0: they run along it. Precondition: not
  // a bundle's.
  [[nodiscard]] int facet_turn(std::uint32_t solid, std::uint32_t leaf) const {
    return turns_.empty() ? make_facet_turn(solid, leaf) : turns_[solid][leaf];
  }
  [[nodiscard]] std::size_t solid_count() const { return solids_.size(); }
  [[nodiscard]] BeamKind kind() const { return bundle_ ? BeamKind::bundle : frames_[0].kind; }
  // Of a leaf in the picture; rays outside miss it.
  [[nodiscard]] LeafWindow window(std::uint32_t solid, std::uint32_t leaf) const {
    return windows_.empty() || leaf == kStartLeaf ? make_window(solid, leaf)
                                                  : windows_[solid][leaf];
  }
  // Holds what the rays through `rect` pass between two depths, in the solid's space. Precondition: rays are not
  // parallel; of a bundle, `rect` is all of it.
  [[nodiscard]] SpaceCell cell(std::uint32_t solid, const Rect& rect, Interval depths) const;
  // Surfaces, not of a bundle. A light's view remembers what it was asked: for one thread at a time.
  [[nodiscard]] const PlaneForm& plane(std::uint32_t solid, std::uint32_t index) const {
    return planes_.empty() ? remembered_plane(solid, index) : planes_[solid][index];
  }
  // Of a mesh's edge.
  [[nodiscard]] const Linear& side(std::uint32_t solid, std::uint32_t edge) const {
    return sides_.empty() ? remembered_side(solid, edge) : sides_[solid][edge];
  }
  [[nodiscard]] const QuadricForm& quadric(std::uint32_t solid, std::uint32_t index) const {
    return quadrics_.empty() ? remembered_quadric(solid, index) : quadrics_[solid][index];
  }

  // Calls visit with the surface's form, which is one type for a bundle, and another for all else.
  template <class Visit>
  auto with_plane(std::uint32_t solid, std::uint32_t index, const Visit& visit) const {
    return bundle_ ? visit(bundle_plane(solid, index)) : visit(plane(solid, index));
  }
  template <class Visit>
  auto with_quadric(std::uint32_t solid, std::uint32_t index, const Visit& visit) const {
    return bundle_ ? visit(bundle_quadric(solid, index)) : visit(quadric(solid, index));
  }
  template <class Visit>
  auto with_side(std::uint32_t solid, std::uint32_t edge, const Visit& visit) const {
    return bundle_ ? visit(make_side(bundle_in(solid), shape(solid).edges()[edge]))
                   : visit(side(solid, edge));
  }
  // Those of a bundle.
  [[nodiscard]] const RayBundle& bundle_in(std::uint32_t solid) const;
  [[nodiscard]] const BundlePlane& bundle_plane(std::uint32_t solid, std::uint32_t index) const;
  [[nodiscard]] const BundleQuadric& bundle_quadric(std::uint32_t solid, std::uint32_t index) const;

 private:
  // Picture point · weight = a linear map of the world's points, seen from the eye or cast by the light.
  struct Projection {
    Mat3d linear;  // rows: x, y, weight
    Vec3d offset;
  };
  [[nodiscard]] int make_facet_turn(std::uint32_t solid, std::uint32_t leaf) const;
  [[nodiscard]] LeafWindow make_window(std::uint32_t solid, std::uint32_t leaf) const;
  [[nodiscard]] LeafWindow make_bundle_window(std::uint32_t solid, const Box3d& box) const;
  [[nodiscard]] SpaceCell bundle_cell(std::uint32_t solid, Interval depths) const;
  [[nodiscard]] const PlaneForm& remembered_plane(std::uint32_t solid, std::uint32_t index) const;
  [[nodiscard]] const Linear& remembered_side(std::uint32_t solid, std::uint32_t edge) const;
  [[nodiscard]] const QuadricForm& remembered_quadric(std::uint32_t solid,
                                                      std::uint32_t index) const;

  std::span<const BeamSolid> solids_;
  bool is_eye_ = false;
  std::optional<LitPlane> mirror_;
  std::optional<RayBundle> bundle_;
  std::optional<Vec3d> apex_;  // in the world; nothing: parallel rays
  std::vector<ViewFrame> frames_;
  std::vector<Projection> projections_;  // by solid, from its own space
  std::vector<std::vector<LeafWindow>> windows_;
  std::vector<std::vector<PlaneForm>> planes_;
  std::vector<std::vector<QuadricForm>> quadrics_;
  std::vector<std::vector<Linear>> sides_;
  std::vector<std::vector<std::int8_t>> turns_;  // by leaf
  mutable std::unordered_map<std::uint32_t, RayBundle> asked_bundles_;
  mutable std::unordered_map<std::uint64_t, BundlePlane> asked_bundle_planes_;
  mutable std::unordered_map<std::uint64_t, BundleQuadric> asked_bundle_quadrics_;
  mutable std::unordered_map<std::uint64_t, Linear> asked_sides_;
  mutable std::unordered_map<std::uint64_t, PlaneForm> asked_planes_;
  mutable std::unordered_map<std::uint64_t, QuadricForm> asked_quadrics_;
};

}  // namespace arris
