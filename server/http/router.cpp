#include "server/http/router.hpp"

#include <algorithm>
#include <optional>
#include <set>

namespace server {
namespace {

using protocols::web::Problem;

std::vector<std::string> split(const std::string& path) {
  std::vector<std::string> segments;
  for (std::size_t begin = 1; begin <= path.size();) {
    const std::size_t end = std::min(path.find('/', begin), path.size());
    segments.push_back(path.substr(begin, end - begin));
    begin = end + 1;
  }
  return segments;
}

bool is_parameter(const std::string& segment) { return !segment.empty() && segment.front() == '{'; }

bool matches(const Router::Route& route, const std::vector<std::string>& segments) {
  return std::equal(route.segments.begin(), route.segments.end(), segments.begin(), segments.end(),
                    [](const auto& pattern, const auto& segment) {
                      return is_parameter(pattern) ? !segment.empty() : pattern == segment;
                    });
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

bool is_json(std::string_view content_type) {
  std::string type(trimmed(content_type.substr(0, content_type.find(';'))));
  std::transform(type.begin(), type.end(), type.begin(), [](unsigned char c) { return std::tolower(c); });
  return type == "application/json";
}

}  // namespace

std::optional<std::size_t> accepted_at(std::string_view accept, std::string_view content_type) {
  if (trimmed(accept).empty()) return 0;
  const std::string_view family = content_type.substr(0, content_type.find('/'));
  for (std::size_t place = 0;; ++place) {
    const std::size_t end = accept.find(',');
    const std::string_view range = trimmed(accept.substr(0, end));
    const std::string_view type = trimmed(range.substr(0, range.find(';')));
    const std::size_t q = range.find("q=");
    const bool refused =
        q != std::string_view::npos && range.substr(q + 2).find_first_not_of("0.") == std::string_view::npos;
    const bool fits =
        type == "*/*" || type == content_type || (type.ends_with("/*") && type.substr(0, type.size() - 2) == family);
    if (fits && !refused) return place;
    if (end == std::string_view::npos) return std::nullopt;
    accept.remove_prefix(end + 1);
  }
}

void Router::add(std::string method, const std::string& pattern, Handler handler, std::string produces) {
  routes_.push_back({std::move(method), split(pattern), std::move(handler), std::move(produces)});
}

bool Router::knows(const std::string& path) const {
  const auto segments = split(path);
  return std::any_of(routes_.begin(), routes_.end(), [&](const Route& route) { return matches(route, segments); });
}

net::awaitable<Reply> Router::route(Call& call) const {
  const auto segments = split(call.path);
  // A path that stands there word for word goes before one with parameters.
  const Route* found = nullptr;
  std::size_t fewest = SIZE_MAX;
  for (const Route& route : routes_) {
    const auto open =
        static_cast<std::size_t>(std::count_if(route.segments.begin(), route.segments.end(), is_parameter));
    if (matches(route, segments)) fewest = std::min(fewest, open);
  }
  std::set<std::string> allowed;
  std::string produced;
  std::optional<std::size_t> place;
  for (const Route& route : routes_) {
    const auto open =
        static_cast<std::size_t>(std::count_if(route.segments.begin(), route.segments.end(), is_parameter));
    if (open != fewest || !matches(route, segments)) continue;
    allowed.insert(route.method);
    if (route.method == "GET") allowed.insert("HEAD");
    if (route.method != call.method) continue;
    produced += (produced.empty() ? "" : " or ") + route.produces;
    const auto accepted = accepted_at(call.header("Accept"), route.produces);
    if (!accepted || (place && *place <= *accepted)) continue;
    found = &route;
    place = accepted;
  }
  if (allowed.empty()) co_return problem_reply({404, "not_found", "There is nothing at this path.", ""});
  if (produced.empty()) {
    allowed.insert("OPTIONS");
    std::string allow;
    for (const auto& method : allowed) allow += (allow.empty() ? "" : ", ") + method;
    Reply reply;
    reply.status = 204;
    if (call.method != "OPTIONS") {
      reply = problem_reply({405, "method_not_allowed", "This path takes " + allow + ".", ""});
    }
    co_return reply.with("Allow", allow);
  }
  if (!found) co_return problem_reply({406, "not_acceptable", "This path gives " + produced + " only.", ""});
  if (!call.body.empty() && call.method != "DELETE" && !is_json(call.header("Content-Type"))) {
    co_return problem_reply({415, "unsupported_media_type", "Send the body as application/json.", ""});
  }
  for (std::size_t i = 0; i < segments.size(); ++i) {
    if (is_parameter(found->segments[i])) call.parameters.push_back(segments[i]);
  }
  co_return co_await found->handler(call);
}

}  // namespace server
