#include "rounding/scenes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <stdexcept>
#include <utility>

#include "rounding/cell_pieces.h"
#include "rounding/convex_pieces.h"

namespace arris::bench {
namespace {

constexpr std::array<Rgb, 5> kColors{Rgb{0.70F, 0.10F, 0.08F},
                                     {0.08F, 0.25F, 0.62F},
                                     {0.80F, 0.62F, 0.10F},
                                     {0.12F, 0.45F, 0.16F},
                                     {0.75F, 0.75F, 0.72F}};
constexpr double kSceneRadius = 0.06;
constexpr double kBrickRadius = 0.04;

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * (double(engine_() >> 11) * 0x1p-53);
  }
  std::size_t below(std::size_t count) { return std::size_t(uniform(0, double(count))); }
  Mat3d rotation() {
    const Vec3d x = direction();
    const Vec3d y = normalize(cross(x, direction()));
    return {x, y, cross(x, y)};
  }

 private:
  Vec3d direction() {
    const double z = uniform(-1, 1), angle = uniform(0, 2 * kPi), r = std::sqrt(1 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
  }
  std::mt19937_64 engine_;
};

Mesh named_mesh(std::string name) {
  Mesh mesh;
  mesh.name = std::move(name);
  return mesh;
}

RoundingSettings rounding_by(double radius) {
  RoundingSettings settings;
  settings.method = RoundMethod::exact;
  settings.radius = radius;
  return settings;
}

MaterialId add_material(Scene& scene, const std::string& name, Rgb color) {
  Material m;
  m.name = name;
  m.base_color = color;
  m.roughness = 0.2F;
  m.glossy_mix = 0.1F;
  scene.materials.push_back(m);
  return {std::uint32_t(scene.materials.size() - 1)};
}

ObjectId add_object(Scene& scene, Mesh mesh, MaterialId material) {
  Object object;
  object.name = mesh.name;
  object.mesh = {std::uint32_t(scene.meshes.size())};
  object.material = material;
  scene.meshes.push_back(std::move(mesh));
  scene.objects.push_back(std::move(object));
  return {std::uint32_t(scene.objects.size() - 1)};
}

void leave_sharp(Scene& scene, ObjectId object) {
  scene.objects[object.index].rounding = RoundingSettings{};
}

// Colours first, so that MaterialId{0..4} are the pieces' colours; then the ground, sky and lamp.
Scene make_stage(double ground_size, Vec3d light_target) {
  Scene scene;
  for (std::size_t i = 0; i < kColors.size(); ++i)
    add_material(scene, "color" + std::to_string(i), kColors[i]);
  const MaterialId grey = add_material(scene, "ground", {0.5F, 0.5F, 0.5F});
  const auto h = float(ground_size / 2);
  Mesh ground = named_mesh("ground");
  ground.positions = {{-h, -h, 0}, {h, -h, 0}, {h, h, 0}, {-h, h, 0}};
  ground.triangles = {{0, 1, 2}, {0, 2, 3}};
  leave_sharp(scene, add_object(scene, std::move(ground), grey));
  scene.environment = ConstantEnvironment{{0.217F, 0.259F, 0.35F}};
  const Vec3d middle{-22, -24, 34};
  const Vec3d n = normalize(light_target - middle);
  const Vec3d u = normalize(cross(Vec3d(0, 0, 1), n)) * 16.0, v = cross(n, u);
  scene.lights.push_back(AreaLight{.corner = middle - (u + v) * 0.5,
                                   .edge_u = u,
                                   .edge_v = v,
                                   .radiance = Rgb(21.484375F),
                                   .visible_to_camera = false});
  scene.image = {.width_px = 960, .height_px = 540, .samples_per_pixel = 16, .max_depth = 8};
  scene.image.filter = ImageSettings::Filter::box;
  return scene;
}

void round_all(BenchScene& bench) {
  bench.scene.rounding = rounding_by(bench.radius);
  bench.scene.name = bench.name;
}

// --- Scenes 1 to 3 ------------------------------------------------------------------------------

enum class Kind { box, tetrahedron, prism, dodecahedron };

// 20.7 triangles a piece on average.
std::vector<Kind> shuffled_kinds(int count, Random& random) {
  std::vector<Kind> kinds;
  const auto add = [&](double share, Kind kind) {
    kinds.insert(kinds.end(), std::size_t(std::lround(share * count)), kind);
  };
  add(0.27, Kind::box);
  add(0.15, Kind::tetrahedron);
  add(0.25, Kind::prism);
  add(0.33, Kind::dodecahedron);
  for (std::size_t i = kinds.size(); i > 1; --i) std::swap(kinds[i - 1], kinds[random.below(i)]);
  return kinds;
}

Piece random_piece(Kind kind, Random& random) {
  const double s = random.uniform(0.8, 1.15);
  const double a = random.uniform(0.5, 0.9), b = random.uniform(0.5, 0.9);
  switch (kind) {
    case Kind::box:
      return make_box(Vec3d(-0.4, -a / 2, -b / 2) * s, Vec3d(0.4, a / 2, b / 2) * s);
    case Kind::tetrahedron:
      return make_tetrahedron(0.4 * s);
    case Kind::prism:
      return make_prism(6, 0.42 * s, -a / 2 * s, a / 2 * s);
    case Kind::dodecahedron:
      return make_dodecahedron(0.52 * s);
  }
  return {};
}

struct Layout {
  int columns = 0, rows = 0;
  double pitch = 1.35;   // between neighbours
  double spread = 0.12;  // of the random displacement
  double layer = 0.75;   // height between layers
};

// Lays the pieces layer on layer; rows first, then columns, then up.
void scatter(Scene& scene, int count, const Layout& layout, Random& random) {
  const std::vector<Kind> kinds = shuffled_kinds(count, random);
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    const int at = int(k) % (layout.columns * layout.rows),
              up = int(k) / (layout.columns * layout.rows);
    const int row = at / layout.columns;
    const Piece piece = random_piece(kinds[k], random);
    Affine3d placed{random.rotation(), {}};
    const double half =
        up % 2 == 0 ? 0 : 0.5;  // every other layer lies in the gaps of the one below
    placed.translation = {(at % layout.columns - 0.5 * (layout.columns - 1) + half) * layout.pitch +
                              random.uniform(-layout.spread, layout.spread),
                          (row - 0.5 * (layout.rows - 1) + half) * layout.pitch +
                              random.uniform(-layout.spread, layout.spread),
                          0};
    placed.translation.z = 0.002 + up * layout.layer - lowest_z(piece, placed);
    Mesh mesh = named_mesh("piece" + std::to_string(k));
    append(mesh, piece, placed);
    add_object(scene, std::move(mesh), {std::uint32_t(random.below(kColors.size()))});
  }
}

