#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "arris/command_line.h"
#include "arris/commands.h"
#include "arris/console.h"
#include "arris/error.h"
#include "arris/input.h"
#include "arris/render.h"
#include "arris/render_request.h"
#include "arris/stop_signal.h"
#include "arris/values.h"
#include "io/file_bytes.h"
#include "scene/limits.h"
#include "view/access.h"
#include "view/view_server.h"

extern char** environ;

namespace arris::program {
namespace {

constexpr std::uint16_t kPort = 7878;
constexpr std::uint64_t kMostSceneFileBytes = std::uint64_t(64) << 20;

view::ServerSettings make_server_settings(const Arguments& arguments) {
  view::ServerSettings settings;
  settings.host = arguments.find("--host").value_or(settings.host);
  settings.port = kPort;
  settings.or_any_port = true;
  if (const auto given = find_given(arguments, "--port")) {
    settings.port = std::uint16_t(parse_count(*given, 0, 65535));
    settings.or_any_port = false;
  }
  settings.once = arguments.has("--once");
  if (const auto given = arguments.find("--token")) {
    if (!view::is_good_token(*given)) {
      throw Error(Error::Kind::input, "--token",
                  "must be 16 to 256 letters, digits, \"-\" or \"_\", such as what openssl rand "
                  "-hex 16 prints");
    }
    settings.token = *given;
  }
  settings.allow_upload = arguments.has("--allow-upload");
  if (arguments.has("--watch")) settings.watch = std::make_shared<view::FileWatch>();
  if (settings.watch && arguments.positionals[0] == "-") {
    throw Error(Error::Kind::input, "--watch", "needs a file; stdin can't be read again");
  }
  return settings;
}

// As apply_request() has it, but that staging is left to the viewer, which does it again and again.
view::ViewModel make_model(Input loaded, const std::filesystem::path& file,
                           const Arguments& arguments) {
  check_scene(loaded.scene, loaded.name);
  view::ViewModel model;
  model.name = std::filesystem::path(loaded.name).filename().string();
  model.file = file;
  model.is_scene_file = loaded.is_scene_file;
  if (model.is_scene_file && !file.empty()) {
    const std::vector<std::uint8_t> bytes = read_file_bytes(file, kMostSceneFileBytes);
    model.text.assign(bytes.begin(), bytes.end());
  }
  model.has_own_rounding = loaded.scene.rounding.has_value();
  model.scene = std::move(loaded.scene);
  apply_image_options(model.scene.image, arguments);
  if (const auto given = find_given(arguments, "--spp")) {
    model.scene.image.samples_per_pixel = int(parse_count(*given, 1, kMostSamples));
  }
  model.stage = make_stage_options(arguments);
  if (model.is_scene_file) {
    model.stage.source = StageOptions::Source::scene_file;
  } else if (!model.scene.rounding) {
    model.scene.rounding.emplace().method = RoundMethod::exact;
  }
  apply_rounding_options(model.scene, arguments);
  model.shader = parse_shader(arguments);
  return model;
}

// watch: null where nothing is watched.
Input load_watched(const std::string& name, const LoadOptions& options, view::FileWatch* watch) {
  if (watch == nullptr) return load_input(name, options);
  view::FileWatch::Reading reading(*watch);
  Input input = load_input(name, options);
  reading.succeed();
  return input;
}

view::ViewModel open_model(const view::ModelFile& what, const Arguments& arguments,
                           view::FileWatch* watch) {
  LoadOptions options = load_options_of(arguments);
  options.stop = what.stop;
  if (what.is_foreign) options.other_files = LoadOptions::OtherFiles::none;
  Input input = load_watched(what.file.string(), options, what.is_foreign ? nullptr : watch);
  view::ViewModel model = make_model(std::move(input), what.file, arguments);
  model.name = what.name;
  return model;
}

bool has_desktop() {
  const auto is_set = [](const char* name) {
    const char* value = std::getenv(name);
    return value != nullptr && *value != '\0';
  };
  return is_set("DISPLAY") || is_set("WAYLAND_DISPLAY");
}

// What a browser has to say is none of our business.
void open_browser(const std::string& address) {
  std::string program = "xdg-open", argument = address;
  char* words[] = {program.data(), argument.data(), nullptr};
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSID);  // Ctrl-C is not meant for it
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (const int stream : {0, 1, 2}) {
    posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", stream == 0 ? 0 : 1, 0);
  }
  pid_t child = 0;
  const bool is_started =
      posix_spawnp(&child, program.c_str(), &actions, &attributes, words, environ) == 0;
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  // Some browsers stay as long as they are open.
  if (is_started) std::thread([child] { ::waitpid(child, nullptr, 0); }).detach();
}

// What goes on beside the server stops soon, but for the reading of files, a structure that is being built and the
// rounding of a single large mesh: the program waits for none of these. Nothing of them is to be kept.
constexpr auto kEndWait = std::chrono::milliseconds(400);
void end_soon() {
  std::thread([] {
    std::this_thread::sleep_for(kEndWait);
    std::_Exit(0);
  }).detach();
}

// Signals while the first view is prepared, before the server has them: programs that are run for the model end, and
// what can't be stopped is not waited for.
class EarlySignals {
 public:
  EarlySignals() : stop_(catch_stop_signals()), thread_([this] { run(); }) {}
  EarlySignals(const EarlySignals&) = delete;
  EarlySignals& operator=(const EarlySignals&) = delete;
  ~EarlySignals() {
    {
      const std::lock_guard lock(mutex_);
      over_ = true;
    }
    wake_.notify_all();
    thread_.join();
  }

