// One connection: a request and its answer, or the beginning of a client session.
#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/dispatch.hpp>
#include <boost/asio/post.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <exception>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "io/file_bytes.h"
#include "view/access.h"
#include "view/server_impl.h"
#include "view/socket_session.h"
#include "view/web_files.h"

namespace arris::view {
namespace {

namespace beast = boost::beast;
namespace http = beast::http;
using boost::system::error_code;

std::string_view to_view(beast::string_view text) {
  return {text.data(), text.size()};
}

const char* type_of(std::string_view name) {
  if (name.ends_with(".html")) return "text/html; charset=utf-8";
  if (name.ends_with(".js")) return "text/javascript; charset=utf-8";
  if (name.ends_with(".css")) return "text/css; charset=utf-8";
  if (name.ends_with(".svg")) return "image/svg+xml";
  if (name.ends_with(".png")) return "image/png";
  return "application/octet-stream";
}

struct Answer {
  http::status status = http::status::ok;
  std::string type = "text/plain; charset=utf-8";
  std::string body;
  std::string file_name;  // to save it as
};

Answer refusal(http::status status, std::string text) {
  return {status, "text/plain; charset=utf-8", std::move(text) + "\n", ""};
}

class HttpSession : public Stranger, public std::enable_shared_from_this<HttpSession> {
 public:
  HttpSession(ViewServer::Impl& server, asio::ip::tcp::socket socket)
      : server_(server), stream_(std::move(socket)), timer_(server.context()) {
    parser_.header_limit(kMostHeaderBytes);
    parser_.body_limit(kMostUploadBytes);
  }
  ~HttpSession() override {
    end_upload();
    server_.remove_stranger(*this);
    if (counted_) server_.remove_connection();
  }
  HttpSession(const HttpSession&) = delete;
  HttpSession& operator=(const HttpSession&) = delete;

  void start() {
    server_.add_stranger(*this);
    wait_at_most(server_.settings().header_time);
    http::async_read_header(
        stream_, buffer_, parser_,
        [self = shared_from_this()](error_code error, std::size_t) { self->on_header(error); });
  }

  void drop() override { stream_.close(); }

 private:
  // What is being read ends then, and the client can be told so: the stream's own limit would close it.
  void wait_at_most(std::chrono::milliseconds time) {
    reading_ = true;
    timer_.expires_after(time);
    timer_.async_wait([weak = weak_from_this()](error_code error) {
      const auto self = weak.lock();
      if (error || !self || !self->reading_ || self->timer_.expiry() > Clock::now()) return;
      self->late_ = true;
      self->stream_.cancel();
    });
  }
  void end_wait() {
    reading_ = false;
    timer_.cancel();
  }
  static bool is_malformed(error_code error) {
    return error.category() == http::make_error_code(http::error::bad_version).category() &&
           error != http::error::end_of_stream;
  }

  void on_header(error_code error) {
    end_wait();
    if (error && late_ && parser_.got_some()) {
      return answer(refusal(http::status::request_timeout,
                            "the request did not arrive in time; send it at once"));
    }
    if (error == http::error::body_limit) {
      return answer(
          refusal(http::status::payload_too_large,
                  fmt::format("models can be up to {} MiB here", kMostUploadBytes >> 20)));
    }
    if (error == http::error::header_limit) {
      return answer(refusal(http::status::request_header_fields_too_large, "too long"));
    }
    if (is_malformed(error)) {
      return answer(refusal(http::status::bad_request,
                            fmt::format("this is no HTTP request ({}); open the address that arris "
                                        "view has printed in a browser",
                                        error.message())));
    }
    if (error) return;  // no request, or none in time
    const auto& request = parser_.get();
    if (request.count(http::field::host) > 1 || request.count(http::field::origin) > 1) {
      return answer(
          refusal(http::status::bad_request, "there must be one Host and at most one Origin"));
    }
    const std::string_view host = to_view(request[http::field::host]);
    if (!is_own_host(host, server_.settings().host)) {
      return answer(refusal(http::status::forbidden, "this server has another name"));
    }
    const auto origin = request.find(http::field::origin);
    if (origin != request.end() && !is_own_origin(to_view(origin->value()), host)) {
      return answer(refusal(http::status::forbidden, "pages from elsewhere may not look here"));
    }
    auto target = parse_target(to_view(request.target()));
    if (!target) return answer(refusal(http::status::bad_request, "no address"));
    target_ = std::move(*target);
    if (is_same_secret(target_.token, server_.token())) {
      if (!server_.admit(*this)) {
        return answer(
            refusal(http::status::service_unavailable, "too many connections; try again"));
      }
      counted_ = true;
    }
    if (request.method() == http::verb::post) return on_post();
    if (request.method() != http::verb::get) {
      return answer(refusal(http::status::method_not_allowed, "only GET, and POST of models"));
    }
    on_get();
  }

