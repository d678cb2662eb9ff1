// A Pioneer base as its host sees it: handshake, set-points with the firmware's ramps, watchdog, server information
// packets with odometry that wraps.
#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>

#include "protocols/serial/p2os_base.hpp"
#include "server/devices/simulated_device.hpp"

namespace devices {

struct SimulatedP2osConfig {
  // The body below the firmware.
  std::function<void(robot::Twist)> drive{};  // what the motors' controllers shall do now
  std::function<void(bool)> enable_motors{};
  std::function<robot::Odometry()> odometry{};
  std::function<robot::BaseState()> state{};
  std::function<robot::SonarScan()> sonars{};  // fires those that are due

  serial::p2os::Identity identity{"Docent", "Pioneer", "peoplebot-sh"};
  int baud = 9600;  // at power-on and after CLOSE
  bool may_switch_baud = true;
  Duration sip_cycle = 50ms;
  Duration watchdog = 2s;
};

class SimulatedP2os : public SimulatedDevice {
 public:
  SimulatedP2os(SimulatedP2osConfig config, Instant now);

  void receive(serial::ByteSpan bytes, Instant now) override;
  void advance(Instant now) override;
  Instant due() const override;
  serial::Bytes take_output() override { return std::exchange(output_, {}); }
  int baud() const override { return baud_; }

  bool open() const { return open_; }
  // What the firmware's ramps ask of the motors.
  robot::Twist reference() const { return reference_; }
  // The newest set-points that came over the line.
  robot::Twist wanted() const { return wanted_; }
  // For tests of faults: a base that says nothing.
  void set_silent(bool silent) { silent_ = silent; }

 private:
  void shake_hands(serial::ByteSpan body, Instant now);
  void obey(const serial::p2os::ParsedCommand& command, Instant now);
  bool obey_motion(const serial::p2os::ParsedCommand& command);
  bool obey_settings(const serial::p2os::ParsedCommand& command);
  void close();
  void control(Instant now);
  double wanted_speed(const robot::Odometry& at) const;
  double wanted_turn(const robot::Odometry& at) const;
  serial::Bytes sip();
  serial::Bytes encoders() const;
  serial::Bytes config_packet() const;
  void say(const serial::Bytes& packet);
  robot::Odometry odometry() const;

  SimulatedP2osConfig options_;
  const serial::p2os::Model* model_;
  serial::p2os::PacketDecoder decoder_;
  serial::Bytes output_;
  int baud_;
  int step_ = 0;  // of the handshake
  bool open_ = false;
  bool silent_ = false;

  // Set-points. A way or a heading to reach is worn down by control().
  robot::Twist wanted_;
  std::optional<robot::Pose> move_from_;  // MOVE: where it began
  double move_way_ = 0.0;                 // m, with sign
  std::optional<double> heading_;         // rad, odom frame
  robot::Twist reference_;
  bool watchdog_bit_ = false;

  // Settings in SI; what the host may set.
  double max_speed_ = 2.2, max_turn_ = robot::radians(500);
  double acceleration_ = 0.3, deceleration_ = 0.3;
  double turn_acceleration_ = robot::radians(100), turn_deceleration_ = robot::radians(100);
  bool sonar_on_ = true;
  std::string polling_;      // 1-based units; empty: all
  int encoder_packets_ = 0;  // to send; -1: with every SIP
  std::uint8_t digital_out_ = 0, analog_port_ = 0;
  std::uint8_t fake_battery_dv_ = 0;
  robot::Pose odometry_zero_;
  double left_way_ = 0.0, right_way_ = 0.0;  // m, of the wheels
  robot::Pose last_pose_;

  Instant last_packet_, last_control_, sip_due_;
  serial::Bytes sip_on_the_line_;
  Instant sip_sent_;
};

}  // namespace devices
