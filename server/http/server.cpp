#include "server/http/server.hpp"

#include <spdlog/spdlog.h>

#include <boost/asio/ip/v6_only.hpp>

#include "server/http/connection.hpp"

namespace server {

HttpServer::HttpServer(net::io_context& context, HttpLimits limits, Handler answer, Observe observe)
    : context_(context),
      limits_(limits),
      answer_(std::move(answer)),
      observe_(std::move(observe)),
      acceptor_(context) {}

void HttpServer::listen(const std::string& address, unsigned short port) {
  const tcp::endpoint endpoint(net::ip::make_address(address), port);
  acceptor_.open(endpoint.protocol());
  acceptor_.set_option(net::socket_base::reuse_address(true));
  if (endpoint.address().is_v6()) acceptor_.set_option(net::ip::v6_only(false));
  acceptor_.bind(endpoint);
  acceptor_.listen(1024);
  net::co_spawn(
      context_, [self = shared_from_this()] { return self->accept_loop(); }, net::detached);
}

void HttpServer::stop() {
  error_code ignored;
  acceptor_.close(ignored);
  for (HttpConnection* connection : open_) connection->abort();
}

bool HttpServer::admit(const net::ip::address& peer) const {
  if (connections_ >= limits_.connections) return false;
  const auto it = by_address_.find(peer);
  return peer.is_loopback() || it == by_address_.end() || it->second < limits_.per_address;
}

net::awaitable<void> HttpServer::accept_loop() {
  const auto self = shared_from_this();
  while (acceptor_.is_open()) {
    error_code error;
    tcp::socket socket = co_await acceptor_.async_accept(quietly(error));
    if (error == net::error::operation_aborted) co_return;
    if (error) {
      // Out of descriptors: those who are connected must go on, so wait until some have left.
      net::steady_timer pause(context_, std::chrono::milliseconds(100));
      co_await pause.async_wait(quietly(error));
      continue;
    }
    const tcp::endpoint remote = socket.remote_endpoint(error);
    if (error) continue;
    const net::ip::address address = remote.address().is_v6() && remote.address().to_v6().is_v4_mapped()
                                         ? net::ip::make_address_v4(net::ip::v4_mapped, remote.address().to_v6())
                                         : remote.address();
    if (!admit(address)) {
      static constexpr std::string_view full =
          "HTTP/1.1 503 Service Unavailable\r\nRetry-After: 5\r\nContent-Length: 0\r\nConnection: close\r\n\r\n";
      socket.non_blocking(true, error);
      socket.write_some(net::buffer(full), error);
      continue;
    }
    net::co_spawn(
        context_, [self, s = std::move(socket), address]() mutable { return self->serve(std::move(s), address); },
        [](std::exception_ptr failure) {
          if (!failure) return;
          try {
            std::rethrow_exception(failure);
          } catch (const std::exception& exception) {
            spdlog::error("a connection ended by an error of ours: {}", exception.what());
          }
        });
  }
}

net::awaitable<void> HttpServer::serve(tcp::socket socket, net::ip::address peer) {
  const auto self = shared_from_this();
  HttpConnection connection(std::move(socket), peer, limits_, answer_, observe_);
  // Counted for as long as this frame lives, however it ends.
  struct Counted {
    HttpServer& server;
    HttpConnection& connection;
    net::ip::address peer;
    Counted(HttpServer& s, HttpConnection& c, net::ip::address p) : server(s), connection(c), peer(std::move(p)) {
      ++server.connections_;
      ++server.by_address_[peer];
      server.open_.insert(&connection);
    }
    ~Counted() {
      --server.connections_;
      if (--server.by_address_[peer] == 0) server.by_address_.erase(peer);
      server.open_.erase(&connection);
    }
  } counted(*this, connection, peer);
  co_await connection.run();
}

}  // namespace server