BenchScene make_scene1() {
  BenchScene bench{"scene1", "Scene 1", make_stage(120, {0, -8, 0}), kSceneRadius};
  Random random(1);
  scatter(bench.scene, 2000, {.columns = 50, .rows = 40}, random);
  bench.scene.camera = Camera{.position = {4, -37, 17}, .target = {0, -14.5, 0}, .fov_deg = 30};
  round_all(bench);
  return bench;
}

// A heap seen from near: pieces fill the picture.
BenchScene make_scene2() {
  BenchScene bench{"scene2", "Scene 2", make_stage(120, {0, -8, 0}), 0.1};
  Random random(2);
  scatter(bench.scene, 5000, {.columns = 50, .rows = 25, .pitch = 1.05}, random);
  bench.scene.camera = Camera{.position = {2, -23, 12}, .target = {0, -8, 1}, .fov_deg = 24};
  round_all(bench);
  return bench;
}

BenchScene make_scene3() {
  BenchScene bench{"scene3", "Scene 3", make_stage(200, {0, -8, 0}), kSceneRadius};
  Random random(3);
  scatter(bench.scene, 12160, {.columns = 80, .rows = 76, .pitch = 1.1}, random);
  bench.scene.camera = Camera{.position = {6, -66, 27}, .target = {0, -22, 0}, .fov_deg = 30};
  round_all(bench);
  return bench;
}

// --- Blocks --------------------------------------------------------------------------------------

constexpr double kPitch = 0.8;  // between knobs
constexpr double kBrickHeight = 0.96;
constexpr int kColumns = 18, kRows = 14, kBricks = 726, kTallest = 6;

