#include "server/devices/p2os_link.hpp"

#include <spdlog/spdlog.h>

#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>

#include "protocols/serial/p2os_base.hpp"
#include "server/devices/serial_line.hpp"

namespace devices {
namespace asio = boost::asio;
namespace p2os = serial::p2os;
using asio::awaitable;
using p2os::Command;
using serial::Bytes;
using serial::ByteSpan;

namespace {

constexpr auto sync_patience = 250ms;
constexpr auto frame_gap = 100ms;    // a pause this long inside a packet ends it
constexpr double fastest = 3.0;      // m/s, of any such base
constexpr auto pulse_every = 400ms;  // the base's watchdog waits for 2 s

// HOSTBAUD's argument; nothing for rates that it does not know.
std::optional<int> rate_code(int baud) {
  constexpr int rates[] = {9600, 19200, 38400, 57600, 115200};
  const auto* found = std::find(std::begin(rates), std::end(rates), baud);
  return found == std::end(rates) ? std::nullopt : std::optional<int>(static_cast<int>(found - rates));
}

int rounded(double value) { return static_cast<int>(std::lround(value)); }
bool is_sip(ByteSpan body) { return body[0] >= 0x31 && body[0] <= p2os::packet::sip_moving; }

}  // namespace

class P2osLink::Session : public std::enable_shared_from_this<Session> {
 public:
  Session(asio::any_io_executor executor, P2osLinkConfig config, Clock clock, EventSink sink)
      : config_(std::move(config)),
        clock_(std::move(clock)),
        sink_(std::move(sink)),
        line_(executor),
        executor_(executor) {}

  void start() {
    asio::co_spawn(
        executor_, [self = shared_from_this()] { return self->run(); }, asio::detached);
  }

  void stop() {
    if (stopping_) return;
    stopping_ = true;
    if (!statistics_.connected) return line_.close();
    halt();
    line_.close_with(p2os::encode(Command::close));
  }

  void drive(const robot::WheelCommand& command) {
    if (!statistics_.connected || stopping_) return;
    robot::Twist twist = command.twist;
    if (!std::isfinite(twist.linear) || !std::isfinite(twist.angular)) twist = {};
    twist.linear = std::clamp(twist.linear, -config_.limits.max_reverse, config_.limits.max_linear);
    twist.angular = std::clamp(twist.angular, -config_.limits.max_angular, config_.limits.max_angular);
    last_command_ = std::chrono::steady_clock::now();
    rolling_ = twist != robot::Twist{};
    send(velocities_.encode(twist));
    const bool at_once =
        command.reason == robot::GateReason::bumper || command.reason == robot::GateReason::emergency_stop;
    if (!rolling_ && at_once) send(p2os::encode(Command::e_stop));
  }

  void enable(const robot::EnableMotors& motors) {
    if (statistics_.connected && !stopping_) send(p2os::encode(Command::enable, motors.on ? 1 : 0));
  }

  LineStatistics statistics() const {
    LineStatistics out = statistics_;
    out.frames += decoder_.counts().frames;
    out.bad_checksums += decoder_.counts().bad_checksums;
    out.skipped_bytes += decoder_.counts().skipped_bytes;
    return out;
  }

 private:
  using Trouble = std::string;  // empty: all is well; otherwise why not, in words for staff

  awaitable<void> run() {
    while (!stopping_) {
      const Trouble trouble = co_await connect_and_listen();
      line_.close();
      if (stopping_) co_return;
      report_lost(trouble);
      co_await line_.sleep(backoff_.next());
    }
  }

  awaitable<Trouble> connect_and_listen() {
    statistics_ = statistics();
    decoder_ = p2os::PacketDecoder();
    rolling_ = false;
    velocities_.reset();
    Trouble trouble = line_.open(config_.path, 9600);
    if (trouble.empty()) trouble = co_await shake_hands();
    if (trouble.empty()) trouble = co_await open_connection();
    if (trouble.empty()) trouble = co_await listen();
    co_return trouble;
  }

  // SYNC0, SYNC1, SYNC2 at every rate that a base may have been left at.
  awaitable<Trouble> shake_hands() {
    for (const int rate : rates_to_try({statistics_.baud, 9600, config_.baud, 38400, 19200, 115200, 57600})) {
      if (!line_.set_baud(rate).empty()) continue;
      for (int attempt = 0; attempt < 4 && !stopping_; ++attempt) {
        const Handshake outcome = co_await sync();
        if (outcome == Handshake::broken) co_return line_.error();
        if (outcome == Handshake::done) co_return Trouble();
        if (outcome == Handshake::silent && attempt > 0 && line_.baud() == rate) break;
        // It was still open from before and has been closed: most bases then fall back to 9600.
        line_.set_baud(outcome == Handshake::out_of_step && line_.baud() == rate ? 9600 : rate);
      }
    }
    co_return "no answer from the base on " + config_.path + " at any rate";
  }

  enum class Handshake { done, silent, out_of_step, broken };

