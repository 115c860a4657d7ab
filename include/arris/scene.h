// scene.h — the scene as plain structs with ids
// What       what a file describes, before anything is built from it. Readers fill it,
//            validate_scene() checks it, prepare_scene() makes the renderer's structures.
// Units      scene units for lengths, radians, linear RGB, W/(m² sr); other units carry a suffix.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "arris/csg.h"
#include "arris/ids.h"
#include "arris/math.h"
#include "arris/shared_vector.h"

namespace arris {

// Two vertices of a mesh.
using VertexPair = std::array<std::uint32_t, 2>;

// An edge of a mesh with a rounding radius of its own.
struct EdgeRadius {
  VertexPair vertices{};  // of one of its triangles
  float radius = 0;       // in the mesh's units; 0: it stays sharp

  friend bool operator==(const EdgeRadius&, const EdgeRadius&) = default;
};

// Triangles in object space. Positions need not be welded: preparation welds them into solids.
struct Mesh {
  std::string name;
  std::vector<Vec3f> positions;
  std::vector<Triangle> triangles;
  std::vector<Vec3f> normals;                  // unit, one per position, or empty: flat shading
  std::vector<Vec2f> uvs;                      // one per position, or empty
  std::vector<MaterialId> triangle_materials;  // one per triangle, or empty: the object's
  // Set where the file says which edges are sharp: these, by the vertices of one of their triangles; no others, however
  // far they turn.
  std::optional<std::vector<VertexPair>> sharp_edges{};
  // Where objects are rounded: radii that go before the object's. Edges that would not be rounded stay so.
  std::vector<EdgeRadius> edge_radii{};
};

// 8-bit texels, row 0 at the top. uv (0,0) is the upper left corner (glTF's convention;
// the OBJ reader flips v).
struct Texture {
  enum class Wrap { repeat, mirror, clamp };
  std::string name;
  int width_px = 0;
  int height_px = 0;
  std::vector<std::array<std::uint8_t, 4>> texels;
  bool srgb = false;  // colour textures: decode R, G, B to linear; alpha always is linear
  Wrap wrap_u = Wrap::repeat;
  Wrap wrap_v = Wrap::repeat;
};

// glTF 2.0 metallic-roughness with ior, specular, transmission, clearcoat and emission. Textures
// multiply the factor beside them; channels as in glTF.
struct Material {
  std::string name;
  Rgb base_color{0.8F, 0.8F, 0.8F};
  float metallic = 0;
  float roughness = 0.5F;
  float ior = 1.5F;
  float specular = 1;
  Rgb specular_color{1, 1, 1};
  float transmission = 0;
  float clearcoat = 0;
  float clearcoat_roughness = 0;
  Rgb emission{0, 0, 0};  // radiance
  float opacity = 1;  // glTF alpha; below 1 the surface lets that share of light straight through
  std::optional<float> alpha_cutoff;  // glTF alphaMode MASK
  float normal_scale = 1;
  // If set, the material is the plain mix (1-w)·Lambert(base_color) + w·GGX(white, roughness), with
  // no Fresnel: Cycles' Diffuse and Glossy nodes under a Mix node. Metallic, ior, … are ignored.
  std::optional<float> glossy_mix;

  std::optional<TextureId> base_color_texture;           // RGB, A = opacity
  std::optional<TextureId> metallic_roughness_texture;   // G roughness, B metallic
  std::optional<TextureId> emission_texture;             // RGB
  std::optional<TextureId> normal_texture;               // tangent space
  std::optional<TextureId> transmission_texture;         // R
  std::optional<TextureId> clearcoat_texture;            // R
  std::optional<TextureId> clearcoat_roughness_texture;  // G
};

// The rounding radius of an object, in world units whatever the instance's scale.
struct AutoRadius {  // reads well at the picture's size, fits the part
  friend bool operator==(const AutoRadius&, const AutoRadius&) = default;
};
struct PercentOfInradius {
  double percent = 10;
  friend bool operator==(const PercentOfInradius&, const PercentOfInradius&) = default;
};
using Radius = std::variant<AutoRadius, double, PercentOfInradius>;

enum class RoundEdges { convex, concave, both };
// What becomes of edges beside which the radius has no room: they stay sharp and are reported, or get a smaller one.
enum class OnOverlap { report, clamp };

// Edges of an object that have a radius of their own: those for which all holds that is given.
struct EdgeRule {
  double radius = 0;     // world units; 0: they stay sharp
  bool is_part = false;  // the radius is a part of the object's
  // Least and most angle between the normals of the two faces, in radians.
  std::optional<std::array<double, 2>> turn;
  RoundEdges kind = RoundEdges::both;  // of those that are rounded at all
  // Corners of a box in which both ends lie, in the object's space.
  std::optional<std::array<Vec3d, 2>> box;
  // One of these segments has the edge on it, in the object's space; empty: no matter.
  std::vector<std::array<Vec3d, 2>> segments;

