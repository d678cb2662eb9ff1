// Counters and gauges in the form that Prometheus reads.
#pragma once

#include <prometheus/counter.h>
#include <prometheus/gauge.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>

#include <string>

namespace server {

class Metrics {
 public:
  Metrics();

  void observe_request(const std::string& method, int status, double seconds);
  // The text exposition format.
  std::string text() const;

 private:
  prometheus::Registry registry_;
  prometheus::Family<prometheus::Counter>& requests_;
  prometheus::Histogram& latency_;

 public:
  prometheus::Gauge& viewers;
  prometheus::Gauge& connections;
  prometheus::Gauge& waiting_bytes;  // in all outboxes
  prometheus::Gauge& queue;          // requests waiting or active
  prometheus::Gauge& robot_age;      // s since the robot's thread was heard
  prometheus::Gauge& store_waiting;  // writes not yet on the disk
  prometheus::Gauge& store_healthy;
  prometheus::Counter& batches;   // of the robot's outputs
  prometheus::Gauge& frames;      // messages encoded, ever
  prometheus::Gauge& deliveries;  // messages handed to viewers, ever
  prometheus::Gauge& dropped;     // messages that viewers were too slow for, ever
  prometheus::Counter& pictures;  // camera pictures taken in
};

}  // namespace server
