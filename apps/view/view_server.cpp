#include "view/view_server.h"

#include <fcntl.h>
#include <fmt/format.h>

#include <boost/asio/ip/address.hpp>
#include <boost/asio/post.hpp>
#include <csignal>
#include <system_error>
#include <utility>

#include "arris/error.h"
#include "view/access.h"
#include "view/server_impl.h"
#include "view/view_report.h"

namespace arris::view {
namespace {

using asio::ip::tcp;
using boost::system::error_code;

constexpr auto kWatchInterval = std::chrono::milliseconds(300);
// A page that is loaded again leaves, too.
constexpr auto kOnceGrace = std::chrono::milliseconds(1500);
constexpr auto kCloseGrace = std::chrono::milliseconds(200);
constexpr auto kAcceptPause = std::chrono::milliseconds(100);

// ::ffff:0.0.0.0 is 0.0.0.0, and is to be known as such.
asio::ip::address unmapped(const asio::ip::address& address) {
  if (!address.is_v6() || !address.to_v6().is_v4_mapped()) return address;
  return asio::ip::make_address_v4(asio::ip::v4_mapped, address.to_v6());
}

tcp::endpoint find_endpoint(const ServerSettings& settings, asio::io_context& context) {
  error_code error;
  const auto address = asio::ip::make_address(settings.host, error);
  if (!error) return {unmapped(address), settings.port};
  tcp::resolver resolver(context);
  const auto found = resolver.resolve(settings.host, std::to_string(settings.port), error);
  // An empty name, or one such as "0", would open the server to all without saying so.
  if (settings.host.empty() || settings.host == "*" || error || found.empty() ||
      found.begin()->endpoint().address().is_unspecified()) {
    throw Error(Error::Kind::input, "--host",
                fmt::format("\"{}\" is no address of this machine; use 127.0.0.1 for this machine "
                            "alone, 0.0.0.0 for all that can reach it",
                            settings.host));
  }
  return found.begin()->endpoint();
}

}  // namespace

ViewServer::Impl::Impl(ViewModel model, ViewRendererSettings renderer, ServerSettings settings)
    : settings_(std::move(settings)),
      token_(settings_.token.empty() ? make_token() : settings_.token) {
  listen();
  renderer_ = std::make_unique<ViewRenderer>(std::move(model), std::move(renderer));
  wait_for_signal();
}

ViewServer::Impl::~Impl() {
  upload_folder_.reset();  // the program may not wait for all that the renderer does
  renderer_.reset();
}

void ViewServer::Impl::listen() {
  tcp::endpoint endpoint = find_endpoint(settings_, context_);
  error_code error;
  const auto bind = [&] {
    acceptor_.close(error);
    acceptor_.open(endpoint.protocol(), error);
    // Programs that are started must not hold it.
    if (!error) ::fcntl(acceptor_.native_handle(), F_SETFD, FD_CLOEXEC);
    if (!error) acceptor_.set_option(asio::socket_base::reuse_address(true), error);
    if (!error) acceptor_.bind(endpoint, error);
    if (!error) acceptor_.listen(asio::socket_base::max_listen_connections, error);
  };
  bind();
  if (error == asio::error::address_in_use && settings_.or_any_port) {
    endpoint.port(0);
    bind();
  }
  if (!error) return;
  throw Error(Error::Kind::failed, fmt::format("{}:{}", settings_.host, settings_.port),
              fmt::format("can't be listened at ({}); use another --port, or --host 127.0.0.1",
                          error.message()));
}

std::string ViewServer::Impl::address() const {
  const tcp::endpoint endpoint = acceptor_.local_endpoint();
  std::string host = endpoint.address().to_string();
  if (endpoint.address().is_unspecified()) host = endpoint.address().is_v6() ? "::1" : "127.0.0.1";
  if (host.find(':') != std::string::npos) host = "[" + host + "]";
  return fmt::format("http://{}:{}/?t={}", host, endpoint.port(), token_);
}

bool ViewServer::Impl::is_open_to_all() const {
  return acceptor_.local_endpoint().address().is_unspecified();
}

void ViewServer::Impl::run() {
  accept();
  if (settings_.watch) watch();
  renderer_->start({[this](std::shared_ptr<const ViewFrame> frame) {
                      asio::post(context_, [this, frame = std::move(frame)] {
                        for (const auto& [id, client] : clients_) {
                          if (const auto session = client.lock()) session->put(frame);
                        }
                        update_ready();
                      });
                    },
                    [this](ViewText text) {
                      asio::post(context_, [this, text = std::move(text)] { send(text); });
                    }});
  context_.run();
}

void ViewServer::Impl::send(const ViewText& text) {
  for (const auto& [id, client] : clients_) {
    if (const auto session = client.lock()) session->put(text);
  }
}

void ViewServer::Impl::stop() {
  asio::post(context_, [this] { close_all(); });
}

void ViewServer::Impl::wait_for_signal() {
  signals_.add(SIGINT);
  signals_.add(SIGTERM);
  signals_.add(SIGHUP);
  signals_.async_wait([this](error_code error, int) {
    if (error) return;
    error_code ignored;
    signals_.clear(ignored);  // a second one ends the program
    close_all();
  });
}

// Pages are told, and given a moment to hear it.
void ViewServer::Impl::close_all() {
  error_code ignored;
  acceptor_.close(ignored);
  for (const auto& [id, client] : clients_) {
    if (const auto session = client.lock()) session->close();
  }
  end_timer_.expires_after(clients_.empty() ? std::chrono::milliseconds(0) : kCloseGrace);
  end_timer_.async_wait([this](error_code) { context_.stop(); });
}

void ViewServer::Impl::accept() {
  acceptor_.async_accept([this](error_code error, tcp::socket socket) {
    if (!acceptor_.is_open()) return;
    if (error) {
      // Too many open files, perhaps: others end.
      auto timer = std::make_shared<asio::steady_timer>(context_, kAcceptPause);
      timer->async_wait([this, timer](error_code) { accept(); });
      return;
    }
    // Programs that are started must not hold it.
    ::fcntl(socket.native_handle(), F_SETFD, FD_CLOEXEC);
    // A frame's last bytes would wait for an acknowledgement of those before, which comes 40 ms late.
    error_code ignored;
    socket.set_option(tcp::no_delay(true), ignored);
    start_http_session(*this, std::move(socket));
    accept();
  });
}

void ViewServer::Impl::add_stranger(Stranger& stranger) {
  strangers_.push_back(&stranger);
  if (strangers_.size() <= kMostStrangers) return;
  Stranger* oldest = strangers_.front();
  strangers_.erase(strangers_.begin());
  oldest->drop();
}

bool ViewServer::Impl::admit(Stranger& stranger) {
  if (connections_ >= kMostConnections) return false;
  remove_stranger(stranger);
  ++connections_;
  return true;
}

ClientId ViewServer::Impl::add_client(std::weak_ptr<ClientSession> session) {
  const ClientId client = next_client_++;
  clients_.emplace(client, std::move(session));
  end_timer_.cancel();
  renderer_->join(client);
  update_ready();
  return client;
}

void ViewServer::Impl::remove_client(ClientId client) {
  if (clients_.erase(client) == 0) return;
  renderer_->leave(client);
  update_ready();
  if (settings_.once && clients_.empty()) end_soon();
}

void ViewServer::Impl::end_soon() {
  end_timer_.expires_after(kOnceGrace);
  end_timer_.async_wait([this](error_code error) {
    if (!error && clients_.empty()) close_all();
  });
}

void ViewServer::Impl::update_ready() {
  std::optional<Clock::time_point> first;
  for (const auto& [id, client] : clients_) {
    const auto session = client.lock();
    const auto next = session ? session->next_send() : std::nullopt;
    if (next && (!first || *next < *first)) first = next;
  }
  renderer_->set_next_send(first);
}

std::optional<ViewText> ViewServer::Impl::watch_problem() const {
  if (watch_problem_.empty()) return std::nullopt;
  const std::string text =
      watch_problem_ + ", the picture shows what was read before; put it back to go on";
  return ViewText{"error", error_message({}, text, kAboutFile), {}, {}};
}

void ViewServer::Impl::watch() {
  watch_timer_.expires_after(kWatchInterval);
  watch_timer_.async_wait([this](error_code error) {
    if (error || !settings_.watch) return;
    FileWatch::Look look = settings_.watch->look();
    if (look.changed) renderer_->reload();
    if (look.problem != watch_problem_) {
      watch_problem_ = std::move(look.problem);
      send(watch_problem().value_or(ViewText{"error", no_error_message(kAboutFile), {}, {}}));
    }
    watch();
  });
}

void ViewServer::Impl::end_watch() {
  settings_.watch.reset();
  watch_timer_.cancel();
  if (watch_problem_.empty()) return;
  watch_problem_.clear();
  send({"error", no_error_message(kAboutFile), {}, {}});
}

bool ViewServer::Impl::begin_upload() {
  if (uploading_) return false;
  uploading_ = true;
  return true;
}

std::filesystem::path ViewServer::Impl::upload_file(const std::string& extension) {
  if (!upload_folder_) upload_folder_.emplace("view");
  return *upload_folder_ / fmt::format("model{}{}", uploads_++, extension);
}

ViewServer::ViewServer(ViewModel model, ViewRendererSettings renderer, ServerSettings settings)
    : impl_(std::make_unique<Impl>(std::move(model), std::move(renderer), std::move(settings))) {}
ViewServer::~ViewServer() = default;

std::string ViewServer::address() const {
  return impl_->address();
}
bool ViewServer::is_open_to_all() const {
  return impl_->is_open_to_all();
}
void ViewServer::run() {
  impl_->run();
}
void ViewServer::stop() {
  impl_->stop();
}

}  // namespace arris::view