  friend bool operator==(const EdgeRule&, const EdgeRule&) = default;
};
enum class RoundMethod { none, exact, shader, mesh };

// The bevel shader's parameters (Anders; names as in the blog). Lengths in world units.
struct BevelShaderSettings {
  std::optional<double> delta;    // depth of the sampling origin; empty: the rounding radius
  std::optional<double> perturb;  // spread of the directions around N; empty: 1
  int divisions = 3;              // Divisions³ rays
  friend bool operator==(const BevelShaderSettings&, const BevelShaderSettings&) = default;
};

struct RoundingSettings {
  RoundMethod method = RoundMethod::none;
  Radius radius = AutoRadius{};
  RoundEdges edges = RoundEdges::convex;
  double min_angle = radians(30);  // turns below are part of a smooth surface
  int subdivisions = 3;            // method mesh
  BevelShaderSettings shader;      // method shader
  OnOverlap on_overlap = OnOverlap::report;
  std::vector<EdgeRule> rules;  // method exact; the last that holds counts
  friend bool operator==(const RoundingSettings&, const RoundingSettings&) = default;
};

// Which part of which [[object]] of a scene file an object is, for who writes the file again; both are counted from 0.
struct ObjectOrigin {
  std::uint32_t entry = 0, part = 0;
};

struct Object {
  std::string name;
  MeshId mesh;
  std::optional<CsgId> csg;  // set: the object is this solid, and `mesh` says nothing
  MaterialId material;
  Affine3d world_from_object;
  std::optional<RoundingSettings> rounding;  // empty: the scene's default
  // World units: the most that AutoRadius takes; empty: what reads well in the scene's picture.
  std::optional<double> auto_radius;
  ObjectOrigin origin;
};

// A soft ground: a disc across the scene's up, opaque in the middle, gone at the radius.
struct Ground {
  Vec3d center;
  double radius = 1;
  friend bool operator==(const Ground&, const Ground&) = default;
};

inline constexpr double kMinFovDeg = 0.01, kMaxFovDeg = 178;
inline constexpr double kMostStops = 64;  // of exposure, up and down

struct Camera {
  Vec3d position;
  Vec3d target;
  Vec3d up{0, 0, 1};
  double fov_deg = 35;  // vertical
};

struct PointLight {
  Vec3d position;
  Rgb intensity{1, 1, 1};  // W/sr
};
struct SpotLight {
  Vec3d position;
  Vec3d direction{0, 0, -1};  // away from the light; need not be unit
  Rgb intensity{1, 1, 1};     // W/sr on the axis
  double inner_angle = 0;     // from the axis; full intensity inside
  double outer_angle = kPi / 4;
};
struct DirectionalLight {
  Vec3d direction{0, 0, -1};  // in which the light travels
  Rgb irradiance{1, 1, 1};    // W/m² on a surface that faces it
};
// Emits from the side of cross(edge_u, edge_v).
struct AreaLight {
  Vec3d corner;
  Vec3d edge_u{1, 0, 0};
  Vec3d edge_v{0, 1, 0};
  Rgb radiance{1, 1, 1};
  bool visible_to_camera = true;
};
using Light = std::variant<PointLight, SpotLight, DirectionalLight, AreaLight>;

struct ConstantEnvironment {
  Rgb radiance{0, 0, 0};
  friend bool operator==(const ConstantEnvironment&, const ConstantEnvironment&) = default;
};
// Clear sky after Preetham, Shirley and Smits, "A Practical Analytic Model for Daylight" (1999), with its sun.
struct SkyEnvironment {
  Vec3d sun_direction{0.4, -0.5, 0.77};  // towards the sun; need not be unit
  double turbidity = 3;
  double strength = 1;
  bool sun = true;
  Vec3d up{0, 0, 1};
  friend bool operator==(const SkyEnvironment&, const SkyEnvironment&) = default;
};
// Equirectangular map seen from its middle: the centre column looks along the map's +x, the column a
// quarter of the width to its right along -y (as Blender has it). The map's z is taken to `up` by the
// shortest rotation, then `rotation` turns it counter-clockwise seen from above.
struct HdrEnvironment {
  std::string name;
  int width_px = 0;
  int height_px = 0;
  SharedVector<Rgb> radiance;  // row 0 is the zenith
  double strength = 1;
  double rotation = 0;  // about up
  Vec3d up{0, 0, 1};
  friend bool operator==(const HdrEnvironment&, const HdrEnvironment&) = default;
};
// Soft three-light room for product pictures; the program's default.
struct StudioEnvironment {
  double strength = 1;
  double rotation = 0;  // about up, counter-clockwise seen from above
  Vec3d up{0, 0, 1};
  friend bool operator==(const StudioEnvironment&, const StudioEnvironment&) = default;
};
using Environment =
    std::variant<ConstantEnvironment, SkyEnvironment, HdrEnvironment, StudioEnvironment>;

struct ImageSettings {
  int width_px = 1280;
  int height_px = 720;
  int samples_per_pixel = 64;
  int max_depth = 8;    // path vertices after the camera's
  double exposure = 0;  // stops, applied before tone mapping
  enum class Filter { box, tent, gaussian, blackman_harris } filter = Filter::blackman_harris;
};

// Of translation, angle or scale, how keys are joined.
enum class Interpolation {
  smooth,  // Catmull-Rom splines; keys may be unevenly far apart
  linear,
};
inline constexpr double kMaxFrame = 1e6;  // of numbers of frames, and of keys down to minus this
inline constexpr double kLeastKeyDistance = 1e-3;  // of the keys of one thing, in frames

struct CameraKey {
  double frame = 0;
  Camera camera;
};

struct ObjectKey {
  double frame = 0;
  Vec3d translate, rotate_deg,
      scale{1, 1, 1};  // scaled first, then turned about x, y and z, then moved
};
// Objects that move together: all those of a file.
struct ObjectTrack {
  struct Part {
    ObjectId object;
    Affine3d placed_from_object;  // before the key's placement
  };
  std::vector<Part> parts;
  std::vector<ObjectKey> keys;
};

struct LightKey {
  double frame = 0;
  Vec3d position;
  Vec3d aim;  // a point or a direction, as LightTrack::aim says
  Vec3d color{1, 1, 1};
  double strength = 1;  // times the color: intensity, irradiance or radiance
  Vec2d size{1, 1};     // of area lights
};
struct LightTrack {
  std::size_t light = 0;  // of Scene::lights: its kind, and what keys don't have
  enum class Aim { target, direction } aim = Aim::direction;
  Vec3d up{0, 0, 1};  // of area lights: where their height goes
  std::vector<LightKey> keys;
};

// What moves from frame to frame. The keys of each thing are in the order of their frames; before the first and after
// the last the thing stays.
struct Animation {
  Interpolation interpolation = Interpolation::smooth;
  std::vector<CameraKey> camera;
  std::vector<ObjectTrack> objects;
  std::vector<LightTrack> lights;

  [[nodiscard]] bool has_keys() const {
    return !camera.empty() || !objects.empty() || !lights.empty();
  }
};

struct Scene {
  std::string name;
  SharedVector<Mesh> meshes;
  SharedVector<CsgTree> csg_trees;
  SharedVector<Material> materials;  // never empty after load
  SharedVector<Texture> textures;
  std::vector<Object> objects;
  std::vector<Light> lights;
  Animation animation;                       // camera, objects and lights are those of frame 0
  std::optional<Camera> camera;              // empty: framed automatically
  std::optional<Environment> environment;    // empty: --lighting decides
  std::optional<RoundingSettings> rounding;  // default of all objects
  std::optional<Ground> ground;              // empty: render/staging.h decides
  ImageSettings image;
  // The world's up for automatic framing, sky, studio and ground; glTF: {0, 1, 0}.
  Vec3d up{0, 0, 1};
  std::vector<std::string> notes;  // what a reader left out, one line each, for the user
};

// The scene at the time of a frame, which may lie between two: camera, transforms and lights as the keys have them.
// Between keys it may be invalid (a camera that passes its target): validate_scene() says so.
Scene scene_at(const Scene& scene, double frame);

}  // namespace arris
