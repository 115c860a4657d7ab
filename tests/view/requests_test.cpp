// Which requests the server answers, and whose.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "view/server_fixture.h"

namespace arris::view {
namespace {

using test::Request;
using test::WebSocket;
using testing::HasSubstr;

TEST_F(ViewServerTest, serves_the_page_to_those_who_know_the_token) {
  start();
  const auto page = test::fetch(port_, Request(with_token("/")));
  EXPECT_EQ(page.status, 200);
  EXPECT_THAT(page.body, HasSubstr("<html"));
  EXPECT_THAT(page.head, HasSubstr("Content-Security-Policy: default-src 'self'"));
  EXPECT_THAT(page.head, HasSubstr("X-Content-Type-Options: nosniff"));
  EXPECT_THAT(page.head, HasSubstr("Referrer-Policy: no-referrer"));
  EXPECT_THAT(page.head, HasSubstr("Cache-Control: no-store"));
  for (const char* target : {"/", "/?t=", "/?t=0123456789abcdef0123456789abcdef", "/ws",
                             "/picture.png", "/scene.toml", "/beam.png"}) {
    EXPECT_EQ(test::fetch(port_, Request(target)).status, 403) << target;
  }
  for (const char* target : {"/../index.html", "/etc/passwd", "/web/index.html", "/nothing"}) {
    EXPECT_EQ(test::fetch(port_, Request(with_token(target))).status, 404) << target;
  }
  EXPECT_EQ(test::fetch(port_, Request(with_token("/")).by("PUT")).status, 405);
}

TEST_F(ViewServerTest, refuses_other_hosts_and_origins) {
  start();
  EXPECT_EQ(test::fetch(port_, Request(with_token("/")).at_host("evil.example")).status, 403);
  EXPECT_EQ(test::fetch(port_, Request(with_token("/")).at_host("localhost:9")).status, 200);
  EXPECT_EQ(
      test::fetch(port_, Request(with_token("/picture.png")).from("http://evil.example")).status,
      403);
  EXPECT_EQ(WebSocket(port_, token_, "http://evil.example").status(), 403);
  EXPECT_EQ(WebSocket(port_, "0123456789abcdef0123456789abcdef").status(), 403);
  EXPECT_EQ(WebSocket(port_, token_, fmt::format("http://127.0.0.1:{}", port_)).status(), 101);
}

TEST_F(ViewServerTest, refuses_requests_that_are_too_long) {
  start();
  const auto long_header =
      test::fetch(port_, Request(with_token("/")).with("X: " + std::string(20000, 'a') + "\r\n"));
  EXPECT_NE(long_header.status, 200);
  const auto upload = test::fetch(
      port_,
      Request(with_token("/model?name=a.stl")).by("POST").with("Content-Length: 99999999999\r\n"));
  EXPECT_EQ(upload.status, 413);
}

TEST_F(ViewServerTest, who_has_the_token_gets_in_past_any_number_without_it) {
  start();
  std::vector<std::unique_ptr<test::Connection>> strangers;
  for (int i = 0; i < 200; ++i) {
    strangers.push_back(std::make_unique<test::Connection>(port_));
    strangers.back()->send("GET / HTTP/1.1\r\n");
  }
  EXPECT_EQ(test::fetch(port_, Request(with_token("/"))).status, 200);
  read_until_converged(*look());
  // The oldest had to go.
  EXPECT_FALSE(strangers.front()->read(1));
}

TEST_F(ViewServerTest, requests_that_are_none_are_answered) {
  start();
  const auto answer_to = [&](const std::string& bytes) {
    test::Connection connection(port_);
    connection.send(bytes);
    return connection.read_all();
  };
  for (const char* bytes : {"what is this\r\n\r\n", "GET / HTTP/7.5\r\n\r\n",
                            "GET / HTTP/1.1\r\nno colon\r\n\r\n", "\x16\x03\x01 hello\r\n\r\n"}) {
    const std::string answer = answer_to(bytes);
    EXPECT_THAT(answer, testing::StartsWith("HTTP/1.1 400 ")) << bytes;
    EXPECT_THAT(answer, HasSubstr("open the address")) << bytes;
  }
}

TEST_F(ViewServerTest, refuses_two_hosts) {
  start();
  const auto answer = test::fetch(port_, Request(with_token("/")).with("Host: evil.example\r\n"));
  EXPECT_EQ(answer.status, 400);
  EXPECT_THAT(answer.body, HasSubstr("Host"));
}

TEST_F(ViewServerTest, says_that_a_request_came_too_slowly) {
  ServerSettings settings;
  settings.header_time = std::chrono::milliseconds(200);
  start(settings);
  test::Connection connection(port_);
  connection.send("GET / HT");
  EXPECT_THAT(connection.read_all(), testing::StartsWith("HTTP/1.1 408 "));
}

TEST_F(ViewServerTest, says_that_a_model_came_too_slowly) {
  ServerSettings settings;
  settings.allow_upload = true;
  settings.body_time = std::chrono::milliseconds(1000);
  start(settings);
  const auto answer = test::fetch(
      port_, Request(with_token("/model?name=a.stl")).by("POST").with("Content-Length: 100\r\n"));
  EXPECT_EQ(answer.status, 408);
  EXPECT_THAT(answer.body, HasSubstr("within 1 s; send a smaller one"));
}

TEST_F(ViewServerTest, keeps_the_token_that_it_is_given) {
  ServerSettings settings;
  settings.token = "a-token_of-mine-0123";
  start(settings);
  EXPECT_EQ(token_, settings.token);
  EXPECT_EQ(test::fetch(port_, Request("/?t=a-token_of-mine-0123")).status, 200);
  EXPECT_EQ(test::fetch(port_, Request("/?t=a-token_of-mine-0124")).status, 403);
}

// An empty variable in a script must not open the server to all.
TEST(ViewServer, listens_to_all_only_if_that_is_said) {
  for (const char* host : {"", "*", "0"}) {
    ServerSettings settings;
    settings.host = host;
    EXPECT_THROW(ViewServer(make_boxes(), {}, settings), Error) << host;
  }
  ServerSettings settings;
  for (const char* host : {"0.0.0.0", "::ffff:0.0.0.0"}) {
    settings.host = host;
    EXPECT_TRUE(ViewServer(make_boxes(), {}, settings).is_open_to_all()) << host;
  }
}

}  // namespace
}  // namespace arris::view
