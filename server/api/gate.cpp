// What every call passes before and after its route: who asks, whether they may ask now, pages, and the security
// headers.
#include <algorithm>

#include "server/api/parts.hpp"

namespace server {
namespace {

using protocols::web::Problem;

constexpr const char* page_policy =
    "default-src 'self'; img-src 'self' blob: data:; connect-src 'self' ws: wss:; style-src 'self'; object-src 'none'; "
    "base-uri 'none'; form-action 'self'; frame-ancestors 'self'";
constexpr const char* data_policy = "default-src 'none'; frame-ancestors 'none'";
constexpr const char* picture_policy =
    "default-src 'none'; style-src 'unsafe-inline'; sandbox";  // an SVG may style itself

bool starts_session(const Call& call) {
  static constexpr std::string_view paths[] = {"/", "/kiosk", "/console", "/ws", "/api/v1/session"};
  return call.method != "GET" || std::find(std::begin(paths), std::end(paths), call.path) != std::end(paths);
}

// "example.org:8080" -> "example.org", "[::1]:8080" -> "[::1]".
std::string_view host_name(std::string_view host) {
  const std::size_t bracket = host.find(']');
  if (bracket != std::string_view::npos) return host.substr(0, bracket + 1);
  return host.substr(0, host.find(':'));
}

}  // namespace

// Whether an Origin header (browsers always send it with changes and WebSockets) names this very server.
bool is_same_origin(const Call& call) {
  const std::string_view origin = call.header("Origin");
  if (origin.empty()) return call.header("Sec-Fetch-Site") != "cross-site";
  const std::size_t host = origin.find("://");
  return host != std::string_view::npos && origin.substr(host + 3) == call.header("Host");
}

// On this machine and not by way of a proxy or of a foreign name that was bent to this address.
bool Web::Parts::is_local(const Call& call) const {
  if (!call.peer.is_loopback()) return false;
  for (const char* header : {"X-Forwarded-For", "X-Forwarded-Host", "X-Real-IP", "Forwarded", "Via"}) {
    if (!call.header(header).empty()) return false;
  }
  const std::string_view host = host_name(call.header("Host"));
  return host == "localhost" || host == "127.0.0.1" || host == "[::1]";
}

void Web::Parts::identify(Call& call, std::optional<std::string>& fresh_cookie) {
  if (const auto session = session_of(cookie_value(call.header("Cookie"), session_cookie))) {
    call.session = *session;
  } else if (starts_session(call)) {
    fresh_cookie = new_cookie();
    call.session = *session_of(*fresh_cookie);
  }
  call.staff = options.staff_password.empty() ? is_local(call) : sessions.is_staff(call.session, Clock::now());
}

Problem Web::Parts::refuse_change(const Call& call, int& retry_after) {
  if (call.method == "GET" || call.method == "OPTIONS") return {200, {}, {}, {}};
  if (!is_same_origin(call)) {
    return {403, "foreign_origin", "Changes may be asked for by this server's own pages and by programs only.",
            "Origin"};
  }
  // Without a cookie every request has a session of its own: such callers share their address's bucket.
  const bool has_cookie = session_of(cookie_value(call.header("Cookie"), session_cookie)).has_value();
  const std::string who = has_cookie ? call.session : "address:" + call.peer.to_string();
  retry_after = sessions.admit_change(who, call.peer, Clock::now());
  if (retry_after == 0) return {200, {}, {}, {}};
  return {429, "too_many_requests", "Too many changes; wait " + std::to_string(retry_after) + " s.", ""};
}

Reply Web::Parts::page(const Call& call) {
  if (call.method != "GET") {
    Reply reply = problem_reply({405, "method_not_allowed", "This path takes GET, HEAD.", ""});
    return reply.with("Allow", "GET, HEAD");
  }
  constexpr std::string_view pictures = "/site/";
  if (call.path.starts_with(pictures)) return site.answer(call.path.substr(pictures.size()), call);
  if (call.path == "/" || call.path == "/kiosk" || call.path == "/console") {
    const std::string name = call.path == "/" ? "index.html" : call.path.substr(1) + ".html";
    if (pages.has(name)) return pages.answer(name, call);
    return text_reply("Docent runs, but its pages have not been built. The API is below /api/v1.\n",
                      "text/plain; charset=utf-8", 404);
  }
  return pages.answer(call.path.substr(1), call);
}

void Web::Parts::secure(const Call& call, Reply& reply) const {
  if (reply.status == 101 || reply.status == 304) return;
  const bool is_page = reply.content_type.starts_with("text/html");
  const bool is_svg = reply.content_type == "image/svg+xml";
  reply.with("Content-Security-Policy", is_page ? page_policy : is_svg ? picture_policy : data_policy);
  if (call.path.starts_with("/api/")) reply.with("Vary", "Cookie");
}

net::awaitable<Reply> Web::Parts::answer(Call& call) {
  std::optional<std::string> fresh_cookie;
  identify(call, fresh_cookie);
  int retry_after = 0;
  Reply reply;
  if (Problem problem = refuse_change(call, retry_after); problem.status != 200) {
    reply = problem_reply(problem);
    if (retry_after > 0) reply.with("Retry-After", std::to_string(retry_after));
  } else if (router.knows(call.path) || call.path.starts_with("/api/")) {
    reply = co_await router.route(call);
  } else {
    reply = page(call);
  }
  secure(call, reply);
  const bool has_cookie = std::any_of(reply.headers.begin(), reply.headers.end(),
                                      [](const auto& header) { return header.first == "Set-Cookie"; });
  if (fresh_cookie && !has_cookie && reply.status < 400) reply.with("Set-Cookie", cookie_header(call, *fresh_cookie));
  co_return reply;
}

std::string cookie_header(const Call& call, const std::string& cookie) {
  std::string header = std::string(session_cookie) + "=" + cookie + "; Path=/; HttpOnly; SameSite=Lax; Max-Age=7776000";
  if (call.header("X-Forwarded-Proto") == "https") header += "; Secure";
  return header;
}

}  // namespace server
