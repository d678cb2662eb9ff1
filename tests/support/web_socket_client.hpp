// A WebSocket client for tests: Beast's own implementation, so that ours is held against another one. Every step has a
// deadline.
#pragma once

#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/websocket.hpp>
#include <functional>
#include <optional>

#include "tests/support/http_client.hpp"

namespace testing_support {

namespace websocket = boost::beast::websocket;

class WebSocketClient {
 public:
  explicit WebSocketClient(unsigned short port, const std::string& cookie = "", const std::string& path = "/ws",
                           const std::string& origin = "")
      : stream_(context_) {
    stream_.next_layer().connect({net::ip::make_address("127.0.0.1"), port});
    stream_.set_option(websocket::stream_base::decorator([=](websocket::request_type& request) {
      if (!cookie.empty()) request.set(http::field::cookie, cookie);
      if (!origin.empty()) request.set(http::field::origin, origin);
    }));
    step("handshake", [&](auto done) { stream_.async_handshake("127.0.0.1:" + std::to_string(port), path, done); });
  }

  void send(const Json& message) { send_text(message.dump()); }
  void send_text(const std::string& text) {
    stream_.text(true);
    step("write", [&](auto done) {
      stream_.async_write(net::buffer(text), [done](boost::system::error_code error, std::size_t) { done(error); });
    });
  }

  struct Message {
    bool text = true;
    std::string payload;
  };
  // The next message.
  Message read(std::chrono::milliseconds patience = std::chrono::seconds(10)) {
    boost::beast::flat_buffer buffer;
    step(
        "read",
        [&](auto done) {
          stream_.async_read(buffer, [done](boost::system::error_code error, std::size_t) { done(error); });
        },
        patience);
    return {stream_.got_text(), boost::beast::buffers_to_string(buffer.data())};
  }
  // The next JSON message of a type; others are passed over.
  Json await(const std::string& type, const std::function<bool(const Json&)>& fits = {}) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(15);
    while (std::chrono::steady_clock::now() < deadline) {
      const Message message = read();
      if (!message.text) continue;
      Json json = Json::parse(message.payload);
      if (json.at("type") == type && (!fits || fits(json))) return json;
    }
    throw std::runtime_error("no message of type " + type);
  }
  std::string await_binary(char kind) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(15);
    while (std::chrono::steady_clock::now() < deadline) {
      const Message message = read();
      if (!message.text && !message.payload.empty() && message.payload[0] == kind) return message.payload;
    }
    throw std::runtime_error("no binary message");
  }
  // Reads until the other side closes; its close code.
  std::uint16_t await_close() {
    try {
      for (int i = 0; i < 10'000; ++i) read();
    } catch (const boost::system::system_error&) {
    }
    return stream_.reason().code;
  }
  void close() {
    step("close", [&](auto done) { stream_.async_close(websocket::close_code::normal, done); });
  }

 private:
  using Done = std::function<void(boost::system::error_code)>;
  void step(const char* what, const std::function<void(Done)>& start,
            std::chrono::milliseconds patience = std::chrono::seconds(10)) {
    bool done = false;
    boost::system::error_code failed;
    start([&](boost::system::error_code error) {
      done = true;
      failed = error;
    });
    run_until(context_, done, patience, what);
    if (failed) throw boost::system::system_error(failed, what);
  }

  net::io_context context_;
  websocket::stream<net::ip::tcp::socket> stream_;
};

}  // namespace testing_support
