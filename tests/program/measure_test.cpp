// arris shoot and arris compare, end to end.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "arris/io.h"
#include "program/run_program.h"

namespace arris {
namespace {

using nlohmann::json;
using test::Outcome;
using test::Workplace;
using testing::HasSubstr;

std::vector<json> lines_of(const std::string& text) {
  std::vector<json> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(json::parse(line));
  return lines;
}

Outcome shoot(const Workplace& place, const std::string& rays, const std::string& options = "") {
  test::write_text(place / "rays.txt", rays);
  return place.arris("shoot cube.stl --rays rays.txt " + options);
}

TEST(Shoot, gives_exact_hits_on_flat_faces) {
  const Workplace place;
  const Outcome run = shoot(place,
                            "# from above, twice as long as unit; from inside; past it; slanted\n"
                            "0.3 0.7 9 0 0 -2\n\n"
                            "0.3 0.7 0.5 1 0 0\n"
                            "5 5 9 0 0 -1\n"
                            "-1 0.1 0.2 3 1 1\n");
  ASSERT_EQ(run.code, 0) << run.err;
  const std::vector<json> hits = lines_of(run.out);
  ASSERT_EQ(hits.size(), 4U);
  EXPECT_EQ(hits[0]["t"].get<double>(), 3.5);
  EXPECT_EQ(hits[0]["position"], json({0.3, 0.7, 2.0}));
  EXPECT_EQ(hits[0]["normal"], json({0.0, 0.0, 1.0}));
  EXPECT_EQ(hits[0]["feature"], "face");
  EXPECT_EQ(hits[0]["object"], "cube");
  EXPECT_EQ(hits[0]["inside"], false);
  EXPECT_NEAR(hits[1]["t"].get<double>(), 1.7, 1e-15);
  EXPECT_EQ(hits[1]["normal"], json({1.0, 0.0, 0.0})) << "outward also from inside";
  EXPECT_EQ(hits[1]["inside"], true);
  EXPECT_TRUE(hits[2]["t"].is_null());
  EXPECT_NEAR(hits[3]["t"].get<double>(), 1.0 / 3, 1e-15);
  EXPECT_NEAR(hits[3]["position"][1].get<double>(), 0.1 + 1.0 / 3, 1e-15);
}

TEST(Shoot, prints_numbers_with_all_their_digits) {
  const Outcome run = shoot(Workplace(), "0.1 0.7 9 0 0 -3\n");
  EXPECT_THAT(run.out, HasSubstr("\"t\": 2.3333333333333335,"));
  EXPECT_THAT(run.out, HasSubstr("\"position\": [0.10000000000000001, 0.69999999999999996, 2]"));
}

TEST(Shoot, far_rays_lose_no_precision) {
  const std::vector<json> hits =
      lines_of(shoot(Workplace(), "0.3 0.7 1e9 0 0 -1\n0.3 0.7 1e9 0 0 -1e9\n").out);
  EXPECT_EQ(hits[0]["t"].get<double>(), 1e9 - 2);
  EXPECT_NEAR(hits[1]["t"].get<double>(), 1 - 2e-9, 1e-15);
}

TEST(Shoot, reads_rays_from_stdin) {
  const Outcome run = Workplace().shell("echo '1 1 9 0 0 -1' | arris shoot cube.stl --rays -");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(lines_of(run.out)[0]["t"].get<double>(), 7);
}

// A cube of side 2 with edges rounded by 0.5: the edge x = 0, z = 2 has its axis at x = 0.5, z = 1.5.
TEST(Shoot, meets_rounded_edges_and_corners_where_they_are) {
  const Outcome run = shoot(Workplace(),
                            "0.5 1 9 0 0 -1\n"
                            "0.1 1 9 0 0 -1\n"
                            "0.1 0.1 9 0 0 -1\n"
                            "0.01 0.01 9 0 0 -1\n",
                            "--round 0.5");
  ASSERT_EQ(run.code, 0) << run.err;
  const std::vector<json> hits = lines_of(run.out);
  EXPECT_NEAR(hits[0]["position"][2].get<double>(), 2, 1e-6);
  EXPECT_EQ(hits[1]["feature"], "edge");
  EXPECT_NEAR(hits[1]["position"][2].get<double>(), 1.5 + std::sqrt(0.25 - 0.16), 1e-5);
  EXPECT_NEAR(hits[1]["normal"][0].get<double>(), -0.8, 1e-4);
  EXPECT_NEAR(hits[1]["normal"][2].get<double>(), 0.6, 1e-4);
  EXPECT_TRUE(hits[2]["t"].is_null()) << "0.566 from the corner's axis: past the sphere";
  EXPECT_TRUE(hits[3]["t"].is_null());
  const std::vector<json> corner =
      lines_of(shoot(Workplace(), "0.3 0.3 9 0 0 -1\n", "--round 0.5").out);
  EXPECT_EQ(corner[0]["feature"], "corner");
  EXPECT_NEAR(corner[0]["position"][2].get<double>(), 1.5 + std::sqrt(0.25 - 0.08), 1e-5);
}

TEST(Shoot, bad_rays_are_errors_with_their_line) {
  const Workplace place;
  const auto error = [&](const std::string& rays) {
    const Outcome run = shoot(place, "0 0 9 0 0 -1\n" + rays);
    EXPECT_EQ(run.code, 2) << rays;
    return run.err;
  };
  EXPECT_EQ(error("1 2 3\n"),
            "arris: rays.txt:2: \"1 2 3\" holds 3 numbers only; a ray is six numbers: ox oy oz dx "
            "dy dz\n");
  EXPECT_THAT(error("1 2 3 4 5 6 7\n"),
              HasSubstr("rays.txt:2: \"1 2 3 4 5 6 7\" holds more than six"));
  EXPECT_THAT(error("1 2 x 4 5 6\n"), HasSubstr("holds \"x\", which is no number"));
  EXPECT_THAT(error("1 2 3 4 nan 6\n"), HasSubstr("holds \"nan\""));
  EXPECT_THAT(error("1 2 3 0 0 0\n"), HasSubstr("has no direction"));
}

// ---- info

TEST(Info, reports_a_cube_as_it_is) {
  const Outcome run = Workplace().arris("info cube.stl --json --round 0.5");
  ASSERT_EQ(run.code, 0) << run.err;
  const json report = json::parse(run.out);
  EXPECT_EQ(report["triangles"], 12);
  ASSERT_EQ(report["objects"].size(), 1U);
  const json& cube = report["objects"][0];
  EXPECT_EQ(cube["name"], "cube");
  EXPECT_EQ(cube["vertices"], 8);
  EXPECT_EQ(cube["shells"], 1);
  EXPECT_EQ(cube["edges"]["convex"], 12);
  EXPECT_EQ(cube["edges"]["concave"], 0);
  EXPECT_EQ(cube["edges"]["flat"], 6);
  EXPECT_EQ(cube["closed"], true);
  EXPECT_EQ(cube["convex"], true);
  EXPECT_NEAR(cube["inradius"].get<double>(), 1, 1e-6);
  EXPECT_EQ(cube["bounds"]["max"], json({2.0, 2.0, 2.0}));
  EXPECT_EQ(cube["rounding"]["radius"].get<double>(), 0.5);
  EXPECT_EQ(cube["rounding"]["edges"], 12);
  EXPECT_EQ(cube["rounding"]["corners"], 8);
}

TEST(Info, tells_objects_of_one_name_apart) {
  const Workplace place;
  test::write_text(place / "two.toml",
                   "[[object]]\nfile = \"cube.stl\"\nname = \"a\"\nround = 0.1\n"
                   "[[object]]\nfile = \"cube.stl\"\nname = \"a\"\nround = 0.2\n"
                   "translate = [4, 0, 0]\n");
  const Outcome run = place.arris("info two.toml --json");
  ASSERT_EQ(run.code, 0) << run.err;
  const json objects = json::parse(run.out)["objects"];
  EXPECT_EQ(objects[0]["rounding"]["radius"].get<double>(), 0.1);
  EXPECT_EQ(objects[1]["rounding"]["radius"].get<double>(), 0.2);
}

TEST(Info, prints_a_report_to_read) {
  const Outcome run = Workplace().arris("info cube.stl");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("cube.stl: 12 triangles in 1 object\n"));
  EXPECT_THAT(run.out, HasSubstr("12 convex, 0 concave"));
  EXPECT_THAT(run.out, HasSubstr("closed, convex, inradius 1"));
  EXPECT_THAT(run.out, HasSubstr("12 edges, 8 corners"));
}

TEST(Info, tells_curved_solids_from_faceted_ones) {
  const Workplace place;
  test::write_text(place / "exact.csg", "sphere(r = 1);\n");
  test::write_text(place / "mixed.csg",
                   "difference() { cube(size = 2); cylinder(h = 3, r = 1); }\n");
  // Of unlike balls: cut into facets.
  test::write_text(
      place / "hull.csg",
      "hull() { sphere(r = 1); multmatrix([[1,0,0,5],[0,1,0,0],[0,0,2,0],[0,0,0,1]]) { "
      "sphere(r = 1); } }\n");
  EXPECT_THAT(place.arris("info exact.csg").out, HasSubstr("1 curved, which is exact\n"));
  EXPECT_THAT(place.arris("info mixed.csg").out,
              HasSubstr("1 curved, which is exact, and 1 of 6 flat faces\n"));
  const std::string hull = place.arris("info hull.csg").out;
  EXPECT_THAT(hull, testing::ContainsRegex("surfaces    1 of [0-9]+ flat faces\n"));
  EXPECT_THAT(hull, testing::Not(HasSubstr("exact")));
  const json mixed = json::parse(place.arris("info mixed.csg --json").out)["objects"][0]["csg"];
  EXPECT_EQ(mixed["curved"], 1);
  EXPECT_EQ(mixed["flat_faces"], 6);
}

TEST(Info, says_none_where_rounding_is_off) {
  EXPECT_THAT(Workplace().arris("info cube.stl --round none").out, HasSubstr("rounding    none"));
}

TEST(Info, rounds_scene_files_only_as_they_say) {
  const Workplace place;
  test::write_text(place / "plain.toml", "[[object]]\nshape = \"box\"\n");
  test::write_text(place / "round.toml", "round = 0.25\n[[object]]\nshape = \"box\"\n");
  EXPECT_THAT(place.arris("info plain.toml").out, HasSubstr("rounding    none"));
  EXPECT_THAT(place.arris("info plain.toml --round 0.2").out, HasSubstr("radius 0.2: 12 edges"));
  EXPECT_THAT(place.arris("info round.toml").out, HasSubstr("radius 0.25: 12 edges"));
}

TEST(Info, says_that_the_bevel_shader_rounds_nothing) {
  const Outcome run = Workplace().arris("info cube.stl --json --round 0.5 --round-method shader");
  ASSERT_EQ(run.code, 0) << run.err;
  const json rounding = json::parse(run.out)["objects"][0]["rounding"];
  EXPECT_EQ(rounding["edges"], 0);
  EXPECT_THAT(rounding["notes"].dump(), HasSubstr("bevel shader of depth 0.5"));
}

// ---- compare

void save_grey(const std::filesystem::path& path, float value, int width = 8) {
  Image image(width, 8, 3);
  image.values.assign(image.values.size(), value);
  SaveOptions options;
  options.tone_map = false;
  save_picture({image, {}}, path, options);
}

TEST(Compare, reports_the_measures_as_text_and_json) {
  const Workplace place;
  save_grey(place / "a.exr", 0.5F);
  save_grey(place / "b.exr", 0.75F);
  const Outcome text = place.arris("compare a.exr b.exr");
  EXPECT_EQ(text.code, 0);
  EXPECT_THAT(text.out, HasSubstr("RMSE        0.25\n"));
  const json values = json::parse(place.arris("compare a.exr b.exr --json").out);
  EXPECT_EQ(values["rmse"].get<double>(), 0.25);
  EXPECT_EQ(values["max_error"].get<double>(), 0.25);
  EXPECT_NEAR(values["psnr_db"].get<double>(), 20 * std::log10(2.0), 1e-12);
  EXPECT_GT(values["flip"].get<double>(), 0);
  EXPECT_TRUE(json::parse(place.arris("compare a.exr a.exr --json").out)["psnr_db"].is_null());
}

TEST(Compare, exit_code_1_past_the_limit_only) {
  const Workplace place;
  save_grey(place / "a.exr", 0.5F);
  save_grey(place / "b.exr", 0.75F);
  EXPECT_EQ(place.arris("compare a.exr b.exr --max-rmse 0.25").code, 0);
  EXPECT_EQ(place.arris("compare a.exr b.exr --max-rmse 0.249").code, 1);
  EXPECT_EQ(place.arris("compare a.exr a.exr --max-rmse 0").code, 0);
}

TEST(Compare, quiet_answers_by_its_exit_code_alone) {
  const Workplace place;
  save_grey(place / "a.exr", 0.5F);
  save_grey(place / "b.exr", 0.75F);
  const Outcome run = place.arris("compare a.exr b.exr --max-rmse 0.1 --quiet");
  EXPECT_EQ(run.code, 1);
  EXPECT_EQ(run.out + run.err, "");
}

TEST(Compare, writes_the_difference_as_a_picture) {
  const Workplace place;
  save_grey(place / "a.png", 0.2F);
  save_grey(place / "b.png", 0.8F);
  ASSERT_EQ(place.arris("compare a.png b.png --diff d.png").code, 0);
  ASSERT_EQ(place.arris("compare a.png a.png --diff e.png").code, 0);
  EXPECT_GT(load_picture(place / "d.png").color.at(4, 4, 0), 0.1F);
  EXPECT_LT(load_picture(place / "e.png").color.at(4, 4, 0), 0.01F);
}

TEST(Compare, different_sizes_are_wrong_input) {
  const Workplace place;
  save_grey(place / "a.exr", 0.5F, 8);
  save_grey(place / "b.exr", 0.5F, 9);
  const Outcome run = place.arris("compare a.exr b.exr");
  EXPECT_EQ(run.code, 2);
  EXPECT_THAT(run.err, HasSubstr("8 x 8 pixels"));
}

}  // namespace
}  // namespace arris
