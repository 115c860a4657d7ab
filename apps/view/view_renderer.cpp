#include "view/view_renderer.h"

#include <utility>

#include "view/view_loop.h"

namespace arris::view {

ViewRenderer::ViewRenderer(ViewModel model, ViewRendererSettings settings)
    : loop_(std::make_unique<Loop>(std::move(model), std::move(settings))) {}
ViewRenderer::~ViewRenderer() = default;

void ViewRenderer::start(ViewOutputs outputs) {
  loop_->start(std::move(outputs));
}

void ViewRenderer::join(ClientId client) {
  loop_->post([loop = loop_.get(), client] { loop->join(client); });
}
void ViewRenderer::leave(ClientId client) {
  loop_->post([loop = loop_.get(), client] { loop->leave(client); });
}

bool ViewRenderer::put(ClientId client, const ClientMessage& message) {
  Input input{client, message.what, {}};
  if (message.seq) input.marks.push_back({client, *message.seq, Clock::now()});
  return loop_->put(std::move(input));
}

void ViewRenderer::set_next_send(std::optional<Clock::time_point> time) {
  loop_->set_next_send(time);
}

void ViewRenderer::save_picture(PictureSaved done) {
  loop_->post([loop = loop_.get(), done = std::move(done)] { loop->save_picture(done); });
}
void ViewRenderer::save_scene(std::string file_name, SceneSaved done) {
  loop_->post([loop = loop_.get(), name = std::move(file_name), done = std::move(done)] {
    loop->save_scene(name, done);
  });
}
void ViewRenderer::save_beam(std::function<void(std::vector<std::uint8_t>)> done) {
  loop_->post([loop = loop_.get(), done = std::move(done)] { loop->save_beam(done); });
}

void ViewRenderer::open(std::filesystem::path file, std::string name,
                        std::function<void(const std::string&)> done) {
  loop_->post([loop = loop_.get(), file = std::move(file), name = std::move(name),
               done = std::move(done)] { loop->open(file, name, done); });
}
void ViewRenderer::repeat_scene() {
  loop_->post([loop = loop_.get()] { loop->send_scene_soon(); });
}
void ViewRenderer::reload() {
  loop_->post([loop = loop_.get()] { loop->reload(); });
}

}  // namespace arris::view
