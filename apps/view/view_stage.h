// view_stage.h — what the viewer shows: a model as it was opened, and what has been changed since
// What       ViewModel is what a file holds; ViewEdits are the changes, complete, so that any two states can be
//            compared; stage_view() makes the scene to render from both, and find_work() says how much of it is new
// Guarantee  same model and edits: same scene. The ground and the objects' numbers do not depend on what is visible or
//            moved.
// Errors     arris::Error, kind input
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "arris/edge_point.h"
#include "arris/render.h"
#include "arris/scene.h"
#include "render/staging.h"
#include "scene/scene_bounds.h"
#include "view/view_protocol.h"

namespace arris::view {

struct ViewModel {
  std::string name;            // to show
  std::filesystem::path file;  // empty: it came through a pipe
  bool is_scene_file = false;
  std::string text;  // of a scene file, as it was opened
  bool has_own_rounding =
      false;           // its file says how objects are rounded that say nothing themselves
  Scene scene;         // with image settings and rounding as options ask for; not staged
  StageOptions stage;  // lighting, ground, material and camera that options ask for
  EdgePointShader shader = EdgePointShader::gi;
};

struct ObjectEdit {
  bool visible = true;
  std::optional<RoundingSettings> rounding;  // empty: the scene's
  bool has_edited_radius = false;            // of `rounding`; the rest follows the scene's rounding
  Affine3d world_from_object;
  // What automatic radii take at most, by the first view of all: later ones, and other picture sizes, change nothing.
  std::optional<double> auto_radius;
  friend bool operator==(const ObjectEdit&, const ObjectEdit&) = default;
};

struct ViewEdits {
  PictureSize size;
  Camera camera;
  // The camera is still what this gives, and is again at another size; empty: it was set by hand.
  std::optional<FrameView::From> framed = FrameView::From::first;
  RoundingSettings rounding;
  LightChoice lighting = LightChoice::file;
  double strength = 1, rotation_deg = 0;  // of the lights
  std::optional<std::string> material;
  bool ground = true;
  EdgePointShader shader = EdgePointShader::gi;
  std::vector<ObjectEdit> objects;  // as in the model
  std::optional<RoundMethod> compared;
  double split = 0.5;
  bool overlay = false;
};

bool is_same(const Camera& a, const Camera& b);

// studio, sky and white, and file where the model has lights of its own.
std::vector<LightChoice> lightings_of(const ViewModel& model);
// Whether the light's rotation is seen: lamps stay where the file has them, and even light is the same from all sides.
bool can_rotate_light(const ViewModel& model, const ViewEdits& edits);

// As the model is when it is opened: framed, staged. Throws if there is no room for its camera or ground.
ViewEdits first_edits(const ViewModel& model);

// A change of one kind. Throws for objects and materials that are not there, and views that are none; `edits` is
// then as before. Messages that change nothing of the scene do nothing.
void apply_message(const ViewModel& model, const MessageKind& message, ViewEdits& edits);

// The camera that shows all visible objects; first: the model's own, or that shows all of it, as when it is opened.
Camera frame_view(const ViewModel& model, const ViewEdits& edits, FrameView::From from);
// A framed view in its picture's size. Where there is no room for that its camera stays.
void fit_camera(const ViewModel& model, ViewEdits& edits);

struct StagedView {
  Scene scene;
  std::vector<std::optional<std::uint32_t>>
      index_of;  // by the model's objects: where they are in the scene
};
// method: instead of the edits' own, for comparison.
StagedView stage_view(const ViewModel& model, const ViewEdits& edits,
                      std::optional<RoundMethod> method = {});

// Of the view a picture of beams, which are followed as far as the view's shader does; edges are sharp.
struct StagedBeams {
  Scene scene;
  BeamSettings settings;
};
StagedBeams stage_beams(const ViewModel& model, const ViewEdits& edits);

// Vertices of a path at most, as image settings have it: EdgePointShader::direct says so of them.
int path_depth(const ImageSettings& image, EdgePointShader shader);

// What has to be done so that `to` is shown where `from` is. Each kind needs all below it.
enum class ViewWork {
  none,
  redraw,      // split and overlay
  camera,      // and nothing else
  change,      // moves of objects, the rounding of the scene
  new_engine,  // picture size, shader, comparison: what was prepared stays
  prepare,     // all else, and any of these two where edges are rounded by meshes
};
ViewWork find_work(const ViewEdits& from, const ViewEdits& to);
// Meshes of rounded edges are among those of the scene: what was prepared serves for no other.
bool has_bevel_meshes(const ViewEdits& edits);
// The message (view_protocol.h) that makes the difference; of several the one that fails the most easily, of none "".
const char* find_change(const ViewEdits& from, const ViewEdits& to);

// In the world, where the file has them, by objects.
std::vector<Bounds> first_bounds(const ViewModel& model);
// The least inradius of its convex solids, in the world, where the file has it; empty: it has none, or is too large a
// mesh to look.
std::vector<std::optional<double>> first_inradii(const ViewModel& model);
// How large a radius all visible objects take that have none of their own; empty: there is no limit that is known.
std::optional<double> radius_limit(const ViewModel& model, const ViewEdits& edits,
                                   const std::vector<std::optional<double>>& first_inradii);
// Of a box that was moved with an object.
Bounds moved_bounds(const Bounds& bounds, const Affine3d& before, const Affine3d& now);

}  // namespace arris::view