  awaitable<Handshake> sync() {
    for (const Command step : {Command::sync0, Command::sync1, Command::sync2}) {
      if (!line_.write(p2os::encode(step))) co_return Handshake::broken;
      const Packet answer = co_await next_packet(sync_patience);
      if (answer.state == SerialLine::ReadState::broken) co_return Handshake::broken;
      if (answer.state == SerialLine::ReadState::timed_out) co_return Handshake::silent;
      if (answer.body[0] != static_cast<std::uint8_t>(step)) {
        // Still open from before, or out of step: close and empty the line.
        line_.write(p2os::encode(Command::close));
        co_await line_.sleep(100ms);
        co_await drain();
        co_return Handshake::out_of_step;
      }
      if (step == Command::sync2) {
        const auto identity = p2os::parse_identity(answer.body);
        if (!identity) co_return Handshake::out_of_step;
        statistics_.identity = identity->name + " " + identity->class_name + " " + identity->subclass;
        model_ = &p2os::model_of(identity->subclass);
        tracker_.reconnected(*model_);
      }
    }
    co_return Handshake::done;
  }

  awaitable<Trouble> open_connection() {
    send(p2os::encode(Command::open));
    halt();
    send(p2os::encode(Command::config, 1));
    p2os::ConfigPacket config;
    const auto deadline = std::chrono::steady_clock::now() + 500ms;
    while (std::chrono::steady_clock::now() < deadline) {
      const Packet packet = co_await next_packet(deadline - std::chrono::steady_clock::now());
      if (packet.state == SerialLine::ReadState::broken) co_return line_.error();
      if (packet.state == SerialLine::ReadState::timed_out) break;  // older firmware has no such packet
      if (const auto parsed = p2os::parse_config(packet.body)) {
        config = *parsed;
        break;
      }
    }
    sip_period_ = config.sip_cycle_ms > 0 ? std::chrono::milliseconds(config.sip_cycle_ms) : 100ms;
    co_await raise_rate(config);
    set_limits();
    send(p2os::encode(Command::sonar, 1));
    co_return line_.error();
  }

  // At 9600 baud the packets take longer than their cycle.
  awaitable<void> raise_rate(const p2os::ConfigPacket& config) {
    const int old = line_.baud();
    const auto code = rate_code(config_.baud);
    if (config.reset_baud == 2 && code && config_.baud > old) {
      send(p2os::encode(Command::hostbaud, *code));
      co_await line_.sleep(50ms);  // so that the command leaves at the old rate
      line_.discard_input();
      line_.set_baud(config_.baud);
      send(p2os::encode(Command::pulse));
      const Packet packet = co_await next_packet(std::max<Duration>(300ms, 4 * sip_period_));
      if (packet.state != SerialLine::ReadState::bytes) line_.set_baud(old);
    }
    statistics_.baud = line_.baud();
  }

  // The base's own limits: firmware ramps no softer and no harder than the body is known to.
  void set_limits() {
    const robot::DriveLimits& limits = config_.limits;
    const int turning = rounded(robot::degrees(limits.max_angular_acceleration));
    send(p2os::encode(Command::setv, rounded(1000.0 * std::max(limits.max_linear, limits.max_reverse))));
    send(p2os::encode(Command::seta, rounded(1000.0 * limits.max_acceleration)));
    send(p2os::encode(Command::seta, -rounded(1000.0 * limits.max_deceleration)));
    send(p2os::encode(Command::setrv, static_cast<int>(std::ceil(robot::degrees(limits.max_angular)))));
    send(p2os::encode(Command::setra, turning));
    send(p2os::encode(Command::setra, -turning));
  }

  awaitable<Trouble> listen() {
    const auto patience = silence_limit(sip_period_);
    auto last_sip = std::chrono::steady_clock::now();
    implausible_ = 0;
    noise_ = {};
    for (;;) {
      const auto waited = std::chrono::steady_clock::now() - last_sip;
      if (waited > patience) {
        const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(patience).count();
        co_return fmt::format("the base said nothing for {} ms", ms);
      }
      const Packet packet = co_await next_packet(std::min<Duration>(patience - waited + 1ms, 50ms));
      if (stopping_ || packet.state == SerialLine::ReadState::broken) co_return line_.error();
      if (packet.state == SerialLine::ReadState::bytes && is_sip(packet.body) && take_sip(packet.body)) {
        last_sip = std::chrono::steady_clock::now();
      }
      if (stopping_) co_return Trouble();
      const auto& counts = decoder_.counts();
      if (noise_.too_noisy(counts.frames, counts.bad_checksums, std::chrono::steady_clock::now())) {
        co_return "the line is too noisy: many damaged packets";
      }
      keep_alive();
      if (!line_.error().empty()) co_return line_.error();
    }
  }

