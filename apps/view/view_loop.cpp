#include "view/view_loop.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <iterator>
#include <utility>
#include <variant>

#include "arris/error.h"
#include "render/camera.h"
#include "render/prepared_scene.h"
#include "view/scene_file.h"
#include "view/view_report.h"

namespace arris::view {
namespace {

constexpr auto kStateInterval = std::chrono::milliseconds(500);
constexpr auto kSceneInterval = std::chrono::milliseconds(100);
// Clients that take nothing don't keep the view from getting finer.
constexpr auto kUnreadyWait = std::chrono::milliseconds(250);

bool is_move(const MessageKind& what) {
  if (const auto* object = std::get_if<SetObject>(&what))
    return object->world_from_object.has_value();
  return std::holds_alternative<SetCamera>(what) || std::holds_alternative<FrameView>(what);
}

}  // namespace

ViewRenderer::Loop::Loop(ViewModel model, ViewRendererSettings settings)
    : settings_(std::move(settings)) {
  auto shared = std::make_shared<const ViewModel>(std::move(model));
  desired_ = first_edits(*shared);
  view_ = build_view(shared, desired_, build_settings());
}

ViewRenderer::Loop::~Loop() {
  stopped_ = true;
  {
    const std::lock_guard lock(mutex_);
    for (const StopFlag& stop : stops_) *stop = true;
    woken_ = true;
  }
  wake_.notify_all();
  if (thread_.joinable()) thread_.join();
  encoder_.reset();
  saver_.reset();
}

void ViewRenderer::Loop::start(ViewOutputs outputs) {
  outputs_ = std::move(outputs);
  encoder_ = std::make_unique<FrameEncoder>(FrameEncoder::Outputs{
      outputs_.send_frame,
      [this](const std::string& error) { send("error", error_message({}, error)); }});
  saver_ = std::make_unique<PictureSaver>();
  pace_.note_change(Clock::now());
  thread_ = std::thread([this] { run(); });
}

BuildSettings ViewRenderer::Loop::build_settings() {
  build_stop_ = std::make_shared<std::atomic<bool>>(false);
  const std::lock_guard lock(mutex_);
  std::erase_if(stops_, [](const StopFlag& stop) { return stop.use_count() == 1; });
  stops_.push_back(build_stop_);
  if (stopped_) *build_stop_ = true;
  return {settings_.threads, settings_.trace_below_ms, &hurry_, build_stop_};
}

// finish_build() hears of it.
void ViewRenderer::Loop::cancel_build() {
  if (build_.is_running()) *build_stop_ = true;
}

// What any thread may call.

void ViewRenderer::Loop::post(std::function<void()> task) {
  {
    const std::lock_guard lock(mutex_);
    tasks_.push_back(std::move(task));
    woken_ = true;
  }
  wake_.notify_all();
}

bool ViewRenderer::Loop::put(Input input) {
  {
    const std::lock_guard lock(mutex_);
    if (!mailbox_.put(std::move(input))) return false;
    woken_ = true;
    hurry_ = true;
  }
  wake_.notify_all();
  return true;
}

void ViewRenderer::Loop::set_next_send(std::optional<Clock::time_point> time) {
  {
    const std::lock_guard lock(mutex_);
    if (next_send_ == time) return;
    next_send_ = time;
    woken_ = true;
  }
  wake_.notify_all();
}

// The loop.

void ViewRenderer::Loop::run() {
  while (!stopped_) {
    try {
      step();
    } catch (const std::exception& error) {  // out of memory, say: what is shown stays
      send("error", error_message({}, error.what()));
    }
  }
}

void ViewRenderer::Loop::step() {
  wait();
  std::deque<std::function<void()>> tasks;
  std::vector<Input> inputs;
  std::optional<Clock::time_point> send;
  {
    // Together: an input never overtakes its client's join().
    const std::lock_guard lock(mutex_);
    tasks.swap(tasks_);
    inputs = mailbox_.take();
    woken_ = false;
    hurry_ = false;
    send = next_send_;
  }
  for (const auto& task : tasks) task();
  tasks.clear();
  for (Input& input : inputs) take(std::move(input));
  if (rest_at_ && Clock::now() >= *rest_at_) rest();
  finish_build();
  follow_edits();
  poll_beam();
  if (wants_frame() && Clock::now() >= frame_due(send)) make_frame();
  if (has_news() && Clock::now() >= scene_sent_ + kSceneInterval) send_scene();
}

bool ViewRenderer::Loop::wants_frame() const {
  return !clients_.empty() && !settled_;
}

// So that it is there when it can be sent.
Clock::time_point ViewRenderer::Loop::frame_due(std::optional<Clock::time_point> send) const {
  if (!send) return std::max(pace_.next_frame(), pace_.last_frame() + kUnreadyWait);
  if (*send == Clock::time_point::min()) return pace_.next_frame();
  const std::chrono::duration<double, std::milli> work(pace_.frame_ms());
  return std::max(pace_.next_frame(), *send - std::chrono::duration_cast<Clock::duration>(work));
}

void ViewRenderer::Loop::wait() {
  std::unique_lock lock(mutex_);
  const auto is_woken = [&] { return woken_ || stopped_; };
  std::optional<Clock::time_point> until;
  if (wants_frame()) until = frame_due(next_send_);
  if (has_news()) {
    const Clock::time_point due = scene_sent_ + kSceneInterval;
    until = until ? std::min(*until, due) : due;
  }
  if (rest_at_) until = until ? std::min(*until, *rest_at_) : *rest_at_;
  if (until) {
    wake_.wait_until(lock, *until, is_woken);
  } else {
    wake_.wait(lock, is_woken);
  }
}

void ViewRenderer::Loop::take(Input input) {
  const auto is_here = [&](ClientId id) {
    return std::ranges::find(clients_, id, &Client::id) != clients_.end();
  };
  std::erase_if(input.marks, [&](const InputMark& mark) { return !is_here(mark.client); });
  // Who has left sees nothing, and picks nothing.
  const bool is_own = std::holds_alternative<Hello>(input.what) ||
                      std::holds_alternative<SetSize>(input.what) ||
                      std::holds_alternative<Pick>(input.what);
  if (is_own && !is_here(input.client)) return;
  try {
    apply(input);
  } catch (const std::exception& error) {
    add_marks(shown_, input.marks);
    send("error",
         error_message(input.marks.empty() ? std::nullopt : std::optional(input.marks.back().seq),
                       error.what(), type_of(input.what)),
         input.client);
    // The page is to show what is, not what was asked for.
    send_scene_soon();
  }
  add_marks(taken_, input.marks);
}

void ViewRenderer::Loop::apply(const Input& input) {
  const Clock::time_point now = Clock::now();
  if (const auto* at = std::get_if<Pick>(&input.what)) return pick(input, *at);
  if (std::holds_alternative<MakeBeam>(input.what)) {
    add_marks(shown_, input.marks);
    return start_beam();
  }
  if (std::holds_alternative<StopBeam>(input.what)) {
    add_marks(shown_, input.marks);
    beam_.stop();
    return;
  }
  if (const auto* quality = std::get_if<SetQuality>(&input.what)) {
    quality_ = *quality;
    add_marks(shown_, input.marks);
    settled_ = false;
    return;
  }
  apply_message(*view_.model, input.what, desired_);
  note_active(input);
  const bool is_next_frame = std::holds_alternative<SetCamera>(input.what) ||
                             std::holds_alternative<FrameView>(input.what) ||
                             std::holds_alternative<SetOverlay>(input.what);
  add_marks(is_next_frame ? shown_ : unasked_, input.marks);
  settled_ = false;
  if (is_move(input.what)) {
    pace_.note_move(now);
  } else {
    pace_.hurry(now);
  }
  if (!std::holds_alternative<SetCamera>(input.what)) return send_scene_soon();
  // A client knows the camera that it has set.
  if (clients_.size() > 1) {
    camera_but_not_ = camera_dirty_ && camera_but_not_ != input.client
                          ? std::nullopt
                          : std::optional(input.client);
    camera_dirty_ = true;
  }
}

void ViewRenderer::Loop::pick(const Input& input, const Pick& at) {
  add_marks(shown_, input.marks);
  const std::shared_ptr<const PreparedScene>& scene = view_.engine->scene();
  if (!shooter_ || shooter_->first != scene) shooter_.emplace(scene, Shooter(*scene));
  const CameraRays rays = make_camera_rays(desired_.camera, scene_of(*scene).image);
  const Ray ray{desired_.camera.position, rays.corner + rays.step_x * at.x + rays.step_y * at.y};
  const std::optional<Shot> shot = shooter_->second.shoot(ray);
  std::optional<std::uint32_t> object;
  if (shot) {
    const auto& index_of = view_.staged.index_of;
    const auto found = std::ranges::find(index_of, std::optional(shot->object.index));
    if (found != index_of.end()) object = std::uint32_t(found - index_of.begin());
  }
  const auto seq = input.marks.empty() ? std::nullopt : std::optional(input.marks.back().seq);
  send("picked", picked_message(seq, shot, object), input.client);
}

void ViewRenderer::Loop::start_beam() {
  StagedBeams staged = stage_beams(*view_.model, desired_);
  send("beam", beam_message({}));
  beam_.start(std::move(staged.scene), staged.settings, settings_.threads, [this] { post([] {}); });
}

void ViewRenderer::Loop::poll_beam() {
  if (const auto status = beam_.take_status()) {
    send("beam", beam_message(*status));
  }
}

// Clients.

void ViewRenderer::Loop::join(ClientId client) {
  clients_.push_back({client, {}});
  rest_at_.reset();
  settled_ = false;
  pace_.hurry(Clock::now());
  send("scene", with_seq(describe_scene(), 0), client);
  if (!busy_.empty()) send("busy", busy_message(busy_), client);
}

void ViewRenderer::Loop::leave(ClientId client) {
  std::erase_if(clients_, [&](const Client& other) { return other.id == client; });
  if (clients_.empty()) rest_at_ = Clock::now() + settings_.rest_after;
  if (sized_by_ == client) {
    sized_by_.reset();
    const auto heir =
        std::ranges::find_if(clients_.rbegin(), clients_.rend(),
                             [](const Client& other) { return other.size.has_value(); });
    if (heir != clients_.rend()) {
      sized_by_ = heir->id;
      set_size(*heir->size);
    }
  }
  const auto is_theirs = [&](const InputMark& mark) { return mark.client == client; };
  std::erase_if(shown_, is_theirs);
  std::erase_if(taken_, is_theirs);
  std::erase_if(unasked_, is_theirs);
  std::erase_if(building_, is_theirs);
  for (Asked& asked : asked_) std::erase_if(asked.marks, is_theirs);
}

void ViewRenderer::Loop::note_active(const Input& input) {
  const auto client = std::ranges::find(clients_, input.client, &Client::id);
  if (client == clients_.end()) return;
  std::optional<PictureSize> size;
  if (const auto* hello = std::get_if<Hello>(&input.what)) size = hello->size;
  if (const auto* asked = std::get_if<SetSize>(&input.what)) size = asked->size;
  if (size) {
    client->size = size;
    sized_by_ = input.client;
  }
  std::rotate(client, client + 1, clients_.end());
}

void ViewRenderer::Loop::set_size(PictureSize size) {
  apply_message(*view_.model, SetSize{size}, desired_);
  settled_ = false;
  pace_.hurry(Clock::now());
  send_scene_soon();
}

void ViewRenderer::Loop::rest() {
  rest_at_.reset();
  const PictureSize first = first_edits(*view_.model).size;
  if (area_of(desired_.size) > area_of(first)) set_size(first);
}

void ViewRenderer::Loop::send(const char* type, std::string text, std::optional<ClientId> to,
                              std::optional<ClientId> but_not) const {
  outputs_.send_text({type, std::move(text), to, but_not});
}

// To each client that has sent one of them, with the newest seq of its own.
void ViewRenderer::Loop::send_errors(const std::vector<InputMark>& marks, const std::string& what,
                                     const std::string& about) const {
  if (marks.empty()) return send("error", error_message({}, what, about));
  for (const InputMark& mark : marks) {
    send("error", error_message(mark.seq, what, about), mark.client);
  }
}

std::string ViewRenderer::Loop::describe_scene() const {
  return scene_message(view_, desired_, {settings_.upload, model_number_});
}

// Or only the camera, to those who have not set it.
void ViewRenderer::Loop::send_scene() {
  scene_sent_ = Clock::now();
  if (std::exchange(camera_dirty_, false) && !scene_dirty_) {
    return send("camera", camera_message(desired_.camera), {}, camera_but_not_);
  }
  scene_dirty_ = false;
  const std::string text = describe_scene();
  for (const Client& client : clients_) {
    const auto mark = std::ranges::find(taken_, client.id, &InputMark::client);
    send("scene", with_seq(text, mark == taken_.end() ? 0 : mark->seq), client.id);
  }
}

void ViewRenderer::Loop::set_busy(const std::string& what) {
  if (busy_ == what) return;
  busy_ = what;
  send("busy", busy_message(busy_));
}

void ViewRenderer::Loop::send_state(bool now) {
  const Clock::time_point time = Clock::now();
  if (!now && time < state_sent_ + kStateInterval) return;
  state_sent_ = time;
  ViewState state;
  state.stats = view_.engine->stats();
  state.fps = pace_.fps(time);
  state.frame_ms = pace_.frame_ms();
  state.seconds = pace_.still_seconds(time);
  const double pixels = double(view_.edits.size.width_px) * view_.edits.size.height_px;
  state.new_samples = double(state.stats.new_points) / pixels;
  state.moving = pace_.is_moving(time);
  state.converged = settled_;
  send("state", state_message(state, *view_.engine->scene()));
}

// Files to save, and models to open.

void ViewRenderer::Loop::save_picture(const PictureSaved& done) {
  try {
    if (picture_ == nullptr) make_pictures();
    saver_->put(picture_number_, *picture_, view_.model->scene.image.exposure, done);
  } catch (const std::exception& error) {
    done(nullptr, error.what());
  }
}

void ViewRenderer::Loop::save_scene(const std::string& file_name, const SceneSaved& done) {
  std::string text;
  try {
    text = make_scene_file(*view_.model, desired_, file_name);
  } catch (const std::exception& error) {
    return done({}, error.what());
  }
  done(std::move(text), "");
}

void ViewRenderer::Loop::save_beam(const std::function<void(std::vector<std::uint8_t>)>& done) {
  done(beam_.picture());
}

void ViewRenderer::Loop::open(std::filesystem::path file, std::string name,
                              std::function<void(const std::string&)> done) {
  if (next_open_ && next_open_->done) next_open_->done("another model was opened meanwhile");
  next_open_ = OpenRequest{std::move(file), std::move(name), false, std::move(done)};
  cancel_build();
}

void ViewRenderer::Loop::reload() {
  reload_waits_ = true;
  // An upload that waits or is prepared is to be shown instead, if it can be.
  if (!next_open_ && (!opening_ || opening_->keeps_edits)) cancel_build();
}

}  // namespace arris::view
