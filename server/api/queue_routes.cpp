// Where people send the robot: the queue of requests.
#include <charconv>

#include "protocols/web/decode.hpp"
#include "protocols/web/encode.hpp"
#include "server/api/parts.hpp"

namespace server {
namespace {

using protocols::web::encode_request;
using protocols::web::Json;
using protocols::web::Problem;
using protocols::web::problem_of;
using protocols::web::QueueBody;

std::optional<robot::RequestId> id_of(const std::string& text) {
  robot::RequestId id = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), id);
  if (error != std::errc() || stop != text.data() + text.size()) return std::nullopt;
  return id;
}

Reply unknown_request() { return problem_reply(problem_of(robot::Refusal::unknown_request)); }

// In memory, or long over and in the database.
net::awaitable<std::optional<robot::Request>> find(Web::Parts& web, const std::string& text) {
  const auto id = id_of(text);
  if (!id || *id > static_cast<robot::RequestId>(std::numeric_limits<std::int64_t>::max())) co_return std::nullopt;
  if (const robot::Request* request = web.view->request(*id)) co_return *request;
  const std::function<std::optional<StoredRequest>(Store&)> question = [id = *id](Store& store) {
    return store.find_request(id);
  };
  const auto stored = co_await web.journal->ask(question);
  if (!stored) co_return std::nullopt;
  robot::Request request = stored->request;
  request.asked = web.view->now() - robot::Seconds(wall_now() - stored->asked);
  co_return request;
}

Reply show(const Call& call, const robot::Request& request, int status = 200) {
  return json_reply(encode_request(request, !call.session.empty() && request.requester.session == call.session),
                    status);
}

net::awaitable<Reply> ask(Web::Parts& web, Call& call) {
  auto decoded = protocols::web::decode_queue(call.body);
  if (const auto* problem = std::get_if<Problem>(&decoded)) co_return problem_reply(*problem);
  const auto& body = std::get<QueueBody>(decoded);
  const auto made = std::make_shared<std::vector<robot::RequestId>>();
  const robot::RequestVisit visit{0, web.requester(call, body.name), body.target};
  const std::function<net::awaitable<Reply>()> make = [&web, &call, visit, made]() -> net::awaitable<Reply> {
    const auto answer = co_await web.desk.ask(visit, web.options.limits.answer, true);
    if (!answer)
      co_return web.unavailable("robot_silent", "The robot did not answer in time; the request was not accepted.");
    if (answer->refusal != robot::Refusal::none) co_return problem_reply(problem_of(answer->refusal));
    if (answer->requests.empty()) co_return problem_reply({500, "internal", "The robot accepted without an id.", ""});
    *made = answer->requests;
    const robot::RequestId id = answer->requests.front();
    const robot::Request* known = web.view->request(id);
    if (!known) co_return problem_reply({500, "internal", "The robot accepted without a request.", ""});
    Reply reply = show(call, *known, 201);
    co_return reply.with("Location", "/api/v1/queue/" + std::to_string(id));
  };
  const std::function<void()> undo = [&web, made] {
    for (const robot::RequestId id : *made) web.desk.tell(robot::CancelRequest{0, id, {}, true});
  };
  co_return co_await web.durable(call, make, undo);
}

net::awaitable<Reply> cancel(Web::Parts& web, Call& call) {
  const auto request = co_await find(web, call.parameters[0]);
  if (!request) co_return unknown_request();
  const robot::CancelRequest event{0, request->id, call.session, call.staff};
  const auto answer = co_await web.desk.ask(event, web.options.limits.answer);
  if (!answer) co_return web.unavailable("robot_silent", "The robot did not answer in time.");
  // A request of an earlier run that is over is unknown to the robot of this one.
  const bool over = answer->refusal == robot::Refusal::unknown_request;
  if (answer->refusal != robot::Refusal::none) {
    co_return problem_reply(problem_of(over ? robot::Refusal::already_over : answer->refusal));
  }
  if (!co_await web.journal->written())
    co_return web.unavailable("storage", "The change could not be stored; try again later.");
  const robot::Request* now = web.view->request(request->id);
  co_return show(call, now ? *now : *request);
}

}  // namespace

void add_queue_routes(Router& router, Web::Parts& web) {
  const std::string queue = "/api/v1/queue";
  router.add("GET", queue, at_once([&web](Call& call) { return json_reply(web.view->queue_json(call.session)); }));
  router.add("POST", queue, [&web](Call& call) { return ask(web, call); });
  router.add("GET", queue + "/{id}", [&web](Call& call) -> net::awaitable<Reply> {
    const auto request = co_await find(web, call.parameters[0]);
    co_return request ? show(call, *request) : unknown_request();
  });
  router.add("DELETE", queue + "/{id}", [&web](Call& call) { return cancel(web, call); });
}

}  // namespace server
