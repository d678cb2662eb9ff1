// How the robot and the server are doing.
#include "protocols/web/encode.hpp"
#include "server/api/parts.hpp"

namespace server {
namespace {

using protocols::web::Json;

std::string metrics_text(Web::Parts& web) {
  const HubStatistics hub = web.hub.statistics();
  Metrics& metrics = web.metrics;
  metrics.viewers.Set(static_cast<double>(web.hub.viewers()));
  metrics.connections.Set(web.http ? static_cast<double>(web.http->connections()) : 0.0);
  metrics.waiting_bytes.Set(static_cast<double>(hub.waiting_bytes));
  metrics.queue.Set(static_cast<double>(web.view->open_requests()));
  metrics.robot_age.Set(web.robot_age());
  metrics.store_waiting.Set(static_cast<double>(web.journal->waiting()));
  metrics.store_healthy.Set(web.journal->healthy() ? 1.0 : 0.0);
  metrics.frames.Set(static_cast<double>(hub.frames));
  metrics.deliveries.Set(static_cast<double>(hub.deliveries));
  metrics.dropped.Set(static_cast<double>(hub.dropped));
  return metrics.text();
}

}  // namespace

void add_report_routes(Router& router, Web::Parts& web) {
  const std::string api = "/api/v1/";
  router.add("GET", api + "status", at_once([&web](Call&) { return json_reply(web.view->status_json()); }));
  router.add("GET", api + "statistics",
             at_once([&web](Call&) { return json_reply(web.view->statistics_json(web.hub.viewers())); }));
  router.add("GET", api + "health", at_once([&web](Call&) { return json_reply(web.health()); }));
  router.add("GET", "/healthz", at_once([&web](Call&) {
               const bool alive = web.robot_alive();
               return json_reply(
                   {{"healthy", alive}, {"robot_age_seconds", protocols::web::number(web.robot_age(), 3)}},
                   alive ? 200 : 503);
             }));
  router.add("GET", "/readyz", at_once([&web](Call&) {
               const bool localized = web.view->pose() && web.view->pose()->localized;
               const bool ready = web.robot_alive() && web.journal->healthy() && localized;
               return json_reply({{"ready", ready},
                                  {"robot", web.robot_alive()},
                                  {"database", web.journal->healthy()},
                                  {"localized", localized}},
                                 ready ? 200 : 503);
             }));
  router.add("GET", "/metrics", at_once([&web](Call&) {
               return text_reply(metrics_text(web), "text/plain; version=0.0.4; charset=utf-8");
             }),
             "text/plain");
}

}  // namespace server
