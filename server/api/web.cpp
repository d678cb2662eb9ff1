#include "server/api/web.hpp"

#include <spdlog/spdlog.h>

#include "server/api/parts.hpp"

namespace server {

Web::Web(net::io_context& context, robot::Museum museum, WebOptions options, Submit submit)
    : parts_(std::make_shared<Parts>(context, std::move(museum), std::move(options), std::move(submit))) {}

Web::~Web() {
  stop();
  parts_->view->save_travel();
  parts_->journal->finish();
}

robot::Remember Web::remember() const { return parts_->remembered; }

void Web::start() {
  // The server's coroutines keep the parts alive until the io_context lets go of them.
  parts_->http = std::make_shared<HttpServer>(
      parts_->context, parts_->options.limits.http, [parts = parts_](Call& call) { return parts->answer(call); },
      [parts = parts_](const std::string& method, int status, double seconds) {
        parts->metrics.observe_request(method, status, seconds);
      });
  parts_->http->listen(parts_->options.address, parts_->options.port);
  parts_->every_second();
  spdlog::info("web: listening on {}:{}", parts_->options.address, port());
}

unsigned short Web::port() const { return parts_->http->port(); }

void Web::take(const std::vector<robot::Output>& outputs, robot::Time now) {
  parts_->heard_robot = Clock::now();
  parts_->metrics.batches.Increment();
  parts_->view->take(outputs, now);
  for (const robot::Output& output : outputs) {
    if (const auto* answer = std::get_if<robot::Answer>(&output)) parts_->desk.take(*answer);
  }
  parts_->batch_arrival.cancel();
}

void Web::frame(const std::string& camera, std::shared_ptr<const std::string> jpeg, robot::Time time) {
  const std::size_t index = parts_->cameras.find(camera);
  if (index == parts_->cameras.infos().size() || !jpeg) return;
  parts_->metrics.pictures.Increment();
  parts_->cameras.put(index, std::move(jpeg), time);
}

void Web::devices(std::vector<DeviceHealth> devices) { parts_->devices = std::move(devices); }

bool Web::camera_wanted(const std::string& camera) const {
  const std::size_t index = parts_->cameras.find(camera);
  return index < parts_->cameras.infos().size() && parts_->cameras.wanted(index);
}

void Web::stop() {
  if (std::exchange(parts_->stopping, true)) return;
  parts_->second.cancel();
  parts_->hub.close_all(protocols::web::close_code::going_away, "the server goes down");
  if (parts_->http) std::exchange(parts_->http, nullptr)->stop();
}

}  // namespace server
