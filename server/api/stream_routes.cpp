// The handshake of /ws (RFC 6455, 4.2) and a viewer's life.
#include <boost/beast/http/rfc7230.hpp>

#include "server/api/parts.hpp"

namespace server {
namespace {

using protocols::web::Json;

bool has_token(const Call& call, http::field field, const char* token) {
  const auto it = call.headers.find(field);
  return it != call.headers.end() && http::token_list(it->value()).exists(token);
}

// 16 bytes in base64.
bool is_key(std::string_view key) {
  return key.size() == 24 && key.ends_with("==") &&
         key.substr(0, 22).find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/") ==
             std::string_view::npos;
}

net::awaitable<void> watch(Web::Parts& web, std::string session, bool staff, tcp::socket socket, std::string early) {
  auto viewer = std::make_shared<Viewer>();
  viewer->socket =
      std::make_shared<WebSocket>(std::move(socket), web.hub.slots(), web.options.limits.web_socket, std::move(early));
  viewer->session = session;
  const std::string& name = web.sessions.name(session);
  web.hub.join(viewer, {{"type", "hello"},
                        {"epoch", ""},
                        {"seq", 0},
                        {"time", robot::to_seconds(web.view->now())},
                        {"site", web.museum.id},
                        {"session", {{"name", name.empty() ? Json(nullptr) : Json(name)}, {"staff", staff}}}});
  const std::shared_ptr<void> leave(nullptr, [&web, viewer](void*) {
    web.hub.leave(viewer);
    web.cameras.update_wanted();
  });
  const WebSocket::OnText on_text = [&web, &viewer](const std::string& text) {
    web.hub.receive(*viewer, text);
    web.cameras.update_wanted();
  };
  co_await viewer->socket->run(on_text);
}

Reply handshake(Web::Parts& web, Call& call) {
  if (!has_token(call, http::field::upgrade, "websocket") || !has_token(call, http::field::connection, "upgrade")) {
    Reply reply = problem_reply({426, "upgrade_required", "This path speaks WebSocket.", ""});
    return reply.with("Upgrade", "websocket");
  }
  if (call.header("Sec-WebSocket-Version") != "13") {
    Reply reply = problem_reply({426, "bad_version", "Speak WebSocket version 13.", "Sec-WebSocket-Version"});
    return reply.with("Sec-WebSocket-Version", "13").with("Upgrade", "websocket");
  }
  const std::string_view key = call.header("Sec-WebSocket-Key");
  if (!is_key(key))
    return problem_reply({400, "bad_key", "Sec-WebSocket-Key must be 16 bytes in base64.", "Sec-WebSocket-Key"});
  if (!is_same_origin(call)) {
    return problem_reply({403, "foreign_origin", "Only this server's own pages and programs may connect.", "Origin"});
  }
  Reply reply;
  reply.status = 101;
  reply.with("Upgrade", "websocket")
      .with("Connection", "Upgrade")
      .with("Sec-WebSocket-Accept", protocols::web::accept_key(key));
  reply.takeover = [&web, session = call.session, staff = call.staff](tcp::socket socket, std::string early) {
    return watch(web, session, staff, std::move(socket), std::move(early));
  };
  return reply;
}

}  // namespace

void add_stream_routes(Router& router, Web::Parts& web) {
  router.add("GET", "/ws", at_once([&web](Call& call) { return handshake(web, call); }));
}

}  // namespace server