// A brick of 2 by 4 knobs whose lower corner is `corner`, counted in bricks. Faces of neighbours coincide: all
// coordinates are multiples of whole numbers. Knobs are open below and sunk into the brick, as toys are hollow.
Mesh make_brick(const std::string& name, int column, int row, int level) {
  Mesh mesh = named_mesh(name);
  const auto plane = [](int index, double step) { return index * step; };
  const int left = 2 * (column - kColumns / 2), front = 4 * (row - kRows / 2);
  const Vec3d low{plane(left, kPitch), plane(front, kPitch), plane(level, kBrickHeight)};
  const Vec3d high{plane(left + 2, kPitch), plane(front + 4, kPitch),
                   plane(level + 1, kBrickHeight)};
  append(mesh, make_box(low, high), {});
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 4; ++j) {
      const Affine3d placed{{}, {low.x + (i + 0.5) * kPitch, low.y + (j + 0.5) * kPitch, high.z}};
      append(mesh, make_prism(16, 0.24, -0.1, 0.18, Bottom::open), placed);
    }
  return mesh;
}

BenchScene make_blocks() {
  BenchScene bench{"blocks", "Blocks", make_stage(160, {0, 0, 0}), kBrickRadius};
  Random random(4);
  std::vector<int> height(std::size_t(kColumns * kRows), 1);
  for (int left = kBricks - kColumns * kRows; left > 0;) {
    int& h = height[random.below(height.size())];
    if (h == kTallest) continue;
    ++h;
    --left;
  }
  for (int column = 0; column < kColumns; ++column)
    for (int row = 0; row < kRows; ++row)
      for (int level = 0; level < height[std::size_t(column) * kRows + std::size_t(row)]; ++level)
        add_object(
            bench.scene,
            make_brick("brick" + std::to_string(bench.scene.objects.size()), column, row, level),
            {std::uint32_t(random.below(kColors.size()))});
  bench.scene.camera = Camera{.position = {17, -34, 20}, .target = {0.3, -2.5, 0.3}, .fov_deg = 34};
  round_all(bench);
  return bench;
}

// --- Cornell box ---------------------------------------------------------------------------------

// The room is one solid of air seen from inside: rounding it fills its inside corners.
Mesh make_room(double side, MaterialId white, MaterialId red, MaterialId green) {
  Mesh room = named_mesh("room");
  append(room, make_box({0, 0, 0}, {side, side, side}), {});
  for (const Triangle& t : room.triangles) {
    const auto all_at = [&](double x) {
      return std::all_of(t.begin(), t.end(),
                         [&](std::uint32_t v) { return room.positions[v].x == float(x); });
    };
    room.triangle_materials.push_back(all_at(0) ? red : all_at(side) ? green : white);
  }
  return room;
}

BenchScene make_cornell() {
  BenchScene bench{"cornell", "Cornell box", {}, 0.1};
  Scene& scene = bench.scene;
  const MaterialId white = add_material(scene, "white", {0.73F, 0.73F, 0.73F});
  const MaterialId red = add_material(scene, "red", {0.63F, 0.06F, 0.05F});
  const MaterialId green = add_material(scene, "green", {0.15F, 0.48F, 0.09F});
  const ObjectId room = add_object(scene, make_room(5.5, white, red, green), white);
  const auto put = [&](const std::string& name, const Piece& piece, Vec3d at, double turn_deg) {
    const double c = std::cos(radians(turn_deg)), s = std::sin(radians(turn_deg));
    Affine3d placed{{{c, s, 0}, {-s, c, 0}, {0, 0, 1}}, {at.x, at.y, 0}};
    placed.translation.z = at.z - lowest_z(piece, placed);
    Mesh mesh = named_mesh(name);
    append(mesh, piece, placed);
    add_object(scene, std::move(mesh), white);
  };
  put("tall", make_box({-0.8, -0.8, 0}, {0.8, 0.8, 3.3}), {1.8, 3.6, 0}, 17);
  put("short", make_box({-0.8, -0.8, 0}, {0.8, 0.8, 1.65}), {3.8, 2.4, 0}, -17);
  put("prism", make_prism(6, 0.55, 0, 0.7), {1.4, 1.5, 0}, 10);
  put("tetrahedron", make_tetrahedron(0.4), {3.8, 2.4, 1.65}, 40);
  scene.lights.push_back(AreaLight{.corner = {2.1, 2.1, 5.45},
                                   .edge_u = {0, 1.3, 0},
                                   .edge_v = {1.3, 0, 0},
                                   .radiance = {17, 12, 6}});
  scene.environment = ConstantEnvironment{};
  scene.camera = Camera{.position = {2.75, 0.5, 2.75}, .target = {2.75, 5.5, 2.6}, .fov_deg = 88};
  scene.image = {.width_px = 960, .height_px = 540, .samples_per_pixel = 16, .max_depth = 8};
  scene.image.filter = ImageSettings::Filter::box;
  round_all(bench);
  scene.objects[room.index].rounding = rounding_by(0.4);
  return bench;
}

