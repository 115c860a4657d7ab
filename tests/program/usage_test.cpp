// What the program says about itself and about wrong usage.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string_view>

#include "program/run_program.h"

namespace arris {
namespace {

using test::Outcome;
using test::Workplace;
using testing::HasSubstr;

TEST(Usage, without_words_the_help_goes_to_stderr_with_code_2) {
  const Outcome run = Workplace().arris("");
  EXPECT_EQ(run.code, 2);
  EXPECT_EQ(run.out, "");
  EXPECT_THAT(run.err, HasSubstr("Usage: arris COMMAND"));
}

TEST(Usage, help_and_version_go_to_stdout) {
  const Workplace place;
  for (const char* command : {"--help", "render --help", "shoot --help", "info --help",
                              "merge --help", "compare --help"}) {
    const Outcome run = place.arris(command);
    EXPECT_EQ(run.code, 0) << command;
    EXPECT_EQ(run.err, "") << command;
    EXPECT_THAT(run.out, HasSubstr("Exit codes: 0 done")) << command;
    if (std::string_view(command) != "--help") {
      EXPECT_THAT(run.out, HasSubstr("Examples:"));
    }
  }
  EXPECT_THAT(place.arris("--version").out, testing::MatchesRegex("arris [0-9.]+\n"));
}

TEST(Usage, the_manual_is_that_of_this_build) {
  EXPECT_EQ(Workplace().arris("--help-markdown").out,
            test::read_text(ARRIS_SOURCE_DIR "/docs/cli.md"))
      << "run: build/release/arris --help-markdown > docs/cli.md";
}

struct Misuse {
  const char* arguments;
  const char* error;
};

class Misused : public testing::TestWithParam<Misuse> {};

TEST_P(Misused, ends_with_code_2_and_says_why) {
  const Outcome run = Workplace().arris(GetParam().arguments);
  EXPECT_EQ(run.code, 2);
  EXPECT_EQ(run.out, "");
  EXPECT_THAT(run.err, testing::StartsWith(std::string("arris: ") + GetParam().error));
}

INSTANTIATE_TEST_SUITE_P(
    Usage, Misused,
    testing::Values(
        Misuse{"rendr cube.stl", "there is no command \"rendr\"; did you mean \"render\"?\n"},
        Misuse{"view cube.stl --prot 1",
               "arris view has no option --prot; did you mean \"--port\"?\n"},
        Misuse{"render cube.stl", "arris render needs an output file: -o picture.png\n"},
        Misuse{"render -o a.png", "arris render needs INPUT; arris render --help shows examples\n"},
        Misuse{"render cube.stl b.stl -o a.png",
               "arris render takes INPUT only; \"b.stl\" is too much\n"},
        Misuse{"render cube.stl -o a.png --sise 10x10",
               "arris render has no option --sise; did you mean \"--size\"?\n"},
        Misuse{"render cube.stl -o a.png --xyzzy",
               "arris render has no option --xyzzy; arris render --help lists them\n"},
        Misuse{"render cube.stl -o a.png --frames 0..9",
               "a.png: --frames makes several pictures: put #### where the number of the frame "
               "goes, such as f_####.png\n"},
        Misuse{"render cube.stl -o a#b##.png --frames 0..9",
               "a#b##.png: has more than one run of #; leave one for the number of the frame\n"},
        Misuse{"render cube.stl -o - --frames 0..9",
               "--frames: needs output files, such as f_####.png, not stdout\n"},
        Misuse{"render cube.stl -o f_##.png --frames 0..9", "cube.stl: has no keys, so that "},
        Misuse{
            "render cube.stl -o f_##.png --frames 5..5",
            "--frames: \"5..5\" is no range of frames; use FIRST..END with FIRST below END, from "
            "-1000000 to 1000000, such as 0..48 for frames 0 to 47\n"},
        Misuse{"render cube.stl -o f_##.png --frames 0..1000002", "--frames: \"0..1000002\" is no"},
        Misuse{"render cube.stl -o f_##.png --frames 0.5..2", "--frames: \"0.5..2\" is no range"},
        Misuse{"render cube.stl -o f_##.png --frames 1..2 --checkpoint c.exr",
               "--checkpoint: can't be used with --frames; "},
        Misuse{"render cube.stl -o no/f_##.png --frames 1..2",
               "no/f_01.png: can't be written: there is no folder no\n"},
        Misuse{"render cube.stl -o f_#.png --frames 0..9 --stats f_7.png",
               "f_7.png: -o and --stats are one file; name another\n"},
        Misuse{"render cube.stl -o a.png --integrator beam --time 3",
               "--time: can't be used with --integrator beam, which makes its picture in one pass; "
               "leave it out or use --integrator path\n"},
        Misuse{"render cube.stl -o a.png --beam-rule corners",
               "--beam-rule: needs --integrator beam\n"},
        Misuse{"render cube.stl -o a.png --integrator edge-point --samples 0..4",
               "--samples: can't be used with --integrator edge-point, whose pictures are not sums "
               "of samples; leave it out or use --integrator path\n"},
        Misuse{"render cube.stl -o f_#.png --frames 0..2 --integrator edge-point --spp 4",
               "--spp: can't be used with the frames of --integrator edge-point; --density says "
               "how much is shaded for each\n"},
        Misuse{"render cube.stl -o a.png --integrator edge-point --trace-below 5",
               "--trace-below: needs --frames: a view that stands still goes over to paths by "
               "itself\n"},
        Misuse{"render cube.stl -o a.png --denoise edges --samples 0..4",
               "--denoise: can't be used with --samples: "},
        Misuse{"render cube.stl -o a.png --denoise edges --integrator beam",
               "--denoise: can't be used with --integrator beam, "},
        Misuse{"render cube.stl -o a.png --density 0.1",
               "--density: needs --integrator edge-point\n"},
        Misuse{"render cube.stl -o a.png --integrator edge-point --density 0", "--density: "},
        Misuse{"render cube.stl -o a.png --integrator edge-point --shader all",
               "--shader: \"all\" is not known; use one of direct, glossy, gi"},
        Misuse{"render cube.stl -o a.png --integrator edge-point --aov depth",
               "--aov: depth needs --integrator path\n"},
        Misuse{"render cube.stl -o a.png --integrator pth",
               "--integrator: \"pth\" is not known; use one of path, beam, edge-point; did you "
               "mean \"path\"?\n"},
        Misuse{"render cube.stl -o a.png --aov coverage_lo",
               "--aov: coverage_lo needs --integrator beam\n"},
        Misuse{"render cube.stl -o a.png --aov albeda",
               "--aov: \"albeda\" is not known; use one of albedo, normal, depth, object, rounded, "
               "bevel_fac; did you mean \"albedo\"?\n"},
        Misuse{"render cube.stl -o a.png --size", "--size takes one value, once: --size WxH\n"},
        Misuse{"render cube.stl -o a.png --size 10", "--size: \"10\" is no size; use WIDTHxHEIGHT"},
        Misuse{"render cube.stl -o a.png --size 0x10", "--size: \"0x10\" is out of range"},
        Misuse{"render cube.stl -o a.png --size 65535x65535",
               "--size: \"65535x65535\" is too large; use at most 134217728 pixels in all\n"},
        Misuse{"render cube.stl -o a.png --spp 0",
               "--spp: \"0\" is no whole number from 1 to 16777216\n"},
        Misuse{"render cube.stl -o a.png --spp 99999999999999999999",
               "--spp: \"99999999999999999999\" is no whole number"},
        Misuse{"render cube.stl -o a.png --spp 4 --samples 0..4",
               "--samples: can't be used together with --spp"},
        Misuse{"render cube.stl -o a.png --samples 4..4",
               "--samples: \"4..4\" is no range of samples"},
        Misuse{"render cube.stl -o a.png --time x", "--time: \"x\" is no number\n"},
        Misuse{"render cube.stl -o a.png --time nan",
               "--time: \"nan\" is out of range; use 0.01 to 1e+08\n"},
        Misuse{"render cube.stl -o a.png --fov 180",
               "--fov: \"180\" is out of range; use 0.01 to 178\n"},
        Misuse{"render cube.stl -o a.png --camera-position 1,2",
               "--camera-position: \"1,2\" is no point"},
        Misuse{"render cube.stl -o a.png --camera-up 0,0,0", "--camera-up: 0,0,0 is no direction"},
        Misuse{"render cube.stl -o a.png --round 0",
               "--round: \"0\" is out of range; use a radius above 0"},
        Misuse{"render cube.stl -o a.png --round 100%", "--round: \"100%\" is out of range"},
        Misuse{"render cube.stl -o a.png --round big",
               "--round: \"big\" is no radius; use auto, none"},
        Misuse{"render cube.stl -o a.png --round-edges convx",
               "--round-edges: \"convx\" is not known; use one of convex, concave, both; did you "
               "mean \"convex\"?\n"},
        Misuse{"info cube.stl --round-on-overlap clip",
               "--round-on-overlap: \"clip\" is not known; use one of report, clamp"},
        Misuse{"render cube.stl -o a.png --round-method mesh",
               "--round-method: \"mesh\" is incomplete"},
        Misuse{"render cube.stl -o a.png --round-method mesh:0",
               "--round-method mesh:N: \"0\" is no whole"},
        Misuse{"render cube.stl -o a.png --round-min-angle 200",
               "--round-min-angle: \"200\" is out of range"},
        Misuse{"render cube.stl -o a.png --lighting stdio",
               "--lighting: \"stdio\" is not known; use one of studio, sky, white; did you mean "
               "\"studio\"?\n"},
        Misuse{"render cube.stl -o a.png --material bras",
               "--material: \"bras\" is no material; did you mean \"brass\"?"},
        Misuse{"render cube.stl -o a.png --threads 0",
               "--threads: \"0\" is no whole number from 1"},
        Misuse{"render cube.stl -o a.gif",
               "a.gif: \".gif\" is no picture format that can be written"},
        Misuse{"render cube.stl -o a", "a: has no extension; use .png, .jpg, .exr or .pfm\n"},
        Misuse{"render none.stl -o a.png",
               "none.stl: can't be opened: No such file or directory\n"},
        Misuse{"render cube.xyz -o a.png", "cube.xyz: the extension"},
        Misuse{"render cube.stl -o a.png --checkpoint a.png",
               "--checkpoint: needs a file that ends in .exr\n"},
        Misuse{"render cube.stl -o - --aov albedo", "--aov: needs an output file, not stdout\n"},
        Misuse{"render cube.stl -o a.png --quiet=false", "--quiet takes no value\n"},
        Misuse{"info cube.stl --json=2", "--json takes no value\n"},
        Misuse{"info --help=1", "--help takes no value\n"},
        Misuse{"render cube.stl -o a.png --quiet --verbose",
               "--quiet and --verbose contradict each other; use one of them\n"},
        Misuse{"render cube.stl -o a.png --round 0.5 --round-method none",
               "--round-method: \"none\" contradicts --round 0.5; leave one of them out\n"},
        Misuse{"info cube.stl --round none --round-method mesh:3",
               "--round-method: \"mesh:3\" contradicts --round none; leave one of them out\n"},
        Misuse{"shoot - --rays -", "--rays: and INPUT can't both be read from stdin"},
        Misuse{"info - < /dev/null", "stdin: is empty; a model is needed\n"},
        Misuse{"shoot cube.stl", "arris shoot needs rays: --rays FILE"},
        Misuse{"shoot cube.stl --rays none.txt", "none.txt: can't be opened"},
        Misuse{"merge a.exr", "arris merge needs an output file: -o whole.exr\n"},
        Misuse{"merge cube.stl -o b.exr",
               "cube.stl: is no PNG, JPEG, EXR, PFM or Radiance HDR picture\n"},
        Misuse{"compare a.png", "arris compare needs A B; arris compare --help shows examples\n"},
        Misuse{"compare cube.stl cube.stl", "cube.stl: is no PNG, JPEG, EXR, PFM"}));

TEST(Usage, a_wrong_option_is_told_before_the_model_is_read) {
  EXPECT_THAT(Workplace().arris("render none.stl -o a.png --spp x").err, HasSubstr("--spp"));
}

TEST(Usage, outputs_that_can_not_be_written_are_refused_before_any_work) {
  const Workplace place;
  for (const char* arguments :
       {"render cube.stl -o none/a.png", "render cube.stl -o a.png --stats none/s.json",
        "render cube.stl -o a.png --checkpoint none/c.exr", "merge x.exr -o none/a.exr",
        "compare x.png y.png --diff none/d.png"}) {
    const Outcome run = place.arris(arguments);
    EXPECT_EQ(run.code, 2) << arguments;
    EXPECT_THAT(run.err, HasSubstr("can't be written: there is no folder none")) << arguments;
  }
  EXPECT_EQ(place.shell("mkdir d.png; arris render cube.stl -o d.png").code, 2);
  const Outcome layer =
      place.shell("mkdir a.depth.pfm; arris render cube.stl -o a.png --aov depth");
  EXPECT_EQ(layer.code, 2);
  EXPECT_EQ(layer.err, "arris: a.depth.pfm: can't be written: it is a folder\n");
  EXPECT_THAT(place.arris("compare x.png y.png --diff d.gif").err,
              HasSubstr("d.gif: \".gif\" is no picture format"));
  EXPECT_THAT(place.arris("render cube.stl --size 65535x1 -o a.jpg").err,
              HasSubstr("a.jpg: 65535 x 1 pixels are too many for JPEG"));
  EXPECT_FALSE(std::filesystem::exists(place / "a.png"));
}

TEST(Usage, files_that_would_overwrite_each_other_are_refused) {
  const Workplace place;
  const std::string cube = place.read("cube.stl");
  ASSERT_EQ(
      place.shell("ln -s cube.stl link.json; ln cube.stl hard.json; ln -s a.exr b.exr; mkdir d")
          .code,
      0);
  const auto error = [&](const std::string& arguments) {
    const Outcome run = place.arris("render cube.stl --size 8x8 --spp 1 " + arguments);
    EXPECT_EQ(run.code, 2) << arguments;
    EXPECT_EQ(place.read("cube.stl"), cube);
    EXPECT_FALSE(std::filesystem::exists(place / "a.exr"));
    return run.err;
  };
  for (const char* stats : {"cube.stl", "./cube.stl", "link.json", "hard.json", "d/../cube.stl"}) {
    EXPECT_THAT(error(std::string("-o a.exr --stats ") + stats),
                HasSubstr(": INPUT and --stats are one file; name another\n"));
  }
  EXPECT_THAT(error("-o a.exr --stats a.exr"), HasSubstr("-o and --stats are one file"));
  EXPECT_THAT(error("-o a.exr --checkpoint d/../a.exr"), HasSubstr("-o and --checkpoint are one"));
  EXPECT_THAT(error("-o a.exr --checkpoint b.exr"), HasSubstr("-o and --checkpoint are one file"));
  EXPECT_THAT(error("-o a.png --aov depth --stats a.depth.pfm"),
              HasSubstr("--aov depth and --stats are one file"));
  EXPECT_EQ(place.arris("render cube.stl --size 8x8 --spp 1 -o a.png --stats /dev/null").code, 0);
}

TEST(Usage, a_link_to_nothing_stays_a_link) {
  const Workplace place;
  const Outcome run = place.shell(
      "mkdir d; ln -s d/real.png link.png; "
      "arris render cube.stl --size 8x8 --spp 1 --quiet -o link.png");
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_TRUE(std::filesystem::is_symlink(place / "link.png"));
  EXPECT_TRUE(std::filesystem::is_regular_file(place / "d/real.png"));
}

TEST(Usage, words_after_two_dashes_are_files) {
  const Workplace place;
  EXPECT_EQ(place.shell("cp cube.stl ./-x.stl; arris info -- -x.stl").code, 0);
  EXPECT_EQ(place.arris("info --quiet -- -x.stl").code, 0);
  EXPECT_EQ(place.arris("info -x.stl").code, 2);
}

TEST(Usage, extensions_may_be_in_any_case) {
  const Workplace place;
  test::write_text(place / "s.toml", "[[object]]\nfile = \"cube.stl\"\n");
  ASSERT_EQ(place.shell("cp s.toml S.TOML").code, 0);
  const std::string render = "render --size 16x12 --spp 2 --quiet ";
  ASSERT_EQ(place.arris(render + "s.toml -o a.exr").code, 0);
  ASSERT_EQ(place.arris(render + "S.TOML -o b.EXR").code, 0);
  EXPECT_TRUE(place.read("a.exr") == place.read("b.EXR"));
  EXPECT_EQ(place.arris("info s.toml --json").out, place.arris("info S.TOML --json").out);
  ASSERT_EQ(place.arris(render + "cube.stl -o c.exr").code, 0);
  EXPECT_EQ(place.arris("compare a.exr c.exr").out, place.arris("compare b.EXR c.exr").out);
}

TEST(Usage, a_full_disk_is_a_failure) {
  const Outcome run =
      Workplace().shell("arris render cube.stl --size 8x8 --spp 1 -o - > /dev/full");
  EXPECT_EQ(run.code, 1);
  EXPECT_THAT(run.err, HasSubstr("stdout: can't be written"));
}

TEST(Usage, messages_that_can_not_be_printed_change_nothing_else) {
  const Workplace place;
  const std::string render = "arris render cube.stl --size 8x8 --spp 1 ";
  ASSERT_EQ(place.shell(render + "-o a.png").code, 0);
  for (const char* nowhere : {"2>/dev/full", "2>&-", "<&- 2>&-", "2>&1 >/dev/full | true"}) {
    ASSERT_EQ(place.shell(render + "-o b.png " + nowhere).code, 0) << nowhere;
    EXPECT_TRUE(place.read("b.png") == place.read("a.png")) << nowhere;
    if (std::string_view(nowhere).ends_with("true")) continue;
    EXPECT_EQ(place.shell("arris render none.stl -o c.png " + std::string(nowhere)).code, 2);
  }
}

TEST(Usage, results_that_can_not_be_printed_are_a_failure) {
  const Workplace place;
  for (const char* nowhere : {">/dev/full", ">&-"}) {
    for (const char* command : {"info cube.stl", "--help", "render cube.stl --material list"}) {
      const Outcome run = place.shell(std::string("arris ") + command + nowhere);
      EXPECT_EQ(run.code, 1) << command << nowhere;
    }
  }
}

TEST(Usage, quiet_is_silent) {
  const Outcome run = Workplace().arris("render cube.stl --size 8x8 --spp 1 -o a.png --quiet");
  EXPECT_EQ(run.code, 0);
  EXPECT_EQ(run.out + run.err, "");
}

TEST(Usage, more_threads_than_processors_are_no_matter) {
  for (const char* threads : {"7", "1024"}) {
    const Outcome run = Workplace().arris(
        std::string("render cube.stl --size 8x8 --spp 1 -o a.png --quiet --threads ") + threads);
    EXPECT_EQ(run.code, 0);
    EXPECT_EQ(run.out + run.err, "");
  }
}

TEST(Usage, models_come_through_pipes) {
  const Workplace place;
  const std::string options = " --size 16x12 --spp 1 --quiet";
  ASSERT_EQ(place.arris("render cube.stl -o file.png" + options).code, 0);
  const Outcome run = place.shell("arris render - -o pipe.png" + options + " < cube.stl");
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_TRUE(place.read("pipe.png") == place.read("file.png"));
  EXPECT_THAT(place.shell("arris info - < cube.stl").out, HasSubstr("stdin: 12 triangles"));
  EXPECT_EQ(
      place.shell("echo '1 1 9 0 0 -1' > rays.txt; arris shoot - --rays rays.txt < cube.stl").code,
      0);
}

TEST(Usage, scenes_come_through_pipes) {
  const Workplace place;
  test::write_text(place / "scene.toml", "round = 0.1\n[[object]]\nfile = \"cube.stl\"\n");
  EXPECT_THAT(place.shell("arris info - < scene.toml").out, HasSubstr("radius 0.1: 12 edges"));
  const Outcome run = place.shell("echo 'what is this' | arris info -");
  EXPECT_EQ(run.code, 2);
  EXPECT_THAT(run.err, HasSubstr("stdin: holds no model that Arris knows by its content"));
}

TEST(Usage, materials_are_listed) {
  const Outcome run = Workplace().arris("render --material list");
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(Workplace().arris("render cube.stl --material list").out, run.out);
  for (const char* name : {"brass", "glass", "clay", "porcelain", "rubber", "steel"}) {
    EXPECT_THAT(run.out, HasSubstr(name));
  }
}

}  // namespace
}  // namespace arris
