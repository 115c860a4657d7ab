// What the program says about itself and about wrong usage.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

TEST(Usage, help_lists_only_what_works) {
  const std::string help = Workplace().arris("render --help").out;
  for (const char* missing : {"beam", "edge-point", "--frames", "coverage_lo"}) {
    EXPECT_THAT(help, testing::Not(HasSubstr(missing)));
  }
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
        Misuse{"view cube.stl",
               "arris view is not in this build; render a picture with arris render\n"},
        Misuse{"render cube.stl", "arris render needs an output file: -o picture.png\n"},
        Misuse{"render -o a.png", "arris render needs INPUT; arris render --help shows examples\n"},
        Misuse{"render cube.stl b.stl -o a.png",
               "arris render takes INPUT only; \"b.stl\" is too much\n"},
        Misuse{"render cube.stl -o a.png --sise 10x10",
               "arris render has no option --sise; did you mean \"--size\"?\n"},
        Misuse{"render cube.stl -o a.png --xyzzy",
               "arris render has no option --xyzzy; arris render --help lists them\n"},
        Misuse{"render cube.stl -o a.png --frames 0..9",
               "--frames is not in this build; render one picture at a time\n"},
        Misuse{"render cube.stl -o a.png --integrator beam",
               "integrator beam is not in this build; use path\n"},
        Misuse{"render cube.stl -o a.png --integrator edge-point",
               "integrator edge-point is not in this build; use path\n"},
        Misuse{"render cube.stl -o a.png --integrator pth",
               "--integrator: \"pth\" is not known; did you mean \"path\"?; use one of path\n"},
        Misuse{"render cube.stl -o a.png --aov coverage_lo",
               "--aov: coverage_lo needs the integrator beam"},
        Misuse{"render cube.stl -o a.png --aov albeda",
               "--aov: \"albeda\" is not known; did you mean \"albedo\"?"},
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
               "--fov: \"180\" is out of range; use 0.01 to 170\n"},
        Misuse{"render cube.stl -o a.png --camera-position 1,2",
               "--camera-position: \"1,2\" is no point"},
        Misuse{"render cube.stl -o a.png --camera-up 0,0,0", "--camera-up: 0,0,0 is no direction"},
        Misuse{"render cube.stl -o a.png --round 0",
               "--round: \"0\" is out of range; use a radius above 0"},
        Misuse{"render cube.stl -o a.png --round 100%", "--round: \"100%\" is out of range"},
        Misuse{"render cube.stl -o a.png --round big",
               "--round: \"big\" is no radius; use auto, none"},
        Misuse{"render cube.stl -o a.png --round-edges convx",
               "--round-edges: \"convx\" is not known; did you mean \"convex\"?"},
        Misuse{"render cube.stl -o a.png --round-method mesh",
               "--round-method: \"mesh\" is incomplete"},
        Misuse{"render cube.stl -o a.png --round-method mesh:0",
               "--round-method mesh:N: \"0\" is no whole"},
        Misuse{"render cube.stl -o a.png --round-min-angle 200",
               "--round-min-angle: \"200\" is out of range"},
        Misuse{"render cube.stl -o a.png --lighting stdio",
               "--lighting: \"stdio\" is not known; did you mean \"studio\"?"},
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

TEST(Usage, outputs_that_can_not_be_written_fail_with_code_1_before_rendering) {
  const Workplace place;
  for (const char* arguments :
       {"render cube.stl -o none/a.png", "render cube.stl -o a.png --stats none/s.json",
        "render cube.stl -o a.png --checkpoint none/c.exr"}) {
    const Outcome run = place.arris(arguments);
    EXPECT_EQ(run.code, 1) << arguments;
    EXPECT_THAT(run.err, HasSubstr("can't be written: there is no folder none")) << arguments;
  }
  EXPECT_EQ(place.shell("mkdir d.png; arris render cube.stl -o d.png").code, 1);
  EXPECT_FALSE(std::filesystem::exists(place / "a.png"));
}

TEST(Usage, a_full_disk_is_a_failure) {
  const Outcome run =
      Workplace().shell("arris render cube.stl --size 8x8 --spp 1 -o - > /dev/full");
  EXPECT_EQ(run.code, 1);
  EXPECT_THAT(run.err, HasSubstr("stdout: can't be written"));
}

TEST(Usage, quiet_is_silent) {
  const Outcome run = Workplace().arris("render cube.stl --size 8x8 --spp 1 -o a.png --quiet");
  EXPECT_EQ(run.code, 0);
  EXPECT_EQ(run.out + run.err, "");
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
