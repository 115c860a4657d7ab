#include "io/packed_scene.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "arris/error.h"

namespace arris {
namespace {

Scene small_scene() {
  Scene scene;
  Material& material = scene.materials.emplace_back();
  material.name = "#ff8000";
  material.base_color = {1, 0.2F, 0};
  material.opacity = 0.5F;
  Mesh& mesh = scene.meshes.emplace_back();
  mesh.name = "part";
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  mesh.normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
  mesh.triangle_materials = {MaterialId{0}};
  mesh.sharp_edges = {{{0, 1}}};
  mesh.edge_radii = {{{1, 2}, 0.25F}, {{2, 0}, 0}};
  scene.meshes.emplace_back().name = "nothing";
  Object& object = scene.objects.emplace_back();
  object.name = "left";
  object.mesh.index = 1;
  object.world_from_object = {{{0, 1, 0}, {1, 0, 0}, {0, 0, 2}}, {3, 4, 5}};
  scene.notes = {"a note"};
  return scene;
}

TEST(PackedScene, gives_back_what_it_got) {
  const Scene scene = small_scene();
  const Scene back = unpack_scene(pack_scene(scene));
  ASSERT_EQ(back.materials.size(), 1U);
  EXPECT_EQ(back.materials[0].name, "#ff8000");
  EXPECT_EQ(back.materials[0].base_color, scene.materials[0].base_color);
  EXPECT_EQ(back.materials[0].opacity, 0.5F);
  ASSERT_EQ(back.meshes.size(), 2U);
  EXPECT_EQ(back.meshes[0].name, "part");
  EXPECT_EQ(back.meshes[0].positions, scene.meshes[0].positions);
  EXPECT_EQ(back.meshes[0].triangles, scene.meshes[0].triangles);
  EXPECT_EQ(back.meshes[0].normals, scene.meshes[0].normals);
  EXPECT_EQ(back.meshes[0].triangle_materials.size(), 1U);
  EXPECT_EQ(back.meshes[0].sharp_edges, scene.meshes[0].sharp_edges);
  EXPECT_FALSE(back.meshes[1].sharp_edges);
  EXPECT_EQ(back.meshes[0].edge_radii, scene.meshes[0].edge_radii);
  ASSERT_EQ(back.objects.size(), 1U);
  EXPECT_EQ(back.objects[0].name, "left");
  EXPECT_EQ(back.objects[0].mesh.index, 1U);
  EXPECT_EQ(back.objects[0].world_from_object, scene.objects[0].world_from_object);
  EXPECT_EQ(back.notes, scene.notes);
}

TEST(PackedScene, refuses_what_is_cut_or_changed) {
  const std::vector<std::uint8_t> bytes = pack_scene(small_scene());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_THROW(unpack_scene(std::span(bytes).first(size)), Error) << size;
  }
  std::vector<std::uint8_t> longer = bytes;
  longer.push_back(0);
  EXPECT_THROW(unpack_scene(longer), Error);
  // Counts beyond what is there take no memory.
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::vector<std::uint8_t> changed = bytes;
    changed[i] ^= 0xFF;
    try {
      unpack_scene(changed);
    } catch (const Error&) {
    }
  }
}

}  // namespace
}  // namespace arris
