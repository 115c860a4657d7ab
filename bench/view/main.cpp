// bench_view — how fast the viewer is: first picture, frames a second and delay of inputs while the camera moves
#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "interleaved.h"
#include "io/child_process.h"
#include "support/web_client.h"

extern char** environ;

namespace {

using arris::test::Frame;
using arris::test::WebSocket;
using Clock = std::chrono::steady_clock;
using nlohmann::json;

struct Arguments {
  std::vector<std::string> models;
  std::string arris;
  std::string shader = "gi";
  int width_px = 1280, height_px = 720;
  double seconds = 8, inputs_a_second = 60;
  double still_seconds = 0;
  int runs = 3;
};

double ms_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

// A rough torus of 102,400 triangles.
void write_torus(const std::filesystem::path& file) {
  constexpr int kAround = 320, kAcross = 160;
  constexpr double kPi = 3.14159265358979323846;
  std::ofstream out(file);
  for (int i = 0; i < kAround; ++i) {
    for (int j = 0; j < kAcross; ++j) {
      const double u = 2 * kPi * i / kAround, v = 2 * kPi * j / kAcross;
      const double tube = 12 + 0.4 * std::sin(9 * u) * std::sin(7 * v);
      out << fmt::format("v {} {} {}\n", (30 + tube * std::cos(v)) * std::cos(u),
                         (30 + tube * std::cos(v)) * std::sin(u), tube * std::sin(v));
    }
  }
  const auto at = [](int i, int j) { return i % kAround * kAcross + j % kAcross + 1; };
  for (int i = 0; i < kAround; ++i) {
    for (int j = 0; j < kAcross; ++j) {
      const int a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
      out << fmt::format("f {} {} {}\nf {} {} {}\n", a, b, c, a, c, d);
    }
  }
}

// The program, which serves one model.
class Viewer {
 public:
  Viewer(const Arguments& arguments, const std::string& model) {
    std::vector<std::string> words{arguments.arris, "view", model,      "--no-browser",
                                   "--port",        "0",    "--shader", arguments.shader};
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    int ends[2];
    if (::pipe(ends) != 0) throw std::runtime_error("no pipe");
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], 1);
    posix_spawn_file_actions_addopen(&actions, 2, "/dev/null", O_WRONLY, 0);
    const int failed =
        posix_spawn(&child_, words[0].c_str(), &actions, nullptr, pointers.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    ::close(ends[1]);
    if (failed != 0) throw std::runtime_error(words[0] + " can't be started; --arris names it");
    std::string line;
    for (char c = 0; ::read(ends[0], &c, 1) == 1 && c != '\n';) line += c;
    ::close(ends[0]);
    if (std::sscanf(line.c_str(), "http://127.0.0.1:%hu/?t=", &port_) != 1) {
      throw std::runtime_error(model + " can't be viewed; arris view says why");
    }
    token_ = line.substr(line.find('=') + 1);
  }
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;
  ~Viewer() {
    ::kill(child_, SIGTERM);
    ::waitpid(child_, nullptr, 0);
  }

  [[nodiscard]] std::uint16_t port() const { return port_; }
  [[nodiscard]] const std::string& token() const { return token_; }
  [[nodiscard]] double most_resident_mb() const {
    std::ifstream status(fmt::format("/proc/{}/status", child_));
    for (std::string line; std::getline(status, line);) {
      if (line.starts_with("VmHWM:")) return std::stod(line.substr(6)) / 1024;
    }
    return 0;
  }

 private:
  pid_t child_ = 0;
  std::uint16_t port_ = 0;
  std::string token_;
};

struct Run {
  double address_ms = 0, first_ms = 0;
  std::vector<double> delays_ms, gaps_ms, work_ms;
  double frames_a_second = 0, frame_kb = 0, resident_mb = 0;
  std::size_t triangles = 0;
  std::uint32_t still_samples = 0;
  double still_seconds = 0;
};

// The camera of a message, turned about the target's vertical.
json turned(const json& camera, double angle, int seq) {
  const auto& p = camera["position"];
  const auto& t = camera["target"];
  const double x = double(p[0]) - double(t[0]), y = double(p[1]) - double(t[1]);
  return {{"type", "camera"},
          {"seq", seq},
          {"position",
           {double(t[0]) + x * std::cos(angle) - y * std::sin(angle),
            double(t[1]) + x * std::sin(angle) + y * std::cos(angle), p[2]}},
          {"target", t},
          {"up", camera["up"]},
          {"fov", camera["fov"]}};
}