  [[nodiscard]] bool has_token() const { return counted_; }
  void refuse_token() {
    answer(refusal(http::status::forbidden,
                   "the address lacks its token; use the one that arris view has printed"));
  }

  void on_get() {
    const std::string& path = target_.path;
    const bool is_page = path == "/" || path == "/index.html";
    const std::string name = is_page ? "index.html" : path.substr(1);
    const auto files = web_files();
    const auto file = std::ranges::find(files, std::string_view(name), &WebFile::name);
    if (file != files.end()) {
      if (is_page && !has_token()) return refuse_token();
      return answer({http::status::ok, type_of(name), std::string(file->content), ""});
    }
    const bool is_known =
        path == "/ws" || path == "/picture.png" || path == "/scene.toml" || path == "/beam.png";
    if (!is_known) return answer(refusal(http::status::not_found, "there is no such address"));
    if (!has_token()) return refuse_token();
    if (path == "/ws") return on_socket();
    if (path == "/scene.toml") return on_scene();
    if (path == "/picture.png") return on_picture();
    server_.renderer().save_beam([self = shared_from_this()](const std::vector<std::uint8_t>& png) {
      if (png.empty()) {
        return self->answer_later(refusal(http::status::not_found, "there is no such picture"));
      }
      self->answer_later(
          {http::status::ok, "image/png", std::string(png.begin(), png.end()), "beam.png"});
    });
  }

  void on_scene() {
    const std::string name = saved_scene_name(target_.name);
    server_.renderer().save_scene(
        name, [self = shared_from_this(), name](std::string text, const std::string& problem) {
          if (!problem.empty()) return self->answer_later(refusal(http::status::conflict, problem));
          self->answer_later({http::status::ok, "application/toml", std::move(text), name});
        });
  }

  void on_picture() {
    server_.renderer().save_picture(
        [self = shared_from_this()](const PngFile& png, const std::string& problem) {
          if (!png) return self->answer_later(refusal(http::status::conflict, problem));
          self->answer_later({http::status::ok, "image/png", std::string(png->begin(), png->end()),
                              "picture.png"});
        });
  }

  void on_socket() {
    // First, as a page whose WebSocket was refused asks like this for the reason.
    if (!server_.has_room_for_client()) {
      return answer(refusal(http::status::service_unavailable,
                            fmt::format("{} pages look already; close one", kMostClients)));
    }
    if (!beast::websocket::is_upgrade(parser_.get())) {
      return answer(refusal(http::status::upgrade_required, "this is a WebSocket"));
    }
    start_socket_session(server_, std::move(stream_), parser_.release());
    counted_ = false;  // the client session counts now
  }

  // Models.

  void on_post() {
    if (target_.path != "/model") {
      return answer(refusal(http::status::not_found, "there is no such address"));
    }
    if (!has_token()) return refuse_token();
    if (!server_.settings().allow_upload) {
      return answer(refusal(http::status::forbidden,
                            "models may not be dropped here; start arris view --allow-upload"));
    }
    const auto extension = upload_extension(target_.name);
    if (!extension) {
      return answer(refusal(http::status::unsupported_media_type,
                            "this is no model that stands by itself; use .stl .obj .ply .off .step "
                            ".gltf .glb .csg"));
    }
    if (!server_.begin_upload()) {
      return answer(refusal(http::status::service_unavailable, "another model is on its way"));
    }
    uploading_ = true;
    extension_ = *extension;
    wait_at_most(server_.settings().body_time);
    http::async_read(
        stream_, buffer_, parser_,
        [self = shared_from_this()](error_code error, std::size_t) { self->on_body(error); });
  }

  void on_body(error_code error) {
    end_wait();
    if (error && late_) {
      const auto time =
          std::chrono::duration_cast<std::chrono::seconds>(server_.settings().body_time);
      return answer(
          refusal(http::status::request_timeout,
                  fmt::format("the model did not arrive within {} s; send a smaller one, or start "
                              "arris view with its file",
                              time.count())));
    }
    if (error == http::error::body_limit) {
      return answer(refusal(http::status::payload_too_large, "too large"));
    }
    if (is_malformed(error)) {
      return answer(refusal(http::status::bad_request, "the model is cut short or garbled"));
    }
    if (error) return;
    try {
      const std::filesystem::path file = server_.upload_file(extension_);
      std::string body = std::move(parser_.get().body());
      write_file_whole(file, {reinterpret_cast<const std::uint8_t*>(body.data()), body.size()});
      // The next one may come while this is prepared, and takes its place.
      end_upload();
      server_.renderer().open(
          file, shown_name(), [self = shared_from_this(), file](const std::string& problem) {
            std::error_code ignored;
            std::filesystem::remove(file, ignored);
            if (!problem.empty()) {
              return self->answer_later(refusal(http::status::unprocessable_entity, problem));
            }
            asio::post(self->server_.context(), [self] { self->server_.end_watch(); });
            self->answer_later({http::status::no_content, "", "", ""});
          });
    } catch (const std::exception&) {  // which names the folder
      answer(refusal(http::status::insufficient_storage,
                     "the server can't keep the model; is there room in its temporary folder?"));
    }
  }