  [[nodiscard]] const std::atomic<bool>& stop() const { return stop_; }

 private:
  void run() {
    constexpr auto kLook = std::chrono::milliseconds(20);
    constexpr int kFailed = 1;
    std::unique_lock lock(mutex_);
    const auto is_over = [&] { return over_; };
    while (!stop_) {
      if (wake_.wait_for(lock, kLook, is_over)) return;
    }
    if (!wake_.wait_for(lock, kEndWait, is_over)) std::_Exit(kFailed);
  }

  const std::atomic<bool>& stop_;
  std::mutex mutex_;
  std::condition_variable wake_;
  bool over_ = false;
  std::thread thread_;  // the last: all else is there when it starts
};

}  // namespace

int run_view(const Arguments& arguments) {
  if (asks_for_materials(arguments)) return print_materials();
  const std::string& input = arguments.positionals[0];
  if (input.empty()) {
    throw Error(Error::Kind::input, "INPUT", "is empty; give a model or a scene file");
  }
  view::ServerSettings server_settings = make_server_settings(arguments);
  view::ViewRendererSettings renderer_settings;
  renderer_settings.threads = threads_of(arguments);
  renderer_settings.upload = server_settings.allow_upload;
  renderer_settings.trace_below_ms = kTraceBelowMs;
  if (const auto given = find_given(arguments, "--trace-below")) {
    renderer_settings.trace_below_ms = parse_real(*given, {0, 1e9});
  }
  const std::shared_ptr<view::FileWatch> watch = server_settings.watch;
  renderer_settings.open = [&arguments, watch](const view::ModelFile& what) {
    return open_model(what, arguments, watch.get());
  };
  with_rounding_options({}, arguments);  // checked before a long file is read

  Console console(arguments);
  std::optional<EarlySignals> signals(std::in_place);
  const std::atomic<bool>& stop = signals->stop();
  LoadOptions load = load_options_of(arguments);
  load.stop = &stop;
  view::ViewModel model =
      make_model(load_watched(input, load, watch.get()),
                 input == "-" ? "" : std::filesystem::absolute(input), arguments);
  for (const std::string& note : model.scene.notes) console.report(note);
  view::ViewServer server(std::move(model), std::move(renderer_settings),
                          std::move(server_settings));
  signals.reset();
  if (stop) throw Error(Error::Kind::failed, "", "stopped");
  fmt::print("{}\n", server.address());
  if (std::fflush(stdout) != 0) throw Error(Error::Kind::failed, "stdout", "can't be written");
  console.report("open this address in a browser; Ctrl-C ends it");
  if (server.is_open_to_all()) console.report("all that can reach this machine can reach it");
  if (!arguments.has("--no-browser") && has_desktop()) open_browser(server.address());
  server.run();
  end_soon();
  return 0;
}

}  // namespace arris::program
