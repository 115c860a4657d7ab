// The edges of a frame: those of the picture, whoever finds them.
#include "render/edge_objects.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "render/camera.h"
#include "render/prepared_scene.h"
#include "support/render_scenes.h"

namespace arris::test {
namespace {

// A ball of more edges than one thread takes, boxes, and an open plane.
Scene scene_of_many() {
  Scene scene;
  scene.materials.emplace_back();
  const auto put = [&](Mesh mesh, const Affine3d& placed) {
    Object object;
    object.mesh = {std::uint32_t(scene.meshes.size())};
    scene.meshes.push_back(std::move(mesh));
    object.material = {0};
    object.world_from_object = placed;
    scene.objects.push_back(object);
  };
  put(make_sphere_mesh(6), {{}, {0, 0, 1}});
  put(make_box_mesh({0.5, 0.5, 0.5}), {{{0, 1, 0}, {-1, 0, 0}, {0, 0, 2}}, {2, 0, 1}});
  put(make_box_mesh({20, 20, 20}), {});
  put(make_square_mesh(3), {});
  scene.camera = Camera{{0, -5, 2}, {0, 0, 1}, {0, 0, 1}, 40};
  scene.image.width_px = 80;
  scene.image.height_px = 60;
  return scene;
}

PixelView view_of(const Camera& camera, const ImageSettings& image) {
  const CameraRays rays = make_camera_rays(camera, image);
  return {Vec3d(rays.position), inverse(Mat3d{rays.step_x, rays.step_y, rays.corner}),
          image.width_px, image.height_px};
}

using Ends = std::array<float, 6>;

Ends ends(const WorldEdge& e) {
  return {e.a.x, e.a.y, e.a.z, e.b.x, e.b.y, e.b.z};
}

bool is_in_picture(const PixelView& view, const WorldEdge& edge) {
  const ScreenEdge e = project_edge(view, edge);
  return e.x0 != e.x1 || e.y0 != e.y1;
}

// By looking at each edge.
std::vector<Ends> drawn_edges(const PreparedScene& scene, const EdgeObjects& objects,
                              const PixelView& view) {
  std::vector<Ends> out;
  for (std::uint32_t i = 0; i < scene.scene().objects.size(); ++i) {
    const EdgeObjects::Parts parts = objects.parts(scene, i).value();
    const HomogeneousPoint eye = transform(inverse(*parts.world), HomogeneousPoint{view.eye, 1});
    const bool within = i == 2;  // the eye is in the large box
    for (std::uint32_t e = 0; e < parts.mesh->edges.size(); ++e) {
      const bool sharp_anyway = (within || parts.mesh->is_open(e)) && parts.mesh->is_sharp(e);
      if (!sharp_anyway && !is_drawn(*parts.mesh, e, eye)) continue;
      const auto place = [&](std::uint32_t v) {
        return Vec3f(transform_point(*parts.world, Vec3d(parts.mesh->vertices[v])));
      };
      const WorldEdge edge{place(parts.mesh->edges[e].v0), place(parts.mesh->edges[e].v1)};
      if (is_in_picture(view, edge)) out.push_back(ends(edge));
    }
  }
  std::ranges::sort(out);
  return out;
}

TEST(EdgeObjects, finds_what_is_drawn_in_the_picture) {
  const auto scene = prepare_scene(scene_of_many());
  const EdgeObjects objects(*scene, 0);
  FoundEdges found;
  std::size_t all = 0, in_picture = 0;
  for (const Vec3d target : {Vec3d{0, 0, 1}, Vec3d{2, 1, 1}, Vec3d{4, 0, 3}, Vec3d{0, -9, 1}}) {
    Camera camera = *scene->scene().camera;
    camera.target = target;
    const PixelView view = view_of(camera, scene->scene().image);
    objects.find_edges(*scene, view, 0, found);
    std::vector<Ends> edges;
    for (const std::span<const WorldEdge> list : found.lists()) {
      all += list.size();
      for (const WorldEdge& e : list) {
        if (is_in_picture(view, e)) edges.push_back(ends(e));
      }
    }
    std::ranges::sort(edges);
    in_picture += edges.size();
    EXPECT_EQ(edges, drawn_edges(*scene, objects, view));
  }
  EXPECT_GT(in_picture, 300U);
  // Nodes reach beyond the picture, but not far.
  EXPECT_LT(all, 2 * in_picture);
}

TEST(EdgeObjects, the_next_frame_uses_the_memory_of_the_one_before) {
  const auto scene = prepare_scene(scene_of_many());
  const EdgeObjects objects(*scene, 0);
  const PixelView view = view_of(*scene->scene().camera, scene->scene().image);
  FoundEdges found;
  objects.find_edges(*scene, view, 0, found);
  const std::vector<std::span<const WorldEdge>> before(found.lists().begin(), found.lists().end());
  const EdgeTotals totals = found.totals();
  EXPECT_GT(totals.silhouette, 100U);
  EXPECT_GT(totals.sharp, 10U);
  objects.find_edges(*scene, view, 1, found);
  ASSERT_EQ(found.lists().size(), before.size());
  for (std::size_t i = 0; i < before.size(); ++i) {
    EXPECT_EQ(found.lists()[i].data(), before[i].data());
    EXPECT_EQ(found.lists()[i].size(), before[i].size());
  }
  EXPECT_EQ(found.totals().silhouette, totals.silhouette);
  EXPECT_EQ(found.totals().sharp, totals.sharp);
}

// The middles of a rounded box's edges between faces that are seen, from a distance at which they are so many pixels
// wide.
std::size_t count_creases(double width_px, Creases creases) {
  constexpr double kRadius = 0.1, kHalf = 0.5;
  const Vec3d toward = normalize(Vec3d{1, 0.9, 0.8});
  Scene scene;
  scene.materials.emplace_back();
  scene.meshes.push_back(make_box_mesh({kHalf, kHalf, kHalf}));
  Object object;
  object.mesh = {0};
  object.material = {0};
  object.rounding.emplace();
  object.rounding->method = RoundMethod::exact;
  object.rounding->radius = kRadius;
  scene.objects.push_back(object);
  scene.image.width_px = scene.image.height_px = 100;
  // Of the edge along z: the tangents at the two sides as seen.
  const Vec3d across = Vec3d{1, -1, 0} * kRadius, side = normalize(Vec3d{-0.9, 1, 0});
  constexpr double kFovDeg = 20;
  const double pixel = 2 * std::tan(radians(kFovDeg / 2)) / 100;
  const double distance = std::abs(dot(across, side)) / (width_px * pixel);
  scene.camera = Camera{toward * distance, {}, {0, 0, 1}, kFovDeg};
  const auto prepared = prepare_scene(std::move(scene));
  const EdgeObjects objects(*prepared, 0, creases);
  FoundEdges found;
  objects.find_edges(*prepared, view_of(*prepared->scene().camera, prepared->scene().image), 0,
                     found);
  const double inner = kHalf - kRadius, outer = inner + kRadius * std::sqrt(0.5);
  std::size_t count = 0;
  for (const std::span<const WorldEdge> list : found.lists()) {
    for (const WorldEdge& e : list) {
      for (const std::array<double, 3> at :
           {std::array{outer, outer, 0.0}, {outer, 0.0, outer}, {0.0, outer, outer}}) {
        const Vec3d middle = (Vec3d(e.a) + Vec3d(e.b)) * 0.5;
        const bool is_whole = std::abs(length(Vec3d(e.b) - Vec3d(e.a)) - 2 * inner) < 1e-5;
        count += is_whole && length(middle - Vec3d{at[0], at[1], at[2]}) < 1e-5 ? 1 : 0;
      }
    }
  }
  return count;
}

TEST(EdgeObjects, narrow_roundings_between_two_seen_faces_have_an_edge) {
  EXPECT_EQ(count_creases(1.5, Creases::drawn), 3U);
  EXPECT_EQ(count_creases(2, Creases::drawn), 3U);
  EXPECT_EQ(count_creases(3, Creases::drawn), 0U);
  EXPECT_EQ(count_creases(1.5, Creases::left_out), 0U);
}

}  // namespace
}  // namespace arris::test
