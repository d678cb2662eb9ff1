// A request as it was understood and the answer to it, without any socket.
#pragma once

#include <boost/asio/ip/address.hpp>
#include <boost/beast/http/fields.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "protocols/web/problem.hpp"
#include "server/stream/asio.hpp"

namespace server {

namespace http = boost::beast::http;

struct Call {
  std::string method;  // "GET"; HEAD is answered as GET without its body
  std::string path;    // percent-decoded, begins with '/'
  std::vector<std::pair<std::string, std::string>> query;
  http::fields headers;
  std::string body;
  net::ip::address peer;
  std::vector<std::string> parameters;  // what stood in the route's {}

  // Who asks; filled in by the one who knows sessions.
  std::string session;
  bool staff = false;

  std::string_view header(std::string_view name) const {
    const auto it = headers.find(boost::beast::string_view(name.data(), name.size()));
    return it == headers.end() ? std::string_view() : std::string_view(it->value().data(), it->value().size());
  }
  std::optional<std::string> query_value(std::string_view name) const {
    for (const auto& [key, value] : query) {
      if (key == name) return value;
    }
    return std::nullopt;
  }
};

struct Reply {
  // Takes over the socket once the head has been sent; what came in early with the request is in the second argument.
  using Takeover = std::function<net::awaitable<void>(tcp::socket, std::string)>;

  int status = 200;
  std::string content_type;  // empty: no body
  std::shared_ptr<const std::string> body;
  std::vector<std::pair<std::string, std::string>> headers;
  Takeover takeover;

  Reply& with(std::string name, std::string value) {
    headers.emplace_back(std::move(name), std::move(value));
    return *this;
  }
};

using Handler = std::function<net::awaitable<Reply>(Call&)>;

Reply json_reply(const protocols::web::Json& json, int status = 200);
Reply text_reply(std::string text, std::string content_type, int status = 200);
Reply problem_reply(const protocols::web::Problem& problem);

}  // namespace server