  bool take_sip(ByteSpan body) {
    const auto sip = p2os::parse_sip(body);
    if (!sip || !plausible(*sip)) return false;
    const robot::Time time = clock_() - robot::Seconds(transmission_time(body.size() + 5, line_.baud()));
    report_connected();
    robot::Odometry odometry = tracker_.update(*sip);
    odometry.time = time;
    robot::BaseState state = p2os::base_state(*sip);
    state.time = time;
    robot::SonarScan sonars = p2os::sonar_scan(*sip, *model_);
    sonars.time = time;
    emit(state);
    emit(odometry);
    if (!sonars.readings.empty()) emit(std::move(sonars));
    return true;
  }

  // The checksum is a mere sum. What no base can do was damaged on the way, unless the base insists: then it has begun
  // its odometry anew.
  bool plausible(const p2os::Sip& sip) {
    const Instant now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - last_plausible_).count();
    if (implausible_ >= 3) tracker_.reconnected(*model_);
    const bool good = p2os::fastest_wheel(sip, *model_) < fastest && tracker_.step(sip) < fastest * seconds + 0.1;
    implausible_ = good ? 0 : implausible_ + 1;
    if (good) last_plausible_ = now;
    return good;
  }

  void emit(robot::Event event) {
    if (!stopping_) sink_(std::move(event));
  }

  void keep_alive() {
    const auto now = std::chrono::steady_clock::now();
    if (rolling_ && now - last_command_ > config_.command_lifetime) {
      spdlog::warn("{}: no wheel command for too long, stopping", config_.path);
      halt();
    }
    if (now - last_sent_ > pulse_every) send(p2os::encode(Command::pulse));
  }

  void halt() {
    rolling_ = false;
    velocities_.reset();
    send(velocities_.encode({}));
  }

  void send(const Bytes& bytes) {
    last_sent_ = std::chrono::steady_clock::now();
    line_.write(bytes);
  }

  struct Packet {
    SerialLine::ReadState state = SerialLine::ReadState::timed_out;
    ByteSpan body;  // valid until the next packet
  };

  awaitable<Packet> next_packet(Duration patience) {
    const auto deadline = std::chrono::steady_clock::now() + patience;
    for (;;) {
      if (const auto body = decoder_.next()) co_return Packet{SerialLine::ReadState::bytes, *body};
      const auto left = deadline - std::chrono::steady_clock::now();
      if (left <= Duration::zero()) co_return Packet{SerialLine::ReadState::timed_out, {}};
      const auto read = co_await line_.read(std::min<Duration>(left, frame_gap));
      if (read.state == SerialLine::ReadState::broken) co_return Packet{read.state, {}};
      if (read.state == SerialLine::ReadState::bytes) last_bytes_ = std::chrono::steady_clock::now();
      if (std::chrono::steady_clock::now() - last_bytes_ > frame_gap) decoder_.line_fell_silent();
      decoder_.feed(read.bytes);
    }
  }

  awaitable<void> drain() {
    line_.discard_input();
    decoder_.line_fell_silent();
    while (decoder_.next()) {
    }
    co_return;
  }

  void report_connected() {
    backoff_.reset();
    last_trouble_.reset();
    if (std::exchange(statistics_.connected, true) || stopping_) return;
    ++statistics_.connections;
    spdlog::info("{}: {} at {} baud", config_.path, statistics_.identity, line_.baud());
    sink_(robot::DeviceState{robot::Device::base, true, {}});
  }

  void report_lost(const Trouble& trouble) {
    const bool was_connected = std::exchange(statistics_.connected, false);
    if (!was_connected && last_trouble_ == trouble) return;
    last_trouble_ = trouble;
    spdlog::warn("{}: {}", config_.path, trouble);
    sink_(robot::DeviceState{robot::Device::base, false, trouble});
  }

  P2osLinkConfig config_;
  Clock clock_;
  EventSink sink_;
  SerialLine line_;
  asio::any_io_executor executor_;
  bool stopping_ = false;
  p2os::PacketDecoder decoder_;
  const p2os::Model* model_ = &p2os::model_of("p3dx-sh");
  p2os::OdometryTracker tracker_{*model_};
  p2os::VelocityEncoder velocities_;
  Duration sip_period_ = 100ms;
  bool rolling_ = false;  // the last set-points were not zero
  Instant last_command_, last_sent_, last_bytes_, last_plausible_;
  int implausible_ = 0;  // packets in a row
  NoiseGauge noise_;
  Backoff backoff_;
  std::optional<Trouble> last_trouble_;
  LineStatistics statistics_;
};

P2osLink::P2osLink(asio::any_io_executor executor, P2osLinkConfig config, Clock clock, EventSink sink)
    : session_(std::make_shared<Session>(executor, std::move(config), std::move(clock), std::move(sink))) {}
P2osLink::~P2osLink() {
  if (session_) session_->stop();
}
void P2osLink::start() { session_->start(); }
void P2osLink::stop() { session_->stop(); }
void P2osLink::drive(const robot::WheelCommand& command) { session_->drive(command); }
void P2osLink::enable(const robot::EnableMotors& motors) { session_->enable(motors); }
LineStatistics P2osLink::statistics() const { return session_->statistics(); }

}  // namespace devices
