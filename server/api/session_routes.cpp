// Who you are: your name, and staff.
#include "protocols/web/decode.hpp"
#include "server/api/parts.hpp"

namespace server {
namespace {

using protocols::web::Json;
using protocols::web::Problem;

Json session_json(Web::Parts& web, const std::string& session, bool staff) {
  const std::string& name = web.sessions.name(session);
  return {{"name", name.empty() ? Json(nullptr) : Json(name)}, {"staff", staff}, {"languages", web.languages}};
}

net::awaitable<Reply> sign_in(Web::Parts& web, Call& call, const std::string& password) {
  const auto now = Clock::now();
  if (const int wait = web.sessions.admit_password(call.peer, now); wait > 0) {
    Reply reply = problem_reply({429, "too_many_requests", "Too many tries; wait " + std::to_string(wait) + " s.", ""});
    co_return reply.with("Retry-After", std::to_string(wait));
  }
  if (web.options.staff_password.empty()) {
    co_return problem_reply(
        {403, "no_password", "No staff password is configured: staff work on the robot's own machine.", ""});
  }
  // Argon2 takes its time on purpose: not on the web's thread.
  const std::function<bool(Store&)> check = [configured = web.options.staff_password, password](Store&) {
    return password_matches(configured, password);
  };
  const bool good = co_await web.journal->ask(check);
  if (!good) co_return problem_reply({401, "wrong_password", "That is not the staff password.", "password"});
  // A new cookie: whoever knew the old one does not become staff with it.
  const std::string cookie = new_cookie();
  const std::string session = *session_of(cookie);
  web.sessions.set_name(session, web.sessions.name(call.session));
  web.sessions.make_staff(session, now);
  Reply reply = json_reply(session_json(web, session, true));
  co_return reply.with("Set-Cookie", cookie_header(call, cookie));
}

}  // namespace

void add_session_routes(Router& router, Web::Parts& web) {
  const std::string path = "/api/v1/session";
  router.add("GET", path,
             at_once([&web](Call& call) { return json_reply(session_json(web, call.session, call.staff)); }));
  router.add("POST", path, [&web](Call& call) -> net::awaitable<Reply> {
    auto decoded = protocols::web::decode_session(call.body);
    if (const auto* problem = std::get_if<Problem>(&decoded)) co_return problem_reply(*problem);
    const auto& body = std::get<protocols::web::SessionBody>(decoded);
    if (body.password) co_return co_await sign_in(web, call, *body.password);
    web.name_for(call, body.name);
    co_return json_reply(session_json(web, call.session, call.staff));
  });
}

}  // namespace server
