// toml_scene_parts.h — the pieces of read_toml_scene()
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "io/toml_document.h"
#include "io/toml_scene.h"

namespace arris {

// What all pieces work on.
struct TomlSceneContext {
  Scene& scene;
  TomlProblems& problems;
  const std::filesystem::path& base_directory;
  const LoadModel& load_model;

  // A file name of the scene file as a path.
  [[nodiscard]] std::filesystem::path resolve(const std::string& file) const {
    return base_directory / std::filesystem::path(file);
  }
};

// The table, or nothing and a report if the value is no table.
const TomlTable* as_toml_table(const TomlMember& member, TomlProblems& problems);

// Rounding as a table, a number or a text like "12%"; what it leaves out comes from
// `defaults`, whose method is not none.
std::optional<RoundingSettings> parse_toml_rounding(const TomlMember& member,
                                                    const RoundingSettings& defaults,
                                                    TomlProblems& problems);

// The elements of an array of tables; a report if it is something else.
const TomlArray& toml_elements_of(const TomlMember& member, TomlProblems& problems);

// [[….key]]: visits the keys of a camera, light or object with the number of their frame, in order.
void parse_toml_keys(TomlTableReader& owner, TomlProblems& problems,
                     const std::function<void(TomlTableReader& key, double frame)>& visit);

// translate, rotate and scale; what is missing is that of `own`.
ObjectKey parse_toml_motion(TomlTableReader& reader, const ObjectKey& own);
// These, or matrix; they go to `own` as well.
Affine3d parse_toml_transform(TomlTableReader& reader, ObjectKey& own);
bool has_toml_transform(TomlTableReader& reader);
void report_if_flat(TomlTableReader& reader, const Mat3d& linear, const char* key);

// The camera, and its keys into `animation`.
std::optional<Camera> parse_toml_camera(const TomlMember& member, Vec3d up, Animation& animation,
                                        TomlProblems& problems);

// [material.…]: fills scene.materials; number 0 is "default".
class TomlMaterials {
 public:
  explicit TomlMaterials(const TomlSceneContext& context) : context_(context) {}

  void parse(const TomlMember& member);
  [[nodiscard]] std::optional<MaterialId> find(const std::string& name) const;
  // Whether there is a [material.default].
  [[nodiscard]] bool has_default() const { return has_default_; }
  // All names, for "did you mean".
  [[nodiscard]] std::vector<std::string> names() const;

 private:
  void parse_one(const TomlMember& member);
  void parse_textures(TomlTableReader& reader, Material& material);
  std::optional<TextureId> find_or_load(const std::string& file, bool srgb, Texture::Wrap wrap_u,
                                        Texture::Wrap wrap_v, TomlPlace place);

  const TomlSceneContext& context_;
  bool has_default_ = false;
  std::map<std::string, MaterialId> ids_{{"default", MaterialId{0}}};
  std::map<std::tuple<std::string, bool, Texture::Wrap, Texture::Wrap>, TextureId> textures_;
};

// Into scene.lights, and its keys into scene.animation.
void parse_toml_light(const TomlValue& value, std::size_t number, const TomlSceneContext& context);
std::optional<Environment> parse_toml_environment(const TomlMember& member,
                                                  const TomlSceneContext& context);

// [[object]]: meshes of shapes and files are made once, whatever the number of objects.
class TomlObjects {
 public:
  TomlObjects(const TomlSceneContext& context, const TomlMaterials& materials)
      : context_(context), materials_(materials) {}

  void parse(const TomlValue& value, std::size_t number);

 private:
  struct Placement {
    std::string name;  // empty: not given
    std::optional<MaterialId> material;
    std::optional<RoundingSettings> rounding;
    std::optional<double> auto_radius;
    Affine3d world_from_object;
    ObjectTrack track;  // parts: what has been placed
    bool hidden = false;
    std::uint32_t entry = 0;  // number of the [[object]], from 0
  };
  // What an [[object.part]] says of an object of a file.
  struct PartEdit {
    bool hidden = false;
    std::optional<MaterialId> material;
    std::optional<RoundingSettings> rounding;
    std::optional<double> auto_radius;
    std::optional<Affine3d> file_from_part;  // instead of where the file has it
  };
  struct Model {
    std::vector<Object> objects;  // ids are the scene's
    std::string stem;
  };

  Placement parse_placement(TomlTableReader& reader);
  std::optional<MaterialId> parse_material(TomlTableReader& reader) const;
  std::optional<RoundingSettings> parse_round(TomlTableReader& reader) const;
  // By the model's objects; empty: it has no [[object.part]].
  std::vector<PartEdit> parse_parts(TomlTableReader& owner, const Model& model);
  std::vector<ObjectKey> parse_keys(TomlTableReader& reader, const ObjectKey& own);
  void add_shape(TomlTableReader& reader, Placement& placement);
  void add_file(TomlTableReader& reader, Placement& placement);
  void place(Object object, Placement& placement);
  const Model* find_or_load(const std::string& file, TomlTableReader& reader);
  Model append(Scene model, const std::filesystem::path& path);
  void give_material(Object& object, MaterialId material);
  MeshId without_materials(MeshId id);
  CsgId with_material(CsgId id, MaterialId material);
  bool has_room(std::size_t objects, TomlTableReader& reader, const char* key) const;

  const TomlSceneContext& context_;
  const TomlMaterials& materials_;
  std::map<std::string, std::optional<Model>> models_;  // empty: could not be loaded
  std::map<std::string, MeshId> shapes_;                // by their parameters
  std::map<std::uint32_t, MeshId> plain_;  // by mesh: copies without triangle materials
  std::map<std::pair<std::uint32_t, std::uint32_t>, CsgId> plain_trees_;  // by tree and material
  std::size_t shape_triangles_ = 0;
};

}  // namespace arris
