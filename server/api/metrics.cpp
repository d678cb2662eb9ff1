#include "server/api/metrics.hpp"

#include <prometheus/text_serializer.h>

namespace server {
namespace {

prometheus::Gauge& gauge(prometheus::Registry& registry, const char* name, const char* help) {
  return prometheus::BuildGauge().Name(name).Help(help).Register(registry).Add({});
}

prometheus::Counter& counter(prometheus::Registry& registry, const char* name, const char* help) {
  return prometheus::BuildCounter().Name(name).Help(help).Register(registry).Add({});
}

// Methods are the client's words: only the known ones become labels.
std::string known(const std::string& method) {
  for (const char* name : {"GET", "POST", "PUT", "PATCH", "DELETE", "OPTIONS"}) {
    if (method == name) return method;
  }
  return "other";
}

}  // namespace

Metrics::Metrics()
    : requests_(prometheus::BuildCounter()
                    .Name("docent_http_requests_total")
                    .Help("HTTP requests answered")
                    .Register(registry_)),
      latency_(prometheus::BuildHistogram()
                   .Name("docent_http_request_seconds")
                   .Help("From the end of a request to the end of making its answer")
                   .Register(registry_)
                   .Add({}, prometheus::Histogram::BucketBoundaries{0.0005, 0.001, 0.0025, 0.005, 0.01, 0.025, 0.05,
                                                                    0.1, 0.25, 0.5, 1.0, 3.0})),
      viewers(gauge(registry_, "docent_viewers", "Open viewer lines (WebSocket and MJPEG)")),
      connections(gauge(registry_, "docent_connections", "Open TCP connections")),
      waiting_bytes(gauge(registry_, "docent_outbox_bytes", "Bytes waiting in all viewers' outboxes")),
      queue(gauge(registry_, "docent_queue_requests", "Requests waiting or active")),
      robot_age(gauge(registry_, "docent_robot_age_seconds", "Time since the robot's thread was last heard")),
      store_waiting(gauge(registry_, "docent_store_waiting", "Writes not yet on the disk")),
      store_healthy(gauge(registry_, "docent_store_healthy", "1 while the database takes writes")),
      batches(counter(registry_, "docent_robot_batches_total", "Batches of outputs taken from the robot")),
      frames(gauge(registry_, "docent_frames_encoded", "Messages encoded for viewers since the start")),
      deliveries(gauge(registry_, "docent_frames_delivered", "Messages handed to viewers since the start")),
      dropped(gauge(registry_, "docent_frames_dropped", "Messages that viewers were too slow for since the start")),
      pictures(counter(registry_, "docent_camera_pictures_total", "Camera pictures taken in")) {}

void Metrics::observe_request(const std::string& method, int status, double seconds) {
  requests_.Add({{"method", known(method)}, {"status", std::to_string(status)}}).Increment();
  latency_.Observe(seconds);
}

std::string Metrics::text() const { return prometheus::TextSerializer().Serialize(registry_.Collect()); }

}  // namespace server
