// A blocking HTTP client for tests, with a deadline for every step, and a raw line for clients that misbehave.
#pragma once

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http.hpp>
#include <chrono>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <string_view>

namespace testing_support {

namespace net = boost::asio;
namespace http = boost::beast::http;
using Json = nlohmann::ordered_json;

// Runs what has been started on `context` until `done`; throws when it takes too long.
inline void run_until(net::io_context& context, const bool& done, std::chrono::milliseconds patience,
                      const char* what) {
  context.restart();
  const auto deadline = std::chrono::steady_clock::now() + patience;
  while (!done && std::chrono::steady_clock::now() < deadline) context.run_one_until(deadline);
  if (!done) throw std::runtime_error(std::string("timeout: ") + what);
}

// A TCP line: sends any bytes, reads what comes.
class RawLine {
 public:
  explicit RawLine(unsigned short port) : socket_(context_) {
    socket_.connect({net::ip::make_address("127.0.0.1"), port});
  }

  // False when the other side has gone.
  bool send(std::string_view bytes) {
    boost::system::error_code error;
    net::write(socket_, net::buffer(bytes), error);
    return !error;
  }

  // Reads until the other side ends the line, `enough` has come, or the time is over.
  std::string read(std::chrono::milliseconds patience = std::chrono::seconds(20), std::string_view enough = {}) {
    closed_ = false;
    const auto deadline = std::chrono::steady_clock::now() + patience;
    std::string all = std::exchange(rest_, {});
    while (std::chrono::steady_clock::now() < deadline && !closed_) {
      if (!enough.empty() && all.find(enough) != std::string::npos) break;
      bool done = false;
      std::size_t size = 0;
      char buffer[4096];
      socket_.async_read_some(net::buffer(buffer), [&](boost::system::error_code error, std::size_t n) {
        done = true;
        size = n;
        closed_ = static_cast<bool>(error);
      });
      context_.restart();
      while (!done && std::chrono::steady_clock::now() < deadline) context_.run_one_until(deadline);
      if (!done) {
        boost::system::error_code ignored;
        socket_.cancel(ignored);
        context_.restart();
        context_.run();
        closed_ = false;
      }
      all.append(buffer, size);
    }
    return all;
  }
  // Whether the last read() ended because the other side closed the line.
  bool closed() const { return closed_; }

  void shrink_receive_buffer(int bytes) { socket_.set_option(net::socket_base::receive_buffer_size(bytes)); }

 private:
  net::io_context context_;
  net::ip::tcp::socket socket_;
  std::string rest_;
  bool closed_ = false;
};

struct Response {
  int status = 0;
  std::map<std::string, std::string, std::less<>> headers;  // names in lower case; the last of each name
  std::string body;
  Json json() const { return Json::parse(body); }
  std::string header(const std::string& name) const {
    const auto it = headers.find(name);
    return it == headers.end() ? "" : it->second;
  }
};

// Keeps cookies, as a browser does; each request has its own connection unless `keep` is called.
class HttpClient {
 public:
  using Headers = std::vector<std::pair<std::string, std::string>>;

  explicit HttpClient(unsigned short port, std::string host = "127.0.0.1") : port_(port), host_(std::move(host)) {}

  Response get(const std::string& target, const Headers& headers = {}) { return request("GET", target, "", headers); }
  Response post(const std::string& target, const Json& body, const Headers& headers = {}) {
    return request("POST", target, body.dump(), headers);
  }
  Response request(const std::string& method, const std::string& target, const std::string& body = "",
                   const Headers& headers = {}) {
    http::request<http::string_body> request;
    request.method_string(method);
    request.target(target);
    request.set(http::field::host, host_ + ":" + std::to_string(port_));
    if (!cookie_.empty()) request.set(http::field::cookie, cookie_);
    if (!body.empty()) request.set(http::field::content_type, "application/json");
    for (const auto& [name, value] : headers) request.set(name, value);
    request.body() = body;
    request.prepare_payload();
    return exchange(request);
  }

  const std::string& cookie() const { return cookie_; }
  void forget_cookie() { cookie_.clear(); }
  unsigned short port() const { return port_; }

 private:
  Response exchange(const http::request<http::string_body>& request) {
    net::io_context context;
    net::ip::tcp::socket socket(context);
    socket.connect({net::ip::make_address("127.0.0.1"), port_});
    boost::beast::flat_buffer buffer;
    http::response_parser<http::string_body> parser;
    parser.body_limit(64u << 20);
    if (request.method() == http::verb::head) parser.skip(true);
    bool done = false;
    boost::system::error_code failed;
    http::async_write(socket, request, [&](boost::system::error_code error, std::size_t) {
      failed = error;
      done = static_cast<bool>(error);
      if (error) return;
      http::async_read(socket, buffer, parser, [&](boost::system::error_code read_error, std::size_t) {
        failed = read_error;
        done = true;
      });
    });
    run_until(context, done, std::chrono::seconds(20), "HTTP exchange");
    if (failed) throw boost::system::system_error(failed, "HTTP exchange");
    Response response{static_cast<int>(parser.get().result_int()), {}, parser.get().body()};
    for (const auto& field : parser.get()) {
      std::string name(field.name_string());
      for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      response.headers[name] = std::string(field.value());
      if (name == "set-cookie") cookie_ = std::string(field.value()).substr(0, field.value().find(';'));
    }
    return response;
  }

  unsigned short port_;
  std::string host_;
  std::string cookie_;
};

}  // namespace testing_support
