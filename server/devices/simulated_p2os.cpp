#include "server/devices/simulated_p2os.hpp"

#include <algorithm>
#include <cmath>

namespace devices {
namespace p2os = serial::p2os;
using p2os::Command;
using serial::Bytes;
using serial::ByteSpan;

namespace {

constexpr Duration control_cycle = 10ms;
constexpr Instant never = Instant::max();
constexpr double ticks_per_mm = 128.0;
constexpr int rates[] = {9600, 19200, 38400, 57600, 115200};

double half_track(const p2os::Model& model) { return 0.001 / model.turn_per_speed_difference; }  // m

// Towards `wanted`, by what the ramp allows in dt: away from zero with `up`, towards it with `down`.
double ramp(double from, double wanted, double up, double down, double dt) {
  const bool slowing = std::abs(wanted) < std::abs(from) || from * wanted < 0.0;
  const double step = (slowing ? down : up) * dt;
  return from + std::clamp(wanted - from, -step, step);
}

// The speed from which `way` is just enough to stop.
double speed_to_stop_in(double way, double deceleration) {
  return std::copysign(std::sqrt(2.0 * deceleration * std::abs(way)), way);
}

}  // namespace

SimulatedP2os::SimulatedP2os(SimulatedP2osConfig config, Instant now)
    : options_(std::move(config)),
      model_(&p2os::model_of(options_.identity.subclass)),
      baud_(options_.baud),
      last_packet_(now),
      last_control_(now),
      sip_due_(never),
      sip_sent_(never) {}

void SimulatedP2os::say(const Bytes& packet) {
  if (!silent_) output_.insert(output_.end(), packet.begin(), packet.end());
}

void SimulatedP2os::receive(ByteSpan bytes, Instant now) {
  decoder_.feed(bytes);
  while (const auto body = decoder_.next()) {
    const auto command = p2os::parse_command(*body);
    if (!command) continue;
    last_packet_ = now;
    if (open_) {
      obey(*command, now);
    } else {
      shake_hands(*body, now);
    }
  }
  if (open_) control(now);
}

void SimulatedP2os::shake_hands(ByteSpan body, Instant now) {
  const int number = body[0];
  if (step_ == 3 && number == static_cast<int>(Command::open)) {
    open_ = true;
    step_ = 0;
    wanted_ = reference_ = {};
    odometry_zero_ = last_pose_ = options_.odometry().odom_from_base;
    left_way_ = right_way_ = 0.0;
    options_.enable_motors(false);
    last_control_ = now;
    sip_due_ = now + options_.sip_cycle;
    return;
  }
  if (step_ == 3 || number != step_) {
    const std::uint8_t error[] = {p2os::packet::sync_error};
    say(p2os::encode_packet(error));
    step_ = 0;
    return;
  }
  say(step_ == 2 ? p2os::encode_identity(options_.identity) : p2os::encode(static_cast<Command>(number)));
  ++step_;
}

void SimulatedP2os::close() {
  open_ = false;
  wanted_ = reference_ = {};
  move_from_.reset();
  heading_.reset();
  encoder_packets_ = 0;
  sip_due_ = sip_sent_ = never;
  baud_ = options_.baud;
  options_.drive({});
  options_.enable_motors(false);
}

void SimulatedP2os::obey(const p2os::ParsedCommand& command, Instant) {
  if (command.is(Command::close) || command.is(Command::reset)) return close();
  if (obey_motion(command) || obey_settings(command)) return;
  const int argument = command.argument.value_or(0);
  switch (static_cast<Command>(command.number)) {
    case Command::enable:
      options_.enable_motors(argument != 0);
      break;
    case Command::config:
      say(config_packet());
      break;
    case Command::encoder:
      encoder_packets_ = argument >= 2 ? -1 : argument;
      break;
    case Command::seto:
      odometry_zero_ = last_pose_ = options_.odometry().odom_from_base;
      break;
    case Command::hostbaud:
      if (options_.may_switch_baud && argument >= 0 && argument < static_cast<int>(std::size(rates))) {
        baud_ = rates[argument];
      }
      break;
    default:
      break;  // pulse, and what this base does not have: it is alive
  }
}

bool SimulatedP2os::obey_motion(const p2os::ParsedCommand& command) {
  const int argument = command.argument.value_or(0);
  const double metres = argument / 1000.0, angle = robot::radians(argument);
  const auto go = [&](double speed) {
    move_from_.reset();
    wanted_.linear = std::clamp(speed, -max_speed_, max_speed_);
  };
  const auto turn = [&](double rate) {
    heading_.reset();
    wanted_.angular = std::clamp(rate, -max_turn_, max_turn_);
  };
  switch (static_cast<Command>(command.number)) {
    case Command::vel:
      go(metres);
      return true;
    case Command::rvel:
    case Command::rotate:
      turn(angle);
      return true;
    case Command::vel2: {
      const auto wheels = p2os::parse_vel2(argument);
      const double unit = model_->vel2_divisor_mm / 1000.0;
      go((wheels.left + wheels.right) / 2.0 * unit);
      turn((wheels.right - wheels.left) / 2.0 * unit / half_track(*model_));
      return true;
    }
    case Command::move:
      move_from_ = odometry().odom_from_base;
      move_way_ = metres;
      return true;
    case Command::head:
      heading_ = robot::wrap_angle(angle);
      return true;
    case Command::dhead:
    case Command::dchead:
      heading_ = robot::wrap_angle(odometry().odom_from_base.theta + angle);
      return true;
    case Command::stop:
      go(0.0);
      turn(0.0);
      return true;
    case Command::e_stop:
      go(0.0);
      turn(0.0);
      reference_ = {};  // the motors brake as hard as they can
      return true;
    default:
      return false;
  }
}

bool SimulatedP2os::obey_settings(const p2os::ParsedCommand& command) {
  const int argument = command.argument.value_or(0);
  const double metres = argument / 1000.0, angle = robot::radians(argument);
  switch (static_cast<Command>(command.number)) {
    case Command::seta:
      (argument >= 0 ? acceleration_ : deceleration_) = std::abs(metres);
      return true;
    case Command::setra:
      (argument >= 0 ? turn_acceleration_ : turn_deceleration_) = std::abs(angle);
      return true;
    case Command::setv:
      max_speed_ = std::min(std::abs(metres), 2.2);
      return true;
    case Command::setrv:
      max_turn_ = std::min(std::abs(angle), robot::radians(500));
      return true;
    case Command::sonar:
      sonar_on_ = argument & 1;
      return true;
    case Command::polling:
      polling_ = command.text;
      return true;
    case Command::digout: {
      const unsigned mask = static_cast<unsigned>(argument) >> 8 & 0xFF;
      digital_out_ = static_cast<std::uint8_t>((digital_out_ & ~mask) | (static_cast<unsigned>(argument) & mask));
      return true;
    }
    case Command::adsel:
      analog_port_ = static_cast<std::uint8_t>(argument);
      return true;
    case Command::battest:
      fake_battery_dv_ = static_cast<std::uint8_t>(argument);
      return true;
    default:
      return false;
  }
}

robot::Odometry SimulatedP2os::odometry() const {
  robot::Odometry out = options_.odometry();
  out.odom_from_base = robot::relative(odometry_zero_, out.odom_from_base);
  return out;
}

double SimulatedP2os::wanted_speed(const robot::Odometry& at) const {
  if (!move_from_) return wanted_.linear;
  const double left = move_way_ - robot::relative(*move_from_, at.odom_from_base).x;
  if (std::abs(left) < 0.002) return 0.0;
  return std::clamp(speed_to_stop_in(left, deceleration_), -max_speed_, max_speed_);
}

double SimulatedP2os::wanted_turn(const robot::Odometry& at) const {
  if (!heading_) return wanted_.angular;
  const double left = robot::wrap_angle(*heading_ - at.odom_from_base.theta);
  if (std::abs(left) < 0.005) return 0.0;
  return std::clamp(speed_to_stop_in(left, turn_deceleration_), -max_turn_, max_turn_);
}

void SimulatedP2os::control(Instant now) {
  const double dt = std::min(std::chrono::duration<double>(now - last_control_).count(), 0.1);
  last_control_ = now;
  const robot::Odometry at = odometry();
  const bool abandoned = now - last_packet_ > options_.watchdog;
  const bool enabled = options_.state().motors_enabled;
  const double speed = abandoned || !enabled ? 0.0 : wanted_speed(at);
  const double rate = abandoned || !enabled ? 0.0 : wanted_turn(at);
  reference_.linear = ramp(reference_.linear, speed, acceleration_, deceleration_, dt);
  reference_.angular = ramp(reference_.angular, rate, turn_acceleration_, turn_deceleration_, dt);
  if (!enabled) reference_ = {};
  options_.drive(reference_);
}

void SimulatedP2os::advance(Instant now) {
  if (!open_) return;
  if (now >= sip_sent_) {
    say(sip_on_the_line_);
    sip_sent_ = never;
  }
  if (now - last_control_ >= control_cycle) control(now);
  if (now < sip_due_) return;
  sip_due_ = std::max(sip_due_ + options_.sip_cycle, now);
  if (sip_sent_ != never) return;  // the line is too slow for its cycle
  sip_on_the_line_ = sip();
  if (encoder_packets_ != 0) {
    const Bytes packet = encoders();
    sip_on_the_line_.insert(sip_on_the_line_.end(), packet.begin(), packet.end());
    encoder_packets_ = std::min(encoder_packets_, 0);
  }
  sip_sent_ = now + std::chrono::duration_cast<Duration>(transmission_time(sip_on_the_line_.size(), baud_));
}

Instant SimulatedP2os::due() const {
  return open_ ? std::min({sip_due_, sip_sent_, last_control_ + control_cycle}) : never;
}

Bytes SimulatedP2os::sip() {
  p2os::BaseReading reading{odometry(), options_.state(), {}};
  const robot::Pose now = reading.odometry.odom_from_base;
  const robot::Pose step = robot::relative(std::exchange(last_pose_, now), now);
  left_way_ += step.x - step.theta * half_track(*model_);
  right_way_ += step.x + step.theta * half_track(*model_);
  if (sonar_on_) reading.sonars = options_.sonars().readings;
  if (!polling_.empty()) {
    std::erase_if(reading.sonars, [this](const robot::SonarReading& sonar) {
      return polling_.find(static_cast<char>(sonar.sonar + 1)) == std::string::npos;
    });
  }
  p2os::Sip out = p2os::to_sip(reading, *model_);
  if (sonar_on_) out.flags |= p2os::flag_sonar;
  if (fake_battery_dv_ != 0) {
    out.battery_dv = fake_battery_dv_;
    out.battery_dv10 = fake_battery_dv_;
    out.state_of_charge_pct.reset();
  }
  out.control = out.theta;
  out.analog_port = analog_port_;
  out.digital_in = 0xFF;
  out.digital_out = digital_out_;
  return p2os::encode_sip(out);
}

Bytes SimulatedP2os::encoders() const {
  const auto ticks = [](double way) {
    return static_cast<std::int32_t>(static_cast<std::int64_t>(std::llround(way * 1000.0 * ticks_per_mm)));
  };
  return p2os::encode_encoders({ticks(left_way_), ticks(right_way_)});
}

Bytes SimulatedP2os::config_packet() const {
  const auto mm = [](double value) { return static_cast<unsigned>(std::lround(value * 1000.0)); };
  const auto deg = [](double value) { return static_cast<unsigned>(std::lround(robot::degrees(value))); };
  p2os::ConfigPacket config;
  config.type = options_.identity.class_name;
  config.subtype = options_.identity.subclass;
  config.serial_number = "1997";
  config.rotation_top_deg = 500;
  config.translation_top_mm = 2200;
  config.rotation_acceleration_top_deg = 500;
  config.translation_acceleration_top_mm = 2000;
  config.name = options_.identity.name;
  config.sip_cycle_ms =
      static_cast<unsigned>(std::chrono::duration_cast<std::chrono::milliseconds>(options_.sip_cycle).count());
  config.front_sonar = config.rear_sonar = true;
  config.low_battery_dv = 115;
  config.watchdog_ms =
      static_cast<unsigned>(std::chrono::duration_cast<std::chrono::milliseconds>(options_.watchdog).count());
  config.rotation_max_deg = deg(max_turn_);
  config.translation_max_mm = mm(max_speed_);
  config.rotation_acceleration_deg = deg(turn_acceleration_);
  config.rotation_deceleration_deg = deg(turn_deceleration_);
  config.translation_acceleration_mm = mm(acceleration_);
  config.translation_deceleration_mm = mm(deceleration_);
  config.front_bumpers = config.rear_bumpers = 5;
  config.reset_baud = options_.may_switch_baud ? 2 : 0;
  config.ticks_mm = static_cast<unsigned>(ticks_per_mm);
  config.firmware = "2.9";
  return p2os::encode_config(config);
}

}  // namespace devices
