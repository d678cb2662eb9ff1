// Tours: which one runs, starting and ending one, and the answer to "more, or move on?".
#include "protocols/web/decode.hpp"
#include "protocols/web/encode.hpp"
#include "server/api/parts.hpp"

namespace server {
namespace {

using protocols::web::Json;
using protocols::web::Problem;
using protocols::web::problem_of;

Json current_tour(const robot::Status& status) {
  return {{"tour", status.tour},
          {"stop", status.stop_number},
          {"stops", status.stop_count},
          {"exhibit", status.exhibit.empty() ? Json(nullptr) : Json(status.exhibit)},
          {"requester", status.requester.empty() ? Json(nullptr) : Json(status.requester)}};
}

Reply no_tour() { return problem_reply({404, "no_tour", "No tour is running.", ""}); }

net::awaitable<Reply> start(Web::Parts& web, Call& call) {
  auto decoded = protocols::web::decode_tour(call.body);
  if (const auto* problem = std::get_if<Problem>(&decoded)) co_return problem_reply(*problem);
  const auto& body = std::get<protocols::web::TourBody>(decoded);
  const auto made = std::make_shared<std::vector<robot::RequestId>>();
  const robot::StartTour event{0, web.requester(call, body.name), body.tour};
  const std::function<net::awaitable<Reply>()> make = [&web, event, made]() -> net::awaitable<Reply> {
    const auto answer = co_await web.desk.ask(event, web.options.limits.answer, true);
    if (!answer)
      co_return web.unavailable("robot_silent", "The robot did not answer in time; the tour was not accepted.");
    if (answer->refusal != robot::Refusal::none) co_return problem_reply(problem_of(answer->refusal));
    *made = answer->requests;
    const robot::Tour* tour = robot::find_tour(web.museum, event.tour);
    const std::size_t stops = tour ? tour->exhibits.size() : answer->requests.size();
    const Json first = tour && !tour->exhibits.empty() ? Json(tour->exhibits.front()) : Json(nullptr);
    const std::string& name = event.requester.name;
    Reply reply = json_reply({{"tour", event.tour},
                              {"stop", 0},
                              {"stops", stops},
                              {"exhibit", first},
                              {"requester", name.empty() ? Json(nullptr) : Json(name)},
                              {"requests", answer->requests}},
                             201);
    co_return reply.with("Location", "/api/v1/tours/current");
  };
  const std::function<void()> undo = [&web, made] {
    for (const robot::RequestId id : *made) web.desk.tell(robot::CancelRequest{0, id, {}, true});
  };
  co_return co_await web.durable(call, make, undo);
}

net::awaitable<Reply> tell(Web::Parts& web, Call& call, robot::TourAnswer choice) {
  if (!web.may_answer_tour(call)) co_return problem_reply(problem_of(robot::Refusal::not_yours));
  const robot::AnswerTour event{0, choice};
  const auto answer = co_await web.desk.ask(event, web.options.limits.answer);
  if (!answer) co_return web.unavailable("robot_silent", "The robot did not answer in time.");
  if (answer->refusal != robot::Refusal::none) co_return problem_reply(problem_of(answer->refusal));
  const char* word = choice == robot::TourAnswer::more      ? "more"
                     : choice == robot::TourAnswer::move_on ? "move_on"
                                                            : "end_tour";
  co_return json_reply({{"answer", word}});
}

}  // namespace

void add_tour_routes(Router& router, Web::Parts& web) {
  const std::string current = "/api/v1/tours/current";
  router.add("GET", current, at_once([&web](Call&) {
               const robot::Status& status = web.view->status();
               return status.tour.empty() ? no_tour() : json_reply(current_tour(status));
             }));
  router.add("POST", current, [&web](Call& call) { return start(web, call); });
  router.add("DELETE", current, [&web](Call& call) -> net::awaitable<Reply> {
    if (web.view->status().tour.empty()) co_return no_tour();
    co_return co_await tell(web, call, robot::TourAnswer::end_tour);
  });
  router.add("POST", current + "/answer", [&web](Call& call) -> net::awaitable<Reply> {
    auto decoded = protocols::web::decode_tour_answer(call.body);
    if (const auto* problem = std::get_if<Problem>(&decoded)) co_return problem_reply(*problem);
    co_return co_await tell(web, call, std::get<robot::TourAnswer>(decoded));
  });
}

}  // namespace server
