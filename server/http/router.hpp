// Which handler answers which method and path, and the answers that follow from the table alone: 404, 405 with Allow,
// 406, 415, OPTIONS.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/http/message.hpp"

namespace server {

class Router {
 public:
  // `pattern` is a path whose segments may be "{name}": any one segment, handed over in Call::parameters in order.
  // `produces`: the content type of its answers. Of routes that differ in this alone the one that the Accept header
  // names first answers, or the one added first; 406 when it names none.
  void add(std::string method, const std::string& pattern, Handler handler, std::string produces = "application/json");

  // Whether any route has this path.
  bool knows(const std::string& path) const;
  net::awaitable<Reply> route(Call& call) const;

  struct Route {
    std::string method;
    std::vector<std::string> segments;
    Handler handler;
    std::string produces;
  };

 private:
  std::vector<Route> routes_;
};

// Where in an Accept header (empty: anything) the first range stands that takes a content type; none: it is refused.
std::optional<std::size_t> accepted_at(std::string_view accept, std::string_view content_type);

}  // namespace server
