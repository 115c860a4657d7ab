// arris render and arris merge, end to end.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string_view>

#include "arris/io.h"
#include "io/picture_file.h"
#include "io/render_part.h"
#include "program/run_program.h"

namespace arris {
namespace {

using test::Outcome;
using test::Workplace;
using testing::HasSubstr;

constexpr const char* kSmall = " --size 40x30 --spp 4 --quiet ";

TEST(Render, one_command_makes_a_framed_picture_on_a_ground) {
  const Workplace place;
  const Outcome run = place.arris("render cube.stl -o a.png --size 64x36 --spp 8");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(run.out, "");
  EXPECT_THAT(run.err, HasSubstr("a.png: 64 x 36 pixels, samples 0..8"));
  const Image image = load_picture(place / "a.png").color;
  ASSERT_EQ(image.width_px, 64);
  ASSERT_EQ(image.height_px, 36);
  // The model is in the middle and darker than the ground around it, which is light everywhere.
  EXPECT_LT(image.at(32, 18, 1), 0.8F * image.at(2, 2, 1));
  for (const int x : {1, 62}) {
    for (const int y : {1, 34}) EXPECT_GT(image.at(x, y, 1), 0.4F);
  }
}

TEST(Render, says_which_radius_it_chose) {
  const Outcome run = Workplace().arris("render cube.stl -o a.png --size 64x36 --spp 1");
  EXPECT_THAT(run.err, HasSubstr("rounded 12 edges and 8 corners, radius "));
  EXPECT_THAT(run.err, HasSubstr("automatic"));
}

TEST(Render, says_which_radii_are_automatic) {
  const Workplace place;
  const auto report = [&](const std::string& second_round) {
    test::write_text(place / "two.toml",
                     "[[object]]\nfile = \"cube.stl\"\nround = 0.1\n"
                     "[[object]]\nfile = \"cube.stl\"\ntranslate = [4, 0, 0]\nround = " +
                         second_round + "\n");
    return place.arris("render two.toml -o a.png --size 64x36 --spp 1").err;
  };
  EXPECT_THAT(report("0.2"), HasSubstr("radii 0.1 to 0.2\n"));
  EXPECT_THAT(report("{ method = \"shader\", delta = 0.2 }"), HasSubstr("radius 0.1\n"));
  EXPECT_THAT(report("\"auto\""),
              HasSubstr(" (automatic for 1 of 2 objects; --round R sets it for all)\n"));
}

TEST(Render, every_format_holds_the_picture) {
  const Workplace place;
  for (const char* name : {"a.png", "a.jpg", "a.exr", "a.pfm"}) {
    ASSERT_EQ(place.arris(std::string("render cube.stl") + kSmall + "-o " + name).code, 0) << name;
    EXPECT_EQ(load_picture(place / name).color.width_px, 40) << name;
  }
  ASSERT_EQ(place.shell(std::string("arris render cube.stl") + kSmall + "-o - > b.png").code, 0);
  EXPECT_TRUE(place.read("b.png") == place.read("a.png"));
  EXPECT_EQ(place.arris("compare a.exr a.pfm --max-rmse 0").code, 0);
}

TEST(Render, layers_are_part_of_exr_and_beside_png) {
  const Workplace place;
  ASSERT_EQ(
      place.arris(std::string("render cube.stl") + kSmall + "-o a.exr --aov depth,normal,object")
          .code,
      0);
  const Picture picture = load_picture(place / "a.exr");
  ASSERT_EQ(picture.layers.size(), 3U);
  ASSERT_EQ(place.arris(std::string("render cube.stl") + kSmall + "-o b.png --aov depth").code, 0);
  EXPECT_GT(load_picture(place / "b.depth.pfm").color.at(20, 15, 0), 0.0F);
}

TEST(Render, layers_beside_png_can_be_looked_at) {
  const Workplace place;
  const std::string render = std::string("render cube.stl") + kSmall + "--aov albedo,depth ";
  ASSERT_EQ(place.arris(render + "-o a.jpg").code, 0);
  const Image values = load_picture(place / "a.albedo.pfm").color;
  const Image shown = load_picture(place / "a.albedo.png").color;
  EXPECT_GT(values.at(20, 15, 0), 0.1F);
  EXPECT_NEAR(shown.at(20, 15, 0), values.at(20, 15, 0), 0.01);
  EXPECT_FALSE(std::filesystem::exists(place / "a.depth.png"));
  ASSERT_EQ(place.arris(render + "-o b.pfm").code, 0);
  EXPECT_FALSE(std::filesystem::exists(place / "b.albedo.png"));
}

TEST(Render, says_how_beams_went_and_which_option_does_nothing) {
  const Workplace place;
  const std::string beam = " --integrator beam --size 40x30 --spp 1 -o a.png";
  const std::string plain = place.arris("render cube.stl" + beam).err;
  EXPECT_THAT(plain, testing::ContainsRegex("a.png: 40 x 30 pixels, [0-9]+ regions, 0 uncertified "
                                            "pixels, "));
  EXPECT_THAT(plain, testing::Not(HasSubstr("sample")));
  EXPECT_THAT(plain, testing::Not(HasSubstr("--light-beams")));
  const std::string option = " --light-beams 2";
  EXPECT_THAT(place.arris("render cube.stl" + beam + option).err,
              HasSubstr("--light-beams changes nothing: there are no area lights\n"));
  test::write_text(place / "lit.toml",
                   "[[object]]\nfile = \"cube.stl\"\n[[light]]\ntype = \"area\"\n"
                   "position = [1, -2, 6]\ntarget = [1, 1, 1]\nsize = [1, 1]\nradiance = 6\n");
  const Outcome lit = place.arris("render lit.toml" + beam + option);
  EXPECT_EQ(lit.code, 0) << lit.err;
  EXPECT_THAT(lit.err, testing::Not(HasSubstr("--light-beams")));
}

TEST(Render, a_model_too_large_to_be_framed_is_an_error_that_names_it_its_size_and_a_remedy) {
  const Workplace place;
  test::write_text(place / "big.csg", "cube(size = [500000000, 500000000, 500000000]);\n");
  const Outcome framed = place.arris(std::string("render big.csg -o a.png") + kSmall);
  EXPECT_EQ(framed.code, 2);
  EXPECT_THAT(
      framed.err,
      testing::MatchesRegex(
          "arris: big.csg: is too large to be framed: it reaches out to 5e.08, its ground "
          "would to 1[.0-9]*e.10, and coordinates can be up to 1e.09; scale it to 0.09[0-9]* "
          "of its size or less, or use --ground off\n"));
  EXPECT_EQ(place.arris(std::string("render big.csg -o a.png --ground off") + kSmall).code, 0);
}

TEST(Render, bytes_do_not_depend_on_the_number_of_threads) {
  const Workplace place;
  for (const char* name : {".png", ".exr"}) {
    for (const char* threads : {"1", "2", "3"}) {
      ASSERT_EQ(place
                    .arris(std::string("render cube.stl") + kSmall + "--threads " + threads +
                           " -o t" + threads + name)
                    .code,
                0);
    }
    EXPECT_TRUE(place.read(std::string("t1") + name) == place.read(std::string("t2") + name));
    EXPECT_TRUE(place.read(std::string("t1") + name) == place.read(std::string("t3") + name));
  }
}

TEST(Render, the_seed_changes_the_noise) {
  const Workplace place;
  ASSERT_EQ(place.arris(std::string("render cube.stl") + kSmall + "-o a.pfm").code, 0);
  ASSERT_EQ(place.arris(std::string("render cube.stl") + kSmall + "--seed 1 -o b.pfm").code, 0);
  EXPECT_TRUE(place.read("a.pfm") != place.read("b.pfm"));
}

TEST(Render, options_change_what_they_name) {
  const Workplace place;
  const auto render = [&](const std::string& options) {
    const Outcome run =
        place.arris(std::string("render cube.stl") + kSmall + "-o x.pfm " + options);
    EXPECT_EQ(run.code, 0) << options << run.err;
    return place.read("x.pfm");
  };
  const std::string plain = render("");
  for (const char* options :
       {"--round none", "--round 0.4", "--round 20%", "--round 0.4 --round-method shader",
        "--material brass", "--lighting sky", "--lighting white", "--ground off", "--fov 20",
        "--camera-position 9,9,9", "--camera-target 0,0,0", "--camera-up 0,1,0", "--max-depth 1"}) {
    EXPECT_TRUE(render(options) != plain) << options;
  }
  EXPECT_TRUE(render("--exposure 2") == plain) << "linear files know no exposure";
  EXPECT_TRUE(render("--round none --round-edges both") == render("--round none"));
}

// An L of 2 x 2 x 1 and a floor, which has no edge to round.
TEST(Render, a_percentage_works_for_any_object) {
  const Workplace place;
  test::write_text(
      place / "l.off",
      "OFF\n12 8 0\n0 0 0\n2 0 0\n2 1 0\n1 1 0\n1 2 0\n0 2 0\n0 0 1\n2 0 1\n2 1 1\n1 1 1\n"
      "1 2 1\n0 2 1\n6 5 4 3 2 1 0\n6 6 7 8 9 10 11\n4 0 1 7 6\n4 1 2 8 7\n4 2 3 9 8\n"
      "4 3 4 10 9\n4 4 5 11 10\n4 5 0 6 11\n");
  test::write_text(
      place / "l.toml",
      "round = \"20%\"\n[[object]]\nfile = \"l.off\"\n[[object]]\nshape = \"plane\"\nsize = 9\n"
      "[[object]]\nshape = \"box\"\ntranslate = [4, 0, 0]\n");
  const Outcome run = place.arris(std::string("render l.toml --stats - -o a.png") + kSmall);
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("\"rounded_edges\": 29"));  // 17 of the L, 12 of the box
}

TEST(Render, a_view_from_straight_above_needs_no_up) {
  const Outcome run =
      Workplace().arris(std::string("render cube.stl") + kSmall +
                        "-o x.pfm --camera-position 0.2,0.1,9 --camera-target 0.2,0.1,0");
  EXPECT_EQ(run.code, 0) << run.err;
}

TEST(Render, a_radius_that_does_not_fit_is_an_error_that_names_object_and_limit) {
  const Outcome run = Workplace().arris("render cube.stl -o a.png --size 8x8 --spp 1 --round 1.5");
  EXPECT_EQ(run.code, 2);
  EXPECT_THAT(run.err, HasSubstr("cube"));
  EXPECT_THAT(run.err, HasSubstr("1.5"));
}

TEST(Render, stats_have_their_keys) {
  const Workplace place;
  const Outcome run = place.arris(std::string("render cube.stl") + kSmall + "-o a.png --stats -");
  ASSERT_EQ(run.code, 0) << run.err;
  const nlohmann::json stats = nlohmann::json::parse(run.out);
  for (const char* key : {"load", "build", "round", "render", "write"}) {
    EXPECT_GE(stats["seconds"][key].get<double>(), 0) << key;
  }
  EXPECT_EQ(stats["rays"]["camera"].get<int>(), 40 * 30 * 4);
  EXPECT_GE(stats["rays"]["total"].get<int>(), 40 * 30 * 4);
  EXPECT_GE(stats["rays"]["rounded_fraction"].get<double>(), 0);
  EXPECT_LE(stats["rays"]["rounded_fraction"].get<double>(), 1);
  for (const char* key : {"geometry", "rounding", "peak_rss"}) {
    EXPECT_GE(stats["memory"][key].get<double>(), 0) << key;
  }
  EXPECT_EQ(stats["triangles"].get<int>(), 12) << "the ground is not the model's";
  EXPECT_EQ(stats["rounded_edges"].get<int>(), 12);
  EXPECT_EQ(stats["rounded_corners"].get<int>(), 8);
  EXPECT_EQ(stats.size(), 6U);
}

// ---- parts

constexpr const char* kPart = "render cube.stl --size 40x30 --quiet --aov depth,normal,object ";

constexpr const char* kKeypad =
    "render '" ARRIS_SOURCE_DIR
    "/examples/models/keypad.obj' --size 40x30 --quiet --aov albedo,normal,depth,object,rounded ";

TEST(Merge, parts_make_the_whole_byte_for_byte) {
  const Workplace place;
  const auto make_parts = [&](const std::string& render) {
    ASSERT_EQ(place.arris(render + "--spp 13 -o whole.exr").code, 0);
    ASSERT_EQ(place.arris(render + "--samples 0..13 -o long.exr").code, 0);
    ASSERT_EQ(place.arris(render + "--samples 0..5 -o a.exr").code, 0);
    ASSERT_EQ(place.arris(render + "--samples 5..6 -o b.exr").code, 0);
    ASSERT_EQ(place.arris(render + "--samples 6..13 -o c.exr").code, 0);
  };
  for (const char* render : {kPart, kKeypad}) {
    make_parts(render);
    const Outcome run = place.arris("merge c.exr a.exr b.exr -o joined.exr");
    ASSERT_EQ(run.code, 0) << run.err;
    EXPECT_EQ(run.err, "joined.exr: samples 0..13\n");
    EXPECT_TRUE(place.read("joined.exr") == place.read("whole.exr"));
    EXPECT_EQ(place.arris("merge c.exr b.exr a.exr --part -o joined.exr").code, 0);
    EXPECT_TRUE(place.read("joined.exr") == place.read("long.exr"));
    // By way of a part of parts.
    EXPECT_EQ(place.arris("merge c.exr b.exr -o d.exr").code, 0);
    EXPECT_EQ(place.arris("merge d.exr a.exr -o joined.exr").code, 0);
    EXPECT_TRUE(place.read("joined.exr") == place.read("whole.exr"));
  }
}

TEST(Merge, says_where_a_picture_is_no_part) {
  const Workplace place;
  ASSERT_EQ(place.arris(std::string(kPart) + "--spp 4 -o a.exr").code, 0);
  ASSERT_EQ(place.arris(std::string(kPart) + "--samples 4..8 -o b.exr").code, 0);
  const Outcome run = place.arris("merge a.exr b.exr -o joined.exr");
  EXPECT_EQ(run.code, 0);
  EXPECT_THAT(run.err, HasSubstr("a.exr: holds a mean only"));
  EXPECT_THAT(run.err, Not(HasSubstr("b.exr: holds")));
  ASSERT_EQ(place.arris(std::string(kPart) + "--spp 8 -o whole.exr").code, 0);
  EXPECT_EQ(place.arris("compare joined.exr whole.exr --max-rmse 1e-6").code, 0);
}

TEST(Merge, refuses_parts_that_do_not_belong_together) {
  const Workplace place;
  const std::string part = "render cube.stl --size 16x12 --quiet ";
  ASSERT_EQ(place.arris(part + "--samples 0..4 -o a.exr").code, 0);
  ASSERT_EQ(place.arris(part + "--samples 3..6 -o overlap.exr").code, 0);
  ASSERT_EQ(place.arris(part + "--samples 4..6 --seed 3 -o seed.exr").code, 0);
  ASSERT_EQ(place.arris(part + "--samples 4..6 --material brass -o scene.exr").code, 0);
  ASSERT_EQ(place.arris(part + "--samples 4..6 --aov depth -o layers.exr").code, 0);
  ASSERT_EQ(place.arris(part + "--samples 4..6 --round none -o sharp.exr").code, 0);
  const auto error = [&](const std::string& other) {
    const Outcome run = place.arris("merge a.exr " + other + " -o c.exr");
    EXPECT_EQ(run.code, 2);
    EXPECT_FALSE(std::filesystem::exists(place / "c.exr"));
    return run.err;
  };
  EXPECT_EQ(error("overlap.exr"),
            "arris: overlap.exr: holds the samples 3..4 that are also in a.exr\n");
  EXPECT_THAT(error("a.exr"), HasSubstr("holds the samples 0..4 that are also in a.exr"));
  EXPECT_THAT(error("seed.exr"), HasSubstr("seed.exr: has seed 3, not 0"));
  EXPECT_THAT(error("scene.exr"), HasSubstr("shows another scene"));
  EXPECT_THAT(error("sharp.exr"), HasSubstr("shows another scene"));
  EXPECT_THAT(error("layers.exr"), HasSubstr("layers.exr: has 1 layers, the part before 0"));
  ASSERT_EQ(place.arris(part + "--samples 4..6 -o p.png").code, 0);
  EXPECT_THAT(error("p.png"), HasSubstr("p.png: is no part of a render"));
}

// ---- breaks

TEST(Checkpoint, going_on_gives_the_same_bytes) {
  const Workplace place;
  ASSERT_EQ(place.arris(std::string(kPart) + "--spp 14 -o whole.exr").code, 0);
  ASSERT_EQ(place.arris(std::string(kPart) + "--spp 9 --checkpoint c.exr -o part.exr").code, 0);
  ASSERT_EQ(place.arris(std::string(kPart) + "--spp 14 --checkpoint c.exr -o resumed.exr").code, 0);
  EXPECT_TRUE(place.read("resumed.exr") == place.read("whole.exr"));
  EXPECT_TRUE(place.read("part.exr") != place.read("whole.exr"));
}

TEST(Checkpoint, of_another_render_is_refused_and_kept) {
  const Workplace place;
  ASSERT_EQ(place.arris(std::string(kPart) + "--spp 4 --checkpoint c.exr -o a.exr").code, 0);
  const std::string before = place.read("c.exr");
  for (const char* other : {"--seed 4", "--fov 50", "--aov depth"}) {
    const Outcome run = place.arris(std::string("render cube.stl --size 40x30 --quiet --spp 8 ") +
                                    other + " --checkpoint c.exr -o b.exr");
    EXPECT_EQ(run.code, 2) << other;
    EXPECT_THAT(run.err, HasSubstr("c.exr: ")) << other;
    EXPECT_THAT(run.err, HasSubstr("delete it or name another file")) << other;
  }
  EXPECT_TRUE(place.read("c.exr") == before);
}

// Renders without end until a signal comes; the shell waits for it.
std::string signalled(const std::string& signal, const std::string& options) {
  return "'" ARRIS_BINARY_DIR "/arris' render cube.stl --size 40x30 --spp 16000000 " + options +
         " & pid=$!; sleep 1.5; kill -" + signal + " $pid; wait $pid";
}

TEST(Interrupted, keeps_the_samples_made_so_far) {
  const Workplace place;
  for (const char* signal : {"INT", "TERM"}) {
    // Shells start background jobs with SIGINT ignored; TERM is the same request.
    const Outcome run = place.shell("trap - INT; " + signalled(signal, "-o a.exr"));
    if (std::string_view(signal) == "INT" && run.code == -1) continue;
    EXPECT_EQ(run.code, 1) << run.err;
    EXPECT_THAT(run.err, HasSubstr("arris: stopped; the picture holds samples 0.."));
    const PictureFile file = load_picture_file(place / "a.exr");
    EXPECT_EQ(file.picture.color.width_px, 40);
    EXPECT_GT(sample_count(render_part_of(file, "a.exr")), 0U);
  }
}

TEST(Interrupted, edge_point_keeps_the_picture_it_has) {
  const Workplace place;
  const Outcome run = place.shell(signalled("TERM", "--quiet --integrator edge-point -o a.pfm"));
  EXPECT_EQ(run.code, 1);
  EXPECT_THAT(run.err, HasSubstr("arris: stopped; the picture "));
  EXPECT_EQ(load_picture(place / "a.pfm").color.width_px, 40);
}

TEST(Interrupted, a_part_and_its_rest_make_the_whole) {
  const Workplace place;
  const Outcome run = place.shell(signalled("TERM", "--quiet --checkpoint c.exr -o a.exr"));
  EXPECT_EQ(run.code, 1);
  const RenderPart part = render_part_of(load_picture_file(place / "a.exr"), "a.exr");
  const RenderPart saved = render_part_of(load_picture_file(place / "c.exr"), "c.exr");
  EXPECT_EQ(saved.samples[0].last, part.samples[0].last);
  EXPECT_TRUE(place.read("a.exr") == place.read("c.exr"));
}

TEST(Interrupted, before_the_first_sample_leaves_the_old_file) {
  const Workplace place;
  for (const char* name : {"a.pfm", "a.png", "a.exr", "a.jpg --integrator edge-point"}) {
    const std::string file = std::string(name).substr(0, 5);
    test::write_text(place / file, "old");
    const Outcome run =
        place.shell(std::string("'" ARRIS_BINARY_DIR "/arris' render cube.stl --quiet --spp 4 "
                                "--size 4000x3000 --stats s.json -o ") +
                    name + " & pid=$!; sleep 0.7; kill -TERM $pid; wait $pid");
    EXPECT_EQ(run.code, 1) << name;
    EXPECT_EQ(run.err, "arris: stopped before the first sample\n");
    EXPECT_EQ(place.read(file), "old");
    EXPECT_FALSE(std::filesystem::exists(place / "s.json"));
  }
}

TEST(Interrupted, killed_at_once_leaves_the_old_file) {
  const Workplace place;
  test::write_text(place / "a.png", "old");
  const Outcome run = place.shell(signalled("KILL", "--quiet -o a.png"));
  EXPECT_NE(run.code, 0);
  EXPECT_EQ(place.read("a.png"), "old");
}

TEST(RoundingNotes, of_several_objects_are_said_once) {
  const Workplace place;
  test::write_text(place / "open.off",
                   "OFF\n4 3 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n"
                   "3 0 2 1\n3 0 1 3\n3 0 3 2\n");
  test::write_text(place / "two.toml",
                   "round = { radius = 0.05 }\n"
                   "[[object]]\nfile = \"open.off\"\nname = \"a\"\n"
                   "[[object]]\nfile = \"open.off\"\nname = \"b\"\ntranslate = [4, 0, 0]\n");
  const std::string render = "render two.toml --size 16x12 --spp 1 -o a.png";
  const Outcome run = place.arris(render);
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("2 objects: 2 shells are not closed"));
  EXPECT_THAT(run.err, Not(HasSubstr("a: 1 shell")));
  EXPECT_THAT(place.arris(render + " --verbose").err, HasSubstr("b: 1 shell is not closed"));
}

