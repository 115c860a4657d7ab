#include "view/socket_session.h"

#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <string>
#include <utility>
#include <variant>

#include "arris/error.h"
#include "view/view_protocol.h"
#include "view/view_report.h"

namespace arris::view {
namespace {

namespace beast = boost::beast;
namespace websocket = beast::websocket;
using boost::system::error_code;
using Request = beast::http::request<beast::http::string_body>;

class SocketSession : public ClientSession, public std::enable_shared_from_this<SocketSession> {
 public:
  SocketSession(ViewServer::Impl& server, beast::tcp_stream stream, Request request)
      : server_(server), request_(std::move(request)), socket_(std::move(stream)) {}
  ~SocketSession() override { server_.remove_connection(); }
  SocketSession(const SocketSession&) = delete;
  SocketSession& operator=(const SocketSession&) = delete;

  void start() {
    websocket::stream_base::timeout timeout{server_.settings().header_time, kIdleTime, true};
    socket_.set_option(timeout);
    socket_.read_message_max(kMaxMessageBytes);
    socket_.auto_fragment(false);
    socket_.control_callback([this](websocket::frame_type kind, beast::string_view) {
      if (kind == websocket::frame_type::close) give_up_seat();
    });
    socket_.async_accept(request_,
                         [self = shared_from_this()](error_code error) { self->on_accept(error); });
  }

  void put(const ViewText& text) override {
    has_scene_ = has_scene_ || text.type == "scene";
    queue_->put(text);
    write();
  }
  void put(std::shared_ptr<const ViewFrame> frame) override {
    queue_->put(std::move(frame));
    write();
  }
  [[nodiscard]] std::optional<Clock::time_point> next_send() const override {
    return greeted_ ? queue_->next_send() : std::nullopt;
  }

  void close() override {
    if (closing_) return;
    closing_ = true;
    if (!writing_) send_close();
  }

 private:
  void on_accept(error_code error) {
    if (error) return;
    // Meanwhile others may have come.
    if (!server_.has_room_for_client()) return;
    client_ = server_.add_client(weak_from_this());
    queue_.emplace(client_);
    if (const auto problem = server_.watch_problem()) put(*problem);
    read();
  }

  void read() {
    socket_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t) {
      self->on_read(error);
    });
  }

  void on_read(error_code error) {
    if (error) return leave();
    const std::string text = beast::buffers_to_string(buffer_.data());
    buffer_.consume(buffer_.size());
    take(text);
    read();
  }

  void take(const std::string& text) {
    try {
      if (socket_.got_binary()) throw Error(Error::Kind::input, "message", "must be text");
      const ClientMessage message = parse_message(text);
      if (const auto* ack = std::get_if<Ack>(&message.what)) {
        queue_->acknowledge(ack->frame, Clock::now());
        write();
        return server_.update_ready();
      }
      if (std::holds_alternative<Hello>(message.what)) {
        greeted_ = true;
        server_.update_ready();
      } else if (!greeted_) {
        throw Error(Error::Kind::input, "message", "hello must come first");
      }
      if (!server_.renderer().put(client_, message)) {
        throw Error(Error::Kind::input, "message", "too many wait already; this one is not taken");
      }
    } catch (const Error& error) {
      const MessageHead head = find_head(text);
      put(ViewText{"error", error_message(head.seq, error.what(), head.type), client_, {}});
      // The page is to show what is, not what was asked for.
      if (head.seq) server_.renderer().repeat_scene();
    }
  }

  void write() {
    if (writing_ || closing_) return;
    // Nobody gets frames before saying how large they should be, and hearing of what.
    const Clock::time_point now = Clock::now();
    auto next = queue_->take(
        greeted_ && has_scene_ ? ClientQueue::Kinds::all : ClientQueue::Kinds::texts, now);
    if (!next) return;
    writing_ = true;
    if (auto* text = std::get_if<ClientQueue::Text>(&*next)) {
      text_ = std::move(*text);
      socket_.text(true);
      return send(asio::buffer(text_));
    }
    frame_ = std::move(std::get<ClientQueue::Frame>(*next));
    text_ = frame_header(*frame_, client_, now);
    socket_.binary(true);
    send(std::array<asio::const_buffer, 2>{asio::buffer(text_), asio::buffer(frame_->jpeg)});
  }

  template <class Buffers>
  void send(const Buffers& buffers) {
    socket_.async_write(buffers, [self = shared_from_this()](error_code error, std::size_t) {
      self->writing_ = false;
      self->frame_.reset();
      if (error) return self->leave();
      if (self->has_left_) return;
      if (self->closing_) return self->send_close();
      self->write();
    });
  }

  void send_close() {
    socket_.async_close(websocket::close_code::going_away,
                        [self = shared_from_this()](error_code) {});
  }

  // The connection's end may take long: the other side has to close it, too.
  void give_up_seat() {
    if (!queue_) return;
    closing_ = true;
    has_left_ = true;
    server_.remove_client(client_);
  }

  void leave() {
    if (!queue_) return;
    give_up_seat();
    beast::get_lowest_layer(socket_).close();
  }

  ViewServer::Impl& server_;
  Request request_;
  websocket::stream<beast::tcp_stream> socket_;
  beast::flat_buffer buffer_;
  std::optional<ClientQueue> queue_;  // set: it is a client
  ClientId client_ = 0;
  bool greeted_ = false, has_scene_ = false, writing_ = false, closing_ = false;
  bool has_left_ = false;
  std::string text_;  // what is being sent
  ClientQueue::Frame frame_;
};

}  // namespace

void start_socket_session(ViewServer::Impl& server, beast::tcp_stream stream, Request request) {
  std::make_shared<SocketSession>(server, std::move(stream), std::move(request))->start();
}

}  // namespace arris::view
