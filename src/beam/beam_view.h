// beam_view.h — planes and quadrics as all rays of a picture see them
// What       A ray is origin + depth · direction, where the picture's x and y move the one or the other:
//            Origin fixed (an eye, or a point light): direction is linear in x and y, depth is along the view.
//            Direction fixed (a directional light): origin / weight moves over the plane that is lit, and depth is in
//            units of 1 / weight.
//            Along each ray a plane's height is height + depth · slope, a quadric's value is
//            value + 2 depth · half_slope + depth² · curvature, with polynomials of x and y that this file makes.
// Guarantee  every polynomial holds that of real arithmetic on the doubles that describe camera and solids, for kind
//            eye and either kind of light view but for the rounding of the lit plane (tests/beam/beam_view_test.cpp)
// Frames     depths are the same in the world and in each solid
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "beam/polynomial.h"
#include "csg/csg_solid.h"

namespace arris {

using LinearVec = Vec3<Linear>;

// A solid where it stands.
struct BeamSolid {
  const CsgSolid* solid = nullptr;
  Affine3d object_from_world;
};

// The eye: world rays through picture points, position + depth (corner + x step_x + y step_y).
struct EyeRays {
  Vec3d position;
  Vec3d corner, step_x, step_y;
};

// Rays in the space of one solid.
struct ViewFrame {
  LinearVec origin, direction;
  Linear weight{1, 0, 0};
  bool direction_fixed = false;
};

struct PlaneForm {
  Linear height, slope;
};
struct QuadricForm {
  Quadratic value, curvature;
  Linear half_slope;
  Quadratic discriminant;  // half_slope² - value · curvature: negative where the ray misses
  Linear along;  // the origin's z in the quadric's own frame: which half of a double cone it is in
};

PlaneForm make_form(const ViewFrame& frame, const CsgPlane& plane);
QuadricForm make_form(const ViewFrame& frame, const CsgQuadric& quadric);

ViewFrame make_eye_frame(const EyeRays& eye, const BeamSolid& solid);

// Signs of these say how two depths along a ray compare; see beam_view.cpp for the derivations.
// Depth at a minus depth at b, times the slopes of both.
Quadratic plane_before_plane(const PlaneForm& a, const PlaneForm& b, bool direction_fixed);
// The quadric's value where the ray meets the plane, times slope².
Quadratic quadric_at_plane(const QuadricForm& q, const PlaneForm& p, bool direction_fixed);
// Depth at the plane minus that of the middle between the roots, times slope · curvature.
Quadratic plane_beyond_middle(const QuadricForm& q, const PlaneForm& p, bool direction_fixed);

// The rays from a light to a plane that the eye sees: picture points are those of the eye's picture.
struct LitPlane {
  std::uint32_t solid = 0, plane = 0;
};
struct LightPlace {
  Vec3d position;   // of a point light
  Vec3d direction;  // in which a directional light travels, any length
  bool is_directional = false;
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

  [[nodiscard]] const CsgSolid& solid(std::uint32_t index) const { return *solids_[index].solid; }
  [[nodiscard]] std::size_t solid_count() const { return solids_.size(); }
  [[nodiscard]] bool direction_fixed() const { return frames_[0].direction_fixed; }
  [[nodiscard]] PlaneForm plane(std::uint32_t solid, std::uint32_t index) const {
    return planes_.empty()
               ? make_form(frames_[solid], this->solid(solid).surfaces().planes()[index])
               : planes_[solid][index];
  }
  [[nodiscard]] QuadricForm quadric(std::uint32_t solid, std::uint32_t index) const {
    return quadrics_.empty()
               ? make_form(frames_[solid], this->solid(solid).surfaces().quadrics()[index])
               : quadrics_[solid][index];
  }

 private:
  std::span<const BeamSolid> solids_;
  std::vector<ViewFrame> frames_;
  std::vector<std::vector<PlaneForm>> planes_;
  std::vector<std::vector<QuadricForm>> quadrics_;
};

}  // namespace arris