TEST(Interrupted, a_time_limit_is_no_failure) {
  const Workplace place;
  const Outcome run = place.arris("render cube.stl --size 40x30 --time 0.3 -o a.exr");
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_GT(sample_count(render_part_of(load_picture_file(place / "a.exr"), "a.exr")), 0U);
}

// ------------------------------------------------------------------------------------------ frames

constexpr const char* kMoving = R"(
[animation]
interpolation = "linear"
[camera]
position = [0, -9, 0]
[[camera.key]]
frame = 0
[[camera.key]]
frame = 4
fov = 70
[[object]]
file = "cube.stl"
round = "auto"
[[object.key]]
frame = -2
translate = [-1, -1, -1]
[[object.key]]
frame = 2
translate = [1, -1, -1]
)";

Outcome render_frames(const Workplace& place, const std::string& options) {
  test::write_text(place / "moving.toml", kMoving);
  return place.arris("render moving.toml --size 40x30 --spp 2 " + options);
}

TEST(Frames, are_files_with_their_numbers) {
  const Workplace place;
  const Outcome run = render_frames(place, "-o f_###.png --aov depth --frames=-2..2");
  ASSERT_EQ(run.code, 0) << run.err;
  for (const char* number : {"-02", "-01", "000", "001"}) {
    const std::string name = std::string("f_") + number;
    EXPECT_THAT(run.err, HasSubstr(name + ".png: 40 x 30 pixels, samples 0..2"));
    EXPECT_TRUE(std::filesystem::exists(place / (name + ".png")));
    EXPECT_TRUE(std::filesystem::exists(place / (name + ".depth.pfm")));
  }
  EXPECT_FALSE(std::filesystem::exists(place / "f_002.png"));
  EXPECT_NE(place.read("f_-02.png"), place.read("f_-01.png"));
}

