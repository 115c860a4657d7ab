// socket_session.h — a page's WebSocket, begun by its request
#pragma once

#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>

#include "view/server_impl.h"

namespace arris::view {

// Precondition: the request may look. The connection counts until the session ends.
void start_socket_session(ViewServer::Impl& server, boost::beast::tcp_stream stream,
                          boost::beast::http::request<boost::beast::http::string_body> request);

}  // namespace arris::view
