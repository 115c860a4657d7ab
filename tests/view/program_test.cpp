// `arris view` as a program: its address, its options, its ends.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <initializer_list>
#include <memory>
#include <string>

#include "program/run_program.h"
#include "support/web_client.h"

extern char** environ;

namespace arris {
namespace {

using test::WebSocket;
using testing::HasSubstr;
using testing::StartsWith;

class RunningView {
 public:
  enum class Browser { none, opened };
  RunningView(const test::Workplace& place, std::vector<std::string> words,
              Browser browser = Browser::none) {
    if (browser == Browser::none) words.emplace_back("--no-browser");
    words.insert(words.begin(), {ARRIS_BINARY_DIR "/arris", "view"});
    for (const char* word : {"--port", "0", "--threads", "1", "--size", "96x64"}) {
      words.emplace_back(word);
    }
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], 1);
    posix_spawn_file_actions_addopen(&actions, 2, (place / "err.txt").c_str(),
                                     O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (::posix_spawn(&process_, words[0].c_str(), &actions, nullptr, pointers.data(), environ) !=
        0) {
      throw std::runtime_error("not started");
    }
    posix_spawn_file_actions_destroy(&actions);
    ::close(ends[1]);
    char c = 0;
    while (::read(ends[0], &c, 1) == 1 && c != '\n') address_ += c;
    ::close(ends[0]);
  }
  RunningView(const RunningView&) = delete;
  RunningView& operator=(const RunningView&) = delete;
  ~RunningView() {
    if (process_ == 0) return;
    ::kill(process_, SIGKILL);
    wait();
  }