TEST(Frames, do_not_depend_on_which_others_are_rendered) {
  const Workplace place;
  ASSERT_EQ(render_frames(place, "-o all_#.exr --frames 0..4").code, 0);
  ASSERT_EQ(render_frames(place, "-o one_#.exr --frames 3..4").code, 0);
  EXPECT_TRUE(place.read("all_3.exr") == place.read("one_3.exr"));
}

TEST(Frames, without_the_option_frame_0_is_rendered) {
  const Workplace place;
  ASSERT_EQ(render_frames(place, "-o frame_#.pfm --frames 0..1").code, 0);
  ASSERT_EQ(render_frames(place, "-o single#.pfm").code, 0);
  const Image frame = load_picture(place / "frame_0.pfm").color;
  const Image single = load_picture(place / "single#.pfm").color;
  double difference = 0;
  for (std::size_t i = 0; i < frame.values.size(); ++i) {
    difference += std::abs(double(frame.values[i]) - double(single.values[i]));
  }
  EXPECT_LT(difference / double(frame.values.size()), 2e-3);  // it is placed another way
}

TEST(Frames, are_rendered_in_beams_too) {
  const Workplace place;
  const Outcome run =
      render_frames(place, "-o f_#.png --integrator beam --round none --frames 0..2");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("f_1.png: 40 x 30 pixels, "));
}

