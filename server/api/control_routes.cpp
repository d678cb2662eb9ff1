// What staff do: stop and go on, the mode, and where the robot is.
#include "protocols/web/decode.hpp"
#include "protocols/web/encode.hpp"
#include "protocols/web/names.hpp"
#include "server/api/parts.hpp"

namespace server {
namespace {

using protocols::web::Json;
using protocols::web::Problem;
using protocols::web::problem_of;

// Hands the event over and gives the status once the robot shows that it has heard.
net::awaitable<Reply> stop_or_resume(Web::Parts& web, Call& call, bool stop) {
  const std::string name = web.sessions.name(call.session);
  const std::string who = name.empty() ? "staff" : name;
  if (stop) {
    web.desk.tell(robot::Stop{who});
  } else {
    web.desk.tell(robot::Resume{who});
  }
  const auto deadline = Clock::now() + std::chrono::seconds(1);
  const auto heard = [&] { return (web.view->status().activity == robot::Activity::stopped) == stop; };
  do {
    co_await web.next_batch(deadline - Clock::now());
  } while (!heard() && Clock::now() < deadline);
  if (!heard() && !web.robot_alive()) co_return web.unavailable("robot_silent", "The robot did not answer in time.");
  co_return json_reply(web.view->status_json());
}

}  // namespace

void add_control_routes(Router& router, Web::Parts& web) {
  const std::string api = "/api/v1/";
  router.add("POST", api + "stop", for_staff([&web](Call& call) { return stop_or_resume(web, call, true); }));
  router.add("POST", api + "resume", for_staff([&web](Call& call) { return stop_or_resume(web, call, false); }));
  router.add("GET", api + "settings", at_once([&web](Call&) {
               return json_reply({{"mode", protocols::web::name_of(web.view->status().mode)}});
             }));
  router.add("PATCH", api + "settings", for_staff(at_once([&web](Call& call) {
               auto decoded = protocols::web::decode_settings(call.body);
               if (const auto* problem = std::get_if<Problem>(&decoded)) return problem_reply(*problem);
               const auto mode = std::get<robot::Mode>(decoded);
               web.desk.tell(robot::SetMode{mode});
               return json_reply({{"mode", protocols::web::name_of(mode)}});
             })));
  router.add("PUT", api + "pose", for_staff(at_once([&web](Call& call) {
               auto decoded = protocols::web::decode_pose(call.body);
               if (const auto* problem = std::get_if<Problem>(&decoded)) return problem_reply(*problem);
               const auto& pose = std::get<protocols::web::PoseBody>(decoded).pose;
               if (!pose) {
                 web.desk.tell(robot::LocalizeGlobally{});
                 return json_reply({{"global", true}});
               }
               if (!web.museum.map.contains(pose->position())) {
                 return problem_reply(problem_of(robot::Refusal::off_the_map));
               }
               web.desk.tell(robot::SetPose{*pose});
               return json_reply(protocols::web::encode(*pose));
             })));
}

}  // namespace server
