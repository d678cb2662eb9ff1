// One client's HTTP connection: requests one after the other, each within the limits, until either side ends it.
#pragma once

#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>

#include "server/http/server.hpp"

namespace server {

class HttpConnection {
 public:
  HttpConnection(tcp::socket socket, net::ip::address peer, const HttpLimits& limits, const Handler& answer,
                 const HttpServer::Observe& observe);

  net::awaitable<void> run();
  void abort();

 private:
  using Parser = http::request_parser<http::string_body>;

  // What to answer to a request that cannot be read; status 0: nothing, the line is gone or was silent.
  net::awaitable<protocols::web::Problem> read(Parser& parser);
  net::awaitable<protocols::web::Problem> read_body(Parser& parser);
  net::awaitable<bool> write(const Reply& reply, bool keep_alive, bool head_only);
  net::awaitable<void> linger();

  boost::beast::tcp_stream stream_;
  boost::beast::flat_buffer buffer_;
  net::ip::address peer_;
  const HttpLimits& limits_;
  const Handler& answer_;
  const HttpServer::Observe& observe_;
};

}  // namespace server