TEST(Frames, are_made_of_edges_and_points_too) {
  const Workplace place;
  test::write_text(place / "moving.toml", kMoving);
  const std::string options =
      "render moving.toml --size 80x60 --integrator edge-point --density 0.1 --frames 0..3 ";
  const Outcome run = place.arris(options + "--aov edges -o f_#.png --stats s.json");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("f_2.png: 80 x 60 pixels, "));
  EXPECT_THAT(run.err, HasSubstr(" points shaded, "));
  EXPECT_TRUE(std::filesystem::exists(place / "f_1.edges.png"));
  const auto stats = nlohmann::json::parse(place.read("s.json"));
  EXPECT_EQ(stats["frames"], 3);
  const auto& edge_point = stats["edge_point"];
  EXPECT_EQ(edge_point["frames"], 3);
  EXPECT_GT(edge_point["stages_ms"]["total"], 0);
  EXPECT_GT(edge_point["edges"]["silhouette"], 0);
  EXPECT_NEAR(edge_point["new_samples_fraction"], 0.1, 0.03);
  const double classes = double(edge_point["classes"]["empty"]) +
                         double(edge_point["classes"]["simple"]) +
                         double(edge_point["classes"]["complex"]);
  EXPECT_NEAR(classes, 1, 0.02);
  // The same at any number of threads.
  ASSERT_EQ(place.arris(options + "-o g_#.png --threads 1").code, 0);
  EXPECT_TRUE(place.read("f_2.png") == place.read("g_2.png"));
}