  [[nodiscard]] const std::string& address() const { return address_; }
  [[nodiscard]] std::uint16_t port() const { return std::uint16_t(std::stoi(address_.substr(17))); }
  [[nodiscard]] std::string token() const { return address_.substr(address_.find("t=") + 2); }
  [[nodiscard]] pid_t process() const { return process_; }
  void signal(int number) const { ::kill(process_, number); }
  int wait() {
    int status = 0;
    ::waitpid(process_, &status, 0);
    process_ = 0;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  pid_t process_ = 0;
  std::string address_;
};

TEST(ViewProgram, prints_its_address_and_ends_well_when_asked_to) {
  const test::Workplace place;
  for (const int signal : {SIGTERM, SIGINT}) {
    RunningView view(place, {(place / "cube.stl").string()});
    ASSERT_THAT(view.address(), StartsWith("http://127.0.0.1:"));
    EXPECT_EQ(view.token().size(), 32U);
    WebSocket socket(view.port(), view.token());
    socket.send({{"type", "hello"}, {"size", {96, 64}}});
    EXPECT_EQ(socket.read_and_acknowledge().width, 96);
    view.signal(signal);
    EXPECT_EQ(view.wait(), 0);
  }
}

TEST(ViewProgram, ends_once_the_last_page_is_closed) {
  const test::Workplace place;
  RunningView view(place, {(place / "cube.stl").string(), "--once"});
  {
    WebSocket socket(view.port(), view.token());
    socket.send({{"type", "hello"}, {"size", {96, 64}}});
    socket.read_frame();
  }
  EXPECT_EQ(view.wait(), 0);
}

TEST(ViewProgram, shows_a_file_anew_that_has_changed) {
  const test::Workplace place;
  RunningView view(place, {(place / "cube.stl").string(), "--watch"});
  WebSocket socket(view.port(), view.token());
  socket.send({{"type", "hello"}, {"size", {96, 64}}});
  EXPECT_EQ(socket.read_text("scene")["bounds"]["upper"][0], 2);
  test::write_text(place / "cube.stl", test::cube_stl(3));
  while (socket.read_text("scene")["bounds"]["upper"][0] != 3) {
  }
}

TEST(ViewProgram, what_it_saves_can_be_rendered_and_viewed) {
  const test::Workplace place;
  std::filesystem::create_directory(place / "here");
  std::filesystem::rename(place / "cube.stl", place / "here/a \"cube\".stl");
  test::write_text(place / "here/s.toml",
                   "camera.position = [5, 6, 7] # [[object]]\r\n"
                   "[[ \"object\" ]]\r\nfile = 'a \"cube\".stl'\r\n");
  for (const char* name : {"here/a \"cube\".stl", "here/s.toml", "saved.toml"}) {
    RunningView view(place, {(place / name).string()});
    const auto saved = test::fetch(view.port(), test::Request("/scene.toml?t=" + view.token()));
    ASSERT_EQ(saved.status, 200) << saved.body;
    test::write_text(place / "saved.toml", saved.body);
    const test::Outcome outcome = place.arris("render saved.toml -o saved.png --spp 1 --quiet");
    EXPECT_EQ(outcome.code, 0) << outcome.err << saved.body;
  }
}

TEST(ViewProgram, shows_a_scene_anew_when_a_file_that_it_names_has_changed) {
  const test::Workplace place;
  test::write_text(place / "scene.toml", "[[object]]\nfile = \"cube.stl\"\n");
  RunningView view(place, {(place / "scene.toml").string(), "--watch"});
  WebSocket socket(view.port(), view.token());
  socket.send({{"type", "hello"}, {"size", {96, 64}}});
  EXPECT_EQ(socket.read_text("scene")["bounds"]["upper"][0], 2);
  test::write_text(place / "cube.stl", test::cube_stl(3));
  while (socket.read_text("scene")["bounds"]["upper"][0] != 3) {
  }
}

TEST(ViewProgram, says_that_a_file_was_deleted_and_goes_on_when_it_is_back) {
  const test::Workplace place;
  RunningView view(place, {(place / "cube.stl").string(), "--watch"});
  WebSocket socket(view.port(), view.token());
  socket.send({{"type", "hello"}, {"size", {96, 64}}});
  socket.read_frame();
  std::filesystem::remove(place / "cube.stl");
  const auto error = socket.read_text("error");
  EXPECT_THAT(error["text"].get<std::string>(), HasSubstr("cube.stl was deleted"));
  EXPECT_THAT(error["remedy"].get<std::string>(), HasSubstr("put it back"));
  EXPECT_EQ(error["about"], "file");
  WebSocket other(view.port(), view.token());  // who comes later hears of it, too
  EXPECT_EQ(other.read_text("error"), error);
  EXPECT_EQ(other.read_text("scene")["bounds"]["upper"][0], 2);
  test::write_text(place / "cube.stl", test::cube_stl(3));
  const auto cleared = other.read_text("error");  // it holds no longer
  EXPECT_EQ(cleared["text"], "");
  EXPECT_EQ(cleared["about"], "file");
  EXPECT_FALSE(
      other.read_text("error").contains("about"));  // nor what was said of the model before
  while (socket.read_text("scene")["bounds"]["upper"][0] != 3) {
  }
}

TEST(ViewProgram, says_nothing_more_of_a_file_that_is_shown_no_longer) {
  const test::Workplace place;
  const RunningView view(place, {(place / "cube.stl").string(), "--watch", "--allow-upload"});
  WebSocket socket(view.port(), view.token());
  socket.send({{"type", "hello"}, {"size", {96, 64}}});
  socket.read_frame();
  std::filesystem::remove(place / "cube.stl");
  socket.read_text("error");
  const std::string target = "/model?name=large.stl&t=" + view.token();
  EXPECT_EQ(test::fetch(view.port(), test::Request(target).post(test::cube_stl(5))).status, 204);
  WebSocket other(view.port(), view.token());
  for (std::string type; type != "scene";) {
    const auto message = other.read();
    ASSERT_TRUE(message);
    type = nlohmann::json::parse(message->payload)["type"];
    EXPECT_NE(type, "error") << message->payload;
  }
}

void write_program(const std::filesystem::path& file, const std::string& text) {
  test::write_text(file, "#!/bin/sh\n" + text);
  std::filesystem::permissions(file, std::filesystem::perms::owner_all);
}

// Until a program has written it.
std::string wait_for(const std::filesystem::path& file) {
  std::string text;
  while ((text = test::read_text(file)).empty()) ::usleep(10'000);
  return text;
}

// What is first on the PATH, for the programs that are started meanwhile.
class OnPath {
 public:
  explicit OnPath(const std::filesystem::path& folder) : before_(std::getenv("PATH")) {
    ::setenv("PATH", (folder.string() + ":" + before_).c_str(), 1);
  }
  OnPath(const OnPath&) = delete;
  OnPath& operator=(const OnPath&) = delete;
  ~OnPath() { ::setenv("PATH", before_.c_str(), 1); }

 private:
  std::string before_;
};

// Folders of its own that a program has left in `folder`.
int count_left(const std::filesystem::path& folder) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    count += entry.path().filename().string().starts_with("arris-") ? 1 : 0;
  }
  return count;
}

TEST(ViewProgram, programs_that_it_runs_end_with_it_and_hold_no_connection) {
  const test::Workplace place;
  const std::filesystem::path said = place / "said";
  write_program(
      place / "openscad",
      fmt::format("echo $$ > '{0}.new'; mv '{0}.new' '{0}'; exec sleep 100\n", said.string()));
  test::write_text(place / "model.csg", "cube(size = [1, 1, 1]);\n");
  const OnPath path(place / ".");
  ::setenv("TMPDIR", (place / ".").c_str(), 1);
  RunningView view(place, {(place / "model.csg").string(), "--watch"});
  ::unsetenv("TMPDIR");
  WebSocket socket(view.port(), view.token());
  socket.send({{"type", "hello"}, {"size", {96, 64}}});
  socket.read_frame();
  // Only openscad can make it.
  test::write_text(
      place / "model.csg",
      "minkowski() { difference() { cube(size = [1, 1, 1]); cube(size = [0.5, 2, 2]); } "
      "sphere(r = 0.1); }\n");
  const pid_t openscad = std::stoi(wait_for(said));
  EXPECT_EQ(count_left(place / "."), 1);
  const std::filesystem::path open_files = fmt::format("/proc/{}/fd", openscad);
  for (const auto& file : std::filesystem::directory_iterator(open_files)) {
    std::error_code closed;  // the shell has become sleep meanwhile
    const std::string name = std::filesystem::read_symlink(file, closed).string();
    EXPECT_THAT(name, testing::Not(HasSubstr("socket"))) << file.path();
  }
  view.signal(SIGTERM);
  EXPECT_EQ(view.wait(), 0);
  EXPECT_NE(::kill(openscad, SIGKILL), 0) << "it is still at work";
  EXPECT_EQ(count_left(place / "."), 0);
}

TEST(ViewProgram, ends_when_it_is_asked_to_before_there_is_an_address) {
  const test::Workplace place;
  write_program(place / "openscad", "echo $$ > said; exec sleep 100\n");
  test::write_text(place / "model.scad", "cube(1);\n");
  std::filesystem::create_directory(place / "tmp");
  const test::Outcome outcome = place.shell(fmt::format(
      "PATH=$PWD:$PATH TMPDIR=$PWD/tmp '{}/arris' view model.scad --no-browser --port 0 & view=$!; "
      "while [ ! -s said ]; do sleep 0.02; done; kill -TERM $view; wait $view; "
      "echo \"ended $?\"; kill -0 $(cat said) && echo alive",
      ARRIS_BINARY_DIR));
  EXPECT_EQ(outcome.out, "ended 1\n") << outcome.err;
  EXPECT_EQ(count_left(place / "tmp"), 0);
}

TEST(ViewProgram, leaves_no_dead_browser) {
  const test::Workplace place;
  const std::filesystem::path said = place / "said";
  write_program(place / "xdg-open",
                fmt::format("echo $1 > '{0}.new'; mv '{0}.new' '{0}'\n", said.string()));
  const OnPath path(place / ".");
  ::setenv("DISPLAY", ":0", 1);
  const RunningView view(place, {(place / "cube.stl").string()}, RunningView::Browser::opened);
  ::unsetenv("DISPLAY");
  EXPECT_THAT(wait_for(said), StartsWith(view.address()));
  const std::string children = fmt::format("/proc/{0}/task/{0}/children", view.process());
  int looks = 0;
  while (!test::read_text(children).empty() && ++looks < 1000) ::usleep(10'000);
  EXPECT_EQ(test::read_text(children), "");
}

TEST(ViewProgram, keeps_the_token_that_it_is_given) {
  const test::Workplace place;
  const RunningView view(place, {(place / "cube.stl").string(), "--token", "a-token_of-mine-0123"});
  EXPECT_EQ(view.token(), "a-token_of-mine-0123");
}

TEST(ViewProgram, lists_materials_as_render_does) {
  const test::Workplace place;
  const test::Outcome list = place.arris("view --material list");
  EXPECT_EQ(list.code, 0) << list.err;
  EXPECT_EQ(list.out, place.arris("render --material list").out);
}

TEST(ViewProgram, bad_input_and_options_are_errors_before_an_address_is_printed) {
  const test::Workplace place;
  for (const auto& [words, text] : std::initializer_list<std::pair<const char*, const char*>>{
           {"view missing.stl", "missing.stl"},
           {"view cube.stl --port 70000", "--port"},
           {"view cube.stl --round 5", "radius"},
           {"view cube.stl --token short", "16"},
           {"view cube.stl --host no.such.host.invalid --no-browser", "--host"},
           {"view \"\"", "INPUT"},
           {"view - --watch", "--watch"}}) {
    const test::Outcome outcome = place.arris(words);
    EXPECT_EQ(outcome.code, 2) << words;
    EXPECT_EQ(outcome.out, "") << words;
    EXPECT_THAT(outcome.err, HasSubstr(text)) << words;
  }
}

}  // namespace
}  // namespace arris
