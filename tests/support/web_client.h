// web_client.h — what a browser does, as far as the viewer's tests need it: HTTP requests and a WebSocket, blocking
// Limits     waits are long, so that slow machines pass; what never comes throws
#pragma once

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace arris::test {

inline constexpr int kPatienceMs = 120'000;

class Connection {
 public:
  explicit Connection(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
      ::close(socket_);
      throw std::runtime_error("nobody listens");
    }
    // As browsers do: small messages wait for nothing.
    const int on = 1;
    ::setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
  }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  ~Connection() { ::close(socket_); }

  // False: the other end has closed.
  bool send(const std::string& bytes) const {
    for (std::size_t sent = 0; sent < bytes.size();) {
      const ssize_t count = ::send(socket_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
      if (count <= 0) return false;
      sent += std::size_t(count);
    }
    return true;
  }

  // Nothing: the other end has closed.
  std::optional<std::string> read(std::size_t count) {
    while (buffer_.size() < count) {
      if (!fill(kPatienceMs)) return std::nullopt;
    }
    std::string out = buffer_.substr(0, count);
    buffer_.erase(0, count);
    return out;
  }

  std::optional<std::string> read_until(const std::string& end) {
    std::size_t at = 0;
    while ((at = buffer_.find(end)) == std::string::npos) {
      if (!fill(kPatienceMs)) return std::nullopt;
    }
    return read(at + end.size());
  }

  std::string read_all() {
    while (fill(kPatienceMs)) {
    }
    return std::exchange(buffer_, "");
  }

  // Whether something is there, now or within a time.
  bool has_more(int wait_ms) {
    if (!buffer_.empty()) return true;
    pollfd waiting{socket_, POLLIN, 0};
    return ::poll(&waiting, 1, wait_ms) > 0;
  }

 private:
  bool fill(int wait_ms) {
    pollfd waiting{socket_, POLLIN, 0};
    if (::poll(&waiting, 1, wait_ms) <= 0) throw std::runtime_error("nothing comes");
    char block[65536];
    const ssize_t count = ::recv(socket_, block, sizeof block, 0);
    if (count <= 0) return false;
    buffer_.append(block, std::size_t(count));
    return true;
  }

  int socket_;
  std::string buffer_;
};

struct Response {
  int status = 0;  // 0: none
  std::string head, body;
};

struct Request {
  std::string target, method = "GET", host = "127.0.0.1", origin, body;
  std::string more;  // header lines

  explicit Request(std::string to) : target(std::move(to)) {}
  Request& at_host(const std::string& value) { return host = value, *this; }
  Request& from(const std::string& value) { return origin = value, *this; }
  Request& with(const std::string& lines) { return more = lines, *this; }
  Request& by(const std::string& value) { return method = value, *this; }
  Request& post(const std::string& what) { return body = what, by("POST"); }
};

inline Response fetch(std::uint16_t port, const Request& request) {
  Connection connection(port);
  std::string text = fmt::format("{} {} HTTP/1.1\r\nHost: {}\r\n{}", request.method, request.target,
                                 request.host, request.more);
  if (!request.origin.empty()) text += fmt::format("Origin: {}\r\n", request.origin);
  if (!request.body.empty()) text += fmt::format("Content-Length: {}\r\n", request.body.size());
  connection.send(text + "\r\n" + request.body);
  Response response;
  const auto head = connection.read_until("\r\n\r\n");
  if (!head) return response;
  response.head = *head;
  response.status = std::stoi(head->substr(9, 3));
  response.body = connection.read_all();
  return response;
}

struct Frame {
  std::uint32_t number = 0, seq = 0, flags = 0, samples = 0;
  int width = 0, height = 0;
  float latency_ms = 0;
  std::string jpeg;
  [[nodiscard]] bool is_converged() const { return (flags & 2) != 0; }
};

class WebSocket {
 public:
  WebSocket(std::uint16_t port, const std::string& token, const std::string& origin = "")
      : connection_(port) {
    std::string text = fmt::format(
        "GET /ws?t={} HTTP/1.1\r\nHost: 127.0.0.1:{}\r\nUpgrade: websocket\r\nConnection: "
        "Upgrade\r\n"
        "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n",
        token, port);
    if (!origin.empty()) text += fmt::format("Origin: {}\r\n", origin);
    connection_.send(text + "\r\n");
    const auto head = connection_.read_until("\r\n\r\n");
    status_ = head ? std::stoi(head->substr(9, 3)) : 0;
  }

  [[nodiscard]] int status() const { return status_; }

  bool send(const nlohmann::json& message) { return send_text(message.dump()); }
  bool send_text(const std::string& text) { return send_frame(0x81, text); }
  bool send_frame(unsigned first_byte, const std::string& payload) {
    std::string out(1, char(first_byte));
    if (payload.size() < 126) {
      out += char(0x80 | payload.size());
    } else if (payload.size() < 65536) {
      out += char(0x80 | 126);
      out += char(payload.size() >> 8);
      out += char(payload.size() & 0xFF);
    } else {
      out += char(0x80 | 127);
      for (int shift = 56; shift >= 0; shift -= 8) out += char(payload.size() >> shift & 0xFF);
    }
    return connection_.send(out + std::string(4, '\0') + payload);  // masked by zeros
  }

  struct Message {
    bool is_binary = false;
    std::string payload;
  };
  // Nothing: closed. Answers pings, but they are not what is waited for.
  std::optional<Message> read() {
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(kPatienceMs);
    while (std::chrono::steady_clock::now() < end) {
      const auto head = connection_.read(2);
      if (!head) return std::nullopt;
      const auto kind = static_cast<unsigned char>((*head)[0]) & 15U;
      std::uint64_t size = static_cast<unsigned char>((*head)[1]) & 127U;
      if (size >= 126) {
        const auto more = connection_.read(size == 126 ? 2 : 8);
        if (!more) return std::nullopt;
        size = 0;
        for (const char c : *more) size = size << 8 | static_cast<unsigned char>(c);
      }
      auto payload = connection_.read(std::size_t(size));
      if (!payload || kind == 8) return std::nullopt;
      if (kind == 9) send_frame(0x8A, *payload);
      if (kind == 1 || kind == 2) return Message{kind == 2, std::move(*payload)};
    }
    throw std::runtime_error("nothing but pings comes");
  }

  nlohmann::json read_text(const std::string& type) {
    for (;;) {
      auto message = read();
      if (!message) throw std::runtime_error("closed");
      if (message->is_binary) {
        frames_.push_back(parse(message->payload));
        continue;
      }
      nlohmann::json json = nlohmann::json::parse(message->payload);
      if (json["type"] == type) return json;
    }
  }

  // The next one, not acknowledged.
  Frame read_frame() {
    if (!frames_.empty()) {
      Frame frame = std::move(frames_.front());
      frames_.erase(frames_.begin());
      return frame;
    }
    for (;;) {
      auto message = read();
      if (!message) throw std::runtime_error("closed");
      if (message->is_binary) return parse(message->payload);
      texts_.push_back(nlohmann::json::parse(message->payload));
    }
  }
  Frame read_and_acknowledge() {
    Frame frame = read_frame();
    send({{"type", "ack"}, {"frame", frame.number}});
    return frame;
  }

  bool has_more(int wait_ms) { return connection_.has_more(wait_ms); }
  // Texts that came while frames were read.
  [[nodiscard]] const std::vector<nlohmann::json>& texts() const { return texts_; }

  static Frame parse(const std::string& payload) {
    if (payload.size() < 32 || payload.substr(0, 4) != "ARRF") {
      throw std::runtime_error("no frame");
    }
    Frame frame;
    const auto read = [&](std::size_t at, auto& value) {
      std::memcpy(&value, payload.data() + at, sizeof value);
    };
    std::uint16_t width = 0, height = 0;
    read(4, frame.number);
    read(8, frame.seq);
    read(12, width);
    read(14, height);
    read(16, frame.latency_ms);
    read(20, frame.flags);
    read(24, frame.samples);
    frame.width = width;
    frame.height = height;
    frame.jpeg = payload.substr(32);
    return frame;
  }

 private:
  Connection connection_;
  int status_ = 0;
  std::vector<Frame> frames_;
  std::vector<nlohmann::json> texts_;
};

}  // namespace arris::test