  // What the page says it is called, without what could be a path; it names no file.
  [[nodiscard]] std::string shown_name() const {
    constexpr std::size_t kMostNameBytes = 100;
    std::string name = target_.name.substr(target_.name.find_last_of("/\\") + 1);
    std::erase_if(name, [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7f'; });
    return name.substr(name.size() > kMostNameBytes ? name.size() - kMostNameBytes : 0);
  }

  void end_upload() {
    if (std::exchange(uploading_, false)) server_.end_upload();
  }

  // Answers.

  // From the renderer's thread.
  void answer_later(Answer what) {
    asio::post(server_.context(), [self = shared_from_this(), what = std::move(what)]() mutable {
      self->answer(std::move(what));
    });
  }

  void answer(Answer what) {
    // Who has heard of one model's end may send the next.
    end_upload();
    response_ = {};
    response_.version(11);
    response_.result(what.status);
    response_.set(http::field::server, "arris");
    response_.set(http::field::cache_control, "no-store");
    response_.set("X-Content-Type-Options", "nosniff");
    response_.set("Referrer-Policy", "no-referrer");
    response_.set("X-Frame-Options", "DENY");
    response_.set("Cross-Origin-Resource-Policy", "same-origin");
    response_.set("Content-Security-Policy", content_policy());
    if (!what.type.empty()) response_.set(http::field::content_type, what.type);
    if (!what.file_name.empty()) {
      response_.set(http::field::content_disposition,
                    fmt::format("attachment; filename=\"{}\"", what.file_name));
    }
    response_.keep_alive(false);
    response_.body() = std::move(what.body);
    response_.prepare_payload();
    stream_.expires_after(counted_ ? server_.settings().body_time : server_.settings().header_time);
    http::async_write(
        stream_, response_, [self = shared_from_this()](error_code error, std::size_t) {
          if (error) return;
          error_code ignored;
          self->stream_.socket().shutdown(asio::ip::tcp::socket::shutdown_send, ignored);
          self->stream_.expires_after(kLingerTime);
          self->discard();
        });
  }

  // Until the client has read what it was told, and closes.
  void discard() {
    constexpr std::size_t kPiece = 16384;
    buffer_.clear();
    stream_.async_read_some(buffer_.prepare(kPiece),
                            [self = shared_from_this()](error_code error, std::size_t) {
                              if (!error) self->discard();
                            });
  }

  // Older browsers don't take a WebSocket for the page's own origin.
  [[nodiscard]] std::string content_policy() const {
    std::string host(to_view(parser_.get()[http::field::host]));
    const auto is_plain = [](char c) {
      return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
             c == '.' || c == '-' || c == ':' || c == '[' || c == ']';
    };
    if (!std::ranges::all_of(host, is_plain)) host.clear();
    const std::string sockets = host.empty() ? "" : fmt::format(" ws://{0} wss://{0}", host);
    return fmt::format(
        "default-src 'self'; img-src 'self' blob: data:; connect-src 'self'{}; frame-ancestors "
        "'none'; base-uri 'none'; form-action 'none'",
        sockets);
  }

  ViewServer::Impl& server_;
  beast::tcp_stream stream_;
  asio::steady_timer timer_;
  beast::flat_buffer buffer_{kMostHeaderBytes + 65536};
  http::request_parser<http::string_body> parser_;
  http::response<http::string_body> response_;
  Target target_;
  std::string extension_;
  bool uploading_ = false;
  bool reading_ = false, late_ = false;
  bool counted_ = false;  // it has shown the token
};

}  // namespace

void start_http_session(ViewServer::Impl& server, asio::ip::tcp::socket socket) {
  // The renderer's thread may hold a session last, but it belongs to the server's.
  const auto destroy = [&context = server.context()](HttpSession* session) {
    asio::dispatch(context, [owner = std::unique_ptr<HttpSession>(session)] {});
  };
  std::shared_ptr<HttpSession>(new HttpSession(server, std::move(socket)), destroy)->start();
}

}  // namespace arris::view
