#include "server/stream/cameras.hpp"

#include "protocols/web/frames.hpp"

namespace server {
namespace {

constexpr auto glance_lasts = std::chrono::seconds(10);

std::shared_ptr<const std::string> multipart(const std::string& jpeg) {
  std::string part = std::string("--") + multipart_boundary +
                     "\r\nContent-Type: image/jpeg\r\nContent-Length: " + std::to_string(jpeg.size()) + "\r\n\r\n";
  part.reserve(part.size() + jpeg.size() + 2);
  return std::make_shared<const std::string>(part.append(jpeg).append("\r\n"));
}

}  // namespace

Cameras::Cameras(net::any_io_executor executor, std::vector<CameraInfo> infos, Hub& hub)
    : infos_(std::move(infos)), states_(infos_.size()), hub_(hub) {
  for (State& state : states_) {
    state.arrival = std::make_unique<net::steady_timer>(executor, Clock::time_point::max());
  }
}

std::size_t Cameras::find(const std::string& id) const {
  std::size_t i = 0;
  while (i < infos_.size() && infos_[i].id != id) ++i;
  return i;
}

void Cameras::put(std::size_t camera, std::shared_ptr<const std::string> jpeg, robot::Time time) {
  State& state = states_.at(camera);
  if (state.watchers > 0) state.picture.part = multipart(*jpeg);
  if (hub_.wanted(camera_topic(camera))) {
    hub_.state_binary(camera_topic(camera), protocols::web::encode_camera_head(static_cast<std::uint8_t>(camera), time),
                      *jpeg);
  }
  state.picture.jpeg = std::move(jpeg);
  ++state.picture.number;
  state.picture.came = Clock::now();
  state.arrival->cancel();
}

void Cameras::look(std::size_t camera) {
  State& state = states_.at(camera);
  if (++state.watchers == 1) state.picture.part = state.picture.jpeg ? multipart(*state.picture.jpeg) : nullptr;
  update_wanted();
}

void Cameras::look_away(std::size_t camera) { --states_.at(camera).watchers; }

void Cameras::glance(std::size_t camera) {
  states_.at(camera).glanced = Clock::now();
  update_wanted();
}

net::awaitable<Picture> Cameras::next(std::size_t camera, std::uint64_t seen, Clock::duration patience) {
  State& state = states_.at(camera);
  const auto deadline = Clock::now() + patience;
  net::steady_timer own(co_await net::this_coro::executor);
  while (state.picture.number <= seen && Clock::now() < deadline) {
    using namespace net::experimental::awaitable_operators;
    own.expires_at(deadline);
    co_await (state.arrival->async_wait(net::as_tuple(net::use_awaitable)) ||
              own.async_wait(net::as_tuple(net::use_awaitable)));
  }
  co_return state.picture;
}

void Cameras::update_wanted() {
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < states_.size(); ++i) {
    const bool glanced = states_[i].glanced != Clock::time_point{} && Clock::now() - states_[i].glanced < glance_lasts;
    if (states_[i].watchers > 0 || glanced || hub_.wanted(camera_topic(i))) bits |= std::uint64_t{1} << i;
  }
  wanted_.store(bits, std::memory_order_relaxed);
}

}  // namespace server
