// Which handler answers which method and path, and the answers that follow from the table alone: 404, 405 with Allow,
// 406, 415, OPTIONS.
#pragma once

#include <string>
#include <vector>

#include "server/http/message.hpp"

namespace server {

class Router {
 public:
  // `pattern` is a path whose segments may be "{name}": any one segment, handed over in Call::parameters in order.
  // `produces`: the content type of its answers, for 406.
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
  const std::vector<Route>& routes() const { return routes_; }

 private:
  std::vector<Route> routes_;
};

// Whether an Accept header (empty: anything) takes a content type.
bool accepts(std::string_view accept, std::string_view content_type);

}  // namespace server
