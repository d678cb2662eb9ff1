#include "server/devices/simulated_line.hpp"

#include <unistd.h>

#include <array>
#include <optional>
#include <random>
#include <utility>

#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/steady_timer.hpp>

#include "server/devices/pty.hpp"

namespace devices {
namespace asio = boost::asio;
using boost::system::error_code;
using serial::Bytes;
using serial::ByteSpan;

namespace {

constexpr int deaf_client = 2048;  // bytes unread: nobody listens, and a device does not wait

// What a receiver at the wrong rate makes of it: other bytes, as many.
Bytes garbled(const Bytes& bytes) {
  Bytes out(bytes);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = static_cast<std::uint8_t>((out[i] >> 1) ^ (0xE0 + 37 * i));
  return out;
}

}  // namespace

struct SimulatedLine::State : std::enable_shared_from_this<State> {
  State(const asio::any_io_executor& executor, std::shared_ptr<SimulatedDevice> simulated)
      : device(std::move(simulated)), timer(executor), reader(executor) {}

  void plug() {
    pty.emplace();
    ++plugged;
    reader.assign(::dup(pty->master()));
    wait_for_bytes();
  }

  void unplug() {
    error_code ignored;
    reader.close(ignored);
    pty.reset();
  }

  void wait_for_bytes() {
    reader.async_read_some(asio::buffer(input),
                           [self = shared_from_this(), line = plugged](error_code error, std::size_t count) {
                             if (error || !self->pty || line != self->plugged) return;
                             self->received(ByteSpan(self->input).first(count));
                             if (self->pty && line == self->plugged) self->wait_for_bytes();
                           });
  }

  void received(ByteSpan bytes) {
    const Instant now = std::chrono::steady_clock::now();
    if (tap.received) tap.received(bytes, now);
    const int rate = device->baud();
    if (pty->baud() == rate) device->receive(damaged(Bytes(bytes.begin(), bytes.end())), now);
    send(rate, now);
    wait_until_due();
  }

  void wait_until_due() {
    const Instant due = device->due();
    if (due == timer.expiry() && waiting) return;
    waiting = due != Instant::max();
    timer.expires_at(due);
    if (!waiting) return;
    timer.async_wait([self = shared_from_this()](error_code error) {
      if (error || self->over) return;
      self->waiting = false;
      const Instant now = std::chrono::steady_clock::now();
      const int rate = self->device->baud();
      self->device->advance(now);
      self->send(rate, now);
      self->wait_until_due();
    });
  }

  // What the device said while it ran at `rate`.
  void send(int rate, Instant now) {
    const Bytes bytes = device->take_output();
    if (bytes.empty() || !pty || pty->unread() > deaf_client) return;
    if (tap.sent) tap.sent(bytes, now);
    pty->write(damaged(pty->baud() == rate ? bytes : garbled(bytes)));
  }

  Bytes damaged(Bytes bytes) {
    if (damage == Damage::none || bytes.empty() || dice() >= share * static_cast<double>(dice.max())) return bytes;
    const std::size_t at = dice() % bytes.size();
    if (damage == Damage::cut) bytes.resize(at);
    if (damage == Damage::flip) bytes[at] = static_cast<std::uint8_t>(bytes[at] ^ (1u << dice() % 8));
    if (damage == Damage::random) {
      for (std::size_t i = 0; i < 1 + at % 40; ++i) bytes.push_back(static_cast<std::uint8_t>(dice()));
    }
    return bytes;
  }

  std::shared_ptr<SimulatedDevice> device;
  std::optional<Pty> pty;
  asio::steady_timer timer;
  asio::posix::stream_descriptor reader;
  std::array<std::uint8_t, 1024> input;
  bool waiting = false;
  bool over = false;          // the line's owner is gone
  std::uint64_t plugged = 0;  // times; what an older terminal still says is not heard
  Tap tap;
  Damage damage = Damage::none;
  double share = 0.0;
  std::minstd_rand dice{1};
};

SimulatedLine::SimulatedLine(asio::any_io_executor executor, std::shared_ptr<SimulatedDevice> device,
                             std::filesystem::path name)
    : name_(std::move(name)), state_(std::make_shared<State>(executor, std::move(device))) {
  plug();
  state_->wait_until_due();
}

SimulatedLine::~SimulatedLine() {
  unplug();
  state_->over = true;
  state_->timer.cancel();
}

void SimulatedLine::unplug() {
  std::error_code ignored;
  std::filesystem::remove(name_, ignored);
  if (state_->pty) state_->unplug();
}

void SimulatedLine::plug() {
  if (state_->pty) return;
  state_->plug();
  // Renamed into place, so that nobody sees a name without a terminal.
  std::filesystem::path fresh = name_;
  fresh += ".new";
  std::error_code ignored;
  std::filesystem::remove(fresh, ignored);
  std::filesystem::create_symlink(state_->pty->path(), fresh);
  std::filesystem::rename(fresh, name_);
}

void SimulatedLine::inject(ByteSpan bytes) {
  if (state_->pty) state_->pty->write(bytes);
}

void SimulatedLine::damage(Damage kind, double share) {
  state_->damage = kind;
  state_->share = share;
}

void SimulatedLine::tap(Tap tap) { state_->tap = std::move(tap); }

}  // namespace devices
