// One viewer's WebSocket. It alone writes to the socket: frames that were built once are sent without blocking, first
// at once and, when the line is full, as soon as it drains. Answers pings, enforces RFC 6455, ends dead and stalled
// lines.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "protocols/web/websocket.hpp"
#include "server/stream/asio.hpp"
#include "server/stream/outbox.hpp"
#include "server/stream/token_bucket.hpp"

namespace server {

struct WebSocketLimits {
  std::size_t inbound_bytes = 16 * 1024;  // of one message, fragments together
  Rate inbound{40.0, 20.0};               // messages and control frames
  std::chrono::seconds ping_after{20};    // of silence
  std::chrono::seconds silence{60};       // nothing heard: the line is dead
  std::chrono::seconds stall{10};         // nothing could be sent although something waits
  std::chrono::seconds closing{2};        // for the other side's close
  OutboxLimits outbox;
};

class WebSocket : public std::enable_shared_from_this<WebSocket> {
 public:
  using OnText = std::function<void(const std::string&)>;

  // `slots`: how many state topics there are. `early`: bytes that came along with the handshake.
  WebSocket(tcp::socket socket, std::size_t slots, WebSocketLimits limits, std::string early);

  // Reads until the line ends; text messages go to `on_text`. Must be called once.
  net::awaitable<void> run(OnText on_text);

  void state(std::size_t slot, const Frame& frame);
  void event(const Frame& frame);
  // An answer to this viewer alone, ahead of everything.
  void answer(protocols::web::Opcode opcode, std::string_view payload);
  void forget(std::size_t slot) {
    if (!closing_) outbox_.clear(slot);
  }
  // Says why and ends the line once what is under way has been sent.
  void close(std::uint16_t code, std::string_view reason);

  bool is_open() const { return !closing_ && socket_.is_open(); }
  std::size_t waiting_bytes() const { return outbox_.bytes() + (sending_.size() - sent_); }
  std::uint64_t take_dropped() { return outbox_.take_dropped(); }

 private:
  net::awaitable<void> read_loop(const OnText& on_text);
  net::awaitable<void> watch();
  void take_in(std::span<const char> bytes, const OnText& on_text);
  void take_control(const protocols::web::Message& message);
  void flush();
  void wait_until_writable();
  void abort();

  tcp::socket socket_;
  net::steady_timer timer_;
  WebSocketLimits limits_;
  Outbox outbox_;
  protocols::web::FrameReader reader_;
  TokenBucket inbound_;
  std::string early_;
  std::string sending_;   // frames gathered into one write
  std::size_t sent_ = 0;  // bytes of it that the kernel has taken
  bool waiting_ = false;  // for the socket to become writable
  bool closing_ = false;  // a close frame has been queued; nothing follows it
  bool heard_close_ = false;
  bool pinged_ = false;
  Clock::time_point heard_;
  Clock::time_point progress_;  // when the kernel last took something, or nothing waited
  Clock::time_point close_at_;  // when the close was queued
};

}  // namespace server
