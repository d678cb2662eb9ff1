#include "protocols/serial/p2os_base.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>

namespace serial::p2os {
namespace {

constexpr double turn = 2.0 * robot::pi;
constexpr std::array<Model, 5> models = {{
    {"p3dx-sh", turn / 4096, 1.0, 1.0, 1.0, 0.0056, 20},
    {"p3dx", turn / 4096, 0.485, 1.0, 1.0, 0.0056, 20},
    {"p3at", turn / 4096, 0.465, 1.0, 1.0, 0.0034, 20},
    {"peoplebot-sh", turn / 4096, 1.0, 1.0, 1.0, 0.006, 20},
    {"pion1x", 0.00614, 0.05066, 2.5332, 0.1734, 0.00333, 4},
}};

// The shorter way between two 15-bit counts.
int wrapped_difference(std::uint16_t now, std::uint16_t before) {
  const int d = (now - before) & 0x7FFF;
  return d >= 0x4000 ? d - 0x8000 : d;
}

// Charge of a 12 V lead-acid battery from its voltage: the base powers off at 11 V and rests at 12.7 V when full.
double charge_at(double volts) { return std::clamp((volts - 11.0) / 1.7, 0.0, 1.0); }

// Rounds `wanted` and keeps what was lost for the next time.
int diffuse(double wanted, double& left_over) {
  constexpr double limit = 32767.0;
  if (wanted == 0.0 || !std::isfinite(wanted)) {
    left_over = 0.0;
    return 0;
  }
  const double exact = std::clamp(wanted, -limit, limit) + left_over;
  const double whole = std::clamp(std::round(exact), -limit, limit);
  left_over = std::clamp(exact - whole, -0.5, 0.5);
  return static_cast<int>(whole);
}

std::int16_t to_s16(double value) {
  return static_cast<std::int16_t>(std::clamp(std::round(value), -32768.0, 32767.0));
}
std::uint16_t wrap_15(double counts) {
  return static_cast<std::uint16_t>(static_cast<std::int64_t>(std::llround(counts)) & 0x7FFF);
}

}  // namespace

const Model& model_of(std::string_view subclass) {
  const auto same = [&](const Model& model) {
    return std::equal(subclass.begin(), subclass.end(), model.subclass.begin(), model.subclass.end(),
                      [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; });
  };
  const auto found = std::find_if(models.begin(), models.end(), same);
  return found == models.end() ? models.front() : *found;
}

robot::Odometry OdometryTracker::update(const Sip& sip) {
  if (started_) {
    x_counts_ += wrapped_difference(sip.x, last_x_);
    y_counts_ += wrapped_difference(sip.y, last_y_);
  }
  last_x_ = sip.x;
  last_y_ = sip.y;
  const double metre = 0.001 * model_->mm_per_count;
  const robot::Pose counts{static_cast<double>(x_counts_) * metre, static_cast<double>(y_counts_) * metre,
                           robot::wrap_angle(sip.theta * model_->radians_per_count)};
  if (!started_) odom_from_counts_ = odom_from_counts_ * robot::inverse(counts);
  started_ = true;

  const double speed = 0.001 * model_->mm_per_s_per_count, left = sip.left * speed, right = sip.right * speed;
  const double from_wheels = 1000.0 * (right - left) / 2.0 * model_->turn_per_speed_difference;
  robot::Odometry out;
  out.odom_from_base = last_ = odom_from_counts_ * counts;
  out.twist.linear = (left + right) / 2.0;
  out.twist.angular = sip.rotation_ddeg ? robot::radians(*sip.rotation_ddeg / 10.0) : from_wheels;
  return out;
}

double OdometryTracker::step(const Sip& sip) const {
  if (!started_) return 0.0;
  return 0.001 * model_->mm_per_count *
         std::hypot(wrapped_difference(sip.x, last_x_), wrapped_difference(sip.y, last_y_));
}

void OdometryTracker::reconnected(const Model& model) {
  model_ = &model;
  odom_from_counts_ = last_;
  started_ = false;
  x_counts_ = y_counts_ = 0;
}

double fastest_wheel(const Sip& sip, const Model& model) {
  return 0.001 * model.mm_per_s_per_count * std::max(std::abs(int{sip.left}), std::abs(int{sip.right}));
}

robot::BaseState base_state(const Sip& sip) {
  robot::BaseState out;
  out.battery_volts = sip.battery_dv10 ? *sip.battery_dv10 / 10.0 : sip.battery_dv / 10.0;
  if (sip.state_of_charge_pct && *sip.state_of_charge_pct <= 100) {
    out.battery_fraction = *sip.state_of_charge_pct / 100.0;
  } else if (out.battery_volts > 1.0) {
    out.battery_fraction = charge_at(out.battery_volts);
  }
  out.motors_enabled = sip.flags & flag_motors;
  out.emergency_stop = sip.flags & (flag_stop_button | flag_e_stall);
  out.stalled = sip.left_stall || sip.right_stall;
  out.bumper_front = sip.front_bumpers != 0;
  out.bumper_rear = sip.rear_bumpers != 0;
  return out;
}

robot::SonarScan sonar_scan(const Sip& sip, const Model& model) {
  robot::SonarScan out;
  out.readings.reserve(sip.sonars.size());
  for (const SonarCount& sonar : sip.sonars) {
    const float range = static_cast<float>(0.001 * model.mm_per_sonar_count * sonar.range);
    out.readings.push_back({sonar.sonar, sonar.range >= no_echo ? std::numeric_limits<float>::quiet_NaN() : range});
  }
  return out;
}

Bytes VelocityEncoder::encode(const robot::Twist& twist) {
  Bytes out = p2os::encode(Command::vel, diffuse(1000.0 * twist.linear, left_over_.linear));
  const Bytes turning = p2os::encode(Command::rvel, diffuse(robot::degrees(twist.angular), left_over_.angular));
  out.insert(out.end(), turning.begin(), turning.end());
  return out;
}

Sip to_sip(const BaseReading& reading, const Model& model) {
  const robot::Odometry& odometry = reading.odometry;
  const double counts_per_m = 1000.0 / model.mm_per_count, speed_counts = 1000.0 / model.mm_per_s_per_count;
  const double half_track = 0.001 / model.turn_per_speed_difference;  // m
  Sip out;
  out.moving = std::abs(odometry.twist.linear) > 0.001 || std::abs(odometry.twist.angular) > 0.002;
  out.x = wrap_15(odometry.odom_from_base.x * counts_per_m);
  out.y = wrap_15(odometry.odom_from_base.y * counts_per_m);
  out.theta = to_s16(robot::wrap_angle(odometry.odom_from_base.theta) / model.radians_per_count);
  out.left = to_s16((odometry.twist.linear - odometry.twist.angular * half_track) * speed_counts);
  out.right = to_s16((odometry.twist.linear + odometry.twist.angular * half_track) * speed_counts);
  out.rotation_ddeg = to_s16(10.0 * robot::degrees(odometry.twist.angular));
  const double decivolts = std::clamp(10.0 * reading.state.battery_volts, 0.0, 255.0);
  out.battery_dv = static_cast<std::uint8_t>(std::lround(decivolts));
  out.battery_dv10 = out.battery_dv;
  out.charge_state = 0;
  if (reading.state.battery_fraction >= 0.0) {
    out.state_of_charge_pct =
        static_cast<std::uint8_t>(std::lround(100.0 * std::min(reading.state.battery_fraction, 1.0)));
  }
  out.left_stall = out.right_stall = reading.state.stalled;
  out.front_bumpers = reading.state.bumper_front ? 0x04 : 0;
  out.rear_bumpers = reading.state.bumper_rear ? 0x04 : 0;
  if (reading.state.motors_enabled) out.flags |= flag_motors;
  if (reading.state.emergency_stop) out.flags |= flag_stop_button;
  for (const robot::SonarReading& sonar : reading.sonars) {
    const double counts = 1000.0 * sonar.range / model.mm_per_sonar_count;
    const bool echo = counts >= 0.0 && counts < no_echo;
    out.sonars.push_back({static_cast<std::uint8_t>(sonar.sonar),
                          echo ? static_cast<std::uint16_t>(std::lround(counts)) : std::uint16_t{no_echo}});
  }
  return out;
}

}  // namespace serial::p2os
