#include "server/stream/web_socket.hpp"

namespace server {

using protocols::web::Message;
using protocols::web::Opcode;
namespace close_code = protocols::web::close_code;

WebSocket::WebSocket(tcp::socket socket, std::size_t slots, WebSocketLimits limits, std::string early)
    : socket_(std::move(socket)),
      timer_(socket_.get_executor()),
      limits_(limits),
      outbox_(slots, limits.outbox),
      reader_(limits.inbound_bytes),
      inbound_(limits.inbound, Clock::now()),
      early_(std::move(early)),
      heard_(Clock::now()),
      progress_(heard_) {
  error_code ignored;
  socket_.non_blocking(true, ignored);
  socket_.set_option(tcp::no_delay(true), ignored);
  // A deep kernel buffer would hold old pictures for a slow viewer; newest-wins must happen here.
  socket_.set_option(net::socket_base::send_buffer_size(128 * 1024), ignored);
}

net::awaitable<void> WebSocket::run(OnText on_text) {
  using namespace net::experimental::awaitable_operators;
  const auto self = shared_from_this();
  flush();
  co_await (read_loop(on_text) || watch());
  abort();
}

net::awaitable<void> WebSocket::read_loop(const OnText& on_text) {
  take_in(early_, on_text);
  early_.clear();
  std::vector<char> buffer(2048);
  while (socket_.is_open() && !heard_close_) {
    error_code error;
    const std::size_t size = co_await socket_.async_read_some(net::buffer(buffer), quietly(error));
    if (error) co_return;
    heard_ = Clock::now();
    pinged_ = false;
    take_in({buffer.data(), size}, on_text);
  }
  flush();
}

void WebSocket::take_in(std::span<const char> bytes, const OnText& on_text) {
  std::vector<Message> messages;
  const auto failure = reader_.feed(bytes, messages);
  for (const Message& message : messages) {
    if (closing_ && message.opcode != Opcode::close) continue;
    if (!inbound_.take(Clock::now())) return close(close_code::policy, "too many messages");
    switch (message.opcode) {
      case Opcode::text:
        on_text(message.payload);
        break;
      case Opcode::binary:
        close(close_code::unsupported, "send text");
        break;
      default:
        take_control(message);
    }
  }
  if (failure) {
    const bool too_big = *failure == close_code::too_big;
    close(*failure, too_big ? "message too big" : *failure == close_code::bad_payload ? "bad UTF-8" : "bad frame");
  }
}

void WebSocket::take_control(const Message& message) {
  if (message.opcode == Opcode::ping) answer(Opcode::pong, message.payload);
  if (message.opcode != Opcode::close) return;
  heard_close_ = true;
  if (closing_) return;
  const auto code = message.payload.size() < 2
                        ? close_code::normal
                        : static_cast<std::uint16_t>(static_cast<unsigned char>(message.payload[0]) << 8 |
                                                     static_cast<unsigned char>(message.payload[1]));
  close(code, "");
}

// Ends the line when nothing is heard, nothing can be sent, or the other side does not answer a close.
net::awaitable<void> WebSocket::watch() {
  while (socket_.is_open()) {
    error_code error;
    timer_.expires_after(std::chrono::seconds(1));
    co_await timer_.async_wait(quietly(error));
    if (error) co_return;
    const auto now = Clock::now();
    if (!waiting_) progress_ = now;
    if (now - progress_ > limits_.stall || now - heard_ > limits_.silence) co_return;
    if (closing_ && now - close_at_ > limits_.closing) co_return;
    if (!closing_ && !pinged_ && now - heard_ > limits_.ping_after) {
      pinged_ = true;
      answer(Opcode::ping, "");
    }
  }
}

void WebSocket::state(std::size_t slot, const Frame& frame) {
  if (closing_) return;
  outbox_.put(slot, frame);
  flush();
}

void WebSocket::event(const Frame& frame) {
  if (closing_) return;
  outbox_.push(frame);
  flush();
}

void WebSocket::answer(Opcode opcode, std::string_view payload) {
  if (closing_) return;
  if (!outbox_.push_first(std::make_shared<const std::string>(protocols::web::encode_frame(opcode, payload)))) {
    return close(close_code::policy, "answers are not read");
  }
  flush();
}

void WebSocket::close(std::uint16_t code, std::string_view reason) {
  if (closing_) return;
  closing_ = true;
  close_at_ = Clock::now();
  outbox_ = Outbox(0, limits_.outbox);
  outbox_.push_first(std::make_shared<const std::string>(protocols::web::encode_close(code, reason)));
  flush();
}

void WebSocket::flush() {
  constexpr std::size_t gather = 16 * 1024;  // bytes: small frames go out in one call, big ones alone
  while (socket_.is_open() && !waiting_) {
    if (sent_ == sending_.size()) {
      sending_.clear();
      sent_ = 0;
      while (sending_.size() < gather) {
        const Frame frame = outbox_.take();
        if (!frame) break;
        sending_ += *frame;
      }
      if (sending_.empty()) break;
    }
    error_code error;
    sent_ += socket_.write_some(net::buffer(sending_.data() + sent_, sending_.size() - sent_), error);
    if (error == net::error::would_block || error == net::error::try_again) return wait_until_writable();
    if (error) return abort();
  }
  if (!socket_.is_open() || waiting_ || !closing_) return;
  error_code ignored;
  socket_.shutdown(tcp::socket::shutdown_send, ignored);
  if (heard_close_) timer_.cancel();
}

void WebSocket::wait_until_writable() {
  waiting_ = true;
  progress_ = Clock::now();
  socket_.async_wait(tcp::socket::wait_write, [self = shared_from_this()](error_code error) {
    self->waiting_ = false;
    if (!error) self->flush();
  });
}

void WebSocket::abort() {
  error_code ignored;
  socket_.close(ignored);
  timer_.cancel();
}

}  // namespace server
