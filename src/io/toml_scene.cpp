#include "io/toml_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "arris/error.h"
#include "arris/image.h"
#include "io/mesh_scene.h"
#include "io/toml_scene_parts.h"
#include "scene/limits.h"
#include "scene/validate_placement.h"

namespace arris {
namespace {

using Filter = ImageSettings::Filter;
constexpr std::array<TomlWord<Filter>, 4> kFilters = {
    {{"box", Filter::box},
     {"tent", Filter::tent},
     {"gaussian", Filter::gaussian},
     {"blackman_harris", Filter::blackman_harris}}};

constexpr std::array<TomlWord<Interpolation>, 2> kInterpolations = {
    {{"smooth", Interpolation::smooth}, {"linear", Interpolation::linear}}};

ImageSettings parse_image(const TomlMember& member, TomlProblems& problems) {
  ImageSettings image;
  const TomlTable* table = as_toml_table(member, problems);
  if (table == nullptr) return image;
  TomlTableReader reader(*table, member.value.place, "[image]", problems);
  if (const auto size = reader.vec2("size", {1, double(kMaxPictureSide)})) {
    if (size->x != std::floor(size->x) || size->y != std::floor(size->y)) {
      reader.report("size", "must be whole numbers of pixels");
    }
    if (size->x * size->y > double(kMaxPicturePixels)) {
      reader.report("size",
                    fmt::format("is too large; use at most {} pixels in all", kMaxPicturePixels));
    }
    image.width_px = int(size->x);
    image.height_px = int(size->y);
  }
  image.samples_per_pixel =
      reader.integer("samples", 1, kMostSamples).value_or(image.samples_per_pixel);
  image.max_depth = reader.integer("max_depth", 0, 1024).value_or(image.max_depth);
  image.exposure = reader.number("exposure", {-kMostStops, kMostStops}).value_or(image.exposure);
  image.filter = reader.word<Filter>("filter", kFilters).value_or(image.filter);
  reader.report_unknown();
  return image;
}

std::optional<Ground> parse_ground(const TomlMember& member, TomlProblems& problems) {
  const TomlTable* table = as_toml_table(member, problems);
  if (table == nullptr) return std::nullopt;
  TomlTableReader reader(*table, member.value.place, "[ground]", problems);
  for (const char* key : {"center", "radius"}) {
    if (!reader.has(key)) reader.report_missing(key);
  }
  Ground ground;
  ground.center = reader.vec3("center", kTomlCoordinate).value_or(ground.center);
  ground.radius = reader.number("radius", kTomlPositive).value_or(ground.radius);
  reader.report_unknown();
  return ground;
}

class SceneParser {
 public:
  SceneParser(const TomlTable& root, const TomlSceneContext& context)
      : reader_(root, {}, "", context.problems), context_(context) {}

  // In the order in which the parts need each other.
  void parse() {
    Scene& scene = context_.scene;
    TomlProblems& problems = context_.problems;
    if (const auto up = reader_.direction("up")) scene.up = normalize(*up);
    if (const auto* image = reader_.find("image")) scene.image = parse_image(*image, problems);
    if (const auto* camera = reader_.find("camera")) {
      scene.camera = parse_toml_camera(*camera, scene.up, scene.animation, problems);
    }
    if (const auto* animation = reader_.find("animation")) parse_animation(*animation);
    if (const auto* environment = reader_.find("environment")) {
      scene.environment = parse_toml_environment(*environment, context_);
    }
    parse_lights();
    if (const auto* round = reader_.find("round")) {
      RoundingSettings defaults;
      defaults.method = RoundMethod::exact;
      scene.rounding = parse_toml_rounding(*round, defaults, problems);
    }
    if (const auto* ground = reader_.find("ground")) scene.ground = parse_ground(*ground, problems);
    TomlMaterials materials(context_);
    if (const auto* material = reader_.find("material")) materials.parse(*material);
    parse_objects(materials);
    reader_.report_unknown();
  }

 private:
  void parse_animation(const TomlMember& member) {
    const TomlTable* table = as_toml_table(member, context_.problems);
    if (table == nullptr) return;
    TomlTableReader reader(*table, member.value.place, "[animation]", context_.problems);
    Animation& animation = context_.scene.animation;
    animation.interpolation = reader.word<Interpolation>("interpolation", kInterpolations)
                                  .value_or(animation.interpolation);
    reader.report_unknown();
  }

  void parse_lights() {
    const TomlMember* lights = reader_.find("light");
    if (lights == nullptr) return;
    std::size_t number = 0;
    for (const TomlValue& value : toml_elements_of(*lights, context_.problems)) {
      parse_toml_light(value, ++number, context_);
    }
  }

  void parse_objects(const TomlMaterials& materials) {
    const TomlMember* objects = reader_.find("object");
    if (objects == nullptr) {
      context_.problems.add({}, "the scene has no object; add an [[object]]");
      return;
    }
    TomlObjects parser(context_, materials);
    std::size_t number = 0;
    for (const TomlValue& value : toml_elements_of(*objects, context_.problems)) {
      parser.parse(value, ++number);
    }
    if (context_.problems.empty() && context_.scene.objects.empty()) {
      context_.problems.add(objects->place, number == 0
                                                ? "the scene has no object; add an [[object]]"
                                                : "all objects are hidden; show one");
    }
  }

  TomlTableReader reader_;
  const TomlSceneContext& context_;
};

}  // namespace

const TomlTable* as_toml_table(const TomlMember& member, TomlProblems& problems) {
  if (const auto* table = std::get_if<TomlTable>(&member.value.data)) return table;
  problems.add(member.place,
               fmt::format("{}: must be a table, written [{}]", member.key, member.key));
  return nullptr;
}

Scene read_toml_scene(std::string_view text, const std::string& name,
                      const std::filesystem::path& base_directory, const LoadModel& load_model) {
  const TomlTable root = parse_toml(text, name);
  Scene scene;
  scene.name = name_from_file(name);
  scene.materials.emplace_back().name = "default";
  TomlProblems problems(name);
  const TomlSceneContext context{scene, problems, base_directory, load_model};
  SceneParser(root, context).parse();
  problems.throw_if_any();
  if (!scene.animation.has_keys()) return scene;
  Scene first = scene_at(scene, 0);
  const std::vector<std::string> wrong = validate_placement(first, NumberedFrom::one);
  if (wrong.empty()) return first;
  throw Error(Error::Kind::input, name + ": frame 0",
              fmt::format("{}; move the keys around it", fmt::join(wrong, "\n  ")));
}

}  // namespace arris