TEST(Render, denoises_and_says_so) {
  const Workplace place;
  const Outcome run =
      place.arris("render cube.stl --size 40x30 --spp 4 --denoise edges --aov albedo -o d.exr");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("d.exr: 40 x 30 pixels, samples 0..4, denoised, "));
  ASSERT_EQ(place.arris("render cube.stl --size 40x30 --spp 4 -o n.exr").code, 0);
  EXPECT_TRUE(place.read("d.exr") != place.read("n.exr"));
}

TEST(Frames, that_are_cheap_are_traced_and_say_so) {
  const Workplace place;
  test::write_text(place / "moving.toml", kMoving);
  const std::string options =
      "render moving.toml --size 20x16 --integrator edge-point --frames 0..2 -o f_#.png ";
  const Outcome run = place.arris(options + "--stats s.json");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("f_1.png: 20 x 16 pixels, every pixel traced, "));
  EXPECT_EQ(nlohmann::json::parse(place.read("s.json"))["edge_point"]["traced"], 2);
  EXPECT_THAT(place.arris(options + "--trace-below 0").err, HasSubstr(" points shaded, "));
}

TEST(Render, of_edges_and_points_stands_still_until_each_pixel_has_its_paths) {
  const Workplace place;
  const Outcome run =
      place.arris("render cube.stl --size 60x40 --spp 32 --integrator edge-point -o still.png");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("still.png: 60 x 40 pixels, samples 0..32"));
}

