#include "view/access.h"

#include <gtest/gtest.h>

#include <set>

namespace arris::view {
namespace {

TEST(ViewAccess, tokens_are_128_bits_and_differ) {
  std::set<std::string> tokens;
  for (int i = 0; i < 100; ++i) tokens.insert(make_token());
  EXPECT_EQ(tokens.size(), 100U);
  EXPECT_EQ(tokens.begin()->size(), 32U);
}

TEST(ViewAccess, given_tokens_are_long_and_plain) {
  EXPECT_TRUE(is_good_token(make_token()));
  EXPECT_TRUE(is_good_token("abcXYZ-_01234567"));
  for (const char* token : {"", "abcXYZ-_0123456", "abcXYZ-_01234567 ", "abcXYZ-_0123456&",
                            "abcXYZ-_0123456%41", "äöcXYZ-_0123456789"}) {
    EXPECT_FALSE(is_good_token(token)) << token;
  }
}

TEST(ViewAccess, secrets_are_the_same_only_as_a_whole) {
  EXPECT_TRUE(is_same_secret("abcd", "abcd"));
  EXPECT_FALSE(is_same_secret("abcd", "abce"));
  EXPECT_FALSE(is_same_secret("abcd", "bbcd"));
  EXPECT_FALSE(is_same_secret("abcd", "abc"));
  EXPECT_FALSE(is_same_secret("abcd", ""));
}

TEST(ViewAccess, cuts_addresses_into_parts) {
  const auto target = parse_target("/model?t=12ab&name=my%20part.STL&x=1");
  ASSERT_TRUE(target);
  EXPECT_EQ(target->path, "/model");
  EXPECT_EQ(target->token, "12ab");
  EXPECT_EQ(target->name, "my part.STL");
  EXPECT_EQ(parse_target("/?t=%zz")->token, "%zz");
  EXPECT_EQ(parse_target("/a")->token, "");
  EXPECT_FALSE(parse_target("http://elsewhere/"));
  EXPECT_FALSE(parse_target(""));
  EXPECT_FALSE(parse_target("/" + std::string(5000, 'a')));
}

TEST(ViewAccess, knows_its_own_names_at_any_port) {
  for (const char* host : {"127.0.0.1:7878", "localhost", "LOCALHOST:9", "[::1]:80"}) {
    EXPECT_TRUE(is_own_host(host, "127.0.0.1")) << host;
  }
  for (const char* host : {"", "evil.example", "evil.example:7878", "10.0.0.1", "127.0.0.1.evil",
                           "localhost.evil:7878", "[evil", "[]"}) {
    EXPECT_FALSE(is_own_host(host, "127.0.0.1")) << host;
  }
  // Listening to others, any address is one of its own: names are what a foreign page can make lead here.
  EXPECT_TRUE(is_own_host("10.0.0.1:7878", "0.0.0.0"));
  EXPECT_TRUE(is_own_host("render.lan:7878", "render.lan"));
  EXPECT_FALSE(is_own_host("evil.example", "0.0.0.0"));
}

TEST(ViewAccess, takes_its_own_page_only) {
  EXPECT_TRUE(is_own_origin("http://127.0.0.1:7878", "127.0.0.1:7878"));
  EXPECT_TRUE(is_own_origin("https://localhost:1", "localhost:1"));
  for (const char* origin : {"null", "", "http://evil.example", "http://127.0.0.1:7879",
                             "http://127.0.0.1:7878.evil.example", "file://"}) {
    EXPECT_FALSE(is_own_origin(origin, "127.0.0.1:7878")) << origin;
  }
}

TEST(ViewAccess, uploads_keep_nothing_but_a_known_extension) {
  EXPECT_EQ(upload_extension("my part.STL"), ".stl");
  EXPECT_EQ(upload_extension("../../etc/passwd.obj"), ".obj");
  for (const char* name :
       {"scene.toml", "part.scad", "part", "", "part.exe", ".stl/..", "a.stl\n"}) {
    EXPECT_FALSE(upload_extension(name)) << name;
  }
}

TEST(ViewAccess, scene_files_are_called_as_the_page_saves_them_if_a_shell_takes_that) {
  EXPECT_EQ(saved_scene_name("my_part-2.toml"), "my_part-2.toml");
  for (const std::string name :
       {"", ".toml", "-rf.toml", "a b.toml", "$(x).toml", "../a.toml", "a.toml\nb.toml", "a.stl"}) {
    EXPECT_EQ(saved_scene_name(name), "scene.toml") << name;
  }
  EXPECT_EQ(saved_scene_name(std::string(200, 'a') + ".toml"), "scene.toml");
}

}  // namespace
}  // namespace arris::view
