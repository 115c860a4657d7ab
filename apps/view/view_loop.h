// view_loop.h — ViewRenderer's inside: what is shown, what is asked for, and when the next frame is due
#pragma once

#include <atomic>
#include <condition_variable>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "arris/image.h"
#include "render/shoot.h"
#include "view/background_job.h"
#include "view/beam_worker.h"
#include "view/frame_encoder.h"
#include "view/frame_pace.h"
#include "view/shown_view.h"
#include "view/view_renderer.h"

namespace arris::view {

class ViewRenderer::Loop {
 public:
  Loop(ViewModel model, ViewRendererSettings settings);
  ~Loop();

  void start(ViewOutputs outputs);

  // From any thread.
  void post(std::function<void()> task);
  bool put(Input input);
  void set_next_send(std::optional<Clock::time_point> time);

  // Of the loop's own thread, posted.
  void join(ClientId client);
  void leave(ClientId client);
  void save_picture(const PictureSaved& done);
  void save_scene(const std::string& file_name, const SceneSaved& done);
  void save_beam(const std::function<void(std::vector<std::uint8_t>)>& done);
  void open(std::filesystem::path file, std::string name,
            std::function<void(const std::string&)> done);
  void reload();
  void send_scene_soon() { scene_dirty_ = true; }

 private:
  // What engines have been told and don't show yet.
  struct Asked {
    ViewEdits edits;
    std::vector<InputMark> marks;
  };
  struct Client {
    ClientId id = 0;
    std::optional<PictureSize> size;  // that it has asked for
  };
  struct OpenRequest {
    std::filesystem::path file;
    std::string name;
    bool keeps_edits = false;  // the same model again; else the file goes away
    std::function<void(const std::string&)> done;
  };

  void run();
  void wait();
  void take(Input input);
  void apply(const Input& input);
  void pick(const Input& input, const Pick& at);
  void start_beam();
  void poll_beam();

  void follow_edits();
  void start_build();
  void start_open();
  void step();
  void finish_build();
  void drop_build();
  void take_view(ShownView view);
  void send_lost();
  void tell_engines();
  void note_shown_changes();
  void undo_asked(const std::string& error);

  [[nodiscard]] bool wants_frame() const;
  [[nodiscard]] Clock::time_point frame_due(std::optional<Clock::time_point> send) const;
  [[nodiscard]] bool is_shader_idle();
  void rest();
  void set_size(PictureSize size);
  void note_active(const Input& input);
  void make_frame();
  void publish(bool moving, bool converged);
  void make_pictures();
  const Image& compose(const Image& main, const Image* right);
  void send_state(bool now);
  void send_scene();
  [[nodiscard]] std::string describe_scene() const;
  [[nodiscard]] bool has_news() const { return scene_dirty_ || camera_dirty_; }
  void send_errors(const std::vector<InputMark>& marks, const std::string& what,
                   const std::string& about) const;
  void send(const char* type, std::string text, std::optional<ClientId> to = {},
            std::optional<ClientId> but_not = {}) const;
  void set_busy(const std::string& what);
  [[nodiscard]] BuildSettings build_settings();
  void cancel_build();

  // What all threads look at.
  std::mutex mutex_;
  std::condition_variable wake_;
  ViewMailbox mailbox_;
  std::deque<std::function<void()>> tasks_;
  std::optional<Clock::time_point> next_send_;
  bool woken_ = false;
  std::atomic<bool> stopped_ = false;
  std::atomic<bool> hurry_ = false;  // inputs wait
  std::vector<StopFlag> stops_;      // of views that are built and shown

  ViewRendererSettings settings_;
  ViewOutputs outputs_;
  std::unique_ptr<FrameEncoder> encoder_;
  std::unique_ptr<PictureSaver> saver_;
  Rgb8Picture codes_;
  SetQuality quality_;

  ShownView view_;
  std::uint32_t model_number_ = 1;  // ServerFacts::model
  ViewEdits desired_;
  std::vector<InputMark> unasked_;  // of inputs that `desired_` has and no engine or build yet
  std::deque<Asked> asked_;
  std::vector<InputMark> shown_;
  std::vector<InputMark> taken_;  // of inputs that `desired_` has, or that were refused
  std::vector<InputMark> building_;
  ViewEdits built_;  // what is being built
  BackgroundJob<ShownView> build_;
  StopFlag build_stop_;
  std::optional<OpenRequest> opening_;  // being built
  std::optional<OpenRequest> next_open_;
  bool reload_waits_ = false;      // the model's file has changed
  std::vector<std::string> lost_;  // lost_objects() of what was read again
  std::string busy_;

  const Image* picture_ = nullptr;    // of the last frame
  std::uint64_t picture_number_ = 0;  // of all that were made
  Image composed_;
  std::optional<std::pair<std::shared_ptr<const PreparedScene>, Shooter>> shooter_;
  BeamWorker beam_;

  FramePace pace_;
  bool settled_ = false;  // nothing to be seen would change
  std::uint32_t frame_number_ = 0;
  std::vector<Client> clients_;               // who has said something last is the last one
  std::optional<ClientId> sized_by_;          // whose size the picture has
  std::optional<Clock::time_point> rest_at_;  // set: nobody looks at a large picture
  bool scene_dirty_ = false, camera_dirty_ = false;
  std::optional<ClientId> camera_but_not_;  // who has set it; empty: several
  Clock::time_point scene_sent_, state_sent_;
  double planned_points_ = 0;  // what the shader was asked for with the last frame

  std::thread thread_;
};

}  // namespace arris::view
