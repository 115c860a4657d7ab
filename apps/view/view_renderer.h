// view_renderer.h — the thread that makes the viewer's frames
// What       takes the clients' inputs, changes the view by them, and makes frames while there is something to see:
//            moving ones as they come, finer ones while the view stands still, none once it has converged or nobody
//            looks. What takes long is prepared beside the frames: a scene, a model, a beam picture.
// Guarantee  the newest input wins: however many come, the next frame shows all of them. A change that can't be made
//            is answered by an error, and the view stays as it was.
// Limits     bounded memory whatever clients send: view_mailbox.h
// Errors     the constructor throws what loading and preparing throw; all later ones become messages
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "view/picture_saver.h"
#include "view/view_mailbox.h"
#include "view/view_stage.h"

namespace arris::view {

struct ViewFrame {
  std::uint32_t number = 0;
  PictureSize size;
  bool moving = false, converged = false;
  std::uint32_t samples = 0;
  std::vector<InputMark> shown;  // the newest input of each client that it shows
  std::vector<std::uint8_t> jpeg;
};

struct ViewText {
  std::string type, text;
  std::optional<ClientId> to;  // empty: all
  std::optional<ClientId> but_not;
};

// Called by the renderer's threads.
struct ViewOutputs {
  std::function<void(std::shared_ptr<const ViewFrame>)> send_frame;
  std::function<void(ViewText)> send_text;
};

struct ModelFile {
  std::filesystem::path file;
  std::string name;
  bool is_foreign = false;                  // a client's, which may name no other files
  const std::atomic<bool>* stop = nullptr;  // set: nobody waits for it any more
};
using OpenModel = std::function<ViewModel(const ModelFile& what)>;

// A scene file, or why there is none.
using SceneSaved = std::function<void(std::string toml, const std::string& error)>;

struct ViewRendererSettings {
  int threads = 0;
  double trace_below_ms = 16;
  bool upload = false;  // only said to clients
  // When nobody has looked for so long, pictures are as small again as the first one: large ones hold much memory.
  std::chrono::milliseconds rest_after{30'000};
  OpenModel open;  // throws; called in another thread
};

class ViewRenderer {
 public:
  ViewRenderer(ViewModel model, ViewRendererSettings settings);
  ViewRenderer(const ViewRenderer&) = delete;
  ViewRenderer& operator=(const ViewRenderer&) = delete;
  // Stops, and waits for what is being done; no output follows.
  ~ViewRenderer();

  void start(ViewOutputs outputs);

  // These may be called from any thread, and wait for nothing.
  void join(ClientId client);
  void leave(ClientId client);
  // False: too many inputs wait.
  bool put(ClientId client, const ClientMessage& message);
  // To all clients, as after a change: one of them shows what was refused.
  void repeat_scene();
  // When the first client will take a frame, or took it, had it been there; nothing: all have one that waits.
  void set_next_send(std::optional<Clock::time_point> time);
  // `done` is called by threads of the renderer.
  void save_picture(PictureSaved done);
  // file_name: that it will have, for the commands in it.
  void save_scene(std::string file_name, SceneSaved done);
  void save_beam(std::function<void(std::vector<std::uint8_t> png)> done);  // empty: there is none
  // error: empty if the model is shown now.
  void open(std::filesystem::path file, std::string name,
            std::function<void(const std::string& error)> done);
  // The model's file has changed.
  void reload();

 private:
  class Loop;
  std::unique_ptr<Loop> loop_;
};

}  // namespace arris::view
