#include "view/view_stage.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <initializer_list>
#include <memory>

#include "arris/error.h"
#include "arris/render.h"
#include "geometry/shapes.h"
#include "render/csg_objects.h"
#include "render/prepared_scene.h"
#include "view/carry_over.h"
#include "view/shown_view.h"

namespace arris::view {
namespace {

ViewModel make_model(std::size_t objects) {
  ViewModel model;
  model.name = "boxes.obj";
  model.scene.meshes.push_back(make_box_mesh({1, 2, 3}));
  model.scene.materials.resize(1);
  for (std::size_t i = 0; i < objects; ++i) {
    Object object;
    object.name = "box " + std::to_string(i);
    object.world_from_object.translation = {3.0 * double(i), 0, 0};
    model.scene.objects.push_back(object);
  }
  RoundingSettings rounding;
  rounding.method = RoundMethod::exact;
  rounding.radius = 0.25;
  model.scene.rounding = rounding;
  return model;
}

TEST(ViewStage, the_first_view_is_the_one_that_render_makes) {
  const ViewModel model = make_model(2);
  Scene rendered = model.scene;
  stage_model(rendered, {});
  const Scene shown = stage_view(model, first_edits(model)).scene;
  EXPECT_TRUE(validate_scene(shown).empty());
  EXPECT_EQ(shown.objects.size(), rendered.objects.size());
  EXPECT_EQ(shown.environment, rendered.environment);
  EXPECT_EQ(shown.rounding, rendered.rounding);
  EXPECT_EQ(shown.camera->position, rendered.camera->position);
  EXPECT_EQ(shown.materials[0].name, rendered.materials[0].name);
}

TEST(ViewStage, hidden_objects_leave_and_the_others_keep_their_place) {
  const ViewModel model = make_model(3);
  ViewEdits edits = first_edits(model);
  SetObject hide;
  hide.id = 1;
  hide.visible = false;
  apply_message(model, hide, edits);
  const StagedView staged = stage_view(model, edits);
  EXPECT_EQ(staged.scene.objects.size(), 3U);  // with the ground
  EXPECT_EQ(staged.index_of[0], 0U);
  EXPECT_EQ(staged.index_of[1], std::nullopt);
  EXPECT_EQ(staged.index_of[2], 1U);
  EXPECT_EQ(staged.scene.objects[2].name, "ground");
  EXPECT_EQ(staged.scene.meshes.back().positions,
            stage_view(model, first_edits(model)).scene.meshes.back().positions);
  apply_message(model, Isolate{1}, edits);
  EXPECT_EQ(stage_view(model, edits).index_of[1], 0U);
  apply_message(model, Isolate{}, edits);
  EXPECT_EQ(stage_view(model, edits).scene.objects.size(), 4U);
}

TEST(ViewStage, says_how_much_is_new) {
  const ViewModel model = make_model(2);
  const ViewEdits first = first_edits(model);
  const auto work = [&](const MessageKind& message) {
    ViewEdits edits = first;
    apply_message(model, message, edits);
    return find_work(first, edits);
  };
  SetCamera camera{first.camera};
  EXPECT_EQ(work(camera), ViewWork::none);
  camera.camera.fov_deg = 20;
  EXPECT_EQ(work(camera), ViewWork::camera);
  EXPECT_EQ(work(SetOverlay{true}), ViewWork::redraw);
  SetRounding rounding;
  rounding.edges = RoundEdges::both;
  EXPECT_EQ(work(rounding), ViewWork::change);
  SetObject object;
  object.world_from_object = Affine3d{{}, {0, 0, 9}};
  EXPECT_EQ(work(object), ViewWork::change);
  object.radius = Radius(0.5);
  EXPECT_EQ(work(object), ViewWork::prepare);
  EXPECT_EQ(work(SetSize{{100, 100}}), ViewWork::new_engine);
  EXPECT_EQ(work(Compare{RoundMethod::none, 0.5}), ViewWork::new_engine);
  EXPECT_EQ(work(SetShader{EdgePointShader::direct}), ViewWork::new_engine);
  EXPECT_EQ(work(SetGround{false}), ViewWork::prepare);
  EXPECT_EQ(work(SetMaterial{"brass"}), ViewWork::prepare);
  EXPECT_EQ(work(SetLight{LightChoice::sky, {}, {}}), ViewWork::prepare);
}

TEST(ViewStage, meshes_of_rounded_edges_are_made_anew_by_every_change_but_the_cameras) {
  ViewModel model = make_model(2);
  model.scene.rounding->method = RoundMethod::mesh;
  const ViewEdits first = first_edits(model);
  BuildSettings settings;
  settings.threads = 1;
  const auto shared = std::make_shared<const ViewModel>(model);
  ViewEdits edits = first;
  edits.size = kLeastSize;
  const ShownView before = build_view(shared, edits, settings);
  SetRounding exact;
  exact.method = RoundMethod::exact;
  SetObject move;
  move.world_from_object = Affine3d{{}, {0, 0, 9}};
  for (const MessageKind& message :
       std::initializer_list<MessageKind>{SetSize{{80, 70}}, Compare{RoundMethod::none, 0.5},
                                          SetShader{EdgePointShader::direct}, exact, move}) {
    ViewEdits changed = edits;
    apply_message(model, message, changed);
    EXPECT_EQ(find_work(edits, changed), ViewWork::prepare) << type_of(message);
    EXPECT_NO_THROW(build_view(shared, changed, settings, usable_parts(before)))
        << type_of(message);
  }
  // Also of what is compared with.
  ViewEdits compared = edits;
  compared.rounding.method = RoundMethod::exact;
  compared.compared = RoundMethod::mesh;
  const ShownView both = build_view(shared, compared, settings);
  ViewEdits larger = compared;
  apply_message(model, SetSize{{80, 70}}, larger);
  EXPECT_NO_THROW(build_view(shared, larger, settings, usable_parts(both)));
}

TEST(ViewStage, the_light_can_be_turned_where_that_is_seen) {
  ViewModel model = make_model(1);
  model.scene.lights.emplace_back(PointLight{});
  ViewEdits edits = first_edits(model);
  EXPECT_EQ(edits.lighting, LightChoice::file);
  EXPECT_FALSE(can_rotate_light(model, edits));
  edits.lighting = LightChoice::studio;
  EXPECT_TRUE(can_rotate_light(model, edits));
  edits.lighting = LightChoice::white;
  EXPECT_FALSE(can_rotate_light(model, edits));
  model.scene.environment = SkyEnvironment{};
  edits.lighting = LightChoice::file;
  EXPECT_TRUE(can_rotate_light(model, edits));
}

TEST(ViewStage, radii_of_objects_follow_the_scenes_other_settings) {
  const ViewModel model = make_model(2);
  ViewEdits edits = first_edits(model);
  SetObject object;
  object.radius = Radius(0.4);
  apply_message(model, object, edits);
  SetRounding rounding;
  rounding.radius = 0.1;
  rounding.method = RoundMethod::shader;
  apply_message(model, rounding, edits);
  EXPECT_EQ(edits.objects[0].rounding->radius, Radius(0.4));
  EXPECT_EQ(edits.objects[0].rounding->method, RoundMethod::shader);
  EXPECT_FALSE(edits.objects[1].rounding);
  object.radius.emplace();
  apply_message(model, object, edits);
  EXPECT_FALSE(edits.objects[0].rounding);
}

std::vector<double> radii_of(const Scene& scene) {
  const auto prepared = prepare_scene(scene, {.threads = 1});
  std::vector<double> radii;
  for (const RoundingSummary& summary : prepare_stats(*prepared).rounding) {
    radii.push_back(summary.radius);
  }
  return radii;
}

// One object is nearer to the camera than the other, so that what reads well differs.
TEST(ViewStage, automatic_radii_are_those_of_the_first_view_whatever_is_shown_later) {
  ViewModel model = make_model(2);
  model.scene.rounding->radius = AutoRadius{};
  model.scene.objects[1].world_from_object.translation = {0, 9, 0};
  Scene rendered = model.scene;
  stage_model(rendered, {});
  const std::vector<double> first = radii_of(rendered);
  ASSERT_EQ(first.size(), 2U);
  EXPECT_NE(first[0], first[1]);
  ViewEdits edits = first_edits(model);
  const ViewEdits first_of_all = edits;
  EXPECT_EQ(radii_of(stage_view(model, edits).scene), first);
  // Below 500 pixels of height, what reads well is a larger part of it.
  apply_message(model, SetSize{{300, 200}}, edits);
  EXPECT_EQ(radii_of(stage_view(model, edits).scene), first);
  SetCamera away{edits.camera};
  away.camera.position = away.camera.position * 3;
  apply_message(model, away, edits);
  SetObject move;
  move.world_from_object = Affine3d{{}, {0, -2, 0}};
  apply_message(model, move, edits);
  EXPECT_EQ(radii_of(stage_view(model, edits).scene), first);
  // A number, and back to automatic.
  SetRounding rounding;
  rounding.radius = 0.01;
  apply_message(model, rounding, edits);
  EXPECT_EQ(radii_of(stage_view(model, edits).scene), std::vector<double>({0.01, 0.01}));
  rounding.radius = AutoRadius{};
  apply_message(model, rounding, edits);
  EXPECT_EQ(radii_of(stage_view(model, edits).scene), first);
  // A file that has been read again has a first view of its own, also of what was moved.
  ViewModel smaller = model;
  for (Vec3f& p : smaller.scene.meshes[0].positions) p = p * 0.5F;
  smaller.scene.objects[1].world_from_object.translation = {0, 4.5, 0};
  const ViewEdits now =
      carry_over(first_of_all, edits, first_edits(smaller), match_objects(model, smaller));
  const std::vector<double> again = radii_of(stage_view(smaller, now).scene);
  EXPECT_NEAR(again[0], first[0] / 2, 1e-3 * first[0]);
  EXPECT_NEAR(again[1], first[1] / 2, 1e-3 * first[1]);
}

TEST(ViewStage, beams_are_followed_as_far_as_the_views_light) {
  const ViewModel model = make_model(1);
  ViewEdits edits = first_edits(model);
  apply_message(model, SetLight{LightChoice::white, 2.0, {}}, edits);
  const auto staged = [&](EdgePointShader shader) {
    apply_message(model, SetShader{shader}, edits);
    return stage_beams(model, edits);
  };
  const StagedBeams all = staged(EdgePointShader::gi);
  EXPECT_EQ(all.scene.image.max_depth, model.scene.image.max_depth);
  EXPECT_FALSE(all.settings.only_glossy);
  EXPECT_EQ(all.scene.environment, stage_view(model, edits).scene.environment);
  EXPECT_TRUE(beam_problems(all.scene).empty());
  EXPECT_EQ(staged(EdgePointShader::direct).scene.image.max_depth, 1);
  EXPECT_FALSE(staged(EdgePointShader::direct).settings.only_glossy);
  EXPECT_TRUE(staged(EdgePointShader::glossy).settings.only_glossy);
  EXPECT_EQ(staged(EdgePointShader::glossy).scene.image.max_depth, all.scene.image.max_depth);
}

TEST(ViewStage, what_is_refused_changes_nothing) {
  const ViewModel model = make_model(1);
  ViewEdits edits = first_edits(model);
  const ViewEdits before = edits;
  SetObject object;
  object.id = 1;
  object.visible = false;
  EXPECT_THROW(apply_message(model, object, edits), Error);
  EXPECT_THROW(apply_message(model, Isolate{7}, edits), Error);
  EXPECT_THROW(apply_message(model, SetMaterial{"unobtainium"}, edits), Error);
  EXPECT_THROW(apply_message(model, SetLight{LightChoice::file, 2.0, {}}, edits), Error);
  SetCamera camera{edits.camera};
  camera.camera.target = camera.camera.position;
  EXPECT_THROW(apply_message(model, camera, edits), Error);
  EXPECT_EQ(find_work(before, edits), ViewWork::none);
}

TEST(ViewStage, what_was_changed_by_hand_outlives_a_change_of_the_file) {
  const ViewModel before = make_model(2);
  ViewEdits edits = first_edits(before);
  apply_message(before, SetMaterial{"brass"}, edits);
  edits.objects[1].visible = false;
  ViewModel after = before;
  after.scene.rounding->radius = 0.125;
  const ViewEdits carried =
      carry_over(first_edits(before), edits, first_edits(after), match_objects(before, after));
  EXPECT_EQ(carried.material, "brass");
  EXPECT_FALSE(carried.objects[1].visible);
  EXPECT_EQ(carried.rounding.radius, Radius(0.125));
}

TEST(ViewStage, changes_of_objects_follow_their_names) {
  ViewModel before = make_model(4);
  before.scene.objects[3].name = before.scene.objects[2].name = "twin";
  ViewEdits edits = first_edits(before);
  edits.objects[0].visible = false;
  edits.objects[1].world_from_object.translation = {0, 0, 7};
  edits.objects[3].rounding.emplace().radius = 0.01;
  // The first has gone, another one has come, and the second twin lies elsewhere.
  ViewModel after = before;
  after.scene.objects = {before.scene.objects[2], before.scene.objects[3], before.scene.objects[1],
                         before.scene.objects[1]};
  after.scene.objects[3].name = "new";
  after.scene.objects[1].world_from_object.translation = {5, 5, 5};
  const ObjectMatch match = match_objects(before, after);
  EXPECT_EQ(match, ObjectMatch({2, 3, 1, std::nullopt}));
  const ViewEdits carried = carry_over(first_edits(before), edits, first_edits(after), match);
  EXPECT_FALSE(carried.objects[0].rounding);
  EXPECT_EQ(carried.objects[1].rounding->radius, Radius(0.01));
  EXPECT_EQ(carried.objects[1].world_from_object.translation, Vec3d(5, 5, 5));
  EXPECT_EQ(carried.objects[2].world_from_object.translation, Vec3d(0, 0, 7));
  EXPECT_TRUE(carried.objects[3].visible);
  EXPECT_EQ(lost_objects(before, edits, match), std::vector<std::string>{"box 0"});
}

TEST(ViewStage, the_files_lighting_is_there_where_the_file_has_lights) {
  ViewModel model = make_model(1);
  EXPECT_EQ(lightings_of(model).size(), 3U);
  model.scene.lights.emplace_back(PointLight{});
  EXPECT_EQ(lightings_of(model).back(), LightChoice::file);
}

TEST(ViewStage, framed_views_show_all_from_where_they_are_asked_for) {
  const ViewModel model = make_model(1);
  const ViewEdits edits = first_edits(model);
  const auto direction = [&](FrameView::From from) {
    const Camera camera = frame_view(model, edits, from);
    return normalize(camera.target - camera.position);
  };
  EXPECT_NEAR(length(direction(FrameView::From::top) - Vec3d(0, 0, -1)), 0, 1e-9);
  EXPECT_NEAR(length(direction(FrameView::From::front) - Vec3d(0, 1, 0)), 0, 1e-9);
  EXPECT_NEAR(length(direction(FrameView::From::right) - Vec3d(-1, 0, 0)), 0, 1e-9);
  const Vec3d iso = direction(FrameView::From::iso);
  EXPECT_NEAR(length(iso - Vec3d(-1, 1, -1) / std::sqrt(3.0)), 0, 1e-9);
  const Vec3d here = normalize(edits.camera.target - edits.camera.position);
  EXPECT_NEAR(length(direction(FrameView::From::here) - here), 0, 1e-6);
}

// Where the corners of what is visible lie, from the middle, in halves of the picture; the largest of each axis.
Vec2d reach_of(const ViewModel& model, const ViewEdits& edits) {
  const Camera& c = edits.camera;
  const Vec3d forward = normalize(c.target - c.position);
  const Vec3d right = normalize(cross(forward, c.up));
  const Vec3d up = cross(right, forward);
  const double half = std::tan(radians(c.fov_deg) / 2);
  const double aspect = double(edits.size.width_px) / edits.size.height_px;
  Vec2d reach{0, 0};
  for (std::size_t i = 0; i < edits.objects.size(); ++i) {
    for (const Vec3f& p : model.scene.meshes[0].positions) {
      const Vec3d at = transform_point(edits.objects[i].world_from_object, Vec3d(p)) - c.position;
      const double depth = dot(at, forward) * half;
      reach.x = std::max(reach.x, std::abs(dot(at, right)) / (depth * aspect));
      reach.y = std::max(reach.y, std::abs(dot(at, up)) / depth);
    }
  }
  return reach;
}

TEST(ViewStage, what_is_framed_is_whole_at_every_size_until_the_camera_is_moved) {
  const ViewModel model = make_model(4);
  ViewEdits edits = first_edits(model);
  const auto expect_whole = [&] {
    for (const PictureSize size : {PictureSize{390, 744}, {1280, 720}, {900, 100}}) {
      apply_message(model, SetSize{size}, edits);
      const Vec2d reach = reach_of(model, edits);
      EXPECT_LT(std::max(reach.x, reach.y), 1) << size.width_px;
      EXPECT_GT(std::max(reach.x, reach.y), 0.7) << size.width_px;
    }
  };
  expect_whole();
  for (const auto from : {FrameView::From::top, FrameView::From::front, FrameView::From::here}) {
    apply_message(model, FrameView{from}, edits);
    expect_whole();
  }
  apply_message(model, SetCamera{edits.camera}, edits);
  const Camera before = edits.camera;
  apply_message(model, SetSize{{390, 744}}, edits);
  EXPECT_EQ(before.position, edits.camera.position);
  apply_message(model, FrameView{FrameView::From::first}, edits);
  const Camera first = edits.camera;
  EXPECT_NE(before.position, first.position);
  expect_whole();
}

TEST(ViewStage, the_files_camera_is_the_first_at_every_size) {
  ViewModel model = make_model(1);
  model.scene.camera = Camera{{0, -20, 1}, {0, 0, 1}, {0, 0, 1}, 20};
  ViewEdits edits = first_edits(model);
  apply_message(model, SetSize{{100, 700}}, edits);
  EXPECT_EQ(edits.camera.position, Vec3d(0, -20, 1));
  apply_message(model, FrameView{FrameView::From::top}, edits);
  apply_message(model, FrameView{FrameView::From::first}, edits);
  EXPECT_EQ(edits.camera.position, Vec3d(0, -20, 1));
  EXPECT_EQ(edits.camera.fov_deg, 20);
}

TEST(ViewStage, a_framed_view_is_framed_again_when_the_file_has_grown) {
  const ViewModel before = make_model(1), after = make_model(5);
  ViewEdits edits = first_edits(before);
  apply_message(before, SetSize{{300, 500}}, edits);
  const ObjectMatch match = match_objects(before, after);
  ViewEdits carried = carry_over(first_edits(before), edits, first_edits(after), match);
  fit_camera(after, carried);
  EXPECT_LT(reach_of(after, carried).x, 1);
  apply_message(before, SetCamera{edits.camera}, edits);
  carried = carry_over(first_edits(before), edits, first_edits(after), match);
  fit_camera(after, carried);
  EXPECT_EQ(carried.camera.position, edits.camera.position);
}

TEST(ViewStage, the_radius_limit_is_the_least_inradius_of_what_the_scenes_radius_rounds) {
  ViewModel model = make_model(3);
  model.scene.objects[1].world_from_object.linear = Mat3d{{2, 0, 0}, {0, 2, 0}, {0, 0, 2}};
  ViewEdits edits = first_edits(model);
  const auto inradii = first_inradii(model);
  ASSERT_EQ(inradii.size(), 3U);
  EXPECT_NEAR(*radius_limit(model, edits, inradii), 0.5, 1e-9);
  edits.objects[0].visible = false;
  SetObject own;
  own.id = 2;
  own.radius = Radius(0.1);
  apply_message(model, own, edits);
  EXPECT_NEAR(*radius_limit(model, edits, inradii), 1, 1e-9);
  edits.objects[1].world_from_object.linear = Mat3d{{4, 0, 0}, {0, 4, 0}, {0, 0, 4}};
  EXPECT_NEAR(*radius_limit(model, edits, inradii), 2, 1e-9);
  edits.objects[1].visible = false;
  EXPECT_FALSE(radius_limit(model, edits, inradii));
}

TEST(ViewStage, tells_which_message_made_a_difference) {
  const ViewModel model = make_model(2);
  const ViewEdits first = first_edits(model);
  const auto change = [&](const MessageKind& message) {
    ViewEdits edits = first;
    apply_message(model, message, edits);
    return std::string(find_change(first, edits));
  };
  SetRounding rounding;
  rounding.radius = 0.5;
  SetObject object;
  object.radius = Radius(0.5);
  for (const MessageKind& message : std::initializer_list<MessageKind>{
           rounding, object, SetSize{{100, 100}}, Compare{RoundMethod::none, 0.5},
           SetShader{EdgePointShader::direct}, SetGround{false}, SetMaterial{"brass"},
           SetLight{LightChoice::sky, {}, {}}}) {
    EXPECT_EQ(change(message), type_of(message));
  }
  EXPECT_EQ(change(SetOverlay{true}), "");
}

TEST(ViewStage, the_ground_of_a_scene_is_where_it_says_until_it_is_turned_off) {
  ViewModel model = make_model(1);
  model.stage.source = StageOptions::Source::scene_file;
  EXPECT_FALSE(first_edits(model).ground);
  model.scene.ground = Ground{{1, 2, -5}, 10};
  ViewEdits edits = first_edits(model);
  EXPECT_TRUE(edits.ground);
  const Scene shown = stage_view(model, edits).scene;
  ASSERT_EQ(shown.objects.size(), 2U);
  EXPECT_EQ(shown.meshes.back().positions[0].z, -5);
  EXPECT_EQ(length(shown.meshes.back().positions[0] - shown.meshes.back().positions[1]), 20);
  apply_message(model, SetGround{false}, edits);
  EXPECT_EQ(stage_view(model, edits).scene.objects.size(), 1U);
  EXPECT_FALSE(stage_view(model, edits).scene.ground);
}

TEST(ShownView, edges_of_csg_solids_are_found_once_for_all_views_of_a_model) {
  ViewModel model = make_model(1);
  CsgTree tree;
  tree.leaves.push_back({CsgSphere{1}, {}, MaterialId{0}});
  tree.nodes.push_back({0, CsgOperation::unite, {}});
  model.scene.csg_trees.push_back(tree);
  model.scene.objects[0].csg = CsgId{0};
  const auto shared = std::make_shared<const ViewModel>(model);
  ViewEdits edits = first_edits(model);
  edits.size = kLeastSize;
  BuildSettings settings;
  settings.threads = 1;
  const ShownView first = build_view(shared, edits, settings);
  const auto edges_of = [](const ShownView& view) {
    return view.engine->scene()->geometry().csg.objects.at(0)->edges;
  };
  for (const MessageKind& message : std::initializer_list<MessageKind>{
           SetSize{{80, 70}}, SetShader{EdgePointShader::direct},
           SetLight{LightChoice::sky, {}, {}}, SetMaterial{"brass"}, SetGround{false}}) {
    ViewEdits changed = edits;
    apply_message(model, message, changed);
    const ShownView view = build_view(shared, changed, settings, usable_parts(first));
    EXPECT_EQ(edges_of(view), edges_of(first)) << type_of(message);
  }
  EXPECT_NE(edges_of(build_view(shared, edits, settings)), edges_of(first));
}

TEST(ShownView, ends_when_it_is_stopped) {
  const auto model = std::make_shared<const ViewModel>(make_model(2));
  ViewEdits edits = first_edits(*model);
  edits.size = kLeastSize;
  BuildSettings settings;
  for (const double trace_below_ms : {0.0, 1e9}) {
    settings.trace_below_ms = trace_below_ms;
    settings.stop = std::make_shared<std::atomic<bool>>(false);
    const ShownView view = build_view(model, edits, settings);
    view.engine->next_frame();
    *view.stop = true;
    EXPECT_THROW(view.engine->next_frame(), Error);
    EXPECT_THROW(build_view(model, edits, settings), Error);
    EXPECT_THROW(build_view(model, edits, settings, usable_parts(view)), Error);
  }
}

}  // namespace
}  // namespace arris::view