// --- Solids with concave edges ------------------------------------------------------------------

// Seen from the front, the side and above, from as far as `distance`.
BenchScene make_creased(BenchScene bench, const Piece& piece, double distance) {
  Mesh mesh = named_mesh(bench.name);
  append(mesh, piece, {});
  add_object(bench.scene, std::move(mesh), MaterialId{1});
  Vec3d low = piece.vertices[0], high = low;
  for (const Vec3d& p : piece.vertices) {
    low = min(low, p);
    high = max(high, p);
  }
  const Vec3d middle = (low + high) * 0.5;
  bench.scene.camera = Camera{.position = middle + normalize(Vec3d(0.9, -1.6, 1.2)) * distance,
                              .target = middle,
                              .fov_deg = 30};
  round_all(bench);
  return bench;
}

BenchScene make_one_bracket() {
  return make_creased({"bracket", "Bracket", make_stage(120, {}), 0.15}, make_bracket(3, 1, 2), 8);
}

BenchScene make_one_boss() {
  return make_creased({"boss", "Boss", make_stage(120, {}), 0.15}, make_boss(), 9);
}

BenchScene make_pocket_plate() {
  return make_creased({"pockets", "Pockets", make_stage(240, {}), 0.12}, make_pockets(20), 70);
}

// 3,000 in one mesh.
BenchScene make_brackets() {
  BenchScene bench{"brackets", "Brackets", make_stage(240, {}), kSceneRadius};
  Random random(5);
  const Piece piece = make_bracket(0.9, 0.3, 0.6);
  Mesh mesh = named_mesh("brackets");
  for (int i = 0; i < 3000; ++i) {
    Affine3d placed{random.rotation(), {}};
    placed.translation = {(i % 60 - 29.5) * 1.5, (double(i) / 60 - 24.5) * 1.5,
                          0.002 - lowest_z(piece, placed)};
    append(mesh, piece, placed);
  }
  add_object(bench.scene, std::move(mesh), MaterialId{1});
  bench.scene.camera = Camera{.position = {4, -50, 22}, .target = {0, -18, 0}, .fov_deg = 30};
  round_all(bench);
  return bench;
}

const std::vector<std::pair<std::string, std::function<BenchScene()>>>& makers() {
  static const std::vector<std::pair<std::string, std::function<BenchScene()>>> kMakers{
      {"scene1", make_scene1}, {"scene2", make_scene2},        {"scene3", make_scene3},
      {"blocks", make_blocks}, {"cornell", make_cornell},      {"bracket", make_one_bracket},
      {"boss", make_one_boss}, {"pockets", make_pocket_plate}, {"brackets", make_brackets}};
  return kMakers;
}

}  // namespace

std::vector<std::string> bench_scene_names() {
  std::vector<std::string> names;
  for (const auto& [name, make] : makers()) names.push_back(name);
  return names;
}

BenchScene make_bench_scene(const std::string& name) {
  for (const auto& [known, make] : makers())
    if (known == name) return make();
  std::string message = "unknown scene \"" + name + "\"; there are";
  for (const std::string& known : bench_scene_names()) message += " " + known;
  throw std::invalid_argument(message);
}

std::vector<Camera> make_camera_move(int frames) {
  std::vector<Camera> move;
  for (int i = 0; i < frames; ++i) {
    const double u = frames > 1 ? double(i) / (frames - 1) : 0;
    const double near = std::sin(kPi * u);  // 0 far, 1 near, 0 far
    const double angle = radians(-70 + 60 * u);
    const double distance = 42 * std::pow(1 - 0.9 * near, 1.0);
    const Vec3d target = Vec3d(0.3, -2.5, 0.3) * (1 - near) + Vec3d(2, -12, 3.5) * near;
    const Vec3d away{std::cos(angle), std::sin(angle), 0.55};
    move.push_back(
        {.position = target + normalize(away) * distance, .target = target, .fov_deg = 34});
  }
  return move;
}

}  // namespace arris::bench
