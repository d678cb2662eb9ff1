#include "server/http/connection.hpp"

#include <spdlog/spdlog.h>

#include <array>
#include <boost/beast/http/read.hpp>
#include <ctime>

#include "server/http/url.hpp"

namespace server {
namespace {

using protocols::web::Problem;

constexpr Problem nothing_to_say() { return Problem{0, {}, {}, {}}; }
const Problem fine{200, {}, {}, {}};

// The Date header's value (RFC 9110, 5.6.7); made once a second.
const std::string& http_date() {
  static std::time_t made = 0;
  static std::string text;
  const std::time_t now = std::time(nullptr);
  if (now != made) {
    std::array<char, 64> buffer;
    std::tm parts{};
    gmtime_r(&now, &parts);
    text.assign(buffer.data(), std::strftime(buffer.data(), buffer.size(), "%a, %d %b %Y %H:%M:%S GMT", &parts));
    made = now;
  }
  return text;
}

Problem problem_of(error_code error) {
  if (error == http::error::header_limit) return {431, "headers_too_large", "The request's headers are too large.", ""};
  if (error == http::error::body_limit) return {413, "body_too_large", "The body is too large.", ""};
  if (error == http::error::bad_version) return {505, "bad_version", "Speak HTTP/1.1.", ""};
  const bool malformed = error.category() == make_error_code(http::error::bad_method).category() &&
                         error != http::error::end_of_stream && error != http::error::partial_message;
  if (malformed)
    return {400, "bad_request", "That is not a well-formed HTTP/1.1 request: " + error.message() + ".", ""};
  return nothing_to_say();
}

std::string head_of(const Reply& reply, bool keep_alive) {
  std::string head = "HTTP/1.1 " + std::to_string(reply.status) + " ";
  head += reply.status == 101 ? "Switching Protocols" : protocols::web::status_title(reply.status);
  head += "\r\nDate: " + http_date() + "\r\nX-Content-Type-Options: nosniff\r\nReferrer-Policy: same-origin\r\n";
  if (!reply.content_type.empty()) head += "Content-Type: " + reply.content_type + "\r\n";
  for (const auto& [name, value] : reply.headers) head.append(name).append(": ").append(value).append("\r\n");
  if (reply.status != 101) {
    if (!reply.takeover && reply.status != 204 && reply.status != 304) {
      head += "Content-Length: " + std::to_string(reply.body ? reply.body->size() : 0) + "\r\n";
    }
    head += keep_alive && !reply.takeover ? "Connection: keep-alive\r\n" : "Connection: close\r\n";
  }
  return head + "\r\n";
}

// What the parser lets through and we do not: more than one Host or length, a target we cannot read.
Problem check(const http::request<http::string_body>& request, const HttpLimits& limits) {
  if (request.target().size() > limits.target_bytes) return {414, "target_too_long", "The URL is too long.", ""};
  if (request.version() == 11 && request.count(http::field::host) != 1) {
    return {400, "bad_host", "Send exactly one Host header.", ""};
  }
  if (request.count(http::field::content_length) > 1 || request.count(http::field::transfer_encoding) > 1 ||
      (request.count(http::field::content_length) && request.count(http::field::transfer_encoding))) {
    return {400, "ambiguous_length", "Send one Content-Length, or one Transfer-Encoding, not both.", ""};
  }
  const auto expect = request[http::field::expect];
  if (!expect.empty() && !boost::beast::iequals(expect, "100-continue")) {
    return {417, "expectation_failed", "Only 'Expect: 100-continue' is known.", ""};
  }
  return fine;
}

}  // namespace

HttpConnection::HttpConnection(tcp::socket socket, net::ip::address peer, const HttpLimits& limits,
                               const Handler& answer, const HttpServer::Observe& observe)
    : stream_(std::move(socket)),
      buffer_(limits.header_bytes + 16 * 1024),
      peer_(std::move(peer)),
      limits_(limits),
      answer_(answer),
      observe_(observe) {
  error_code ignored;
  stream_.socket().set_option(tcp::no_delay(true), ignored);
}

void HttpConnection::abort() { stream_.close(); }

net::awaitable<Problem> HttpConnection::read(Parser& parser) {
  error_code error;
  if (buffer_.size() == 0) {
    stream_.expires_after(limits_.idle);
    const std::size_t size = co_await stream_.async_read_some(buffer_.prepare(1024), quietly(error));
    if (error) co_return nothing_to_say();
    buffer_.commit(size);
  }
  parser.header_limit(static_cast<std::uint32_t>(limits_.header_bytes));
  parser.body_limit(limits_.body_bytes);
  stream_.expires_after(limits_.header);
  co_await http::async_read_header(stream_, buffer_, parser, quietly(error));
  if (error) co_return problem_of(error);
  if (Problem problem = check(parser.get(), limits_); problem.status != 200) co_return problem;
  if (parser.content_length() && *parser.content_length() > limits_.body_bytes) {
    co_return problem_of(http::error::body_limit);
  }
  if (parser.is_done()) co_return fine;
  co_return co_await read_body(parser);
}

net::awaitable<Problem> HttpConnection::read_body(Parser& parser) {
  error_code error;
  if (!parser.get()[http::field::expect].empty()) {
    static constexpr std::string_view go_on = "HTTP/1.1 100 Continue\r\n\r\n";
    co_await net::async_write(stream_, net::buffer(go_on), quietly(error));
    if (error) co_return nothing_to_say();
  }
  const double bytes = static_cast<double>(parser.content_length().value_or(limits_.body_bytes));
  const std::chrono::duration<double> at_slowest(bytes / limits_.body_bytes_per_second);
  stream_.expires_after(limits_.header + std::chrono::duration_cast<std::chrono::milliseconds>(at_slowest));
  co_await http::async_read(stream_, buffer_, parser, quietly(error));
  co_return error ? problem_of(error) : fine;
}

net::awaitable<void> HttpConnection::run() {
  while (stream_.socket().is_open()) {
    Parser parser;
    const Problem problem = co_await read(parser);
    if (problem.status == 0) break;
    if (problem.status != 200) {
      if (observe_) observe_("?", problem.status, 0.0);
      const Reply reply = problem_reply(problem);
      co_await write(reply, false, false);
      co_await linger();
      break;  // a request that came too slowly finds the line closed
    }
    auto request = parser.release();
    const bool head_only = request.method() == http::verb::head;
    Call call;
    call.method = head_only ? "GET" : std::string(request.method_string());
    call.body = std::move(request.body());
    call.peer = peer_;
    bool keep_alive = request.keep_alive();
    const auto asked = Clock::now();
    Reply reply;
    if (auto url = parse_target({request.target().data(), request.target().size()})) {
      call.path = std::move(url->path);
      call.query = std::move(url->query);
      call.headers = std::move(static_cast<http::fields&>(request));
      try {
        reply = co_await answer_(call);
      } catch (const std::exception& exception) {
        spdlog::error("{} {} failed: {}", call.method, call.path, exception.what());
        reply = problem_reply({500, "internal", "Docent failed at this request; the log says why.", ""});
      }
    } else {
      reply = problem_reply({400, "bad_target", "That URL is malformed.", ""});
      keep_alive = false;
    }
    if (observe_) observe_(call.method, reply.status, std::chrono::duration<double>(Clock::now() - asked).count());
    if (!co_await write(reply, keep_alive, head_only)) break;
    if (reply.takeover && !head_only) {
      std::string early(static_cast<const char*>(buffer_.data().data()), buffer_.size());
      co_await reply.takeover(stream_.release_socket(), std::move(early));
      co_return;
    }
    if (!keep_alive || reply.takeover) {
      co_await linger();
      break;
    }
  }
  stream_.close();
}

net::awaitable<bool> HttpConnection::write(const Reply& reply, bool keep_alive, bool head_only) {
  const std::string head = head_of(reply, keep_alive);
  const std::string_view body = reply.body && !head_only ? std::string_view(*reply.body) : std::string_view();
  // At least 64 kB/s for a big answer.
  stream_.expires_after(limits_.write + std::chrono::milliseconds(body.size() / 64));
  const std::array<net::const_buffer, 2> buffers{net::buffer(head), net::buffer(body)};
  error_code error;
  co_await net::async_write(stream_, buffers, quietly(error));
  co_return !error;
}

// Takes in what is still coming for a moment: closing at once would reset the line and destroy the answer.
net::awaitable<void> HttpConnection::linger() {
  error_code error;
  stream_.socket().shutdown(tcp::socket::shutdown_send, error);
  stream_.expires_after(std::chrono::seconds(1));
  std::array<char, 4096> sink;
  for (int i = 0; i < 64 && !error; ++i) co_await stream_.async_read_some(net::buffer(sink), quietly(error));
}

}  // namespace server