TEST(Frames, have_statistics_in_sum) {
  const Workplace place;
  const Outcome run = render_frames(place, "-o f_#.png --quiet --frames 0..3 --stats -");
  ASSERT_EQ(run.code, 0) << run.err;
  const auto stats = nlohmann::json::parse(run.out);
  EXPECT_EQ(stats["frames"], 3);
  EXPECT_EQ(stats["rays"]["camera"], 3 * 2 * 40 * 30);
  EXPECT_EQ(stats["triangles"], 12);
}

TEST(Frames, never_replace_the_input) {
  const Workplace place;
  test::write_text(place / "moving.toml", kMoving);
  ASSERT_EQ(place.shell("cp moving.toml s_2.png; ln -s s_2.png in.toml").code, 0);
  const Outcome run = place.arris("render in.toml -o s_#.png --frames 0..4");
  EXPECT_EQ(run.code, 2);
  EXPECT_EQ(run.err, "arris: s_2.png: INPUT and -o are one file; name another\n");
}

TEST(Frames, that_make_no_scene_are_found_before_any_is_rendered) {
  const Workplace place;
  test::write_text(place / "turn.toml", R"([camera]
position = [0, -9, 0]
[[light]]
type = "directional"
direction = [0, 0, -1]
[[light.key]]
frame = 0
[[light.key]]
frame = 8
direction = [0, 0, 1]
[[object]]
file = "cube.stl"
)");
  const Outcome run = place.arris("render turn.toml -o f_#.png --size 40x30 --frames 0..8");
  EXPECT_EQ(run.code, 2);
  EXPECT_EQ(run.err,
            "arris: turn.toml: frame 4: light 1: direction is (0, 0, 0); give a vector other than "
            "0; move the keys around it\n");
  EXPECT_FALSE(std::filesystem::exists(place / "f_0.png"));
}

TEST(Frames, that_are_finished_stay_when_stopped) {
  const Workplace place;
  test::write_text(place / "moving.toml", kMoving);
  const Outcome run = place.shell(
      "'" ARRIS_BINARY_DIR
      "/arris' render moving.toml --size 40x30 --time 0.4 -o f_#.png --frames 0..1000 & pid=$!; "
      "sleep 1.5; kill -TERM $pid; wait $pid");
  EXPECT_EQ(run.code, 1);
  EXPECT_THAT(run.err, HasSubstr("arris: stopped; frames 0.."));
  EXPECT_THAT(run.err, HasSubstr(" are finished, go on with --frames "));
  EXPECT_EQ(load_picture(place / "f_0.png").color.width_px, 40);
  EXPECT_FALSE(std::filesystem::exists(place / "f_900.png"));
}

}  // namespace
}  // namespace arris
