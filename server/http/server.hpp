// Listens, reads requests within limits, asks for an answer, writes it. Knows HTTP/1.1 and nothing of robots.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>

#include "server/http/message.hpp"

namespace server {

struct HttpLimits {
  std::size_t header_bytes = 8 * 1024;  // request line and headers together
  std::size_t target_bytes = 2 * 1024;
  std::size_t body_bytes = 64 * 1024;
  std::chrono::milliseconds header{5'000};  // from the first byte to the end of the headers
  std::chrono::milliseconds idle{30'000};   // between requests
  double body_bytes_per_second = 4096.0;    // slower bodies are cut off (after the header time has been granted again)
  std::chrono::milliseconds write{30'000};  // for an answer, and more for a big one
  std::size_t connections = 4000;           // at once
  std::size_t per_address = 256;            // at once; this machine's own addresses are free of it
};

class HttpConnection;

class HttpServer : public std::enable_shared_from_this<HttpServer> {
 public:
  // method, status, seconds from the end of the request to the end of the answer's making
  using Observe = std::function<void(const std::string& method, int status, double seconds)>;

  HttpServer(net::io_context& context, HttpLimits limits, Handler answer, Observe observe);

  // Throws boost::system::system_error when the address cannot be had. Port 0: any free one.
  void listen(const std::string& address, unsigned short port);
  unsigned short port() const { return acceptor_.local_endpoint().port(); }
  std::size_t connections() const { return connections_; }
  void stop();

 private:
  net::awaitable<void> accept_loop();
  net::awaitable<void> serve(tcp::socket socket, net::ip::address peer);
  bool admit(const net::ip::address& peer) const;

  net::io_context& context_;
  HttpLimits limits_;
  Handler answer_;
  Observe observe_;
  tcp::acceptor acceptor_;
  std::size_t connections_ = 0;
  std::map<net::ip::address, std::size_t> by_address_;
  std::set<HttpConnection*> open_;
};

}  // namespace server
