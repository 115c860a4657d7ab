// view_server.h — the viewer over HTTP and WebSocket (docs/view-protocol.md)
// What       one thread serves the page, the WebSocket and files to save; the renderer's thread makes the frames
// Guarantee  what clients send is bounded in size, number and time, whether or not they read; without the token nothing
//            but the page's own files is to be had, and however many come without it, who has it gets in; nothing that
//            a client sends becomes a path
// Errors     arris::Error, kind failed: no such address to listen at
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "view/file_watch.h"
#include "view/view_renderer.h"

namespace arris::view {

struct ServerSettings {
  std::string host = "127.0.0.1";
  std::uint16_t port = 0;    // 0: any that is free
  bool or_any_port = false;  // if that port is taken
  bool once = false;         // end when the last client has left
  bool allow_upload = false;
  std::string token;  // is_good_token(); empty: a new one
  // A request's head, its body, and the connection of who has been answered may take so long.
  std::chrono::milliseconds header_time{5'000}, body_time{120'000};
  std::shared_ptr<FileWatch>
      watch;  // the model is shown again when its files change; null: it is not
};

class ViewServer {
 public:
  // Listens; prepares the first view. From then on it has SIGINT, SIGTERM and SIGHUP.
  ViewServer(ViewModel model, ViewRendererSettings renderer, ServerSettings settings);
  ViewServer(const ViewServer&) = delete;
  ViewServer& operator=(const ViewServer&) = delete;
  ~ViewServer();

  // With the token.
  [[nodiscard]] std::string address() const;
  // Whether it listens on every address of this machine.
  [[nodiscard]] bool is_open_to_all() const;
  // Until SIGINT, SIGTERM, stop(), or the last client leaves.
  void run();
  void stop();  // from any thread

  class Impl;  // of the server's own sources

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace arris::view
