// server_impl.h — ViewServer's inside: what its sessions share
// Limits     all of it belongs to the server's thread
#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/signal_set.hpp>
#include <boost/asio/steady_timer.hpp>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "io/child_process.h"
#include "view/client_queue.h"
#include "view/view_server.h"

namespace arris::view {

namespace asio = boost::asio;

// Bounds, for all clients together where it says so.
inline constexpr std::size_t kMostStrangers = 32, kMostConnections = 64, kMostClients = 8;
inline constexpr std::uint32_t kMostHeaderBytes = 8192;
inline constexpr std::uint64_t kMostUploadBytes = std::uint64_t(256) << 20;
inline constexpr auto kIdleTime = std::chrono::seconds(60);
// Who sends on while being answered would lose the answer if the connection ended at once.
inline constexpr auto kLingerTime = std::chrono::seconds(2);

// A page that looks: the WebSocket's end that the server knows.
class ClientSession {
 public:
  virtual ~ClientSession() = default;
  virtual void put(const ViewText& text) = 0;
  virtual void put(std::shared_ptr<const ViewFrame> frame) = 0;
  [[nodiscard]] virtual std::optional<Clock::time_point> next_send() const = 0;
  virtual void close() = 0;
};

// A connection that has not shown the token.
class Stranger {
 public:
  virtual ~Stranger() = default;
  virtual void drop() = 0;  // its end comes later, but no answer
};

class ViewServer::Impl {
 public:
  Impl(ViewModel model, ViewRendererSettings renderer, ServerSettings settings);
  ~Impl();

  [[nodiscard]] std::string address() const;
  [[nodiscard]] bool is_open_to_all() const;
  void run();
  void stop();

  // For sessions.
  [[nodiscard]] const ServerSettings& settings() const { return settings_; }
  [[nodiscard]] const std::string& token() const { return token_; }
  [[nodiscard]] asio::io_context& context() { return context_; }
  [[nodiscard]] ViewRenderer& renderer() { return *renderer_; }

  [[nodiscard]] bool has_room_for_client() const { return clients_.size() < kMostClients; }
  ClientId add_client(std::weak_ptr<ClientSession> session);
  void remove_client(ClientId client);
  void update_ready();
  // Another model is shown: files of the one before are of no interest any more.
  void end_watch();
  // Of the files that are watched; empty: none.
  [[nodiscard]] std::optional<ViewText> watch_problem() const;

  // Of too many the oldest is dropped.
  void add_stranger(Stranger& stranger);
  void remove_stranger(Stranger& stranger) { std::erase(strangers_, &stranger); }
  // It has shown the token, and counts until remove_connection(). False: too many are there.
  bool admit(Stranger& stranger);
  void remove_connection() { --connections_; }

  bool begin_upload();  // false: there is one already
  void end_upload() { uploading_ = false; }
  // Where an upload is kept, until the server ends or the next one is.
  std::filesystem::path upload_file(const std::string& extension);

 private:
  void listen();
  void accept();
  void wait_for_signal();
  void watch();
  void send(const ViewText& text);
  void end_soon();
  void close_all();

  ServerSettings settings_;
  std::string token_;
  // Sessions that end with the context look at these.
  std::size_t connections_ = 0;
  std::vector<Stranger*> strangers_;  // the oldest first
  bool uploading_ = false;
  asio::io_context context_{1};
  asio::ip::tcp::acceptor acceptor_{context_};
  asio::signal_set signals_{context_};
  asio::steady_timer end_timer_{context_}, watch_timer_{context_};
  std::map<ClientId, std::weak_ptr<ClientSession>> clients_;
  ClientId next_client_ = 1;
  std::uint64_t uploads_ = 0;
  std::optional<ScratchFolder> upload_folder_;
  std::string watch_problem_;
  std::unique_ptr<ViewRenderer> renderer_;  // last: its thread uses the context
};

// Serves one request and ends, or hands the connection on to a client session.
void start_http_session(ViewServer::Impl& server, asio::ip::tcp::socket socket);

}  // namespace arris::view