void move_camera(WebSocket& socket, const json& camera, const Arguments& arguments, Run& run) {
  std::map<std::uint32_t, Clock::time_point> sent;
  const Clock::time_point begin = Clock::now();
  Clock::time_point last{};
  double bytes = 0;
  int seq = 0, frames = 0;
  while (ms_since(begin) < arguments.seconds * 1e3) {
    const double due_ms = seq * 1e3 / arguments.inputs_a_second;
    if (ms_since(begin) >= due_ms) {
      ++seq;
      socket.send(turned(camera, 0.01 * seq, seq));
      sent[std::uint32_t(seq)] = Clock::now();
    }
    if (!socket.has_more(std::max(1, int(due_ms - ms_since(begin))))) continue;
    const auto message = socket.read();
    if (!message) throw std::runtime_error("the viewer has closed the connection");
    if (!message->is_binary) {
      const json text = json::parse(message->payload);
      if (text["type"] == "state") run.work_ms.push_back(text["frame_ms"]);
      continue;
    }
    const Frame frame = WebSocket::parse(message->payload);
    socket.send({{"type", "ack"}, {"frame", frame.number}});
    const Clock::time_point now = Clock::now();
    if (const auto asked = sent.find(frame.seq); asked != sent.end()) {
      run.delays_ms.push_back(ms_since(asked->second));
    }
    if (frames > 0) {
      run.gaps_ms.push_back(std::chrono::duration<double, std::milli>(now - last).count());
    }
    last = now;
    bytes += double(message->payload.size());
    ++frames;
  }
  run.frames_a_second = frames / arguments.seconds;
  run.frame_kb = bytes / 1e3 / std::max(frames, 1);
}

// Until the view that stands still has converged, or the time is over.
void wait_still(WebSocket& socket, const Arguments& arguments, Run& run) {
  const Clock::time_point begin = Clock::now();
  while (ms_since(begin) < arguments.still_seconds * 1e3) {
    if (!socket.has_more(100)) continue;
    const Frame frame = socket.read_and_acknowledge();
    run.still_samples = frame.samples;
    run.still_seconds = ms_since(begin) / 1e3;
    if (frame.is_converged()) return;
  }
}

Run measure(const Arguments& arguments, const std::string& model) {
  Run run;
  const Clock::time_point begin = Clock::now();
  const Viewer viewer(arguments, model);
  run.address_ms = ms_since(begin);
  const Clock::time_point opened = Clock::now();
  WebSocket socket(viewer.port(), viewer.token());
  socket.send({{"type", "hello"}, {"size", {arguments.width_px, arguments.height_px}}});
  const json scene = socket.read_text("scene");
  Frame frame = socket.read_and_acknowledge();
  run.first_ms = ms_since(opened);
  for (const json& object : scene["objects"]) run.triangles += std::size_t(object["triangles"]);
  // The page's own size comes with a second scene.
  const Clock::time_point still = Clock::now();
  while (frame.width != arguments.width_px || ms_since(still) < 1000) {
    frame = socket.read_and_acknowledge();
  }
  move_camera(socket, scene["camera"], arguments, run);
  wait_still(socket, arguments, run);
  run.resident_mb = viewer.most_resident_mb();
  return run;
}

double part_of(std::vector<double> values, double part) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[std::size_t(part * double(values.size() - 1))];
}

void print_run(const std::string& name, const Run& run) {
  fmt::print(
      "{:24} {:9} | {:7.0f} {:7.0f} | {:5.1f} {:6.0f} {:6.0f} {:6.0f} | {:6.0f} {:6.0f} | {:5.0f} "
      "{:6.0f}\n",
      name, run.triangles, run.address_ms, run.first_ms, run.frames_a_second,
      arris::bench::median(run.gaps_ms), part_of(run.gaps_ms, 1), arris::bench::median(run.work_ms),
      arris::bench::median(run.delays_ms), part_of(run.delays_ms, 0.95), run.frame_kb,
      run.resident_mb);
  if (run.still_seconds > 0) {
    fmt::print("{:34} | still: {} samples of each pixel after {:.1f} s\n", "", run.still_samples,
               run.still_seconds);
  }
  std::fflush(stdout);
}

int run_all(const Arguments& arguments) {
  const arris::ScratchFolder folder("bench_view");
  std::vector<std::string> models = arguments.models;
  if (models.empty()) {
    models.push_back((folder.path() / "torus.obj").string());
    write_torus(models[0]);
  }
  fmt::print("{} x {} pixels, {}, {} camera inputs a second for {} s; milliseconds\n",
             arguments.width_px, arguments.height_px, arguments.shader, arguments.inputs_a_second,
             arguments.seconds);
  fmt::print(
      "{:34} | address   first |   a s    gap longest   work |  delay    95% |    kB     MB\n", "");
  for (const std::string& model : models) {
    for (int i = 0; i < arguments.runs; ++i) {
      print_run(std::filesystem::path(model).filename().string(), measure(arguments, model));
    }
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  arguments.arris =
      (std::filesystem::read_symlink("/proc/self/exe").parent_path() / "arris").string();
  CLI::App app{
      "Times `arris view`: how long until its address and its first picture, then frames and "
      "delays while "
      "the camera turns"};
  app.add_option("models", arguments.models, "files; a torus of 102,400 triangles by default");
  app.add_option("--arris", arguments.arris, "the program; the one beside this one by default");
  app.add_option("--shader", arguments.shader, "direct, glossy or gi");
  app.add_option("--width", arguments.width_px, "of the picture in pixels");
  app.add_option("--height", arguments.height_px, "of the picture in pixels");
  app.add_option("--seconds", arguments.seconds, "for which the camera turns");
  app.add_option("--still", arguments.still_seconds,
                 "for which the camera then stands still at most, until the picture is done");
  app.add_option("--inputs", arguments.inputs_a_second, "camera inputs a second");
  app.add_option("--runs", arguments.runs, "of each model");
  CLI11_PARSE(app, argc, argv);
  try {
    return run_all(arguments);
  } catch (const std::exception& error) {
    fmt::print(stderr, "bench_view: {}\n", error.what());
    return 1;
  }
}
